"""A student's own symbols, short forms of LaTeX, and matrices of named blocks."""

from __future__ import annotations

from pathlib import Path

import pytest

import pinscrew as ps

SCARA = ps.load("scara")


@pytest.mark.parametrize(
    "text",
    [
        r"[l_1 c\theta_1 + l_2 c\theta_{12}, l_1 s \theta_1 + l_2 s\theta_{12}, -d_3]",
        r"[l_1 c_{\theta_1} + l_2 c_{\theta_1+\theta_2}, l_1 s_{\theta_1} + l_2 s_{12}, -d_3]",
        r"[\frac12(2 l_1 \cos\vartheta_1 + 2 l_2 c_{12}), l_1 s_1 + \frac{2l_2}2 s_{12}, -d_3]",
        r"\begin{bmatrix} l_1 C_1 + l_2 C_{12} \\ l_1 S_1 + l_2 S_{12} \\ -d_3 \end{bmatrix}",
    ],
)
def test_short_forms(text: str) -> None:
    verdict = ps.check(SCARA, "p", text)
    assert (verdict.right, verdict.meant) == (True, ()), verdict


def test_letters_of_ones_own() -> None:
    verdict = ps.check(SCARA, "p", r"[a_1 c_1 + a_2 c_{12}, a_1 s_1 + a_2 s_{12}, -d_3]")
    assert (verdict.right, verdict.meant) == (True, (("a_1", "l1"), ("a_2", "l2")))
    assert "read: a_1 as l1, a_2 as l2" in str(verdict)
    assert verdict.data()["answers"][0]["meant"] == {"a_1": "l1", "a_2": "l2"}
    swapped = ps.check(SCARA, "p", "[b*c1 + a*c12, b*s1 + a*s12, -d3]")
    assert (swapped.right, swapped.meant) == (True, (("a", "l2"), ("b", "l1")))
    wrong = ps.check(SCARA, "p", "[a*c1 + l2*c12, a*s1 - l2*s12, -d3]")
    assert (wrong.entries, wrong.meant) == (((2, 1),), (("a", "l1"),))
    assert wrong.slips == ("entry (2, 1): the sign of l2*s12",)


@pytest.mark.parametrize(
    "text",
    [
        "[l9*c1 + l2*c12, l9*s1 + l2*s12, -d3]",  # it may be a wrong index
        "[a*c1 + b*c12, a*s1 + c*s12, -d3]",  # three letters for two lengths
        "[a*c1 + l2*c1, l1*s1 + l2*s12, -d3]",  # a letter in a wrong entry alone
        "[a*c2 + l2*c12, a*s2 + l2*s12, -d3]",  # no assignment fits
        "[c9*c1 + l2*c12, c9*s1 + l2*s12, -d3]",  # a cosine of a joint that is not there
    ],
)
def test_letters_that_are_not_guessed(text: str) -> None:
    verdict = ps.check(SCARA, "p", text)
    assert verdict.meant == ()
    assert verdict.unread
    assert verdict.right is not True


def test_a_dot_too_many() -> None:
    assert ps.check(SCARA, "pdot", r"[0, 0, -\ddot{\theta}_3]").unread == ()
    right = "-(l1*s1 + l2*s12)*dq1 - l2*s12*dq2, (l1*c1 + l2*c12)*dq1 + l2*c12*dq2"
    verdict = ps.check(SCARA, "pdot", f"[{right}, -ddq3]")
    assert (verdict.entries, verdict.slips) == (((3, 1),), ("entry (3, 1): ddq3 for dtheta3",))
    assert ps.check(SCARA, "p", "[ddq9, 0, 0]").unread[0][0] == (1, 1)


def test_named_blocks(tmp_path: Path) -> None:
    R = r"R = \begin{bmatrix} c_{12} & -s_{12} & 0 \\ s_{12} & c_{12} & 0 \\ 0 & 0 & 1 \end{bmatrix}"
    p = r"p = \begin{bmatrix} l_1 c_1 + l_2 c_{12} \\ l_1 s_1 + l_2 s_{12} \\ -d_3 \end{bmatrix}"
    T = r"T = \begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}"
    assert ps.check(SCARA, "T", f"{R}\n\n{p}\n\n{T}").right is True
    (tmp_path / "a.md").write_text(f"$${R}$$\n$${p}$$\n$${T}$$\n$$g^{{-1}} = [1, 2]$$", encoding="utf-8")
    sheet = ps.check_file(SCARA, tmp_path / "a.md")
    assert [(verdict.quantity, verdict.right) for verdict, _ in sheet.verdicts] == [
        ("R", True),
        ("p", True),
        ("T", True),
    ]
    transposed = ps.check(SCARA, "R", R + "\n\n" + r"\begin{bmatrix} R^T \end{bmatrix}")
    assert transposed.slips == ("it is transposed",)
    python = "R = [[c12, -s12, 0], [s12, c12, 0], [0, 0, 1]]\np = [[l1*c1 + l2*c12], [l1*s1 + l2*s12], [-q3]]\n"
    assert ps.check(SCARA, "T", python + "T = [[R, p], [0, 1]]").right is True
    with pytest.raises(ps.PinscrewError, match="4 rows"):
        ps.check(SCARA, "T", python + "T = [[R, R], [p, 1]]")
