"""Edits of real robots: which change the motion, Pinocchio says; which joint it was, the edit says."""

from __future__ import annotations

import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from diff_edits import Edited
from diff_matrix import CHANGED, SAME, Row, scaled, ten_times

import pinscrew as ps
from pinscrew.description import urdf
from pinscrew.description.catalogue import example_robots
from pinscrew.ground.errors import MissingExtraError
from pinscrew.robot.robot import Robot
from pinscrew.verification.configurations import configurations


def files() -> dict[str, Path]:
    try:
        return {entry.name: entry.file for entry in example_robots()}
    except MissingExtraError:
        return {}


FILES = files()
pytestmark = pytest.mark.skipif(not FILES, reason="the extra robots is not installed")


@cache
def original(name: str, *, large: bool) -> tuple[str, Robot]:
    """A robot's links and joints, ten times as large if asked for; meshes and masses take their time to parse."""
    e = Edited(FILES[name].read_text(encoding="utf-8"))
    e.root[:] = [*e.root.findall("link"), *e.root.findall("joint")]
    for link in e.root.findall("link"):
        link[:] = []
    if large:
        ten_times(e)
    return e.text, parsed(e.text)


def parsed(text: str) -> Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ps.PinscrewWarning)
        return Robot.from_description(urdf.parse(text, "edited.urdf"))


def before_and_after(row: Row, *, large: bool = False) -> tuple[Robot, Robot]:
    text, before = original(row.robot, large=large)
    after = Edited(text)
    row.edit(after)
    return before, parsed(after.text)


def pinocchio_sees(a: Robot, b: Robot, row: Row) -> float:
    """Largest difference of the tips that both have, at equal coordinates; joints without a partner are at 0."""
    drawn = configurations(a, 20, 1)
    q_a = drawn.q[: drawn.inside]
    q_b = np.tile(b.neutral, (len(q_a), 1))
    for i, name in enumerate(a.joint_names):
        if row.names(name) in b.joint_names:
            q_b[:, b.joint_names.index(row.names(name))] = q_a[:, i]
    pins = ps.Pinocchio(a), ps.Pinocchio(b)
    tips = [tip for tip in a.description.leaves if row.names(tip) in b.frame_names]
    assert tips
    return max(float(abs(pins[0].fk(q_a, tip) - pins[1].fk(q_b, row.names(tip))).max()) for tip in tips)


@pytest.mark.parametrize("row", SAME.values(), ids=SAME)
def test_the_same_motion(row: Row) -> None:
    a, b = before_and_after(row)
    found = ps.diff(a, b)
    assert found.same, str(found)
    assert {note.kind for note in found.notes} == row.kinds, str(found)
    assert pinocchio_sees(a, b, row) < 1e-11
    assert found.displacement is not None
    assert found.displacement.length < 1e-11


@pytest.mark.parametrize("name", CHANGED)
def test_another_motion(name: str) -> None:
    row = CHANGED[name]
    a, b = before_and_after(row, large=scaled(name))
    found = ps.diff(a, b)
    assert {change.joint for change in found.changes} == row.joints, str(found)
    assert {change.kind for change in found.changes} == row.kinds, str(found)
    if row.length is not None or row.angle is not None:
        (change,) = found.changes
        assert row.length is None or change.length == pytest.approx(row.length, rel=1e-6, abs=1e-12)
        assert row.angle is None or change.angle == pytest.approx(row.angle, rel=1e-6, abs=1e-12)
    if row.moves:
        assert pinocchio_sees(a, b, row) > 1e-8


def test_the_matrix_is_wide() -> None:
    rows = [*SAME.values(), *CHANGED.values()]
    assert len(SAME) >= 20
    assert len(CHANGED) >= 40
    assert len({row.robot for row in rows}) >= 8
