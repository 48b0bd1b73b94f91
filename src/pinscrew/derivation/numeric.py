"""Closed forms as functions of arrays."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp
from sympy.printing.numpy import NumPyPrinter

from pinscrew.derivation.forms import ClosedForms
from pinscrew.ground.typing import FloatArray

__all__ = ["evaluate"]


def evaluate(
    derivation: ClosedForms,
    matrices: Sequence[Any],
    q: FloatArray,
    qd: FloatArray,
    lengths: Mapping[sp.Symbol, FloatArray],
) -> list[FloatArray]:
    """The values of matrices of a derivation at N configurations.

    Args:
        derivation: where they come from.
        matrices: sympy matrices in its symbols.
        q: its coordinates, shape (N, m), rad and m.
        qd: their rates, shape (N, m).
        lengths: the lengths, each of shape (N,).

    Returns:
        arrays (N, rows, columns).
    """
    known: dict[sp.Symbol, FloatArray] = dict(lengths)
    for i, variable in enumerate(derivation.coordinates):
        known[variable.symbol], known[variable.rate] = q[:, i], qd[:, i]
    for joint in derivation.chain.joints:
        if joint.master is not joint.variable:
            factor = _value(joint.multiplier, known, len(q))
            known[joint.variable.symbol] = factor * known[joint.master.symbol]
            known[joint.variable.rate] = factor * known[joint.master.rate]
    wanted = set().union(*(matrix.free_symbols for matrix in matrices))
    for symbol, meaning in list(derivation.atoms.explicit.items()):
        if symbol in wanted:
            known[symbol] = _value(meaning, known, len(q))
    symbols = [symbol for symbol in known if symbol in wanted]
    entries = [entry for matrix in matrices for entry in matrix]
    values = _function(symbols, entries)(*(known[symbol] for symbol in symbols))
    flat = np.stack([np.broadcast_to(np.asarray(value, dtype=float), len(q)) for value in values], axis=-1)
    found, start = [], 0
    for matrix in matrices:
        size = matrix.rows * matrix.cols
        found.append(flat[:, start : start + size].reshape(len(q), matrix.rows, matrix.cols))
        start += size
    return found


def _value(expression: sp.Expr, known: Mapping[sp.Symbol, FloatArray], count: int) -> FloatArray:
    symbols = sorted(expression.free_symbols, key=str)
    value = _function(symbols, expression)(*(known[symbol] for symbol in symbols))
    return np.broadcast_to(np.asarray(value, dtype=float), count)


def _function(symbols: Sequence[sp.Symbol], expressions: Any) -> Callable[..., Any]:
    """Expressions as a function of arrays.

    With ``"numpy"`` for its modules, `sympy.lambdify` would load all that numpy has, f2py among it, which takes 0.1 s;
    given its printer it imports what the expressions need.
    """
    settings = {"fully_qualified_modules": False, "inline": True, "allow_unknown_functions": True}
    function: Callable[..., Any] = sp.lambdify(symbols, expressions, modules=[], printer=NumPyPrinter(settings))
    return function
