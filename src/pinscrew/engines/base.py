"""What every engine answers, and the checking of what it is asked."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from pinscrew.engines.answers import Answers, Bound, JointView
from pinscrew.engines.asking import long_way
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import KINDS, ArrayLike, FloatArray, JacobianKind, KindLike, jacobian_kind
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.manifold import quaternion_starts
from pinscrew.robot.robot import Robot

__all__ = ["Answers", "Bound", "CheckedEngine", "Engine", "JointView"]

QUATERNION_TOLERANCE: Final = 1e-6
"""How far from 1 a quaternion's norm may be (float32 rounding); within it, it is normalised."""


class Engine(Protocol):
    """Kinematics of one robot. Arrays have leading batch axes ``...``, the same in as out.

    ``frame`` is a link's name, None for the robot's tip. Twists and Jacobian rows are (v, ω), in m and rad.
    """

    @property
    def name(self) -> str:
        """What to call the engine in a report."""

    @property
    def robot(self) -> Robot:
        """The robot it was made for."""

    def fk(self, q: ArrayLike, frame: str | None = None) -> FloatArray:
        """Pose of ``frame`` in the base: ``q`` (..., nq) to (..., 4, 4)."""

    def jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Jacobian of ``frame``: ``q`` (..., nq) to (..., 6, nv)."""

    def fk_jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> tuple[FloatArray, FloatArray]:
        """Pose and Jacobian of ``frame``: ``q`` (..., nq) to (..., 4, 4) and (..., 6, nv)."""

    def bind(self, frame: str | None, kind: KindLike) -> Bound:
        """A question about one configuration at a time, with all that does not depend on it checked once."""

    def jacobian_derivative(self, q: ArrayLike, qd: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Time derivative of the Jacobian: ``q`` (..., nq) and ``qd`` (..., nv) to (..., 6, nv)."""

    def velocity(self, q: ArrayLike, qd: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Twist of ``frame``: ``q`` (..., nq) and ``qd`` (..., nv) to (..., 6)."""

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        """Everything about ``frames`` in one pass: ``q`` (N, nq) and ``qd`` (N, nv)."""

    def joints(self) -> Mapping[str, JointView]:
        """The joints as the engine's parser saw them, by name."""


class CheckedEngine(ABC):
    """An `Engine` whose questions are checked here and answered by its subclass, one flat batch at a time."""

    name: str

    def __init__(self, robot: RobotLike) -> None:
        self._robot = robot_of(robot)
        self._quaternions = quaternion_starts(self._robot)

    def __repr__(self) -> str:
        return f"<{self.name} of {self._robot.name!r}>"

    @property
    def robot(self) -> Robot:
        """The robot the engine was made for."""
        return self._robot

    def fk(self, q: ArrayLike, frame: str | None = None) -> FloatArray:
        """Pose of ``frame`` in the base frame.

        Args:
            q: coordinates, shape (..., nq), rad and m.
            frame: a link's name; by default the robot's tip.

        Returns:
            T_base_frame, shape (..., 4, 4).

        Raises:
            InputError: if ``q`` has another shape or holds what is no finite number.
            UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        """
        frame = self._robot.frame(frame)
        flat, batch = self._coordinates(q)
        return self._poses(flat, frame).reshape(*batch, 4, 4)

    def jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Jacobian of ``frame``: the twist (v, ω) per unit of each velocity.

        Args:
            q: coordinates, shape (..., nq), rad and m.
            frame: a link's name; by default the robot's tip.
            kind: ``"spatial"``, ``"body"`` or ``"hybrid"``, or Pinocchio's name for it; see `pinscrew.ground.typing`.

        Returns:
            shape (..., 6, nv).

        Raises:
            InputError: if ``q`` has another shape or holds what is no finite number, or there is no such kind.
            UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        """
        frame, kind = self._robot.frame(frame), jacobian_kind(kind)
        flat, batch = self._coordinates(q)
        return self._jacobians(flat, frame, kind).reshape(*batch, 6, self._robot.nv)

    def fk_jacobian(self, q: ArrayLike, frame: str | None, kind: KindLike) -> tuple[FloatArray, FloatArray]:
        """Pose and Jacobian of ``frame``: `fk` and `jacobian`, which engines may do in one pass."""
        frame, kind = self._robot.frame(frame), jacobian_kind(kind)
        flat, batch = self._coordinates(q)
        poses, jacobians = self._poses_and_jacobians(flat, frame, kind)
        return poses.reshape(*batch, 4, 4), jacobians.reshape(*batch, 6, self._robot.nv)

    def bind(self, frame: str | None, kind: KindLike) -> Bound:
        """A question about one configuration at a time, with all that does not depend on it checked once.

        Args:
            frame: a link's name; None for the robot's tip.
            kind: see `jacobian`.

        Returns:
            ``ask``, for ``T, J = ask(q)``: what `fk_jacobian` says of one configuration, q of shape (nq,). With
            ``out=(T, J)``, arrays of shapes (4, 4) and (6, nv), it writes there. It may be called from several
            threads, and needs nobody to keep the engine. It raises `InputError` as `fk_jacobian` does.

        Raises:
            InputError, UnknownNameError, AmbiguousTipError: see `jacobian`.
        """
        name, kind = self._robot.frame(frame), jacobian_kind(kind)
        return self._bound(name, kind, long_way(self._robot, lambda q: self.fk_jacobian(q, name, kind)))

    def _bound(self, frame: str, kind: JacobianKind, rest: Bound) -> Bound:  # noqa: ARG002 (for those who know better)
        """A bound question; an engine's short way leaves to ``rest`` all that is no good array of float64."""
        return rest

    def jacobian_derivative(self, q: ArrayLike, qd: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Time derivative of the Jacobian along the velocities ``qd``.

        Args:
            q: coordinates, shape (..., nq), rad and m.
            qd: velocities, shape (..., nv), rad/s and m/s; batch axes broadcast against those of ``q``.
            frame: a link's name; by default the robot's tip.
            kind: see `jacobian`.

        Returns:
            shape (..., 6, nv).

        Raises:
            InputError, UnknownNameError, AmbiguousTipError: see `jacobian`.
        """
        frame, kind = self._robot.frame(frame), jacobian_kind(kind)
        flat, flat_rates, batch = self._motion(q, qd)
        return self._derivatives(flat, flat_rates, frame, kind).reshape(*batch, 6, self._robot.nv)

    def velocity(self, q: ArrayLike, qd: ArrayLike, frame: str | None, kind: KindLike) -> FloatArray:
        """Twist (v, ω) of ``frame``: spatial, body or hybrid.

        Args:
            q, qd, frame, kind: see `jacobian_derivative`.

        Returns:
            shape (..., 6), m/s and rad/s.

        Raises:
            InputError, UnknownNameError, AmbiguousTipError: see `jacobian`.
        """
        frame, kind = self._robot.frame(frame), jacobian_kind(kind)
        flat, flat_rates, batch = self._motion(q, qd)
        return self._velocities(flat, flat_rates, frame, kind).reshape(*batch, 6)

    def answers(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> Answers:
        """Everything about ``frames`` at a flat batch; the general way, which engines shorten.

        Args:
            q, qd: shapes (N, nq) and (N, nv).
            frames: names of F links.

        Raises:
            InputError, UnknownNameError: see `jacobian`.
        """
        q, qd, names = self._asked(q, qd, frames)
        return Answers(
            np.stack([self._poses(q, name) for name in names], axis=1),
            {kind: np.stack([self._jacobians(q, n, kind) for n in names], axis=1) for kind in KINDS},
            {kind: np.stack([self._derivatives(q, qd, n, kind) for n in names], axis=1) for kind in KINDS},
        )

    @abstractmethod
    def joints(self) -> Mapping[str, JointView]:
        """The joints as the engine's parser saw them, by name."""

    @abstractmethod
    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        """(N, nq) to (N, 4, 4)."""

    @abstractmethod
    def _jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        """(N, nq) to (N, 6, nv)."""

    def _poses_and_jacobians(self, q: FloatArray, frame: str, kind: JacobianKind) -> tuple[FloatArray, FloatArray]:
        """(N, nq) to (N, 4, 4) and (N, 6, nv); the general way, which engines shorten."""
        return self._poses(q, frame), self._jacobians(q, frame, kind)

    @abstractmethod
    def _derivatives(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        """(N, nq) and (N, nv) to (N, 6, nv)."""

    def _velocities(self, q: FloatArray, qd: FloatArray, frame: str, kind: JacobianKind) -> FloatArray:
        """(N, nq) and (N, nv) to (N, 6); by the Jacobian, unless an engine knows better."""
        return (self._jacobians(q, frame, kind) @ qd[:, :, None])[:, :, 0]

    def _coordinates(self, q: ArrayLike) -> tuple[FloatArray, tuple[int, ...]]:
        """``q`` as a flat batch, and its batch axes."""
        checked = self._finite(q, "q", self._robot.nq, self._robot.coordinate_names)
        return self._with_unit_quaternions(_flat(checked)), checked.shape[:-1]

    def _motion(self, q: ArrayLike, qd: ArrayLike) -> tuple[FloatArray, FloatArray, tuple[int, ...]]:
        """``q`` and ``qd`` as flat batches of one length, and their common batch axes."""
        coordinates = self._finite(q, "q", self._robot.nq, self._robot.coordinate_names)
        rates = self._finite(qd, "qd", self._robot.nv, self._robot.velocity_names)
        try:
            batch = np.broadcast_shapes(coordinates.shape[:-1], rates.shape[:-1])
        except ValueError:
            what = f"the batch axes of q {coordinates.shape[:-1]} and qd {rates.shape[:-1]} do not broadcast"
            raise InputError("shape", what, where=self._robot.name) from None
        flat, _ = self._coordinates(np.broadcast_to(coordinates, (*batch, self._robot.nq)))
        return flat, _flat(np.broadcast_to(rates, (*batch, self._robot.nv))), batch

    def _asked(self, q: FloatArray, qd: FloatArray, frames: Sequence[str]) -> tuple[FloatArray, FloatArray, list[str]]:
        """What `answers` was asked, checked to be one flat batch and frames that exist."""
        flat, flat_rates, batch = self._motion(q, qd)
        if len(batch) != 1:
            what = f"q and qd have the batch axes {batch}"
            raise InputError("shape", what, where=self._robot.name, remedy="give one axis of N configurations")
        return flat, flat_rates, [self._robot.frame(frame) for frame in frames]

    def _finite(self, values: ArrayLike, symbol: str, n: int, names: tuple[str, ...]) -> FloatArray:
        array = self._shaped(values, symbol, n, names).astype(np.float64, copy=False)
        self._refuse_not_finite(array, symbol, names)
        return array

    def _shaped(self, values: ArrayLike, symbol: str, n: int, names: tuple[str, ...]) -> NDArray[Any]:
        """An array of numbers of the right shape, of the type that it came in."""
        try:
            given = np.asarray(values)
        except ValueError as error:  # rows of different lengths
            what = f"{symbol} is not an array of numbers ({error})"
            raise InputError("not-numbers", what, where=self._robot.name) from None
        if given.dtype.kind not in "fiu":
            what = f"{symbol} is not an array of numbers but of {given.dtype}"
            raise InputError("not-numbers", what, where=self._robot.name)
        if given.ndim == 0 or given.shape[-1] != n:
            listed = ", ".join(names) if len(names) <= 12 else f"{', '.join(names[:12])}, …"
            what = f"{symbol} has shape {given.shape}"
            remedy = f"expected (..., {n}): {listed}" if n else "expected (..., 0): the robot has no coordinates"
            raise InputError("shape", what, where=self._robot.name, remedy=remedy)
        return given

    def _refuse_not_finite(self, array: NDArray[Any], symbol: str, names: tuple[str, ...]) -> None:
        if not (finite := np.isfinite(array)).all():
            index = tuple(int(i) for i in np.argwhere(~finite)[0])
            what = f"{symbol} holds {array[index]} at index {index} ({names[index[-1]]})"
            raise InputError("not-finite", what, where=self._robot.name, remedy="give finite numbers")

    def _with_unit_quaternions(self, q: FloatArray) -> FloatArray:
        q = q.copy() if self._quaternions else q
        for start in self._quaternions:
            norms = np.linalg.norm(q[:, start : start + 4], axis=1, keepdims=True)
            if (abs(norms - 1.0) > QUATERNION_TOLERANCE).any():
                worst = float(norms[abs(norms - 1.0).argmax(), 0])
                name = self._robot.coordinate_names[start].removesuffix(".qx")
                what = f"the quaternion (x, y, z, w) of {name!r} has norm {worst:g}"
                raise InputError("quaternion", what, where=self._robot.name, remedy="normalise it")
            q[:, start : start + 4] /= norms
        return q


def _flat(array: FloatArray) -> FloatArray:
    """All batch axes as one; written so that it also tells the length of N times nothing."""
    return array.reshape(math.prod(array.shape[:-1]), array.shape[-1])
