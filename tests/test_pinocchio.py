"""The Pinocchio engine: the same answers as PoE, from the file alone, and plain words where it has none."""

from __future__ import annotations

import dataclasses
import os
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import pinscrew as ps
import urdfs
from pinscrew.description.model import Limits, Mimic
from pinscrew.engines import expansion
from pinscrew.engines.base import Answers
from pinscrew.engines.pinocchio import MAX_COORDINATES, MAX_DEPTH
from pinscrew.ground.errors import EngineError, PinscrewWarning, UnsupportedError
from pinscrew.ground.typing import KINDS, FloatArray

AGREEMENT = 1e-13
"""Times max(1, largest entry): 450 ε, for up to 9 joints of some 20 roundings each on both sides."""


def assert_agree(first: Answers, second: Answers, factor: float = 1.0) -> None:
    """All poses, Jacobians and derivatives of two engines."""
    pairs = [("pose", first.poses, second.poses)]
    for kind in KINDS:
        pairs.append((f"{kind} J", first.jacobians[kind], second.jacobians[kind]))
        pairs.append((f"{kind} dJ", first.derivatives[kind], second.derivatives[kind]))
    for what, a, b in pairs:
        assert a.shape == b.shape, what
        size = max(1.0, np.abs(a).max(initial=0.0))
        assert np.abs(a - b).max(initial=0.0) <= AGREEMENT * size * factor, what


def assert_engines_agree(robot: ps.Robot, count: int, seed: int = 0) -> None:
    q, qd = urdfs.sample(robot, count, seed)
    assert_agree(*(make(robot).answers(q, qd, robot.frame_names) for make in (ps.PoE, ps.Pinocchio)))


@cache
def load(name: str, *, floating_base: bool = False) -> ps.Robot:
    return urdfs.load(urdfs.ROBOTS[name], floating_base=floating_base)


# ------------------------------------------------------------------------------------------------ agreement


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_engines_agree(name: str, floating_base: bool) -> None:
    assert_engines_agree(load(name, floating_base=floating_base), 60)


@given(urdfs.trees(), st.booleans(), st.integers(0, 2**32 - 1))
@settings(max_examples=120)
def test_engines_agree_on_random_trees(text: str, floating_base: bool, seed: int) -> None:
    assert_engines_agree(urdfs.load(text, floating_base=floating_base), 4, seed)


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_engines_see_the_same_joints(name: str, floating_base: bool) -> None:
    robot = load(name, floating_base=floating_base)
    assert dict(ps.PoE(robot).joints()) == dict(ps.Pinocchio(robot).joints())


@pytest.mark.parametrize("make", [ps.PoE, ps.Pinocchio])
@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", urdfs.ROBOTS)
def test_answers_are_those_of_the_questions(name: str, floating_base: bool, make: Any) -> None:
    """``answers`` in one pass and the single questions agree, and a velocity is J q̇."""
    engine = make(load(name, floating_base=floating_base))
    q, qd = urdfs.sample(engine.robot, 7)
    answers = engine.answers(q, qd, engine.robot.frame_names)
    for i, frame in enumerate(engine.robot.frame_names):
        single = Answers(
            engine.fk(q, frame)[:, None],
            {kind: engine.jacobian(q, frame, kind)[:, None] for kind in KINDS},
            {kind: engine.jacobian_derivative(q, qd, frame, kind)[:, None] for kind in KINDS},
        )
        of_frame = (
            {kind: values[kind][:, i : i + 1] for kind in KINDS} for values in (answers.jacobians, answers.derivatives)
        )
        assert_agree(Answers(answers.poses[:, i : i + 1], *of_frame), single)
        for kind in KINDS:
            J = answers.jacobians[kind][:, i]
            velocity = engine.velocity(q, qd, frame, kind)
            assert np.abs(velocity - (J @ qd[..., None])[..., 0]).max() <= AGREEMENT * max(
                1.0, np.abs(J).max(initial=0)
            )


@pytest.mark.parametrize("kind", urdfs.SCALAR)
@pytest.mark.parametrize("axis", ["2 0 0", "0 -0.5 0", "1 1 1", "0 0 1e-3"])
def test_axes_are_normalised(kind: str, axis: str) -> None:
    """An axis of any length means the same to both: Pinocchio's own parser normalises, too."""
    joint = urdfs.joint("j", kind, "base", "tool", xyz="0.3 0.2 0.1", axis=axis)
    with pytest.warns(PinscrewWarning, match="the axis is .* long and was normalised"):
        robot = urdfs.load(urdfs.robot(joint, links="base tool"))
    assert_engines_agree(robot, 20)


def test_missing_axis_and_origin() -> None:
    """URDF's defaults: the axis is x, the origin the parent's."""
    text = urdfs.single_revolute().replace('<axis xyz="0 1 0"/>', "")
    text = text.replace('<origin xyz="0.3 -0.2 0.5" rpy="0 0 0"/>', "")
    robot = urdfs.load(text)
    np.testing.assert_array_equal(robot.screws()[:, 0], [0, 0, 0, 1, 0, 0])
    np.testing.assert_array_equal(robot.home(), np.eye(4))
    assert_engines_agree(robot, 5)


def test_mimics_of_fixed_joints_are_ignored() -> None:
    text = urdfs.only_fixed().replace("</joint>", '<mimic joint="nowhere" multiplier="2"/></joint>')
    with pytest.warns(PinscrewWarning, match="joint 'f': is fixed, so its <mimic> was ignored"):
        robot = urdfs.load(text)
    assert_engines_agree(robot, 1)
    for make in (ps.PoE, ps.Pinocchio):
        assert make(robot).joints()["f"].mimic is None


def test_pinocchio_rounds_axes_by_1e_12() -> None:
    """Pinocchio takes an axis within 1e-12 of a coordinate axis for it; PoE does not. No bug, but no zero either."""
    for tilt, error in ((9e-13, 9e-10), (2e-12, 0.0)):
        joint = urdfs.joint("j", "prismatic", "base", "tool", axis=f"1 {tilt} 0")
        robot = urdfs.load(urdfs.robot(joint, links="base tool"))
        poe, pinocchio = (make(robot).fk([1000.0])[1, 3] for make in (ps.PoE, ps.Pinocchio))
        assert poe == pytest.approx(1000.0 * tilt, rel=1e-12)
        assert poe - pinocchio == pytest.approx(error, rel=1e-12, abs=1e-22)


# --------------------------------------------------------------------------------------------- independence


def with_garbage(robot: ps.Robot) -> ps.Robot:
    """The robot with everything that Pinocchio has no business to know replaced by NaN and wrong numbers."""
    nan = np.full((4, 4), np.nan)
    joints = tuple(
        dataclasses.replace(
            joint,
            T_parent_joint=nan.copy(),
            axis=np.full(3, np.nan),
            limits=Limits(5.0, -5.0),
            mimic=joint.mimic and Mimic(joint.mimic.joint, np.nan, np.nan),
        )
        for joint in robot.description.joints
    )
    motions = tuple(
        dataclasses.replace(m, T_base_child=nan, twists=np.full_like(m.twists, np.nan), multiplier=np.nan)
        for m in robot.mechanism.motions
    )
    homes = dict.fromkeys(robot.mechanism.homes, nan)
    ruined = dataclasses.replace(robot)
    object.__setattr__(ruined, "description", dataclasses.replace(robot.description, joints=joints))
    mechanism = dataclasses.replace(robot.mechanism, motions=motions, homes=homes, reach=np.nan)
    object.__setattr__(ruined, "mechanism", mechanism)
    return ruined


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", ["rotated", "mimic_chain", "mimic_continuous", "planar", "floating_middle", "tree"])
def test_our_numbers_are_not_read(name: str, floating_base: bool) -> None:
    """Pinocchio's answers come from the file: our screws, homes, axes, limits and multipliers may all be garbage."""
    robot = load(name, floating_base=floating_base)
    ruined = with_garbage(robot)
    q, qd = urdfs.sample(robot, 5)
    whole, from_ruins = ps.Pinocchio(robot), ps.Pinocchio(ruined)
    assert_agree(whole.answers(q, qd, robot.frame_names), from_ruins.answers(q, qd, robot.frame_names), factor=0.0)
    assert dict(whole.joints()) == dict(from_ruins.joints())
    frame = robot.frame_names[-1]
    assert not np.isfinite(ps.PoE(ruined).fk(q, frame)).all()


# --------------------------------------------------------------------------------------------------- limits


def refusal(text: str) -> UnsupportedError:
    robot = urdfs.load(text)
    with pytest.raises(UnsupportedError) as caught:
        ps.Pinocchio(robot)
    assert caught.value.code == "pinocchio-size"
    assert caught.value.remedy == "use the PoE engine, which has no such limit"
    return caught.value


def test_too_many_velocities() -> None:
    assert f"201 velocities (mimic joints counted) are more than the {MAX_COORDINATES}" in str(
        refusal(urdfs.chain(201))
    )


def test_too_long_chain() -> None:
    """Fixed joints count: it is the depth of the tree that costs Pinocchio its stack."""
    text = urdfs.chain(1001, kind="fixed")
    assert f"1001 joints in a chain are more than the {MAX_DEPTH}" in str(refusal(text))
    expected = np.eye(4)
    expected[0, 3] = 1001.0
    np.testing.assert_array_equal(ps.PoE(urdfs.load(text)).fk([]), expected)


@pytest.mark.parametrize(
    ("name", "velocities", "depth"),
    [("mimic_chain", 3, 3), ("floating_middle", 8, 3), ("tree", 4, 3), ("planar", 5, 3)],
)
def test_limits_are_inclusive(name: str, velocities: int, depth: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Mimic joints count as velocities, free joints as 3 or 6."""
    monkeypatch.setattr(expansion, "MAX_COORDINATES", velocities)
    monkeypatch.setattr(expansion, "MAX_DEPTH", depth)
    ps.Pinocchio(load(name))
    monkeypatch.setattr(expansion, "MAX_COORDINATES", velocities - 1)
    assert f"{velocities} velocities" in str(refusal(urdfs.ROBOTS[name]))
    monkeypatch.setattr(expansion, "MAX_COORDINATES", velocities)
    monkeypatch.setattr(expansion, "MAX_DEPTH", depth - 1)
    assert f"{depth} joints in a chain" in str(refusal(urdfs.ROBOTS[name]))


def test_a_wide_robot_agrees_up_to_the_limit() -> None:
    """100 joints in a chain with as many mimics: 200 velocities are still taken."""
    steps = []
    for i in range(100):
        steps.append(urdfs.joint(f"j{i}", "revolute", f"a{i}", f"b{i}", xyz="0.01 0 0.02", axis="0 1 0"))
        follow = (f"j{i}", -0.5, 0.01)
        steps.append(urdfs.joint(f"m{i}", "continuous", f"b{i}", f"a{i + 1}", xyz="0 0.01 0", mimic=follow))
    links = " ".join([*(f"a{i} b{i}" for i in range(100)), "a100"])
    robot = urdfs.load(urdfs.robot(*steps, links=links))
    q: FloatArray = urdfs.sample(robot, 1)[0]
    poe, pinocchio = (make(robot).jacobian(q, "a100", "body") for make in (ps.PoE, ps.Pinocchio))
    # 200 joints with some 20 roundings each, of lengths that sum up to 4.5 m.
    assert np.abs(poe - pinocchio).max() <= 200 * 20 * 4.5 * np.finfo(float).eps


# ------------------------------------------------------------------------------------------------- refusals


def refused(text: str) -> EngineError:
    """What is said of a robot whose text is replaced after it was read."""
    robot = load("single_revolute")
    other = ps.Robot.from_description(dataclasses.replace(robot.description, text=text))
    with pytest.raises(EngineError) as caught:
        ps.Pinocchio(other)
    return caught.value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            urdfs.single_revolute().replace('<link name="base"/>', ""),
            "Failed to build tree: parent link [base] of joint [j] not found",
        ),
        (urdfs.single_revolute().replace('"revolute"', '"rubber"'), "Joint [j] has no known type [rubber]"),
        ("", "XML_ERROR_EMPTY_DOCUMENT"),
        ("<robot", "XML_ERROR_PARSING_ELEMENT"),
        ("no XML", "XML_ERROR_PARSING_TEXT"),
        ("<other/>", "Could not find the 'robot' element"),
        ('<robot name="a"/>', "No link elements found"),
    ],
)
def test_refusals_carry_pinocchios_words(text: str, words: str, capfd: pytest.CaptureFixture[str]) -> None:
    """The reason that urdfdom writes to standard error is in the message, in one line, and nowhere else."""
    error = refused(text)
    assert error.code == "pinocchio-refuses"
    assert error.where == "small.urdf"
    assert error.what.startswith("Pinocchio refuses the file: ")
    assert words in error.what
    assert error.what.endswith("The XML stream does not contain a valid URDF model.")
    assert "\n" not in str(error)
    assert capfd.readouterr() == ("", "")


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_an_angle_that_its_multiplier_makes_infinite() -> None:
    """Alone or among others a configuration gets the same answer, not an error of Python's cosine."""
    robot = urdfs.load(urdfs.mimic_continuous())
    engine = ps.Pinocchio(robot)
    q = np.array([[0.0, 0.1], [1e308, 0.1]])
    poses = engine.fk(q)
    assert not np.isfinite(poses[1]).all()
    np.testing.assert_array_equal(engine.fk(q[1]), poses[1])


def test_standard_error_is_given_back(capfd: pytest.CaptureFixture[str]) -> None:
    refused("no XML")
    sys.stderr.write("python ")
    sys.stderr.flush()
    os.write(2, b"system")
    assert capfd.readouterr().err == "python system"


def test_other_links_and_joints_are_noticed() -> None:
    """A text that Pinocchio reads, but that is not this robot."""
    renamed = urdfs.single_revolute().replace('"tool"', '"hand"')
    assert refused(renamed).code == "pinocchio-frames"
    assert refused(urdfs.single_revolute().replace('"j"', '"other"')).code == "pinocchio-coordinates"
