"""Closed forms of the motion between any two frames, against Pinocchio's poses and their differences."""

from __future__ import annotations

from typing import Final

import numpy as np
import pytest
import sympy as sp

import pinscrew as ps
import urdfs
from command_line import ok
from pinscrew.derivation.forms import ClosedForms
from pinscrew.ground.errors import UnknownNameError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

PAIRS: Final = [
    ("scara", "link1", "link2"),
    ("scara", "tool", "base"),
    ("anthropomorphic", "link1", "tool"),
    ("stanford", "tool", "link1"),
    ("lead_screw", "tool", "base"),
    ("gear_pair", "gear1", "tool"),
    ("planar_2r", "frame0", "tool"),
]


def relative(robot: Robot, q: FloatArray, reference: str, tip: str) -> FloatArray:
    engine = ps.Pinocchio(robot)
    T: FloatArray = se3.inverse(engine.fk(q, reference)) @ engine.fk(q, tip)
    return T


def value(robot: Robot, d: ClosedForms, matrix: sp.Matrix, q: FloatArray) -> FloatArray:
    """A matrix of a derivation at a configuration."""
    at = {v.symbol: float(q[robot.coordinate_names.index(v.joint)]) for v in d.coordinates}
    numbers = {**{s: float(x) for s, x in d.lengths.items()}, **at}
    follows = {s: expression.subs(numbers) for s, expression in d.follows.items()}
    plain = matrix
    for _ in range(3):  # short forms are of sums of joints, and those of others
        plain = plain.subs(d.atoms.explicit)
    return np.array(plain.subs(follows).subs(numbers), dtype=np.float64)


@pytest.mark.parametrize(("name", "reference", "tip"), PAIRS)
def test_the_pose_between_two_frames(name: str, reference: str, tip: str) -> None:
    robot = ps.load(name)
    d = ps.derive(robot, tip, reference=reference)
    assert (d.reference, d.tip) == (reference, tip)
    for q in np.random.default_rng(1).uniform(-1.0, 1.0, (4, robot.nq)):
        np.testing.assert_allclose(value(robot, d, d.pose, q), relative(robot, q, reference, tip), atol=1e-12)


@pytest.mark.parametrize(("name", "reference", "tip"), PAIRS)
def test_it_is_proved(name: str, reference: str, tip: str) -> None:
    proof = ps.derive(name, tip, reference=reference).prove(samples=4)
    assert proof.ok, proof


def test_between_the_branches_of_a_tree() -> None:
    """In along one branch, with its joints the other way round, and out along the other; mimics have offsets."""
    arm = urdfs.robot(
        urdfs.joint("column", "prismatic", "base", "top", axis="0 0 1"),
        urdfs.joint("left", "revolute", "top", "l1", xyz="0 0.2 0", rpy="0.5 0 0", axis="0 1 0"),
        urdfs.joint("left2", "prismatic", "l1", "l2", xyz="0.3 0 0", axis="1 0 0", mimic=("left", 0.1, 0.05)),
        urdfs.joint("right", "revolute", "top", "r1", xyz="0 -0.2 0", rpy="0 0 1.5707963267948966", axis="0 0 1"),
        urdfs.joint("right2", "revolute", "r1", "r2", xyz="0.4 0 0", axis="1 0 0", mimic=("right", -2.0, 0.3)),
        links="base top l1 l2 r1 r2",
    )
    robot = urdfs.load(arm)
    d = ps.derive(robot, "r2", reference="l2")
    assert {v.joint for v in d.coordinates} == {"left", "right"}
    assert d.prove(samples=4).ok
    assert ps.derive(robot, "l2", reference="r2").prove(samples=4).ok
    base = ps.derive(robot, "r2")
    assert (base.reference, base.prove(samples=2).ok) == ("base", True)


def test_another_choice_of_frame_0() -> None:
    """Of planar_2r: in frame0 the axes go through [-1, -1, 0] and [-1, 0, 0] (its file says so)."""
    d = ps.derive("planar_2r", reference="frame0")
    points = [[float(x) for x in screw.q[:2]] for screw in d.screws]  # of lines along z
    np.testing.assert_allclose(points, [[-1, -1], [-1, 0]], atol=1e-15)
    np.testing.assert_allclose(np.array(d.home, dtype=float), np.eye(4), atol=1e-15)


def test_a_wrong_reference_is_caught() -> None:
    """The proof asks the engines for the frame that the report names."""
    d = ps.derive("scara", "tool", reference="link1")
    assert d.prove(samples=3).ok
    object.__setattr__(d, "reference", "link2")
    assert not d.prove(samples=3).ok


def test_no_such_frame() -> None:
    with pytest.raises(UnknownNameError):
        ps.derive("scara", reference="nowhere")


def test_on_the_command_line() -> None:
    words = ok("derive", "scara", "--from", "link1", "--tip", "link2", "--part", "T", "--samples", "2").out
    assert "The motion of the frame `link2` in `link1`." in words
    same = ok("derive", "scara", "--reference", "link1", "--tip", "link2", "--part", "T", "--samples", "2").out
    assert same == words
    code = ok("derive", "scara", "--from", "tool", "--tip", "base", "--code", "python", "--samples", "2").out
    assert "frame base in frame tool" in code
