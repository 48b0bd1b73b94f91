"""Files of answers in each language: what is in them is found, graded at its place, and nothing is run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import pinscrew as ps
from command_line import run
from pinscrew.checking.names import quantity_in_heading, quantity_named
from pinscrew.checking.passages import passages
from pinscrew.checking.sheet import AnswerSheet

SCARA = ps.load("scara")
PYTHON = """import numpy as np
from numpy import cos, sin
l1 = 0.4  # a number in the place of what is a symbol
c1, s1 = cos(q1), sin(q1)
c12 = cos(q1 + q2); s12 = sin(q1 + q2)

def body_jacobian(q):
    half = np.array([[1, 2], [3, 4]])
    return np.array([[l1*s2, 0, 0], [l2 + l1*c2, l2, 0], [0, 0, -1], [0, 0, 0], [0, 0, 0], [1, 1, 0]])

T = np.array([[c12, -s12, 0, l1*c1 + l2*c12],
              [s12, c12, 0, l1*s1 - l2*s12],
              [0, 0, 1, -q3],
              [0, 0, 0, 1]])
A_1 = np.array([[c1, -s1], [s1, c1]])
"""
MATLAB = """function J = Jb(q)
  % the body Jacobian
  J = [l1*s2 0 0; l2+l1*c2 l2 0; 0 0 -1; 0 0 0; 0 0 0; 1 1 0];
end
xi1 = [0 0 0 0 0 1]'; xi_2 = [0; l1; 0; 0; 0; 1];
T = [1 2; 3 4];
"""
LATEX = r"""\documentclass{article}
\begin{document}
\section*{Twists} % \section{not here}
\begin{align}
  \xi_1 &= (0, 0, 0, 0, 0, 1)^T \label{one} \\
  \xi_2 &= \begin{pmatrix} 0 \\ -\ell \\ 0 \\ 0 \\ 0 \\ 1 \end{pmatrix} \nonumber \\
  \xi_3 &= \begin{bmatrix} 0 \\ 0 \\ 0 \end{bmatrix}
        = \boldsymbol{\begin{bmatrix} 0 \end{bmatrix}}
\end{align}
\subsection{Spatial Jacobian}
where $\ell = l_1$ and
\[ \boxed{\begin{bmatrix} 0 & l_1 s_1 & 0 \\ 0 & -l_1 c_1 & 0 \\ 0 & 0 & -1 \\ 0&0&0 \\ 0&0&0 \\
  1&1&0 \end{bmatrix}} \]
\begin{equation*}
  p_{0n}(\theta) = \begin{bmatrix} l_1 c_1 + l_2 c_{12} \\ l_1 s_1 + l_2 s_{12} \\ \theta_3 \end{bmatrix}
\end{equation*}
\[ an end that is missing
\end{document}
"""


def graded(tmp_path: Path, name: str, text: str, robot: ps.Robot = SCARA) -> AnswerSheet:
    (tmp_path / name).write_text(text, encoding="utf-8")
    return ps.check_file(robot, tmp_path / name)


def found(sheet: AnswerSheet) -> list[tuple[str, bool | None, int]]:
    return [(verdict.quantity, verdict.right, line) for verdict, line in sheet.verdicts]


def test_python(tmp_path: Path) -> None:
    sheet = graded(tmp_path, "answers.py", PYTHON)
    assert found(sheet) == [("Jb", True, 9), ("T", False, 11)]
    assert sheet.verdicts[1][0].entries == ((2, 4),)
    assert sheet.verdicts[1][0].slips == ("entry (2, 4): the sign of l2*s12",)
    assert (sheet.passed, sheet.refused, sheet.right) == (("half", "A_1"), (), False)


def test_matlab(tmp_path: Path) -> None:
    sheet = graded(tmp_path, "answers.m", MATLAB)
    assert found(sheet) == [("Jb", True, 3), ("xi1", True, 5), ("xi2", False, 5)]
    (refused,) = sheet.refused
    assert (refused.quantity, refused.line) == ("T", 6)
    assert "4 rows and 4 columns" in refused.reason


def test_latex(tmp_path: Path) -> None:
    sheet = graded(tmp_path, "answers.tex", LATEX)
    assert found(sheet) == [("xi1", True, 4), ("xi2", True, 4), ("Js", True, 12), ("p", False, 14)]
    assert sheet.verdicts[3][0].slips == ("the sign of entry (3, 1)",)
    assert [each.quantity for each in sheet.refused] == ["xi3"]


@pytest.mark.parametrize(
    "form", ["markdown", *(pytest.param(form, marks=pytest.mark.slow) for form in ("latex", "notebook"))]
)
def test_worksheet_is_read_back(tmp_path: Path, form: str) -> None:
    """Empty it says what there is to do; with one matrix filled in, and no more, that is graded."""
    file = tmp_path / {"markdown": "scara.md", "latex": "scara.tex", "notebook": "scara.ipynb"}[form]
    assert run("derive", "scara", "--worksheet", "--format", form, "-o", file).status == 0
    sheet = ps.check_file("scara", file)
    wanted = ("M", "xi1", "xi2", "xi3", "exp1", "exp2", "exp3", "T", "Tinv", "Js", "Jb", "Jh", "Vb")
    assert (sheet.blank, sheet.verdicts, sheet.refused, sheet.right) == (wanted, (), (), None)
    text, empty = file.read_text(encoding="utf-8"), r"? \\ ? \\ ? \\ ? \\ ? \\ ?"
    answer = r"0 \\ 0 \\ 0 \\ 0 \\ 0 \\ 1"
    if form == "notebook":
        empty, answer = empty.replace("\\", "\\\\"), answer.replace("\\", "\\\\")
    file.write_text(text.replace(empty, answer, 1), encoding="utf-8")
    sheet = ps.check_file("scara", file)
    assert [(verdict.quantity, verdict.right) for verdict, _ in sheet.verdicts] == [("xi1", True)]
    assert sheet.blank == wanted[:1] + wanted[2:]


@pytest.mark.parametrize("form", ["markdown", pytest.param("latex", marks=pytest.mark.slow)])
def test_what_derive_writes_is_right(tmp_path: Path, form: str) -> None:
    for robot in ("scara", "spherical") if form == "latex" else ("scara",):
        file = tmp_path / {"markdown": f"{robot}.md", "latex": f"{robot}.tex"}[form]
        run("derive", robot, "--format", form, "-o", file, "--samples", "1")
        sheet = ps.check_file(robot, file)
        assert (sheet.count(True), sheet.right) == (30, True)


def test_json(tmp_path: Path) -> None:
    answers = {
        "xi1": [0, 0, 0, 0, 0, 1],
        "p": r"\begin{bmatrix} l_1 \\ 0 \\ 0 \end{bmatrix}",
        "K": [1],
        "Js": [[1], [1, 2]],
    }
    sheet = graded(tmp_path, "a.json", json.dumps(answers))
    assert [(quantity, right) for quantity, right, _ in found(sheet)] == [("xi1", True), ("p", False)]
    assert sheet.passed == ("K",)
    assert "differ in length" in sheet.refused[0].reason
    again = graded(tmp_path, "b.json", sheet.to_json())
    assert [(quantity, right) for quantity, right, _ in found(again)] == [("xi1", True), ("p", False)]


def test_what_is_said_last_is_the_answer(tmp_path: Path) -> None:
    text = "## Js\n$$[1, 2]$$\n$$(0, 0, 0)$$\n## exp1\n$$ A B $$\n## nothing\n$$(1, 2)$$\n"
    text += "```python\nxi1 = [0,0,0,0,0,1]\n```"
    sheet = graded(tmp_path, "a.md", text)
    assert found(sheet) == [("xi1", True, 9)]
    assert [each.quantity for each in sheet.refused] == ["Js"]
    product = r"$$ p = \begin{bmatrix}1\end{bmatrix}\begin{bmatrix}1\end{bmatrix} $$"
    result = "$$p = (l_1 c_1 + l_2 c_{12}, l_1 s_1 + l_2 s_{12}, -q_3)$$"
    assert [each.quantity for each in graded(tmp_path, "a.md", product).refused] == ["p"]
    sheet = graded(tmp_path, "a.md", f"{product}\n{result}")
    assert (found(sheet), sheet.refused, sheet.right) == ([("p", True, 2)], (), True)


@pytest.mark.parametrize(
    ("name", "key"),
    [
        (r"J^s_{ST}(\theta)", "Js"),
        (r"J_b", "Jb"),
        ("J^{b}", "Jb"),
        ("J_{spatial}", "Js"),
        ("geometric_jacobian", "Jh"),
        (r"\mathbf{J}^{h}", "Jh"),
        (r"g_{st}(\theta)", "T"),
        (r"g_{st}(0)", "M"),
        ("T_{03}", "T"),
        ("T_{02}", None),
        (r"{}^0T_3", "T"),
        (r"^{0}T_{2}", None),
        ("T_1", None),
        (r"\hat{V}^b_{ST}", "Vbhat"),
        (r"V^{b}", "Vb"),
        (r"\dot T", "Tdot"),
        (r"\dot{g}", "Tdot"),
        ("g^{-1}", "Tinv"),
        ("T_inv", "Tinv"),
        (r"e^{\hat{\xi}_2 \theta_2}", "exp2"),
        (r"e^{\hat{\xi}_2 \theta_1}", None),
        (r"e^{\hat\xi_1\theta_1} e^{\hat\xi_2\theta_2}", "prod2"),
        (r"\xi_{3}", "xi3"),
        ("xi4", None),
        ("R_{ST}", "R"),
        ("p", "p"),
        ("A", None),
        ("J", None),
        ("q", None),
        ("T" * 300, None),
    ],
)
def test_names(name: str, key: str | None) -> None:
    assert quantity_named(name, 3) == key


@pytest.mark.parametrize(
    ("heading", "key"),
    [
        ("Js: the spatial Jacobian", "Js"),
        ("(l) Spatial Jacobian, column by column", "Js"),
        ("2. The body Jacobian", "Jb"),
        ("**b)** Geometric Jacobian", "Jh"),
        ("Body velocity", "Vb"),
        ("$T$: pose", "T"),
        ("Home pose", "M"),
        ("Body and spatial velocity", "Vs"),
        ("Spatial Jacobian and body Jacobian", None),
        ("What is given", None),
    ],
)
def test_headings(heading: str, key: str | None) -> None:
    assert quantity_in_heading(heading, 3) == key


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.docx", "T = [1]"),
        ("a", ""),
        ("a.ipynb", "{}"),
        ("a.ipynb", "[" * 100_000),
        ("a.json", "[1, 2]"),
        ("a.json", "{"),
        ("a.json", "1" * 100_000),
        ("a.py", "x = 1\n" * 2001),
    ],
)
def test_refused(tmp_path: Path, name: str, text: str) -> None:
    with pytest.raises(ps.PinscrewError) as caught:
        graded(tmp_path, name, text)
    assert caught.value.code == "check-file"
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "suffix"),
    [
        ("$" * 99_999, "a.md"),
        (r"\[" * 50_000, "a.tex"),
        (r"\begin{equation}" * 6000, "a.md"),
        ("```\n" * 2001, "a.md"),
        ("# " * 50_000, "a.md"),
        (r"$$\boxed{" * 10_000, "a.tex"),
        ("", "a.txt"),
        ("$$ p = " + "(" * 90_000 + "$$", "a.md"),
        ("$$ p = [9**9**9, l_1 s_1 + l_2 s_{12}, -q_3] $$", "a.md"),
        (r"$$\def\x{\x\x} p = (\x, l_1 s_1 + l_2 s_{12}, -q_3)$$", "a.tex"),
        ("p = [__import__('os').system('false'), l1*s1 + l2*s12, -q3]", "a.py"),
    ],
)
def test_hostile(tmp_path: Path, text: str, suffix: str) -> None:
    """Nothing hangs, nothing is run, and what can't be read is not wrong."""
    try:
        sheet = graded(tmp_path, suffix, text)
    except ps.PinscrewError as error:
        assert "\n" not in str(error)  # noqa: PT017 (either is right)
    else:
        assert sheet.count(False) == sheet.count(True) == 0
        assert sheet.right is None


def test_lines_of_passages() -> None:
    found = [(passage.text, passage.line) for passage in passages("\n\na = [1,\n 2]; b = 3\n# c = 4\nd = 5", ".py")]
    assert found == [("a = [1,\n 2]", 3), ("b = 3", 4), ("d = 5", 6)]
    found = [(passage.text, passage.line) for passage in passages("a\n$x$ and\n\n```m\ny = 1;\nz = 2\n```", ".md")]
    assert found == [("x", 2), ("y = 1", 5), ("z = 2", 6)]


def test_command(tmp_path: Path) -> None:
    (tmp_path / "answers.py").write_text(PYTHON, encoding="utf-8")
    done = run("check", "scara", tmp_path / "answers.py")
    assert done.status == 1
    assert "answers.py: 1 right, 1 wrong, 0 not read" in done.out
    document = json.loads(run("check", "scara", tmp_path / "answers.py", "--json").out)
    assert [(each["quantity"], each["right"], each["line"]) for each in document["answers"]] == [
        ("Jb", True, 9),
        ("T", False, 11),
    ]
    (tmp_path / "right.py").write_text("xi1 = [0, 0, 0, 0, 0, 1]", encoding="utf-8")
    assert run("check", "scara", "l1:=0.5", tmp_path / "right.py").status == 0
    (tmp_path / "empty.py").write_text("", encoding="utf-8")
    assert run("check", "scara", tmp_path / "empty.py").status == 2
    for words in (
        ("scara",),
        ("scara", "a.md", "--quantity", "p", "--text", "[1]"),
        ("scara", "--quantity", "p"),
        ("a", "b", "c"),
    ):
        done = run("check", *words)
        assert done.status == 2
        assert done.err.count("\n") <= 4
