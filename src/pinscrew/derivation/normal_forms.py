"""Every quantity of the coursework, by the route that the coursework takes, in normal form.

Equation numbers are of Murray, Li and Sastry, *A Mathematical Introduction to Robotic Manipulation*, 1994 (MLS).
Everything here is in the values of the joints that move the frame; where one joint follows another, the columns of
Jacobians are those of the single joints, and `derivation` adds them up.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from itertools import accumulate
from typing import Final

import numpy as np
import numpy.typing as npt

from pinscrew.derivation.chain import Elements, Moving, ScrewChain, cross
from pinscrew.derivation.trig import Algebra, Element

__all__ = ["GrowthError", "NormalForms", "adjoint", "adjoint_inverse", "derivative", "hat", "inverse"]


MOST_TERMS: Final = 500
"""Products of sines and cosines in one entry of a pose."""
MOST_MONOMIALS: Final = 5000
"""The same, with those of their coefficients, which are polynomials in lengths, counted."""


class GrowthError(Exception):
    """An entry has more terms than are of use to anyone; `run.derive` says so with the file's name."""


class NormalForms:
    """The results of a chain as arrays of elements, each formed when it is first asked for.

    n is the number of joints that move the frame; lengths are in m, angles in rad.
    """

    def __init__(self, chain: ScrewChain) -> None:
        self.chain = chain
        self._algebra = chain.algebra
        self._joints = chain.joints

    @cached_property
    def exponentials(self) -> tuple[Elements, ...]:
        """e^{ξ̂i θi}, n of shape (4, 4); MLS eq. 2.32 and 2.36."""
        return tuple(_exponential(self._algebra, joint) for joint in self._joints)

    @cached_property
    def partial(self) -> tuple[Elements, ...]:
        """e^{ξ̂1 θ1} … e^{ξ̂i θi}, n of shape (4, 4).

        Raises:
            GrowthError: if an entry grows beyond `MOST_TERMS`.
        """
        return tuple(accumulate(self.exponentials, lambda before, e: _bounded(before @ e)))

    @cached_property
    def before(self) -> tuple[Elements, ...]:
        """The product of the exponentials before each joint, n of shape (4, 4)."""
        return (_constant(self._algebra, np.eye(4, dtype=int)), *self.partial)[: len(self._joints)]

    @cached_property
    def tails(self) -> tuple[Elements, ...]:
        """e^{ξ̂i θi} … e^{ξ̂n θn} g(0), n of shape (4, 4)."""
        backwards = accumulate(reversed(self.exponentials), lambda after, e: e @ after, initial=self.chain.home)
        return tuple(reversed(list(backwards)[1:]))

    @cached_property
    def pose(self) -> Elements:
        """g(θ), shape (4, 4); MLS eq. 3.3."""
        return self.partial[-1] @ self.chain.home if self._joints else self.chain.home

    @cached_property
    def inverse(self) -> Elements:
        """g⁻¹ = (Rᵀ, -Rᵀp), shape (4, 4); MLS eq. 2.24."""
        return inverse(self.pose)

    @cached_property
    def rates(self) -> tuple[Elements, ...]:
        """(∂g/∂θi) θ̇i, n of shape (4, 4), whose sum is ġ."""
        return tuple(derivative(self.pose, joint) * rate for joint, rate in zip(self._joints, self._rate, strict=True))

    @cached_property
    def pose_rate(self) -> Elements:
        """ġ, shape (4, 4)."""
        return sum(self.rates, _constant(self._algebra, np.zeros((4, 4), dtype=int)))

    @cached_property
    def body_hat(self) -> Elements:
        """V̂^b = g⁻¹ġ, shape (4, 4); MLS eq. 2.55."""
        return self.inverse @ self.pose_rate

    @cached_property
    def spatial_hat(self) -> Elements:
        """V̂^s = ġg⁻¹, shape (4, 4); MLS eq. 2.53."""
        return self.pose_rate @ self.inverse

    @cached_property
    def spatial(self) -> Elements:
        """J^s: column i is ξ′ = Ad(e^{ξ̂1 θ1} … e^{ξ̂(i-1) θ(i-1)}) ξi, shape (6, n); MLS eq. 3.54."""
        return self._columns(
            self._carried(joint.twist, reversed(self._joints[:i])) for i, joint in enumerate(self._joints)
        )

    @cached_property
    def body(self) -> Elements:
        """J^b: column i is ξ† = Ad⁻¹(e^{ξ̂i θi} … e^{ξ̂n θn} g(0)) ξi, shape (6, n); MLS eq. 3.55."""
        home = adjoint_inverse(self.chain.home)
        return self._columns(
            home @ self._carried(joint.twist, self._joints[i + 1 :], back=True) for i, joint in enumerate(self._joints)
        )

    def at(self, middle: int) -> Elements:
        """The Jacobian in the frame that goes with joint ``middle``, Ad⁻¹(e^{ξ̂1 θ1} … e^{ξ̂m θm}) J^s, shape (6, n).

        It has the rank of J^s and J^b, and for n = 6 their determinant, in fewer terms.
        """
        return self._columns(
            self._carried(joint.twist, self._joints[i + 1 : middle], back=True)
            if i < middle
            else self._carried(joint.twist, reversed(self._joints[middle:i]))
            for i, joint in enumerate(self._joints)
        )

    @cached_property
    def hybrid(self) -> Elements:
        """J^h = diag(R, R) J^b: columns (ω′ × (p - q′), ω′), formed at the joint, then turned; shape (6, n)."""
        columns = []
        for g, tail, joint in zip(self.before, self.tails, self._joints, strict=True):
            R = g[:3, :3]
            # With g = e₁ … e_{i-1} and e_i … e_n g(0) = (·, p): at the joint, the tip moves by ω × (p - q).
            arm = cross(joint.axis, tail[:3, 3] - joint.point) if joint.revolute else joint.axis
            columns.append(np.concatenate([R @ arm, R @ joint.axis if joint.revolute else joint.twist[3:]]))
        return self._columns(columns)

    @cached_property
    def body_velocity(self) -> Elements:
        """V^b = J^b θ̇, shape (6,)."""
        return self._times_rate(self.body)

    @cached_property
    def spatial_velocity(self) -> Elements:
        """V^s = J^s θ̇, shape (6,)."""
        return self._times_rate(self.spatial)

    @cached_property
    def hybrid_velocity(self) -> Elements:
        """V^h = diag(R, R) V^b = J^h θ̇, shape (6,)."""
        return self._times_rate(self.hybrid)

    @cached_property
    def agrees(self) -> bool:
        """Whether g⁻¹ġ is the hat of J^b θ̇, entry for entry."""
        return not (self.body_hat - hat(self._algebra, self.body_velocity)).any()

    @property
    def _rate(self) -> list[Element]:
        return [self._algebra.constant(joint.variable.rate) for joint in self._joints]

    def _times_rate(self, J: Elements) -> Elements:
        rate = np.array(self._rate, dtype=object)
        return J @ rate if len(rate) else _constant(self._algebra, np.zeros(6, dtype=int))

    def _columns(self, columns: Iterable[Elements]) -> Elements:
        found = list(columns)
        return np.stack(found, axis=1) if found else _constant(self._algebra, np.zeros((6, 0), dtype=int))

    def _carried(self, twist: Elements, joints: Iterable[Moving], *, back: bool = False) -> Elements:
        """The twist after Ad (or, ``back``, Ad⁻¹) of the exponentials of these joints, one after the other.

        Ad of a turn about an axis through q is linear in its sine and cosine when the twist is taken at q: that is
        why it is not formed as a 6×6 matrix, in which p̂R would be quadratic.
        """
        for joint in joints:
            v, w = twist[:3], twist[3:]
            if joint.revolute:
                # At q, the twist (v, ω) is (v + ω × q, ω); turned there, and taken back to the origin. Such as a slide
                # along x before a quarter turn about z: v = R [1, 0, 0] = [0, 1, 0], for any q, since ω = 0.
                R = self._turn(joint, back=back)
                w_turned = R @ w
                twist = np.concatenate([R @ (v + cross(w, joint.point)) - cross(w_turned, joint.point), w_turned])
            else:
                # Ad of a translation p: (v + p × ω, ω); MLS eq. 2.58 with R = I.
                p = joint.axis * self._algebra.constant(joint.variable.symbol)
                moved = cross(p, w)
                twist = np.concatenate([v - moved if back else v + moved, w])
        return twist

    def _turn(self, joint: Moving, *, back: bool) -> Elements:
        R = self.exponentials[self._joints.index(joint)][:3, :3]
        return R.T if back else R


def _bounded(elements: Elements) -> Elements:
    """The elements, refused where one is longer than anyone can use.

    Each joint whose axis is neither parallel nor perpendicular to the last triples the terms, for R = I + s ω̂ + (1 -
    c) ω̂² has three: five such joints give 3⁵ = 243, six 729, eight 6561, for each of twelve entries.
    """
    terms = max(len(element.terms) for element in elements.flat)
    monomials = max(sum(map(len, element.terms.values())) for element in elements.flat)
    if terms > MOST_TERMS or monomials > MOST_MONOMIALS:
        raise GrowthError(f"an entry of the pose would have {max(terms, monomials)} terms")
    return elements


def derivative(elements: Elements, joint: Moving) -> Elements:
    """The partial derivative of each element with respect to a joint's value."""
    symbol = joint.variable.symbol
    found: Elements = np.frompyfunc(lambda e: e.derivative(symbol), 1, 1)(elements)
    return found


def _constant(algebra: Algebra, values: npt.NDArray[np.int_]) -> Elements:
    return np.array([algebra.constant(int(x)) for x in values.flat], dtype=object).reshape(values.shape)


def _exponential(algebra: Algebra, joint: Moving) -> Elements:
    """e^{ξ̂θ}: for a turning joint R = I + s ω̂ + (1 - c) ω̂² and p = (I - R)q, for a sliding one p = ωθ."""
    g = _constant(algebra, np.eye(4, dtype=int))
    theta = joint.variable.symbol
    if not joint.revolute:
        g[:3, 3] = joint.axis * algebra.constant(theta)
        return g
    w = _hat3(algebra, joint.axis)
    one = _constant(algebra, np.eye(3, dtype=int))
    R = one + w * algebra.sine(theta) + (w @ w) * (algebra.constant(1) - algebra.cosine(theta))
    g[:3, :3], g[:3, 3] = R, (one - R) @ joint.point
    return g


def inverse(g: Elements) -> Elements:
    """g⁻¹ = (Rᵀ, -Rᵀp), MLS eq. 2.24."""
    out = g.copy()
    out[:3, :3], out[:3, 3] = g[:3, :3].T, -(g[:3, :3].T @ g[:3, 3])
    return out


def _hat3(algebra: Algebra, w: Elements) -> Elements:
    """ω̂, the matrix of ω ×, shape (3, 3); MLS eq. 2.4."""
    zero = algebra.constant(0)
    x, y, z = w
    return np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]], dtype=object)


def hat(algebra: Algebra, twist: Elements) -> Elements:
    """ξ̂ of a twist (v, ω), shape (4, 4); MLS eq. 2.31."""
    out = _constant(algebra, np.zeros((4, 4), dtype=int))
    out[:3, :3], out[:3, 3] = _hat3(algebra, twist[3:]), twist[:3]
    return out


def adjoint(g: Elements) -> Elements:
    """Ad of a pose on twists (v, ω): [[R, p̂R], [0, R]], shape (6, 6); MLS eq. 2.58."""
    R = g[:3, :3]
    return _blocks(R, _hat3(R[0, 0].algebra, g[:3, 3]) @ R)


def adjoint_inverse(g: Elements) -> Elements:
    """Ad⁻¹ of a pose: [[Rᵀ, -Rᵀp̂], [0, Rᵀ]], shape (6, 6); MLS §2.4.2."""
    R = g[:3, :3].T
    return _blocks(R, -(R @ _hat3(R[0, 0].algebra, g[:3, 3])))


def _blocks(R: Elements, corner: Elements) -> Elements:
    out = _constant(R[0, 0].algebra, np.zeros((6, 6), dtype=int))
    out[:3, :3], out[3:, 3:], out[:3, 3:] = R, R, corner
    return out
