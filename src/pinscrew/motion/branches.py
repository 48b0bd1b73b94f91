"""All configurations that reach a target, where they are finitely many.

Descents start from random configurations until every solution was met at least twice. After I. J. Good, "The population
frequencies of species and the estimation of population parameters", Biometrika 40(3/4), 1953, doi:10.2307/2333344, the
part of all starts that lead to solutions not yet met is about n₁/N: n₁ of them were met once, in N starts. With n₁ = 0
little is left; it is an estimate and no proof.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.motion.freedoms import TURN, Freedoms, Task, task_rows
from pinscrew.motion.search import SETTLED, STEPS, Findings, Search

__all__ = ["NO_OTHER", "every", "require_isolated"]

NO_OTHER: Final = "no other"
"""The reason in the place of a solution that another target has and this one not."""
SAME: Final = 1e-4
"""Solutions that differ by less (rad, and m over the length) are one. At a double root, as of a stretched arm, an error
of 1e-9 is one of some 3e-5 in q: what lies between two that are nearer reaches the target as well as they do."""
INDEPENDENT: Final = 1e-9
"""Singular values of a Jacobian below this part of the largest are none."""
PROBES: Final = 8
"""Configurations at which the rank is looked at: all would have to be singular by accident."""


def require_isolated(free: Freedoms, engine: Engine, task: Task, drawn: FloatArray) -> None:
    """Refuse a frame that can stay where it is while its joints move: its solutions are not countable.

    Args:
        free: the coordinates that move the frame; those held by equal limits do not count.
        engine: answers for Jacobians.
        task: the rows that count.
        drawn: some configurations, shape (N, m).

    Raises:
        InputError: if there are more coordinates than their Jacobian has rank.
    """
    weights = task_rows(task, free.length)
    loose = free.limits[:, 0] < free.limits[:, 1]
    q = free.put(free.robot.neutral, drawn[:PROBES])
    J = engine.jacobian(q, free.frame, "body")[:, : len(weights), free.v[loose]] * weights[:, None] * free.scales[loose]
    values = np.linalg.svd(J, compute_uv=False)
    rank = int((values > INDEPENDENT * values[:, :1]).sum(axis=1).max(initial=0))
    count = int(loose.sum())
    if count > rank:
        names = ", ".join(name for name, moves in zip(free.names, loose, strict=True) if moves)
        what = f"the {task} of {free.frame!r} leaves {count - rank} of {count} coordinates free ({names})"
        remedy = "hold as many by equal limits, or ask for one solution"
        what += ": there are infinitely many solutions"
        raise InputError("redundant", what, where=free.robot.name, remedy=remedy)


def every(search: Search, T: FloatArray, q: FloatArray, given: bool) -> Findings:
    """All configurations (N, k, nq) of targets (N, 4, 4), their errors (N, k) in m and rad, and reasons (N, k).

    The nearest to ``q`` (N, nq) come first; k is the number of the target that has most, and what others have less is
    NaN and `NO_OTHER`. A target without any has what `Search.solve` finds.
    """
    free = search.free
    parts = [_branches(search, target, values) for target, values in zip(T, q[:, free.q], strict=True)]
    most = max([1, *map(len, parts)])
    there = np.arange(most) < np.array([len(part) for part in parts], dtype=np.intp)[:, None]
    out = np.full((len(T), most, free.robot.nq), np.nan)
    distance, angle = np.full((2, len(T), most), np.nan)
    reason = np.full((len(T), most), NO_OTHER, dtype="U16")
    row, _ = np.nonzero(there)
    out[there] = free.put(q[row], np.concatenate([np.empty((0, len(free.q))), *parts]))
    distance[there], angle[there], good = search.confirmed(T[row], out[there])
    reason[there] = np.where(good, "", "unconfirmed")
    none = ~there[:, 0]
    out[none, 0], distance[none, 0], angle[none, 0], reason[none, 0] = search.solve(T[none], q[none], given)
    return out, distance, angle, reason


def _branches(search: Search, T: FloatArray, first: FloatArray) -> FloatArray:
    """Values (k, m) that reach a target (4, 4) by the first engine, the nearest to ``first`` (m,) first."""
    free = search.free
    descent = search.descent(free)
    found, met = np.empty((0, len(free.q))), list[int]()
    for i in range(0, len(search.drawn), search.starts):
        starts = search.drawn[i : i + search.starts]
        lanes = descent.run(np.broadcast_to(T, (len(starts), 4, 4)), starts, STEPS, SETTLED)
        for x in free.nearest_turn(lanes.x[lanes.converged], first):
            same = np.flatnonzero(_apart(free, found, x).max(axis=1, initial=0.0) < SAME)
            if len(same):
                met[same[0]] += 1
            else:
                found = np.vstack([found, x])
                met.append(1)
        if met and min(met) > 1:
            break
    return np.asarray(found[np.argsort(_apart(free, found, first).sum(axis=1), kind="stable")])


def _apart(free: Freedoms, x: FloatArray, other: FloatArray) -> FloatArray:
    """How far each of ``x`` (k, m) is from that of ``other`` (m,), in rad or lengths; whole turns are nothing."""
    difference = x - other
    difference -= TURN * np.where(free.wraps, np.round(difference / TURN), 0.0)
    return np.asarray(abs(difference) / free.scales)
