"""What may be asked for, by name, and its right form as the derivation has it.

A name is one of `QUANTITIES`, or a function of one: ``Ad(tail2)``, ``R(prod2)``, ``hat(xi1)``, ``det(v(Jh))``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import partial
from typing import Final, TypeAlias

import numpy as np

from pinscrew.derivation.chain import Elements, cross
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.normal_forms import adjoint, derivative, hat, inverse
from pinscrew.derivation.trig import Element
from pinscrew.ground.errors import InputError
from pinscrew.ground.words import brief

__all__ = ["FUNCTIONS", "QUANTITIES", "atoms_of", "is_quantity", "quantity_key", "right_form"]

QUANTITIES: Final = {
    "M": "the home pose",
    "omega1": "the direction of the axis of joint 1 at zero",
    "q1": "a point of the axis of joint 1 at zero: any is right",
    "foot1": "its point nearest to the origin",
    "xi1": "the twist of joint 1, and so on",
    "twists": "all twists, a column each",
    "exp1": "the exponential of joint 1, and so on",
    "prod2": "the product of the exponentials of joints 1 to 2",
    "tail2": "the product of those from joint 2 on, and of the home pose",
    "T": "the pose",
    "R": "its rotation",
    "p": "its position",
    "phat": "the matrix of the position",
    "Tinv": "its inverse",
    "Tdot": "its rate",
    "pdot": "the velocity of the tool's origin in the axes of the base",
    "Ad": "the adjoint of the pose",
    "Adinv": "the adjoint of its inverse",
    "Js": "the spatial Jacobian",
    "Jb": "the body Jacobian",
    "Jh": "the hybrid Jacobian, which books on Denavit-Hartenberg call geometric",
    "Js1": "a column of a Jacobian",
    "z0": "the direction of the axis of joint 1 at any configuration, as the geometric method counts",
    "Vs": "the spatial velocity",
    "Vb": "the body velocity",
    "Vh": "the hybrid velocity",
    "Vshat": "the matrix of the spatial velocity",
    "Vbhat": "the matrix of the body velocity",
}
"""The names, and what they stand for."""

FUNCTIONS: Final = {
    "inv": "the inverse of a pose",
    "R": "the rotation of a pose, or its upper left block",
    "p": "the position of a pose, or its last column",
    "dot": "the rate of a pose",
    "Ad": "the adjoint of a pose",
    "corner": "the upper right 3×3 block of an adjoint",
    "hat": "the matrix of three or of six numbers",
    "v": "the upper three rows of a twist or a Jacobian",
    "w": "the lower three",
    "det": "the determinant of a square matrix",
}
"""What can be asked of a quantity."""

_SAME: Final = {
    "home": "M",
    "g0": "M",
    "g(0)": "M",
    "pose": "T",
    "g": "T",
    "inverse": "Tinv",
    "rate": "Tdot",
    "spatial": "Js",
    "body": "Jb",
    "hybrid": "Jh",
    "geometric": "Jh",
    "position": "p",
    "rotation": "R",
}
_SHORT: Final = {
    "R": "R(T)",
    "p": "p(T)",
    "phat": "hat(p(T))",
    "Tinv": "inv(T)",
    "Tdot": "dot(T)",
    "pdot": "v(Vh)",
    "Ad": "Ad(T)",
    "Adinv": "Ad(inv(T))",
    "Vshat": "hat(Vs)",
    "Vbhat": "hat(Vb)",
}
_NUMBERED: Final = re.compile(r"(xi|exp|prod|tail|omega|foot|q|J[sbh])(\d+)|(z)(\d+)")
_CALL: Final = re.compile(r"(\w+)\((.+)\)")
LONGEST_NAME: Final = 60

_Form: TypeAlias = Callable[[], Elements]


def quantity_key(name: str, joints: int) -> str:
    """The name of a quantity as this module writes it.

    Raises:
        InputError: there is no such quantity of an arm with so many joints.
    """
    plain = re.sub(r"[\s_^{}\\]", "", name[:LONGEST_NAME])
    plain = _SAME.get(plain, plain)
    if _known(_SHORT.get(plain, plain), joints):
        return next((short for short, whole in _SHORT.items() if whole == plain), plain)
    listed = f"{', '.join(QUANTITIES)}, and functions of them: {', '.join(FUNCTIONS)}"
    what = f"there is no quantity {brief(name, 80)!r} of an arm with {joints} moving joints"
    raise InputError("check-quantity", what, remedy=f"the quantities are: {listed}")


def is_quantity(name: str, joints: int) -> bool:
    """Whether a name is one that this module itself writes for a quantity of an arm with so many joints."""
    return len(name) <= LONGEST_NAME and _known(name, joints)


def _known(plain: str, joints: int) -> bool:
    call = _CALL.fullmatch(plain)
    if call:
        return call[1] in FUNCTIONS and _known(_SAME.get(call[2], _SHORT.get(call[2], call[2])), joints)
    numbered = _NUMBERED.fullmatch(plain)
    if numbered:
        first = 0 if numbered[3] else 1
        return first <= int(numbered[2] or numbered[4]) < first + joints
    return plain in QUANTITIES or plain in _SHORT


def right_form(derivation: Derivation, key: str, instead: Mapping[str, Elements] | None = None) -> Elements:
    """The right form of a quantity, as a matrix.

    Args:
        derivation: the closed forms.
        key: the quantity; see `quantity_key`.
        instead: other matrices in the place of some quantities that functions are asked of.

    Raises:
        InputError: a function is asked of what has none: the inverse of a Jacobian, say.
    """
    key = _SHORT.get(_SAME.get(key, key), _SAME.get(key, key))
    call = _CALL.fullmatch(key)
    if not call:
        return instead[key] if instead and key in instead else _form(derivation, key)()
    inner = right_form(derivation, call[2], instead)
    try:
        return _FUNCTIONS[call[1]](derivation, inner)
    except _NoFunctionError as error:
        remedy = f"{call[1]}: {FUNCTIONS[call[1]]}"
        raise InputError("check-quantity", f"there is no {key}: {error}", remedy=remedy) from None


def atoms_of(key: str) -> tuple[str, ...]:
    """The quantity that functions are asked of in a key: T in ``Ad(inv(T))``, or the key itself."""
    key = _SHORT.get(key, key)
    while call := _CALL.fullmatch(key):
        key = call[2]
    return (key,)


class _NoFunctionError(Exception):
    """A matrix has not the size that a function needs; the message says which."""


def _form(derivation: Derivation, key: str) -> _Form:
    normal, chain = derivation.normal, derivation.chain
    whole: dict[str, _Form] = {
        "M": lambda: chain.home,
        "twists": lambda: np.stack([joint.twist for joint in chain.joints], axis=1),
        "T": lambda: normal.pose,
        "Js": lambda: normal.spatial,
        "Jb": lambda: normal.body,
        "Jh": lambda: normal.hybrid,
        "Vs": lambda: normal.spatial_velocity.reshape(6, 1),
        "Vb": lambda: normal.body_velocity.reshape(6, 1),
        "Vh": lambda: normal.hybrid_velocity.reshape(6, 1),
    }
    if key in whole:
        return whole[key]
    name, number = re.fullmatch(r"(\D+)(\d+)", key).groups()  # type: ignore[union-attr]
    i = int(number) - (name != "z")
    joint = chain.joints[i]
    numbered: dict[str, _Form] = {
        "xi": lambda: joint.twist.reshape(6, 1),
        "omega": lambda: joint.axis.reshape(3, 1),
        "q": lambda: joint.point.reshape(3, 1),
        "foot": lambda: cross(joint.axis, joint.twist[:3]).reshape(3, 1),
        "exp": lambda: normal.exponentials[i],
        "prod": lambda: normal.partial[i],
        "tail": lambda: normal.tails[i],
        "Js": lambda: normal.spatial[:, i : i + 1],
        "Jb": lambda: normal.body[:, i : i + 1],
        "Jh": lambda: normal.hybrid[:, i : i + 1],
        # z_{i-1} of Spong's geometric method: R_{i-1} turns the axis, and a slide goes along it.
        "z": lambda: normal.hybrid[3:, i : i + 1] if joint.revolute else normal.hybrid[:3, i : i + 1],
    }
    return numbered[name]


def _sized(elements: Elements, *shapes: tuple[int, int], what: str) -> Elements:
    if elements.shape not in shapes:
        raise _NoFunctionError(f"it needs {what}")
    return elements


def _pose(elements: Elements) -> Elements:
    return _sized(elements, (4, 4), what="a matrix of 4 rows and 4 columns")


def _rate(derivation: Derivation, pose: Elements) -> Elements:
    """Σ ∂g/∂θi θ̇i."""
    algebra = derivation.chain.algebra
    joints = derivation.chain.joints
    terms = [derivative(_pose(pose), joint) * algebra.constant(joint.variable.rate) for joint in joints]
    found: Elements = sum(terms[1:], terms[0]) if terms else pose * algebra.constant(0)
    return found


def _hat(_derivation: Derivation, of: Elements) -> Elements:
    _sized(of, (3, 1), (6, 1), what="a column of 3 or 6")
    algebra = of[0, 0].algebra
    if len(of) == 6:
        return hat(algebra, of[:, 0])
    zero = np.array([algebra.constant(0)] * 3, dtype=object)
    return hat(algebra, np.concatenate([zero, of[:, 0]]))[:3, :3]


def _rows(_derivation: Derivation, of: Elements, *, lower: bool) -> Elements:
    if len(of) != 6:
        raise _NoFunctionError("it needs a matrix of 6 rows")
    return of[3:] if lower else of[:3]


def _determinant(derivation: Derivation, of: Elements) -> Elements:
    """Laplace's expansion by rows, each minor formed once."""
    if of.shape[0] != of.shape[1]:
        raise _NoFunctionError("it needs a square matrix")
    n = len(of)
    minors: dict[tuple[int, ...], Element] = {(): derivation.chain.algebra.constant(1)}
    for row in range(n - 1, -1, -1):
        below: dict[tuple[int, ...], Element] = {}
        for columns, minor in minors.items():
            for j in range(n):
                if j in columns or not of[row, j] or not minor:
                    continue
                chosen = tuple(sorted((*columns, j)))
                term = of[row, j] * minor
                term = -term if chosen.index(j) % 2 else term
                below[chosen] = below[chosen] + term if chosen in below else term
        minors = below
    whole = tuple(range(n))
    found = minors.get(whole, derivation.chain.algebra.constant(0))
    return np.array([[found]], dtype=object)


_FUNCTIONS: Final[dict[str, Callable[[Derivation, Elements], Elements]]] = {
    "inv": lambda _, g: inverse(_pose(g)),
    "R": lambda _, g: _pose(g)[:3, :3],
    "p": lambda _, g: _pose(g)[:3, 3:],
    "dot": _rate,
    "Ad": lambda _, g: adjoint(_pose(g)),
    "hat": _hat,
    "corner": lambda _, ad: _sized(ad, (6, 6), what="an adjoint")[:3, 3:],
    "v": partial(_rows, lower=False),
    "w": partial(_rows, lower=True),
    "det": _determinant,
}
