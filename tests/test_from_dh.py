"""Robots from Denavit-Hartenberg tables, against products of scipy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import pinscrew as ps
from pinscrew.dh.table import dh_table


def _turn(axis: str, angle: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler(axis, angle).as_matrix()
    return T


def _move(x: float = 0.0, z: float = 0.0) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, 0.0, z
    return T


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("seed", range(6))
def test_poses_are_the_products_of_the_rows(convention, seed):
    random = np.random.default_rng(seed)
    rows = random.uniform(-2.0, 2.0, (5, 4))
    rows[::2, [0, 3]] = np.pi / 2 * random.integers(-2, 3, (3, 2))  # where roll and yaw are one
    kinds = "".join(random.choice(["R", "P"], 5))
    robot = ps.from_dh(rows.tolist(), convention=convention, joints=kinds)
    for q in random.uniform(-3.0, 3.0, (5, 5)):
        T = np.eye(4)
        for (theta, d, a, alpha), kind, value in zip(rows, kinds, q, strict=True):
            turned, moved = (theta + value, d) if kind == "R" else (theta, d + value)
            Z, X = _turn("z", turned) @ _move(z=moved), _move(x=a) @ _turn("x", alpha)
            T = T @ Z @ X if convention == "standard" else T @ X @ Z
        for engine in (ps.PoE(robot), ps.Pinocchio(robot)):
            np.testing.assert_allclose(engine.fk(q, "tool"), T, atol=1e-13)


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_a_robot_through_its_table_and_back(convention):
    arm = ps.load("anthropomorphic")
    table = dh_table(arm, convention=convention)
    rows = [{"theta": r.theta, "d": r.d, "a": r.a, "alpha": r.alpha} for r in table.rows]
    back = ps.from_dh(rows, convention=convention)
    q = np.array([0.3, -0.4, 0.5])
    T = table.T_base_0 @ ps.PoE(back).fk(q, "tool") @ table.T_n_tool
    np.testing.assert_allclose(T, ps.Pinocchio(arm).fk(q), atol=1e-12)


@pytest.mark.parametrize(
    ("rows", "more", "words"),
    [
        ([], {}, "0 rows"),
        (5, {}, "not int"),
        ("1234", {}, "not str"),
        (np.zeros((1001, 4)), {}, "1001 rows"),
        ([(0.0, 0.0, 0.0)], {}, "row 1"),
        ([(0.0, 0.0, 0.0, float("nan"))], {}, "row 1"),
        (["1234"], {}, "row 1"),
        ([(0, 0, 0, 0), 5], {}, "row 2"),
        ([{"theta": 0.0, "d": 0.0, "a": 0.0}], {}, "theta, d, a, alpha"),
        ([(0, 0, 0, 0)], {"joints": "RR"}, "1 rows"),
        ([(0, 0, 0, 0)], {"joints": "X"}, "prismatic"),
        ([(0, 0, 0, 0)], {"convention": "craig"}, "'modified'"),
    ],
)
def test_a_bad_table_is_refused_in_one_line(rows, more, words):
    with pytest.raises(ps.PinscrewError) as caught:
        ps.from_dh(rows, **{"convention": "standard", **more})
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
