"""Mistakes of the printed courseworks: where, what is printed and what is right, and what both engines say.

The data are in ``errata.json`` beside the robots: one entry of one quantity each, as expressions in the lengths and
in c1, s12, theta1, dtheta1, …
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Section, Table, Writeup
from pinscrew.derivation.errata_entries import SLIPS, Erratum, errata
from pinscrew.derivation.errata_truth import truth
from pinscrew.description import catalogue
from pinscrew.engines.pair import pair_of
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.mathtext import evaluate, read_plain, symbols
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot

__all__ = ["Erratum", "Verdict", "errata", "report", "verdicts"]

SAMPLES: Final = 20
TOLERANCE: Final = 1e-12
WRONG: Final = 1e-6
"""A printed expression counts as refuted if it is off by more than this somewhere."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What an engine says to an erratum: how far the printed and the right expression are from it."""

    erratum: Erratum
    engine: str
    printed_error: float
    right_error: float

    @property
    def ok(self) -> bool:
        """Whether the printed expression is refuted and the right one holds."""
        return self.printed_error > WRONG and self.right_error <= TOLERANCE


def verdicts(erratum: Erratum, robot: Robot | None = None, seed: int = 0) -> tuple[Verdict, Verdict]:
    """What both engines say to an erratum at random configurations and rates.

    Args:
        erratum: the erratum.
        robot: its robot, perhaps with other lengths; by default as the catalogue has it.
        seed: of the random numbers.
    """
    if erratum.check or robot is None:
        robot = load(erratum.check or erratum.robot)
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (SAMPLES, robot.nq))
    for name, value in erratum.at.items():
        q[:, robot.coordinate_names.index(name)] = float(evaluate(read_plain(value), {}))
    qd = rng.uniform(0.5, 1.5, (SAMPLES, robot.nv))
    delta = rng.uniform(0.1, 0.5, SAMPLES)
    printed, right = (_evaluate(text, robot, q, qd, delta) for text in (erratum.printed, erratum.right))
    found = []
    for engine in pair_of(robot):
        i, j = erratum.index
        said = truth(engine, erratum, q, qd, delta)[:, i - 1, j - 1]
        errors = (float(abs(mine - said).max()) for mine in (printed, right))
        found.append(Verdict(erratum, engine.name, *errors))
    return found[0], found[1]


_SHORT: Final = re.compile(r"([cs])(\d+)")


def _evaluate(text: str, robot: Robot, q: FloatArray, qd: FloatArray, delta: FloatArray) -> FloatArray:
    """The value of an expression, c12 being cos(θ1 + θ2), and letters that the robot has not any number."""
    formula = read_plain(text)
    path = catalogue.find(robot.name).file
    known: dict[str, Any] = {"delta": delta}
    known |= {k: float(v) for k, v in {**catalogue.declared_arguments(path), **robot.description.arguments}.items()}
    for i in range(robot.nq):
        known |= {f"theta{i + 1}": q[:, i], f"dtheta{i + 1}": qd[:, i], f"ddtheta{i + 1}": qd[:, i] ** 2 + 1.0}
    for name in symbols(formula) - set(known):
        short = _SHORT.fullmatch(name)
        if short:
            angle = q[:, [int(digit) - 1 for digit in short[2]]].sum(axis=1)
            known[name] = np.cos(angle) if short[1] == "c" else np.sin(angle)
        else:
            known[name] = 0.1234 * sum(map(ord, name))
    return np.broadcast_to(evaluate(formula, known), len(q))


def report(robot: Robot) -> Writeup:
    """The errata of a robot's coursework, each with what both engines say.

    Raises:
        InputError: if there are none.
    """
    found = errata(robot.name)
    if not found:
        known = ", ".join(dict.fromkeys(e.robot for e in errata()))
        remedy = f"there are errata for: {known}"
        raise InputError("no-errata", "no printed mistakes are known of this robot", where=robot.name, remedy=remedy)
    found = tuple(sorted(found, key=lambda erratum: erratum.scan))
    summary = f"Of {len(found)} entries both engines refute what is printed, and confirm what is right."
    if any(erratum.scan for erratum in found):
        first = next(number for number, erratum in enumerate(found, 1) if erratum.scan)
        summary += f" From number {first} on they may be the scan's, and not the author's."
    sections, ok = [Section("", "errata", "What is listed", (Paragraph(summary),))], True
    for number, erratum in enumerate(found, 1):
        said = verdicts(erratum, robot)
        ok = ok and all(verdict.ok for verdict in said)
        sections.append(Section("", f"erratum-{number}", f"{number}. {erratum.where}", tuple(_blocks(erratum, said))))
    code = f"import pinscrew as ps\n\nrobot = ps.load({robot.name!r})"
    return Writeup(f"Errata of the coursework on {robot.name}", tuple(sections), code, ok)


def _blocks(erratum: Erratum, said: Iterable[Verdict]) -> Iterator[Block]:
    where = "".join(f", {name} at ${_latex(value)}$" for name, value in erratum.at.items())
    yield Paragraph(f"Kind of slip: {SLIPS[erratum.slip]}{where}.")
    yield Formula((r"\text{printed}", _latex(erratum.printed)))
    yield Formula((r"\text{right}", _latex(erratum.right)))
    if erratum.note:
        yield Paragraph(f"{erratum.note[0].upper()}{erratum.note[1:]}.")
    rows = tuple((v.engine, f"{v.printed_error:.1e}", f"{v.right_error:.1e}") for v in said)
    yield Table(("engine", "printed is off by", "right is off by"), rows)


def _latex(text: str) -> str:
    expression = sp.sympify(text, evaluate=False)
    names = {}
    for symbol in expression.free_symbols:
        dotted = re.fullmatch(r"(d{1,2})theta(\d+)", str(symbol))
        if dotted:
            accent = r"\dot" if len(dotted[1]) == 1 else r"\ddot"
            names[symbol] = rf"{accent}{{\theta}}_{{{dotted[2]}}}"
    return str(sp.latex(expression, symbol_names=names, order="none"))
