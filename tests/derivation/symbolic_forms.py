"""The closed forms of the courseworks A1–A10 in sympy, typed in from the assignments, errata corrected.

A formula here is the truth that derivations are held against: never fit it to code.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import sympy as sp

import pinscrew as ps
from pinscrew.derivation.derivation import Derivation

__all__ = ["FORMS", "derivation", "names"]


@cache
def derivation(robot: str, tip: str | None = None) -> Derivation:
    return ps.derive(ps.load(robot), tip)


class Names:
    """Lengths, θ1, d1 = θ̇1, c12 = cos(θ1 + θ2) and so on, as attributes."""

    def __init__(self, d: Derivation) -> None:
        self._known = {str(s): s for s in d.lengths}
        for variable in d.variables:
            self._known[f"t{variable.label}"] = variable.symbol
            self._known[f"d{variable.label}"] = variable.rate

    def __getattr__(self, name: str) -> Any:
        if name in self._known:
            return self._known[name]
        if name[0] in "cs" and name[1:].isdigit():
            angle = sum(self._known[f"t{i}"] for i in name[1:])
            return sp.cos(angle) if name[0] == "c" else sp.sin(angle)
        raise AttributeError(name)


def names(d: Derivation) -> Any:
    return Names(d)


def M(text: str, n: Any) -> sp.Matrix:
    """A matrix from rows between semicolons and entries between bars."""
    return sp.Matrix([[_entry(x, n) for x in row.split("|")] for row in text.split(";")])


def _entry(text: str, n: Any) -> Any:
    code = compile(text.strip(), "<entry>", "eval")
    return sp.sympify(eval(code, {"__builtins__": {}}, {name: getattr(n, name) for name in code.co_names}))  # noqa: S307 (our own formulas)


# (robot, tip): what is held against the text; rows between semicolons.
FORMS: dict[tuple[str, str | None], dict[str, str]] = {
    ("spherical_rrp", None): {
        "home": "1|0|0|0 ; 0|1|0|L3 ; 0|0|1|L0 ; 0|0|0|1",
        "twists": "0|0|0 ; 0|-L0|1 ; 0|0|0 ; 0|-1|0 ; 0|0|0 ; 1|0|0",
        "exponential 1": "c1|-s1|0|0 ; s1|c1|0|0 ; 0|0|1|0 ; 0|0|0|1",
        "exponential 2": "1|0|0|0 ; 0|c2|s2|-L0*s2 ; 0|-s2|c2|L0*(1-c2) ; 0|0|0|1",
        "exponential 3": "1|0|0|0 ; 0|1|0|t3 ; 0|0|1|0 ; 0|0|0|1",
        "pose": "c1|-s1*c2|-s1*s2|-(L3+t3)*s1*c2 ; s1|c1*c2|c1*s2|(L3+t3)*c1*c2 ; 0|-s2|c2|L0-(L3+t3)*s2 ; 0|0|0|1",
        "rate 1": "-s1*d1|-c1*c2*d1|-c1*s2*d1|-(L3+t3)*c1*c2*d1 ; c1*d1|-s1*c2*d1|-s1*s2*d1|-(L3+t3)*s1*c2*d1"
        " ; 0|0|0|0 ; 0|0|0|0",
        "rate 2": "0|s1*s2*d2|-s1*c2*d2|(L3+t3)*s1*s2*d2 ; 0|-c1*s2*d2|c1*c2*d2|-(L3+t3)*c1*s2*d2"
        " ; 0|-c2*d2|-s2*d2|-(L3+t3)*c2*d2 ; 0|0|0|0",
        "rate 3": "0|0|0|-s1*c2*d3 ; 0|0|0|c1*c2*d3 ; 0|0|0|-s2*d3 ; 0|0|0|0",
        "inverse": "c1|s1|0|0 ; -s1*c2|c1*c2|-s2|L0*s2-(L3+t3) ; -s1*s2|c1*s2|c2|-L0*c2 ; 0|0|0|1",
        "body hat": "0|-c2*d1|-s2*d1|-(L3+t3)*c2*d1 ; c2*d1|0|d2|d3 ; s2*d1|-d2|0|-(L3+t3)*d2 ; 0|0|0|0",
        "body velocity": "-(L3+t3)*c2*d1 ; d3 ; -(L3+t3)*d2 ; -d2 ; -s2*d1 ; c2*d1",
        "body": "-(L3+t3)*c2|0|0 ; 0|0|1 ; 0|-(L3+t3)|0 ; 0|-1|0 ; -s2|0|0 ; c2|0|0",
        "hybrid velocity": "(L3+t3)*(s1*s2*d2-c1*c2*d1)-s1*c2*d3 ; -(L3+t3)*(s1*c2*d1+c1*s2*d2)+c1*c2*d3"
        " ; -(L3+t3)*c2*d2-s2*d3 ; -c1*d2 ; -s1*d2 ; d1",
        "spatial": "0|L0*s1|-s1*c2 ; 0|-L0*c1|c1*c2 ; 0|0|-s2 ; 0|-c1|0 ; 0|-s1|0 ; 1|0|0",
    },
    ("planar_2r", None): {
        "home": "0|0|1|-1 ; 0|1|0|1 ; -1|0|0|0 ; 0|0|0|1",
        "twists": "0|0 ; 1|1 ; 0|-1 ; 1|1 ; 0|0 ; 0|0",
        "pose": "0|0|1|-1 ; s12|c12|0|c1+s12 ; -c12|s12|0|1+s1-c12 ; 0|0|0|1",
        "spatial": "0|0 ; 1|1+s1 ; 0|-c1 ; 1|1 ; 0|0 ; 0|0",
        "body": "-c2|0 ; 1+s2|1 ; 0|0 ; 0|0 ; 0|0 ; 1|1",
    },
    ("scara_rrp", None): {
        "position": "l1*c1+l2*c12 ; l1*s1+l2*s12 ; -t3",
        "hybrid": "-l1*s1-l2*s12|-l2*s12|0 ; l1*c1+l2*c12|l2*c12|0 ; 0|0|-1 ; 0|0|0 ; 0|0|0 ; 1|1|0",
    },
    ("stanford_rrp", None): {
        "rotation home": "0|0|1 ; 1|0|0 ; 0|1|0",
        "position": "t3*c1*c2+l2*s1 ; t3*s1*c2-l2*c1 ; t3*s2+l1",
        "hybrid": "-t3*s1*c2+l2*c1|-t3*c1*s2|c1*c2 ; t3*c1*c2+l2*s1|-t3*s1*s2|s1*c2 ; 0|t3*c2|s2 ; 0|s1|0"
        " ; 0|-c1|0 ; 1|0|0",
        "body": "t3*c2|0|0 ; -l2*s2|t3|0 ; l2*c2|0|1 ; 0|-1|0 ; c2|0|0 ; s2|0|0",
    },
    ("planar_rrr", None): {
        "position": "l1*c1+l2*c12+l3*c123 ; l1*s1+l2*s12+l3*s123 ; 0",
        "hybrid": "-(l1*s1+l2*s12+l3*s123)|-(l2*s12+l3*s123)|-l3*s123 ; l1*c1+l2*c12+l3*c123|l2*c12+l3*c123|l3*c123"
        " ; 0|0|0 ; 0|0|0 ; 0|0|0 ; 1|1|1",
        "body": "l1*s23+l2*s3|l2*s3|0 ; l1*c23+l2*c3+l3|l2*c3+l3|l3 ; 0|0|0 ; 0|0|0 ; 0|0|0 ; 1|1|1",
    },
    ("drone", "tool"): {
        "pose": "c3|-s3|0|0 ; c2*s3|c2*c3|-s2|0 ; s2*s3|s2*c3|c2|t1 ; 0|0|0|1",
    },
    ("drone", "obstacle"): {
        "position": "0 ; -3*s2 ; t1+3*c2",
    },
    ("anthropomorphic_rrr", None): {
        "home": "0|0|1|0 ; 0|-1|0|0 ; 1|0|0|l1+l2+l3 ; 0|0|0|1",
        "twists": "0|0|0 ; 0|l1|l1+l2 ; 0|0|0 ; 0|1|1 ; 0|0|0 ; 1|0|0",
        "pose": "s1*s23|s1*c23|c1|(l2*s2+l3*s23)*s1 ; -c1*s23|-c1*c23|s1|-(l2*s2+l3*s23)*c1"
        " ; c23|-s23|0|l1+l2*c2+l3*c23 ; 0|0|0|1",
        "hybrid": "(l2*s2+l3*s23)*c1|(l2*c2+l3*c23)*s1|l3*s1*c23 ; (l2*s2+l3*s23)*s1|-(l2*c2+l3*c23)*c1|-l3*c1*c23"
        " ; 0|-(l2*s2+l3*s23)|-l3*s23 ; 0|c1|c1 ; 0|s1|s1 ; 1|0|0",
        "body": "0|l2*s3|0 ; 0|l2*c3+l3|l3 ; l2*s2+l3*s23|0|0 ; c23|0|0 ; -s23|0|0 ; 0|1|1",
    },
    ("one_joint", None): {
        "pose": "c1|-s1|0|l1+l2*c1 ; s1|c1|0|l2*s1 ; 0|0|1|0 ; 0|0|0|1",
        "spatial velocity": "0 ; -l1*d1 ; 0 ; 0 ; 0 ; d1",
        "body velocity": "0 ; l2*d1 ; 0 ; 0 ; 0 ; d1",
        "adjoint corner": "0|0|l2*s1 ; 0|0|-(l1+l2*c1) ; l1*s1|l1*c1+l2|0",
    },
    ("two_joint", None): {
        "twists": "l0|l0+l1 ; 0|0 ; 0|0 ; 0|0 ; 0|0 ; 1|1",
        "pose": "c12|-s12|0|-l1*s1-l2*s12 ; s12|c12|0|l0+l1*c1+l2*c12 ; 0|0|1|0 ; 0|0|0|1",
        "spatial": "l0|l0+l1*c1 ; 0|l1*s1 ; 0|0 ; 0|0 ; 0|0 ; 1|1",
        "body": "-l1*c2-l2|-l2 ; l1*s2|0 ; 0|0 ; 0|0 ; 0|0 ; 1|1",
    },
}


def expected(robot: str, tip: str | None, what: str) -> sp.Matrix:
    return M(FORMS[robot, tip][what], names(derivation(robot, tip)))


def derived(d: Derivation, what: str) -> sp.Matrix:
    """The derivation's own of what a key of `FORMS` says."""
    word, _, index = what.partition(" ")
    found = {
        "home": lambda: d.home,
        "rotation home": lambda: d.home[:3, :3],
        "twists": lambda: sp.Matrix.hstack(*(screw.twist for screw in d.screws)),
        "pose": lambda: d.pose,
        "position": lambda: d.pose[:3, 3],
        "inverse": lambda: d.inverse,
        "body hat": lambda: d.body_hat,
        "body velocity": lambda: d.body_velocity,
        "spatial velocity": lambda: d.spatial_velocity,
        "hybrid velocity": lambda: d.hybrid_velocity,
        "adjoint corner": lambda: d.adjoint[:3, 3:],
        "spatial": lambda: d.jacobian("spatial"),
        "body": lambda: d.jacobian("body"),
        "hybrid": lambda: d.jacobian("hybrid"),
    }
    if what in found:
        return found[what]()
    return {"exponential": d.exponentials, "rate": d.pose_rates}[word][int(index) - 1]
