"""A wrong step carried through rightly: what an answer would be if an earlier one of the same file were right."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import reduce
from typing import Any, Final, TypeAlias

import numpy as np
import sympy as sp

from pinscrew.checking.quantities import atoms_of, right_form
from pinscrew.checking.scope import Scope
from pinscrew.derivation.chain import Elements, cross
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.normal_forms import adjoint, inverse

__all__ = ["follows_from"]

_Way: TypeAlias = tuple[tuple[str, ...], Callable[..., Elements]]
_VELOCITIES: Final = {"Vs": ("Js", "Vshat"), "Vb": ("Jb", "Vbhat"), "Vh": ("Jh", "")}


def follows_from(
    derivation: Derivation, scope: Scope, key: str, given: Elements, earlier: Mapping[str, Elements]
) -> tuple[str, ...]:
    """Which earlier wrong answers an answer follows from by the right formula; none if it does not.

    Args:
        derivation: the closed forms.
        scope: the algebra of all values.
        key: the quantity.
        given: the answer.
        earlier: wrong answers that stand before it, by quantity.
    """
    adopt = np.frompyfunc(scope.adopt, 1, 1)
    for needs, formula in _ways(derivation, scope, key):
        used = tuple(need for need in needs if need in earlier)
        if not used:
            continue
        parts = [earlier[need] if need in earlier else adopt(right_form(derivation, need)) for need in needs]
        if not (formula(*parts) - given).any():
            return used
    return ()


def _ways(derivation: Derivation, scope: Scope, key: str) -> Iterator[_Way]:
    """Formulas for a quantity, each with what it needs."""
    numbered = re.fullmatch(r"(exp|prod|tail|xi)(\d+)", key)
    if numbered:
        yield from _of_joint(derivation, scope, numbered[1], int(numbered[2]))
    elif key in ("T", "Tdot", "Vbhat", "Vshat"):
        yield from _of_pose(derivation, scope, key)
    elif key in ("Js", "Jb", "Jh", *_VELOCITIES):
        yield from _of_jacobian(derivation, scope, key)
    else:
        atoms = atoms_of(key)
        yield atoms, lambda *given: right_form(derivation, key, dict(zip(atoms, given, strict=True)))


def _of_joint(derivation: Derivation, scope: Scope, what: str, i: int) -> Iterator[_Way]:
    exponentials = tuple(f"exp{j}" for j in range(1, len(derivation.chain.joints) + 1))
    joint = derivation.chain.joints[i - 1]
    if what == "prod":
        yield exponentials[:i], _product
    elif what == "tail":
        yield (*exponentials[i - 1 :], "M"), _product
    elif joint.revolute and what == "xi":
        yield (f"omega{i}", f"q{i}"), lambda w, q: np.concatenate([-cross(w[:, 0], q[:, 0]), w[:, 0]])[:, None]
    elif joint.revolute:
        cosine, sine = scope.turn({joint.variable.symbol: Fraction(1)})
        yield (f"xi{i}",), lambda xi: _exponential(xi[:, 0], cosine, sine, scope)


def _of_pose(derivation: Derivation, scope: Scope, key: str) -> Iterator[_Way]:
    n = len(derivation.chain.joints)
    if key == "T":
        yield (*(f"exp{j}" for j in range(1, n + 1)), "M"), _product
        yield (f"prod{n}", "M"), _product
    elif key == "Tdot":
        yield ("T",), lambda T: _rate(derivation, scope, T)
    else:
        yield ("Tinv", "Tdot") if key == "Vbhat" else ("Tdot", "Tinv"), _product


def _of_jacobian(derivation: Derivation, scope: Scope, key: str) -> Iterator[_Way]:
    n = len(derivation.chain.joints)
    if key == "Js":
        needs = (*(f"xi{j}" for j in range(1, n + 1)), *(f"exp{j}" for j in range(1, n)))
        yield needs, lambda *given: _carried(given[:n], given[n:])
    elif key == "Jb":
        yield ("Js", "T"), lambda J, T: adjoint(inverse(T)) @ J
    elif key == "Jh":
        yield ("Jb", "R"), lambda J, R: np.concatenate([R @ J[:3], R @ J[3:]])
    else:
        J, hatted = _VELOCITIES[key]
        rates = np.array([[scope.symbol(joint.variable.rate)] for joint in derivation.chain.joints], dtype=object)
        yield (J,), lambda J: J @ rates
        if hatted:
            yield (hatted,), _vee


def _product(*factors: Elements) -> Elements:
    found: Elements = reduce(lambda a, b: a @ b, factors)
    return found


def _rate(derivation: Derivation, scope: Scope, pose: Elements) -> Elements:
    """Σ ∂g/∂θi θ̇i; the angles of the algebra are halves."""
    half = scope.algebra.constant(sp.Rational(1, 2))
    total: Elements = pose * scope.algebra.constant(0)
    for joint in derivation.chain.joints:
        symbol = joint.variable.symbol
        slope: Any = np.frompyfunc(lambda e, s=symbol: e.derivative(s), 1, 1)(pose)
        factor = half if joint.revolute else scope.one
        total = total + slope * (factor * scope.symbol(joint.variable.rate))
    return total


def _vee(hatted: Elements) -> Elements:
    v, w = hatted[:3, 3], [hatted[2, 1], hatted[0, 2], hatted[1, 0]]
    return np.array([*v, *w], dtype=object)[:, None]


def _carried(twists: tuple[Elements, ...], exponentials: tuple[Elements, ...]) -> Elements:
    """Columns Ad(e₁ … e_{i-1}) ξi; MLS eq. 3.54."""
    columns = [twists[0]]
    for i, twist in enumerate(twists[1:], 1):
        columns.append(adjoint(_product(*exponentials[:i])) @ twist)
    return np.concatenate(columns, axis=1)


def _exponential(xi: Elements, cosine: Any, sine: Any, scope: Scope) -> Elements:
    """e^{ξ̂θ} of a twist with ‖ω‖ = 1; MLS eq. 2.36: p = (I - R)(ω × v) + ω ωᵀ v θ, of which the last is 0 here."""
    v, w = xi[:3], xi[3:]
    zero, one = scope.algebra.constant(0), scope.one
    hatted = np.array([[zero, -w[2], w[1]], [w[2], zero, -w[0]], [-w[1], w[0], zero]], dtype=object)
    identity = np.array([[one if i == j else zero for j in range(3)] for i in range(3)], dtype=object)
    R = identity + hatted * sine + (hatted @ hatted) * (one - cosine)
    g = np.array([[one if i == j else zero for j in range(4)] for i in range(4)], dtype=object)
    g[:3, :3], g[:3, 3] = R, (identity - R) @ cross(w, v)
    return g
