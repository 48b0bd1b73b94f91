"""Arguments of a xacro file as symbols: exact coefficients from a few evaluations of the file.

Where lengths enter, a position is affine in them, so one evaluation at the given arguments and one with each
argument moved give its coefficients, and one more, with all of them moved at once, must agree with what they
predict. The multiplier of a mimic joint is a number times powers of arguments, found and proved by the same
evaluations. An argument that changes a rotation, an axis or the structure, or enters otherwise, stays a number.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Final, TypeAlias

import sympy as sp

from pinscrew.derivation.exact import bounded, length
from pinscrew.derivation.reading import Printed, printed
from pinscrew.description import catalogue, expand
from pinscrew.ground.errors import PinscrewError
from pinscrew.robot.robot import Robot

__all__ = ["Arguments", "Loader", "recover"]

Loader: TypeAlias = Callable[[Mapping[str, str]], Robot]
"""Loads the robot's file with other arguments."""
Sample: TypeAlias = tuple[dict[str, Fraction], dict[str, Printed]]
"""Values of the arguments, and the joints printed with them."""

MOST_ARGUMENTS: Final = 32
"""Numbers among a file's arguments that are examined: each takes an evaluation of the file."""

_POWERS: Final = (1, -1, 2, -2)
_NEAR: Final = 1e-12


@dataclass
class Arguments:
    """What became of a file's arguments.

    Attributes:
        symbols: of those that are symbols, by name.
        values: their values as given.
        numeric: why each of the others stays a number.
        scalars: expressions of the scalars that depend on arguments, by joint and name (see `Printed.scalars`).
        evaluations: how many times the file was evaluated.
    """

    symbols: dict[str, sp.Symbol] = field(default_factory=dict)
    values: dict[str, Fraction] = field(default_factory=dict)
    numeric: dict[str, str] = field(default_factory=dict)
    scalars: dict[tuple[str, str], sp.Expr] = field(default_factory=dict)
    evaluations: int = 0


def recover(robot: Robot, frames: Sequence[str], joints: Mapping[str, Printed], load: Loader) -> Arguments:
    """The arguments of a robot's xacro file as symbols, as far as that is exact.

    Args:
        robot: the robot with the arguments as given.
        frames: those whose joints matter.
        joints: from `reading.printed`.
        load: loads the file with other values of some arguments.
    """
    found = Arguments()
    path = Path(robot.description.file)
    if not expand.is_xacro(path):
        return found
    texts = {**catalogue.declared_arguments(path), **robot.description.arguments}
    base: dict[str, Fraction] = {}
    for name, text in texts.items():
        if len(base) == MOST_ARGUMENTS:
            found.numeric[name] = f"only the first {MOST_ARGUMENTS} numbers among the arguments are examined"
            continue
        try:
            base[name] = Fraction(bounded(text))
        except (ValueError, ZeroDivisionError):
            found.numeric[name] = f"its value {text!r} is no number"
    if not base:
        return found
    sampler = _Sampler(frames, load, base, joints, found)
    together = {name: _moved(value, i + 1) for i, (name, value) in enumerate(base.items())}
    *singly, proof = sampler.all([*({name: _moved(value, 0)} for name, value in base.items()), together])
    alone = dict(zip(base, singly, strict=True))
    symbols: list[str] = []
    for name, sample in alone.items():
        if isinstance(sample, str):
            found.numeric[name] = sample
        elif any(sample[1][j].scalars != joints[j].scalars for j in joints):
            symbols.append(name)
        else:
            found.numeric[name] = "it does not enter the kinematics of this frame"
    samples = {name: sample for name, sample in alone.items() if not isinstance(sample, str)}
    kept = _proved(symbols, samples, sampler, proof if len(symbols) == len(base) else None)
    for name in symbols:
        if name not in kept:
            found.numeric[name] = "positions are not affine in it, nor multipliers a power of it"
    found.symbols = {name: sp.Symbol(name, positive=True) for name in kept}
    found.values = {name: base[name] for name in kept}
    found.scalars = _expressions(kept, samples, sampler.start) or {}
    return found


def _moved(value: Fraction, which: int) -> Fraction:
    """Another value near one: exact in binary, and different for each argument."""
    if value.denominator == 1:
        return value + 1 + which
    return value + Fraction(2 * which + 1, 8)


class _Sampler:
    """Evaluates the file."""

    def __init__(
        self,
        frames: Sequence[str],
        load: Loader,
        base: dict[str, Fraction],
        joints: Mapping[str, Printed],
        found: Arguments,
    ) -> None:
        self._frames = frames
        self._load = load
        self._base = base
        self._found = found
        self.start: Sample = (base, dict(joints))

    def all(self, changes: Sequence[Mapping[str, Fraction]]) -> list[Sample | str]:
        """The file with each of these changes, or why one is of no use; several at once."""
        if not changes:
            return []
        with ThreadPoolExecutor(max_workers=4) as pool:
            self._found.evaluations += len(changes)
            return list(pool.map(self._one, changes))

    def _one(self, change: Mapping[str, Fraction]) -> Sample | str:
        try:
            robot = self._load({name: _text(value) for name, value in change.items()})
            joints = printed(robot, self._frames)
        except PinscrewError:
            return "the file can't be used at other values of it"
        fixed = self.start[1]
        if list(joints) != list(fixed) or any(_structure(joints[j]) != _structure(fixed[j]) for j in fixed):
            return "it changes which joints there are"
        if any(joints[j].rpy != fixed[j].rpy or joints[j].axis != fixed[j].axis for j in fixed):
            return "it enters a rotation or an axis"
        return {**self._base, **change}, joints


def _text(value: Fraction) -> str:
    return str(value.numerator) if value.denominator == 1 else repr(float(value))


def _structure(joint: Printed) -> tuple[str, str | None]:
    return joint.type, None if joint.mimic is None else joint.mimic[0]


def _proved(
    symbols: list[str], samples: Mapping[str, Sample], sampler: _Sampler, proof: Sample | str | None
) -> list[str]:
    """The largest list of arguments that one more evaluation with all of them moved agrees with.

    ``proof`` is that of all arguments where it is there already.
    """
    kept: list[str] = []
    trials = [symbols, *([name] for name in symbols)] if len(symbols) > 1 else [symbols]
    for trial in trials:
        wanted = [*kept, *(name for name in trial if name not in kept)]
        if not wanted or wanted == kept:
            continue
        if proof is None:
            (proof,) = sampler.all([{name: _moved(sampler.start[0][name], i + 1) for i, name in enumerate(wanted)}])
        expressions = _expressions(wanted, samples, sampler.start)
        if not isinstance(proof, str) and expressions is not None and _agrees(expressions, proof, sampler.start):
            kept = wanted
            if trial is symbols:
                break
        proof = None
    return kept


def _agrees(expressions: Mapping[tuple[str, str], sp.Expr], proof: Sample, start: Sample) -> bool:
    values = {sp.Symbol(name, positive=True): sp.Rational(v.numerator, v.denominator) for name, v in proof[0].items()}
    for name, joint in proof[1].items():
        for scalar, text in joint.scalars.items():
            expected = expressions.get((name, scalar), start[1][name].scalars[scalar])
            if abs(float(sp.sympify(expected).subs(values)) - float(text)) > _NEAR * max(1.0, abs(float(text))):
                return False
    return True


def _expressions(
    symbols: Sequence[str], samples: Mapping[str, Sample], start: Sample
) -> dict[tuple[str, str], sp.Expr] | None:
    """The scalars that change with the arguments ``symbols``, as expressions in them; None where one is neither."""
    found = {}
    for name, joint in start[1].items():
        for scalar, text in joint.scalars.items():
            moved = {s: samples[s][1][name].scalars[scalar] for s in symbols}
            changing = {s: other for s, other in moved.items() if other != text}
            if not changing:
                continue
            steps = {s: (start[0][s], samples[s][0][s], other) for s, other in changing.items()}
            expression = _monomial(text, steps) if scalar == "multiplier" else _affine(text, steps)
            if expression is None:
                return None
            found[name, scalar] = expression
    return found


Steps: TypeAlias = Mapping[str, tuple[Fraction, Fraction, str]]
"""For each argument: its value, its moved value, and what the scalar then is."""


def _affine(text: str, steps: Steps) -> sp.Expr:
    """constant + Σ coefficient × argument."""
    value, found = length(text), sp.Integer(0)
    for name, (before, after, other) in steps.items():
        step = sp.Rational((after - before).numerator, (after - before).denominator)
        slope = _simple((float(other) - float(text)) / float(step))
        found += slope * sp.Symbol(name, positive=True)
        value -= slope * sp.Rational(before.numerator, before.denominator)
    constant = _simple(float(value)) if value.has(sp.Float) else value
    return (sp.Integer(0) if abs(float(constant)) < _NEAR else constant) + found


def _monomial(text: str, steps: Steps) -> sp.Expr | None:
    """number × Π argument^power."""
    found, rest = sp.Integer(1), float(text)
    for name, (before, after, other) in steps.items():
        for power in _POWERS:
            if abs(float(other) / float(text) - float(after / before) ** power) <= _NEAR if before and rest else False:
                found *= sp.Symbol(name, positive=True) ** power
                rest /= float(before) ** power
                break
        else:
            return None
    return _simple(rest) * found


def _simple(value: float) -> sp.Expr:
    """The exact number nearby."""
    fraction = Fraction(value).limit_denominator(10**6)
    if abs(float(fraction) - value) <= _NEAR * max(1.0, abs(value)):
        return sp.Rational(fraction.numerator, fraction.denominator)
    return length(repr(value))
