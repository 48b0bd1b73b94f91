"""Inverse kinematics: targets from Pinocchio are reached and checked by it; others are said not to be."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import AmbiguousTipError, InputError, UnknownNameError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.motion.descent import Descent
from pinscrew.motion.freedoms import freedoms

BUNDLED = (
    "spherical",
    "planar_2r",
    "scara",
    "stanford",
    "planar_rrr",
    "drone",
    "anthropomorphic",
    "one_joint",
    "two_joint",
    "gear_pair",
    "bevel_pair",
    "lead_screw",
)
ARMS = {**dict.fromkeys(BUNDLED), "ur5_robot": "tool0", "panda": "panda_hand_tcp"}
"""Robots, and the frame that is to be put somewhere where there is more than one tip."""


@cache
def load(name: str) -> ps.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ps.load(name)


def targets(robot: ps.Robot, frame: str | None, count: int, seed: int) -> FloatArray:
    """Poses at random configurations within the limits, all joints' own, by Pinocchio."""
    lower, upper = robot.limits.T
    q = np.random.default_rng(seed).uniform(lower, upper, (count, robot.nq))
    return ps.Pinocchio(robot).fk(q, frame)


def assert_right(robot: ps.Robot, T: FloatArray, solution: ps.Solution, task: str = "pose") -> None:
    """What is called solved is within 1e-9 of the target, by Pinocchio, and everything is within the limits."""
    lower, upper = robot.limits.T
    assert (solution.q >= lower).all()
    assert (solution.q <= upper).all()
    found = ps.Pinocchio(robot).fk(solution.q, solution.frame)
    distance = np.linalg.norm(found[..., :3, 3] - T[..., :3, 3], axis=-1)
    # ‖R - R'‖ = 2√2 sin(θ/2)
    angle = np.linalg.norm(found[..., :3, :3] - T[..., :3, :3], axis=(-2, -1)) / np.sqrt(2.0)
    assert (distance[solution.solved] < 1e-9).all()
    if task == "pose":
        assert (angle[solution.solved] < 1e-9).all()
    assert abs(distance - solution.position_error).max(initial=0.0) < 1e-12
    assert ((solution.reason == "") == solution.solved).all()


# ------------------------------------------------------------------------------------------- what is reachable


@pytest.mark.parametrize("name", ARMS)
def test_reachable(name: str) -> None:
    robot = load(name)
    T = targets(robot, ARMS[name], 100, seed=1)
    solution = ps.ik(robot, T, frame=ARMS[name])
    assert_right(robot, T, solution)
    assert solution.ok, str(solution)


@pytest.mark.slow
@pytest.mark.parametrize("task", ["pose", "position"])
@pytest.mark.parametrize("name", ARMS)
def test_reachable_many(name: str, task: Any) -> None:
    robot = load(name)
    T = targets(robot, ARMS[name], 1000, seed=2)
    solution = ps.ik(robot, T, frame=ARMS[name], task=task)
    assert_right(robot, T, solution, task)
    assert solution.solved.mean() >= 0.995, str(solution)


@pytest.mark.parametrize("name", ["planar_2r", "scara", "ur5_robot"])
def test_position(name: str) -> None:
    robot = load(name)
    T = targets(robot, ARMS[name], 50, seed=3)
    T[:, :3, :3] = np.eye(3)  # which plays no part
    solution = ps.ik(robot, T, frame=ARMS[name], task="position")
    assert_right(robot, T, solution, "position")
    assert solution.ok, str(solution)


def test_at_singularities() -> None:
    """Targets at the edge of the workspace and in folded and stretched arms, where Newton's method is slow."""
    robot, frame = load("ur5_robot"), "tool0"
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (60, 6))
    q[:20, 2], q[20:40, 4], q[40:, 2], q[40:, 4] = 0.0, np.pi, 0.0, 0.0
    T = ps.Pinocchio(robot).fk(q, frame)
    solution = ps.ik(robot, T, frame=frame)
    assert_right(robot, T, solution)
    assert solution.ok, str(solution)


def test_limits_in_corners() -> None:
    """Where every joint is at a limit, the only way may be along the limits."""
    for name in ("planar_2r", "panda"):
        robot = load(name)
        corners = np.random.default_rng(5).integers(0, 2, (20, robot.nq)).astype(bool)
        T = ps.Pinocchio(robot).fk(np.where(corners, *robot.limits.T), ARMS[name])
        solution = ps.ik(robot, T, frame=ARMS[name])
        assert_right(robot, T, solution)
        assert solution.ok, str(solution)


def test_sharing_one_drive() -> None:
    """Mimic joints move with their masters: of both kinds, across the tree, and with offsets."""
    for text in (urdfs.mimic(), urdfs.mimic_chain(), urdfs.mimic_continuous()):
        robot = urdfs.load(text)
        q, _ = urdfs.sample(robot, 50)
        q = np.clip(q, *robot.limits.T)
        T = ps.Pinocchio(robot).fk(q)
        solution = ps.ik(robot, T)
        assert_right(robot, T, solution)
        assert solution.ok, str(solution)


# ------------------------------------------------------------------------------------------------- starts


def test_q0_leads_to_the_nearest() -> None:
    robot, frame = load("panda"), "panda_hand_tcp"
    rng = np.random.default_rng(6)
    lower, upper = robot.limits.T
    q0 = rng.uniform(0.9 * lower + 0.1 * upper, 0.1 * lower + 0.9 * upper, (50, robot.nq))
    q0[:, 7] = 0.013  # a finger, which does not move the frame
    step = rng.uniform(-0.02, 0.02, q0.shape)
    T = ps.Pinocchio(robot).fk(q0 + step, frame)
    solution = ps.ik(robot, T, q0, frame=frame)
    assert_right(robot, T, solution)
    assert solution.ok
    assert abs(solution.q[:, :7] - q0[:, :7]).max() < 0.3
    assert (solution.q[:, 7] == 0.013).all()


def test_whole_turns() -> None:
    """Angles come out nearest to q0, by whole turns, without one nearest to 0; and never past a limit."""
    robot, frame = load("ur5_robot"), "tool0"
    q0 = np.array([6.0, -1.2, 1.1, -5.5, 1.0, 3.5])
    T = ps.Pinocchio(robot).fk(q0, frame)
    assert abs(ps.ik(robot, T, q0, frame=frame).q - q0).max() < 1e-9
    assert abs(ps.ik(robot, T, frame=frame).q).max() <= np.pi
    turning = urdfs.load(urdfs.continuous())
    q0 = np.array([40.0, -90.0])
    T = ps.PoE(turning).fk(q0 + 0.1)
    assert abs(ps.ik(turning, T, q0).q - q0 - 0.1).max() < 1e-8
    assert abs(ps.ik(turning, T).q).max() <= np.pi


def test_deterministic() -> None:
    robot = load("anthropomorphic")
    T = targets(robot, None, 20, seed=7)
    first, again = ps.ik(robot, T, seed=3), ps.ik(robot, T, seed=3)
    assert (first.q == again.q).all()
    assert abs(ps.ik(robot, T[5], seed=3).q - first.q[5]).max() < 1e-9


def test_batches() -> None:
    robot = load("planar_rrr")
    T = targets(robot, None, 6, seed=8).reshape(2, 3, 4, 4)
    solution = ps.ik(robot, T, np.zeros((3, 3)))
    assert solution.q.shape == (2, 3, 3)
    assert solution.solved.shape == solution.position_error.shape == solution.reason.shape == (2, 3)
    empty = ps.ik(robot, np.zeros((0, 4, 4)))
    assert (empty.q.shape, empty.ok, str(empty)) == ((0, 3), True, "planar_rrr, pose of tool: 0 of 0 reached")
    one = ps.ik(robot, T[0, 0])
    assert one.q.shape == (3,)
    assert one.solved.shape == ()


def test_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = load("scara")
    T = targets(robot, None, 7, seed=9)
    whole = ps.ik(robot, T)
    monkeypatch.setattr("pinscrew.motion.inverse_kinematics.BLOCK", 3)
    assert abs(ps.ik(robot, T).q - whole.q).max() < 1e-9


# ----------------------------------------------------------------------------------------- what is not reachable


def test_beyond_reach() -> None:
    """The nearest point of a stretched arm is on the line to the target: the distance is known."""
    robot = ps.load("planar_rrr", l1=0.5, l2=0.4, l3=0.3)
    T = np.eye(4)
    T[:3, 3] = [1.5, 0.7, 0.0]
    solution = ps.ik(robot, T, task="position")
    assert (solution.ok, str(solution.reason)) == (False, "unreachable")
    assert solution.position_error == pytest.approx(np.hypot(1.5, 0.7) - 1.2, abs=1e-9)
    assert "0 of 1 reached" in str(solution)
    assert "unreachable: 1" in str(solution)
    T[2, 3] = 0.4  # within reach in the plane, but above it
    T[:2, 3] = [0.3, 0.2]
    solution = ps.ik(robot, T, task="position")
    assert str(solution.reason) == "unreachable"
    assert solution.position_error == pytest.approx(0.4, abs=1e-9)


def test_impossible_orientation() -> None:
    robot = load("planar_rrr")
    T = se3.exp([0.0, 0.0, 0.0, 0.5, 0.0, 0.0])  # a planar arm can't tilt its tool
    T[:3, 3] = [0.3, 0.2, 0.0]
    solution = ps.ik(robot, T)
    assert (solution.ok, str(solution.reason)) == (False, "unreachable")
    assert solution.angle_error == pytest.approx(0.5, abs=1e-6)
    assert solution.position_error < 1e-6
    assert ps.ik(robot, T, task="position").ok


@pytest.mark.parametrize(
    ("name", "q"), [("planar_2r", [-1.5, 0.3]), ("spherical", [0.3, 0.3, 0.6]), ("scara", [0.1, 0.2, -0.1])]
)
def test_outside_limits(name: str, q: list[float]) -> None:
    robot = load(name)
    T = ps.Pinocchio(robot).fk(q)
    solution = ps.ik(robot, T)
    assert_right(robot, T, solution)
    assert (solution.ok, str(solution.reason)) == (False, "outside limits")
    wider = ps.ik(robot, T, limits=[(-3.0, 3.0)] * robot.nq)
    assert wider.ok
    assert abs(ps.Pinocchio(robot).fk(wider.q) - T).max() < 1e-9


def test_nearest_within_limits() -> None:
    """What is not reached is approached as far as the limits allow: against scipy's bounded minimisation."""
    robot = load("planar_rrr")
    pin = ps.Pinocchio(robot)
    limits = np.array([[-0.5, 0.5], [-0.7, 0.3], [0.2, 1.0]])
    rng = np.random.default_rng(13)
    T = np.tile(np.eye(4), (15, 1, 1))
    T[:, :2, 3] = rng.uniform(-1.5, 1.5, (15, 2))
    solution = ps.ik(robot, T, limits=limits, task="position", starts=20)
    for pose, distance in zip(T, solution.position_error, strict=True):

        def square(q: FloatArray, p: FloatArray = pose[:3, 3]) -> float:
            return float(((pin.fk(q)[:3, 3] - p) ** 2).sum())

        options = {"ftol": 1e-15, "gtol": 1e-10}
        found = [minimize(square, q, bounds=limits, options=options).fun for q in rng.uniform(*limits.T, (2, 3))]
        assert distance <= np.sqrt(min(found)) + 1e-6
    assert {"outside limits", "unreachable"} <= set(solution.reason)


def test_mixed_reasons() -> None:
    """In one batch, each target has its own answer."""
    robot = load("spherical")
    pin = ps.Pinocchio(robot)
    T = np.stack(
        [pin.fk([0.1, 0.2, 0.3]), pin.fk([0.1, 0.2, 0.7]), pin.fk([0.1, 0.2, 0.3]) @ se3.exp([0, 0, 0, 0, 1, 0])]
    )
    solution = ps.ik(robot, T)
    assert solution.reason.tolist() == ["", "outside limits", "unreachable"]
    assert solution.solved.tolist() == [True, False, False]


def test_stalled() -> None:
    """A search that is cut short says so rather than that there is no way."""
    robot = load("planar_rrr")
    with pytest.MonkeyPatch.context() as patch:
        for name in ("STEPS", "LAST_STEPS"):
            patch.setattr(f"pinscrew.motion.search.{name}", 1)
        solution = ps.ik(robot, targets(robot, None, 20, seed=10), starts=1)
    assert set(solution.reason[~solution.solved]) == {"stalled"}
    assert not solution.ok


class Bent(ps.PoE):
    """An engine whose frames are all a micrometre too high."""

    def _poses(self, q: FloatArray, frame: str) -> FloatArray:
        T = super()._poses(q, frame)
        T[:, 2, 3] += 1e-6
        return T


@pytest.mark.parametrize("wrong", [0, 1])
def test_wrong_engine(wrong: int) -> None:
    """If an engine is wrong, in searching or in checking, nothing is called solved."""
    robot = load("scara")
    engines: list[Any] = [ps.PoE(robot), ps.Pinocchio(robot)]
    engines[wrong] = Bent(robot)
    solution = ps.ik(robot, targets(robot, None, 5, seed=11), engines=(engines[0], engines[1]))
    assert not solution.solved.any()
    assert set(solution.reason) == {"unconfirmed"}


def test_never_wrong_by_the_descent(monkeypatch: pytest.MonkeyPatch) -> None:
    """If the descent takes anything for converged, the check at the end does not."""
    run = Descent.run

    def lying(self: Descent, *args: Any, **options: Any) -> Any:
        lanes = run(self, *args, **options)
        lanes.converged[:] = True
        return lanes

    monkeypatch.setattr(Descent, "run", lying)
    robot = load("anthropomorphic")
    T = targets(robot, None, 50, seed=12)
    T[:, :3, 3] *= 1.5
    solution = ps.ik(robot, T)
    assert_right(robot, T, solution)
    assert "unconfirmed" in solution.reason


@settings(max_examples=4, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(["planar_2r", "scara", "anthropomorphic", "ur5_robot"]))
def test_never_wrong(seed: int, name: str) -> None:
    """Poses anywhere: what is called solved is right, what is not has a reason, and nothing is past a limit."""
    robot = load(name)
    rng = np.random.default_rng(seed)
    T = se3.exp(rng.uniform(-1.0, 1.0, (5, 6)) * [1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    assert_right(robot, T, ps.ik(robot, T, frame=ARMS[name], starts=10))
    T[:, :3, :3] = np.eye(3)
    assert_right(robot, T, ps.ik(robot, T, frame=ARMS[name], task="position", starts=10), "position")


# ----------------------------------------------------------------------------------------------- bad input

TARGET = np.eye(4)
TILTED = np.diag([1.0, 1.0, -1.0, 1.0])
ENDLESS = [(-np.inf, np.inf)] * 3


@pytest.mark.parametrize(
    ("ask", "code", "words"),
    [
        (lambda r: ps.ik(r, np.eye(3)), "shape", r"T_base_tip has shape \(3, 3\)"),
        (lambda r: ps.ik(r, "pose"), "not-numbers", "T_base_tip is no array of numbers"),
        (lambda r: ps.ik(r, TARGET * np.nan), "not-finite", "T_base_tip is not finite"),
        (lambda r: ps.ik(r, TILTED), "not-a-rotation", "is no rotation"),
        (lambda r: ps.ik(r, TARGET + np.eye(4)[3]), "not-a-pose", "has the bottom row"),
        (lambda r: ps.ik(r, TARGET, [0.0, 0.0]), "shape", r"q0 has shape \(2,\)"),
        (lambda r: ps.ik(r, TARGET, [0.0, 0.0, np.inf]), "not-finite", "q0 is not finite"),
        (lambda r: ps.ik(r, TARGET, [0.0, 4.0, 0.0]), "outside-limits", "'joint2' outside its limits"),
        (lambda r: ps.ik(r, np.stack([TARGET] * 2), np.zeros((3, 3))), "shape", "do not broadcast"),
        (lambda r: ps.ik(r, TARGET, task="orientation"), "task", "use 'pose' or 'position'"),
        (lambda r: ps.ik(r, TARGET, starts=0), "starts", "starts=0"),
        (lambda r: ps.ik(r, TARGET, starts=1.5), "starts", "a whole number"),
        (lambda r: ps.ik(r, TARGET, seed=-1), "seed", "seed=-1"),
        (lambda r: ps.ik(r, TARGET, tolerance=0.0), "tolerance", "tolerance=0.0"),
        (lambda r: ps.ik(r, TARGET, tolerance=np.nan), "tolerance", "tolerance=nan"),
        (lambda r: ps.ik(r, TARGET, frame="base"), "nothing-moves", "no joint moves the frame 'base'"),
        (lambda r: ps.ik(r, TARGET, limits=[(0.0, 1.0)]), "shape", r"limits has shape \(1, 2\)"),
        (lambda r: ps.ik(r, TARGET, limits=[(1.0, 0.0)] * 3), "limits", "the limits of 'joint1' are"),
        (lambda r: ps.ik(r, TARGET, limits=[(0.0, np.nan)] * 3), "limits", "the limits of 'joint1' are"),
        (lambda r: ps.ik(r, TARGET, limits=ENDLESS), "limits", "the displacement 'joint3' has no limits"),
    ],
)
def test_bad_input(ask: Callable[[ps.Robot], object], code: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        ask(load("scara"))
    assert caught.value.code == code


def test_bad_frames() -> None:
    with pytest.raises(UnknownNameError, match="there is no frame 'hand'"):
        ps.ik(load("scara"), TARGET, frame="hand")
    with pytest.raises(AmbiguousTipError, match="3 leaves"):
        ps.ik(load("panda"), TARGET)
    for text in (urdfs.planar(), urdfs.floating_middle()):
        with pytest.raises(InputError, match=r"joint '(table|free)' moves the frame 'tool'") as caught:
            ps.ik(urdfs.load(text), TARGET)
        assert caught.value.code == "free-joint"
    for text in (urdfs.no_joints(), urdfs.only_fixed()):
        with pytest.raises(InputError, match="no joint moves") as caught:
            ps.ik(urdfs.load(text), TARGET)
        assert caught.value.code == "nothing-moves"


# ------------------------------------------------------------------------------------- freedoms and the page


def test_the_page_does_what_it_shows(capsys: pytest.CaptureFixture[str]) -> None:
    """Its Python runs, and prints what its comments say; but for what needs pink."""
    text = (Path(__file__).resolve().parents[2] / "docs" / "inverse_kinematics.md").read_text(encoding="utf-8")
    code = "".join(re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL))
    exec(code, {})  # noqa: S102 (our own page)
    printed = capsys.readouterr().out
    assert printed.startswith("scara_rrp, pose of tool: 1 of 1 reached, largest error ")
    assert "\n".join(line.removeprefix("# ") for line in code.splitlines() if line.startswith("# ")) in printed


def test_characteristic_length() -> None:
    """The longest way to the frame: over the origins, and with the slides drawn out."""
    assert freedoms(ps.load("planar_rrr", l1=0.5, l2=0.4, l3=0.3)).length == pytest.approx(1.2)
    assert freedoms(ps.load("spherical", L0=0.5, L3=0.8)).length == pytest.approx(0.5 + 0.8 + 0.4)
    assert freedoms(ps.load("lead_screw", lead=0.005)).length == pytest.approx(0.05)
    assert freedoms(ps.load("gear_pair"), length=2.0).length == 2.0
    turn = urdfs.robot(urdfs.joint("j", "continuous", "base", "tool"), links="base tool")
    assert freedoms(urdfs.load(turn)).length == 1.0
    with pytest.raises(InputError, match="length=0"):
        freedoms(load("scara"), length=0.0)


def test_turns() -> None:
    """A joint may turn freely where a whole turn moves neither its own limits' sense nor what mimics it."""
    assert freedoms(load("lead_screw")).turns.tolist() == [False]  # it moves along
    assert freedoms(load("scara")).turns.tolist() == [True, True, False]
    assert freedoms(urdfs.load(urdfs.mimic_continuous())).turns.tolist() == [True, False]  # × 3, × 0.5
