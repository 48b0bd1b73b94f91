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
from pinscrew.identification.observers import moving, observed
from pinscrew.identification.outcome import Candidate, Identified
from pinscrew.identification.search import jacobians, per_angle, unknown_points
from pinscrew.identification.writings import UNITS
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


def identify(robot: RobotLike, q: ArrayLike | None, *given: ArrayLike) -> Identified:
    """Which convention a Jacobian, a pose or a twist is in: whose, at which point, in which axes, order and units.

    Every convention that is known is tried: it fits if it gives the numbers at each q to the digits that they have, by
    PoE and by Pinocchio. Those whose numbers are the same at every q are one, under several names. What only some of
    the samples agree with is none; what several conventions agree with is ambiguous, and never guessed.

    Args:
        robot: a robot, or a name or path that `load` takes.
        q: configurations, shape (nq,) or (N, nq), rad and m; None for what is of no q: a list of screw axes (6, m),
            such as Slist or Blist of Lynch and Park, or the home pose M (4, 4).
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
    places = asked.q if asked.home else _places(robot)
    found: list[Candidate] = []
    for relative, absolute in tolerances(asked.values):
        search = _poses if asked.quantity == "pose" else jacobians
        found = list(search(robot, engine, asked, relative, absolute))
        found = found or list(unknown_points(robot, engine, asked, relative, absolute))
        if found:
            other = Pinocchio(robot)
            found = [each for each in found if _confirmed(other, each, asked, relative, absolute)]
            break
    found.sort(key=lambda each: each.cost)  # stable: of equals the one that was tried first
    distinct = _distinct(engine, found, places)
    return Identified(
        robot.name, tuple(distinct), len(asked.q), None if asked.home else _telling(engine, distinct, places)
    )


def _poses(robot: Robot, engine: Engine, asked: GivenSamples, relative: float, absolute: float) -> Iterator[Candidate]:
    turning, tip = per_angle(robot), moving(robot)[:1]
    frames = robot.frame_names
    pairs = [(a, b) for a, b in product(frames, frames) if a != b]
    pairs.sort(key=lambda pair: (pair[0] != robot.base, pair[1] not in tip))
    T_base = {name: np.asarray(engine.fk(asked.q, name)) for name in frames}
    inverses = {name: se3.inverse(T) for name, T in T_base.items()}
    known = np.stack([inverses[a] @ T_base[b] for a, b in pairs]) if pairs else np.zeros((0, 1, 4, 4))
    scale = max(1.0, float(abs(asked.values).max(initial=0.0)))
    inverted = np.asarray(se3.inverse(known))
    for encoding in encodings(asked.values.shape[1:]):
        # An inverse is held against inverses as it was given: turned round, its rounding would be in all numbers.
        turned = encoding.form == "inverse"
        T = (replace(encoding, form="matrix") if turned else encoding).decode(asked.values)
        if T is None:
            continue
        length = UNITS[encoding.unit] * (absolute + relative * scale)
        digits = absolute if asked.values.ndim == 3 else 2.0 * absolute
        turn = (digits + relative) * (np.pi / 180.0 if encoding.angle == "deg" else 1.0) + relative
        off = abs((inverted if turned else known) - T)
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
