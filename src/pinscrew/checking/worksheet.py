"""A worksheet: what is given, and a matrix to fill in for each quantity, which `check_file` reads back."""

from __future__ import annotations

from typing import Final

from pinscrew.checking.files import BLANK
from pinscrew.checking.quantities import QUANTITIES, quantity_key, right_form
from pinscrew.derivation.blocks import Formula, Paragraph, Section, Writeup, from_file
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.reports import given, write

__all__ = ["worksheet"]

_ASKED: Final = ("M", "xi", "exp", "T", "Tinv", "Js", "Jb", "Jh", "Vb")
_LATEX: Final = {
    "M": "g(0)",
    "T": r"g(\theta)",
    "Tinv": r"g^{-1}",
    "Js": "J^{s}",
    "Jb": "J^{b}",
    "Jh": "J^{h}",
    "Vb": "V^{b}",
}


def worksheet(derivation: Derivation, form: str) -> str:
    """The worksheet of a robot.

    Args:
        derivation: the closed forms; they give no more than the sizes.
        form: ``"markdown"``, ``"latex"``, ``"notebook"``, or another of `derivation.reports.write`.

    Raises:
        InputError: there is no such format.
    """
    n = len(derivation.chain.joints)
    sections = [given(derivation), Section("", "how", "How to fill it in", (Paragraph(_HOW),))]
    for name in _ASKED:
        numbered = [f"{name}{i}" for i in range(1, n + 1)] if name in ("xi", "exp") else [name]
        sections += [_asked(derivation, quantity_key(key, n)) for key in numbered]
    title = f"Worksheet: the kinematics of {from_file(derivation.robot.name)}"
    return write(Writeup(title, tuple(sections), "import pinscrew as ps", ok=True), form)


_HOW: Final = (
    f"Write each entry in the place of its {BLANK}: in the symbols above, with $c_1$ for $\\cos\\theta_1$ and "
    "$c_{12}$ for $\\cos(\\theta_1 + \\theta_2)$, or in any other way. Leave what you have not done as it is. Then "
    "`pinscrew check` says which entries are wrong, and why."
)


def _asked(derivation: Derivation, key: str) -> Section:
    rows, columns = right_form(derivation, key).shape
    cells = r" \\ ".join([" & ".join([BLANK] * columns)] * rows)
    matrix = rf"\begin{{bmatrix}} {cells} \end{{bmatrix}}"
    number = "".join(c for c in key if c.isdigit())
    named = {f"xi{number}": rf"\xi_{{{number}}}"}
    if number and key == f"exp{number}":
        named[key] = rf"e^{{\hat{{\xi}}_{{{number}}} {derivation.chain.joints[int(number) - 1].variable.latex[0]}}}"
    words = {f"xi{number}": f"the twist of joint {number}", f"exp{number}": f"the exponential of joint {number}"}
    title = f"{key}: {words.get(key) or QUANTITIES[key]}"
    return Section("", f"answer-{key}", title, (Formula((named.get(key) or _LATEX[key], matrix)),))
