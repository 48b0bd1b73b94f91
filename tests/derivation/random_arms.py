"""Random serial arms as URDF text, their origins and axes at multiples of 30° or 45°, or at any angle."""

from __future__ import annotations

import math

import numpy as np

from urdfs import joint, robot

__all__ = ["random_arm"]


def random_arm(seed: int, joints: int, angles: str) -> str:
    """An arm of this many joints; ``angles`` is ``"30"``, ``"45"`` or ``"any"``."""
    rng = np.random.default_rng(seed)

    def angle() -> float:
        if angles == "any":
            return float(rng.uniform(-math.pi, math.pi))
        return math.radians(int(angles)) * int(rng.integers(-5, 6))

    def axis() -> str:
        if rng.random() < 0.6:
            return ["1 0 0", "0 1 0", "0 0 1", "0 0 -1", "-1 0 0"][rng.integers(5)]
        a = angle()
        return f"{math.cos(a)!r} 0 {math.sin(a)!r}"

    parts = []
    for i in range(joints):
        kind = "prismatic" if rng.random() < 0.2 else "revolute"
        xyz = " ".join(str(round(x, 3)) for x in rng.uniform(-0.5, 0.5, 3))
        # Two of three origins turn about one axis, so that some axes stay parallel.
        rpy = [0.0, 0.0, 0.0]
        rpy[rng.integers(3)] = angle()
        if rng.random() < 0.3:
            rpy = [angle(), angle(), angle()]
        if rng.random() < 0.3:
            rpy = [0.0, 0.0, 0.0]
        parts.append(joint(f"j{i}", kind, f"l{i}", f"l{i + 1}", xyz=xyz, rpy=" ".join(map(repr, rpy)), axis=axis()))
    parts.append(joint("end", "fixed", f"l{joints}", "tool", xyz="0.1 0 0.05", rpy=f"0 {angle()!r} 0"))
    return robot(*parts, links=" ".join([*(f"l{i}" for i in range(joints + 1)), "tool"]))
