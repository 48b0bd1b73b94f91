"""MathML, equations with matrices, and programs, read: what a page shows is what is read, and no more."""

from __future__ import annotations

import pytest

from pinscrew.ground.errors import InputError
from pinscrew.mathtext import Number, evaluate, mathml, read_latex
from pinscrew.mathtext.equations import Grid, read_equations
from pinscrew.mathtext.programs import read_programs


def math(inside: str) -> str:
    return f'<math xmlns="http://www.w3.org/1998/Math/MathML"><mrow>{inside}</mrow></math>'


@pytest.mark.parametrize(
    ("inside", "latex"),
    [
        ("<mfrac><mi>a</mi><mrow><mi>b</mi><mo>+</mo><mn>2</mn></mrow></mfrac>", r"\frac{a}{b + 2}"),
        ("<msubsup><mi>c</mi><mn>1</mn><mn>2</mn></msubsup>", "c_{1}^{2}"),
        ("<msub><mover><mi>θ</mi><mo>˙</mo></mover><mn>1</mn></msub>", r"\dot{\theta}_{1}"),
        ("<msup><mover><mi>V</mi><mo>ˆ</mo></mover><mi>b</mi></msup>", r"\hat{V}^{b}"),
        ("<msqrt><mn>2</mn><mi>x</mi></msqrt>", r"\sqrt{2 x}"),
        ('<mi mathvariant="normal">a</mi><mi mathvariant="normal">_</mi><mn>7</mn>', r"\mathrm{a\_7}"),
        ('<mi mathvariant="normal">A</mi><mi mathvariant="normal">d</mi><mi>x</mi>', r"\mathrm{Ad} x"),
        ("<mo>−</mo><mi>cos</mi><mi>x</mi><mo>×</mo><mi>y</mi>", r"- \cos x \times y"),
        (
            "<mrow><mi>a</mi><mo>+</mo><mi>b</mi></mrow><mi>c</mi>",
            "a + b c",
        ),  # no parenthesis is seen, and none is read
        (
            "<mo>[</mo><mtable><mtr><mtd><mn>1</mn></mtd><mtd><mi>x</mi></mtd></mtr></mtable><mo>]</mo>",
            r"\begin{bmatrix} 1 & x \end{bmatrix}",
        ),
    ],
)
def test_mathml(inside: str, latex: str) -> None:
    assert mathml.to_latex(math(inside)) == latex
    assert mathml.formulas(f"<p>{math(inside)} and {math('<mi>y</mi>')}</p>") == [latex, "y"]


@pytest.mark.parametrize(
    "text",
    [
        "<math><mi>x</math>",
        math("<maction><mi>x</mi></maction>"),
        math("<mfrac><mi>x</mi></mfrac>"),
        math("<mover><mi>x</mi><mo>~</mo></mover>"),
        '<!DOCTYPE x [<!ENTITY a "b">]><math><mi>&a;</mi></math>',
        math("<mrow>" * 99 + "</mrow>" * 99),
    ],
)
def test_mathml_that_is_not_read(text: str) -> None:
    with pytest.raises(InputError):
        mathml.to_latex(text)


def test_equations() -> None:
    text = (
        r"J = \begin{aligned} A &= \begin{bmatrix} a & b \\ c & d \end{bmatrix} x \\ &= 0 \end{aligned} , \quad q_1 = 1"
    )
    grid = Grid((("a", "b"), ("c", "d")))
    assert read_equations(text) == ((("J",), ("A",), (grid, "x"), ("0",)), (("q_1",), ("1",)))


@pytest.mark.parametrize(
    "text",
    [r"\begin{bmatrix} a & b \\ c \end{bmatrix}", r"\begin{bmatrix} a", "x" * 100_001, "\ue0000\ue001"],
)
def test_equations_that_are_not_read(text: str) -> None:
    with pytest.raises(InputError):
        read_equations(text)


PROGRAMS = {
    "python": '"""A."""\n\nimport math\n\ndef fk(q, L=0.5):\n    x = q[0]\n'
    "    return [\n        [math.cos(x), L*2.0],\n    ]\n",
    "c": "/* A */\nvoid fk(const double *q, const double *lengths, double out[2])\n{\n    (void)q;\n"
    "    const double L = lengths[0];\n    const double x = q[0];\n    out[0] = cos(x);\n    out[1] = L*2.0;\n}\n",
    "matlab": "% A\nfunction out = fk(q, lengths)\n    if nargin < 2\n        lengths = [0.5];\n    end\n"
    "    L = lengths(1);\n    x = q(1);\n    out = [\n        cos(x)  L.*2.0\n    ];\nend\n",
    "julia": "# A\nconst default_lengths = Float64[0.5]\nfunction fk(q, lengths=default_lengths)\n"
    "    L = lengths[1];\n    x = q[1];\n    return [\n        cos(x)  L/1//2\n    ]\nend\n",
}


@pytest.mark.parametrize("language", PROGRAMS)
def test_programs(language: str) -> None:
    (program,) = read_programs(PROGRAMS[language], language)
    assert program.name == "fk"
    assert [name for name, _ in program.steps] == (["x"] if language == "python" else ["L", "x"])
    (row,) = program.cells
    assert [float(evaluate(cell, {"x": 0.0, "L": 3.0})) for cell in row] == [1.0, 6.0]


@pytest.mark.parametrize("line", ["x = q[0] if y else 2", "for i in q:", "x += 1", "import os", "x = 2 y"])
def test_programs_that_are_not_read(line: str) -> None:
    with pytest.raises(InputError):
        read_programs(f"def fk(q):\n    {line}\n    return [\n        [x],\n    ]\n", "python")


def test_an_array_in_c_is_whole() -> None:
    text = PROGRAMS["c"].replace("out[1]", "out[2]")
    (program,) = read_programs(text, "c")
    assert len(program.cells[0]) == 1  # an entry that is left out is none
    assert read_latex("2") == Number(2.0)
