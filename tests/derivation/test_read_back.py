"""What reports print, read back from their text and compared with both engines: the text is what was proved."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.derivation import reports
from pinscrew.ground.errors import InputError
from pinscrew.ground.typing import FloatArray
from pinscrew.mathtext import evaluate, read_latex_matrix, symbols

LENGTHS: dict[str, dict[str, float]] = {
    "spherical_rrp": {"L0": 0.31, "L3": 0.77},
    "scara_rrp": {"l1": 0.43, "l2": 0.29},
    "stanford_rrp": {"l1": 0.61, "l2": 0.17},
    "planar_rrr": {"l1": 0.53, "l2": 0.41, "l3": 0.37},
    "anthropomorphic_rrr": {"l1": 0.9, "l2": 0.57, "l3": 0.46},
    "one_joint": {"l1": 0.55, "l2": 0.73},
    "two_joint": {"l0": 0.21, "l1": 0.47, "l2": 0.39},
    "planar_2r": {},
    "drone": {},
}
"""Lengths for which no two sums are alike by chance."""
PRINTED = {
    "pose": r"g(\theta)",
    "inverse": "g^{-1}",
    "rate": r"\dot{g}",
    "spatial": "J^{s}",
    "body": "J^{b}",
    "hybrid": "J^{h}",
}
CLOSE = 1e-9


@cache
def text(name: str) -> str:
    derivation = ps.derive(ps.load(name))
    return reports.write(reports.report(derivation, derivation.prove(3)), "markdown")


def printed(markdown: str, quantity: str) -> str:
    """The last matrix of the last formula for a quantity that ends in one."""
    start = re.escape(PRINTED[quantity])
    lines = [
        line for line in markdown.splitlines() if re.match(start + " = ", line) and line.endswith(r"\end{bmatrix}")
    ]
    return lines[-1][lines[-1].rindex(r"\begin{bmatrix}") :]


def value_of(symbol: str, q: FloatArray, qd: FloatArray, lengths: dict[str, float]) -> float:
    """By the textbook's convention: c_12 = cos(θ1 + θ2), whatever the writer's own table says."""
    if match := re.fullmatch(r"([cs])_(\d+)", symbol):
        return float((np.cos if match[1] == "c" else np.sin)(sum(q[int(digit) - 1] for digit in match[2])))
    if match := re.fullmatch(r"(dot )?theta_(\d)", symbol):
        return float((qd if match[1] else q)[int(match[2]) - 1])
    return lengths[symbol.replace("_", "")]


def read_at(matrix: str, q: FloatArray, qd: FloatArray, lengths: dict[str, float]) -> FloatArray:
    rows = read_latex_matrix(matrix)
    return np.array(
        [[float(evaluate(e, {s: value_of(s, q, qd, lengths) for s in symbols(e)})) for e in row] for row in rows]
    )


def true(engine: ps.PoE | ps.Pinocchio, quantity: str, q: FloatArray, qd: FloatArray) -> FloatArray:
    pose = engine.fk(q, "tool")
    if quantity == "pose":
        return pose
    if quantity == "inverse":
        return np.linalg.inv(pose)
    if quantity == "rate":  # ġ = V̂^s g (Murray–Li–Sastry, eq. 2.53)
        return np.asarray(ps.lie.se3.hat(engine.jacobian(q, "tool", "spatial") @ qd) @ pose)
    return engine.jacobian(q, "tool", quantity)


@pytest.mark.parametrize("name", LENGTHS)
def test_every_printed_result_is_what_both_engines_say(name: str) -> None:
    robot = ps.load(name, **LENGTHS[name])
    rng = np.random.default_rng(15)
    for engine in (ps.PoE(robot), ps.Pinocchio(robot)):
        q, qd = rng.uniform(-2.5, 2.5, (2, len(robot.joint_names)))
        for quantity in PRINTED:
            np.testing.assert_allclose(
                read_at(printed(text(name), quantity), q, qd, LENGTHS[name]), true(engine, quantity, q, qd), atol=CLOSE
            )


@pytest.mark.parametrize("name", LENGTHS)
def test_every_matrix_of_entries_can_be_read(name: str) -> None:
    matrices = re.findall(r"\\begin\{bmatrix\}(?:(?!\\begin).)*?\\end\{bmatrix\}", text(name))
    assert len(matrices) > 30
    names = r"\\hat|\\xi|R"  # of matrices within matrices
    for matrix in matrices:
        if not re.search(names, matrix):
            read_latex_matrix(matrix)


@pytest.mark.parametrize(
    ("quantity", "old", "new"),
    [
        ("pose", r"-(L_{3} + \theta_{3}) s_{1} c_{2}", r"-L_{3} + \theta_{3} s_{1} c_{2}"),
        ("body", "-s_{2}", "s_{2}"),
        ("spatial", "L_{0} s_{1}", "L_{0} c_{1}"),
        ("rate", r"-s_{1} \dot{\theta}_{1}", r"-s_{1} \theta_{1}"),
        ("pose", r"-(L_{3}", r"-L_{3}"),
    ],
)
def test_a_lost_parenthesis_sign_or_dot_is_seen(quantity: str, old: str, new: str) -> None:
    name, q, qd = "spherical_rrp", np.array([0.3, -0.8, 0.45]), np.array([0.7, -0.2, 0.9])
    whole = printed(text(name), quantity)
    assert old in whole
    right = true(ps.PoE(ps.load(name, **LENGTHS[name])), quantity, q, qd)
    try:
        wrong = read_at(whole.replace(old, new, 1), q, qd, LENGTHS[name])
    except InputError:
        return  # a parenthesis without its partner is no formula at all
    assert np.abs(wrong - right).max() > 1e-3
