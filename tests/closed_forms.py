"""The closed forms of the coursework, typed in by hand. Numpy only: no engine takes part.

One class per arm (two for the arm with two choices of frame 0), one method per printed result, with
the errata corrected. A formula here is the truth that code is held against: never fit it to code.

Notation: ``c1 = cos θ1``, ``s12 = sin(θ1 + θ2)``; twists are ``ξ = (v, ω)``, linear part first;
``g(θ) = e^{ξ̂1 θ1} … e^{ξ̂n θn} g(0)``. Every matrix is written row by row. Lengths in metres, angles in
radians. ``q`` holds the coordinates in order, ``qd`` their rates, ``L`` the arguments of the robot file
by name.
"""
# ruff: noqa: ARG002 -- the interface is the same for every arm; not every formula needs every argument

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import cos, pi, sin, sqrt
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Lengths = Mapping[str, float]


def rows(*lines: list[float]) -> Array:
    """A matrix, one line per row."""
    return np.array(lines, dtype=float)


def columns(*lines: list[float]) -> Array:
    """A matrix, one line per column, as twists are printed."""
    matrix: Array = rows(*lines).T
    return matrix


def vector(*entries: float) -> Array:
    """A vector, shape (len(entries),)."""
    return np.array(entries, dtype=float)


def pose(R: Array, p: Array) -> Array:
    """The homogeneous matrix of (R, p), shape (4, 4)."""
    g = np.eye(4)
    g[:3, :3], g[:3, 3] = R, p
    return g


def Rx(a: float) -> Array:
    """Rotation about x."""
    return rows([1, 0, 0], [0, cos(a), -sin(a)], [0, sin(a), cos(a)])


def Ry(a: float) -> Array:
    """Rotation about y."""
    return rows([cos(a), 0, sin(a)], [0, 1, 0], [-sin(a), 0, cos(a)])


def Rz(a: float) -> Array:
    """Rotation about z."""
    return rows([cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1])


class Arm(ABC):
    """What every arm answers. A Jacobian that the coursework does not print is None."""

    robot: ClassVar[str]  # name in robots/catalogue.json
    lengths: ClassVar[tuple[str, ...]] = ()  # arguments of the robot file
    joints: ClassVar[int]  # independent coordinates
    reference: ClassVar[str] = "base"  # the frame in which g, ξ and J^s are written
    tip: ClassVar[str] = "tool"

    @abstractmethod
    def home(self, L: Lengths) -> Array:
        """g(0), shape (4, 4)."""

    @abstractmethod
    def twists(self, L: Lengths) -> Array:
        """ξ1 … ξn, shape (6, n)."""

    @abstractmethod
    def fk(self, q: Array, L: Lengths) -> Array:
        """g(θ), shape (4, 4)."""

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array | None:
        """J^s, shape (6, n)."""
        return None

    def jacobian_body(self, q: Array, L: Lengths) -> Array | None:
        """J^b, shape (6, n)."""
        return None

    def jacobian_hybrid(self, q: Array, L: Lengths) -> Array | None:
        """J^h = diag(R, R) J^b, shape (6, n)."""
        return None


class SphericalRRP(Arm):
    """Medical robotics, assignment 4, parts a–k."""

    robot = "spherical_rrp"
    lengths = ("L0", "L3")
    joints = 3

    def home(self, L: Lengths) -> Array:
        """Part (a)."""
        return pose(np.eye(3), vector(0, L["L3"], L["L0"]))

    def twists(self, L: Lengths) -> Array:
        """Part (b): ω1 = z and ω2 = -x through [0, 0, L0], joint 3 along y."""
        L0 = L["L0"]
        return columns([0, 0, 0, 0, 0, 1], [0, -L0, 0, -1, 0, 0], [0, 1, 0, 0, 0, 0])

    def exponentials(self, q: Array, L: Lengths) -> tuple[Array, Array, Array]:
        """Part (c): e^{ξ̂1 θ1}, e^{ξ̂2 θ2}, e^{ξ̂3 θ3}."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        L0 = L["L0"]
        return (
            rows([c1, -s1, 0, 0], [s1, c1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]),
            rows([1, 0, 0, 0], [0, c2, s2, -L0 * s2], [0, -s2, c2, L0 * (1 - c2)], [0, 0, 0, 1]),
            rows([1, 0, 0, 0], [0, 1, 0, q[2]], [0, 0, 1, 0], [0, 0, 0, 1]),
        )

    def fk(self, q: Array, L: Lengths) -> Array:
        """Part (d), r = L3 + θ3."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        L0, r = L["L0"], L["L3"] + q[2]
        return rows(
            [c1, -s1 * c2, -s1 * s2, -r * s1 * c2],
            [s1, c1 * c2, c1 * s2, r * c1 * c2],
            [0, -s2, c2, L0 - r * s2],
            [0, 0, 0, 1],
        )

    def pose_rate_terms(self, q: Array, qd: Array, L: Lengths) -> tuple[Array, Array, Array]:
        """Part (e): the terms ∂g/∂θi θ̇i, whose sum is ġ."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        r = L["L3"] + q[2]
        d1 = rows(
            [-s1, -c1 * c2, -c1 * s2, -r * c1 * c2],
            [c1, -s1 * c2, -s1 * s2, -r * s1 * c2],
            [0, 0, 0, 0],
            [0, 0, 0, 0],
        )
        d2 = rows(
            [0, s1 * s2, -s1 * c2, r * s1 * s2],
            [0, -c1 * s2, c1 * c2, -r * c1 * s2],
            [0, -c2, -s2, -r * c2],
            [0, 0, 0, 0],
        )
        d3 = rows(
            [0, 0, 0, -s1 * c2],
            [0, 0, 0, c1 * c2],
            [0, 0, 0, -s2],
            [0, 0, 0, 0],
        )
        return d1 * qd[0], d2 * qd[1], d3 * qd[2]

    def pose_rate(self, q: Array, qd: Array, L: Lengths) -> Array:
        """Part (e): ġ."""
        d1, d2, d3 = self.pose_rate_terms(q, qd, L)
        return d1 + d2 + d3

    def inverse(self, q: Array, L: Lengths) -> Array:
        """Part (f): g⁻¹ = (Rᵀ, -Rᵀp)."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        L0, r = L["L0"], L["L3"] + q[2]
        return rows(
            [c1, s1, 0, 0],
            [-s1 * c2, c1 * c2, -s2, L0 * s2 - r],
            [-s1 * s2, c1 * s2, c2, -L0 * c2],
            [0, 0, 0, 1],
        )

    def body_velocity_hat(self, q: Array, qd: Array, L: Lengths) -> Array:
        """Part (g): V̂^b = g⁻¹ġ."""
        c2, s2 = cos(q[1]), sin(q[1])
        r = L["L3"] + q[2]
        d1, d2, d3 = qd
        return rows(
            [0, -c2 * d1, -s2 * d1, -r * c2 * d1],
            [c2 * d1, 0, d2, d3],
            [s2 * d1, -d2, 0, -r * d2],
            [0, 0, 0, 0],
        )

    def body_velocity(self, q: Array, qd: Array, L: Lengths) -> Array:
        """Part (h): V^b, read off V̂^b."""
        c2, s2 = cos(q[1]), sin(q[1])
        r = L["L3"] + q[2]
        d1, d2, d3 = qd
        return vector(-r * c2 * d1, d3, -r * d2, -d2, -s2 * d1, c2 * d1)

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """Part (i)."""
        c2, s2 = cos(q[1]), sin(q[1])
        r = L["L3"] + q[2]
        return rows(
            [-r * c2, 0, 0],
            [0, 0, 1],
            [0, -r, 0],
            [0, -1, 0],
            [-s2, 0, 0],
            [c2, 0, 0],
        )

    def hybrid_velocity(self, q: Array, qd: Array, L: Lengths) -> Array:
        """Part (k): V^h = diag(R, R) V^b."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        r = L["L3"] + q[2]
        d1, d2, d3 = qd
        return vector(
            r * (s1 * s2 * d2 - c1 * c2 * d1) - s1 * c2 * d3,
            -r * (s1 * c2 * d1 + c1 * s2 * d2) + c1 * c2 * d3,
            -r * c2 * d2 - s2 * d3,
            -c1 * d2,
            -s1 * d2,
            d1,
        )

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """J^s."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        L0 = L["L0"]
        return rows(
            [0, L0 * s1, -s1 * c2],
            [0, -L0 * c1, c1 * c2],
            [0, 0, -s2],
            [0, -c1, 0],
            [0, -s1, 0],
            [1, 0, 0],
        )


class ScrewParameters(NamedTuple):
    """The axis {point + λ direction}, the pitch and the magnitude of a twist."""

    point: Array
    direction: Array
    pitch: float
    magnitude: float


class Planar2RBase(Arm):
    """Medical robotics, assignment 3, parts a–f: frame 0 at the base. Every length is 1."""

    robot = "planar_2r"
    joints = 2
    limits = ((-pi / 4, pi / 2), (-pi / 2, pi / 2))

    def home(self, L: Lengths) -> Array:
        """g(0) = (Ry(90°), [-1, 1, 0])."""
        return rows([0, 0, 1, -1], [0, 1, 0, 1], [-1, 0, 0, 0], [0, 0, 0, 1])

    def screw_parameters(self) -> tuple[ScrewParameters, ScrewParameters]:
        """Part (b)."""
        return (
            ScrewParameters(vector(0, 0, 1), vector(1, 0, 0), 0, 1),
            ScrewParameters(vector(0, 1, 1), vector(1, 0, 0), 0, 1),
        )

    def twists(self, L: Lengths) -> Array:
        """Part (c)."""
        return columns([0, 1, 0, 1, 0, 0], [0, 1, -1, 1, 0, 0])

    def fk(self, q: Array, L: Lengths) -> Array:
        """Part (e)."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        return rows(
            [0, 0, 1, -1],
            [s12, c12, 0, c1 + s12],
            [-c12, s12, 0, 1 + s1 - c12],
            [0, 0, 0, 1],
        )

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """J^s."""
        c1, s1 = cos(q[0]), sin(q[0])
        return columns([0, 1, 0, 1, 0, 0], [0, 1 + s1, -c1, 1, 0, 0])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """J^b."""
        c2, s2 = cos(q[1]), sin(q[1])
        return columns([-c2, 1 + s2, 0, 0, 0, 1], [0, 1, 0, 0, 0, 1])

    def workspace_grid(self) -> Array:
        """Part (f): the joint angles in steps of 5°, shape (28 · 37, 2)."""
        theta1 = np.deg2rad(np.arange(-45, 91, 5))
        theta2 = np.deg2rad(np.arange(-90, 91, 5))
        return np.array([[a, b] for a in theta1 for b in theta2])


class Planar2RTip(Arm):
    """The same mechanism with frame 0 where the tool is at home."""

    robot = "planar_2r"
    joints = 2
    reference = "frame0"

    def home(self, L: Lengths) -> Array:
        """g(0) = I."""
        return np.eye(4)

    def screw_parameters(self) -> tuple[ScrewParameters, ScrewParameters]:
        """Part (b)."""
        return (
            ScrewParameters(vector(-1, -1, 0), vector(0, 0, 1), 0, 1),
            ScrewParameters(vector(-1, 0, 0), vector(0, 0, 1), 0, 1),
        )

    def twists(self, L: Lengths) -> Array:
        """Part (c)."""
        return columns([-1, 1, 0, 0, 0, 1], [0, 1, 0, 0, 0, 1])

    def base_from_frame0(self) -> Array:
        """(Ry(90°), [-1, 1, 0]): carries this choice to the base; base_from_frame0 · g is Planar2RBase.fk."""
        return rows([0, 0, 1, -1], [0, 1, 0, 1], [-1, 0, 0, 0], [0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """Part (e), in frame 0: e^{ξ̂1 θ1} e^{ξ̂2 θ2}."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        return rows(
            [c12, -s12, 0, c12 - s1 - 1],
            [s12, c12, 0, c1 + s12 - 1],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        )


class ScaraRRP(Arm):
    """Robotics, assignment 2, questions 7 and 11. Axis 3 points down."""

    robot = "scara_rrp"
    lengths = ("l1", "l2")
    joints = 3

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return pose(np.eye(3), vector(L["l1"] + L["l2"], 0, 0))

    def twists(self, L: Lengths) -> Array:
        """ξ = (-ω×q, ω), and (v, 0) for joint 3."""
        l1 = L["l1"]
        return columns([0, 0, 0, 0, 0, 1], [0, -l1, 0, 0, 0, 1], [0, 0, -1, 0, 0, 0])

    def link_transforms(self, q: Array, L: Lengths) -> tuple[Array, Array, Array]:
        """Question 7: Rz(q1); (Rz(q2), [l1, 0, 0]); (I, [l2, 0, -d3])."""
        return (
            pose(Rz(q[0]), vector(0, 0, 0)),
            pose(Rz(q[1]), vector(L["l1"], 0, 0)),
            pose(np.eye(3), vector(L["l2"], 0, -q[2])),
        )

    def fk(self, q: Array, L: Lengths) -> Array:
        """Question 7."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        l1, l2, d3 = L["l1"], L["l2"], q[2]
        return rows(
            [c12, -s12, 0, l1 * c1 + l2 * c12],
            [s12, c12, 0, l1 * s1 + l2 * s12],
            [0, 0, 1, -d3],
            [0, 0, 0, 1],
        )

    def jacobian_hybrid(self, q: Array, L: Lengths) -> Array:
        """Question 11, for q̇ = (q̇1, q̇2, ḋ3); the coursework takes q̇3 = -ḋ3 and prints +1."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        l1, l2 = L["l1"], L["l2"]
        return rows(
            [-l1 * s1 - l2 * s12, -l2 * s12, 0],
            [l1 * c1 + l2 * c12, l2 * c12, 0],
            [0, 0, -1],
            [0, 0, 0],
            [0, 0, 0],
            [1, 1, 0],
        )


class StanfordRRP(Arm):
    """Robotics, assignment 2, question 8 and bonus."""

    robot = "stanford_rrp"
    lengths = ("l1", "l2")
    joints = 3

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        R = rows([0, 0, 1], [1, 0, 0], [0, 1, 0])
        return pose(R, vector(0, -L["l2"], L["l1"]))

    def twists(self, L: Lengths) -> Array:
        """ω1 = z through 0; ω2 = -y through [0, -l2, l1]; joint 3 along x."""
        l1 = L["l1"]
        return columns([0, 0, 0, 0, 0, 1], [l1, 0, 0, 0, -1, 0], [1, 0, 0, 0, 0, 0])

    def link_transforms(self, q: Array, L: Lengths) -> tuple[Array, Array, Array]:
        """Rz(q1); (Rx(90°)Rz(q2), [0, -l2, l1]); (Ry(90°), [d3, 0, 0])."""
        return (
            pose(Rz(q[0]), vector(0, 0, 0)),
            pose(Rx(pi / 2) @ Rz(q[1]), vector(0, -L["l2"], L["l1"])),
            pose(Ry(pi / 2), vector(q[2], 0, 0)),
        )

    def fk(self, q: Array, L: Lengths) -> Array:
        """Question 8."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        l1, l2, d3 = L["l1"], L["l2"], q[2]
        return rows(
            [-s1, -c1 * s2, c1 * c2, d3 * c1 * c2 + l2 * s1],
            [c1, -s1 * s2, s1 * c2, d3 * s1 * c2 - l2 * c1],
            [0, c2, s2, d3 * s2 + l1],
            [0, 0, 0, 1],
        )

    def jacobian_hybrid(self, q: Array, L: Lengths) -> Array:
        """J^h."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        l2, d3 = L["l2"], q[2]
        return rows(
            [-d3 * s1 * c2 + l2 * c1, -d3 * c1 * s2, c1 * c2],
            [d3 * c1 * c2 + l2 * s1, -d3 * s1 * s2, s1 * c2],
            [0, d3 * c2, s2],
            [0, s1, 0],
            [0, -c1, 0],
            [1, 0, 0],
        )

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """J^b."""
        c2, s2 = cos(q[1]), sin(q[1])
        l2, d3 = L["l2"], q[2]
        return rows(
            [d3 * c2, 0, 0],
            [-l2 * s2, d3, 0],
            [l2 * c2, 0, 1],
            [0, -1, 0],
            [c2, 0, 0],
            [s2, 0, 0],
        )


class PlanarRRR(Arm):
    """Robotics, assignment 2, question 13."""

    robot = "planar_rrr"
    lengths = ("l1", "l2", "l3")
    joints = 3

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return pose(np.eye(3), vector(L["l1"] + L["l2"] + L["l3"], 0, 0))

    def twists(self, L: Lengths) -> Array:
        """ω = z through 0, [l1, 0, 0] and [l1 + l2, 0, 0]."""
        l1, l2 = L["l1"], L["l2"]
        return columns([0, 0, 0, 0, 0, 1], [0, -l1, 0, 0, 0, 1], [0, -(l1 + l2), 0, 0, 0, 1])

    def link_transforms(self, q: Array, L: Lengths) -> tuple[Array, Array, Array, Array]:
        """Rz(q1); (Rz(q2), [l1, 0, 0]); (Rz(q3), [l2, 0, 0]); tool at [l3, 0, 0]."""
        return (
            pose(Rz(q[0]), vector(0, 0, 0)),
            pose(Rz(q[1]), vector(L["l1"], 0, 0)),
            pose(Rz(q[2]), vector(L["l2"], 0, 0)),
            pose(np.eye(3), vector(L["l3"], 0, 0)),
        )

    def fk(self, q: Array, L: Lengths) -> Array:
        """g(θ)."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        c123, s123 = cos(q[0] + q[1] + q[2]), sin(q[0] + q[1] + q[2])
        l1, l2, l3 = L["l1"], L["l2"], L["l3"]
        return rows(
            [c123, -s123, 0, l1 * c1 + l2 * c12 + l3 * c123],
            [s123, c123, 0, l1 * s1 + l2 * s12 + l3 * s123],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        )

    def jacobian_hybrid(self, q: Array, L: Lengths) -> Array:
        """J^h: rows 1 and 2 are the partial derivatives of p."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        c123, s123 = cos(q[0] + q[1] + q[2]), sin(q[0] + q[1] + q[2])
        l1, l2, l3 = L["l1"], L["l2"], L["l3"]
        return rows(
            [-l1 * s1 - l2 * s12 - l3 * s123, -l2 * s12 - l3 * s123, -l3 * s123],
            [l1 * c1 + l2 * c12 + l3 * c123, l2 * c12 + l3 * c123, l3 * c123],
            [0, 0, 0],
            [0, 0, 0],
            [0, 0, 0],
            [1, 1, 1],
        )

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """J^b."""
        c3, s3 = cos(q[2]), sin(q[2])
        c23, s23 = cos(q[1] + q[2]), sin(q[1] + q[2])
        l1, l2, l3 = L["l1"], L["l2"], L["l3"]
        return rows(
            [l1 * s23 + l2 * s3, l2 * s3, 0],
            [l1 * c23 + l2 * c3 + l3, l2 * c3 + l3, l3],
            [0, 0, 0],
            [0, 0, 0],
            [0, 0, 0],
            [1, 1, 1],
        )


class Drone(Arm):
    """Robotics, assignment 2, question 9: up, roll about x, then turn about the drone's z."""

    robot = "drone"
    joints = 3

    def home(self, L: Lengths) -> Array:
        """g(0) = I."""
        return np.eye(4)

    def twists(self, L: Lengths) -> Array:
        """Along z, about x, about z; all through 0."""
        return columns([0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """g = (Rx(q2)Rz(q3), [0, 0, q1])."""
        c2, s2, c3, s3 = cos(q[1]), sin(q[1]), cos(q[2]), sin(q[2])
        return rows(
            [c3, -s3, 0, 0],
            [c2 * s3, c2 * c3, -s2, 0],
            [s2 * s3, s2 * c3, c2, q[0]],
            [0, 0, 0, 1],
        )

    def obstacle(self, q: Array) -> Array:
        """The point [0, 0, 3] of the drone's frame, in the world's."""
        return vector(0, -3 * sin(q[1]), q[0] + 3 * cos(q[1]))

    def printed(self) -> tuple[Array, Array]:
        """The q of the question (10 m, 30°, 60°) and the printed position of the obstacle."""
        return vector(10, pi / 6, pi / 3), vector(0, -3 / 2, 10 + 3 * sqrt(3) / 2)


class AnthropomorphicRRR(Arm):
    """Velocity kinematics assignment; u = l2s2 + l3s23, w = l2c2 + l3c23."""

    robot = "anthropomorphic_rrr"
    lengths = ("l1", "l2", "l3")
    joints = 3

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return rows([0, 0, 1, 0], [0, -1, 0, 0], [1, 0, 0, L["l1"] + L["l2"] + L["l3"]], [0, 0, 0, 1])

    def twists(self, L: Lengths) -> Array:
        """ω1 = z through 0; ω2 = x through [0, 0, l1]; ω3 = x through [0, 0, l1 + l2]."""
        l1, l2 = L["l1"], L["l2"]
        return columns([0, 0, 0, 0, 0, 1], [0, l1, 0, 1, 0, 0], [0, l1 + l2, 0, 1, 0, 0])

    def denavit_hartenberg(self, q: Array, L: Lengths) -> Array:
        """The standard rows (θ, d, a, α), shape (3, 4)."""
        return rows(
            [q[0] + pi / 2, L["l1"], 0, pi / 2],
            [q[1] + pi / 2, 0, L["l2"], 0],
            [q[2], 0, L["l3"], 0],
        )

    def fk(self, q: Array, L: Lengths) -> Array:
        """g(θ)."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        c23, s23 = cos(q[1] + q[2]), sin(q[1] + q[2])
        l1, l2, l3 = L["l1"], L["l2"], L["l3"]
        u, w = l2 * s2 + l3 * s23, l2 * c2 + l3 * c23
        return rows(
            [s1 * s23, s1 * c23, c1, u * s1],
            [-c1 * s23, -c1 * c23, s1, -u * c1],
            [c23, -s23, 0, l1 + w],
            [0, 0, 0, 1],
        )

    def jacobian_hybrid(self, q: Array, L: Lengths) -> Array:
        """J^h, the geometric Jacobian."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        c23, s23 = cos(q[1] + q[2]), sin(q[1] + q[2])
        l2, l3 = L["l2"], L["l3"]
        u, w = l2 * s2 + l3 * s23, l2 * c2 + l3 * c23
        return rows(
            [u * c1, w * s1, l3 * s1 * c23],
            [u * s1, -w * c1, -l3 * c1 * c23],
            [0, -u, -l3 * s23],
            [0, c1, c1],
            [0, s1, s1],
            [1, 0, 0],
        )

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """J^b."""
        s2, c3, s3 = sin(q[1]), cos(q[2]), sin(q[2])
        c23, s23 = cos(q[1] + q[2]), sin(q[1] + q[2])
        l2, l3 = L["l2"], L["l3"]
        u = l2 * s2 + l3 * s23
        return rows(
            [0, l2 * s3, 0],
            [0, l2 * c3 + l3, l3],
            [u, 0, 0],
            [c23, 0, 0],
            [-s23, 0, 0],
            [0, 1, 1],
        )

    def given_rates(self, t: float) -> Array:
        """The given θ̇(t) for 0 ≤ t ≤ 16 s. It jumps at t = 1, 5 and 6, as printed."""
        if t <= 1:
            return vector(0, 0, 0)
        if t <= 5:
            return vector(0.1 * t, 0.1, 0.1 * t)
        if t <= 6:
            return vector(0.3, 0.1 - 0.01 * (t - 5), 0.3)
        return vector(0.3 - 0.1 * (t - 5), 0.1 - 0.01 * (t - 5), 0.3 - 0.1 * (t - 5))


class OneJoint(Arm):
    """Velocities lecture, one revolute joint."""

    robot = "one_joint"
    lengths = ("l1", "l2")
    joints = 1

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return pose(np.eye(3), vector(L["l1"] + L["l2"], 0, 0))

    def twists(self, L: Lengths) -> Array:
        """ω = z through [l1, 0, 0]."""
        return columns([0, -L["l1"], 0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """g = (Rz(θ1), [l1 + l2c1, l2s1, 0])."""
        c1, s1 = cos(q[0]), sin(q[0])
        l1, l2 = L["l1"], L["l2"]
        return rows([c1, -s1, 0, l1 + l2 * c1], [s1, c1, 0, l2 * s1], [0, 0, 1, 0], [0, 0, 0, 1])

    def spatial_velocity(self, q: Array, qd: Array, L: Lengths) -> Array:
        """V^s."""
        l1, d1 = L["l1"], qd[0]
        return vector(0, -l1 * d1, 0, 0, 0, d1)

    def body_velocity(self, q: Array, qd: Array, L: Lengths) -> Array:
        """V^b."""
        l2, d1 = L["l2"], qd[0]
        return vector(0, l2 * d1, 0, 0, 0, d1)

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """V^s = J^s θ̇1."""
        return columns([0, -L["l1"], 0, 0, 0, 1])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """V^b = J^b θ̇1."""
        return columns([0, L["l2"], 0, 0, 0, 1])

    def adjoint_block(self, q: Array, L: Lengths) -> Array:
        """p̂R, the top right block of Ad_g."""
        c1, s1 = cos(q[0]), sin(q[0])
        l1, l2 = L["l1"], L["l2"]
        return rows([0, 0, l2 * s1], [0, 0, -(l1 + l2 * c1)], [l1 * s1, l1 * c1 + l2, 0])

    def tool_velocity_in_base(self, q: Array, qd: Array, L: Lengths) -> Array:
        """v_A = V̂^s q_A = ġg⁻¹ q_A of the tool's origin."""
        c1, s1 = cos(q[0]), sin(q[0])
        l2, d1 = L["l2"], qd[0]
        return vector(-l2 * s1 * d1, l2 * c1 * d1, 0)

    def tool_velocity_in_tool(self, q: Array, qd: Array, L: Lengths) -> Array:
        """v_B = V̂^b q_B = g⁻¹ġ q_B of the tool's origin."""
        return vector(0, L["l2"] * qd[0], 0)


class TwoJoint(Arm):
    """Velocities lecture, two revolute joints. Frames W, A, B, C = base, first joint, second joint, tool.

    A turns with joint 1, B with joint 2, C is fixed to B.
    """

    robot = "two_joint"
    lengths = ("l0", "l1", "l2")
    joints = 2
    links: ClassVar[dict[str, str]] = {"W": "base", "A": "A", "B": "B", "C": "tool"}

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return pose(np.eye(3), vector(0, L["l0"] + L["l1"] + L["l2"], 0))

    def twists(self, L: Lengths) -> Array:
        """ω = z through [0, l0, 0] and [0, l0 + l1, 0]."""
        l0, l1 = L["l0"], L["l1"]
        return columns([l0, 0, 0, 0, 0, 1], [l0 + l1, 0, 0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """g_WC."""
        c1, s1 = cos(q[0]), sin(q[0])
        c12, s12 = cos(q[0] + q[1]), sin(q[0] + q[1])
        l0, l1, l2 = L["l0"], L["l1"], L["l2"]
        return rows(
            [c12, -s12, 0, -l1 * s1 - l2 * s12],
            [s12, c12, 0, l0 + l1 * c1 + l2 * c12],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        )

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """J^s."""
        c1, s1 = cos(q[0]), sin(q[0])
        l0, l1 = L["l0"], L["l1"]
        return columns([l0, 0, 0, 0, 0, 1], [l0 + l1 * c1, l1 * s1, 0, 0, 0, 1])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """J^b."""
        c2, s2 = cos(q[1]), sin(q[1])
        l1, l2 = L["l1"], L["l2"]
        return columns([-l1 * c2 - l2, l1 * s2, 0, 0, 0, 1], [-l2, 0, 0, 0, 0, 1])

    def poses(self, q: Array, L: Lengths) -> dict[str, Array]:
        """g_WA, g_AB, g_BC of the chain, and g_WB, g_AC, g_WC across it, by the letters of their frames."""
        c1, s1, c2, s2 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1])
        R1, R2, R12 = Rz(q[0]), Rz(q[1]), Rz(q[0] + q[1])
        l0, l1, l2 = L["l0"], L["l1"], L["l2"]
        return {
            "WA": pose(R1, vector(0, l0, 0)),
            "AB": pose(R2, vector(0, l1, 0)),
            "BC": pose(np.eye(3), vector(0, l2, 0)),
            "WB": pose(R12, vector(-l1 * s1, l0 + l1 * c1, 0)),
            "AC": pose(R2, vector(-l2 * s2, l1 + l2 * c2, 0)),
            "WC": self.fk(q, L),
        }

    def spatial_velocities(self, q: Array, qd: Array, L: Lengths) -> dict[str, Array]:
        """V^s of the same pairs; for a chain of frames X, Y, Z: V_XZ^s = V_XY^s + Ad_{g_XY} V_YZ^s."""
        c1, s1 = cos(q[0]), sin(q[0])
        d1, d2 = qd
        l0, l1 = L["l0"], L["l1"]
        joint1 = vector(l0, 0, 0, 0, 0, 1) * d1
        joint2 = vector(l0 + l1 * c1, l1 * s1, 0, 0, 0, 1) * d2
        return {
            "WA": joint1,
            "AB": vector(l1, 0, 0, 0, 0, 1) * d2,
            "BC": np.zeros(6),
            "WB": joint1 + joint2,
            "AC": vector(l1, 0, 0, 0, 0, 1) * d2,
            "WC": joint1 + joint2,
        }

    def body_velocities(self, q: Array, qd: Array, L: Lengths) -> dict[str, Array]:
        """V^b of the same pairs; for a chain of frames X, Y, Z: V_XZ^b = Ad_{g_YZ}⁻¹ V_XY^b + V_YZ^b."""
        c2, s2 = cos(q[1]), sin(q[1])
        d1, d2 = qd
        l1, l2 = L["l1"], L["l2"]
        return {
            "WA": vector(0, 0, 0, 0, 0, 1) * d1,
            "AB": vector(0, 0, 0, 0, 0, 1) * d2,
            "BC": np.zeros(6),
            "WB": vector(-l1 * c2, l1 * s2, 0, 0, 0, 1) * d1 + vector(0, 0, 0, 0, 0, 1) * d2,
            "AC": vector(-l2, 0, 0, 0, 0, 1) * d2,
            "WC": vector(-l1 * c2 - l2, l1 * s2, 0, 0, 0, 1) * d1 + vector(-l2, 0, 0, 0, 0, 1) * d2,
        }

    def tip_velocity_straight(self, qd: Array, L: Lengths) -> Array:
        """The tip's velocity in W at θ1 = 0, θ2 = 0."""
        l1, l2 = L["l1"], L["l2"]
        return vector(-(l1 + l2) * qd[0] - l2 * qd[1], 0, 0)

    def tip_velocity_turned(self, qd: Array, L: Lengths) -> Array:
        """The tip's velocity in W at θ1 = π/2, θ2 = 0."""
        l1, l2 = L["l1"], L["l2"]
        return vector(0, -(l1 + l2) * qd[0] - l2 * qd[1], 0)

    def tip_velocity_in_tip(self, qd: Array, L: Lengths) -> Array:
        """The tip's velocity in frame C at θ2 = π/2, any θ1."""
        l1, l2 = L["l1"], L["l2"]
        return vector(-l2 * (qd[0] + qd[1]), l1 * qd[0], 0)


class GearPair(Arm):
    """Robotics, assignment 2, question 10: spur gears of module 2 mm. q is the angle of the driver."""

    robot = "gear_pair"
    lengths = ("N1", "N2")
    joints = 1

    def ratio(self, L: Lengths) -> float:
        """Angle of the driven gear over that of the driver."""
        return -L["N1"] / L["N2"]

    def centre_distance(self, L: Lengths) -> float:
        """Sum of the pitch radii."""
        return 0.001 * (L["N1"] + L["N2"])

    def home(self, L: Lengths) -> Array:
        """g(0)."""
        return pose(np.eye(3), vector(self.centre_distance(L), 0, 0))

    def twists(self, L: Lengths) -> Array:
        """The driven gear's axis z through [a, 0, 0], times the ratio."""
        a, k = self.centre_distance(L), self.ratio(L)
        return columns([0, -a * k, 0, 0, 0, k])

    def driver(self, q: Array, L: Lengths) -> Array:
        """The pose of the driver, frame gear1."""
        return pose(Rz(q[0]), vector(0, 0, 0))

    def driver_twist(self) -> Array:
        """The twist of the driver."""
        return columns([0, 0, 0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """g(θ)."""
        return pose(Rz(self.ratio(L) * q[0]), vector(self.centre_distance(L), 0, 0))

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """The tool's one twist."""
        a, k = self.centre_distance(L), self.ratio(L)
        return columns([0, -a * k, 0, 0, 0, k])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """The tool sits on the axis."""
        return columns([0, 0, 0, 0, 0, self.ratio(L)])


class BevelPair(Arm):
    """Robotics, assignment 2, question 10: bevel gears of module 2 mm, axes z and x through the origin."""

    robot = "bevel_pair"
    lengths = ("N1", "N2")
    joints = 1

    def ratio(self, L: Lengths) -> float:
        """Angle of the driven gear over that of the driver."""
        return -L["N1"] / L["N2"]

    def home(self, L: Lengths) -> Array:
        """g(0): the driven gear lies one pitch radius of the driver from the apex."""
        return pose(np.eye(3), vector(0.001 * L["N1"], 0, 0))

    def twists(self, L: Lengths) -> Array:
        """The driven gear's axis x through 0, times the ratio."""
        return columns([0, 0, 0, self.ratio(L), 0, 0])

    def driver(self, q: Array, L: Lengths) -> Array:
        """The pose of the driver, frame gear1, one pitch radius of the driven gear from the apex."""
        return pose(Rz(q[0]), vector(0, 0, 0.001 * L["N2"]))

    def driver_twist(self) -> Array:
        """The twist of the driver."""
        return columns([0, 0, 0, 0, 0, 1])

    def fk(self, q: Array, L: Lengths) -> Array:
        """g(θ)."""
        return pose(Rx(self.ratio(L) * q[0]), vector(0.001 * L["N1"], 0, 0))

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """The tool's one twist."""
        return columns([0, 0, 0, self.ratio(L), 0, 0])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """The tool sits on the axis."""
        return columns([0, 0, 0, self.ratio(L), 0, 0])


class LeadScrew(Arm):
    """Robotics, assignment 2, question 10: one twist of pitch h = lead/2π. q is the angle of the screw."""

    robot = "lead_screw"
    lengths = ("lead",)
    joints = 1

    def pitch(self, L: Lengths) -> float:
        """h, in metres per radian."""
        return L["lead"] / (2 * pi)

    def home(self, L: Lengths) -> Array:
        """g(0) = I."""
        return np.eye(4)

    def twists(self, L: Lengths) -> Array:
        """ξ = (hω, ω), ω = z through 0."""
        return columns([0, 0, self.pitch(L), 0, 0, 1])

    def handwheel(self, q: Array) -> Array:
        """The pose of the part that turns in place, frame screw."""
        return pose(Rz(q[0]), vector(0, 0, 0))

    def fk(self, q: Array, L: Lengths) -> Array:
        """g = (Rz(θ), [0, 0, hθ])."""
        return pose(Rz(q[0]), vector(0, 0, self.pitch(L) * q[0]))

    def jacobian_spatial(self, q: Array, L: Lengths) -> Array:
        """The tool's one twist."""
        return columns([0, 0, self.pitch(L), 0, 0, 1])

    def jacobian_body(self, q: Array, L: Lengths) -> Array:
        """The same: a screw motion commutes with its own twist."""
        return columns([0, 0, self.pitch(L), 0, 0, 1])


ARMS: tuple[Arm, ...] = (
    SphericalRRP(),
    Planar2RBase(),
    Planar2RTip(),
    ScaraRRP(),
    StanfordRRP(),
    PlanarRRR(),
    Drone(),
    AnthropomorphicRRR(),
    OneJoint(),
    TwoJoint(),
    GearPair(),
    BevelPair(),
    LeadScrew(),
)
