"""How well a frame moves at a configuration: singular values of the Jacobian, translation and rotation apart.

The two have different units (m and rad per unit of a coordinate), so no number mixes them. Each is measured in the
directions that the arm can move in at all: r is the generic rank of the Jacobian's three rows, 2 for the translation
of a planar arm, and the values are σ1 ≥ … ≥ σr.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.typing import FloatArray
from pinscrew.workspace.axes import Axis

__all__ = ["Measures", "generic_ranks", "manipulability", "unit"]

TRIALS: Final = 64
"""Random configurations that tell a generic rank; all of them are singular with probability 0."""
ZERO: Final = 1e-9
"""Singular values below this part of the largest one, or of the robot's size, are none: rounding leaves 1e-15."""


@dataclass(frozen=True, eq=False, slots=True)
class Measures:
    """Singular values σ1 ≥ … ≥ σr of three rows of a Jacobian at N configurations, and what follows from them.

    Attributes:
        singular_values: shape (N, r); m or rad per unit of a coordinate (rad or m).
    """

    singular_values: FloatArray

    @property
    def rank(self) -> int:
        """r: in how many directions the frame can move at once; 0 if it never does."""
        return int(self.singular_values.shape[1])

    @property
    def manipulability(self) -> FloatArray:
        """w = σ1 ⋯ σr, shape (N,); NaN where r = 0.

        For r = 3 it is √det(J Jᵀ) of Yoshikawa (Int. J. Robotics Research 4:2, 1985), to whose ellipsoid's volume
        it is proportional; for r < 3 the same in the directions that there are.
        """
        product: FloatArray = self.singular_values.prod(axis=1)
        return product if self.rank else np.full(len(product), np.nan)

    @property
    def smallest(self) -> FloatArray:
        """σr, shape (N,): the distance to the nearest matrix of lower rank (Eckart and Young, 1936); NaN if r = 0."""
        return self.singular_values[:, -1] if self.rank else np.full(len(self.singular_values), np.nan)

    @property
    def condition(self) -> FloatArray:
        """σ1 / σr, shape (N,): 1 is isotropic, infinity singular; NaN where r = 0."""
        if not self.rank:
            return self.smallest
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: FloatArray = self.singular_values[:, 0] / self.singular_values[:, -1]
        return np.where(self.singular_values[:, -1] > 0.0, ratio, np.inf)


def generic_ranks(engine: Engine, frame: str, axes: tuple[Axis, ...]) -> tuple[int, int]:
    """Ranks of the translation's and of the rotation's rows at almost all configurations, in or out of the ranges."""
    robot = engine.robot
    rng = np.random.default_rng(0)
    q = np.tile(robot.neutral, (TRIALS, 1))
    for axis in axes:
        most = np.pi if axis.angle else max(1.0, robot.reach)
        q[:, axis.index] = rng.uniform(-most, most, TRIALS)
    J = engine.jacobian(q, frame, "hybrid")
    # Where nothing moves, rounding leaves a part of the robot's size, or of a radian.
    return _rank(J[:, :3], robot.reach), _rank(J[:, 3:], 1.0)


def _rank(rows: FloatArray, size: float) -> int:
    """The largest rank of matrices, shape (N, 3, n), in which sizes of rounding are a part of ``size``."""
    values = np.linalg.svd(rows, compute_uv=False)
    return int((values > ZERO * max(size, float(values.max()))).sum(axis=1).max())


def manipulability(J: FloatArray, rank: int) -> FloatArray:
    """`Measures.manipulability` without singular values: for voxels, where 1e-8 of the largest one is near enough.

    The r-th elementary symmetric function of the eigenvalues of J Jᵀ, from its principal minors, is (σ1 ⋯ σr)²,
    since σi = 0 for i > r.

    Args:
        J: three rows of Jacobians, shape (N, 3, n).
        rank: the generic rank r, 0 to 3.

    Returns:
        shape (N,).
    """
    if rank == 0:
        return np.full(len(J), np.nan)
    rows = np.ascontiguousarray(J.transpose(1, 2, 0))
    xx, yy, zz = ((row * row).sum(axis=0) for row in rows)
    square: FloatArray = xx + yy + zz
    xy, xz, yz = ((rows[i] * rows[j]).sum(axis=0) for i, j in ((0, 1), (0, 2), (1, 2)))
    if rank == 2:
        square = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
    elif rank == 3:
        square = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    product: FloatArray = np.sqrt(np.maximum(square, 0.0))
    return product


def unit(metadata: Mapping[str, Any], power: int, of: str = "m") -> str:
    """The unit of a product of so many singular values, from the units of the coordinates in a sweep's metadata.

    Args:
        metadata: of a sweep or a map.
        power: how many singular values.
        of: ``"m"`` for translation, ``"rad"`` for rotation.
    """
    units = sorted(set(metadata["units"].values()), reverse=True)
    raised = ("", "", "²", "³")[power]
    if units == [of]:
        return "1"
    return f"{of}{raised}/{units[0]}{raised}" if len(units) == 1 else f"{of}{raised} per ({' or '.join(units)}){raised}"
