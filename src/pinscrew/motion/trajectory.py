"""What an integration answers: coordinates, poses and twists over time, and how far the poses drifted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinscrew.ground.typing import FloatArray
from pinscrew.lie import so3
from pinscrew.robot.robot import Robot

__all__ = ["Drift", "Trajectory"]


@dataclass(frozen=True, eq=False)
class Drift:
    """How far integrated poses are from rotations, and from the pose of the integrated coordinates.

    Attributes:
        orthogonality: ‖RᵀR - I‖ (Frobenius), shape (K + 1,).
        column_lengths: lengths of the columns of R, shape (K + 1, 3).
        position: distance (m) from the position that forward kinematics gives, shape (K + 1,).
        angle: angle (rad) between the rotation nearest to R and the one that forward kinematics gives, (K + 1,).
    """

    orthogonality: FloatArray
    column_lengths: FloatArray
    position: FloatArray
    angle: FloatArray

    @classmethod
    def of(cls, poses: FloatArray, references: FloatArray) -> Drift:
        """The drift of ``poses`` from the ``references`` of forward kinematics, both (K + 1, 4, 4)."""
        R, R_reference = poses[:, :3, :3], references[:, :3, :3]
        gram = np.swapaxes(R, -1, -2) @ R
        return cls(
            orthogonality=np.linalg.norm(gram - np.eye(3), axis=(-2, -1)),
            column_lengths=np.linalg.norm(R, axis=-2),
            position=np.linalg.norm(poses[:, :3, 3] - references[:, :3, 3], axis=-1),
            angle=np.linalg.norm(so3.log(np.swapaxes(R_reference, -1, -2) @ so3.project(R)), axis=-1),
        )


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory:
    """A motion in K steps of ``dt`` seconds; `pinscrew.integrate` makes one.

    Attributes:
        robot: what moves.
        frame: the frame whose pose is integrated.
        scheme: how.
        dt: the step (s).
        t: times (s), shape (K + 1,).
        q: coordinates (rad and m), shape (K + 1, nq).
        qd: the given rates (rad/s and m/s) at these times, shape (K + 1, nv).
        poses: integrated T_base_frame, shape (K + 1, 4, 4). What `coursework` makes are no rigid motions.
        twists: hybrid velocities ξ = Jʰ(q) θ̇ = (v, ω) (m/s and rad/s), shape (K + 1, 6).
        drift: how far the poses are from rotations and from forward kinematics.
    """

    robot: Robot
    frame: str
    scheme: str
    dt: float
    t: FloatArray
    q: FloatArray
    qd: FloatArray
    poses: FloatArray
    twists: FloatArray
    drift: Drift

    def __repr__(self) -> str:
        end = f"{self.t[0]:g} to {self.t[-1]:g} s"
        return f"<Trajectory of {self.frame!r} of {self.robot.name!r}: {self.scheme}, {self.steps} steps, {end}>"

    @property
    def steps(self) -> int:
        """How many steps there are: K."""
        return len(self.t) - 1

    @property
    def increments(self) -> FloatArray:
        """Pose increments (dx, δφ) = ξ δt (m and rad) at each time, shape (K + 1, 6)."""
        return self.twists * self.dt
