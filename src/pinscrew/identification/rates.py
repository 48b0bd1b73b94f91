"""Rates of what an orientation is written with, in place of ω: the rows of analytic Jacobians."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pinscrew.ground.typing import FloatArray
from pinscrew.identification import turns
from pinscrew.identification.encodings import Encoding
from pinscrew.lie import so3

__all__ = ["rated", "rates_of"]

LOCKED = 1e-9
"""Where the axes of three angles are so nearly in a plane, their rates are not known."""


def rated(rows: int) -> Iterator[Encoding]:
    """What rates a Jacobian may have instead of ω: with seven rows those of a quaternion."""
    if rows == 7:
        yield Encoding("quaternion xyzw")
        yield Encoding("quaternion wxyz")
        return
    for angle in ("rad", "deg"):
        yield Encoding("rotation vector", "", angle)
        for sequence in turns.SEQUENCES:
            yield Encoding("angles", sequence, angle)
            yield Encoding("angles", sequence.upper(), angle)


def rates_of(encoding: Encoding, R: FloatArray) -> FloatArray:
    """What turns ω, in the axes of the base, into the rates of the encoding at R; shape (N, 3 or 4, 3).

    Three angles: ω = e₁ȧ + R₁ e₂ ḃ + R₁R₂ e₃ ċ (Siciliano et al. 2009, sec. 3.6), solved for the rates; NaN where the
    three axes lie in a plane. A rotation vector r: ω = J_l(r) ṙ (Barfoot 2017, eq. 7.76). A quaternion (v, w), w ≥ 0:
    v̇ = (w ω + ω × v) / 2 and ẇ = -ω·v / 2 (Diebel 2006, eq. 110).
    """
    if encoding.form == "angles":
        turn = _of_angles(encoding.sequence, R)
    elif encoding.form == "rotation vector":
        turn = np.asarray(so3.left_jacobian_inverse(so3.log(R)))
    else:
        xyzw = turns.to_quaternion(np.asarray(so3.log(R)))
        v, w = xyzw[:, :3], xyzw[:, 3]
        of_v = w[:, None, None] * np.eye(3) - np.asarray(so3.hat(v))
        parts = [of_v, -v[:, None, :]]
        return np.concatenate(parts if encoding.form == "quaternion xyzw" else parts[::-1], axis=1) / 2.0
    return turn * (180.0 / np.pi if encoding.angle == "deg" else 1.0)


def _of_angles(sequence: str, R: FloatArray) -> FloatArray:
    angles = turns.to_angles(sequence, R)
    order = (0, 1, 2) if sequence.isupper() else (2, 1, 0)  # about fixed axes, the last turn is the outermost
    before, columns = np.broadcast_to(np.eye(3), R.shape), [np.zeros((len(R), 3))] * 3
    for k in order:
        columns[k] = before[:, :, "xyz".index(sequence[k].lower())]
        before = before @ turns.from_angles(sequence[k].upper(), angles[:, k : k + 1])
    axes = np.stack(columns, axis=-1)
    locked = abs(np.linalg.det(axes)) < LOCKED
    axes[locked] = np.eye(3)
    found = np.linalg.inv(axes)
    found[locked] = np.nan
    return np.asarray(found)
