"""Do two engines' parsers see the same joints?"""

from __future__ import annotations

import math

from pinscrew.engines.base import Engine, JointView

__all__ = ["compare"]


def compare(a: Engine, b: Engine) -> tuple[tuple[str, ...], bool]:
    """Differences between the joints that two engines saw, in words, and whether numbers can be compared.

    Numbers can be compared if both engines take the same coordinates and velocities.
    """
    remarks: list[str] = []
    seen_a, seen_b = a.joints(), b.joints()
    for name in seen_a.keys() | seen_b.keys():
        if name not in seen_b:
            remarks.append(f"joint {name!r} is seen by {a.name} only")
        elif name not in seen_a:
            remarks.append(f"joint {name!r} is seen by {b.name} only")
        else:
            remarks += _compare_joint(name, (a.name, seen_a[name]), (b.name, seen_b[name]))
    comparable = True
    for what in ("coordinate_names", "velocity_names"):
        mine, other = getattr(a.robot, what), getattr(b.robot, what)
        if mine != other:
            comparable = False
            remarks.append(f"{what.replace('_', ' ')} are {list(mine)} in {a.name}, {list(other)} in {b.name}")
    return tuple(sorted(remarks)), comparable


def _compare_joint(name: str, a: tuple[str, JointView], b: tuple[str, JointView]) -> list[str]:
    (engine_a, view_a), (engine_b, view_b) = a, b
    remarks = []
    for what in ("type", "parent", "child", "mimic"):
        mine, other = getattr(view_a, what), getattr(view_b, what)
        if mine != other:
            remarks.append(f"joint {name!r}: its {what} is {mine!r} to {engine_a}, {other!r} to {engine_b}")
    # A mimic joint's own limits don't bound any coordinate.
    if view_a.mimic is None and not _same_limits(view_a.limits, view_b.limits):
        remarks.append(f"joint {name!r}: its limits are {view_a.limits} to {engine_a}, {view_b.limits} to {engine_b}")
    return remarks


def _same_limits(a: tuple[float, float] | None, b: tuple[float, float] | None) -> bool:
    if a is None or b is None:
        return a is b
    return all(math.isclose(x, y, rel_tol=1e-15) for x, y in zip(a, b, strict=True))
