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

import functools
import importlib
from typing import TYPE_CHECKING, Any

from pinscrew.ground.displays import DRAWN_BY
from pinscrew.ground.version import __version__

if TYPE_CHECKING:
    from pinscrew import lie
    from pinscrew.changes.run import Changes, diff
    from pinscrew.checking.files import check_file
    from pinscrew.checking.run import check
    from pinscrew.derivation.run import derive
    from pinscrew.dh.robots import from_dh
    from pinscrew.engines.base import Engine
    from pinscrew.engines.compiled.batch import Batch
    from pinscrew.engines.pinocchio import Pinocchio
    from pinscrew.engines.poe import PoE
    from pinscrew.ground.errors import PinscrewError, PinscrewWarning
    from pinscrew.identification.outcome import Identified
    from pinscrew.identification.run import identify
    from pinscrew.lie.screw import Screw
    from pinscrew.motion.integration import integrate
    from pinscrew.motion.inverse_kinematics import Solution, ik
    from pinscrew.motion.inverse_velocity import InverseVelocity, inverse_velocity
    from pinscrew.motion.profile import Profile
    from pinscrew.motion.singularities import find_singularities
    from pinscrew.motion.singularity import Singularity, classify_singularity
    from pinscrew.motion.track import Track, track
    from pinscrew.motion.trajectory import Trajectory
    from pinscrew.robot.loading import load
    from pinscrew.robot.robot import Robot
    from pinscrew.verification.report import Report
    from pinscrew.verification.run import verify
    from pinscrew.view.meshcat import show
    from pinscrew.witnesses.witness import witness
    from pinscrew.workspace.reachability import reachability
    from pinscrew.workspace.reachability_map import ReachabilityMap
    from pinscrew.workspace.sweep import Sweep, sweep

__all__ = [
    "Batch",
    "Changes",
    "Engine",
    "Identified",
    "InverseVelocity",
    "Pinocchio",
    "PinscrewError",
    "PinscrewWarning",
    "PoE",
    "Profile",
    "ReachabilityMap",
    "Report",
    "Robot",
    "Screw",
    "Singularity",
    "Solution",
    "Sweep",
    "Track",
    "Trajectory",
    "__version__",
    "check",
    "check_file",
    "classify_singularity",
    "derive",
    "diff",
    "find_singularities",
    "from_dh",
    "identify",
    "ik",
    "integrate",
    "inverse_velocity",
    "lie",
    "load",
    "reachability",
    "show",
    "sweep",
    "track",
    "verify",
    "witness",
]

# Where each public name lives: parsers and engines are heavy, and load when first used.
_HOMES = {
    "Batch": "pinscrew.engines.compiled.batch",
    "Changes": "pinscrew.changes.run",
    "Engine": "pinscrew.engines.base",
    "Identified": "pinscrew.identification.outcome",
    "InverseVelocity": "pinscrew.motion.inverse_velocity",
    "Pinocchio": "pinscrew.engines.pinocchio",
    "PinscrewError": "pinscrew.ground.errors",
    "PinscrewWarning": "pinscrew.ground.errors",
    "PoE": "pinscrew.engines.poe",
    "Profile": "pinscrew.motion.profile",
    "ReachabilityMap": "pinscrew.workspace.reachability_map",
    "Report": "pinscrew.verification.report",
    "Robot": "pinscrew.robot.robot",
    "Screw": "pinscrew.lie.screw",
    "Singularity": "pinscrew.motion.singularity",
    "Solution": "pinscrew.motion.inverse_kinematics",
    "Sweep": "pinscrew.workspace.sweep",
    "Track": "pinscrew.motion.track",
    "Trajectory": "pinscrew.motion.trajectory",
    "check": "pinscrew.checking.run",
    "check_file": "pinscrew.checking.files",
    "classify_singularity": "pinscrew.motion.singularity",
    "derive": "pinscrew.derivation.run",
    "diff": "pinscrew.changes.run",
    "find_singularities": "pinscrew.motion.singularities",
    "from_dh": "pinscrew.dh.robots",
    "identify": "pinscrew.identification.run",
    "ik": "pinscrew.motion.inverse_kinematics",
    "integrate": "pinscrew.motion.integration",
    "inverse_velocity": "pinscrew.motion.inverse_velocity",
    "lie": "pinscrew.lie",
    "load": "pinscrew.robot.loading",
    "reachability": "pinscrew.workspace.reachability",
    "show": "pinscrew.view.meshcat",
    "sweep": "pinscrew.workspace.sweep",
    "track": "pinscrew.motion.track",
    "verify": "pinscrew.verification.run",
    "witness": "pinscrew.witnesses.witness",
}


def _drawn(drawing: str, thing: Any) -> str:
    """What a function of the notebook's makes of a thing; the view is loaded when it is first asked."""
    shown: str = getattr(importlib.import_module("pinscrew.view.notebook"), drawing)(thing)
    return shown


DRAWN_BY["Robot"] = functools.partial(_drawn, "robot")


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'pinscrew' has no attribute {name!r}")
    module = importlib.import_module(_HOMES[name])
    value = module if module.__name__ == f"pinscrew.{name}" else getattr(module, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
