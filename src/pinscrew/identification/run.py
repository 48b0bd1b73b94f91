"""Which convention numbers are in: `pinscrew.identify`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.engines.pinocchio import Pinocchio
from pinscrew.engines.poe import PoE
from pinscrew.ground.typing import ArrayLike, FloatArray
from pinscrew.identification.encodings import Encoding, encodings
from pinscrew.identification.given import GivenSamples, samples, tolerances
from pinscrew.identification.observers import moving, observed, observers
from pinscrew.identification.outcome import Candidate, Identified
from pinscrew.identification.points import movable
from pinscrew.identification.writings import UNITS, Writing, columns
from pinscrew.lie import se3
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import Robot
from pinscrew.verification.configurations import configurations

__all__ = ["identify"]

TRIED: Final = 8
"""Configurations at which candidates are told apart."""
SAME: Final = 1e-9
"""Numbers that differ by less are the same convention under two names."""
MOST: Final = 8
"""So many different conventions are told: what fits more says nothing."""


def identify(robot: RobotLike, q: ArrayLike, *given: ArrayLike) -> Identified:
    """Which convention a Jacobian, a pose or a twist is in: whose, at which point, in which axes, order and units.

    Every convention that is known is tried: it fits if it gives the numbers at each q to the digits that they have, by
    PoE and by Pinocchio. Those whose numbers are the same at every q are one, under several names. What only some of
    the samples agree with is none; what several conventions agree with is ambiguous, and never guessed.

    Args:
        robot: a robot, or a name or path that `load` takes.
        q: configurations, shape (nq,) or (N, nq); rad and m.
        given: one array for each q: a Jacobian (6, m) or (m, 6), whose columns may lack joints, be in another order or
            have other signs; a pose (4, 4), or 6 or 7 numbers; or two arrays: rates (nv,) and a twist (6,).

    Returns:
        the conventions that fit, the plainest first; `Identified.verdict` says whether it is one.

    Raises:
        InputError: if a shape is none of these, or a number is not finite.
    """
    robot = robot_of(robot)
    asked = samples(robot, q, given)
    engine = PoE(robot)
    places = _places(robot)
    found: list[Candidate] = []
    for relative, absolute in tolerances(asked.values):
        search = _poses if asked.quantity == "pose" else _jacobians
        found = list(search(robot, engine, asked, relative, absolute))
        found = found or list(_points(robot, engine, asked, relative, absolute))
        if found:
            other = Pinocchio(robot)
            found = [each for each in found if _confirmed(other, each, asked, relative, absolute)]
            break
    found.sort(key=lambda each: each.cost)  # stable: of equals the one that was tried first
    distinct = _distinct(engine, found, places)
    return Identified(robot.name, tuple(distinct), len(asked.q), _telling(engine, distinct, places))


def _jacobians(
    robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float
) -> Iterator[Candidate]:
    turning = _turning(robot)
    twist = asked.qd is not None
    layouts = ("rows", "transposed") if asked.values.shape[1:] == (6, 6) else ("rows",)
    if not twist and asked.values.shape[1] != 6:
        layouts = ("transposed",)
    for observer in observers(robot):
        J = observed(engine, observer, asked.q)
        ours = J if asked.qd is None else J @ asked.qd[:, :, None]
        per_column = turning if asked.qd is None else np.zeros(0)
        for order, unit, angle, layout in product(("v,w", "w,v"), UNITS, ("rad", "deg"), layouts):
            if twist and not turning.any() and angle == "deg":
                continue
            writing = Writing(order, unit, angle, layout)  # type: ignore[arg-type]
            expected = writing.rows(ours, per_column)
            values = asked.values[:, :, None] if twist else asked.values
            values = np.swapaxes(values, 1, 2) if layout == "transposed" else values
            off = _apart(values, expected, relative, absolute)
            if twist:
                if off[0, 0, 0] <= 1.0:
                    residual = float(abs(values - expected).max())
                    yield Candidate(asked.quantity, residual, robot.velocity_names, turning, observer, writing)
                continue
            for joints, signs in columns(off <= 1.0):
                residual = float(abs(values - expected[:, :, list(joints)] * signs).max())
                written = replace(writing, joints=joints, signs=signs)
                yield Candidate(asked.quantity, residual, robot.velocity_names, turning, observer, written)


def _points(robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float) -> Iterator[Candidate]:
    """Jacobians with all columns in their order, of points that the file does not name."""
    if asked.quantity != "jacobian" or sorted(asked.values.shape[1:]) != sorted((6, robot.nv)):
        return
    turning, rows, joints = _turning(robot), asked.values, tuple(range(robot.nv))
    layouts = ["rows"] if rows.shape[1] == 6 else []
    layouts += ["transposed"] if rows.shape[2] == 6 else []
    seen = list(movable(robot, engine, asked.q))
    for layout, order, unit, angle in product(layouts, ("v,w", "w,v"), UNITS, ("rad", "deg")):
        writing = Writing(order, unit, angle, layout, joints, (1,) * robot.nv)  # type: ignore[arg-type]
        given = np.swapaxes(rows, 1, 2) if layout == "transposed" else rows
        ours = given * np.where((turning > 0.0) & (angle == "deg"), 180.0 / np.pi, 1.0)
        linear, angular = (ours[:, :3], ours[:, 3:]) if order == "v,w" else (ours[:, 3:], ours[:, :3])
        for each in seen:
            for observer in each.explaining(linear * UNITS[unit], angular):
                expected = writing.rows(observed(engine, observer, asked.q), turning)
                off = _apart(given, expected, relative, absolute)[joints, joints, 0]
                if off.max() <= 1.0:
                    residual = float(abs(given - expected).max())
                    yield Candidate(asked.quantity, residual, robot.velocity_names, turning, observer, writing)


def _apart(values: FloatArray, expected: FloatArray, relative: float, absolute: float) -> FloatArray:
    """How far each given column is from each expected one and from its opposite, in tolerances; shape (m, n, 2)."""
    blocks = []
    for rows in (slice(0, 3), slice(3, 6)):
        theirs, ours = values[:, rows, :, None], expected[:, rows, None, :]
        tolerance = absolute + relative * max(abs(theirs).max(initial=0.0), 1e-3)
        blocks.append(np.stack([abs(theirs - ours), abs(theirs + ours)], axis=-1).max(axis=(0, 1)) / tolerance)
    return np.asarray(np.maximum(*blocks))


def _poses(robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float) -> Iterator[Candidate]:
    turning, tip = _turning(robot), moving(robot)[:1]
    frames = robot.frame_names
    pairs = [(a, b) for a, b in product(frames, frames) if a != b]
    pairs.sort(key=lambda pair: (pair[0] != robot.base, pair[1] not in tip))
    T_base = {name: np.asarray(engine.fk(asked.q, name)) for name in frames}
    inverses = {name: se3.inverse(T) for name, T in T_base.items()}
    known = np.stack([inverses[a] @ T_base[b] for a, b in pairs]) if pairs else np.zeros((0, 1, 4, 4))
    scale = max(1.0, float(abs(asked.values).max(initial=0.0)))
    for encoding in encodings(asked.values.shape[1:]):
        T = encoding.decode(asked.values)
        if T is None:
            continue
        length = UNITS[encoding.unit] * (2.0 * absolute + relative * scale)
        turn = (2.0 * absolute + relative) * (np.pi / 180.0 if encoding.angle == "deg" else 1.0) + relative
        off = abs(known - T)
        fits = (off[..., :3, 3].max(axis=(1, 2)) <= length) & (off[..., :3, :3].max(axis=(1, 2, 3)) <= turn)
        for k in np.flatnonzero(fits):
            residual = float(off[k].max())
            yield Candidate("pose", residual, robot.velocity_names, turning, frames=pairs[k], encoding=encoding)


def _confirmed(engine: Engine, candidate: Candidate, asked: GivenSamples, relative: float, absolute: float) -> bool:
    """Whether another engine says so too."""
    if candidate.encoding is not None:
        expected = _predicted(engine, candidate, asked.q)
        theirs = candidate.encoding.decode(asked.values)
        ours = candidate.encoding.decode(expected)
        near = 4.0 * absolute + 1e3 * relative * max(1.0, float(abs(asked.values).max(initial=0.0)))
        return theirs is not None and ours is not None and bool(abs(theirs - ours).max() <= near)
    expected = _predicted(engine, candidate, asked.q, asked.qd)
    scale = max(1.0, float(abs(expected).max(initial=0.0)))
    return bool(abs(expected - asked.values).max() <= absolute + 10.0 * relative * scale)


def _predicted(engine: Engine, candidate: Candidate, q: FloatArray, qd: FloatArray | None = None) -> FloatArray:
    """What somebody with this convention would give at q, in the shape of what was given."""
    if candidate.encoding is not None:
        a, b = candidate.frames
        return candidate.encoding.encode(se3.inverse(engine.fk(q, a)) @ engine.fk(q, b))
    if candidate.observer is None or candidate.writing is None:
        return np.zeros(0)
    J = observed(engine, candidate.observer, q)
    writing = candidate.writing
    if candidate.quantity == "twist":
        rates = np.random.default_rng(0).uniform(0.5, 1.0, (len(q), J.shape[-1])) if qd is None else qd
        return writing.rows(J @ rates[:, :, None], np.zeros(0))[:, :, 0]
    written = writing.rows(J, candidate.turning)[:, :, list(writing.joints)] * writing.signs
    return np.swapaxes(written, 1, 2) if writing.layout == "transposed" else written


def _distinct(engine: Engine, found: list[Candidate], places: FloatArray) -> list[Candidate]:
    """One candidate for each convention, with its other names."""
    kept: list[Candidate] = []
    names: list[list[str]] = []
    for each in found:
        k = next((k for k, other in enumerate(kept) if _same(engine, each, other, places)), None)
        if k is None:
            kept += [each] if len(kept) < MOST else []
            names += [[]] if len(names) < MOST else []
        else:
            names[k].append(each.words)
    return [replace(each, aliases=tuple(words)) for each, words in zip(kept, names, strict=True)]


def _same(engine: Engine, one: Candidate, other: Candidate, places: FloatArray) -> bool:
    """Whether two give the same numbers wherever the robot is."""
    return bool(_differences(engine, one, other, places).max() <= SAME)


def _differences(engine: Engine, one: Candidate, other: Candidate, places: FloatArray) -> FloatArray:
    """By how much two differ at each place, shape (N,)."""
    if one.encoding is not None and other.encoding is not None:
        # Three angles of one rotation are not unique; so what one writes is read as the other would.
        return np.maximum(
            _misread(engine, one, other, other.encoding, places), _misread(engine, other, one, one.encoding, places)
        )
    a, b = (_predicted(engine, each, places) for each in (one, other))
    return np.asarray(abs(a - b).reshape(len(places), -1).max(axis=1))


def _misread(engine: Engine, one: Candidate, other: Candidate, encoding: Encoding, places: FloatArray) -> FloatArray:
    read = encoding.decode(_predicted(engine, one, places))
    meant = encoding.decode(_predicted(engine, other, places))
    if read is None or meant is None:
        return np.full(len(places), np.inf)
    return np.asarray(abs(read - meant).reshape(len(places), -1).max(axis=1))


def _telling(engine: Engine, candidates: list[Candidate], places: FloatArray) -> FloatArray | None:
    """The place at which the candidates nearest to each other are farthest apart; None where one is left."""
    if len(candidates) < 2:
        return None
    pairs = [(a, b) for k, a in enumerate(candidates) for b in candidates[:k]]
    apart = np.min([_differences(engine, a, b, places) for a, b in pairs], axis=0)
    return np.asarray(places[int(np.argmax(apart))])


def _places(robot: Robot) -> FloatArray:
    """Configurations within the limits, always the same; shape (TRIED, nq)."""
    drawn = configurations(robot, TRIED, 0)
    return drawn.q[[k for k, label in enumerate(drawn.labels) if label.startswith("random")]]


def _turning(robot: Robot) -> FloatArray:
    return np.array([1.0 if unit == "rad" else 0.0 for unit in robot.velocity_units])
