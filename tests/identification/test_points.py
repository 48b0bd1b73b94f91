"""Tools that the file does not know."""

from __future__ import annotations

import numpy as np
import pytest

import pinscrew as ps

TIPS = {"ur5_robot": "wrist_3_link", "panda": "panda_link7", "spherical_rrp": "link3", "scara": "link3"}


@pytest.mark.parametrize("name", TIPS)
@pytest.mark.parametrize("kind", ["body", "hybrid"])
@pytest.mark.parametrize("foreign", [False, True])
def test_a_tool_is_found(name: str, kind: str, foreign: bool) -> None:
    """v' = v + ω × p, by numpy alone, with p turned into the base frame for the hybrid one."""
    robot, rng = ps.load(name), np.random.default_rng(3)
    q, p = rng.uniform(-1.0, 1.0, (3, robot.nq)), np.array([0.11, -0.07, 0.23])
    pin = ps.Pinocchio(robot)
    J = pin.jacobian(q, TIPS[name], kind)  # type: ignore[arg-type]
    arms = pin.fk(q, TIPS[name])[:, :3, :3] @ p if kind == "hybrid" else np.tile(p, (3, 1))
    J[:, :3] += np.stack([np.cross(J[i, 3:].T, arms[i]).T for i in range(3)])
    given = np.concatenate([J[:, 3:], 1000.0 * J[:, :3]], axis=1) if foreign else J
    found = ps.identify(robot, q, given)
    assert found.verdict == "unique", str(found)
    assert np.allclose(found.convert(given), J, atol=1e-9)
    names = {found.candidates[0].words, *found.candidates[0].aliases}
    z = "0" if name == "scara" else "0.23"  # all its axes are z: no Jacobian tells how high the tool is
    said = f"the {kind} Jacobian of the point (0.11, -0.07, {z}) m in {TIPS[name]}"
    assert any(each.startswith(said) for each in names), str(found)
    wrong = given.copy()
    wrong[1, 4, 0] += 1e-5
    assert ps.identify(robot, q, wrong).verdict == "none"


def test_one_turning_joint_does_not_make_everything_right() -> None:
    """Any column across the axis is that of some point; so none is named."""
    assert (
        ps.identify("one_joint", [[0.1], [0.7]], np.full((2, 6, 1), [[0.3], [0.2], [0], [0], [0], [1]])).verdict
        == "none"
    )
