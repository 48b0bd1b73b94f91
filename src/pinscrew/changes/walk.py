"""Down both trees at once, to the joints that were edited.

An edit of a joint moves all that hangs below it. So the way down carries a rigid displacement D, the one that takes
what lies ahead in a to where it is in b: at first none. A joint whose screw in b is not Ad(D) times that in a was
edited, and so was one behind which another D is needed. Behind a joint, D is what it was (the joints below make up for
the edit, or it was one of the axis alone), or the displacement of the link's frame, or, where the frame was chosen anew
as well, that of a link further down, if the joint's own screw goes along with it.

Of all ways down, the one is taken that needs the fewest edits. All displacements that can occur are known beforehand,
so a table from the tips up tells how many edits each displacement above a joint leaves to be made from there.

Screws are compared as lines, since it is these that a motion is about: MLS §2.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.changes.geometry import Features, Poses, between, kind
from pinscrew.changes.matching import Step
from pinscrew.ground.typing import FloatArray

__all__ = ["Met", "walk"]

AHEAD: Final = 12
"""Links below a joint whose displacements are tried for the joint's own."""
GRID: Final = 1e-12
"""What makes two displacements one, beside the robot's size: more than rounding does, and less than an edit."""


@dataclass(frozen=True)
class Met:
    """What the way down met at a step.

    Attributes:
        D_in: displacement that carries a onto b above the joint, shape (4, 4).
        D_out: that below it.
        carried: whether what is below is displaced beside what is above.
        own: whether the joint's own screw (or pose, of a floating or planar joint) is the same.
        rigid: whether the joint's screw goes along with D_out.
        lost: whether a tip that the step leads to does not go along with D_out.
    """

    D_in: FloatArray
    D_out: FloatArray
    carried: bool
    own: bool
    rigid: bool
    lost: bool


def walk(steps: tuple[Step, ...], a: Poses, b: Poses, features: Features) -> list[Met]:
    """What is met at each step, on the way with the fewest edits."""
    frames = [between(a.links[step.link_a], b.links[step.link_b]) for step in steps]
    displacements, at = _distinct([np.eye(4), *frames], max(a.size, b.size))
    explained = np.array([features.explained(D) for D in displacements])
    table = _Table(steps, at[1:], features, explained)
    used = [at[0]] * len(steps)
    found = []
    for i, step in enumerate(steps):
        above = used[step.above] if step.above >= 0 else at[0]
        used[i] = table.behind(i, above)
        found.append(
            Met(
                D_in=displacements[above],
                D_out=displacements[used[i]],
                carried=used[i] != above,
                own=bool(table.own[i][above]),
                rigid=bool(table.own[i][used[i]]),
                lost=bool(table.lost[i][used[i]]),
            )
        )
    return found


def _distinct(all_of_them: list[FloatArray], size: float) -> tuple[list[FloatArray], list[int]]:
    """The displacements without repetitions, and where each is among them."""
    scale = np.full((4, 4), GRID)
    scale[:3, 3] *= size
    keys: dict[bytes, int] = {}
    found: list[FloatArray] = []
    where = []
    for D in all_of_them:
        key = (np.round(D / scale) + 0.0).tobytes()
        if key not in keys:
            keys[key] = len(found)
            found.append(D)
        where.append(keys[key])
    return found, where


class _Table:
    """How many edits each of K displacements above a step leaves to be made, at it and below.

    Attributes:
        own: for each step whether each displacement explains its own screw, shape (K,).
        lost: likewise, how many tips that it leads to it does not explain.
        below: likewise, how many edits are left below, and lost tips.
    """

    def __init__(
        self, steps: tuple[Step, ...], frames: list[int], features: Features, explained: NDArray[np.bool_]
    ) -> None:
        K = len(explained)
        yes, none = np.ones(K, dtype=bool), np.zeros(K, dtype=int)
        self._steps, self._frames = steps, frames
        self.own = [explained[:, features.own[i]] if i in features.own else yes for i in range(len(steps))]
        self.lost = [none + (~explained[:, features.tips.get(i, [])]).sum(axis=1) for i in range(len(steps))]
        self.below = [lost.copy() for lost in self.lost]
        self._others: list[list[int]] = []
        for i in range(len(steps)):
            ahead = dict.fromkeys(frames[j] for j in features.nearest(i, AHEAD))
            self._others.append([D for D in ahead if i in features.own and self.own[i][D]])
        for i in reversed(range(len(steps))):
            if steps[i].above >= 0:
                self.below[steps[i].above] += self._left(i)

    def _left(self, i: int) -> NDArray[np.int_]:
        """Edits at a step and below, for each displacement above it: shape (K,)."""
        below = self.below[i]
        edited = 1 if _edited(self._steps[i]) else 0
        keep = np.where(self.own[i], edited, 1) + below
        other = 1 + min(below[D] for D in [self._frames[i], *self._others[i]])
        left: NDArray[np.int_] = np.minimum(keep, other)
        return left

    def behind(self, i: int, above: int) -> int:
        """The displacement behind a step, given that above it; of equally good ones, the most literal."""
        below, frame = self.below[i], self._frames[i]
        edited = _edited(self._steps[i]) or not self.own[i][above]
        keep = below[above] + edited
        literal = below[frame] + 1
        best = min(keep, literal, *(below[D] + 1 for D in self._others[i]))
        if edited and keep == best and below[above] == 0:
            return above
        both = self._steps[i].a is not None and self._steps[i].b is not None
        if literal == best and (below[frame] == 0 or (edited and both)):
            return frame
        # That an edit further down goes along with this screw by chance is unlikely, if this joint was edited too.
        further = [D for D in self._others[i] if below[D] + 1 == best]
        if further and (keep > best or frame != above):
            return further[0]
        return above if keep == best else frame


def _edited(step: Step) -> bool:
    """Whether a step is a change wherever it leads: a joint added, removed, of another type or hung elsewhere."""
    return step.elsewhere or kind(step.a) != kind(step.b)
