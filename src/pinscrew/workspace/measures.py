"""How well a frame moves at a configuration: singular values of the Jacobian, translation and rotation apart.

The two have different units (m and rad per unit of a coordinate), so no number mixes them. Each is measured in the
directions that the arm can move in at all: r is the generic rank of the Jacobian's three rows, 2 for the translation
of a planar arm, and the values are σ1 ≥ … ≥ σr.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pinscrew.ground.typing import FloatArray

__all__ = ["Measures", "unit"]


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
