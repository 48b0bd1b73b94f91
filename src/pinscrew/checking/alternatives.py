"""What a quantity would be after one slip in the way to it: an order, a joint, the home pose, an approximation."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial, reduce
from typing import TypeAlias

import numpy as np

from pinscrew.checking.quantities import right_form
from pinscrew.checking.scope import Scope
from pinscrew.derivation.chain import Elements, Moving
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.normal_forms import hat, inverse

__all__ = ["alternatives"]

_Alternative: TypeAlias = tuple[str, Callable[[], Elements]]


def alternatives(derivation: Derivation, key: str, scope: Scope) -> Iterator[_Alternative]:
    """What a quantity would be after a slip, each with the slip in words, the likelier first.

    Args:
        derivation: the closed forms.
        key: the quantity.
        scope: in whose algebra an angle can stand without its sine and cosine.
    """
    if re.fullmatch(r"M|T|(?:exp|prod|tail)\d+", key):
        yield "it is inverted", partial(right_form, derivation, f"inv({key})")
    if key in ("T", "R", "p", "phat", "Tinv", "Tdot", "Ad", "Adinv"):
        for words, pose in _poses(derivation):
            yield words, partial(_instead, derivation, key, pose)
        if key != "Tdot":
            for words, pose in _slides(derivation, scope):
                yield words, partial(_instead, derivation, key, pose)
    numbered = re.fullmatch(r"(xi|exp)(\d+)", key)
    if numbered:
        joint = derivation.chain.joints[int(numbered[2]) - 1]
        yield from _twists(derivation, joint) if numbered[1] == "xi" else _exponentials(derivation, joint, scope)
    if key in ("Js", "Jb", "Jh", "twists") and len(derivation.chain.joints) > 1:
        yield from _columns(derivation, key)


def _instead(derivation: Derivation, key: str, pose: Callable[[], Elements]) -> Elements:
    """The quantity with another pose in the place of the right one."""
    return right_form(derivation, key, {"T": pose()})


def _poses(derivation: Derivation) -> Iterator[_Alternative]:
    factors, home = list(derivation.normal.exponentials), derivation.chain.home
    if not factors:
        return
    yield "the home pose is left out", partial(_product, factors)
    yield "the home pose stands before the exponentials", partial(_product, [home, *factors])
    if len(factors) > 1:
        yield "the exponentials stand in the opposite order", partial(_product, [*reversed(factors), home])
    for i in range(len(factors)):
        before, after = factors[:i], [*factors[i + 1 :], home]
        yield f"joint {i + 1} counts the other way", partial(_product, [*before, inverse(factors[i]), *after])
        yield f"the exponential of joint {i + 1} is left out", partial(_product, [*before, *after])
    for i in range(len(factors) - 1):
        swapped = [*factors[:i], factors[i + 1], factors[i], *factors[i + 2 :], home]
        yield f"the exponentials of joints {i + 1} and {i + 2} are exchanged", partial(_product, swapped)


def _product(factors: Sequence[Elements]) -> Elements:
    found: Elements = reduce(lambda a, b: a @ b, factors)
    return found


def _slides(derivation: Derivation, scope: Scope) -> Iterator[_Alternative]:
    """The exponential of (ω, 0) in the place of that of (v, ω): its angle stands without sine and cosine."""
    adopt = np.frompyfunc(scope.adopt, 1, 1)
    factors = [adopt(factor) for factor in (*derivation.normal.exponentials, derivation.chain.home)]
    for i, joint in enumerate(derivation.chain.joints):
        if joint.revolute:
            slide = _slide(derivation, joint, scope)
            yield f"joint {i + 1} is taken to slide", partial(_product, [*factors[:i], slide, *factors[i + 1 :]])


def _slide(derivation: Derivation, joint: Moving, scope: Scope) -> Elements:
    adopt = np.frompyfunc(scope.adopt, 1, 1)
    slide: Elements = np.array(adopt(_identity(derivation)), dtype=object)
    slide[:3, 3] = adopt(joint.axis) * scope.symbol(joint.variable.symbol)
    return slide


def _identity(derivation: Derivation) -> Elements:
    algebra = derivation.chain.algebra
    return np.array([algebra.constant(int(i == j)) for i in range(4) for j in range(4)], dtype=object).reshape(4, 4)


def _twists(derivation: Derivation, joint: Moving) -> Iterator[_Alternative]:
    zero = np.array([derivation.chain.algebra.constant(0)] * 3, dtype=object)
    if joint.revolute:
        yield "the joint is taken to slide: it turns", partial(_column, [joint.axis, zero])
        yield "v is left out: the axis would go through the origin", partial(_column, [zero, joint.axis])
        yield "v is the point q, not -ω × q", partial(_column, [joint.point, joint.axis])
    else:
        yield "the joint is taken to turn: it slides", partial(_column, [-_cross(joint), joint.axis])


def _cross(joint: Moving) -> Elements:
    a, b = joint.axis, joint.point
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object)


def _column(parts: Sequence[Elements]) -> Elements:
    return np.concatenate(parts).reshape(-1, 1)


def _exponentials(derivation: Derivation, joint: Moving, scope: Scope) -> Iterator[_Alternative]:
    if not joint.revolute:
        return
    algebra = derivation.chain.algebra
    right = right_form(derivation, f"exp{derivation.chain.joints.index(joint) + 1}")
    turned = right.copy()
    turned[:3, 3] = algebra.constant(0)
    yield "its position is left out: the axis would go through the origin", lambda: turned
    # e^{ξ̂θ} = I + ξ̂θ + …, MLS eq. 2.14: to first order the cosine is 1 and the sine the angle.
    adopt = np.frompyfunc(scope.adopt, 1, 1)
    slope = adopt(hat(algebra, joint.twist)) * scope.symbol(joint.variable.symbol)
    yield "the joint is taken to slide: it turns", partial(_slide, derivation, joint, scope)
    yield "it is the first-order approximation I + ξ̂θ", partial(np.add, adopt(_identity(derivation)), slope)
    point = right.copy()
    point[:3, 3] = joint.point
    yield "its position is q, not (I - R) q", lambda: point


def _columns(derivation: Derivation, key: str) -> Iterator[_Alternative]:
    J = right_form(derivation, key)
    yield "the columns stand in the opposite order", lambda: J[:, ::-1]
    for j, joint in enumerate(derivation.chain.joints):
        changed = J.copy()
        changed[:, j] = np.concatenate([J[3:, j], J[:3, j]])
        if joint.revolute:
            changed[3:, j] = derivation.chain.algebra.constant(0)
        does = "turns" if joint.revolute else "slides"
        words = f"column {j + 1}: joint {j + 1} {does}, and is taken to {'slide' if joint.revolute else 'turn'}"
        yield words, partial(np.copy, changed)
