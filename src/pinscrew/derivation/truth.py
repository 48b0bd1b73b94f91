"""What an engine says of each quantity of a derivation, at a few random configurations with random lengths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
import sympy as sp

from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.proof import relative, variant
from pinscrew.engines.base import Answers
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray, KindLike, jacobian_kind
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

__all__ = ["Drawn", "Truth", "draw"]

SAMPLES: Final = 2


@dataclass(frozen=True)
class Drawn:
    """Random lengths, values and rates, and the robots that have these lengths.

    Attributes:
        lengths: by symbol (m, or a number).
        q: values of the coordinates, shape (N, m).
        qd: their rates, shape (N, m).
        values: of each joint that moves the frame, without its offset, shape (N, n).
        rates: of each of them, shape (N, n).
        robot: joints that follow others do.
        free: every joint moves on its own.
        offsets: of the joints that move the frame where their values are 0, shape (n,).
        others: values and rates, shapes (N,), of the joints that were read for other frames.
    """

    lengths: Mapping[sp.Symbol, float]
    q: FloatArray
    qd: FloatArray
    values: FloatArray
    rates: FloatArray
    robot: Robot
    free: Robot
    offsets: FloatArray
    others: Mapping[str, tuple[FloatArray, FloatArray]]


def draw(d: ClosedForms, seed: int) -> Drawn:
    """Random values for everything, such that no two are alike by chance."""
    rng = np.random.default_rng(seed)
    lengths = {s: float(rng.uniform(0.6, 1.4)) * (float(v) or 1.0) for s, v in d.lengths.items()}
    q = rng.uniform(0.3, 1.4, (SAMPLES, len(d.coordinates))) * rng.choice([-1.0, 1.0], (SAMPLES, len(d.coordinates)))
    qd = rng.uniform(0.3, 1.4, q.shape)
    order = [variable.symbol for variable in d.coordinates]
    columns = [order.index(joint.master.symbol) for joint in d.chain.joints]
    factors = np.array([float(joint.multiplier.xreplace(lengths)) for joint in d.chain.joints])
    by_name = {joint.name: joint for joint in d.geometry}
    offsets = [float(sp.sympify(by_name[j.variable.joint].offset).xreplace(lengths)) for j in d.chain.joints]
    robot = variant(d, lengths)
    free = variant(d, lengths, follow=False) if d.follows else robot
    given = np.array(offsets) if d.follows else np.zeros(len(offsets))
    others = _others(d, lengths, q, qd, rng)
    return Drawn(lengths, q, qd, q[:, columns] * factors, qd[:, columns] * factors, robot, free, given, others)


def _others(
    d: ClosedForms, lengths: Mapping[sp.Symbol, float], q: FloatArray, qd: FloatArray, rng: np.random.Generator
) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Of joints that do not move the frame, but others that were read with it."""
    known = {variable.joint: (q[:, i], qd[:, i]) for i, variable in enumerate(d.coordinates)}
    own = {joint.variable.joint for joint in d.chain.joints} | set(known)
    others: dict[str, tuple[FloatArray, FloatArray]] = {}
    for joint in d.geometry:
        if joint.type == "fixed" or joint.name in own:
            continue
        if joint.master not in known:
            known[joint.master] = (rng.uniform(0.3, 1.4, len(q)), rng.uniform(0.3, 1.4, len(q)))
        factor = float(sp.sympify(joint.multiplier).xreplace(dict(lengths)))
        values, rates = known[joint.master]
        others[joint.name] = (factor * values, factor * rates)
    return others


class Truth:
    """Quantities by one engine, each of shape (N, rows, columns); twists are (v, ω)."""

    def __init__(self, engine: type, d: ClosedForms, drawn: Drawn) -> None:
        """Ask ``engine`` about ``drawn``, a draw of the derivation ``d``."""
        self._engine, self._d, self._drawn = engine, d, drawn
        self.name = engine.__name__
        self.joints = len(d.chain.joints)

    def at(self, values: Sequence[float | None]) -> Truth:
        """The same question, with these values of the coordinates; None keeps one as it was drawn."""
        q = self._drawn.q.copy()
        if len(values) != q.shape[1]:
            raise InputError("formula", f"{len(values)} values for {q.shape[1]} coordinates")
        for column, value in enumerate(values):
            if value is not None:
                q[:, column] = value
        return Truth(self._engine, self._d, replace(self._drawn, q=q))

    def _ask(self, robot: Robot, named: Mapping[str, FloatArray], count: int, frames: Sequence[str] = ()) -> Answers:
        q, qd = np.zeros((count, robot.nq)) + robot.neutral, np.zeros((count, robot.nv))
        for name, values in named.items():
            q[:, robot.coordinate_names.index(name)] = values
        found: Answers = self._engine(robot).answers(q, qd, frames or [self._d.tip, self._d.reference])
        return found

    @cached_property
    def _free(self) -> tuple[FloatArray, Mapping[Any, FloatArray]]:
        """Poses and Jacobians of the free robot: at home, with each joint alone, and with all, N of each."""
        values, n = self._drawn.values, self.joints
        alone = [np.where(np.arange(n) == i, values, 0.0) for i in range(n)]
        stacked = np.concatenate([np.zeros_like(values), *alone, values]) + self._drawn.offsets
        names = [joint.variable.joint for joint in self._d.chain.joints]
        return relative(self._ask(self._drawn.free, dict(zip(names, stacked.T, strict=True)), len(stacked)))

    @cached_property
    def _moving(self) -> tuple[FloatArray, Mapping[Any, FloatArray]]:
        names = [variable.joint for variable in self._d.coordinates]
        q = self._drawn.q
        pose, jacobians = relative(self._ask(self._drawn.robot, dict(zip(names, q.T, strict=True)), len(q)))
        columns = [self._drawn.robot.velocity_names.index(name) for name in names]
        return pose, {kind: J[:, :, columns] for kind, J in jacobians.items()}

    def _columns(self, kind: str, place: int) -> FloatArray:
        """Of the joints that move the frame, where the free robot was asked the ``place``-th time."""
        robot = self._drawn.free
        columns = [robot.velocity_names.index(joint.variable.joint) for joint in self._d.chain.joints]
        N = len(self._drawn.q)
        return np.asarray(self._free[1][kind][place * N : (place + 1) * N][:, :, columns])

    @property
    def home(self) -> FloatArray:
        """g(0)."""
        return self._free[0][: len(self._drawn.q)]

    @property
    def pose(self) -> FloatArray:
        """g."""
        return self._moving[0]

    def exponential(self, i: int) -> FloatArray:
        """e^{ξ̂i θi} = g(0, …, θi, …, 0) g(0)⁻¹."""
        N = len(self._drawn.q)
        return np.asarray(self._free[0][i * N : (i + 1) * N] @ se3.inverse(self.home))

    def tail(self, i: int) -> FloatArray:
        """g_i = e^{ξ̂i θi} … e^{ξ̂n θn} g(0)."""
        found = self.home
        for k in range(self.joints, i - 1, -1):
            found = self.exponential(k) @ found
        return found

    def link(self, label: str) -> FloatArray:
        """The pose, in the first frame, of the link that a joint moves; ``"0"`` is that frame, ``"e"`` the tip."""
        if label == "e":
            return self.pose
        if label == "0":
            return np.broadcast_to(np.eye(4), self.pose.shape)
        names = {joint.name: joint.child for joint in self._d.robot.description.joints}
        child = names[self._d.chain.joints[int(label) - 1].variable.joint]
        moving = [variable.joint for variable in self._d.coordinates]
        at = dict(zip(moving, self._drawn.q.T, strict=True))
        poses = self._ask(self._drawn.robot, at, len(self._drawn.q), [child, self._d.reference]).poses
        return np.asarray(se3.inverse(poses[:, 1]) @ poses[:, 0])

    def leg(self, tip: str, reference: str) -> tuple[FloatArray, Mapping[str, FloatArray]]:
        """The pose of one frame in another, and its velocities by kind, of shape (N, 6, 1)."""
        drawn = self._drawn
        at = {v.joint: (drawn.q[:, i], drawn.qd[:, i]) for i, v in enumerate(self._d.coordinates)}
        free = drawn.robot.coordinate_names
        at |= {name: found for name, found in drawn.others.items() if name in free}
        values = {name: value for name, (value, _) in at.items()}
        pose, jacobians = relative(self._ask(drawn.robot, values, len(drawn.q), [tip, reference]))
        rates = np.zeros((len(drawn.q), drawn.robot.nv, 1))
        for name, (_, rate) in at.items():
            rates[:, drawn.robot.velocity_names.index(name), 0] = rate
        return pose, {kind: J @ rates for kind, J in jacobians.items()}

    def twist(self, i: int) -> FloatArray:
        """ξi: column i of J^s where all joints are at zero."""
        return self._columns("spatial", 0)[:, :, i - 1 : i]

    def column(self, kind: str, i: int) -> FloatArray:
        """ξ′i or ξ†i."""
        return self._columns(kind, self.joints + 1)[:, :, i - 1 : i]

    def partial_rate(self, i: int) -> FloatArray:
        """∂g/∂θi = ξ̂′i g (MLS, §3.4.1)."""
        return np.asarray(se3.hat(self.column("spatial", i)[:, :, 0]) @ self.pose)

    def jacobian(self, kind: KindLike) -> FloatArray:
        """A column for each coordinate."""
        return np.asarray(self._moving[1][jacobian_kind(kind)])

    def jacobian_at_home(self) -> FloatArray:
        """J^s where all coordinates are zero."""
        twists = self._columns("spatial", 0)
        order = [variable.symbol for variable in self._d.coordinates]
        found = np.zeros((len(twists), 6, len(order)))
        for i, joint in enumerate(self._d.chain.joints):
            factor = float(joint.multiplier.xreplace(dict(self._drawn.lengths)))
            found[:, :, order.index(joint.master.symbol)] += factor * twists[:, :, i]
        return found

    def velocity(self, kind: KindLike) -> FloatArray:
        """V = J θ̇, shape (N, 6, 1)."""
        return np.asarray(self.jacobian(kind) @ self._drawn.qd[:, :, None])

    @property
    def rate(self) -> FloatArray:
        """ġ = V̂^s g (MLS, eq. 2.53)."""
        return np.asarray(se3.hat(self.velocity("spatial")[:, :, 0]) @ self.pose)
