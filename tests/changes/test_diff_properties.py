"""What holds for any two robots: random trees, with a third of their numbers changed by up to a random size."""

from __future__ import annotations

import json
import re
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import pinscrew as ps
import urdfs

ROUNDING = 1e-10
"""m and rad, far above what computed poses of these robots are off by."""
NUMBERS = re.compile(r'(?<=origin xyz=)"[^"]*"|(?<= rpy=)"[^"]*"|(?<= offset=)"[^"]*"')


def shaken(text: str, size: float, rng: np.random.Generator) -> str:
    def other(match: re.Match[str]) -> str:
        if rng.random() < 0.7:
            return match[0]
        values = (float(x) + size * rng.uniform(-1.0, 1.0) for x in match[0].strip('"').split())
        return f'"{" ".join(map(repr, values))}"'

    return NUMBERS.sub(other, text)


def check(text: str, seed: int, size: float, tolerance: tuple[float, float]) -> None:
    length, angle = tolerance
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ps.PinscrewWarning)
        a, b = urdfs.load(text), urdfs.load(shaken(text, size, np.random.default_rng(seed)))
    there, back = (ps.diff(*pair, length=length, angle=angle) for pair in ((a, b), (b, a)))
    assert there.same is back.same
    if there.same and there.displacement is not None:
        assert there.displacement.length <= max(length, ROUNDING)
        assert there.displacement.angle <= max(angle, ROUNDING)
    for change in (*there.changes, *there.notes):
        told = re.search(r"from (.*) to (.*?)(;|,|$)", change.words)
        assert told is None or told[1] != told[2], change.words
    assert json.loads(there.to_json())["same"] is there.same


TOLERANCES = st.tuples(*[st.sampled_from([1e-9, 1e-6, 1e-3, 0.1])] * 2)
SIZES = st.sampled_from([1e-8, 1e-6, 1e-4, 1e-2, 0.3])
ANY = given(urdfs.trees(), st.integers(0, 10**6), SIZES, TOLERANCES)


@settings(max_examples=40, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@ANY
def test_never_the_same_beside_a_displacement(
    text: str, seed: int, size: float, tolerance: tuple[float, float]
) -> None:
    check(text, seed, size, tolerance)


@pytest.mark.slow
@settings(max_examples=1500, deadline=None, suppress_health_check=list(HealthCheck))
@ANY
def test_never_the_same_beside_a_displacement_at_length(
    text: str, seed: int, size: float, tolerance: tuple[float, float]
) -> None:
    check(text, seed, size, tolerance)
