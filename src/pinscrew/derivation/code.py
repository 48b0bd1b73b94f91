"""Closed forms as functions in Python, C, MATLAB and Julia, common subexpressions taken out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import sympy as sp

from pinscrew.derivation.forms import ClosedForms
from pinscrew.ground import escaping_code
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import KindLike, jacobian_kind
from pinscrew.ground.version import __version__

__all__ = ["LANGUAGES", "code"]


def code(derivation: ClosedForms, language: str, kind: KindLike = "body") -> str:
    """Functions ``fk`` and ``jacobian`` of a derivation as source text.

    Both take the coordinates q, in the order of `ClosedForms.coordinates`, and the lengths, in that of
    `ClosedForms.lengths`; the values in the file are its defaults. ``fk`` gives the pose (4×4), ``jacobian`` the
    Jacobian (6×n) with rows in the order of the derivation's convention.

    Args:
        derivation: the closed forms.
        language: ``"python"``, ``"c"``, ``"matlab"`` or ``"julia"``.
        kind: of the Jacobian.

    Raises:
        InputError: if there is no such language or kind.
    """
    if language not in LANGUAGES:
        known = ", ".join(LANGUAGES)
        raise InputError("derive-option", f"code in {language!r}", remedy=f"use one of {known}")
    d, kind = derivation, jacobian_kind(kind)
    jacobian = d.jacobian(kind)
    if d.convention == "lynch-park":
        jacobian = sp.ImmutableMatrix.vstack(jacobian[3:, :], jacobian[:3, :])
    functions = (_function(d, "fk", d.pose), _function(d, "jacobian", jacobian))
    return LANGUAGES[language](_Source(_header(d, kind), functions, d.lengths, len(d.coordinates)))


@dataclass(frozen=True, slots=True)
class _Function:
    """A function's steps, and its result, in the order of the rows."""

    name: str
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...]
    matrix: sp.Matrix


@dataclass(frozen=True, slots=True)
class _Source:
    header: tuple[str, ...]
    functions: tuple[_Function, ...]
    lengths: Mapping[sp.Symbol, sp.Expr]
    count: int


def _header(d: ClosedForms, kind: str) -> tuple[str, ...]:
    rows = "vx, vy, vz, wx, wy, wz" if d.convention == "mls" else "wx, wy, wz, vx, vy, vz"
    sliding = {joint.master.symbol for joint in d.chain.joints if not joint.revolute}
    turning = {joint.master.symbol for joint in d.chain.joints if joint.revolute}
    units = ["rad" if v.symbol in turning or v.symbol not in sliding else "m" for v in d.coordinates]
    q = ", ".join(f"{v.joint} ({unit})" for v, unit in zip(d.coordinates, units, strict=True)) or "none"
    lengths = ", ".join(f"{s} = {float(value):.9g}" for s, value in d.lengths.items()) or "none"
    return (
        f"Kinematics of {d.robot.name}: frame {d.tip} in frame {d.reference}.",
        f"Closed forms by pinscrew {__version__}; lengths in m, angles in rad.",
        f"q, in this order: {q}",
        f"lengths, in this order: {lengths}",
        "fk: pose T, 4 by 4: p_base = T p_tip",
        f"jacobian: {kind} Jacobian, 6 by {len(d.coordinates)}; rows {rows}; columns as q",
    )


def _function(d: ClosedForms, name: str, matrix: sp.Matrix) -> _Function:
    """The steps: values of joints that follow, sines and cosines, common subexpressions."""
    steps: list[tuple[sp.Symbol, sp.Expr]] = []
    q = {v.symbol: sp.Symbol(f"q[{i}]") for i, v in enumerate(d.coordinates)}
    atoms = [(s, meaning) for s, meaning in d.atoms.explicit.items() if s in matrix.free_symbols]
    used = matrix.free_symbols.union(*(meaning.free_symbols for _, meaning in atoms))
    steps += [(s, q[s]) for s in q if s in used or any(s in d.follows[f].free_symbols for f in d.follows if f in used)]
    steps += [(s, value) for s, value in d.follows.items() if s in used]
    steps += atoms
    common, (reduced,) = sp.cse([sp.Matrix(matrix)], symbols=sp.numbered_symbols("x"), order="none")
    return _Function(name, (*steps, *common), reduced)


def _numbers(expression: sp.Expr) -> sp.Expr:
    """The expression with doubles for all numbers but whole ones."""
    inexact = {n: sp.Float(n, 17) for n in expression.atoms(sp.Rational) if not n.is_Integer and n not in _HALVES}
    return expression.xreplace(inexact)


_HALVES: Final = (sp.Rational(1, 2), sp.Rational(-1, 2))


def _python(source: _Source) -> str:
    from sympy.printing.pycode import PythonCodePrinter

    show = PythonCodePrinter({"fully_qualified_modules": True}).doprint
    header = [escaping_code.python_docstring(line) for line in source.header]
    lines = ['"""' + header[0], "", *header[1:], '"""', "", "import math", ""]
    names = "".join(f", {s}={float(v)!r}" for s, v in source.lengths.items())
    for function in source.functions:
        lines += ["", f"def {function.name}(q{names}):"]
        lines += [f"    {s} = {show(_numbers(e))}" for s, e in function.steps]
        lines.append("    return [")
        lines += [
            "        [" + ", ".join(show(_numbers(x)) for x in function.matrix.row(i)) + "],"
            for i in range(function.matrix.rows)
        ]
        lines += ["    ]", ""]
    return "\n".join(lines)


def _c(source: _Source) -> str:
    from sympy.printing.c import C99CodePrinter

    show: Callable[[Any], str] = C99CodePrinter().doprint
    lines = [
        "/*",
        *(f" * {escaping_code.c_comment(line)}" for line in source.header),
        " * Matrices are stored row by row.",
        " */",
        "",
    ]
    lines += ["#include <math.h>", "", "#ifndef M_PI", "#define M_PI 3.14159265358979323846", "#endif", ""]
    values = ", ".join(repr(float(v)) for v in source.lengths.values())
    if source.lengths:
        lines += [f"const double default_lengths[{len(source.lengths)}] = {{{values}}};", ""]
    for function in source.functions:
        size = function.matrix.rows * function.matrix.cols
        lines.append(f"void {function.name}(const double *q, const double *lengths, double out[{max(size, 1)}])")
        lines.append("{")
        lines += ["    (void)q;", "    (void)lengths;"]
        free = function.matrix.free_symbols.union(*(e.free_symbols for _, e in function.steps))
        lines += [f"    const double {s} = lengths[{i}];" for i, s in enumerate(source.lengths) if s in free]
        lines += [f"    const double {s} = {show(_numbers(e))};" for s, e in function.steps]
        lines += [f"    out[{i}] = {show(_numbers(x))};" for i, x in enumerate(function.matrix)]
        lines += ["}", ""]
    return "\n".join(lines)


def _matlab(source: _Source) -> str:
    from sympy.printing.octave import OctaveCodePrinter

    show: Callable[[Any], str] = OctaveCodePrinter().doprint
    return _indexed(source, "%", show, ("function out = {name}(q, lengths)", "end"), ("out = [", "];"))


def _julia(source: _Source) -> str:
    from sympy.printing.julia import JuliaCodePrinter

    show: Callable[[Any], str] = JuliaCodePrinter().doprint
    return _indexed(source, "#", show, ("function {name}(q, lengths=default_lengths)", "end"), ("return [", "]"))


def _indexed(
    source: _Source, comment: str, show: Callable[[Any], str], frame: Sequence[str], brackets: Sequence[str]
) -> str:
    """A language that counts from 1 and writes matrices in brackets, rows between semicolons."""
    matlab = comment == "%"
    values = ", ".join(repr(float(v)) for v in source.lengths.values())
    escaped = escaping_code.matlab_comment if matlab else escaping_code.julia_comment
    lines = [f"{comment} {escaped(line)}" for line in source.header]
    lines += [""] if matlab else ["", f"const default_lengths = Float64[{values}]", ""]
    for function in source.functions:
        lines.append(frame[0].format(name=function.name))
        if matlab:
            lines += ["    if nargin < 2", f"        lengths = [{values}];", "    end"]
        bracket = "({})" if matlab else "[{}]"
        lines += [f"    {s} = lengths{bracket.format(i)};" for i, s in enumerate(source.lengths, 1)]
        for s, e in function.steps:
            text = f"q{bracket.format(int(str(e)[2:-1]) + 1)}" if str(e).startswith("q[") else show(_numbers(e))
            lines.append(f"    {s} = {text};")
        rows = ("        " + "  ".join(_spaceless(show(_numbers(x))) for x in r) for r in function.matrix.tolist())
        lines += [f"    {brackets[0]}", ";\n".join(rows), f"    {brackets[1]}", frame[1], ""]
    return "\n".join(lines)


def _spaceless(text: str) -> str:
    """An entry of a matrix in brackets, where a space would begin the next one."""
    return text.replace(" ", "")


LANGUAGES: Final[dict[str, Callable[[_Source], str]]] = {
    "python": _python,
    "c": _c,
    "matlab": _matlab,
    "julia": _julia,
}
"""What writes each language."""
