"""Down both trees at once, to the joints that were edited.

An edit of a joint moves all that hangs below it. So the way down carries a rigid displacement D, the one that takes
what lies ahead in a to where it is in b: at first none. A joint whose screw in b is not Ad(D) times that in a was
edited, and so was one behind which another D is needed. Behind a joint, D is what it was (the joints below make up for
the edit, or it was one of the axis alone), or the displacement of the link's frame, or, where the frame was chosen anew
as well, that of a link further down, if the joint's own screw goes along with it.

Of all ways down, the one is taken that needs the fewest edits. All displacements that can occur are known beforehand,
so a table from the tips up tells how many edits each displacement above a joint leaves to be made from there.

For example, let the origin of j2 in the chain j1 → j2 → j3 → tip be moved by X. The frames of j1, j2, j3 and tip are
displaced by 1, X, X and X, so there are two displacements. The edits that each leaves to be made, from the tips up::

    above      tip   j3   j2   j1
    D = 1       1     1    1    1     at j2: keep 1, and edit here and below (1 + 1), or go on with X (1 + 0)
    D = X       0     0    0    1     at j1: its screw is not displaced by X, so it would be edited

The way down begins with 1 at j1, keeps it there, goes on with X at j2 and keeps that: one edit, and it is that of j2.

Screws are compared as lines, since it is these that a motion is about: MLS §2.3.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.changes.geometry import Poses, common_locus, displacement, locus, turned
from pinscrew.changes.matching import JointPair
from pinscrew.changes.outcome import Tolerance
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray

__all__ = ["Crossing", "Features", "walk"]

AHEAD: Final = 12
"""Links below a joint whose displacements are tried for the joint's own."""
GRID: Final = 1e-12
"""What makes two displacements one, beside the robot's size: more than rounding does, and less than an edit."""
MOST: Final = 10_000_000
"""Displacements times joints and tips, at the most: 3000 joints that all were edited, each in another way."""


@dataclass(frozen=True)
class Crossing:
    """What the way down finds where it crosses a joint.

    Attributes:
        D_in: displacement that carries a onto b above the joint, shape (4, 4).
        D_out: that below it.
        carried: whether what is below is displaced beside what is above.
        own: whether the joint's own screw (or pose, of a floating or planar joint) is the same.
        rigid: whether the joint's screw goes along with D_out.
        lost: whether a tip that the joint leads to does not go along with D_out.
    """

    D_in: FloatArray
    D_out: FloatArray
    carried: bool
    own: bool
    rigid: bool
    lost: bool


class Features:
    """All by which the two robots' motions are told apart: the n screws of joints and poses of tips, at zero.

    Attributes:
        own: for pairs whose joint has a screw in both robots, its index among the features.
        tips: for pairs that lead to tips, their indices among the features.
    """

    def __init__(
        self,
        a: Poses,
        b: Poses,
        pairs: Sequence[JointPair],
        tips: Sequence[tuple[str, str, int]],
        either: Container[int],
        tolerance: Tolerance,
    ) -> None:
        """Take the pairs' joints, and ``tips``: the names of each in a and in b, and the pair that leads to it.

        Pairs in ``either`` have joints whose screws may be opposite.
        """
        self._tolerance = tolerance
        self._below: dict[int, list[int]] = {}
        for i, pair in enumerate(pairs):
            self._below.setdefault(pair.above, []).append(i)
        matched = [(i, pair.a, pair.b) for i, pair in enumerate(pairs) if pair.a and pair.b and common_locus(pair)]
        self.own = {i: n for n, (i, _, _) in enumerate(matched)}
        self.tips: dict[int, list[int]] = {}
        for n, (_, _, index) in enumerate(tips, len(matched)):
            self.tips.setdefault(index, []).append(n)
        loci = [common_locus(pairs[i]) for i in self.own] + ["pose"] * len(tips)
        poses = [(a.joints[x.name], b.joints[y.name]) for _, x, y in matched]
        poses += [(a.links[x], b.links[y]) for x, y, _ in tips]
        axes = [(a.direction(x), b.direction(y)) for _, x, y in matched] + [(np.zeros(3), np.zeros(3))] * len(tips)
        self._loci = np.array(loci, dtype=str)
        self._a, self._b = np.array(poses).reshape(-1, 2, 4, 4).swapaxes(0, 1)
        self._u, self._w = np.array(axes).reshape(-1, 2, 3).swapaxes(0, 1)
        self._either = np.array([i in either for i in self.own] + [False] * len(tips), dtype=bool)

    def __len__(self) -> int:
        return len(self._loci)

    def nearest(self, index: int, most: int) -> list[int]:
        """Some pairs below one, the nearest first."""
        below = self._below.get(index, [])[:most]
        for nearer in below:  # which grows meanwhile
            below += self._below.get(nearer, [])[: most - len(below)]
        return below

    def explained(self, D: FloatArray) -> NDArray[np.bool_]:
        """Which features of b are those of a, displaced by D: shape (n,).

        A line through p along u goes to the line through ``D p`` along ``R u``. That is b's line through p' along w if
        the directions agree, ``∠(R u, w) = 0``, and ``D p`` is on b's line, ``w × (D p - p') = 0``. A direction has the
        first condition alone, and of a pose all of rotation and origin counts.
        """
        R = D[:3, :3]
        shift = self._a[:, :3, 3] @ R.T + D[:3, 3] - self._b[:, :3, 3]
        u = self._u @ R.T
        cosine = (u * self._w).sum(axis=1)
        sine = np.linalg.norm(np.cross(u, self._w), axis=1)
        angles = np.arctan2(sine, np.where(self._either, abs(cosine), cosine))
        angles = np.where(self._loci == "pose", turned(R @ self._a[:, :3, :3], self._b[:, :3, :3]), angles)
        off_line = np.linalg.norm(np.cross(self._w, shift), axis=1)
        lengths = np.where(self._loci == "line", off_line, 0.0)
        lengths = np.where(self._loci == "pose", np.linalg.norm(shift, axis=1), lengths)
        same: NDArray[np.bool_] = (angles <= self._tolerance.angle) & (lengths <= self._tolerance.length)
        return same


def walk(pairs: tuple[JointPair, ...], a: Poses, b: Poses, features: Features) -> list[Crossing]:
    """What is found at each joint, on the way with the fewest edits.

    Raises:
        InputError: if so many joints were edited in so many ways that it would take minutes.
    """
    frames = [displacement(a.links[pair.link_a], b.links[pair.link_b]) for pair in pairs]
    displacements, at = _distinct([np.eye(4), *frames], max(a.size, b.size))
    if len(displacements) * len(features) > MOST:
        what = f"{len(features)} joints and tips are displaced in {len(displacements)} ways, too many to look through"
        raise InputError("too-many-changes", what, remedy="compare smaller robots, or smaller edits one by one")
    explained = np.array([features.explained(D) for D in displacements])
    edits = _Edits(pairs, at[1:], features, explained)
    used = [at[0]] * len(pairs)
    crossings = []
    for i, pair in enumerate(pairs):
        above = used[pair.above] if pair.above >= 0 else at[0]
        used[i] = edits.behind(i, above)
        crossings.append(
            Crossing(
                D_in=displacements[above],
                D_out=displacements[used[i]],
                carried=used[i] != above,
                own=bool(edits.own[i][above]),
                rigid=bool(edits.own[i][used[i]]),
                lost=bool(edits.lost[i][used[i]]),
            )
        )
    return crossings


def _distinct(displacements: list[FloatArray], size: float) -> tuple[list[FloatArray], list[int]]:
    """The displacements without repetitions, and where each is among them."""
    grid = np.full((4, 4), GRID)
    grid[:3, 3] *= size
    indices: dict[bytes, int] = {}
    distinct: list[FloatArray] = []
    where = []
    for D in displacements:
        rounded = (np.round(D / grid) + 0.0).tobytes()
        if rounded not in indices:
            indices[rounded] = len(distinct)
            distinct.append(D)
        where.append(indices[rounded])
    return distinct, where


class _Edits:
    """How many edits each of K displacements above a joint leaves to be made, at it and below.

    Attributes:
        own: for each pair whether each displacement explains its own screw, shape (K,).
        lost: likewise, how many tips that it leads to it does not explain.
        below: likewise, how many edits are left below, and lost tips.
    """

    def __init__(
        self, pairs: tuple[JointPair, ...], frames: list[int], features: Features, explained: NDArray[np.bool_]
    ) -> None:
        K = len(explained)
        all_of_them, none = np.ones(K, dtype=bool), np.zeros(K, dtype=np.int32)
        self._pairs, self._frames = pairs, frames
        self.own = [explained[:, features.own[i]] if i in features.own else all_of_them for i in range(len(pairs))]
        self.lost = [
            (~explained[:, features.tips[i]]).sum(axis=1, dtype=np.int32) if i in features.tips else none
            for i in range(len(pairs))
        ]
        self.below = [lost.copy() for lost in self.lost]
        self._others: list[list[int]] = []
        for i in range(len(pairs)):
            ahead = dict.fromkeys(frames[j] for j in features.nearest(i, AHEAD))
            self._others.append([D for D in ahead if i in features.own and self.own[i][D]])
        for i in reversed(range(len(pairs))):
            if pairs[i].above >= 0:
                self.below[pairs[i].above] += self._left(i)

    def _left(self, i: int) -> NDArray[np.int32]:
        """Edits at a joint and below, for each displacement above it: shape (K,)."""
        below = self.below[i]
        edited = 1 if _edited(self._pairs[i]) else 0
        keep = np.where(self.own[i], edited, 1) + below
        other = 1 + min(below[D] for D in [self._frames[i], *self._others[i]])
        left: NDArray[np.int32] = np.minimum(keep, other).astype(np.int32)
        return left

    def behind(self, i: int, above: int) -> int:
        """The displacement behind a joint, given that above it; of equally good ones, the most literal."""
        below, frame = self.below[i], self._frames[i]
        edited = _edited(self._pairs[i]) or not self.own[i][above]
        keep = below[above] + edited
        literal = below[frame] + 1
        best = min(keep, literal, *(below[D] + 1 for D in self._others[i]))
        if edited and keep == best and below[above] == 0:
            return above
        both = self._pairs[i].a is not None and self._pairs[i].b is not None
        if literal == best and (below[frame] == 0 or (edited and both)):
            return frame
        # That an edit further down goes along with this screw by chance is unlikely, if this joint was edited too.
        further = [D for D in self._others[i] if below[D] + 1 == best]
        if further and (keep > best or frame != above):
            return further[0]
        return above if keep == best else frame


def _edited(pair: JointPair) -> bool:
    """Whether a pair is an edit wherever it leads: a joint added, removed, of another type or hung elsewhere."""
    return pair.elsewhere or locus(pair.a) != locus(pair.b)
