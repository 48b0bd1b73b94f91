"""yourdfpy's parser, run without trimesh: the same numbers as the whole library's, and no other import is touched."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import urdfs
from pinscrew.description import _yourdfpy
from pinscrew.description.catalogue import bundled
from pinscrew.robot.loading import expanded

TEXTS = {
    **{name: text for name, text in urdfs.ROBOTS.items() if name != "no_joints"},
    **{entry.name: expanded(entry.file, {}).text for entry in bundled()[:3]},
}


def read(parser: Any, text: str) -> Any:
    return parser.load(io.BytesIO(text.encode()), load_meshes=False, build_scene_graph=False).robot


@pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)
def test_it_reads_what_yourdfpy_reads(text: str) -> None:
    """To the last bit, and by another class than that of the whole library."""
    import yourdfpy

    alone = _yourdfpy._parser_alone()
    assert alone is not yourdfpy.URDF
    ours, theirs = read(alone, text), read(yourdfpy.URDF, text)
    assert [link.name for link in ours.links] == [link.name for link in theirs.links]
    assert len(ours.joints) == len(theirs.joints)
    for a, b in zip(ours.joints, theirs.joints, strict=True):
        assert (a.name, a.type, a.parent, a.child) == (b.name, b.type, b.parent, b.child)
        assert repr((a.limit, a.mimic)) == repr((b.limit, b.mimic))
        np.testing.assert_array_equal(a.axis, b.axis)
        assert (a.origin is None) == (b.origin is None)
        if a.origin is not None:
            np.testing.assert_array_equal(a.origin, b.origin)


def python(code: str) -> str:
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_reading_loads_no_trimesh() -> None:
    """Nor what it brings; and who imports it or yourdfpy later gets the whole."""
    code = """
import sys
import pinscrew as ps
ps.PoE(ps.load("scara")).fk([0.1, 0.2, 0.3])
print(*{"scipy", "trimesh", "networkx", "yourdfpy"} & {name.split(".")[0] for name in sys.modules})
import trimesh, yourdfpy
print(trimesh.creation.box().volume, yourdfpy.urdf.trimesh is trimesh)
"""
    assert python(code).splitlines() == ["", "1.0 True"]


@pytest.fixture
def forgotten() -> Any:
    """Nothing is remembered of earlier readings, nor of these."""
    _yourdfpy.parser.cache_clear()
    yield
    _yourdfpy.parser.cache_clear()


@pytest.mark.usefixtures("forgotten")
def test_what_is_loaded_already_is_used() -> None:
    import yourdfpy

    assert _yourdfpy.parser() is yourdfpy.URDF


@pytest.mark.usefixtures("forgotten")
@pytest.mark.parametrize(
    "source",
    [
        None,
        "import trimesh\nclass URDF:\n    meshes = trimesh.load_mesh\n",
        "import trimesh.creation\nfrom trimesh.creation import box\nclass URDF: ...\n",
        "class Robot: ...\n",
    ],
    ids=["no such file", "more of trimesh", "another module of trimesh", "no such class"],
)
def test_another_layout_is_imported_whole(source: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import yourdfpy

    folder = _yourdfpy._folder
    if source is not None:
        (tmp_path / "urdf.py").write_text(source)
    monkeypatch.setattr(_yourdfpy, "_folder", lambda package: tmp_path if package == "yourdfpy" else folder(package))
    with pytest.raises((ImportError, AttributeError, OSError)):
        _yourdfpy._parser_alone()
    monkeypatch.delitem(sys.modules, "yourdfpy")
    monkeypatch.setitem(sys.modules, "yourdfpy.urdf", yourdfpy.urdf)
    assert _yourdfpy.parser() is sys.modules["yourdfpy"].URDF


def test_a_package_that_is_not_there() -> None:
    with pytest.raises(ImportError):
        _yourdfpy._folder("no_such_package_anywhere")
