"""Moving configurations along velocities, against Pinocchio's own integrate."""

import numpy as np
import pinocchio as pin
import pytest

import pinscrew as ps
import urdfs
from pinscrew.robot.manifold import integrate

CASES = ["single_revolute", "mimic_chain", "continuous", "planar", "floating_middle", "rotated"]


@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("size", [1e-9, 1.0, 50.0])
def test_as_pinocchio_does(name: str, floating_base: bool, size: float) -> None:
    robot = urdfs.load(getattr(urdfs, name)(), floating_base=floating_base)
    engine = ps.Pinocchio(robot)
    q, qd = urdfs.sample(robot, 50)
    moved = integrate(robot, q, size * qd)
    for start, step, end in zip(engine._expansion.all(q), size * qd, engine._expansion.all(moved), strict=True):
        expected = pin.integrate(engine.model, start, engine._fold @ step)
        # A quaternion and its negative are one rotation; angles of up to 50 rad are rounded by 4e-15.
        np.testing.assert_allclose(poses(engine, end), poses(engine, expected), atol=1e-13 * max(1.0, size))


def poses(engine: ps.Pinocchio, q: np.ndarray) -> np.ndarray:
    """The poses of all links, by Pinocchio."""
    data = engine.model.createData()
    pin.framesForwardKinematics(engine.model, data, q)
    return np.array([placement.homogeneous for placement in data.oMf])


def test_batches_broadcast() -> None:
    robot = urdfs.load(urdfs.floating_middle())
    q, qd = urdfs.sample(robot, 6)
    wide = integrate(robot, q[:, None], qd[None])
    assert wide.shape == (6, 6, robot.nq)
    for i in range(6):
        np.testing.assert_array_equal(wide[i], integrate(robot, q[i], qd))


def test_the_wrong_frame_is_seen() -> None:
    robot = urdfs.load(urdfs.planar())
    engine = ps.Pinocchio(robot)
    q, qd = urdfs.sample(robot, 5)
    in_the_parent = q + qd  # as if (vx, vy) were the rates of (x, y)
    assert abs(engine.fk(in_the_parent) - engine.fk(integrate(robot, q, qd))).max() > 1e-2
