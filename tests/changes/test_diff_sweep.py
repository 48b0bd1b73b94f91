"""Edits drawn at random, of every robot of example-robot-data: the joint that was edited is the one that is named."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diff_edits import Edited, pose
from diff_matrix import axis_moved_alone, axis_turned, origin_moved, origin_turned, zero_shifted

import pinscrew as ps
from pinscrew.description import urdf
from pinscrew.description.catalogue import example_robots
from pinscrew.ground.errors import MissingExtraError
from pinscrew.robot.robot import Robot

BROKEN = {"falcon", "ur3", "alex_psyonic_hands"}
"""Files that are refused for what they say."""
EDITS = 6
FEW = 12
"""Robots of which every edit of the default run is one."""


def files() -> dict[str, Path]:
    try:
        return {entry.name: entry.file for entry in example_robots() if entry.name not in BROKEN}
    except MissingExtraError:
        return {}


FILES = files()


def parsed(text: str) -> Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ps.PinscrewWarning)
        return Robot.from_description(urdf.parse(text, "edited.urdf"))


def slid(joint: str, far: float) -> Callable[[Edited], None]:
    """A joint moved along its axis, or a slide across it: only what it carries is displaced."""

    def edit(e: Edited) -> None:
        sliding = e.joint(joint).get("type") == "prismatic"
        e.move(joint, pose(far * (e.across(joint) if sliding else e.axis(joint))))

    return edit


def zero(joint: str, far: float) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        if e.joint(joint).get("type") == "prismatic":
            e.move(joint, pose(far * e.axis(joint)))
        else:
            zero_shifted(joint, far)(e)

    return edit


KINDS = {
    axis_turned: {"axis-turned"},
    zero: {"zero-shifted"},
    slid: {"link-moved", "tip-moved"},
    origin_turned: {"axis-turned"},
    origin_moved: {"axis-moved"},
    axis_moved_alone: {"axis-moved"},
}
ON_SLIDES = 3
"""Of these, those that a slide shows in this way."""


def sweep(name: str, edits: int, seed: int) -> int:
    """Check random edits of a robot, from 1e-6 to 0.1 m or rad; how many there were."""
    rng = np.random.default_rng(seed)
    text = FILES[name].read_text(encoding="utf-8")
    a = parsed(text)
    found = ps.diff(a, a)
    assert (found.changes, found.notes) == ((), ())
    moving = [j for j in a.description.joints if j.type in ("revolute", "continuous", "prismatic")]
    done = 0
    for _ in range(edits if moving else 0):
        joint = moving[rng.integers(len(moving))]
        kinds = list(KINDS)[: ON_SLIDES if joint.type == "prismatic" else None]
        edit, size = kinds[rng.integers(len(kinds))], float(10 ** rng.uniform(-6.0, -1.0))
        e = Edited(text)
        if edit is axis_moved_alone and not list(e.below(joint.name)):
            continue  # nothing hangs there that could stay
        edit(joint.name, size)(e)
        found = ps.diff(a, parsed(e.text))
        assert {change.joint for change in found.changes} == {joint.name}, f"{edit.__name__} {size}: {found}"
        assert {change.kind for change in found.changes} <= KINDS[edit], f"{edit.__name__} {size}: {found}"
        done += 1
    return done


@pytest.mark.skipif(not FILES, reason="the extra robots is not installed")
def test_some_robots() -> None:
    assert sum(sweep(name, 1, seed) for seed, name in enumerate(sorted(FILES)[::FEW])) >= 3


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(FILES))
def test_every_robot(name: str) -> None:
    sweep(name, EDITS, 0)
