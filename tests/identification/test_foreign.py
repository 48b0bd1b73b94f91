"""What other libraries answer, from their own functions and their own reading of the file."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pinscrew as ps

ARMS = ["spherical_rrp", "scara", "stanford_rrp", "anthropomorphic", "planar_2r", "ur5_robot"]


def names(found: Any) -> list[str]:
    return [name for each in found.candidates for name in (each.words, *each.aliases)]


@pytest.mark.parametrize("name", ARMS)
def test_mujoco_s(name: str) -> None:
    """``mj_jacBody`` gives jacp and jacr: the hybrid Jacobian at the body's frame; ``xquat`` is w, x, y, z."""
    mujoco = pytest.importorskip("mujoco")
    robot = ps.load(name)
    model = ps.witness("mujoco", robot).model  # type: ignore[attr-defined] # MuJoCo's own, of the file
    data = mujoco.MjData(model)
    body = "tool0" if name == "ur5_robot" else "tool"
    q = np.random.default_rng(0).uniform(-1.0, 1.0, (2, robot.nq))
    J, pose = np.zeros((2, 6, model.nv)), np.zeros((2, 7))
    for i in range(2):
        data.qpos[:] = q[i]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
        mujoco.mj_jacBody(model, data, J[i, :3], J[i, 3:], index)
        pose[i] = np.concatenate([data.xpos[index], data.xquat[index]])
    for given in (J, np.concatenate([J[:, 3:], J[:, :3]], axis=1)):
        found = ps.identify(robot, q, given)
        assert found.verdict == "unique", str(found)
        assert any(each.startswith(f"the hybrid Jacobian of {body} ") for each in names(found))
    found = ps.identify(robot, q, pose)
    assert any(f"the pose of {body} in {robot.base}, as quaternion wxyz" in each for each in names(found))
    assert found.verdict == "unique" or name == "planar_2r", str(found)


@pytest.mark.parametrize("name", ARMS)
def test_roboticstoolbox_s(name: str) -> None:
    """``jacob0`` is the hybrid Jacobian, ``jacobe`` the body one."""
    pytest.importorskip("roboticstoolbox")
    robot = ps.load(name)
    model = ps.witness("roboticstoolbox", robot).model  # type: ignore[attr-defined]
    tip = "tool0" if name == "ur5_robot" else "tool"
    chain = model.ets(end=next(link for link in model.links if link.name == tip))
    q = np.random.default_rng(0).uniform(-1.0, 1.0, (2, robot.nq))
    for function, kind in ((chain.jacob0, "hybrid"), (chain.jacobe, "body")):
        found = ps.identify(robot, q, np.array([function(each) for each in q]))
        assert found.verdict == "unique", str(found)
        assert any(each.startswith(f"the {kind} Jacobian of {tip} ") for each in names(found))
