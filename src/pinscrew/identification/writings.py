"""How the numbers of a Jacobian or a twist are written down: rows, units, columns; and how to turn them into ours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.typing import FloatArray

__all__ = ["UNITS", "Writing", "columns"]

UNITS: Final = {"m": 1.0, "mm": 0.001, "cm": 0.01}
"""Metres per unit."""
MOST: Final = 8
"""So many ways to order columns are looked for; two that differ are ambiguous already."""


@dataclass(frozen=True)
class Writing:
    """How numbers are written down.

    Attributes:
        order: which three rows come first.
        unit: of length.
        angle: columns of turning joints are per radian or per degree; of a twist, ω is in these.
        layout: a Jacobian's columns are the joints' (``"rows"``: its rows are v and ω), or its rows are.
        joints: for each given column the index of the velocity it is of; empty for a twist.
        signs: of each given column.
    """

    order: Literal["v,w", "w,v"] = "v,w"
    unit: str = "m"
    angle: Literal["rad", "deg"] = "rad"
    layout: Literal["rows", "transposed"] = "rows"
    joints: tuple[int, ...] = ()
    signs: tuple[int, ...] = ()

    def rows(self, ours: FloatArray, turning: FloatArray) -> FloatArray:
        """Columns (N, 6, n) of ours, with rows and units as here.

        Args:
            ours: rows (v, ω), m and rad; or v and rates, of which there may be four.
            turning: 1 where a column is of a turning joint, 0 of a sliding one; of a twist it is empty.
        """
        per = np.pi / 180.0 if self.angle == "deg" else 1.0
        linear, angular = ours[:, :3] / UNITS[self.unit], ours[:, 3:]
        if len(turning):
            scale = np.where(turning > 0.0, per, 1.0)
            linear, angular = linear * scale, angular * scale
        else:
            angular = angular / per
        return np.concatenate([linear, angular] if self.order == "v,w" else [angular, linear], axis=1)

    def words(self, names: tuple[str, ...], turn: str = "ω") -> str:
        """What differs from ours, which has rows (v, ω), metres, radians and all columns in their order."""
        said = [] if self.order == "v,w" else [f"rows ({turn}, v)"]
        said += [] if self.unit == "m" else [f"in {self.unit}"]
        said += [] if self.angle == "rad" else ["per degree" if self.joints else "in degrees"]
        said += [] if self.layout == "rows" else ["transposed"]
        if self.joints and self.joints != tuple(range(len(names))):
            said.append("columns in the order " + ", ".join(names[i] for i in self.joints))
        turned = [names[i] for i, sign in zip(self.joints, self.signs, strict=True) if sign < 0]
        said += [f"{', '.join(turned)} counted the other way"] if turned else []
        return ", ".join(said)

    def cost(self, count: int) -> int:
        """How far it is from the plainest: what is to be said, in numbers."""
        plain = (self.order == "v,w", self.unit == "m", self.angle == "rad", self.layout == "rows")
        moved = self.joints != tuple(range(count)) and bool(self.joints)
        return 2 * (4 - sum(plain)) + 3 * moved + 4 * sum(sign < 0 for sign in self.signs)


def columns(
    fits: NDArray[np.bool_], empty: frozenset[int] = frozenset()
) -> list[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Ways to give each column a joint of its own and a sign, those in the joints' order first; at most `MOST`.

    Args:
        fits: whether a given column is a joint's, shape (m, n, 2); for the sign + and for the sign -.
        empty: joints that do not move the frame: their columns are all alike, and are named in the joints' order.
    """
    count, joints, _ = fits.shape
    found: list[tuple[tuple[int, ...], tuple[int, ...]]] = []

    def extend(chosen: tuple[int, ...], signs: tuple[int, ...]) -> None:
        column = len(chosen)
        if column == count:
            found.append((chosen, signs))
            return
        first = chosen[-1] + 1 if chosen else 0
        left = set(range(joints)) - set(chosen)
        left -= empty - {min(empty & left, default=-1)}
        for joint in sorted(left, key=lambda i: (i < first, i)):
            for k, sign in enumerate((1,) if joint in empty else (1, -1)):
                if fits[column, joint, k] and len(found) < MOST:
                    extend((*chosen, joint), (*signs, sign))

    if fits.any(axis=(1, 2)).all():
        extend((), ())
    return found
