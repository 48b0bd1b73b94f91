"""Random serial arms as URDF text, their origins and axes at multiples of 30° or 45°, or at any angle."""

from __future__ import annotations

import math

import numpy as np

from urdfs import joint, robot

__all__ = ["awkward_arm", "puma", "random_arm"]


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


AWKWARD = ["1st", "a b", "L_shoulder", "joint-3", "größe", "x_0", "T", "theta1"]
"""Names that are no identifiers, or are taken."""
ODD_LENGTHS = ["0.0003", "1e-05", "12.34567", "-0.125", "3.141592653589793", "0.333", "7", "9.25"]


def awkward_arm(seed: int) -> str:
    """An arm of two to four joints, some of which follow others, with awkward names and lengths."""
    rng = np.random.default_rng(seed)
    names = [str(name) for name in rng.permutation(AWKWARD)]
    count = int(rng.integers(2, 5))
    kinds = ["prismatic" if rng.random() < 0.3 else "revolute" for _ in range(count)]
    parts = []
    for i, kind in enumerate(kinds):
        mimic = None
        if i and rng.random() < 0.5:  # a number of radians for each radian, or of metres for each metre or radian
            offset = 0.25 if kind == "prismatic" else float(rng.choice([0.0, math.pi / 2, math.pi / 6]))
            mimic = (names[0], float(rng.choice([-1.0, 2.0, -0.5, 3.0])), offset)
        xyz = " ".join(str(x) for x in rng.choice(ODD_LENGTHS, 3))
        axis = str(rng.choice(["1 0 0", "0 1 0", "0 0 1", "0 0 -1"]))
        rpy = f"0 {math.pi / 2 * int(rng.integers(-1, 2))!r} 0"
        parts.append(joint(names[i], kind, f"l{i}", f"l{i + 1}", xyz=xyz, rpy=rpy, axis=axis, mimic=mimic))
    parts.append(joint("end", "fixed", f"l{count}", "tool", xyz="0.1 0 0.05"))
    return robot(*parts, links=" ".join([*(f"l{i}" for i in range(count + 1)), "tool"]))


def puma() -> str:
    """Murray, Li and Sastry's elbow arm with an offset and a spherical wrist, as a Puma's."""
    origins = ("0 0 0.672", "0 0.14 0", "0.432 0 0", "0.02 0 0.433", "0 0 0", "0 0 0")
    axes = ("0 0 1", "0 -1 0", "0 -1 0", "0 0 1", "0 -1 0", "0 0 1")
    parts = [
        joint(f"j{i}", "revolute", f"l{i - 1}", f"l{i}", xyz=xyz, axis=axis)
        for i, (xyz, axis) in enumerate(zip(origins, axes, strict=True), 1)
    ]
    return robot(*parts, links=" ".join(f"l{i}" for i in range(7)))
