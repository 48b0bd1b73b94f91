"""The mistakes of the printed courseworks, found by `check` itself: where each is, and which slip explains it.

Each is graded as a student's answer would be: its matrix with the printed entry in the right ones' company.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Final

import numpy as np

from pinscrew.checking.grading import graded, graded_entry
from pinscrew.checking.meanings import Meanings
from pinscrew.checking.numbers import at_configuration, number
from pinscrew.checking.numeric import graded_at
from pinscrew.checking.quantities import quantity_key, right_form
from pinscrew.checking.run import checkable
from pinscrew.checking.scope import Scope
from pinscrew.checking.texts import Written
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.errata_entries import Erratum, errata
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.mathtext import Node, Operation, Symbol, evaluate, read_plain, symbols
from pinscrew.reporting.document import Account, Document, ResultTable, Sentence
from pinscrew.reporting.documented import Documented

__all__ = ["ErrataVerdicts", "PrintedMistake", "check_errata"]

_KEYS: Final = {
    "home": "M",
    "twist": "twists",
    "pose": "T",
    "position": "p",
    "inverse": "Tinv",
    "rate": "Tdot",
    "body hat": "Vbhat",
    "adjoint inverse": "Adinv",
    "corner of the adjoint inverse": "corner(Adinv)",
    "position hat": "phat",
    "axis": "z",
    "axis hat": "hat(z)",
    "axis point": "foot",
    "hybrid Jacobian": "Jh",
    "body Jacobian": "Jb",
    "spatial Jacobian": "Js",
    "hybrid velocity": "Vh",
    "body velocity": "Vb",
    "spatial velocity": "Vs",
}
"""The quantities of the list that `check` has; the others are entries for themselves."""
_OF_TAILS: Final = {
    "T": "tail{}",
    "phat": "hat(p(tail{}))",
    "corner(Adinv)": "corner(Ad(inv(tail{})))",
    "Adinv": "Ad(inv(tail{}))",
}


@dataclass(frozen=True, slots=True)
class PrintedMistake:
    """What `check` says to one printed entry.

    Attributes:
        erratum: the mistake, as the list has it.
        located: whether the entry comes out wrong, and no other.
        slip: which slip explains it, in words, or ``""``.
    """

    erratum: Erratum
    located: bool
    slip: str


@dataclass(frozen=True, slots=True)
class ErrataVerdictsData:
    """What `check` says to the printed mistakes."""

    found: tuple[PrintedMistake, ...]

    @property
    def located(self) -> int:
        """How many are located."""
        return sum(each.located for each in self.found)

    @property
    def explained(self) -> int:
        """How many are explained by one slip."""
        return sum(bool(each.slip) for each in self.found)


class ErrataVerdicts(Documented, ErrataVerdictsData):
    """What `check` says to the printed mistakes; ``print`` shows it."""

    __slots__ = ()

    def document(self) -> Document:
        """The report in no format yet."""
        rows = []
        for each in self.found:
            slip = each.slip or ("no single slip explains it" if each.located else "not located")
            rows.append((each.erratum.robot, each.erratum.where, each.erratum.printed, each.erratum.right, slip))
        counted = f"{len(self.found)} printed mistakes: {self.located} located, {self.explained} explained by one slip"
        table = ResultTable(("robot", "where", "printed", "right", "slip"), tuple(rows))
        account = Account("errata", counted, table=table, lines=(Sentence(counted),))
        return Document("pinscrew check", self.located == len(self.found), (account,), data=self.data())

    def data(self) -> dict[str, Any]:
        """The verdicts as JSON has them."""
        answers = [
            {
                "robot": each.erratum.robot,
                "where": each.erratum.where,
                "quantity": each.erratum.quantity,
                "entry": list(each.erratum.index),
                "given": each.erratum.printed,
                "expected": each.erratum.right,
                "located": each.located,
                "slip": each.slip or None,
            }
            for each in self.found
        ]
        counts = {"located": self.located, "explained": self.explained}
        return {"schema": "pinscrew.check-errata/1", **counts, "errata": answers}


def check_errata(robot: str | None = None) -> ErrataVerdicts:
    """What `check` says to each mistake that is printed of a robot of the catalogue, or of all.

    Raises:
        InputError: none are known.
    """
    found = errata(robot)
    if not found:
        known = ", ".join(dict.fromkeys(each.robot for each in errata()))
        remedy = f"there are errata for: {known}"
        raise InputError("no-errata", "no printed mistakes are known of this robot", where=str(robot), remedy=remedy)
    derivations = cache(checkable)
    return ErrataVerdicts(tuple(_checked(each, derivations) for each in found))


def _checked(erratum: Erratum, derivations: Any) -> PrintedMistake:
    what, dimension = erratum.quantity, ""
    for prefix in ("rows of ", "columns of "):
        if what.startswith(prefix):
            dimension = prefix.partition(" ")[0]
    if dimension:  # an answer of another shape is not compared, and the message has both numbers
        located = erratum.printed != erratum.right
        return PrintedMistake(erratum, located, f"{erratum.printed} {dimension} where {erratum.right} are due")
    derivation = derivations(erratum.robot, erratum.frame or None, erratum.reference or None)
    key = _key(erratum, derivation)
    free = _free(derivation, (erratum.printed, erratum.right))
    if erratum.at and key is not None:
        q = _configuration(derivation, erratum)
        if q is not None:
            return _at(erratum, derivation, key, q)
        key = None  # the right entry is as it is at some joint's value
    if key is None:
        words = graded_entry(derivation, read_plain(erratum.printed), read_plain(erratum.right), free)
        if words == "":
            words = _first_order(derivation, erratum, free) or ""
        return PrintedMistake(erratum, words is not None, words or "")
    right = right_form(derivation, key)
    cells = [[str(x) for x in row] for row in derivation.write(right).tolist()]
    i, j = erratum.index
    cells[i - 1][j - 1] = erratum.printed
    written = Written(tuple(map(tuple, cells)), "plain")
    verdict = graded(derivation, key, written, {}, free).verdict
    return PrintedMistake(erratum, verdict.entries == (erratum.index,), "; ".join(verdict.slips))


def _configuration(derivation: Derivation, erratum: Erratum) -> FloatArray | None:
    """The configuration at which the printed numbers are meant, where it is given in whole."""
    names = derivation.robot.coordinate_names
    if set(names) != set(erratum.at):
        return None
    return np.array([float(evaluate(read_plain(erratum.at[name]), {})) for name in names])


def _at(erratum: Erratum, derivation: Derivation, key: str, q: FloatArray) -> PrintedMistake:
    i, j = erratum.index
    right = right_form(derivation, key)
    at = at_configuration(derivation, q)
    cells = [[repr(number(element, at)) for element in row] for row in right]
    cells[i - 1][j - 1] = erratum.printed
    verdict = graded_at(derivation, key, Written(tuple(map(tuple, cells)), "plain"), {}, q)
    return PrintedMistake(erratum, verdict.entries == (erratum.index,), "; ".join(verdict.slips))


def _key(erratum: Erratum, derivation: Derivation) -> str | None:
    """The quantity of `check` that an entry of the list is of; None for one that stands for itself."""
    key, n = _KEYS.get(erratum.quantity), len(derivation.chain.joints)
    if key is None or (erratum.frame and key not in ("T", "M")):
        return None
    if key in ("z", "hat(z)"):
        key = key.replace("z", f"z{erratum.joint - 1}")
    elif key == "foot":
        key = f"foot{erratum.joint}"
    elif erratum.joint > 1:
        key = _OF_TAILS[key].format(erratum.joint) if key in _OF_TAILS else key
    key = quantity_key(key, n)
    rows, columns = right_form(derivation, key).shape
    return key if erratum.index[0] <= rows and erratum.index[1] <= columns else None


def _free(derivation: Derivation, texts: Iterable[str]) -> tuple[str, ...]:
    """Letters that the robot has not."""
    scope, meanings = Scope(derivation), Meanings(derivation)
    names = sorted({name for text in texts for name in symbols(read_plain(text))})
    return tuple(name for name in names if meanings.find(name, scope) is None)


def _first_order(derivation: Derivation, erratum: Erratum, free: tuple[str, ...]) -> str | None:
    """Whether the printed entry is the right one with cosines and sines of a small angle to first order."""
    right = read_plain(erratum.right)
    for name in free:
        linear = _linear(right, name)
        if linear != right and graded_entry(derivation, read_plain(erratum.printed), linear, free) is None:
            return f"it is the first-order approximation in {name}"
    return None


def _linear(node: Node, name: str) -> Node:
    """cos(a + δ) as cos a - δ sin a, sin(a + δ) as sin a + δ cos a."""
    if not isinstance(node, Operation):
        return node
    inner = node.operands[0]
    if node.operator in ("cos", "sin") and isinstance(inner, Operation) and Symbol(name) in inner.operands:
        rest = tuple(operand for operand in inner.operands if operand != Symbol(name))
        angle = rest[0] if len(rest) == 1 else replace(inner, operands=rest)
        turned: Node = Operation("sin" if node.operator == "cos" else "cos", (angle,))
        slope: Node = Operation("multiply", (Symbol(name), turned))
        slope = Operation("negate", (slope,)) if node.operator == "cos" else slope
        return Operation("add", (replace(node, operands=(angle,)), slope))
    return replace(node, operands=tuple(_linear(operand, name) for operand in node.operands))
