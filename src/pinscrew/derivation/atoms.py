"""Names for sines and cosines, as the courseworks write them: c1, s12, c123."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp

from pinscrew.derivation.trig import Algebra, Atom

__all__ = ["Atoms"]


class Atoms:
    """The symbols that stand for the sines and cosines of an algebra, made as they are asked for.

    Attributes:
        latex: how to typeset each symbol.
        explicit: what each symbol stands for, such as cos(θ1 + θ2).
    """

    def __init__(self, algebra: Algebra, labels: Mapping[sp.Symbol, str]) -> None:
        """Name the atoms of ``algebra`` after the ``labels`` of its angles, such as ``"1"``."""
        self.latex: dict[sp.Symbol, str] = {}
        self.explicit: dict[sp.Symbol, sp.Expr] = {}
        self.order: dict[sp.Symbol, tuple[int, ...]] = {}
        self._algebra = algebra
        self._labels = labels
        self._made: dict[tuple[int, Atom], sp.Symbol] = {}

    def symbol(self, group: int, atom: Atom) -> sp.Symbol:
        """The symbol of an atom of a group of angles."""
        if (group, atom) not in self._made:
            self._made[group, atom] = self._make(group, atom)
        return self._made[group, atom]

    def _make(self, group: int, atom: Atom) -> sp.Symbol:
        sine, m = atom
        angles = self._algebra.angles[group]
        parts = [(factor, self._labels[angle]) for factor, angle in zip(m, angles, strict=True) if factor]
        letter = "s" if sine else "c"
        symbol = sp.Symbol(letter + _plain(parts), real=True)
        self.latex[symbol] = f"{letter}_{{{_typeset(parts)}}}"
        argument = sum((factor * angle for factor, angle in zip(m, angles, strict=True)), sp.Integer(0))
        self.explicit[symbol] = sp.sin(argument) if sine else sp.cos(argument)
        first = next(i for i, factor in enumerate(m) if factor)
        self.order[symbol] = (group, first, sum(map(bool, m)), int(sine))
        return symbol


def _plain(parts: Sequence[tuple[int, str]]) -> str:
    """A label for code: 12 for θ1 + θ2, 1m2 for θ1 - θ2, 2x1 for 2 θ1."""
    words = []
    for i, (factor, label) in enumerate(parts):
        sign = "m" if factor < 0 else ("_" if i and len(label) > 1 else "")
        words.append(sign + (f"{abs(factor)}x" if abs(factor) > 1 else "") + label)
    text = "".join(words)
    return text if (len(parts) == 1 and len(text) == 1) or text.isdigit() else f"_{text}".replace("__", "_")


def _typeset(parts: Sequence[tuple[int, str]]) -> str:
    """A label for LaTeX: 12, 1-2, 2\\cdot 1."""
    long = any(len(label) > 1 for _, label in parts)
    words = []
    for i, (factor, label) in enumerate(parts):
        sign = "-" if factor < 0 else ("+" if i and long else "")
        shown = rf"\mathrm{{{label}}}".replace("_", r"\_") if len(label) > 1 else label
        words.append(sign + (rf"{abs(factor)}\cdot " if abs(factor) > 1 else "") + shown)
    return "".join(words)
