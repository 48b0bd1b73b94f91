"""Answers by hand and from the courseworks against the closed forms: right, wrong and where, unread and why."""

from __future__ import annotations

import json

import pytest

import pinscrew as ps
from command_line import run
from pinscrew.checking.meanings import Meanings, given
from pinscrew.checking.scope import NoValueError, Scope
from pinscrew.checking.verdict import AnswerVerdict
from pinscrew.derivation.errata_entries import errata
from pinscrew.mathtext import read_plain, symbols

SPHERICAL = ps.load("spherical")
TWO = ps.load("two_joint")
SCARA = ps.load("scara")
RIGHT_JB = [
    ["-(L3 + q3)*c2", 0, 0],
    [0, 0, 1],
    [0, "-(L3 + q3)", 0],
    [0, -1, 0],
    ["-s2", 0, 0],
    ["c2", 0, 0],
]


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        ("p", r"\begin{bmatrix} -(L_3+\theta_3)s_1c_2 \\ (L_3+\theta_3)c_1c_2 \\ L_0-(L_3+\theta_3)s_2 \end{bmatrix}"),
        ("p", r"p = [-(L_3+d_3)\sin\theta_1\cos\theta_2, c_{1}c_{2}(L_3 + q_3), L_0 - s_{\theta_2} (L_3+\theta_3)]^T"),
        ("p", "r = L3 + q[2]\nreturn np.array([-r*sin(q[0])*cos(q[1]), r*np.cos(q[0])*c2, L0 - r*s2])"),
        ("p", "r = L3 + q(3);\np = [-r*s1*c2; r*c1*c2; L0 - r*s2];"),
        ("p", "[-(L3+d3)*s1*c2  (L3+d3)*c1*c2  L0 - (L3+d3)*s2]"),
        ("xi2", "[0 -L0 0 -1 0 0]'"),
        ("xi2", r"\xi_2 = \left(0, -L_0, 0, -1, 0, 0\right)^\top"),
        ("M", r"\left[\begin{array}{cccc} 1&0&0&0\\0&1&0&L_3\\0&0&1&L_0\\0&0&0&1\end{array}\right]"),
        (
            "Vb",
            r"(-(L_3+d_3)c_2\dot\theta_1, \dot{\theta}_3, -(L_3+d_3)\dot q_2, -\dot q_2, -s_2 \dot{q_1}, c_2\dot q_1)",
        ),
        ("Jb", str(RIGHT_JB).replace("'", "")),
        ("exp1", "[c1 -s1 0 0; s1 c1 0 0; 0 0 1 0; 0 0 0 1]"),
        (
            "exp1",
            "[[2*cos(q1/2)**2 - 1, cos(q1 + pi/2), 0, 0], [sin(q1), 1 - 2*sin(t1/2)^2, 0, 0], [0,0,1,0], [0,0,0,1]]",
        ),
        ("R", r"-\begin{bmatrix} -c_1 & s_1c_2 & s_1s_2 \\ -s_1 & -c_1c_2 & -c_1s_2 \\ 0 & s_2 & -c_2 \end{bmatrix}"),
        ("xi2", r"L_0 \begin{pmatrix} 0 \\ -1 \\ 0 \\ -\frac{1}{L_0} \\ 0 \\ 0 \end{pmatrix}"),
    ],
)
def test_right(quantity: str, text: str) -> None:
    verdict = ps.check(SPHERICAL, quantity, text)
    assert verdict.right is True, verdict
    assert (verdict.entries, verdict.slips, verdict.unread) == ((), (), ())


def test_sums_of_parallel_angles() -> None:
    for x in (
        "l1*c1 + l2*c12",
        "l1*c1 + l2*(c1*c2 - s1*s2)",
        "l1*cos(q1) + l2*cos(q1 + q2)",
        "l2*cos(theta_12) + c1*l1",
    ):
        assert ps.check(SCARA, "p", f"[{x}, l1*s1 + l2*s12, -d3]").right is True
        assert ps.check(SCARA, "p", f"[{x}, l1*s1 + l2*s2, -d3]").entries == ((2, 1),)


def test_arrays_and_sympy() -> None:
    assert ps.check(SPHERICAL, "Jb", RIGHT_JB).right is True
    assert ps.check(SPHERICAL, "Js", ps.derive(SPHERICAL).jacobian("spatial")).right is True


def wrong(quantity: str, text: object, robot: ps.Robot = SPHERICAL) -> AnswerVerdict:
    verdict = ps.check(robot, quantity, text)
    assert verdict.right is False
    assert verdict.unread == ()
    return verdict


def test_one_sign() -> None:
    """Assignment 4, part (f), as printed: entries (2,1) and (3,1) lack their minus sign."""
    rows = (r"c_1&s_1&0&0", r"s_1c_2&c_1c_2&-s_2&L_0s_2-L_3-\theta_3", r"s_1s_2&c_1s_2&c_2&-L_0c_2", "0&0&0&1")
    text = r"\begin{bmatrix}" + r"\\".join(rows) + r"\end{bmatrix}"
    verdict = wrong("Tinv", text)
    assert verdict.entries == ((2, 1), (3, 1))
    assert verdict.slips == ("the sign of entry (2, 1)", "the sign of entry (3, 1)")
    assert (verdict.given[1][0], verdict.expected[1][0]) == ("s_1c_2", "-c2*s1")


def test_one_hypothesis_on_the_whole() -> None:
    derivation = ps.derive(SPHERICAL)
    Jb, Js = derivation.jacobian("body"), derivation.jacobian("spatial")
    assert wrong("Jb", Js).slips == ("this is Js, asked was Jb",)
    assert wrong("Jb", -Jb).slips == ("every sign: this is -Jb",)
    assert wrong("Jb", Jb.extract([3, 4, 5, 0, 1, 2], [0, 1, 2])).slips == ("the rows are (ω, v), asked was (v, ω)",)
    assert wrong("R", derivation.pose[:3, :3].T).slips == ("it is transposed",)
    assert wrong("xi2", [0, "L0", 0, -1, 0, 0]).slips == ("v is negated: q × ω is right, not ω × q",)
    row, column = Jb.as_mutable(), Js.as_mutable()
    row[0, :], column[:, 1] = -row[0, :], -column[:, 1]
    assert wrong("Jb", row).slips == ("the sign of row 1",)
    assert wrong("Js", column).slips == ("the sign of column 2",)
    assert wrong("p", ["1", "2", "c1"]).slips == ()
    assert "no single slip explains it" in str(wrong("p", ["1", "2", "c1"]))


@pytest.mark.parametrize(
    ("cell", "slip"),
    [
        ("L0 - (L3 + d3)*c2", "c2 for s2"),
        ("L0 - (L3 + d3)*cos(q2)", "cos(q2) for sin(q2)"),
        ("L0 - (L3 + d3)*s1", "s1 for s2"),
        ("L0 + (L3 + d3)*s2", "the sign of (L3 + d3)*s2"),
        ("L0 - (L3 - d3)*s2", "the sign of d3"),
        ("L3 - (L3 + d3)*s2", "L3 for L0"),
        ("L0 - (L3 + d3)", "the factor s2 of L3 + d3 is missing"),
        ("L0 - L3*s2", "a term theta3 beside L3 is missing"),
        ("-(L3 + d3)*s2", "a term -L0 beside (L3 + d3)*s2 is missing"),
        ("L0 - (L3 + d3)*s2*c1", "the factor c1 is too many"),
        ("L0 - (L3 + d3)*s2 - L3", "the term -L3 is too many"),
        ("L0 - (L3 + dq3)*s2", "dq3 for theta3"),
        ("(L3 + d3)*c1*c2", "what is due at (2, 1) stands here"),
    ],
)
def test_one_change_of_an_entry(cell: str, slip: str) -> None:
    text = f"[-(L3 + d3)*s1*c2, (L3 + d3)*c1*c2, {cell}]"
    verdict = wrong("p", text)
    assert verdict.entries == ((3, 1),)
    assert verdict.slips == (f"entry (3, 1): {slip}",)


def test_a_sum_of_angles_is_short() -> None:
    verdict = wrong("p", "[l1*c1 + l2*c2, l1*s1 + l2*s12, -d3]", SCARA)
    assert verdict.slips == ("entry (1, 1): c2 for c12",)
    dotted = ["l0*q1 + (l0 + l1*c1)*dq2", "l1*s1*dq2", 0, 0, 0, "dq1 + dq2"]
    assert wrong("Vs", dotted, TWO).slips == ("entry (1, 1): q1 for dtheta1",)


@pytest.mark.slow
def test_every_printed_mistake_that_is_read_is_located() -> None:
    """The lists of the courseworks: what both engines refute is never called right here, whatever can't be read."""
    located, unread = 0, []
    for erratum in errata():
        derivation = ps.derive(erratum.robot)
        scope, meanings = Scope(derivation), Meanings(derivation)
        printed, right = read_plain(erratum.printed), read_plain(erratum.right)
        known = given(set(symbols(printed) | symbols(right)), meanings, scope, {})
        try:
            assert scope.value(printed, known) != scope.value(right, known), erratum
            located += 1
        except NoValueError as error:
            unread.append((erratum.printed, str(error)))
    assert (located, len(unread)) == (89, 7), unread


@pytest.mark.parametrize(
    ("cell", "reason"),
    [
        ("9**9**9", "a power of a power"),
        ("c1**13", "powers are whole numbers"),
        ("x*c1", "'x' is no symbol"),
        ("d1", "'d1' is no symbol"),
        ("1/0", "a division by zero"),
        ("(c1+s1+c2+L0+L3)**12*(c1+s1+c2+L0)**12", "too long"),
        ("cos(90)", "write degrees as"),
        ("cos(L0)", "what is no joint's angle"),
        ("sqrt(L0)", "a root of something else"),
        ("__import__('os')", "character"),
        ("cos(q1/3)", "are not compared"),
        ("tan(pi/2)", "no number"),
    ],
)
def test_unread_is_not_wrong(cell: str, reason: str) -> None:
    verdict = ps.check(SPHERICAL, "p", f"[{cell}, (L3+d3)*c1*c2, L0 - (L3+d3)*s2]")
    assert verdict.right is None
    assert verdict.entries == ()
    place, why = verdict.unread[0]
    assert place == (1, 1)
    assert reason in why


@pytest.mark.parametrize(
    "text",
    [
        "(" * 100_000,
        "(" * 50_000 + ")" * 50_000,
        "[" * 99_000,
        "",
        "[1, 2",
        "[1, 2; 3]",
        "c" + "1" * 90_000,
        r"\begin{bmatrix}" * 5000,
        r"\def\a{\a}\a",
        r"\begin{bmatrix} 1 \end{bmatrix}\begin{bmatrix} 1 \end{bmatrix}",
        "[0,0,0]" + "'" * 50_000,
        "-" * 99_999,
    ],
)
def test_hostile(text: str) -> None:
    with pytest.raises(ps.PinscrewError) as caught:
        ps.check(SPHERICAL, "p", text)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 2000


def test_no_such_quantity() -> None:
    for name in ("Jx", "xi4", "xi0", "J"):
        with pytest.raises(ps.PinscrewError, match="there is no quantity"):
            ps.check(SPHERICAL, name, "[1]")
    with pytest.raises(ps.PinscrewError, match="joints that follow others"):
        ps.check("gear_pair", "p", "[1, 2, 3]")


def test_command() -> None:
    right = run("check", "scara", "--quantity", "p", "--text", "[l1*c1 + l2*c12, l1*s1 + l2*s12, -q3]", "--json")
    assert right.status == 0
    assert json.loads(right.out)["answers"][0]["right"] is True
    done = run("check", "spherical", "--quantity", "xi2", "--text", "[0, L_0, 0, -1, 0, 0]^T", "--json")
    assert done.status == 1
    document = json.loads(done.out)
    (answer,) = document["answers"]
    assert document["schema"] == "pinscrew.check/1"
    assert (answer["quantity"], answer["right"], answer["entries"]) == ("xi2", False, [[2, 1]])
    assert (answer["given"][1], answer["expected"][1]) == (["L_0"], ["-L0"])
    unread = run("check", "spherical", "--quantity", "xi2", "--text", "[0, -L_9, 0, -1, 0, 0]^T")
    assert unread.status == 2
    assert "not read" in unread.out
    assert run("check", "spherical", "--quantity", "xi2", "--text", "[0, 1]").status == 2
