"""The PoE engine against matrix exponentials and finite differences, both computed here, and without Pinocchio."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

import pinscrew as ps
import urdfs
from pinscrew.engines.poe import BLOCK, _Chain
from pinscrew.ground.typing import KINDS, FloatArray, JacobianKind
from pinscrew.robot.mechanism import JointMotion

EPSILON = float(np.finfo(float).eps)
MOVING = [name for name in urdfs.ROBOTS if name not in ("no_joints", "only_fixed")]


@cache
def make(name: str, *, floating_base: bool = False) -> ps.PoE:
    return ps.PoE(urdfs.load(urdfs.ROBOTS[name], floating_base=floating_base))


def hat(xi: FloatArray) -> FloatArray:
    X = np.zeros((*xi.shape[:-1], 4, 4))
    X[..., 2, 1], X[..., 0, 2], X[..., 1, 0] = np.moveaxis(xi[..., 3:], -1, 0)
    X = X - X.swapaxes(-1, -2)
    X[..., :3, 3] = xi[..., :3]
    return X


def free_pose(motion: JointMotion, q: FloatArray) -> FloatArray:
    """The poses X that the coordinates (..., nq) of a planar or floating joint stand for."""
    X = np.tile(np.eye(4), (*q.shape[:-1], 1, 1))
    if motion.joint.type == "planar":
        X[..., :2, 3] = q[..., motion.q : motion.q + 2]
        X[..., :3, :3] = Rotation.from_rotvec(q[..., motion.q + 2, None] * [0.0, 0.0, 1.0]).as_matrix()
    else:
        X[..., :3, 3] = q[..., motion.q : motion.q + 3]
        X[..., :3, :3] = Rotation.from_quat(q[..., motion.q + 3 : motion.q + 7]).as_matrix()
    return X


def product(robot: ps.Robot, q: FloatArray, frame: str) -> FloatArray:
    """e^{ξ1 θ1} … e^{ξn θn} M of a batch by scipy, with T X T⁻¹ for free joints at T."""
    g = np.tile(np.eye(4), (len(q), 1, 1))
    for index in robot.motions_above(frame):
        motion = robot.mechanism.motions[index]
        if motion.joint.type in urdfs.SCALAR:
            g = g @ expm(hat(motion.twists[:, 0] * motion.multiplier * q[:, motion.q, None]))
        else:
            T = motion.T_base_child
            g = g @ T @ free_pose(motion, q) @ np.linalg.inv(T)
    return g @ robot.mechanism.homes[frame]


def moved(robot: ps.Robot, q: FloatArray, qd: FloatArray, t: float) -> FloatArray:
    """The configuration after time ``t`` at constant velocities."""
    q = q.copy()
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is not None:
            continue
        if motion.joint.type in urdfs.SCALAR:
            q[motion.q] += t * qd[motion.v]
            continue
        planar = motion.joint.type == "planar"
        twist = qd[motion.velocities]
        if planar:
            twist = np.array([twist[0], twist[1], 0, 0, 0, twist[2]])
        X = free_pose(motion, q) @ expm(hat(twist) * t)
        turn = Rotation.from_matrix(X[:3, :3])
        coordinates = [*X[:2, 3], turn.as_rotvec()[2]] if planar else [*X[:3, 3], *turn.as_quat()]
        q[motion.q : motion.q + len(coordinates)] = coordinates
    return q


# -------------------------------------------------------------------------------------- matrix exponentials


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_product_of_exponentials(name: str, floating_base: bool) -> None:
    """scipy's expm is right to some 10 ε ‖ξθ‖, and up to 9 of them are multiplied."""
    poe = make(name, floating_base=floating_base)
    q, _ = urdfs.sample(poe.robot, 20)
    for frame in poe.robot.frame_names:
        off = np.abs(poe.fk(q, frame) - product(poe.robot, q, frame)).max(axis=(1, 2))
        assert (off <= 90 * EPSILON * np.array([size(poe.robot, x) for x in q])).all()


def test_pose_and_jacobian_go_down_the_tree_once(monkeypatch: pytest.MonkeyPatch) -> None:
    engine = make("mimic_chain")
    q, _ = urdfs.sample(engine.robot, BLOCK + 1)
    frame = engine.robot.frame_names[-1]
    apart = engine.fk(q, frame), engine.jacobian(q, frame, "body")
    begun: list[int] = []
    begin = _Chain.__init__

    def counted(self: _Chain, *given: Any) -> None:
        begun.append(1)
        begin(self, *given)

    monkeypatch.setattr(_Chain, "__init__", counted)
    together = engine.fk_jacobian(q, frame, "body")
    assert len(begun) == 2, "one way for each block"
    for found, expected in zip(together, apart, strict=True):
        np.testing.assert_array_equal(found, expected)


# -------------------------------------------------------------------------------------- finite differences
# Central differences of four points, f' = (f(-2h) - 8 f(-h) + 8 f(h) - f(2h)) / 12h, are wrong by at most
# h⁴/30 max|f⁽⁵⁾| by truncation and 18/12h u by rounding, where u is the error of one f.
#
# With the rates' sum K = Σ |m| Σ|q̇| and the length S of the way to the frame, f is a sum of products of sines and
# cosines, whose rates sum up to K, times lengths that sum up to S and change by K at most: |f⁽⁵⁾| ≤ 5 K⁵ S. An f has
# some 64 roundings of things up to S: u = 64 ε S. So with h = 0.002/K the error is at most K S times
# 5 · 0.002⁴/30 + 1.5 · 64 ε/0.002.

STEP = 0.002
RELATIVE = 5 * STEP**4 / 30 + 1.5 * 64 * EPSILON / STEP


def rates(robot: ps.Robot, qd: FloatArray) -> float:
    """K, at least 1."""
    return max(1.0, sum(abs(m.multiplier) * np.abs(qd[m.velocities]).sum() for m in robot.mechanism.motions))


def size(robot: ps.Robot, q: FloatArray) -> float:
    """S, taking angles for lengths, too."""
    return 1.0 + robot.reach + sum(abs(m.multiplier) for m in robot.mechanism.motions) * float(np.abs(q).sum())


def stencil(robot: ps.Robot, q: FloatArray, qd: FloatArray) -> tuple[FloatArray, float]:
    """The four configurations, shape (4, nq), and h."""
    h = STEP / rates(robot, qd)
    return np.array([moved(robot, q, qd, k * h) for k in (-2, -1, 1, 2)]), h


def difference(f: FloatArray, h: float) -> FloatArray:
    return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * h)


def twist_of(X: FloatArray) -> FloatArray:
    """(v, ω) of a nearly skew X, the skew part of it."""
    W = (X[:3, :3] - X[:3, :3].T) / 2
    return np.array([*X[:3, 3], W[2, 1], W[0, 2], W[1, 0]])


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", MOVING)
def test_jacobians_are_the_derivatives_of_poses(name: str, floating_base: bool) -> None:
    poe = make(name, floating_base=floating_base)
    robot = poe.robot
    units = np.eye(robot.nv)
    for q in urdfs.sample(robot, 3)[0]:
        points, steps = zip(*(stencil(robot, q, unit) for unit in units), strict=True)
        # Ṫ T⁻¹ and T⁻¹ Ṫ multiply errors by those of a pose, up to S: 2 S is enough.
        tolerances = [2 * size(robot, q) ** 2 * rates(robot, unit) * RELATIVE for unit in units]
        for frame in robot.frame_names:
            T = poe.fk(q, frame)
            inverse, still = np.linalg.inv(T), np.eye(4)
            still[:3, 3] = T[:3, 3]
            found = {kind: poe.jacobian(q, frame, kind) for kind in KINDS}
            for column, poses in enumerate(poe.fk(np.array(points), frame)):
                rate = difference(poses, steps[column])
                expected: dict[JacobianKind, FloatArray] = {
                    "spatial": twist_of(rate @ inverse),
                    "body": twist_of(inverse @ rate),
                    "hybrid": twist_of(rate @ inverse @ still),
                }
                for kind in KINDS:
                    assert np.abs(found[kind][:, column] - expected[kind]).max() <= tolerances[column], (frame, kind)


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", MOVING)
@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_are_those_of_jacobians(name: str, floating_base: bool, kind: JacobianKind) -> None:
    poe = make(name, floating_base=floating_base)
    robot = poe.robot
    for q, qd in zip(*urdfs.sample(robot, 3), strict=True):
        points, h = stencil(robot, q, qd)
        tolerance = rates(robot, qd) * size(robot, q) * RELATIVE
        for frame in robot.frame_names:
            expected = difference(poe.jacobian(points, frame, kind), h)
            found = poe.jacobian_derivative(q, qd, frame, kind)
            assert np.abs(found - expected).max() <= tolerance, frame


def test_a_wrong_derivative_is_seen() -> None:
    """The tolerance of finite differences is tight: it would see an error of 1e-7 in size."""
    robot = make("rotated").robot
    q, qd = (x[0] for x in urdfs.sample(robot, 1))
    assert rates(robot, qd) * size(robot, q) * RELATIVE < 1e-8


# ------------------------------------------------------------------------------------- blocks and long chains


@pytest.mark.parametrize("count", [BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 7])
@pytest.mark.parametrize("name", ["floating_middle", "mimic_chain", "tree", "only_fixed"])
def test_blocks(name: str, count: int) -> None:
    """A batch of several blocks, not all of them full, is answered as its halves are, and one by one."""
    poe = make(name)
    frame = poe.robot.frame_names[-1]
    q, qd = urdfs.sample(poe.robot, count)
    pose, J, dJ = poe.fk(q, frame), poe.jacobian(q, frame, "body"), poe.jacobian_derivative(q, qd, frame, "hybrid")
    answers = poe.answers(q, qd, [frame])
    np.testing.assert_array_equal(answers.poses[:, 0], pose)
    np.testing.assert_array_equal(answers.jacobians["body"][:, 0], J)
    np.testing.assert_array_equal(answers.derivatives["hybrid"][:, 0], dJ)
    for i in (0, 1, count // 2, BLOCK - 2, count - 2, count - 1):
        for found, alone in (
            (pose[i], poe.fk(q[i], frame)),
            (J[i], poe.jacobian(q[i], frame, "body")),
            (dJ[i], poe.jacobian_derivative(q[i], qd[i], frame, "hybrid")),
        ):
            np.testing.assert_allclose(found, alone, atol=1e-13, rtol=0, equal_nan=False)


def test_ten_thousand_links() -> None:
    """No recursion, and nothing that grows with the square: some 2 s, nearly all of them for reading the file."""
    length = 9_999
    robot = urdfs.load(urdfs.chain(length))
    q = np.random.default_rng(0).uniform(-1.0, 1.0, length)
    angles = np.cumsum(q)
    heading = np.concatenate([[0.0], angles[:-1]])
    T = ps.PoE(robot).fk(q)
    expected = np.eye(4)
    expected[:2, :2] = [[np.cos(angles[-1]), -np.sin(angles[-1])], [np.sin(angles[-1]), np.cos(angles[-1])]]
    expected[:2, 3] = np.cos(heading).sum(), np.sin(heading).sum()
    # 10⁴ rotations by 4 roundings each turn links of 1 m each: at worst 4 ε 10⁴ 10⁴ / 2.
    assert np.abs(T - expected).max() <= 2 * EPSILON * length**2
    assert np.abs(T[:3, :3] - expected[:3, :3]).max() <= 4 * EPSILON * length


# ------------------------------------------------------------------------------------------------ independence

WITHOUT_PINOCCHIO = """
import json, sys
import numpy as np
if sys.argv[1] == "blocked":
    sys.modules["pinocchio"] = None
import pinscrew as ps
for name in ("planar_2r", "drone"):
    robot = ps.load(name)
    poe = ps.PoE(robot)
    q, qd = np.full(robot.nq, 0.3), np.full(robot.nv, 0.7)
    print(json.dumps(poe.fk(q).tolist()))
    print(json.dumps(poe.jacobian(q, None, "body").tolist()))
    print(json.dumps(poe.jacobian_derivative(q, qd, None, "WORLD").tolist()))
floating = ps.load("drone", floating_base=True)
ps.PoE(floating).answers(floating.neutral[None], np.ones((1, floating.nv)), floating.frame_names)
assert sys.modules.get("pinocchio") is None, "pinocchio was imported"
if sys.argv[1] == "blocked":
    try:
        ps.Pinocchio
    except ImportError:
        print("refused")
"""


def run(mode: str) -> list[str]:
    command = [sys.executable, "-W", "error", "-c", WITHOUT_PINOCCHIO, mode]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()


def test_without_pinocchio() -> None:
    """PoE never imports Pinocchio, and answers the same where there is none."""
    free, blocked = run("free"), run("blocked")
    assert len(free) == 6
    assert blocked == [*free, "refused"]


def test_the_text_is_not_read() -> None:
    """PoE asks the description, not the file that Pinocchio reads."""
    robot = make("rotated").robot
    q, _ = urdfs.sample(robot, 5)
    other = dataclasses.replace(robot.description, text="no XML")
    np.testing.assert_array_equal(ps.PoE(ps.Robot.from_description(other)).fk(q), make("rotated").fk(q))


def test_poses_of_several_frames_are_those_of_each() -> None:
    """Against Pinocchio, over more than one block of configurations; with the checks that every question has."""
    robot = urdfs.load(urdfs.tree())
    q, _ = urdfs.sample(robot, 300)
    frames = ["camera", "l2", "base"]
    T = ps.PoE(robot).poses(q, frames)
    pin = ps.Pinocchio(robot)
    assert pytest.approx(np.stack([pin.fk(q, frame) for frame in frames], axis=1), abs=1e-12) == T
    with pytest.raises(ps.PinscrewError):
        ps.PoE(robot).poses(q, ["nowhere"])
    with pytest.raises(ps.PinscrewError):
        ps.PoE(robot).poses(q * np.nan, frames)
