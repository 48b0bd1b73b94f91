"""The joints that move a frame, as screws at zero in exact form, and the frame's home pose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import sympy as sp

from pinscrew.derivation.exact import PRIMES
from pinscrew.derivation.reading import JointGeometry
from pinscrew.derivation.trig import Algebra

__all__ = ["Elements", "Moving", "ScrewChain", "Variable", "compose"]

Elements: TypeAlias = npt.NDArray[Any]
"""An array of `Element`."""


@dataclass(frozen=True, slots=True)
class Variable:
    """The value of a joint.

    Attributes:
        joint: the joint's name.
        label: what it has in the names of its sine and cosine: ``"1"`` for θ1.
        symbol: the value, rad or m.
        rate: its time derivative.
        latex: how to typeset the value and the rate.
    """

    joint: str
    label: str
    symbol: sp.Symbol
    rate: sp.Symbol
    latex: tuple[str, str]


@dataclass(frozen=True, slots=True)
class Moving:
    """A joint that moves the frame.

    Attributes:
        variable: its value.
        revolute: whether it turns; otherwise it slides.
        axis: ω, or for a sliding joint its direction: unit vector in the base frame at zero, shape (3,).
        point: q, the place of its origin in the base frame at zero (m), shape (3,).
        twist: ξ = (v, ω), v = -ω × q; (axis, 0) for a sliding joint; shape (6,).
        frame: the pose of its own frame at zero, which it moves, in the base frame; shape (4, 4).
        master: the variable that it follows; its own if it follows none.
        multiplier: its value per unit of the master's, beyond what is in the home pose.
    """

    variable: Variable
    revolute: bool
    axis: Elements
    point: Elements
    twist: Elements
    frame: Elements
    master: Variable
    multiplier: sp.Expr


@dataclass(frozen=True, slots=True)
class ScrewChain:
    """All that a derivation starts from.

    Attributes:
        algebra: what the elements are made of.
        joints: those that move the frame, from the base outwards.
        home: M, the frame's pose at zero, shape (4, 4).
        coordinates: the independent variables, in the order of the robot's, or along a way that leads back.
    """

    algebra: Algebra
    joints: tuple[Moving, ...]
    home: Elements
    coordinates: tuple[Variable, ...]


def compose(
    geometry: Sequence[JointGeometry],
    back: Sequence[str],
    on_path: Sequence[str],
    variables: Mapping[str, Variable],
    lengths: Sequence[sp.Symbol],
    order: Sequence[str],
) -> ScrewChain:
    """The chain of the joints from one frame to another.

    A joint has T_parent_child(θ) = T_parent_joint e^{axis θ}. Outwards these are multiplied as they are. On the way
    ``back`` it is T_child_parent(θ) = e^{-axis θ} T_parent_joint⁻¹, the joint first and its origin after it: the same
    joint about the opposite axis. At θ = 0 the product up to a joint gives its axis and a point of it in the first
    frame. Two links, a turn about z, then one about x at [1, 0, 0] that is turned by 90° about z:

        after joint 1: p = 0,         axis [0, 0, 1]
        after joint 2: p = [1, 0, 0], R = Rz(90°), axis R [1, 0, 0] = [0, 1, 0]

    Args:
        geometry: of these joints and of the masters they follow.
        back: names of the joints from the first frame inwards to where the ways part.
        on_path: names of the joints from there outwards to the second frame.
        variables: of the moving joints and their masters.
        lengths: the symbols that may occur in positions.
        order: names of the robot's coordinates.
    """
    by_name = {joint.name: joint for joint in geometry}
    path = [by_name[name] for name in (*back, *on_path)]
    numbers = [x for joint in path for M in (joint.R, joint.p, joint.axis) for x in M] + [j.offset for j in path]
    numbers += [x for j in path if j.type not in ("fixed", "prismatic") and j.offset for x in _about(j.axis, j.offset)]
    exact = not any(sp.sympify(x).has(sp.Float) for x in numbers)
    moving = [joint for joint in path if joint.type != "fixed"]
    sliding = [variables[joint.name].symbol for joint in moving if joint.type == "prismatic"]
    symbols = (*lengths, *sliding, *(variables[joint.name].rate for joint in moving))
    # Axes at zero are found first, with no angles in the algebra: which joints form a group is read off them.
    plain = Algebra((), symbols, _primes(numbers), exact=exact)
    poses, R, p = [], _array(plain, sp.eye(3)), _array(plain, sp.zeros(3, 1))[:, 0]
    for number, joint in enumerate(path):
        inwards = number < len(back)
        if not inwards:
            p = p + R @ _array(plain, joint.p)[:, 0]
            R = R @ _array(plain, joint.R)
        axis = R @ _array(plain, -joint.axis if inwards else joint.axis)[:, 0]
        poses.append((axis, p, R))
        if joint.type == "prismatic":  # what a mimic adds to its master's value is in the pose at zero
            p = p + axis * plain.constant(joint.offset)
        elif joint.type != "fixed" and joint.offset:
            R = R @ _array(plain, _about(joint.axis, -joint.offset if inwards else joint.offset))
        if inwards:
            # T_parent_joint⁻¹ = (Rᵀ, -Rᵀp), MLS eq. 2.24, after the joint.
            R = R @ _array(plain, joint.R).T
            p = p - R @ _array(plain, joint.p)[:, 0]
    at_zero = {joint.name: pose for joint, pose in zip(path, poses, strict=True)}
    groups = _groups([(variables[j.name].symbol, at_zero[j.name][0]) for j in moving if j.type != "prismatic"])
    algebra = Algebra(groups, symbols, _primes(numbers), exact=exact)
    lift = np.frompyfunc(lambda e: algebra.element(dict.fromkeys([algebra.one], e.terms[()]) if e else {}), 1, 1)
    moved = []
    for joint in moving:
        axis, point, turn = (lift(x) for x in at_zero[joint.name])
        zero = np.array([algebra.constant(0)] * 3, dtype=object)
        revolute = joint.type != "prismatic"
        # ξ = (-ω × q, ω) or (v, 0): MLS eq. 2.26 and 2.28.
        twist = np.concatenate([-cross(axis, point), axis] if revolute else [axis, zero])
        multiplier, master = joint.multiplier, variables[joint.master]
        frame = _pose(algebra, turn, point)
        moved.append(Moving(variables[joint.name], revolute, axis, point, twist, frame, master, multiplier))
    # Columns stand as the joints do along the way: outwards that is the robot's order, back it is the other way round.
    masters = list(dict.fromkeys(joint.master for joint in moving))
    masters = masters if back else [name for name in order if name in masters]
    driving = tuple(variables[name] for name in masters)
    return ScrewChain(algebra, tuple(moved), _pose(algebra, lift(R), lift(p)), driving)


def _pose(algebra: Algebra, R: Elements, p: Elements) -> Elements:
    """(R, p), shape (4, 4)."""
    pose = np.full((4, 4), algebra.constant(0), dtype=object)
    pose[:3, :3], pose[:3, 3], pose[3, 3] = R, p, algebra.constant(1)
    return pose


def _primes(numbers: Sequence[sp.Expr]) -> list[int]:
    """The primes whose roots occur."""
    roots = {atom.base for x in numbers for atom in sp.sympify(x).atoms(sp.Pow) if atom.exp == sp.Rational(1, 2)}
    found = {p for root in roots if root.is_Integer for p in sp.primefactors(root)}
    return [p for p in PRIMES if p in found]


def _array(algebra: Algebra, matrix: sp.Matrix) -> Elements:
    entries = [algebra.constant(x) for x in matrix]
    return np.array(entries, dtype=object).reshape(matrix.shape)


def _about(axis: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """The rotation about a unit vector: Rodrigues' formula, MLS eq. 2.14."""
    x, y, z = axis
    hat = sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return sp.eye(3) + sp.sin(angle) * hat + (1 - sp.cos(angle)) * hat * hat


def _groups(turning: Sequence[tuple[sp.Symbol, Elements]]) -> list[list[sp.Symbol]]:
    """The angles of successive joints with parallel axes together; sliding joints between them do not count."""
    groups: list[list[sp.Symbol]] = []
    last: Elements | None = None
    for symbol, axis in turning:
        # Parallel at zero is parallel always: between them only turns about the axis itself, and slides.
        if last is not None and not any(cross(last, axis)):
            groups[-1].append(symbol)
        else:
            groups.append([symbol])
        last = axis
    return groups


def cross(a: Elements, b: Elements) -> Elements:
    """Cross product of two vectors of elements."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object)
