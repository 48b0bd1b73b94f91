"""What may be asked for against Pinocchio and scipy's expm, and slips made on purpose, each named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

import pinscrew as ps
from pinscrew.checking.quantities import quantity_key, right_form
from pinscrew.checking.run import checkable
from pinscrew.lie import se3, so3

SPHERICAL = ps.load("spherical")
SCARA = ps.load("scara")
FORMS = checkable(SPHERICAL)
Q, QD = np.array([0.3, -0.7, 0.2]), np.array([0.5, 1.1, -0.4])


def value(key: str) -> np.ndarray[Any, Any]:
    """The right form at Q and QD, by sympy."""
    matrix = FORMS.explicit(FORMS.write(right_form(FORMS, quantity_key(key, 3))))
    numbers = dict(FORMS.lengths)
    for variable, q, qd in zip(FORMS.variables, Q, QD, strict=True):
        numbers |= {variable.symbol: q, variable.rate: qd}
    return np.array(matrix.subs(numbers).evalf().tolist(), dtype=float)


def truths() -> dict[str, np.ndarray[Any, Any]]:
    engine = ps.Pinocchio(SPHERICAL)
    T, M = engine.fk(Q), engine.fk(np.zeros(3))
    J = {kind: engine.jacobian(Q, None, kind) for kind in ("spatial", "body", "hybrid")}
    xi = engine.jacobian(np.zeros(3), None, "spatial")
    e = [expm(se3.hat(xi[:, i]) * Q[i]) for i in range(3)]
    Tdot = se3.hat(J["spatial"] @ QD) @ T
    return {
        "M": M,
        "T": T,
        "R": T[:3, :3],
        "p": T[:3, 3:],
        "phat": so3.hat(T[:3, 3]),
        "Tinv": np.linalg.inv(T),
        "Tdot": Tdot,
        "pdot": Tdot[:3, 3:],
        "Ad": se3.adjoint(T),
        "Adinv": np.linalg.inv(se3.adjoint(T)),
        "twists": xi,
        "xi2": xi[:, 1:2],
        "hat(xi2)": se3.hat(xi[:, 1]),
        "exp3": e[2],
        "prod2": e[0] @ e[1],
        "tail2": e[1] @ e[2] @ M,
        "inv(exp1)": expm(-se3.hat(xi[:, 0]) * Q[0]),
        "Ad(prod2)": se3.adjoint(e[0] @ e[1]),
        "corner(Ad(tail2))": se3.adjoint(e[1] @ e[2] @ M)[:3, 3:],
        "R(prod2)": (e[0] @ e[1])[:3, :3],
        "Js": J["spatial"],
        "Jb": J["body"],
        "Jh": J["hybrid"],
        "Jh3": J["hybrid"][:, 2:],
        "v(Jb)": J["body"][:3],
        "w(Js)": J["spatial"][3:],
        "Vs": (J["spatial"] @ QD)[:, None],
        "Vb": (J["body"] @ QD)[:, None],
        "Vh": (J["hybrid"] @ QD)[:, None],
        "Vshat": se3.hat(J["spatial"] @ QD),
        "Vbhat": se3.hat(J["body"] @ QD),
        "omega2": xi[3:, 1:2],
        "z1": J["hybrid"][3:, 1:2],
        "z2": J["hybrid"][:3, 2:],
        "foot2": np.cross(xi[3:, 1], xi[:3, 1])[:, None],
        "det(v(Jh))": np.array([[np.linalg.det(J["hybrid"][:3])]]),
        "det(Ad)": np.eye(1),
    }


@pytest.mark.parametrize("key", truths())
def test_right_forms(key: str) -> None:
    np.testing.assert_allclose(value(key), truths()[key], rtol=0, atol=1e-12)


@pytest.mark.parametrize("key", ["inv(Js)", "Ad(xi1)", "v(T)", "det(Js)", "hat(T)", "corner(T)", "dot(p)"])
def test_functions_that_are_none(key: str) -> None:
    with pytest.raises(ps.PinscrewError) as caught:
        ps.check(SPHERICAL, key, "[1]")
    assert caught.value.code == "check-quantity"


@pytest.mark.parametrize("key", ["f(T)", "inv()", "xi4", "z3", "q0", "prod0", "inv(" * 20 + "T" + ")" * 20])
def test_no_such_quantity(key: str) -> None:
    with pytest.raises(ps.PinscrewError, match="there is no quantity"):
        ps.check(SPHERICAL, key, "[1]")


def test_any_point_of_an_axis_is_right() -> None:
    for answer in (["0", "0", "L0"], ["5", "0", "L0"], ["L3*c1", "0", "L0"]):
        assert ps.check(SPHERICAL, "q2", answer).right is True
    verdict = ps.check(SPHERICAL, "q2", ["5", "0", "L3"])
    assert (verdict.entries, verdict.slips) == (((3, 1),), ("entry (3, 1): L3 for L0",))


def slip(quantity: str, matrix: Any, robot: ps.Robot = SPHERICAL) -> str:
    verdict = ps.check(robot, quantity, matrix)
    assert verdict.right is False
    (words,) = verdict.slips
    return words


def test_slips_on_the_way_to_a_pose() -> None:
    d = ps.derive(SPHERICAL)
    e1, e2, e3 = d.exponentials
    M = d.home
    assert slip("T", e1 * e2 * e3) == "the home pose is left out"
    assert slip("T", M * e1 * e2 * e3) == "the home pose stands before the exponentials"
    assert slip("T", e3 * e2 * e1 * M) == "the exponentials stand in the opposite order"
    assert slip("T", e2 * e1 * e3 * M) == "the exponentials of joints 1 and 2 are exchanged"
    assert slip("T", e1 * e2.inv() * e3 * M) == "joint 2 counts the other way"
    assert slip("T", e1 * e3 * M) == "the exponential of joint 2 is left out"
    assert slip("T", d.inverse) == "this is Tinv, asked was T"
    assert slip("p", (e1 * e2.inv() * e3 * M)[:3, 3]) == "joint 2 counts the other way"
    assert slip("exp2", e2.inv()) == "it is inverted"
    assert slip("prod2", (e1 * e2).inv()) == "it is inverted"


def test_slips_of_one_joint() -> None:
    slide = [["1", 0, 0, "-q2"], [0, "1", 0, 0], [0, 0, "1", 0], [0, 0, 0, 1]]
    d = ps.derive(SPHERICAL)
    e1, _, e3 = d.exponentials

    slid = e1 * sp.Matrix(4, 4, lambda i, j: -sp.Symbol("q2") if (i, j) == (0, 3) else int(i == j)) * e3 * d.home
    assert slip("T", slid) == "joint 2 is taken to slide"
    assert slip("xi2", [-1, 0, 0, 0, 0, 0]) == "the joint is taken to slide: it turns"
    assert slip("xi2", [0, 0, 0, -1, 0, 0]) == "v is left out: the axis would go through the origin"
    assert slip("xi2", [0, 0, "L0", -1, 0, 0]) == "v is the point q, not -ω × q"
    assert slip("xi3", [0, 0, 0, 0, 1, 0]).startswith("the rows are (ω, v)")
    first = [["1", 0, 0, 0], [0, "1", "q2", "-L0*q2"], [0, "-q2", "1", 0], [0, 0, 0, 1]]
    assert slip("exp2", first) == "it is the first-order approximation I + ξ̂θ"
    assert slip("exp2", [[1, 0, 0, 0], [0, "c2", "s2", 0], [0, "-s2", "c2", "L0"], [0, 0, 0, 1]]).startswith(
        "its position is q"
    )
    assert slip("exp2", slide) == "the joint is taken to slide: it turns"


def test_slips_of_jacobians() -> None:
    d = ps.derive(SPHERICAL)
    Js = d.jacobian("spatial")
    assert slip("Js", Js[:, ::-1]) == "the columns stand in the opposite order"
    assert (
        slip("Js", [[0, 0, 0], [0, "-L0", 1], [0, 0, 0], [0, -1, 0], [0, 0, 0], [1, 0, 0]])
        == "this is twists, asked was Js"
    )
    turned = Js.as_mutable()
    turned[:3, 2], turned[3:, 2] = Js[3:, 2], Js[:3, 2]
    assert slip("Js", turned) == "column 3: joint 3 slides, and is taken to turn"
    slid = Js.as_mutable()
    slid[:3, 1], slid[3:, 1] = Js[3:, 1], Js[:3, 1] * 0
    assert slip("Js", slid) == "column 2: joint 2 turns, and is taken to slide"


def test_slips_of_one_entry() -> None:
    assert slip("p", ["0", "l1*s1 + l2*s12", "-q3"], SCARA) == "entry (1, 1): 0 stands there: it is left out"
    assert slip("p", ["l1*c1 + l2*c12", "l1*c1 + l2*c12", "-q3"], SCARA).endswith("what is due at (1, 1) stands here")
    short = ["-(L3 + q3)*s1*c2 + L0*c1*s2", "(L3 + q3)*c1*c2", "L0 - (L3 + q3)*s2"]
    assert slip("p", short) == "entry (1, 1): the term L0*c1*s2 is too many"
    assert slip(
        "Vh", ["-dq1*(l1*s1 + l2*s12)", "(l1*c1 + l2*c12)*dq1 + l2*c12*dq2", "-dq3", 0, 0, "dq1 + dq2"], SCARA
    ) == ("entry (1, 1): a term -s12*dtheta2*l2 is missing")


def test_another_frame_0() -> None:
    assert ps.check("planar_2r", "M", np.eye(4).astype(int), reference="frame0").right is True
    assert ps.check("planar_2r", "M", np.eye(4).astype(int)).right is False
