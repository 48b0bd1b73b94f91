"""How poses are written down: matrices, or positions beside quaternions, rotation vectors or three angles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from pinscrew.ground.typing import FloatArray
from pinscrew.identification import turns
from pinscrew.identification.writings import UNITS
from pinscrew.lie import se3, so3

__all__ = ["Encoding", "encodings"]

Form: TypeAlias = Literal[
    "matrix", "inverse", "transposed", "quaternion xyzw", "quaternion wxyz", "rotation vector", "angles"
]

VENDORS: Final = {
    ("rotation vector", "", "rad"): "UR",
    ("angles", "ZYX", "deg"): "KUKA A B C",
    ("angles", "xyz", "deg"): "Fanuc W P R, Yaskawa",
    ("angles", "xyz", "rad"): "ROS roll pitch yaw",
    ("angles", "XYZ", "deg"): "Stäubli Rx Ry Rz",
    ("angles", "ZYZ", "deg"): "Kawasaki O A T, Doosan",
    ("quaternion wxyz", "", "rad"): "ABB, MuJoCo",
    ("quaternion xyzw", "", "rad"): "ROS, scipy",
}
"""Who writes poses so; angles of small letters are about fixed axes, of capitals about axes that move along."""


@dataclass(frozen=True)
class Encoding:
    """A way to write a pose.

    Attributes:
        form: what the rotation is, or that it is a matrix.
        sequence: of three angles.
        angle: of rotation vectors and angles.
        unit: of length.
        order: whether the position or the rotation comes first.
    """

    form: Form
    sequence: str = ""
    angle: Literal["rad", "deg"] = "rad"
    unit: str = "m"
    order: Literal["p,r", "r,p"] = "p,r"

    @property
    def name(self) -> str:
        """What it is called, with who uses it."""
        vendor = VENDORS.get((self.form, self.sequence, self.angle), "")
        kept = {"matrix": "4×4 matrix", "inverse": "inverse of the 4×4 matrix", "transposed": "transposed 4×4 matrix"}
        said = kept.get(self.form, f"{self.form} {self.sequence}".rstrip())
        said += " in degrees" if self.angle == "deg" else ""
        said += f" ({vendor})" if vendor else ""
        said += "" if self.unit == "m" else f", in {self.unit}"
        return said + (", position last" if self.order == "r,p" else "")

    @property
    def cost(self) -> int:
        """How far from the plainest."""
        known = (self.form, self.sequence, self.angle) in VENDORS or self.form == "matrix"
        return 3 * (not known) + 2 * (self.unit != "m") + 2 * (self.order != "p,r") + (self.form != "matrix")

    def decode(self, values: FloatArray) -> FloatArray | None:
        """The poses that are written so, shape (N, 4, 4); None where they can't be."""
        scale = UNITS[self.unit]
        if values.ndim == 3:
            T = np.swapaxes(values, -1, -2) if self.form == "transposed" else values
            if abs(T[:, 3] - np.array([0.0, 0.0, 0.0, 1.0])).max() > 1e-12:
                return None
            T = T.copy()
            T[:, :3, 3] *= scale
            return _inverse(T) if self.form == "inverse" else T
        position, rotation = (values[:, :3], values[:, 3:]) if self.order == "p,r" else (values[:, -3:], values[:, :-3])
        T = np.tile(np.eye(4), (len(values), 1, 1))
        T[:, :3, 3] = scale * position
        T[:, :3, :3] = self._rotation(rotation)
        return T

    def encode(self, T: FloatArray) -> FloatArray:
        """Poses written so: what `decode` reads."""
        scaled = _inverse(T) if self.form == "inverse" else T.copy()
        scaled[:, :3, 3] /= UNITS[self.unit]
        if self.form in ("matrix", "inverse", "transposed"):
            return np.swapaxes(scaled, -1, -2) if self.form == "transposed" else scaled
        R = T[:, :3, :3]
        per = np.pi / 180.0 if self.angle == "deg" else 1.0
        if self.form == "angles":
            rotation = turns.to_angles(self.sequence, R) / per
        else:
            rotation = np.asarray(so3.log(R)) / per
            if self.form != "rotation vector":
                rotation = turns.to_quaternion(rotation)
                rotation = rotation[:, [3, 0, 1, 2]] if self.form == "quaternion wxyz" else rotation
        parts = [scaled[:, :3, 3], rotation]
        return np.concatenate(parts if self.order == "p,r" else parts[::-1], axis=1)

    def _rotation(self, given: FloatArray) -> FloatArray:
        per = np.pi / 180.0 if self.angle == "deg" else 1.0
        if self.form == "angles":
            return turns.from_angles(self.sequence, per * given)
        if self.form == "rotation vector":
            return np.asarray(so3.exp(per * given))
        return turns.from_quaternion(given[:, [1, 2, 3, 0]] if self.form == "quaternion wxyz" else given)


def encodings(shape: tuple[int, ...]) -> Iterator[Encoding]:
    """All that a pose of this shape may be in."""
    for unit in UNITS:
        if shape == (4, 4):
            yield from (Encoding(form, unit=unit) for form in ("matrix", "inverse", "transposed"))
            continue
        for order in ("p,r", "r,p"):
            if shape == (7,):
                yield Encoding("quaternion xyzw", unit=unit, order=order)
                yield Encoding("quaternion wxyz", unit=unit, order=order)
                continue
            for angle in ("rad", "deg"):
                yield Encoding("rotation vector", "", angle, unit, order)
                for sequence in turns.SEQUENCES:
                    yield Encoding("angles", sequence, angle, unit, order)
                    yield Encoding("angles", sequence.upper(), angle, unit, order)


def _inverse(T: FloatArray) -> FloatArray:
    """T⁻¹, with the position as R⁻¹ p whatever its unit."""
    return np.asarray(se3.inverse(T))
