"""Engines that answer wrongly: each check of `verify` fails where it should, and alone where it can."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from broken import ROBOT, Alter, Altered, pair
from pinscrew.engines.base import Answers
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.lie import se3
from pinscrew.verification.configurations import configurations
from pinscrew.verification.report import Report
from pinscrew.verification.run import verify

ENGINES = ("PoE", "Pinocchio")
SIDES = pytest.mark.parametrize("side", [0, 1], ids=ENGINES)
SAMPLES = 3
CHECKS = [check.name for check in verify(ROBOT, 0).checks]
TOOL, J3 = ROBOT.frame_names.index("tool"), ROBOT.velocity_names.index("j3")


def run(engines: tuple[Any, Any]) -> Report:
    return verify(ROBOT, SAMPLES, engines=engines)


def failed(report: Report) -> set[str]:
    return {check.name for check in report.failed}


def of(engine: str, *checks: str) -> set[str]:
    return {f"{check} in {engine}" for check in checks}


def on(frame: str, change: Callable[[Answers, int], None]) -> Alter:
    """A change of the answers about one frame, given its place among them."""

    def alter(answers: Answers, frames: Sequence[str], _: FloatArray) -> None:
        if frame in frames:
            change(answers, list(frames).index(frame))

    return alter


def entry(field: str, kind: Any = None, by: float = 1e-10, frame: str = "tool") -> Alter:
    """One entry of an answer about a frame is off: of a pose in x, of a Jacobian in the vy of j3."""

    def change(answers: Answers, at: int) -> None:
        if kind is None:
            answers.poses[:, at, 0, 3] += by
        else:
            getattr(answers, field)[kind][:, at, 1, J3] += by

    return on(frame, change)


def scaled(answers: Answers, _: Sequence[str], __: FloatArray) -> None:
    for kind in KINDS:
        answers.jacobians[kind][:] *= 1.0 + 1e-7
        answers.derivatives[kind][:] *= 1.0 + 1e-7


SPATIAL, HYBRID, DIFFERENCES = "J_s = Ad(T) J_b", "J_h = diag(R, R) J_b", "finite differences of FK"
ALONE = {
    "pose": (entry("poses"), {"home poses", "forward kinematics"}, {SPATIAL}),
    "spatial": (entry("jacobians", "spatial"), {"screw axes", "spatial Jacobian"}, {SPATIAL}),
    "body": (entry("jacobians", "body"), {"body Jacobian"}, {SPATIAL, HYBRID}),
    "hybrid": (entry("jacobians", "hybrid"), {"hybrid Jacobian"}, {HYBRID}),
    **{f"{kind} rate": (entry("derivatives", kind), {f"{kind} Jacobian derivative"}, set()) for kind in KINDS},
}


@SIDES
@pytest.mark.parametrize(("alter", "between", "within"), ALONE.values(), ids=ALONE)
def test_one_engine_is_wrong(alter: Alter, between: set[str], within: set[str], side: int) -> None:
    """What differs between the engines fails, and what does not hold within the wrong one."""
    report = run(pair(side, alter))
    assert failed(report) == between | of(ENGINES[side], *within)
    for check in report.failed:
        assert check.error == pytest.approx(1e-10, rel=1.0), "divided by at most the robot's size"
        assert check.place.frame == "tool"


BOTH = {
    "pose": (entry("poses"), {SPATIAL}),
    "spatial": (entry("jacobians", "spatial"), {SPATIAL}),
    "hybrid": (entry("jacobians", "hybrid"), {HYBRID}),
    "scale": (scaled, {DIFFERENCES}),
}


@pytest.mark.parametrize(("alter", "within"), BOTH.values(), ids=BOTH)
def test_both_engines_are_wrong_alike(alter: Alter, within: set[str]) -> None:
    """No comparison between them tells, but those with identities and differences do."""
    report = run((Altered(ps.PoE(ROBOT), alter), Altered(ps.Pinocchio(ROBOT), alter)))
    assert failed(report) == of("PoE", *within) | of("Pinocchio", *within)


def test_every_check_has_been_seen_to_fail() -> None:
    seen = {"structure"}  # test_diagnosis.py: wrong limits
    for _, between, within in ALONE.values():
        seen |= between.union(*(of(engine, *within) for engine in ENGINES))
    seen |= set().union(*(of(engine, *within) for _, within in BOTH.values() for engine in ENGINES))
    assert seen == set(CHECKS)


# -------------------------------------------------------------------------------------- wrong questions


def swapped(answers: Answers, _: Sequence[str], __: FloatArray) -> None:
    answers.jacobians["hybrid"][:] = answers.jacobians["body"]


@SIDES
def test_body_for_hybrid(side: int) -> None:
    report = run(pair(side, swapped))
    assert failed(report) == {"hybrid Jacobian"} | of(ENGINES[side], HYBRID)
    assert report.diagnosis == ("every joint places and moves its child alike; what differs is: "
                                f"hybrid Jacobian, {HYBRID} in {ENGINES[side]}",)  # fmt: skip


@SIDES
@pytest.mark.parametrize(
    ("asked", "given", "joint"),
    [("l2", "l3", "j2"), ("l2", "base", "j2"), ("tool", "l4", "mount"), ("l1", "tool", "j1")],
)
def test_answer_about_another_frame(asked: str, given: str, joint: str, side: int) -> None:
    """The joint above it is named, and the one below, which is where it should be, is not."""
    engine = (ps.PoE, ps.Pinocchio)[side](ROBOT)

    def alter(answers: Answers, frames: Sequence[str], q: FloatArray) -> None:
        if asked in frames:
            at = list(frames).index(asked)
            other = engine.answers(q, np.zeros((len(q), ROBOT.nv)), [given])
            answers.poses[:, at] = other.poses[:, 0]
            for kind in KINDS:
                answers.jacobians[kind][:, at] = other.jacobians[kind][:, 0]

    report = run(pair(side, alter))
    assert {"home poses", "forward kinematics", "body Jacobian"} <= failed(report)
    assert {check.place.frame for check in report.failed} == {asked}
    assert {line.split(": ")[0] for line in report.diagnosis} == {f"joint {joint!r}"}


def test_the_base_is_elsewhere() -> None:
    def alter(answers: Answers, _: Sequence[str], __: FloatArray) -> None:
        answers.poses[..., 2, 3] += 0.1

    (line,) = run(pair(1, alter)).diagnosis
    assert line == "the base 'base' itself is placed or moved differently in Pinocchio, compared with PoE"


def test_wrong_only_away_from_zero() -> None:
    """The joint is then found where the largest error is."""

    def alter(answers: Answers, frames: Sequence[str], q: FloatArray) -> None:
        turn = np.zeros((len(q), 6))
        turn[:, 5] = 0.1 * np.sin(q[:, 0]) ** 2
        for frame in ("l3", "l4", "tool"):
            if frame in frames:
                at = list(frames).index(frame)
                answers.poses[:, at] = se3.exp(turn) @ answers.poses[:, at]

    report = run(pair(1, alter))
    assert "home poses" not in failed(report)
    assert "forward kinematics" in failed(report)
    where = next(check.place for check in report.failed if check.name == "forward kinematics")
    assert report.diagnosis
    for line in report.diagnosis:
        assert line.startswith(f"at {where.configuration}, joint 'j3': ")


# ------------------------------------------------------------------------------------------------ NaN

POISONED = {
    "pose": ("poses", None, {"forward kinematics"}),
    **{kind: ("jacobians", kind, {f"{kind} Jacobian"}) for kind in KINDS},
    **{f"{kind} rate": ("derivatives", kind, {f"{kind} Jacobian derivative"}) for kind in KINDS},
}


@SIDES
@pytest.mark.parametrize("value", [math.nan, -math.inf])
@pytest.mark.parametrize(("field", "kind", "fails"), POISONED.values(), ids=POISONED)
def test_not_finite(field: str, kind: Any, fails: set[str], value: float, side: int) -> None:
    """One entry at one configuration: the check fails there, whatever engine it is in, and the report can be told."""
    where = configurations(ROBOT, SAMPLES, 0)
    chosen = where.labels.index("random 1")

    def poison(answers: Answers, frames: Sequence[str], q: FloatArray) -> None:
        if "tool" in frames:
            array = answers.poses if kind is None else getattr(answers, field)[kind]
            array[(q == where.q[chosen]).all(axis=1), frames.index("tool"), 2, -1] = value

    report = run(pair(side, poison))
    assert fails <= failed(report)
    for check in report.failed:
        if DIFFERENCES not in check.name:
            assert check.error == math.inf
            assert (check.place.frame, check.place.configuration) == ("tool", "random 1")
    assert report.worst.error == math.inf
    assert not report.ok
    said = json.loads(report.to_json(), parse_constant=pytest.fail)["robots"][0]
    assert {check["name"] for check in said["checks"] if check["error"] == "inf"} >= fails
    assert f'failures="{len(report.failed)}"' in report.to_junit()
    assert "inf" in str(report)
    if field == "poses" or (field, kind) == ("jacobians", "body"):
        expected = f"joint 'mount': its child 'tool' has an answer that is not finite in {ENGINES[side]}"
        assert report.diagnosis == (f"at random 1, {expected}",)
    else:
        (line,) = report.diagnosis
        assert line.startswith("every joint places and moves its child alike; what differs is: ")


@SIDES
@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_nothing_but_not_finite(value: float, side: int) -> None:
    def poison(answers: Answers, _: Sequence[str], __: FloatArray) -> None:
        answers.poses[:] = value
        for kind in KINDS:
            answers.jacobians[kind][:] = answers.derivatives[kind][:] = value

    report = run(pair(side, poison))
    other = ENGINES[1 - side]
    assert failed(report) == set(CHECKS) - {"structure"} - of(other, SPATIAL, HYBRID, DIFFERENCES)
    assert report.diagnosis[0].startswith("the base 'base' itself is placed or moved differently")


@SIDES
@pytest.mark.parametrize("matrix", [np.zeros((4, 4)), 2 * np.eye(4), np.diag([1.0, 1, -1, 1]), np.ones((4, 4))])
def test_no_rigid_motion(matrix: FloatArray, side: int) -> None:
    """An engine may answer anything; that is a failure, not an error."""

    def change(answers: Answers, at: int) -> None:
        answers.poses[:, at] = matrix

    report = run(pair(side, on("l3", change)))
    assert {"home poses", "forward kinematics"} <= failed(report)
    expected = f"joint 'j3': its child 'l3' has a pose that is no rigid motion in {ENGINES[side]}"
    assert report.diagnosis == (expected,)
