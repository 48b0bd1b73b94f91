"""Measure derivations against sympy's own ``simplify`` on the same product, ratios first.

    python scripts/bench_derive.py [--patience SECONDS]

sympy gets what a person would give it: the product of the exponentials with cos and sin in it, and the Jacobian
whose columns are adjoints of partial products, each entry simplified. It is stopped when its patience is over.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import platform
import queue
import time
from typing import Any, Final

import sympy as sp

import pinscrew as ps
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.factoring import operations
from pinscrew.description import urdf

PUMA: Final = """<robot name="puma"><link name="base"/>{links}{joints}</robot>"""
# Murray, Li and Sastry's elbow arm with an offset and a spherical wrist, as a Puma's: origin and axis of each joint.
_PUMA_JOINTS: Final = (
    ("0 0 0.672", "0 0 1"),
    ("0 0.14 0", "0 -1 0"),
    ("0.432 0 0", "0 -1 0"),
    ("0.02 0 0.433", "0 0 1"),
    ("0 0 0", "0 -1 0"),
    ("0 0 0", "0 0 1"),
)

GOALS: Final = {"ur5": 3.0, "puma": 3.0, "panda": 10.0}


def puma() -> ps.Robot:
    """A Puma-type 6R."""
    links = "".join(f'<link name="l{i}"/>' for i in range(1, 7))
    limit = '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="{"base" if i == 1 else f"l{i - 1}"}"/>'
        f'<child link="l{i}"/><origin xyz="{xyz}"/><axis xyz="{axis}"/>{limit}</joint>'
        for i, (xyz, axis) in enumerate(_PUMA_JOINTS, 1)
    )
    return ps.Robot.from_description(urdf.parse(PUMA.format(links=links, joints=joints), "puma"))


def derived(robot: ps.Robot, tip: str | None) -> tuple[float, Derivation, list[int]]:
    """Seconds for FK, J^s and J^b in symbols, and operations in each."""
    start = time.perf_counter()
    d = ps.derive(robot, tip, symbols=True)
    matrices = d.pose, d.jacobian("spatial"), d.jacobian("body")
    seconds = time.perf_counter() - start
    return seconds, d, [sum(map(operations, matrix)) for matrix in matrices]


def everything(name: str) -> tuple[float, float]:
    """Seconds for (a) to (k) of a three-joint arm, without and with the proof."""
    from pinscrew.derivation import reports

    robot = ps.load(name)
    start = time.perf_counter()
    d = ps.derive(robot)
    reports.report(d, (proof := d.prove(1)))
    seconds = time.perf_counter() - start
    d.prove(100)
    if not proof.ok:
        raise SystemExit(f"{name}: the proof fails")
    return seconds, time.perf_counter() - start


def simplified(d: Derivation, patience: float) -> tuple[float, list[int]]:
    """Seconds of sympy's simplify on the same three, and the operations it leaves in those that it finished."""
    answers: Any = multiprocessing.get_context("fork").Queue()
    child = multiprocessing.get_context("fork").Process(target=_simplify, args=(d, answers))
    start = time.perf_counter()
    child.start()
    left: list[int] = []
    try:
        while len(left) < 3:
            left.append(answers.get(timeout=max(0.01, start + patience - time.perf_counter())))
    except queue.Empty:
        child.terminate()
    child.join()
    return time.perf_counter() - start, left


def _simplify(d: Derivation, answers: Any) -> None:
    g, columns = sp.eye(4), []
    for screw, joint in zip(d.screws, d.chain.joints, strict=True):
        columns.append(_adjoint(g) * screw.twist)
        g = g * _exponential(screw, joint.variable.symbol)
    g = g * d.home
    spatial = sp.Matrix.hstack(*columns)
    body = _adjoint(_inverse(g)) * spatial
    for matrix in (g, spatial, body):
        answers.put(sum(operations(sp.simplify(entry)) for entry in matrix))


def _exponential(screw: Any, theta: sp.Symbol) -> sp.Matrix:
    g = sp.eye(4)
    if not screw.revolute:
        g[:3, 3] = screw.v * theta
        return g
    w = screw.omega.hat()
    R = sp.eye(3) + sp.sin(theta) * w + (1 - sp.cos(theta)) * w * w
    g[:3, :3], g[:3, 3] = R, (sp.eye(3) - R) * screw.q
    return g


def _inverse(g: sp.Matrix) -> sp.Matrix:
    out = sp.eye(4)
    out[:3, :3], out[:3, 3] = g[:3, :3].T, -g[:3, :3].T * g[:3, 3]
    return out


def _adjoint(g: sp.Matrix) -> sp.Matrix:
    R, corner = g[:3, :3], g[:3, 3].hat() * g[:3, :3]
    return sp.Matrix(sp.BlockMatrix([[R, corner], [sp.zeros(3), R]]))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--patience", type=float, default=120.0, help="seconds that sympy's simplify gets for each arm")
    patience: float = parser.parse_args().patience
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, sympy {sp.__version__}")
    ps.derive(ps.load("one_joint")).prove(1)  # imports are not measured
    print("pose, spatial and body Jacobian in symbols, against sympy.simplify on the same product:", flush=True)
    arms = {
        "ur5": (ps.load("ur5_robot"), "tool0"),
        "puma": (puma(), None),
        "panda": (ps.load("panda"), "panda_hand_tcp"),
    }
    for name, (robot, tip) in arms.items():
        seconds, d, counts = derived(robot, tip)
        slow, left = simplified(d, patience)
        more = "at least " if len(left) < 3 else ""
        print(f"  {name}: {more}{slow / seconds:.0f} times as fast: {seconds:.2f} s", end=" ")
        print(f"(goal: {GOALS[name]:.0f} s) to {more}{slow:.0f} s; operations", end=" ")
        theirs = [*map(str, left), *["not finished"] * (3 - len(left))]
        for what, mine, other in zip(("pose", "spatial", "body"), counts, theirs, strict=True):
            print(f"{what} {mine} to {other}", end="\n" if what == "body" else ", ", flush=True)
    print("three-joint arms, all of (a) to (k) and the report (goal: 2 s); with 100 samples of the proof:")
    for name in ("spherical_rrp", "scara_rrp", "stanford_rrp", "planar_rrr", "anthropomorphic_rrr"):
        seconds, proved = everything(name)
        print(f"  {name}: {seconds:.2f} s; {proved:.2f} s")


if __name__ == "__main__":
    main()
