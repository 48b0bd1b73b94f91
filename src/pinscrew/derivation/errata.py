"""Mistakes of the printed courseworks: where, what is printed and what is right, and what both engines say.

The data are in ``errata.json`` beside the robots: one entry of one quantity each, as expressions in the lengths and
in c1, s12, theta1, dtheta1, …
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Final

import numpy as np
import sympy as sp

from pinscrew.derivation.blocks import Block, Formula, Paragraph, Report, Section, Table
from pinscrew.description import catalogue
from pinscrew.engines.pair import pair_of
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3, so3
from pinscrew.robot.loading import load
from pinscrew.robot.robot import Robot

__all__ = ["Erratum", "Verdict", "errata", "report", "verdicts"]

SAMPLES: Final = 20
TOLERANCE: Final = 1e-12
WRONG: Final = 1e-6
"""A printed expression counts as refuted if it is off by more than this somewhere."""


@dataclass(frozen=True, slots=True)
class Erratum:
    """One mistake.

    Attributes:
        arm: the arm's number among the assignments.
        robot: its name in the catalogue.
        part: of the coursework.
        where: where it is printed.
        quantity: what it is an entry of.
        index: row and column, from 1.
        printed: the expression as printed.
        right: the right expression.
        note: more in words, or ``""``.
        reference: the frame in which the quantity is, or ``""`` for the base.
        check: the robot to check it on where that is another, or ``""``.
        at: values of coordinates at which it holds, as expressions.
    """

    arm: str
    robot: str
    part: str
    where: str
    quantity: str
    index: tuple[int, int]
    printed: str
    right: str
    note: str = ""
    reference: str = ""
    check: str = ""
    at: Mapping[str, str] = field(default_factory=dict)


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


@cache
def errata(robot: str | None = None) -> tuple[Erratum, ...]:
    """The mistakes in what is printed about a robot of the catalogue, or all."""
    text = (catalogue.robots_directory() / "errata.json").read_text(encoding="utf-8")
    rows = (Erratum(**{**row, "index": tuple(row["index"])}) for row in json.loads(text)["errata"])
    return tuple(row for row in rows if robot in (None, row.robot))


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
        q[:, robot.coordinate_names.index(name)] = float(sp.sympify(value))
    qd = rng.uniform(0.5, 1.5, (SAMPLES, robot.nv))
    delta = rng.uniform(0.1, 0.5, SAMPLES)
    printed, right = (_evaluate(text, robot, q, qd, delta) for text in (erratum.printed, erratum.right))
    found = []
    for engine in pair_of(robot):
        i, j = erratum.index
        truth = _quantity(engine, erratum, q, qd, delta)[:, i - 1, j - 1]
        errors = (float(abs(mine - truth).max()) for mine in (printed, right))
        found.append(Verdict(erratum, engine.name, *errors))
    return found[0], found[1]


_SHORT: Final = re.compile(r"\b([cs])(\d+)\b")


def _expression(text: str) -> sp.Expr:
    """An expression of ours, with cos(θ1 + θ2) for c12 and so on."""
    long = _SHORT.sub(lambda m: f"{'cos' if m[1] == 'c' else 'sin'}({'+'.join(f'theta{i}' for i in m[2])})", text)
    return sp.sympify(long)


def _evaluate(text: str, robot: Robot, q: FloatArray, qd: FloatArray, delta: FloatArray) -> FloatArray:
    known: dict[str, Any] = {"delta": delta}
    for i in range(robot.nq):
        known |= {f"theta{i + 1}": q[:, i], f"dtheta{i + 1}": qd[:, i], f"ddtheta{i + 1}": qd[:, i] ** 2 + 1.0}
    path = catalogue.find(robot.name).file
    known |= {k: float(v) for k, v in {**catalogue.declared_arguments(path), **robot.description.arguments}.items()}
    expression = _expression(text)
    symbols = sorted(expression.free_symbols, key=str)
    function: Callable[..., Any] = sp.lambdify(symbols, expression, "numpy")
    value = np.asarray(function(*(known[str(symbol)] for symbol in symbols)), dtype=float)
    return np.broadcast_to(value, len(q))


def _quantity(engine: Any, erratum: Erratum, q: FloatArray, qd: FloatArray, delta: FloatArray) -> FloatArray:
    """A quantity by an engine, shape (N, rows, columns)."""
    what = erratum.quantity
    pose, zero = engine.fk(q), np.zeros_like(q)

    def twist() -> Any:
        J = engine.jacobian(zero, None, "spatial")
        return se3.adjoint(se3.inverse(engine.fk(zero, erratum.reference or robot.base))) @ J

    def pitch() -> Any:  # how far the tool advances along the screw for each radian that it turns
        moved = se3.log(se3.inverse(engine.fk(zero)) @ engine.fk(zero + 0.3))
        return (moved[:, 2] / moved[:, 5])[:, None, None]

    robot = engine.robot
    simple: dict[str, Callable[[], Any]] = {
        "home": lambda: engine.fk(zero),
        "twist": twist,
        "step": lambda: engine.fk(np.concatenate([q[:, :1] + delta[:, None], q[:, 1:]], axis=1)),
        "pitch": pitch,
        "pose": lambda: pose,
        "inverse": lambda: se3.inverse(pose),
        "rate": lambda: se3.hat(engine.velocity(q, qd, None, "spatial")) @ pose,
        "body hat": lambda: se3.hat(engine.velocity(q, qd, None, "body")),
        "adjoint inverse": lambda: se3.adjoint(se3.inverse(pose)),
        "position hat": lambda: so3.hat(pose[:, :3, 3]),
    }
    if what in simple:
        return np.asarray(simple[what]())
    kind, _, name = what.partition(" ")
    if name == "Jacobian":
        return np.asarray(engine.jacobian(q, None, kind))
    return np.asarray(engine.velocity(q, qd, None, kind))[:, :, None]


def report(robot: Robot) -> Report:
    """The errata of a robot's coursework, each with what both engines say.

    Raises:
        InputError: if there are none.
    """
    found = errata(robot.name)
    if not found:
        known = ", ".join(dict.fromkeys(e.robot for e in errata()))
        remedy = f"there are errata for: {known}"
        raise InputError("no-errata", "no printed mistakes are known of this robot", where=robot.name, remedy=remedy)
    sections, ok = [], True
    for number, erratum in enumerate(found, 1):
        said = verdicts(erratum, robot)
        ok = ok and all(verdict.ok for verdict in said)
        blocks: list[Block] = [
            Formula((r"\text{printed}", _latex(erratum.printed))),
            Formula((r"\text{right}", _latex(erratum.right))),
        ]
        if erratum.note:
            blocks.append(Paragraph(f"{erratum.note[0].upper()}{erratum.note[1:]}."))
        rows = tuple((v.engine, f"{v.printed_error:.1e}", f"{v.right_error:.1e}") for v in said)
        blocks.append(Table(("engine", "printed is off by", "right is off by"), rows))
        sections.append(Section("", f"erratum-{number}", f"{number}. {erratum.where}", tuple(blocks)))
    code = f"import pinscrew as ps\n\nrobot = ps.load({robot.name!r})"
    return Report(f"Errata of the coursework on {robot.name}", tuple(sections), code, ok)


def _latex(text: str) -> str:
    expression = sp.sympify(text, evaluate=False)
    names = {}
    for symbol in expression.free_symbols:
        dotted = re.fullmatch(r"(d{1,2})theta(\d+)", str(symbol))
        if dotted:
            accent = r"\dot" if len(dotted[1]) == 1 else r"\ddot"
            names[symbol] = rf"{accent}{{\theta}}_{{{dotted[2]}}}"
    return str(sp.latex(expression, symbol_names=names, order="none"))
