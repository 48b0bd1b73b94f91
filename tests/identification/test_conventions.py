"""The page of conventions: what each library's function gives is asked of it, and named as the page names it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest
from scipy.spatial.transform import Rotation

import pinscrew as ps

PAGE = (Path(__file__).parents[2] / "docs" / "conventions.md").read_text(encoding="utf-8")
TIP, BASE = "tool0", "base_link"
Given = Any


def rows(chapter: str) -> Iterator[list[str]]:
    """The cells of a table of the page."""
    part = PAGE.partition(f"\n## {chapter}\n")[2].partition("\n## ")[0]
    for line in part.splitlines():
        if line.startswith("| ") and not line.startswith("| library |"):
            yield [cell.strip() for cell in line.strip("|").split(" | ")]


def asked(chapter: str, known_by: int) -> dict[str, list[str]]:
    return {f"{row[0]} {row[1]}": row for row in rows(chapter) if row[known_by] == "test"}


@pytest.fixture(scope="module")
def robot() -> ps.Robot:
    return ps.load("ur5_robot")


Q = np.random.default_rng(5).uniform(-1.0, 1.0, (2, 6))
QD = np.random.default_rng(6).uniform(-1.0, 1.0, (2, 6))

# ------------------------------------------------------------------------------------------------ pinocchio


def pinocchio_s(robot: ps.Robot, what: str) -> Given:
    model = pinocchio.buildModelFromXML(robot.description.text, mimic=True)
    data, frame = model.createData(), model.getFrameId(TIP)
    joint = model.frames[frame].parentJoint
    worlds = re.search("LOCAL_WORLD_ALIGNED|LOCAL|WORLD", what)
    frames = [getattr(pinocchio, worlds[0])] if worlds else []
    found = []
    for q, qd in zip(Q, QD, strict=True):
        pinocchio.forwardKinematics(model, data, q, qd)
        pinocchio.computeJointJacobians(model, data, q)
        pinocchio.updateFramePlacements(model, data)
        if "getFrameJacobian" in what:
            found.append(pinocchio.getFrameJacobian(model, data, frame, *frames).copy())
        elif "computeFrameJacobian" in what:
            found.append(pinocchio.computeFrameJacobian(model, data, q, frame).copy())
        elif "computeJointJacobians" in what:
            found.append(data.J.copy())
        elif "computeJointJacobian" in what:
            found.append(pinocchio.computeJointJacobian(model, data, q, joint).copy())
        elif "getFrameVelocity" in what:
            found.append(
                pinocchio.getFrameVelocity(model, data, frame, *([] if "(…)" in what else frames)).vector.copy()
            )
        else:
            found.append(pinocchio.SE3ToXYZQUAT(data.oMf[frame]))
    return np.array(found)


# --------------------------------------------------------------------------------------------------- mujoco


def mujoco_s(robot: ps.Robot, what: str) -> Given:
    mujoco = pytest.importorskip("mujoco")
    model = ps.witness("mujoco", robot).model  # type: ignore[attr-defined] # MuJoCo's own, of the file
    data, found = mujoco.MjData(model), []
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, TIP)
    for q, qd in zip(Q, QD, strict=True):
        data.qpos[:], data.qvel[:] = q, qd
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        J, V = np.zeros((6, 6)), np.zeros(6)
        if "mj_jacBody" in what:
            mujoco.mj_jacBody(model, data, J[:3], J[3:], body)
        elif "`mj_jac`" in what:
            mujoco.mj_jac(model, data, J[:3], J[3:], data.xpos[body], body)
        elif "mj_objectVelocity" in what:
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, V, int("1)" in what))
        else:
            J = np.concatenate([data.xpos[body], data.xquat[body]])
        found.append(V if "mj_objectVelocity" in what else J)
    return np.array(found)


# ------------------------------------------------------------------------------------------- other libraries


def toolbox_s(robot: ps.Robot, what: str) -> Given:
    pytest.importorskip("roboticstoolbox")
    model = ps.witness("roboticstoolbox", robot).model  # type: ignore[attr-defined]
    chain = model.ets(end=next(link for link in model.links if link.name == TIP))
    if "analytical" in what:
        representation = what.split("`")[3]
        return np.array([model.jacob0_analytical(q, representation=representation, end=TIP) for q in Q])
    return np.array([(chain.jacobe if "jacobe" in what else chain.jacob0)(q) for q in Q])


def modern_s(robot: ps.Robot, what: str) -> Given:
    """Its screws are (ω, v), as its book has them."""
    modern = pytest.importorskip("modern_robotics")
    if "Space" in what:
        axes = robot.screws(TIP)[[3, 4, 5, 0, 1, 2]]
        return np.array([modern.JacobianSpace(axes, q) for q in Q])
    axes = robot.screws(TIP, at="body")[[3, 4, 5, 0, 1, 2]]
    return np.array([modern.JacobianBody(axes, q) for q in Q])


def spatialmath_s(robot: ps.Robot, what: str) -> Given:
    spatialmath = pytest.importorskip("spatialmath")
    T = [spatialmath.SE3(each, check=False) for each in ps.Pinocchio(robot).fk(Q, TIP)]
    turns = {
        "`UnitQuaternion.vec`": lambda each: spatialmath.UnitQuaternion(each).vec,
        "`SE3.rpy()`": lambda each: each.rpy(),
        "`SE3.eul()`": lambda each: each.eul(),
    }
    return np.array([np.concatenate([each.t, turns[what.split(" ", 1)[1]](each)]) for each in T])


def scipy_s(robot: ps.Robot, what: str) -> Given:  # noqa: ARG001 (there is one)
    T = ps.Pinocchio(robot).fk(Q, TIP)
    return np.concatenate([T[:, :3, 3], Rotation.from_matrix(T[:, :3, :3]).as_quat()], axis=1)


LIBRARIES: dict[str, Callable[[ps.Robot, str], Given]] = {
    "Pinocchio": pinocchio_s,
    "MuJoCo": mujoco_s,
    "roboticstoolbox": toolbox_s,
    "ModernRobotics": modern_s,
    "spatialmath": spatialmath_s,
    "scipy": scipy_s,
}


@pytest.mark.parametrize("what", asked("Jacobians", 6))
def test_jacobians(robot: ps.Robot, what: str) -> None:
    _, _, name, point, axes, order, _ = asked("Jacobians", 6)[what]
    found = ps.identify(robot, Q, LIBRARIES[what.split(" ", maxsplit=1)[0]](robot, what))
    assert found.verdict == "unique", str(found)
    candidate = found.candidates[0]
    assert candidate.observer is not None
    assert candidate.writing is not None
    kind = name.split(",")[0]
    assert kind == candidate.observer.kind
    places = {candidate.observer.root: "base", candidate.observer.frame: "frame"}
    assert (places[candidate.observer.point], places[candidate.observer.base]) == (point, axes)
    assert candidate.writing.order == order.replace("rates", "w").replace("ω", "w").replace(" ", "")
    if kind == "analytic":
        words = (candidate.words, *candidate.aliases)
        assert any(f" {TIP}, rates of its position and {name.split(', ')[1]}" in each for each in words)
    assert (candidate.writing.unit, candidate.writing.angle, candidate.writing.layout) == ("m", "rad", "rows")


@pytest.mark.parametrize("what", asked("Twists", 4))
def test_twists(robot: ps.Robot, what: str) -> None:
    _, _, kind, order, _ = asked("Twists", 4)[what]
    found = ps.identify(robot, Q, QD, LIBRARIES[what.split(" ", maxsplit=1)[0]](robot, what))
    assert found.verdict == "unique", str(found)
    candidate = found.candidates[0]
    assert candidate.observer is not None
    assert candidate.writing is not None
    assert (candidate.observer.kind, candidate.writing.order) == (kind, order.replace("ω", "w").replace(" ", ""))


ENCODED = {
    "position, x, y, z, w": "quaternion xyzw",
    "x, y, z, w": "quaternion xyzw",
    "w, x, y, z": "quaternion wxyz",
    "radians, `xyz` about fixed axes": "angles xyz",
    "radians, `ZYZ` about moving axes": "angles ZYZ",
}


@pytest.mark.parametrize("what", asked("Orientations", 3))
def test_orientations(robot: ps.Robot, what: str) -> None:
    order = asked("Orientations", 3)[what][2]
    found = ps.identify(robot, Q, LIBRARIES[what.split(" ", maxsplit=1)[0]](robot, what))
    assert found.verdict == "unique", str(found)
    encoding = found.candidates[0].encoding
    assert encoding is not None
    assert f"{encoding.form} {encoding.sequence}".strip() == ENCODED[order]
    assert (encoding.unit, encoding.angle, encoding.order) == ("m", "rad", "p,r")


def test_every_row_says_how_it_is_known() -> None:
    known = [row[-1] for chapter in ("Jacobians", "Twists", "Orientations") for row in rows(chapter)]
    known = [each for each in known if each not in ("known by", "---")]
    assert len(known) > 30
    assert all(re.fullmatch(r"test|measured, [\d.]+|\[its .*\]\(https://.*\)", each) for each in known)
