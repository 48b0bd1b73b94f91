"""Names of matrices in formulas, as two books have them, and what an engine says of each.

It is read from the text alone: nothing here asks how it was written.
"""

from __future__ import annotations

import re
from typing import Final, TypeAlias

import numpy as np

from pinscrew.derivation.names import Names, NotUnderstoodError
from pinscrew.derivation.point_quantities import point_quantity
from pinscrew.derivation.step_quantities import step_quantity
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.mathtext.equations import Grid, Side
from pinscrew.mathtext.tokens import CLOSING

__all__ = ["side_value"]

Token: TypeAlias = str | Grid

_TOKEN: Final = re.compile(r"\\[A-Za-z]+|\\.|\d+|\S")
_SIZES: Final = {r"\left", r"\right", r"\,", r"\;", r"\ "}
_KINDS: Final[dict[str, str]] = {"s": "spatial", "b": "body", "h": "hybrid"}
_TURN: Final = re.compile(r"(?:\\hat\{\\omega\}_\{?(\d+)\}?|\[\\omega_\{?(\d+)\}?\])(.+)")
_POWER: Final = re.compile(r"(?:\\hat\{\\xi\}_\{?(\d+)\}?|\[\\mathcal\{S\}_\{?(\d+)\}?\])(.+)")


def side_value(names: Names, side: Side) -> tuple[FloatArray, list[FloatArray]]:
    """The value of a side of an equation, shape (N, rows, columns), and those of the factors of its terms.

    Raises:
        NotUnderstoodError: something in it is no such name.
    """
    tokens: list[Token] = []
    for piece in side:
        if isinstance(piece, Grid):
            tokens.append(piece)
        else:
            tokens += [token for token in _TOKEN.findall(piece) if token not in _SIZES]
    read = _Side(tokens, names)
    value = read.whole()
    return value, read.factors


class _Side:
    """Evaluates one side by descent."""

    def __init__(self, tokens: list[Token], names: Names) -> None:
        self._tokens, self._at, self._names = tokens, 0, names
        self.factors: list[FloatArray] = []
        self._inside: list[FloatArray] = []  # factors within fractions

    def whole(self) -> FloatArray:
        found = self._sum()
        if self._at < len(self._tokens):
            raise NotUnderstoodError
        return found

    def _ahead(self, by: int = 0) -> Token:
        return self._tokens[self._at + by] if self._at + by < len(self._tokens) else ""

    def _sum(self) -> FloatArray:
        total: FloatArray | None = None
        factors: list[FloatArray] = []
        while total is None or self._ahead() in ("+", "-"):
            sign = self._ahead() if self._ahead() in ("+", "-") else "+"
            self._at += self._ahead() in ("+", "-")
            term = self._product()
            term = -term if sign == "-" else term
            factors += self.factors
            total = term if total is None else total + term
        self.factors = factors
        return total

    def _product(self) -> FloatArray:
        self.factors = []
        found = self._factor()
        self._keep(found)
        while self._ahead() not in ("", "+", "-", ")", "]"):
            crossed = self._ahead() == r"\times"
            self._at += crossed
            factor = self._factor()
            self._keep(factor)
            if crossed and found.shape[1:] == factor.shape[1:] == (3, 1):
                found = np.cross(found, factor, axis=1)
            elif not crossed and (1, 1) in (found.shape[1:], factor.shape[1:]):
                found = found * factor
            elif crossed or found.shape[2] != factor.shape[1]:
                raise InputError("formula", f"sizes {found.shape[1:]} and {factor.shape[1:]} do not fit in a product")
            else:
                found = found @ factor
        return found

    def _keep(self, factor: FloatArray) -> None:
        self.factors += self._inside or [factor]
        self._inside = []

    def _group(self) -> list[Token]:
        """What is in braces, or the one token there."""
        opening = self._ahead()
        self._at += 1
        if opening == "":
            raise NotUnderstoodError
        if opening not in CLOSING:
            return [opening]
        depth, inside = 1, []
        while depth:
            token = self._ahead()
            if token == "":
                raise NotUnderstoodError
            self._at += 1
            depth += (token in CLOSING) - (token in CLOSING.values())
            inside.append(token)
        return inside[:-1]

    def _factor(self) -> FloatArray:
        ahead = self._ahead()
        if isinstance(ahead, Grid):
            self._at += 1
            found = self._names.grid(ahead)
            if found is None:
                raise NotUnderstoodError
            return found
        if ahead == "(":
            return _Side(self._group(), self._names).whole()
        if ahead == r"\|":
            return self._norm()
        if ahead == r"\frac" and self._ahead(2) != r"\partial":
            self._at += 1
            above, below = (_Side(self._group(), self._names) for _ in range(2))
            found = above.whole() / below.whole()
            self._inside += above.factors
            return np.asarray(found)
        base = self._base()
        scripts = {"_": "", "^": ""}
        while self._ahead() in ("_", "^", "'"):
            which = self._ahead()
            self._at += 1
            if which == "'":
                scripts["^"] = "'"
                continue
            inner = self._group()
            if base == r"\mathrm{Ad}" and which == "_":
                return self._adjoint(inner, scripts["^"])
            scripts[str(which)] += "".join(map(str, inner))
        leg = self._names.leg(base, scripts["_"], scripts["^"])
        return self._named(base, scripts["_"], scripts["^"]) if leg is None else leg

    def _norm(self) -> FloatArray:
        """‖ω‖ or ‖ω‖²."""
        end = self._tokens.index(r"\|", self._at + 1) if r"\|" in self._tokens[self._at + 1 :] else 0
        inside = _Side(self._tokens[self._at + 1 : end], self._names).whole()
        self._at = end + 1
        power = 1
        if self._ahead() == "^":
            self._at += 1
            power = int("".join(map(str, self._group())))
        return np.asarray(np.linalg.norm(inside, axis=(1, 2), keepdims=True) ** power)

    def _base(self) -> str:
        ahead = str(self._ahead())
        if ahead in (r"\hat", r"\dot", r"\mathrm", r"\mathcal", r"\frac"):
            self._at += 1
            text = ahead + "{" + "".join(map(str, self._group())) + "}"
            return text + "{" + " ".join(map(str, self._group())) + "}" if ahead == r"\frac" else text
        if ahead == "[":
            return "[" + "".join(map(str, self._group())) + "]"
        self._at += 1
        return ahead

    def _adjoint(self, inner: list[Token], power: str) -> FloatArray:
        pose = self._names.truth.pose if "".join(map(str, inner)) in "gT" else _Side(inner, self._names).whole()
        if self._ahead() == "^":
            self._at += 1
            power = "".join(map(str, self._group()))
        return self._names.adjoint(pose if power == "" else np.asarray(se3.inverse(pose)))

    def _argument(self) -> str:
        """What stands in parentheses after a name: 0 or θ."""
        return "".join(map(str, self._group())) if self._ahead() == "(" else ""

    def _named(self, base: str, sub: str, sup: str) -> FloatArray:
        truth, at = self._names.truth, self._at
        found = step_quantity(truth, base, sub, sup)
        if base in ("g", "T") and not sub:
            argument = self._argument()
            found = {("0", ""): truth.home, ("", "-1"): np.asarray(se3.inverse(truth.pose))}.get((argument, sup))
            found = truth.pose if (argument, sup) in ((r"\theta", ""), ("", "")) else found
        elif base == "M" and not sub + sup:
            found = truth.home
        elif base in (r"\dot{g}", r"\dot{T}") and not sub + sup:
            found = truth.rate
        elif base in ("J", "V", r"\mathcal{V}", r"\hat{V}") or base.startswith(r"[\mathcal{V}_"):
            found = self._velocity(base, sub, sup)
        elif base == "e":
            found = self._exponential(sub, sup)
        elif base in (r"\xi", r"\mathcal{S}") and sub.isdecimal():
            i = int(sub)
            columns = {"'": "spatial", r"\dagger": "body"}
            found = self._names.twist(truth.column(columns[sup], i) if sup in columns else truth.twist(i))
        elif base in ("q", "v") and self._names.point is not None and not sub.isdecimal():
            found = point_quantity(truth, self._names.point, base, sub, self._argument())
        elif base == "q" and sub.isdecimal():
            found = self._names.points.get(int(sub))
        elif base == r"\dot{\theta}" and not sub + sup:
            found = self._names.rates[:, :, None]
        elif partial := re.fullmatch(r"\\frac\{\\partial[gT]\}\{\\partial (.*)\}", base):
            found = truth.partial_rate(self._names.joint(partial[1].replace(" ", "")))
        elif not sup and found is None:
            found = self._names.scalar(f"{base}_{{{sub}}}" if sub else base)[:, None, None]
        if found is None:
            self._at = at
            raise NotUnderstoodError
        return found

    def _velocity(self, base: str, sub: str, sup: str) -> FloatArray | None:  # noqa: PLR0911 (one for each name)
        """Jacobians, with their columns, and velocities, with their matrices."""
        truth, twist = self._names.truth, self._names.twist
        if base.startswith("["):
            return self._hat(_KINDS.get(base.removeprefix(r"[\mathcal{V}_").strip("{}]"), ""))
        letter = sup + sub if base == "J" and sub.isdecimal() else sub + sup
        kind = _KINDS.get(letter[:1], "")
        if not kind:
            return None
        if base == "J" and letter[1:].isdecimal():
            return twist(truth.column(kind, int(letter[1:])))
        if len(letter) > 1:
            return None
        if base == "J" and self._argument() == "0":
            return twist(truth.jacobian_at_home()) if kind == "spatial" else None
        if base == r"\hat{V}":
            return self._hat(kind)
        return twist(truth.jacobian(kind) if base == "J" else truth.velocity(kind))

    def _hat(self, kind: str) -> FloatArray | None:
        return np.asarray(se3.hat(self._names.truth.velocity(kind)[:, :, 0])) if kind else None

    def _exponential(self, sub: str, sup: str) -> FloatArray | None:
        names = self._names
        turn = _TURN.fullmatch(sup)
        power = turn or _POWER.fullmatch(sup)
        if power and not sub:
            i = int(power[1] or power[2])
            right = names.joint(power[3]) == i
            found = names.truth.exponential(i) if right else None
            return found if found is None or not turn else found[:, :3, :3]
        if sub.isdecimal() and not sup:
            return np.broadcast_to(
                np.eye(names.rates.shape[1])[:, int(sub) - 1 : int(sub)], (len(names.rates), names.rates.shape[1], 1)
            )
        return None
