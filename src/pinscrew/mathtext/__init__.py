"""Formulas read from the text in which they stand, by a reader that knows nothing of who wrote them.

No robot and no computer algebra is known here: a text becomes a tree, and a tree becomes numbers.
"""

from pinscrew.mathtext.latex import read_latex, read_latex_matrix
from pinscrew.mathtext.plain import read_plain
from pinscrew.mathtext.tree import Node, Number, Operation, Symbol, evaluate, symbols

__all__ = [
    "Node",
    "Number",
    "Operation",
    "Symbol",
    "evaluate",
    "read_latex",
    "read_latex_matrix",
    "read_plain",
    "symbols",
]
