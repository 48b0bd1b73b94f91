"""Do two engines' parsers see the same links and joints?"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pinscrew.engines.base import Engine, JointView

__all__ = ["EngineDifference", "compare", "joint_differences", "same_coordinates"]

_COORDINATES = ("coordinate_names", "velocity_names")


@dataclass(frozen=True, slots=True)
class EngineDifference:
    """One thing about a joint that two engines see or answer differently.

    Attributes:
        joint: its name, or ``""`` if it is about none.
        aspect: ``"presence"``, ``"type"``, ``"parent"``, ``"child"``, ``"mimic"`` or ``"limits"`` as their parsers see
            it, or ``"answers"``.
        words: the difference in a sentence.
    """

    joint: str
    aspect: str
    words: str


def compare(a: Engine, b: Engine) -> tuple[str, ...]:
    """Differences between the joints, links and coordinates that two engines saw, in words, down the tree."""
    remarks = [difference.words for difference in joint_differences(a, b)]
    for engine, other in ((a, b), (b, a)):
        only = (link for link in engine.robot.frame_names if link not in other.robot.frame_names)
        remarks += [f"link {link!r} is seen by {engine.name} only" for link in only]
    for names in _COORDINATES:
        mine, theirs = getattr(a.robot, names), getattr(b.robot, names)
        if mine != theirs:
            remarks.append(f"{names.replace('_', ' ')} are {list(mine)} in {a.name}, {list(theirs)} in {b.name}")
    return tuple(remarks)


def same_coordinates(a: Engine, b: Engine) -> bool:
    """Whether both engines take the same coordinates and velocities, so that their numbers can be compared."""
    return all(getattr(a.robot, names) == getattr(b.robot, names) for names in _COORDINATES)


def joint_differences(a: Engine, b: Engine) -> tuple[EngineDifference, ...]:
    """What two engines' parsers see differently about joints, from the base outwards."""
    seen_a, seen_b = a.joints(), b.joints()
    differences: list[EngineDifference] = []
    for name in (*seen_a, *(name for name in seen_b if name not in seen_a)):
        if name in seen_a and name in seen_b:
            differences += _compare_joint(name, (a.name, seen_a[name]), (b.name, seen_b[name]))
        else:
            engine = a if name in seen_a else b
            differences.append(EngineDifference(name, "presence", f"joint {name!r} is seen by {engine.name} only"))
    return tuple(differences)


def _compare_joint(name: str, a: tuple[str, JointView], b: tuple[str, JointView]) -> list[EngineDifference]:
    (engine_a, view_a), (engine_b, view_b) = a, b
    differences = []
    for aspect in ("type", "parent", "child", "mimic"):
        mine, other = getattr(view_a, aspect), getattr(view_b, aspect)
        if mine != other:
            if mine is None:
                words = f"{engine_a} treats joint {name!r} as independent; to {engine_b} it is {_mimic(other)}"
            elif other is None:
                words = f"{engine_b} treats joint {name!r} as independent; to {engine_a} it is {_mimic(mine)}"
            else:
                shown = [_mimic(value) if aspect == "mimic" else repr(value) for value in (mine, other)]
                words = f"joint {name!r}: its {aspect} is {shown[0]} to {engine_a}, {shown[1]} to {engine_b}"
            differences.append(EngineDifference(name, aspect, words))
    # A mimic joint's own limits don't bound any coordinate.
    if view_a.mimic is None and not _same_limits(view_a.limits, view_b.limits):
        shown = ["none" if view.limits is None else str(view.limits) for view in (view_a, view_b)]
        words = f"joint {name!r}: its limits are {shown[0]} to {engine_a}, {shown[1]} to {engine_b}"
        differences.append(EngineDifference(name, "limits", words))
    return differences


def _mimic(mimic: tuple[str, float, float]) -> str:
    return f"{mimic[1]!r} times {mimic[0]!r} plus {mimic[2]!r}"


def _same_limits(a: tuple[float, float] | None, b: tuple[float, float] | None) -> bool:
    if a is None or b is None:
        return a is b
    return all(math.isclose(x, y, rel_tol=1e-15) for x, y in zip(a, b, strict=True))
