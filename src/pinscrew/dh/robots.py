"""A robot from a Denavit-Hartenberg table: the table becomes URDF, which both engines read as any other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from pinscrew.description import urdf
from pinscrew.description.orientation import to_rpy
from pinscrew.dh.table import Convention, about_z, along_x, check_convention
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.ground.words import brief
from pinscrew.robot.robot import Robot

__all__ = ["from_dh"]

PARAMETERS: Final = ("theta", "d", "a", "alpha")
MOST_ROWS: Final = 1000


def from_dh(
    table: Sequence[Sequence[float] | Mapping[str, Any]] | FloatArray, *, convention: Convention, joints: str = ""
) -> Robot:
    """The robot of a Denavit-Hartenberg table, with links ``base``, ``link1``, … and ``tool``.

    Standard rows are Aᵢ = Rz(θᵢ) Tz(dᵢ) Tx(aᵢ) Rx(αᵢ) (Spong, Hutchinson, Vidyasagar, eq. 3.10), modified ones
    Tᵢ = Tx(aᵢ₋₁) Rx(αᵢ₋₁) Rz(θᵢ) Tz(dᵢ) (Craig, eq. 3.6). The joint's value is added to θ, or to d. Revolute joints
    are continuous; prismatic ones move within ±1 m, since a table has no limits.

    Args:
        table: one row for each joint: θ, d, a, α at zero (rad, m, m, rad), in this order or by the names ``theta``,
            ``d``, ``a``, ``alpha``; in the modified convention, a and α are aᵢ₋₁ and αᵢ₋₁.
        convention: ``"standard"`` or ``"modified"``; there is no default, since the same rows are two arms.
        joints: a letter for each row, R for revolute and P for prismatic; by default all are revolute.

    Raises:
        InputError: if a row has not four finite numbers, there is no row, more than 1000, or no such convention, or
            ``joints`` does not fit.
    """
    check_convention(convention)
    _check_table(table)
    rows = [_row(row, i) for i, row in enumerate(table, 1)]
    kinds = joints or "R" * len(rows)
    if len(kinds) != len(rows) or set(kinds) - set("RP"):
        what = f"joints={brief(kinds)!r} for {len(rows)} rows"
        raise InputError("dh-table", what, remedy="give one letter for each row: R, or P for prismatic")
    parts, before, parent = ['<robot name="dh">', '<link name="base"/>'], np.eye(4), "base"
    for i, ((theta, d, a, alpha), kind) in enumerate(zip(rows, kinds, strict=True), 1):
        # Z(θ + q, d) = Z(θ, d) Rz(q), and likewise for d: the row's own Z is part of the joint's origin.
        X, Z = along_x(a, alpha, 0.0), about_z(theta, d)
        origin = before @ Z if convention == "standard" else X @ Z
        before = X if convention == "standard" else np.eye(4)
        parts += _joint(f"joint{i}", "continuous" if kind == "R" else "prismatic", parent, f"link{i}", origin)
        parent = f"link{i}"
    parts += _joint("tool_joint", "fixed", parent, "tool", before)
    return Robot.from_description(urdf.parse("\n".join([*parts, "</robot>"]), "DH table"), tip="tool")


def _check_table(table: Any) -> None:
    """Refuse what is no list of rows.

    Raises:
        InputError: if it is none, or has no row or more than 1000.
    """
    if not isinstance(table, Sequence | np.ndarray) or isinstance(table, str):
        what = f"a table is a list of rows, not {type(table).__name__}"
        raise InputError("dh-table", what, remedy="give rows of θ, d, a, α (rad, m, m, rad)")
    if not 1 <= len(table) <= MOST_ROWS:
        raise InputError("dh-table", f"a table of {len(table)} rows", remedy=f"give 1 to {MOST_ROWS}")


def _row(row: Any, number: int) -> tuple[float, ...]:
    """The row's four numbers.

    Raises:
        InputError: if they are not four finite numbers.
    """
    if isinstance(row, Mapping):
        if set(row) != set(PARAMETERS):
            what = f"row {number} has {brief(', '.join(map(str, row)))!r}"
            raise InputError("dh-table", what, remedy=f"give {', '.join(PARAMETERS)}")
        row = [row[name] for name in PARAMETERS]
    try:
        values = tuple(map(float, row))
    except (TypeError, ValueError, OverflowError):
        values = ()
    if isinstance(row, str) or len(values) != len(PARAMETERS) or not all(map(math.isfinite, values)):
        what = f"row {number} is {brief(repr(row))}"
        raise InputError("dh-table", what, remedy="give four finite numbers: θ, d, a, α (rad, m, m, rad)")
    return values


def _joint(name: str, kind: str, parent: str, child: str, T: FloatArray) -> list[str]:
    limit = '<limit lower="-1" upper="1" effort="0" velocity="0"/>' if kind == "prismatic" else ""
    xyz, rpy = (" ".join(repr(float(v)) for v in values) for values in (T[:3, 3], to_rpy(T[:3, :3])))
    return [
        f'<link name="{child}"/>',
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 0 1"/>{limit}</joint>',
    ]
