"""What was written, read back: every matrix of a report, from its text, against both engines.

The proof is of expressions; this is of the text. A reader that knows nothing of the writers parses it, each matrix is
evaluated at random values, and compared with the other sides of its equation and with what both engines say of the
name there: c12 is cos(θ1 + θ2) because the textbooks say so.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from pinscrew.derivation.asked import NOTHING, ReportQuestion
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.named_quantities import side_value
from pinscrew.derivation.names import Names, NotUnderstoodError
from pinscrew.derivation.truth import Drawn, Truth, draw
from pinscrew.ground.errors import InputError, PinscrewError
from pinscrew.ground.typing import FloatArray
from pinscrew.mathtext import evaluate, read_latex, symbols
from pinscrew.mathtext.equations import Equation, Grid, read_equations
from pinscrew.mathtext.pages import formulas

__all__ = ["ReadBack", "ReadBackError", "read_back"]

EXACT: Final = 1e-9
SHOWN: Final = 1e-4
"""What values may differ by, relative to the size of the robot; the second where numbers are shown to 6 digits."""


class ReadBackError(PinscrewError):
    """A text that was written does not say what was proved: a mistake in pinscrew."""


@dataclass(frozen=True, slots=True)
class ReadBack:
    """What was read.

    Attributes:
        matrices: how many matrices agree with both engines.
        alone: how many could be read, but stand under no name that is known here, and agree with one another only.
        general: how many are general forms, such as (R p; 0 1), or columns of names.
        largest: the largest difference, metres divided by the size of the robot.
    """

    matrices: int
    alone: int
    general: int
    largest: float


def read_back(
    derivation: ClosedForms, text: str, form: str, seed: int = 0, asked: ReportQuestion = NOTHING
) -> ReadBack:
    """Read a report's text and compare every matrix in it with both engines.

    Args:
        derivation: what the report is of.
        text: the report.
        form: its format, as for `reports.write`.
        seed: of the random values.
        asked: what else the report is about.

    Raises:
        ReadBackError: a matrix cannot be read, or is not what the engines say.
    """
    drawn = draw(derivation, seed)
    reader = _Reader(derivation, drawn, asked)
    equations: list[Equation] = []
    try:
        for formula in formulas(text, form):
            found = read_equations(formula)
            if found[0][0] == () and equations:  # it goes on from the one before
                equations[-1] = (*equations[-1], *found[0][1:])
                found = found[1:]
            equations += found
    except InputError as error:
        raise _failed(f"a formula cannot be read: {error.what}", error.where) from None
    for number, equation in enumerate(equations):
        reader.equation(equation, equations[number + 1 :])
    return ReadBack(reader.matrices, reader.alone, reader.general, reader.largest)


def _failed(what: str, where: str) -> ReadBackError:
    where = " ".join(where.split())
    return ReadBackError("read-back", what, where=where if len(where) < 200 else f"{where[:200]} …")


_GENERAL: Final = re.compile(r"\\hat|\\omega|\\xi|\\mathcal|(?<![A-Za-z\\])[RIpqvJThzo](?![A-Za-z])")
"""Names of matrices and vectors in a general form such as (R p; 0 1)."""
_SHORT: Final = re.compile(r"([cs])_(.+)")


class _Reader:
    """Evaluates the equations of one report."""

    def __init__(self, derivation: ClosedForms, drawn: Drawn, asked: ReportQuestion = NOTHING) -> None:
        self._d, self._drawn, self._asked = derivation, drawn, asked
        self._known = _scalars(derivation, drawn)
        values = _values(derivation, drawn)
        self._labels = {v.label: values[v.joint] for v in derivation.variables if v.joint in values}
        self._points: dict[int, FloatArray] = {}
        self._defined: dict[str, str] = {}
        self._cells: dict[str, FloatArray] = {}
        self.matrices, self.alone, self.general, self.largest = 0, 0, 0, 0.0
        self._tolerance = EXACT if derivation.exact else SHOWN
        self._size = max(1.0, drawn.robot.reach)

    @cached_property
    def _names(self) -> tuple[Names, ...]:
        from pinscrew.engines.pinocchio import Pinocchio
        from pinscrew.engines.poe import PoE

        truths = (Truth(engine, self._d, self._drawn) for engine in (PoE, Pinocchio))
        first = self._d.convention == "lynch-park"
        joints = tuple(str(symbol).replace("_", "") for symbol in self._d.joint_values)
        of_all = (first, joints, self._drawn.qd, self.grid, self.scalar, self._points)
        return tuple(Names(truth, *of_all, self._asked.numbers, self._asked.frames) for truth in truths)

    def equation(self, equation: Equation, following: Sequence[Equation]) -> None:
        """Read one equation; the ``following`` ones may say what names in its matrices stand for."""
        grids = [piece for side in equation for piece in side if isinstance(piece, Grid)]
        if not grids:
            self._plain(equation)
            return
        for later in following:
            if any(isinstance(piece, Grid) for side in later for piece in side):
                break
            if len(later) == 2 and len(later[0]) == len(later[1]) == 1:
                self._define(str(later[0][0]), str(later[1][0]))
        where = " = ".join(" ".join(p if isinstance(p, str) else _latex(p) for p in side) for side in equation)
        try:
            self._compare(equation, where)
        except InputError as error:
            raise _failed(f"an entry of a matrix cannot be read: {error.what}, {error.where}", where) from None

    def _compare(self, equation: Equation, where: str) -> None:
        if point := re.fullmatch(r"q_\{?(\d+)\}?", str(equation[0][0]) if equation[0] else ""):
            self._point(int(point[1]), equation, where)
            return
        named = False
        for names in self._names:
            values = []
            for side in equation:
                try:
                    values.append(side_value(names, side))
                    named = named or not any(isinstance(piece, Grid) for piece in side)
                except NotUnderstoodError:
                    continue
            for other, _ in values[1:]:
                self._same(values[0][0], other, where)
            # Factor by factor too: an entry that a zero multiplies would not be seen in the product.
            products = [factors for _, factors in values if len(factors) > 1]
            for a, b in pairwise(products):
                if [x.shape for x in a] == [x.shape for x in b]:
                    for x, y in zip(a, b, strict=True):
                        self._same(x, y, where)
        grids = [piece for side in equation for piece in side if isinstance(piece, Grid)]
        count = sum(self.grid(grid) is not None for grid in grids)
        self.general += len(grids) - count
        if named:
            self.matrices += count
        else:
            self.alone += count

    def _point(self, i: int, equation: Equation, where: str) -> None:
        """A point of an axis, which is any: -ω × q is v."""
        for names in self._names:
            q, xi = side_value(names, equation[1])[0], names.truth.twist(i)
            self._same(np.cross(q, xi[:, 3:], axis=1), xi[:, :3], where)
            self._points[i] = q
        self.matrices += 1

    def _same(self, a: FloatArray, b: FloatArray, where: str) -> None:
        if a.shape[1:] != b.shape[1:]:
            raise _failed(f"two sides have shapes {a.shape[1:]} and {b.shape[1:]}", where)
        difference = float(np.max(abs(a - b), initial=0.0)) / self._size
        if not difference <= self._tolerance:
            raise _failed(f"two sides differ by {difference:.1e}", where)
        self.largest = max(self.largest, difference)

    def _plain(self, equation: Equation) -> None:
        """Equations of scalars: what a short form, or the value of a joint that follows, stands for."""
        texts = [side[0] if len(side) == 1 else "" for side in equation]
        if len(texts) < 2 or not all(isinstance(text, str) and text for text in texts) or "0" in texts:
            return
        head = str(texts[0])
        if re.match(r"[cs]_|\\(dot\{\\)?theta", head) and not re.fullmatch(r"[\d.\\pi{}frac/-]*", str(texts[-1])):
            try:
                values = [self.scalar(str(text))[:, None, None] for text in texts]
            except NotUnderstoodError:
                return
            for value in values[1:]:
                self._same(values[0], value, " = ".join(map(str, texts)))

    def _define(self, name: str, meaning: str) -> None:
        """Note what a name of an entry or sum stands for; what has a value already, as in a condition, is none."""
        if name not in self._defined:
            try:
                self._cell(name)
            except InputError:
                pass
            else:
                return
        self._defined[name] = meaning
        self._cells.pop(name, None)

    def grid(self, grid: Grid) -> FloatArray | None:
        """The values (N, rows, columns) of a matrix of entries, or None of a general form."""
        try:
            rows = [[self._cell(cell) for cell in row] for row in grid.cells]
        except InputError:
            if any(_GENERAL.search(cell) for row in grid.cells for cell in row):
                return None
            raise
        return np.moveaxis(np.array(rows), -1, 0)

    def scalar(self, text: str) -> FloatArray:
        """The values (N,) of a symbol or formula."""
        try:
            return self._cell(text)
        except InputError:
            raise NotUnderstoodError from None

    def _cell(self, text: str) -> FloatArray:
        found = self._cells.get(text)
        if found is None:
            if text in self._defined:
                found = self._cell(self._defined[text])
            else:
                node = read_latex(text)
                values = {name: self._symbol(name) for name in symbols(node)}
                found = np.broadcast_to(evaluate(node, values), len(self._drawn.q))
            self._cells[text] = found
        return found

    def _symbol(self, name: str) -> FloatArray:
        found = self._known.get(name.replace("_", ""))
        if found is not None:
            return found
        letter, _, index = name.partition("_")
        meaning = self._defined.get(f"{letter}_{{{index}}}")
        if meaning is not None:
            return self._cell(meaning)
        short = _SHORT.fullmatch(name)
        if short:
            angle = self._angle(short[2])
            return np.asarray(np.cos(angle) if short[1] == "c" else np.sin(angle))
        raise InputError("formula", f"{name!r} is no symbol of the derivation")

    def _angle(self, index: str) -> FloatArray:
        """θ1 + θ2 of 12, θ1 - θ2 of 1-2, 2 θ1 of 2*1, and the sum of named joints with a sign between them."""
        total = np.zeros(len(self._drawn.q))
        for sign, factor, label in re.findall(r"([+-]?)(?:(\d+)\*)?(\d|[^\W\d]\w*)", index):
            if label not in self._labels:
                raise InputError("formula", f"{label!r} is no joint")
            total = total + (-1.0 if sign == "-" else 1.0) * float(factor or 1) * self._labels[label]
        return total


def _latex(grid: Grid) -> str:
    return r"\begin{bmatrix} " + r" \\ ".join(" & ".join(row) for row in grid.cells) + r" \end{bmatrix}"


def _values(d: ClosedForms, drawn: Drawn) -> dict[str, FloatArray]:
    """The value (N,) of each joint, without its offset, by the joint's name in the file."""
    found = {variable.joint: drawn.q[:, i] for i, variable in enumerate(d.coordinates)}
    found |= {joint.variable.joint: drawn.values[:, i] for i, joint in enumerate(d.chain.joints)}
    return found | {name: values for name, (values, _) in drawn.others.items()}


def _scalars(d: ClosedForms, drawn: Drawn) -> dict[str, FloatArray]:
    """The values (N,) of lengths, joints and rates by their names, without underscores.

    Raises:
        ReadBackError: two have one name.
    """
    count = len(drawn.q)
    values = _values(d, drawn)
    rates = {variable.joint: drawn.qd[:, i] for i, variable in enumerate(d.coordinates)}
    rates |= {joint.variable.joint: drawn.rates[:, i] for i, joint in enumerate(d.chain.joints)}
    rates |= {name: rate for name, (_, rate) in drawn.others.items()}
    found: dict[str, FloatArray] = {}
    pairs = [(str(symbol), np.full(count, value)) for symbol, value in drawn.lengths.items()]
    for variable in d.variables:
        if variable.joint in values:
            pairs.append((str(variable.symbol), values[variable.joint]))
            pairs.append((f"dot {variable.symbol}", rates[variable.joint]))
    for name, value in pairs:
        plain = name.replace("_", "")
        if plain in found:
            raise _failed("two symbols are printed alike", name)
        found[plain] = value
    return found
