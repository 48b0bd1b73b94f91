"""The names and orders of two books: Murray–Li–Sastry's and Lynch–Park's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.forms import Convention

__all__ = ["NOTATIONS", "Notation"]

_SWAPPED: Final = [3, 4, 5, 0, 1, 2]


@dataclass(frozen=True, slots=True)
class Notation:
    """How a book writes things; `{}` and the like stand for indices.

    Attributes:
        book: what to cite.
        angular_first: whether twists are (ω, v).
        twist: a joint's screw axis.
        exponential: e to a screw axis times the joint's value.
        equations: the numbers of the book's equations, by topic.
    """

    book: str
    angular_first: bool
    pose: str
    pose_rate: str
    home: str
    twist: str
    twist_hat: str
    hat: str
    spatial_column: str
    body_column: str
    spatial: str
    body: str
    hybrid: str
    spatial_velocity: str
    spatial_velocity_hat: str
    body_velocity: str
    body_velocity_hat: str
    hybrid_velocity: str
    order: str
    adjoint: str
    equations: dict[str, str]

    def exponential(self, number: int, value: str) -> str:
        """e^{ξ̂i θi}."""
        return rf"e^{{{self.twist_hat.format(number)} {value}}}"

    def rows(self, matrix: Any) -> Any:
        """A twist (6, 1) or Jacobian (6, n) with its rows in the book's order."""
        return matrix.extract(_SWAPPED, list(range(matrix.cols))) if self.angular_first else matrix

    def both(self, matrix: Any) -> sp.Matrix:
        """An adjoint (6, 6) in the book's order."""
        return matrix.extract(_SWAPPED, _SWAPPED) if self.angular_first else matrix


NOTATIONS: Final[dict[Convention, Notation]] = {
    "mls": Notation(
        book="Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, 1994",
        angular_first=False,
        pose=r"g(\theta)",
        pose_rate=r"\dot{g}",
        home="g(0)",
        twist=r"\xi_{{{}}}",
        twist_hat=r"\hat{{\xi}}_{{{}}}",
        hat=r"\hat{{{}}}",
        spatial_column=r"\xi'_{{{}}}",
        body_column=r"\xi^{{\dagger}}_{{{}}}",
        spatial="J^{s}",
        body="J^{b}",
        hybrid="J^{h}",
        spatial_velocity="V^{s}",
        spatial_velocity_hat=r"\hat{V}^{s}",
        body_velocity="V^{b}",
        body_velocity_hat=r"\hat{V}^{b}",
        hybrid_velocity="V^{h}",
        order="(v, ω)",
        adjoint=r"\begin{bmatrix} R & \hat{p} R \\ 0 & R \end{bmatrix}",
        equations={
            "twist": "§2.3.3",
            "exponential": "eq. 2.36",
            "pose": "eq. 3.3",
            "inverse": "eq. 2.24",
            "body": "eq. 3.55",
            "spatial": "eq. 3.54",
            "velocity": "eq. 2.55",
            "spatial-velocity": "eq. 2.53",
            "spatial-sum": "proposition 2.14",
            "body-sum": "proposition 2.15",
            "adjoint": "eq. 2.58",
        },
    ),
    "lynch-park": Notation(
        book="Lynch, Park, Modern Robotics, 2017",
        angular_first=True,
        pose=r"T(\theta)",
        pose_rate=r"\dot{T}",
        home="M",
        twist=r"\mathcal{{S}}_{{{}}}",
        twist_hat=r"[\mathcal{{S}}_{{{}}}]",
        hat="{{[{}]}}",
        spatial_column="J_{{s{}}}",
        body_column="J_{{b{}}}",
        spatial="J_{s}",
        body="J_{b}",
        hybrid="J_{h}",
        spatial_velocity=r"\mathcal{V}_{s}",
        spatial_velocity_hat=r"[\mathcal{V}_{s}]",
        body_velocity=r"\mathcal{V}_{b}",
        body_velocity_hat=r"[\mathcal{V}_{b}]",
        hybrid_velocity=r"\mathcal{V}_{h}",
        order="(ω, v)",
        adjoint=r"\begin{bmatrix} R & 0 \\ {[p]} R & R \end{bmatrix}",
        equations={
            "twist": "§3.3.2",
            "exponential": "eq. 3.88",
            "pose": "eq. 4.14",
            "inverse": "eq. 3.64",
            "body": "§5.1.2",
            "spatial": "§5.1.1",
            "velocity": "§3.3.2",
            "spatial-velocity": "§3.3.2",
            "spatial-sum": "§3.3.2",
            "body-sum": "§3.3.2",
            "adjoint": "§3.3.2",
        },
    ),
}
