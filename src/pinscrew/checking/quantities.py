"""What may be asked for, by name, and its right form as the derivation has it."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

import numpy as np

from pinscrew.derivation.chain import Elements
from pinscrew.derivation.derivation import Derivation
from pinscrew.ground.errors import InputError

__all__ = ["QUANTITIES", "quantity_key", "right_form"]

QUANTITIES: Final = {
    "M": "the home pose",
    "xi1": "the twist of joint 1, and so on",
    "twists": "all twists, a column each",
    "exp1": "the exponential of joint 1, and so on",
    "T": "the pose",
    "R": "its rotation",
    "p": "its position",
    "Tinv": "its inverse",
    "Tdot": "its rate",
    "Js": "the spatial Jacobian",
    "Jb": "the body Jacobian",
    "Jh": "the hybrid Jacobian, which books on Denavit-Hartenberg call geometric",
    "Vs": "the spatial velocity",
    "Vb": "the body velocity",
    "Vh": "the hybrid velocity",
    "Vbhat": "the matrix of the body velocity",
}
"""The names, and what they stand for."""

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


def quantity_key(name: str, joints: int) -> str:
    """The name of `QUANTITIES` that a name means, with the joint's number where it is one joint's.

    Raises:
        InputError: there is no such quantity.
    """
    plain = re.sub(r"[\s_^{}\\]", "", name)
    plain = _SAME.get(plain, plain)
    numbered = re.fullmatch(r"(xi|exp)(\d+)", plain)
    if numbered and 1 <= int(numbered[2]) <= joints:
        return plain
    if plain in QUANTITIES and not numbered:
        return plain
    listed = ", ".join(QUANTITIES)
    what = f"there is no quantity {name!r} of an arm with {joints} moving joints"
    raise InputError("check-quantity", what, remedy=f"the quantities are: {listed}")


def right_form(derivation: Derivation, key: str) -> Elements:
    """The right form of a quantity, as a matrix."""
    normal, chain = derivation.normal, derivation.chain
    if key.startswith("xi"):
        return chain.joints[int(key[2:]) - 1].twist.reshape(6, 1)
    if key.startswith("exp"):
        return normal.exponentials[int(key[3:]) - 1]
    forms: dict[str, Callable[[], Elements]] = {
        "M": lambda: chain.home,
        "twists": lambda: np.stack([joint.twist for joint in chain.joints], axis=1),
        "T": lambda: normal.pose,
        "R": lambda: normal.pose[:3, :3],
        "p": lambda: normal.pose[:3, 3:],
        "Tinv": lambda: normal.inverse,
        "Tdot": lambda: normal.pose_rate,
        "Js": lambda: normal.spatial,
        "Jb": lambda: normal.body,
        "Jh": lambda: normal.hybrid,
        "Vs": lambda: normal.spatial_velocity.reshape(6, 1),
        "Vb": lambda: normal.body_velocity.reshape(6, 1),
        "Vh": lambda: normal.hybrid_velocity.reshape(6, 1),
        "Vbhat": lambda: normal.body_hat,
    }
    return forms[key]()
