"""What an engine says of the quantities in which the printed courseworks have mistakes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pinscrew.derivation.errata_entries import Erratum
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3

__all__ = ["truth"]


def truth(engine: Any, erratum: Erratum, q: FloatArray, qd: FloatArray, delta: FloatArray) -> FloatArray:
    """A quantity by an engine, shape (N, rows, columns); or its size, shape (N, 1, 1).

    Args:
        engine: the engine.
        erratum: names the quantity and its frames.
        q: coordinates, shape (N, nq).
        qd: velocities, shape (N, nv).
        delta: steps of joint 1, shape (N,).
    """
    what = erratum.quantity
    for dimension, axis in (("rows of ", 1), ("columns of ", 2)):
        if what.startswith(dimension):
            size = _matrix(engine, erratum, what.removeprefix(dimension), q, qd, delta).shape[axis]
            return np.full((len(q), 1, 1), float(size))
    return _matrix(engine, erratum, what, q, qd, delta)


def _matrix(engine: Any, erratum: Erratum, what: str, q: FloatArray, qd: FloatArray, delta: FloatArray) -> FloatArray:
    zero = np.zeros_like(q)
    column = erratum.joint - 1
    frame, reference = erratum.frame or None, erratum.reference or engine.robot.base

    def pose(at: FloatArray) -> FloatArray:
        there = np.array(at)
        there[:, : max(column, 0)] = 0.0  # g_i is g with the joints before i at zero, for e^0 = I
        return np.asarray(se3.inverse(engine.fk(there, reference)) @ engine.fk(there, frame))

    def home() -> FloatArray:
        return pose(zero)

    def twists() -> FloatArray:
        J = engine.jacobian(zero, frame, "spatial")
        return np.asarray(se3.adjoint(se3.inverse(engine.fk(zero, reference))) @ J)

    def pitch() -> FloatArray:  # how far the tool advances along the screw for each radian that it turns
        moved = se3.log(se3.inverse(engine.fk(zero)) @ engine.fk(zero + 0.3))
        return np.asarray((moved[:, 2] / moved[:, 5])[:, None, None])

    def axis_point() -> FloatArray:  # ω × v of a twist of magnitude 1: the axis's point nearest to the origin
        xi = twists()[:, :, column]
        return np.asarray(np.cross(xi[:, 3:], xi[:, :3])[:, :, None])

    def lever() -> FloatArray:  # from the joint to the tool, in the axes of the base
        return np.asarray((engine.fk(q)[:, :3, 3] - engine.fk(q, frame)[:, :3, 3])[:, :, None])

    def mirrored() -> FloatArray:  # det(R diag(1, 1, -1)): its columns are orthonormal, too
        return np.asarray(np.linalg.det(pose(q)[:, :3, :3] * np.array([1.0, 1.0, -1.0]))[:, None, None])

    def step() -> FloatArray:
        return np.asarray(engine.fk(np.concatenate([q[:, :1] + delta[:, None], q[:, 1:]], axis=1)))

    simple: dict[str, Callable[[], Any]] = {
        "home": home,
        "twist": twists,
        "step": step,
        "pitch": pitch,
        "axis point": axis_point,
        "lever": lever,
        "mirrored determinant": mirrored,
        "pose": lambda: pose(q),
        "position": lambda: pose(q)[:, :3, 3:],
        "inverse": lambda: se3.inverse(pose(q)),
        "rate": lambda: se3.hat(engine.velocity(q, qd, None, "spatial")) @ engine.fk(q),
        "body hat": lambda: se3.hat(engine.velocity(q, qd, None, "body")),
        "adjoint inverse": lambda: se3.adjoint(se3.inverse(pose(q))),
        "corner of the adjoint inverse": lambda: se3.adjoint(se3.inverse(pose(q)))[:, :3, 3:],  # -Rᵀp̂
        "position hat": lambda: so3.hat(pose(q)[:, :3, 3]),
        "axis": lambda: engine.jacobian(q, frame, "hybrid")[:, 3:, column : column + 1],
        "axis hat": lambda: so3.hat(engine.jacobian(q, frame, "hybrid")[:, 3:, column]),
    }
    if what in simple:
        return np.asarray(simple[what]())
    kind, _, name = what.partition(" ")
    if name == "Jacobian":
        return np.asarray(engine.jacobian(q, frame, kind))
    return np.asarray(engine.velocity(q, qd, frame, kind))[:, :, None]
