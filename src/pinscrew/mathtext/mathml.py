r"""MathML as the LaTeX that would look the same: what a browser shows is what is read.

A group that cannot be seen is none: ``<mrow>a + b</mrow> c`` is shown as a + b c, and so it is read.
"""

from __future__ import annotations

import re
from typing import Final
from xml.etree import ElementTree as ET

from pinscrew.ground.errors import InputError

__all__ = ["formulas", "to_latex"]

_LETTERS: Final = {
    "θ": r"\theta", "ω": r"\omega", "ξ": r"\xi", "π": r"\pi", "α": r"\alpha", "β": r"\beta", "γ": r"\gamma",
    "δ": r"\delta", "φ": r"\phi", "ψ": r"\psi", "λ": r"\lambda", "μ": r"\mu", "ρ": r"\rho", "∂": r"\partial",
    "−": "-", "×": r"\times", "·": r"\cdot", "⋅": r"\cdot", "′": "'", "†": r"\dagger", "…": r"\dots", "‖": r"\|",
    "cos": r"\cos", "sin": r"\sin", "tan": r"\tan", "𝒮": r"\mathcal{S}", "𝒱": r"\mathcal{V}", "&": r"\&", "_": r"\_",
}  # fmt: skip
_ACCENTS: Final = {"ˆ": r"\hat", "^": r"\hat", "˙": r"\dot", "¨": r"\ddot"}
_MATH: Final = re.compile(r"<math\b.*?</math>", re.DOTALL)
DEEPEST: Final = 60
"""Elements within one another."""


def formulas(page: str) -> list[str]:
    """Every formula of a page in LaTeX, in order."""
    return [to_latex(match[0]) for match in _MATH.finditer(page)]


def to_latex(mathml: str) -> str:
    """A ``<math>`` element in LaTeX.

    Raises:
        InputError: it is no XML, is nested too deeply, or has an element that is not read.
    """
    if "<!" in mathml:
        raise InputError("formula", "declarations in MathML are not read")
    try:
        return _element(ET.fromstring(mathml), 0)  # noqa: S314 (there is no declaration, and so no entity)
    except ET.ParseError as error:
        raise InputError("formula", f"this is no MathML: {error}") from None


def _element(e: ET.Element, depth: int) -> str:  # noqa: PLR0911 (one for each kind of element)
    if depth > DEEPEST:
        raise InputError("formula", f"more than {DEEPEST} elements stand within one another")
    tag = e.tag.rpartition("}")[2]
    if tag in ("mi", "mn", "mo", "mtext"):
        text = (e.text or "").strip()
        return _LETTERS.get(text, text)
    if tag == "mspace":
        return r"\quad" if e.get("width", "").startswith(("1em", "1.0em", "2em")) else " "
    if tag == "mrow" and len(e) > 1 and _upright(e[0]) and all(map(_in_a_name, e)):
        return rf"\mathrm{{{''.join(_element(child, depth + 1) for child in e)}}}"
    if tag in ("math", "mrow", "mstyle", "mpadded"):
        return _row(list(e), depth)
    parts = [_element(child, depth + 1) for child in e]
    if tag == "mtable":
        return r"\begin{bmatrix} " + r" \\ ".join(parts) + r" \end{bmatrix}"
    if tag == "mtr":
        return " & ".join(parts)
    if tag == "mtd":
        return _row(list(e), depth)
    if tag == "msqrt":
        return rf"\sqrt{{{_row(list(e), depth)}}}"
    if tag == "mover" and len(parts) == 2 and parts[1] in _ACCENTS:
        return f"{_ACCENTS[parts[1]]}{{{parts[0]}}}"
    shapes = {"mfrac": (2, r"\frac{{{}}}{{{}}}"), "msub": (2, "{}_{{{}}}"), "msup": (2, "{}^{{{}}}")}
    count, shape = shapes.get(tag, (3, "{}_{{{}}}^{{{}}}"))
    if (tag not in shapes and tag != "msubsup") or len(parts) != count:
        raise InputError("formula", f"<{tag}> of {len(parts)} elements is not read")
    return shape.format(*parts)


def _upright(e: ET.Element) -> bool:
    return e.tag.rpartition("}")[2] == "mi" and e.get("mathvariant") == "normal"


def _in_a_name(e: ET.Element) -> bool:
    """Whether it is upright as the letters of a name are, or a digit of it."""
    return _upright(e) or e.tag.rpartition("}")[2] == "mn"


def _row(children: list[ET.Element], depth: int) -> str:
    """Elements side by side; upright letters that follow one another are a name."""
    words: list[str] = []
    name = ""
    for child in children:
        if _upright(child):
            name += _element(child, depth + 1)
            continue
        words += [rf"\mathrm{{{name}}}"] if name else []
        name = ""
        words.append(_element(child, depth + 1))
    words += [rf"\mathrm{{{name}}}"] if name else []
    text = " ".join(word for word in words if word)
    # The brackets of a matrix are its own.
    return text.replace(r"[ \begin{bmatrix}", r"\begin{bmatrix}").replace(r"\end{bmatrix} ]", r"\end{bmatrix}")
