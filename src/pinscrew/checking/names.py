r"""Which quantity a name or a heading in an answer means: ``J^s_{ST}(\theta)``, ``J_body``, ``## Js: …``.

A name that may be of something else is of nothing here: ``T_1`` is the pose of some link, ``A`` anything.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from pinscrew.checking.quantities import is_quantity, quantity_key

__all__ = ["quantity_in_heading", "quantity_named"]

LONGEST_NAME: Final = 200
"""Characters of a name."""
_STYLE: Final = re.compile(
    r"\\(?:left|right|mathbf|boldsymbol|bm|mathrm|mathit|mathsf|mathcal|text|vec|underline|operatorname"
    r"|displaystyle|[,;:! ])(?![A-Za-z])|[\s{}&]"
)
_ARGUMENT: Final = re.compile(r"\((?!0\))[^()]*\)$|\[[^\[\]]*\]$")
_FRAMES: Final = r"(?:_?(?:s,?t|S,?T|s,?b|S,?B|b,?t|B,?T|BE|be|W,?E|0,?[tTeEn]|base,?tool|%(n)d|0,?%(n)d|\^0_%(n)d))?"
_POSE: Final = rf"(?:\^0)?(?:g|T|H){_FRAMES}"
_NAMES: Final[tuple[tuple[str, str], ...]] = (
    (rf"{_POSE}\(0\)|M|g_?0|home|T_?home", "M"),
    (rf"{_POSE}|T_?pose|fk|pose", "T"),
    (rf"(?:\^0)?R{_FRAMES}|rotation", "R"),
    (rf"(?:\^0)?p{_FRAMES}|position", "p"),
    (rf"{_POSE}\^-1|[gT]_?inv|inv_?[gT]", "Tinv"),
    (rf"dot{_POSE}|d[gT]|[gT]_?dot|[gT]d", "Tdot"),
    (r"xi_?(\d+)", "xi{}"),
    (r"twists|Xi|xis", "twists"),
    (r"e\^(?:hat|widehat)xi_?(\d+)\*?(?:theta|q|d)_?\1|exp_?(\d+)|e(\d+)", "exp{}"),
    (r"e\^\[S_?(\d+)\](?:theta|q|d)_?\1", "exp{}"),
    (r"omega_?(\d+)|w_?(\d+)", "omega{}"),
    (r"q_?(\d+)", "q{}"),
    (r"(?:hat|widehat)xi_?(\d+)|xi_?hat_?(\d+)", "hat(xi{})"),
    (r"(?:hat|widehat)omega_?(\d+)", "hat(omega{})"),
    (r"xi_?(\d+)'|xi'_?(\d+)|xi\^prime_?(\d+)", "Js{}"),
    (r"xi_?(\d+)\^dagger|xi\^dagger_?(\d+)", "Jb{}"),
    (rf"(?:hat|widehat)p{_FRAMES}|p_?hat", "phat"),
    (rf"dotp{_FRAMES}|p_?dot|dp", "pdot"),
    (rf"Ad_?{_POSE}|Ad(?:_g|_T)?", "Ad"),
    (rf"Ad_?{_POSE}\^-1|Ad_?inv", "Adinv"),
    (r"J_?v", "v(Jh)"),
    (r"J_?(?:omega|w)", "w(Jh)"),
    (r"(?:hat|widehat)V(?:[\^_]s|s)|Vs_?hat", "Vshat"),
    (r"z_?(\d+)", "z{}"),
)
_ONE: Final = re.compile(r"e\^(?:hat|widehat|\[)(?:xi|S)_?(\d+)\]?\*?(?:theta|q|d)_?\1")
_HOME: Final = re.compile(r"(?:g|T)(?:_?(?:st|ST))?\(0\)|M")
_KINDS: Final = {"s": "spatial", "b": "body", "h": "hybrid"}
_PHRASES: Final[tuple[tuple[str, str], ...]] = (
    (r"spatial (?:manipulator )?jacobian", "Js"),
    (r"body (?:manipulator )?jacobian", "Jb"),
    (r"(?:hybrid|geometric) jacobian", "Jh"),
    (r"spatial velocity|spatial twist", "Vs"),
    (r"body velocity|body twist", "Vb"),
    (r"hybrid velocity", "Vh"),
    (r"home (?:pose|configuration|position)|initial configuration", "M"),
    (r"inverse of the pose", "Tinv"),
    (r"rate of the pose", "Tdot"),
    (r"forward kinematics|pose of the tool|^pose\b", "T"),
)


def quantity_named(name: str, joints: int) -> str | None:
    """The key of the quantity that a name in LaTeX or in a program means; None where it means none, or may mean others.

    Args:
        name: the left side of an equation, or a variable.
        joints: how many joints move the frame: ``T_{03}`` is the pose of an arm of three.
    """
    if len(name) > LONGEST_NAME:
        return None
    plain = _STYLE.sub("", name).replace("\\", "")
    plain = _ARGUMENT.sub("", plain)
    numbers = [int(number) for number in _ONE.findall(plain)]
    if len(numbers) > 1:
        rest = _ONE.sub("", plain)
        return _product(numbers, joints, home=bool(rest)) if not rest or _HOME.fullmatch(rest) else None
    for pattern, key in (*_NAMES, *_of_kinds()):
        found = re.fullmatch(pattern % {"n": joints} if "%(n)d" in pattern else pattern, plain)
        if found:
            number = next((group for group in found.groups() if group), "")
            first = 0 if key.startswith("z") else 1
            return None if number and not first <= int(number) < first + joints else key.format(number)
    return quantity_key(name, joints) if is_quantity(name, joints) else None


def _product(numbers: list[int], joints: int, *, home: bool) -> str | None:
    """The key of a product of exponentials in order, with or without the home pose."""
    first, last = numbers[0], numbers[-1]
    if numbers != list(range(first, last + 1)) or not 1 <= first < last <= joints:
        return None
    if home:
        return None if last < joints else "T" if first == 1 else f"tail{first}"
    return f"prod{last}" if first == 1 else None


def _of_kinds() -> Iterator[tuple[str, str]]:
    """Names of Jacobians and velocities, with the letter above or below."""
    for letter, kind in _KINDS.items():
        letters = f"{letter}|{kind}" if letter != "h" else "h|hybrid|geometric"
        for base in "JV":
            word = "jacobian" if base == "J" else "velocity"
            scripts = rf"(?:[\^_](?:{letters}){_FRAMES}|{_FRAMES}[\^_](?:{letters})|_?(?:{letters}))"
            yield rf"{base}{scripts}|(?:{letters})_{word}|{word}_(?:{letters})", f"{base}{letter}"
            if (base, letter) == ("V", "b"):
                yield rf"(?:hat|widehat)V{scripts}", "Vbhat"


def quantity_in_heading(heading: str, joints: int) -> str | None:
    """The key of the quantity that a heading is about: its name before a colon, or what books call it."""
    heading = re.sub(r"^[\s*_]*(?:\(?\w{1,2}[.)]\s*)?", "", heading[:LONGEST_NAME]).replace("$", "")
    named = quantity_named(heading.partition(":")[0].strip(), joints)
    if named is not None:
        return named
    found = [key for pattern, key in _PHRASES if re.search(pattern, heading, re.IGNORECASE)]
    return found[0] if len(found) == 1 else None
