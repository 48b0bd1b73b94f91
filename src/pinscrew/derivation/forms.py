"""The closed forms of a frame's motion as sympy expressions, each formed when it is first asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final, Literal, TypeAlias

import numpy as np
import sympy as sp

from pinscrew.derivation import normal_forms, reader
from pinscrew.derivation.atoms import Atoms
from pinscrew.derivation.chain import Elements, ScrewChain, Variable
from pinscrew.derivation.exact import Snapped
from pinscrew.derivation.factoring import Factoring
from pinscrew.derivation.joint_screw import JointScrew
from pinscrew.derivation.reading import JointGeometry
from pinscrew.ground.typing import KINDS, KindLike, jacobian_kind
from pinscrew.robot.robot import Robot

__all__ = ["ClosedForms", "Convention"]

LARGE: Final = 4
"""Joints above which an arm is `Derivation.large`."""
MANY: Final = 100
"""Terms of the pose above which it is, too: axes at odd angles."""

Convention: TypeAlias = Literal["mls", "lynch-park"]


@dataclass(frozen=True, eq=False, repr=False)
class ClosedForms:
    """Closed forms of the kinematics of one frame.

    All matrices are sympy's, in symbols for lengths, for the joints' values (``theta1``) and rates (``dtheta1``),
    and for sines and cosines (``c1``, ``s12``): `explicit` puts cos(θ1) and sin(θ1 + θ2) for these. Twists and rows
    of Jacobians are (v, ω), in m and rad. Each is formed when it is first asked for.

    Attributes:
        robot: the robot.
        tip: the frame whose motion this is.
        reference: the frame in which it is: the base, or another.
        also: further frames whose joints were read.
        lengths: the symbols of lengths and other arguments, and their values as given.
        remarks: in words: which arguments stay numbers, and why.
        snapped: numbers of the file that were replaced by exact ones.
        convention: whose names and order of twists reports use; matrices here are always (v, ω).
        chain: the joints in normal form.
        geometry: the joints as they were read.
    """

    robot: Robot
    tip: str
    reference: str
    also: tuple[str, ...]
    lengths: Mapping[sp.Symbol, sp.Expr]
    remarks: tuple[str, ...]
    snapped: tuple[Snapped, ...]
    convention: Convention
    chain: ScrewChain
    geometry: tuple[JointGeometry, ...]
    variables: tuple[Variable, ...]
    normal: normal_forms.NormalForms = field(init=False)
    atoms: Atoms = field(init=False)
    _factoring: Factoring = field(init=False)
    _columns: dict[str, sp.ImmutableMatrix] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        labels = {variable.symbol: variable.label for variable in self.variables}
        object.__setattr__(self, "normal", normal_forms.NormalForms(self.chain))
        object.__setattr__(self, "atoms", Atoms(self.chain.algebra, labels))
        object.__setattr__(self, "_factoring", Factoring(self.atoms))

    def __repr__(self) -> str:
        names = ", ".join(map(str, self.lengths)) or "none"
        return f"<Derivation of {self.tip!r} of {self.robot.name!r}: {len(self.screws)} joints, lengths: {names}>"

    @property
    def coordinates(self) -> tuple[Variable, ...]:
        """The coordinates that move the frame, one for each column of the Jacobians; from the base, in its order."""
        return self.chain.coordinates

    @property
    def symbols(self) -> Mapping[str, sp.Symbol]:
        """Every symbol by its name: lengths, values and rates of joints, sines and cosines of the closed forms.

        They are those of each joint, of the sums of angles that are in the pose and in the Jacobians, whatever was
        asked for before, and any that were made since.
        """
        for joint in self.chain.joints:
            if joint.revolute:
                algebra, angle = self.chain.algebra, joint.variable.symbol
                self.write(np.array([[algebra.cosine(angle), algebra.sine(angle)]], dtype=object))
        for kind in KINDS:
            self.columns(kind)
        _ = self.pose
        values = [s for variable in self.variables for s in (variable.symbol, variable.rate)]
        return {str(symbol): symbol for symbol in (*self.lengths, *values, *self.atoms.explicit)}

    @property
    def exact(self) -> bool:
        """Whether every number is exact; otherwise some are decimals of 30 digits."""
        return self.chain.algebra.exact

    @cached_property
    def home(self) -> sp.ImmutableMatrix:
        """g(0), the pose at zero, shape (4, 4)."""
        return self.write(self.chain.home)

    @cached_property
    def screws(self) -> tuple[JointScrew, ...]:
        """The joints that move the frame, from the base outwards."""
        found = []
        for joint in self.chain.joints:
            omega = joint.twist[3:]
            vectors = [self.write(x.reshape(3, 1)) for x in (omega, joint.point, joint.twist[:3])]
            value = joint.multiplier * joint.master.symbol
            found.append(JointScrew(joint.variable.joint, joint.revolute, vectors[0], vectors[1], vectors[2], value))
        return tuple(found)

    @cached_property
    def exponentials(self) -> tuple[sp.ImmutableMatrix, ...]:
        """e^{ξ̂i θi} of each joint, of shape (4, 4)."""
        return tuple(self.write(g) for g in self.normal.exponentials)

    @cached_property
    def partial_products(self) -> tuple[sp.ImmutableMatrix, ...]:
        """e^{ξ̂1 θ1} … e^{ξ̂i θi}, of shape (4, 4)."""
        return tuple(self.write(g) for g in self.normal.partial)

    @cached_property
    def pose(self) -> sp.ImmutableMatrix:
        """g(θ), the pose in the frame `reference`, shape (4, 4)."""
        return self.write(self.normal.pose)

    @cached_property
    def inverse(self) -> sp.ImmutableMatrix:
        """g⁻¹, shape (4, 4)."""
        return self.write(self.normal.inverse)

    @cached_property
    def pose_rates(self) -> tuple[sp.ImmutableMatrix, ...]:
        """(∂g/∂θi) θ̇i of each joint, of shape (4, 4)."""
        return tuple(self.write(g) for g in self.normal.rates)

    @cached_property
    def pose_rate(self) -> sp.ImmutableMatrix:
        """ġ, in the rates of the coordinates, shape (4, 4)."""
        return self.in_rates(self.write(self.normal.pose_rate))

    @cached_property
    def body_hat(self) -> sp.ImmutableMatrix:
        """V̂^b = g⁻¹ġ, shape (4, 4)."""
        return self.in_rates(self.write(self.normal.body_hat))

    @cached_property
    def spatial_hat(self) -> sp.ImmutableMatrix:
        """V̂^s = ġg⁻¹, shape (4, 4)."""
        return self.in_rates(self.write(self.normal.spatial_hat))

    @cached_property
    def adjoint(self) -> sp.ImmutableMatrix:
        """Ad of g, shape (6, 6)."""
        return self.write(normal_forms.adjoint(self.normal.pose))

    @cached_property
    def spatial_adjoints(self) -> tuple[sp.ImmutableMatrix, ...]:
        """Ad(e^{ξ̂1 θ1} … e^{ξ̂(i-1) θ(i-1)}) of each joint, of shape (6, 6)."""
        return tuple(self.write(normal_forms.adjoint(g)) for g in self.normal.before)

    @cached_property
    def tails(self) -> tuple[sp.ImmutableMatrix, ...]:
        """g_i = e^{ξ̂i θi} … e^{ξ̂n θn} g(0) of each joint, of shape (4, 4)."""
        return tuple(self.write(g) for g in self.normal.tails)

    @cached_property
    def body_adjoints(self) -> tuple[sp.ImmutableMatrix, ...]:
        """Ad⁻¹(e^{ξ̂i θi} … e^{ξ̂n θn} g(0)) of each joint, of shape (6, 6)."""
        return tuple(self.write(normal_forms.adjoint_inverse(g)) for g in self.normal.tails)

    def columns(self, kind: KindLike) -> sp.ImmutableMatrix:
        """The Jacobian's columns for each joint that moves the frame, as if none followed another; shape (6, n)."""
        kind = jacobian_kind(kind)
        if kind not in self._columns:
            self._columns[kind] = self.write(getattr(self.normal, kind))
        return self._columns[kind]

    def jacobian(self, kind: KindLike) -> sp.ImmutableMatrix:
        """A Jacobian: a column for each of `coordinates`, shape (6, m).

        Where joints follow others, a coordinate's column is the sum of its joints' `columns`, each times its
        multiplier, with the joints' values put in terms of the coordinates by `in_coordinates`.
        """
        columns = self.columns(kind)
        if not self.follows:
            return columns
        found = sp.zeros(6, len(self.coordinates))
        order = [variable.symbol for variable in self.coordinates]
        for i, joint in enumerate(self.chain.joints):
            k = order.index(joint.master.symbol)
            found[:, k] += joint.multiplier * columns[:, i]
        return sp.ImmutableMatrix(found)

    @cached_property
    def body_velocity(self) -> sp.ImmutableMatrix:
        """V^b = J^b θ̇, shape (6, 1)."""
        return self.in_rates(self.write(self.normal.body_velocity.reshape(6, 1)))

    @cached_property
    def spatial_velocity(self) -> sp.ImmutableMatrix:
        """V^s = J^s θ̇, shape (6, 1)."""
        return self.in_rates(self.write(self.normal.spatial_velocity.reshape(6, 1)))

    @cached_property
    def hybrid_velocity(self) -> sp.ImmutableMatrix:
        """V^h = diag(R, R) V^b, shape (6, 1)."""
        return self.in_rates(self.write(self.normal.hybrid_velocity.reshape(6, 1)))

    @property
    def velocities_agree(self) -> bool:
        """Whether g⁻¹ġ is the hat of J^b θ̇, entry for entry: the two routes to V^b."""
        return self.normal.agrees

    @cached_property
    def large(self) -> bool:
        """Whether velocities term by term and adjoints are too long to be of use, unless they are asked for."""
        return len(self.screws) > LARGE or sum(len(e.terms) for e in self.normal.pose.flat) > MANY

    @property
    def joint_values(self) -> tuple[sp.Symbol, ...]:
        """The values of the joints that move the frame."""
        return tuple(joint.variable.symbol for joint in self.chain.joints)

    @cached_property
    def follows(self) -> Mapping[sp.Symbol, sp.Expr]:
        """The values of the joints that follow others, in terms of the coordinates, without their offsets."""
        return {
            joint.variable.symbol: joint.multiplier * joint.master.symbol
            for joint in self.chain.joints
            if joint.master is not joint.variable
        }

    def in_rates(self, matrix: sp.ImmutableMatrix) -> sp.ImmutableMatrix:
        """With the rates of joints that follow others put in terms of those of the coordinates."""
        rates = {
            joint.variable.rate: joint.multiplier * joint.master.rate
            for joint in self.chain.joints
            if joint.master is not joint.variable
        }
        return matrix.xreplace(rates).applyfunc(sp.factor_terms) if rates else matrix

    def explicit(self, expression: Any) -> Any:
        """An expression or matrix with cos(θ1) for c1, sin(θ1 + θ2) for s12 and so on."""
        return expression.xreplace(self.atoms.explicit)

    def in_coordinates(self, expression: Any) -> Any:
        """An expression or matrix, explicit, with the values of joints that follow others put in."""
        return self.explicit(expression).xreplace(dict(self.follows))

    def equal(self, a: Any, b: Any) -> bool:
        """Whether two expressions or matrices, polynomial in lengths, sines and cosines, are identically equal.

        Each may be sympy's, a number, a text such as ``"L0 - s2*(L3 + theta3)"``, or a matrix or list of lists of
        these. Symbols may be one's own, such as ``sympy.Symbol("L3")``: a symbol is known by its name.

        Both are brought to the normal form of `trig`, so the answer is exact, both ways (to 20 digits, where
        numbers are not `exact`).

        Raises:
            InputError: if a text is no expression, or has a symbol that the closed forms have not.
            TypeError: if they are no such expressions.
        """
        known = self.symbols
        left, right = reader.matrix(a, known), reader.matrix(b, known)
        if left.shape != right.shape:
            return False
        difference = (left - right).xreplace({s: known.get(s.name, s) for s in (left - right).free_symbols})
        return not any(self.chain.algebra.read(x) for x in self.explicit(difference))

    def write(self, elements: Elements) -> sp.ImmutableMatrix:
        """A matrix in normal form as one of expressions."""
        rows, columns = elements.shape
        return sp.ImmutableMatrix(rows, columns, [self._factoring.expression(e) for e in np.ravel(elements)])
