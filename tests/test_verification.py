"""`verify` on robots that are right, and where it looks: configurations, sizes, limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from broken import ROBOT, Altered, edited, pair
from pinscrew.description.catalogue import bundled
from pinscrew.engines.answers import Answers
from pinscrew.ground.errors import InputError, UnknownNameError
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.verification import comparison, differences
from pinscrew.verification.configurations import (
    FAR_ANGLE,
    FAR_DISTANCE,
    angles,
    configurations,
    effective_limits,
    sizes,
    speeds,
)
from pinscrew.verification.report import Report
from pinscrew.verification.run import TOLERANCE, verify

FIXED = 20
"""Configurations that are there without samples: zero, both limits, the middle, 16 corners."""


def assert_agree(report: Report) -> None:
    assert_agree_to(report, 1e-14)


def assert_agree_to(report: Report, largest: float) -> None:
    assert report.ok, str(report)
    assert report.failed == report.diagnosis == ()
    assert report.largest_difference < largest


# ---------------------------------------------------------------------------------------------- agreement


@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_bundled_robots_agree(name: str) -> None:
    robot = ps.load(name)
    report = verify(robot, samples=5)
    assert_agree(report)
    assert (report.robot, report.frames) == (name, len(robot.frame_names))


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_small_robots_agree(name: str, floating_base: bool) -> None:
    """Robots with no coordinate, with one, with mimics, with planar and floating joints."""
    assert_agree(verify(urdfs.load(urdfs.ROBOTS[name], floating_base=floating_base), samples=3))


def test_report_fields() -> None:
    robot = ps.load("scara", l1=0.5)
    report = verify(robot, samples=8, seed=3, tolerance=1e-11)
    assert report.robot == "scara_rrp"
    assert report.file.endswith("scara_rrp.urdf.xacro")
    assert report.arguments == {"l1": "0.5"}
    assert report.engines == ("PoE", "Pinocchio")
    assert (report.frames, report.samples, report.seed) == (5, 8, 3)
    assert report.configurations == FIXED + 8 + 2
    assert report.tolerance == 1e-11
    assert report.reach == pytest.approx(0.8, rel=1e-15)
    assert [check.name for check in report.checks] == [
        "structure",
        "home poses",
        "screw axes",
        "forward kinematics",
        "spatial Jacobian",
        "body Jacobian",
        "hybrid Jacobian",
        "spatial Jacobian derivative",
        "body Jacobian derivative",
        "hybrid Jacobian derivative",
        "J_s = Ad(T) J_b in PoE",
        "J_h = diag(R, R) J_b in PoE",
        "J_s = Ad(T) J_b in Pinocchio",
        "J_h = diag(R, R) J_b in Pinocchio",
        "finite differences of FK in PoE",
        "finite differences of FK in Pinocchio",
    ]
    assert [check.tolerance for check in report.checks[:-2]] == [0.0] + 13 * [1e-11]
    assert all(1e-11 < check.tolerance < 1e-8 for check in report.checks[-2:])


def test_defaults() -> None:
    report = verify(urdfs.load(urdfs.single_revolute()))
    assert (report.samples, report.seed, report.tolerance) == (1000, 0, TOLERANCE)
    assert report.configurations == FIXED + 1000 + 250
    assert_agree(report)


def test_the_same_seed_gives_the_same_report() -> None:
    one, same, other = (verify(ROBOT, 20, seed) for seed in (1, 1, 2))
    assert one == same
    assert one.to_json() == same.to_json()
    assert [check.error for check in one.checks] != [check.error for check in other.checks]


def test_without_samples() -> None:
    report = verify(ROBOT, samples=0)
    assert_agree(report)
    assert report.configurations == FIXED + 1


def test_blocks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Configuration by configuration the largest errors are found where they are found all at once."""
    engines = pair(1, edited(("0.4 0 0", "0.41 0 0")))
    whole = verify(ROBOT, 10, engines=engines)
    monkeypatch.setattr("pinscrew.verification.run.BLOCK_BYTES", 1)
    single = verify(ROBOT, 10, engines=engines)
    assert [(check.name, check.place) for check in single.failed] == [(c.name, c.place) for c in whole.failed]
    errors = [check.error for check in whole.failed]
    assert [check.error for check in single.failed] == pytest.approx(errors, rel=1e-9)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"samples": -1}, "samples=-1; give a whole number, 0 or more"),
        ({"seed": -1}, "seed=-1; give a whole number, 0 or more"),
        *(({"tolerance": t}, f"tolerance={t}; give a positive") for t in (0.0, -1e-9, math.nan, math.inf)),
        ({"frames": []}, "there are no frames to compare"),
    ],
)
def test_what_makes_no_sense_is_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        verify(ROBOT, **options)


# -------------------------------------------------------------------------------- frames and tolerances


def test_only_some_frames() -> None:
    """A frame that is left out does not count, and all may be asked for in any order."""
    engines = pair(0, edited(("0 0.4 0", "0 0.5 0")))  # the tool is turned
    assert verify(ROBOT, 2, engines=engines, frames=["l4", "base"]).ok
    report = verify(ROBOT, 2, engines=engines, frames=["tool"])
    assert not report.ok
    assert report.frames == 1
    assert {check.place.frame for check in report.failed} == {"tool"}
    assert verify(ROBOT, 2, frames=ROBOT.frame_names[::-1]).ok


def test_the_first_joint_is_named() -> None:
    """Of a pose the joint above the frame is told, the first one too; of the base none."""
    report = verify(ROBOT, 2, engines=pair(1, edited(('xyz="0 0 0.3"', 'xyz="0 0 0.31"'))), frames=["l1", "base"])
    places = {check.name: check.place for check in report.failed}
    assert (places["home poses"].frame, places["home poses"].joint) == ("l1", "j1")

    def alter(answers: Any, _frames: Any, _q: Any) -> None:
        answers.poses[..., 0, 3] += 1e-3

    moved = Altered(ps.PoE(ROBOT), alter)
    report = verify(ROBOT, 2, engines=(ps.PoE(ROBOT), moved), frames=["base"])
    (place,) = {(check.place.frame, check.place.joint) for check in report.failed if check.name == "home poses"}
    assert place == ("base", "")


def geared(multiplier: float, offset: float = 0.3) -> ps.Robot:
    joints = (
        urdfs.joint("j", "revolute", "base", "mid", xyz="0.1 0 0.2", axis="0 1 0"),
        urdfs.joint("k", "revolute", "mid", "tool", xyz="0.4 0 0", axis="0.6 0 0.8", mimic=("j", multiplier, offset)),
        urdfs.joint("m", "fixed", "tool", "tip", xyz="0.5 0 0"),
        urdfs.joint("slow", "revolute", "base", "other", xyz="0 0.3 0"),
    )
    return urdfs.load(urdfs.robot(*joints, links="base mid tool tip other"))


@pytest.mark.parametrize("multiplier", [1.0, -4.0, 30.0, 100.0])
def test_a_mimic_that_turns_fast_is_no_disagreement(multiplier: float) -> None:
    """Its Jacobian's columns are that many times as large, and so are their rounding and that of its angles."""
    report = verify(geared(multiplier), samples=100)
    assert report.ok, str(report)
    assert report.largest_difference < 2e-14
    assert speeds(geared(multiplier)).tolist() == [max(1.0, abs(multiplier)), 1.0]


def test_a_mimic_that_turns_fast_is_not_turned_farther_than_others() -> None:
    """Ten turns of the driven joint, and for the coordinate no less than its limits of ±2 rad."""
    for multiplier, farthest in ((4.0, FAR_ANGLE / 4), (100.0, 2.0)):
        where = configurations(geared(multiplier), 4000, 0)
        outside = abs(where.q[where.inside :]).max(axis=0)
        assert outside == pytest.approx([farthest, FAR_ANGLE], rel=0.01)
        assert (outside <= [farthest, FAR_ANGLE]).all()


@pytest.mark.parametrize("multiplier", [1.0, 30.0])
def test_a_small_mistake_in_a_mimic_that_turns_fast_is_one(multiplier: float) -> None:
    robot = geared(multiplier)
    engines = ps.PoE(robot), ps.PoE(geared(multiplier * (1.0 + 1e-10)))
    report = verify(robot, 20, engines=engines)
    numbers = {check.name for check in report.failed} - {"structure"}
    assert {"forward kinematics", "screw axes", "body Jacobian", "body Jacobian derivative"} <= numbers
    assert set(report.blamed) == {"k"}


def test_unknown_frame() -> None:
    with pytest.raises(UnknownNameError, match="there is no frame 'hand'; known are: base, l1"):
        verify(ROBOT, frames=["tool", "hand"])


def test_tolerance_is_respected() -> None:
    engines = pair(1, edited(("0.4 0 0", "0.400000001 0 0")))  # 1 nm
    strict, mild = (verify(ROBOT, 2, engines=engines, tolerance=t) for t in (0.5e-9, 2e-9))
    assert mild.ok
    assert "forward kinematics" in {check.name for check in strict.failed}
    (fk,) = (check for check in mild.checks if check.name == "forward kinematics")
    assert 0.5e-9 < fk.error <= 1.0001e-9
    assert fk.tolerance == 2e-9


@pytest.mark.filterwarnings("ignore:.*lengths are in metres")
def test_metres_are_divided_by_the_size() -> None:
    """1e-12 m are rounding for a robot of 400 m, whose entries of 400 have an ulp of 6e-14."""
    text = urdfs.chain(4).replace("1 0 0", "100 0 0")
    right, wrong = urdfs.load(text), urdfs.load(text.replace("100 0 0", "100.00000000005 0 0", 1))
    report = verify(right, 2, engines=(ps.PoE(right), ps.Pinocchio(wrong)))
    assert report.ok
    assert report.largest_difference == pytest.approx(5e-11 / 400, rel=0.05)


def test_places_reproduce_the_error() -> None:
    """Frame, joint and coordinates of a failed check are where the engines differ by its error."""
    wrong = edited(("0.4 0 0", "0.41 0 0"))
    engines = ps.PoE(ROBOT), ps.Pinocchio(wrong)
    checks = {check.name: check for check in verify(ROBOT, 20, engines=engines).failed}
    fk = checks["forward kinematics"].place
    poses = [engine.fk(fk.q, fk.frame) for engine in engines]
    size = sizes(ROBOT, np.array([fk.q]))
    assert comparison.pose_error(*(T[None] for T in poses), size) == checks["forward kinematics"].error
    body = checks["body Jacobian"].place
    column = ROBOT.velocity_names.index(body.joint)
    columns = [engine.jacobian(body.q, body.frame, "body")[None, :, [column]] for engine in engines]
    found = comparison.jacobian_error(*columns, sizes(ROBOT, np.array([body.q])))
    assert found.item() == pytest.approx(checks["body Jacobian"].error, rel=1e-9)
    where = configurations(ROBOT, 20, 0)
    for place in (fk, body):
        assert tuple(where.q[where.labels.index(place.configuration)]) == place.q


# --------------------------------------------------------------------------------------------- errors


def test_pose_error() -> None:
    a, b = np.zeros((2, 3, 4, 4)), np.zeros((2, 3, 4, 4))
    b[0, 1, 0, 3], b[0, 2, 1, 1], b[1, 0, 2, 3], b[1, 1, 3, 0], b[1, 2, 0, 0] = -4.0, 0.5, 4.0, -1.0, np.nan
    b[0, 0, 3, 3] = 0.25  # no length: it is divided by nothing
    expected = [[0.25, 2.0, 0.5], [1.0, 1.0, np.inf]]
    np.testing.assert_array_equal(comparison.pose_error(a, b, np.array([2.0, 4.0])), expected)


def test_jacobian_error() -> None:
    a, b = np.zeros((2, 1, 6, 2)), np.zeros((2, 1, 6, 2))
    b[0, 0, 2, 0], b[0, 0, 3, 1], b[1, 0, 0, 0], b[1, 0, 5, 1] = 4.0, 0.5, np.nan, np.nan
    expected = [[[2.0, 0.5]], [[np.inf, np.inf]]]
    np.testing.assert_array_equal(comparison.jacobian_error(a, b, np.array([2.0, 4.0])), expected)


@pytest.mark.parametrize("name", ["scara", "lead_screw", "gear_pair", "spherical"])
def test_difference_tolerance_is_tight(name: str) -> None:
    """Errors of the differences reach within three orders of the bound that is derived for them."""
    report = verify(ps.load(name), 20)
    for check in report.checks[-2:]:
        assert check.tolerance / 1000 < check.error < check.tolerance


def test_differences_take_the_leaves() -> None:
    robot = urdfs.load(urdfs.tree())
    assert differences.difference_frames(robot, robot.frame_names) == ("l2", "camera")
    assert differences.difference_frames(robot, ("base", "l1", "camera")) == ("camera",)
    assert differences.difference_frames(robot, ("base", "l1")) == ("base", "l1")


# -------------------------------------------------------------------------------------- configurations

EVERY = {name: urdfs.load(text) for name, text in urdfs.ROBOTS.items()}
EVERY["floating base"] = urdfs.load(urdfs.mimic(), floating_base=True)
ROBOTS = pytest.mark.parametrize("robot", EVERY.values(), ids=EVERY)


@ROBOTS
def test_configurations(robot: ps.Robot) -> None:
    where = configurations(robot, 40, 7)
    names = ["zero", "lower limits", "upper limits", "middle", *(f"corner {i}" for i in range(16))]
    names += [*(f"random {i}" for i in range(40)), *(f"far outside {i}" for i in range(10))]
    assert list(where.labels) == names
    assert where.inside == FIXED + 40
    assert where.q.shape == (len(names), robot.nq)
    np.testing.assert_array_equal(where.q[0], robot.neutral)
    np.testing.assert_array_equal(where.q, configurations(robot, 40, 7).q)
    assert where.qd.shape == (len(names), robot.nv)
    if robot.nv:
        np.testing.assert_allclose(np.linalg.norm(where.qd, axis=1), 1.0, rtol=1e-15)
    np.testing.assert_array_equal(where.scales, sizes(robot, where.q))
    lower, upper = effective_limits(robot).T
    free = quaternions(robot)
    inside = where.q[: where.inside, ~free]
    assert (lower[~free] <= inside).all()
    assert (inside <= upper[~free]).all()
    np.testing.assert_array_equal(where.q[1, ~free], lower[~free])
    np.testing.assert_array_equal(where.q[2, ~free], upper[~free])
    corners = where.q[4:20, ~free]
    assert ((corners == lower[~free]) | (corners == upper[~free])).all()
    for motion in robot.mechanism.motions:
        if motion.joint.type == "floating":
            norms = np.linalg.norm(where.q[:, motion.q + 3 : motion.q + 7], axis=1)
            np.testing.assert_allclose(norms, 1.0, rtol=1e-15)


def quaternions(robot: ps.Robot) -> FloatArray:
    return np.array([name[-3:] in (".qx", ".qy", ".qz", ".qw") for name in robot.coordinate_names], dtype=bool)


@ROBOTS
def test_far_outside_is_far(robot: ps.Robot) -> None:
    where = configurations(robot, 400, 0)
    far = where.q[where.inside :, ~quaternions(robot)]
    bound = np.where(angles(robot), FAR_ANGLE, FAR_DISTANCE * max(1.0, robot.reach))[~quaternions(robot)]
    if robot.nq == robot.nv:  # mimics that turn faster are not turned farther than this
        bound = bound / speeds(robot)
    assert (abs(far) <= bound).all()
    assert (abs(far).max(axis=0, initial=0.0) > 0.9 * bound).all()


def test_the_middle_of_limits_is_one_of_the_configurations() -> None:
    joint = urdfs.joint("j", "revolute", "base", "tool", limits=(-0.5, 1.5))
    where = configurations(urdfs.load(urdfs.robot(joint, links="base tool")), 3, 0)
    ends = {label: where.q[i].tolist() for i, label in enumerate(where.labels)}
    assert (ends["lower limits"], ends["middle"], ends["upper limits"]) == ([-0.5], [0.5], [1.5])


def test_velocities_are_of_norm_one_and_of_either_sign() -> None:
    where = configurations(ROBOT, 2000, 0)
    assert np.linalg.norm(where.qd, axis=1) == pytest.approx(np.ones(len(where.q)))
    assert abs(where.qd.mean(axis=0)).max() < 0.05


def test_effective_limits() -> None:
    robot = urdfs.load(
        urdfs.robot(
            urdfs.joint("turn", "revolute", "base", "a", limits=(-0.5, 1.5), xyz="3 0 0"),
            urdfs.joint("spin", "continuous", "a", "b"),
            urdfs.joint("wide", "revolute", "b", "c", limits=(-1e4, 1e4)),
            urdfs.joint("slide", "prismatic", "c", "d", limits=(-1e9, 0.25)),
            urdfs.joint("table", "planar", "d", "tool"),
            links="base a b c d tool",
        )
    )
    pi, far, size = np.pi, 20 * np.pi, 3.0
    expected = [(-0.5, 1.5), (-pi, pi), (-far, far), (-10 * size, 0.25), (-size, size), (-size, size), (-pi, pi)]
    np.testing.assert_array_equal(effective_limits(robot), expected)
    assert angles(robot).tolist() == [True, True, True, False, False, False, True]


def test_sizes() -> None:
    """Reach plus what prismatic, planar and floating joints draw out; mimics too; at least 1 m."""
    robot = urdfs.load(urdfs.mimic_chain())  # reach 0.3 + √0.05; the slide moves -0.5 m for each rad of c
    reach = 0.3 + math.sqrt(0.05)
    np.testing.assert_allclose(sizes(robot, np.array([[0.0], [4.0], [-4.0]])), [1.0, reach + 2, reach + 2], rtol=1e-15)
    floating = urdfs.load(urdfs.single_revolute(), floating_base=True)
    q = np.array([[3.0, 0, 4.0, 0, 0, 0, 1, 0.5]])
    np.testing.assert_allclose(sizes(floating, q), [5.0 + math.sqrt(0.38)], rtol=1e-15)


# ------------------------------------------------------------------------------------------ very many samples


def test_very_many_samples_are_asked_of_the_compiled_engine_too(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("llvmlite")
    from pinscrew.engines.compiled import walk
    from pinscrew.verification.compiled import MANY
    from pinscrew.verification.run import check_names

    robot = ps.load("one_joint")
    few, many = ps.verify(robot, 10), ps.verify(robot, MANY)
    assert tuple(check.name for check in few.checks) == check_names(10)
    assert tuple(check.name for check in many.checks) == check_names(MANY)
    extra = [check for check in many.checks if check.name not in check_names(10)]
    assert [check.name for check in extra] == ["forward kinematics, compiled", "body Jacobian, compiled"]
    assert many.ok
    right = walk._column
    monkeypatch.setattr(walk, "_column", lambda step, z, point: right(step, [-x for x in z], point))
    wrong = ps.verify(robot, MANY)
    assert [check.name for check in wrong.failed] == ["body Jacobian, compiled"]
    assert wrong.failed[0].place.frame == "tool"


@pytest.mark.parametrize(("fastest", "divisors"), [([1.0], (1.0, 1.0)), ([1.0, 1.0], (1.0, 1.0)), ([4.0], (4.0, 16.0))])
def test_errors_are_divided_by_how_fast_joints_move(fastest: list[float], divisors: tuple[float, float]) -> None:
    """Jacobians by the speed, derivatives by its square: no joint that moves with its coordinate is let off."""
    n = len(fastest)
    right, wrong = np.zeros((1, 1, 6, n)), np.zeros((1, 1, 6, n))
    wrong[0, 0, 5, 0] = 1.0
    a, b = (Answers(np.eye(4)[None, None], dict.fromkeys(KINDS, J), dict.fromkeys(KINDS, J)) for J in (right, wrong))
    checks = comparison.compare_answers(1.0)
    comparison.see_answers(checks, a, b, np.ones(1), np.array(fastest), 0)
    for kind in KINDS:
        assert checks[f"{kind} Jacobian"].error == 1.0 / divisors[0]
        assert checks[f"{kind} Jacobian derivative"].error == 1.0 / divisors[1]
