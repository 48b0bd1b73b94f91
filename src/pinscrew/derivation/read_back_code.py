"""Functions that were written, read back: their text against both engines, in languages of which none need be there."""

from __future__ import annotations

from typing import Final

import numpy as np

from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.read_back import ReadBack, ReadBackError
from pinscrew.derivation.truth import Drawn, Truth, draw
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray, KindLike
from pinscrew.mathtext import evaluate, symbols
from pinscrew.mathtext.programs import Program, read_programs

__all__ = ["read_back_code"]

TOLERANCE: Final = 1e-11
"""Metres divided by the size of the robot; numbers in code have all their digits."""
_FIRST: Final = {"python": 0, "c": 0, "matlab": 1, "julia": 1}
"""What the languages count from."""


def read_back_code(derivation: ClosedForms, text: str, language: str, kind: KindLike, seed: int = 0) -> ReadBack:
    """Read the functions ``fk`` and ``jacobian`` of a source text and compare them with both engines.

    Args:
        derivation: what they are of.
        text: from `code.code`.
        language: of the text.
        kind: of the Jacobian.
        seed: of the random values.

    Raises:
        ReadBackError: they cannot be read, or are not what the engines say.
    """
    from pinscrew.engines.pinocchio import Pinocchio
    from pinscrew.engines.poe import PoE

    drawn = draw(derivation, seed)
    try:
        programs = {program.name: program for program in read_programs(text, language)}
        found = {name: _values(programs[name], drawn, language) for name in ("fk", "jacobian")}
    except (InputError, KeyError) as error:
        raise ReadBackError("read-back", f"a function in {language} cannot be read: {error}") from None
    largest = 0.0
    for engine in (PoE, Pinocchio):
        truth = Truth(engine, derivation, drawn)
        J = truth.jacobian(kind)
        J = np.concatenate([J[:, 3:], J[:, :3]], axis=1) if derivation.convention == "lynch-park" else J
        for name, right in (("fk", truth.pose), ("jacobian", J)):
            if found[name].size != right.size:
                raise ReadBackError("read-back", f"{name} in {language} has {found[name].shape[1:]} entries")
            off = float(abs(found[name].reshape(right.shape) - right).max(initial=0.0)) / max(1.0, drawn.robot.reach)
            if not off <= TOLERANCE:
                raise ReadBackError("read-back", f"{name} in {language} is off by {off:.1e} from {truth.name}")
            largest = max(largest, off)
    return ReadBack(2, 0, 0, largest)


def _values(program: Program, drawn: Drawn, language: str) -> FloatArray:
    """The result, shape (N, rows, columns)."""
    count, first = len(drawn.q), _FIRST[language]
    known: dict[str, FloatArray] = {str(s): np.full(count, value) for s, value in drawn.lengths.items()}
    for array, values in (("q", drawn.q.T), ("lengths", np.array(list(drawn.lengths.values())))):
        for i, value in enumerate(values, first):
            for brackets in ("[]", "()"):
                known[f"{array}{brackets[0]}{i}{brackets[1]}"] = np.broadcast_to(value, count)
    for name, formula in program.steps:
        known[name] = evaluate(formula, {s: known[s] for s in symbols(formula)})
    rows = [
        [np.broadcast_to(evaluate(x, {s: known[s] for s in symbols(x)}), count) for x in row] for row in program.cells
    ]
    return np.moveaxis(np.array(rows), -1, 0)
