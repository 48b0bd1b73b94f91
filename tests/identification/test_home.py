"""Lists of screw axes and home poses: what is of the robot at zero."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pinscrew as ps
from command_line import ok, refused
from pinscrew.ground.errors import InputError

TIPS = {"spherical_rrp": "tool", "scara": "tool", "ur5_robot": "tool0", "panda": "panda_hand"}


@pytest.mark.parametrize("name", TIPS)
@pytest.mark.parametrize("kind", ["spatial", "body"])
def test_screw_lists(name: str, kind: str) -> None:
    """By Pinocchio at zero; as Lynch and Park have them, with millimetres, and in another order."""
    robot, rng = ps.load(name), np.random.default_rng(0)
    J = ps.Pinocchio(robot).jacobian(robot.neutral, TIPS[name], kind)  # type: ignore[arg-type]
    moved = [i for i in range(robot.nv) if J[:, i].any()]
    order = rng.permutation(moved)
    said = f"the {'space' if kind == 'spatial' else 'body'} screw axes of {TIPS[name]} at zero"
    for given, rows in (
        (J[:, moved], ""),
        (J[[3, 4, 5, 0, 1, 2]][:, moved], ", rows (ω, v)"),
        (np.concatenate([J[3:], 1000.0 * J[:3]])[:, order], ", rows (ω, v), in mm, columns in the order"),
    ):
        found = ps.identify(robot, None, given)
        assert found.verdict == "unique", str(found)
        names = (found.candidates[0].words, *found.candidates[0].aliases)
        assert any(each.startswith(said + rows) for each in names), names
        assert np.allclose(found.convert(given), J, atol=1e-12)
        assert found.to_document()["candidates"][0]["quantity"] == "screws"
    wrong = J[:, moved].copy()
    wrong[2, 1] += 0.01
    assert ps.identify(robot, None, wrong).verdict == "none"


@pytest.mark.parametrize("name", TIPS)
def test_home_poses(name: str) -> None:
    robot = ps.load(name)
    M = ps.Pinocchio(robot).fk(robot.neutral, TIPS[name])
    found = ps.identify(robot, None, M)
    names = [each for one in found.candidates for each in (one.words, *one.aliases)]
    assert f"the pose of {TIPS[name]} in {robot.base}, as 4×4 matrix" in names
    M[0, 3] += 0.01
    assert ps.identify(robot, None, M).verdict == "none"


def test_other_kinds_of_zero_are_no_screws() -> None:
    """The hybrid Jacobian at zero is no list of screw axes, and a Jacobian elsewhere neither."""
    robot = ps.load("ur5_robot")
    pin = ps.Pinocchio(robot)
    assert ps.identify(robot, None, pin.jacobian(np.zeros(6), "tool0", "hybrid")).verdict == "none"
    assert ps.identify(robot, None, pin.jacobian(np.full(6, 0.3), "tool0", "spatial")).verdict == "none"


def test_command(tmp_path: Path) -> None:
    file = tmp_path / "S.csv"
    np.savetxt(file, ps.load("scara").screws("tool"))
    assert ok("identify", "scara", "--home", "--matrix", file).out.startswith("the space screw axes of tool at zero")
    assert "--home takes --matrix" in refused("identify", "scara", "--home", "-q", "0,0,0", "--matrix", file)


def test_a_twist_has_a_q() -> None:
    with pytest.raises(InputError, match="without q"):
        ps.identify("scara", None, np.zeros(3), np.zeros(6))
