"""Kinematics from URDF that you can trust.

Pinocchio and the product of exponentials answer the same questions about a robot, each from its own reading of
the file, and are compared to rounding error:

>>> import pinscrew as ps
>>> robot = ps.load("scara", l1=0.4, l2=0.3)
>>> bool(abs(ps.PoE(robot).fk([0.1, 0.2, 0.3]) - ps.Pinocchio(robot).fk([0.1, 0.2, 0.3])).max() < 1e-14)
True

Twists and Jacobian rows are (v, ω), linear part first; lengths are metres, angles radians.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pinscrew import lie
    from pinscrew.derivation.run import derive
    from pinscrew.engines.base import Engine
    from pinscrew.engines.pinocchio import Pinocchio
    from pinscrew.engines.poe import PoE
    from pinscrew.errors import PinscrewError, PinscrewWarning
    from pinscrew.loading import load
    from pinscrew.robot import Robot
    from pinscrew.screw import Screw
    from pinscrew.verification.report import Report
    from pinscrew.verification.run import verify
    from pinscrew.view.meshcat import show

__all__ = [
    "Engine",
    "Pinocchio",
    "PinscrewError",
    "PinscrewWarning",
    "PoE",
    "Report",
    "Robot",
    "Screw",
    "__version__",
    "derive",
    "lie",
    "load",
    "show",
    "verify",
]

__version__ = "0.1.0"

# Where each public name lives: parsers and engines are heavy, and load when first used.
_HOMES = {
    "Engine": "pinscrew.engines.base",
    "Pinocchio": "pinscrew.engines.pinocchio",
    "PinscrewError": "pinscrew.errors",
    "PinscrewWarning": "pinscrew.errors",
    "PoE": "pinscrew.engines.poe",
    "Report": "pinscrew.verification.report",
    "Robot": "pinscrew.robot",
    "Screw": "pinscrew.screw",
    "derive": "pinscrew.derivation.run",
    "lie": "pinscrew.lie",
    "load": "pinscrew.loading",
    "show": "pinscrew.view.meshcat",
    "verify": "pinscrew.verification.run",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'pinscrew' has no attribute {name!r}")
    module = importlib.import_module(_HOMES[name])
    value = module if module.__name__ == f"pinscrew.{name}" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
