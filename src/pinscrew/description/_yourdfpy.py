"""yourdfpy's parser, without what yourdfpy draws with.

``import yourdfpy`` loads all of trimesh, and with it scipy and networkx: two thirds of a second, for meshes that
are not read here. So yourdfpy's own module is run, as it is installed, with an ``import trimesh`` that finds two
things: the names of types in its annotations, and `trimesh.transformations`, which composes the pose of an
``<origin>`` and is trimesh's own file. The module is a private one; what anybody else imports is not touched. Where a
release of either asks for more than that, yourdfpy is imported whole.
"""

from __future__ import annotations

import builtins
import sys
from functools import lru_cache
from importlib import import_module
from importlib.machinery import SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    import yourdfpy

__all__ = ["parser"]

_TRIMESH: Final = "_trimesh_of_pinscrew"
_URDF: Final = "_yourdfpy_of_pinscrew"
_FOR_ANNOTATIONS: Final = ("Trimesh", "Scene")
"""What yourdfpy names of trimesh while it is loaded."""


@lru_cache(maxsize=1)
def parser() -> type[yourdfpy.URDF]:
    """yourdfpy's ``URDF``, of which only ``load`` without meshes and scenes is to be used."""
    if "yourdfpy" not in sys.modules:
        try:
            return _parser_alone()
        except (ImportError, AttributeError, OSError):
            pass  # another layout than that of the releases known
    import yourdfpy

    whole: type[yourdfpy.URDF] = yourdfpy.URDF
    return whole


def _parser_alone() -> type[yourdfpy.URDF]:
    """The class from yourdfpy's file, run with `_stand_in` in the place of trimesh.

    Raises:
        ImportError, AttributeError, OSError: if the files are not there, or need more of trimesh.
    """
    trimesh = _stand_in()

    def import_with_stand_in(name: str, space: Any = None, local: Any = None, names: Any = (), level: int = 0) -> Any:
        if level == 0 and name.partition(".")[0] == "trimesh":
            return getattr(trimesh, name.partition(".")[2]) if names and "." in name else trimesh
        return __import__(name, space, local, names, level)

    module = ModuleType(_URDF)
    # An import statement calls the __import__ of its module's builtins: this module's alone is another.
    module.__dict__["__builtins__"] = {**vars(builtins), "__import__": import_with_stand_in}
    code = SourceFileLoader(_URDF, str(_folder("yourdfpy") / "urdf.py")).get_code(_URDF)
    if code is None:
        raise ImportError(_URDF)
    exec(code, module.__dict__)  # noqa: S102 (an installed module, as an import of it would)
    found: type[yourdfpy.URDF] = module.URDF
    return found


def _stand_in() -> ModuleType:
    """A module with `trimesh.transformations` and the types of `_FOR_ANNOTATIONS`, and nothing else."""
    package = ModuleType(_TRIMESH)  # over trimesh's folder, but its __init__, which loads all the rest, is not run
    package.__path__ = [str(_folder("trimesh"))]
    sys.modules[_TRIMESH] = package
    package.transformations = import_module(f"{_TRIMESH}.transformations")  # type: ignore[attr-defined]
    for name in _FOR_ANNOTATIONS:
        setattr(package, name, type(name, (), {}))
    return package


def _folder(package: str) -> Path:
    spec = find_spec(package)
    if spec is None or spec.origin is None:
        raise ImportError(package)
    return Path(spec.origin).parent
