"""Answers in numbers against Pinocchio: rounded as people round, and wrong in the ways that people are wrong."""

from __future__ import annotations

import numpy as np
import pytest

import pinscrew as ps
from command_line import run
from pinscrew.checking.numbers import Near, last_digit

SCARA = ps.load("scara")
SPHERICAL = ps.load("spherical")
Q = np.array([0.3, 0.5, 0.1])


def written(matrix: np.ndarray[tuple[int, ...], np.dtype[np.float64]], digits: int) -> list[list[str]]:
    return [[f"{x:.{digits}f}" for x in row] for row in np.atleast_2d(matrix)]


@pytest.mark.parametrize("robot", [SCARA, SPHERICAL])
@pytest.mark.parametrize("digits", [2, 4, 7])
def test_rounded(robot: ps.Robot, digits: int) -> None:
    engine = ps.Pinocchio(robot)
    J = engine.jacobian(Q, None, "body")
    assert ps.check(robot, "Jb", written(J, digits), q=Q).right is True
    assert ps.check(robot, "T", written(engine.fk(Q), digits), q=Q).right is True
    wrong = J.copy()
    wrong[1, 0] += 2.1 * 10.0**-digits
    verdict = ps.check(robot, "Jb", written(wrong, digits), q=Q)
    assert verdict.entries == ((2, 1),)


@pytest.mark.parametrize(
    ("text", "tolerance"),
    [
        ("0.707", 1e-3),
        ("-1.25e-3", 1e-5),
        ("12.00", 1e-2),
        ("0.7", 1e-6),
        ("1", 1e-6),
        ("sqrt(2)/2", 0.0),
        ("1.", 1e-6),
    ],
)
def test_last_digit(text: str, tolerance: float) -> None:
    assert last_digit(text) == pytest.approx(tolerance)


def test_near() -> None:
    assert Near(0.7071, 1e-3) == Near(0.7077)
    assert Near(0.7071) == Near(0.7077, 1e-3)
    assert Near(0.7071, 1e-4) != Near(0.7077)
    assert -Near(1.0) == Near(-1.0)
    assert not Near(1e-12)
    assert Near(1.0) != 1.0


def slip(quantity: str, matrix: object, robot: ps.Robot = SCARA) -> str:
    verdict = ps.check(robot, quantity, matrix, q=Q)
    assert verdict.right is False
    (words,) = verdict.slips
    return words


def test_slips() -> None:
    engine = ps.Pinocchio(SCARA)
    T, J = engine.fk(Q), engine.jacobian(Q, None, "body")
    assert slip("Jb", written(engine.jacobian(Q, None, "spatial"), 4)) == "this is Js, asked was Jb"
    assert slip("Jb", written(-J, 4)) == "every sign: this is -Jb"
    assert slip("Tinv", written(T, 4)) == "this is T, asked was Tinv"
    assert slip("R", written(T[:3, :3].T, 4)) == "it is transposed"
    degrees, radians = np.radians(Q), np.degrees(Q)
    degrees[2] = radians[2] = Q[2]
    assert "were taken for degrees" in slip("T", written(engine.fk(degrees), 5))
    assert "taken in degrees" in slip("T", written(engine.fk(radians), 4))
    p = [f"{0.4 * np.cos(0.3) + 0.3 * np.cos(0.5):.5f}", "0.4*sin(0.3) + 0.3*sin(0.8)", "-0.1"]
    assert ps.check(SCARA, "p", p, q=Q).entries == ((1, 1),)
    assert slip("exp1", [["c1", "-s1", 0, 0], ["s1", f"{np.cos(0.5):.6f}", 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) == (
        "entry (2, 2): c2 for c1"
    )
    assert slip("p", [f"{T[1, 3]:.5f}", f"{T[1, 3]:.5f}", "-0.1"]).endswith("what is due at (2, 1) stands here")


def test_formulas_in_numbers() -> None:
    for answer in (["l1*c1 + l2*c12", "0.4*sin(0.3) + 0.3*sin(0.8)", "-d3"], ["0.591147", "0.333415", "-0.1"]):
        assert ps.check(SCARA, "p", answer, q=Q).right is True
    text = "c = cos(0.3)\np = [0.4*c + 0.3*cos(0.8), 0.4*sin(0.3) + 0.3*sin(0.8), -0.1]"
    assert ps.check(SCARA, "p", text, q=Q).right is True
    assert ps.check(SCARA, "q2", ["0.4", "0", "7"], q=Q).right is True
    assert ps.check(SCARA, "q2", ["0.4", "1", "7"], q=Q).entries == ((2, 1),)
    unread = ps.check(SCARA, "p", ["x", "0.333415", "-0.1"], q=Q)
    assert (unread.right, unread.unread[0][0]) == (None, (1, 1))


def test_refused() -> None:
    for key, q in (("p", [0.1]), ("p", [0.1, 0.2, np.nan]), ("Vb", Q)):
        with pytest.raises(ps.PinscrewError):
            ps.check(SCARA, key, ["1", "2", "3"] * (2 if key == "Vb" else 1), q=q)


def test_command() -> None:
    words = ("check", "scara", "--quantity", "p", "--text", "[0.5912, 0.3334, -0.1]")
    assert run(*words, "-q", "0.3,0.5,0.1").status == 0
    assert run(*words, "-q", "0.3,0.5,0.2").status == 1
