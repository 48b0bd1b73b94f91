"""Each configuration has a name of its own, however few there are."""

from __future__ import annotations

import pytest

import urdfs
from pinscrew.verification.configurations import configurations


@pytest.mark.parametrize(("samples", "random", "far"), [(0, 0, 1), (1, 1, 1), (2, 2, 1), (9, 9, 2)])
def test_labels_are_unique(samples: int, random: int, far: int) -> None:
    where = configurations(urdfs.load(urdfs.single_revolute()), samples, 0)
    assert len(set(where.labels)) == len(where.labels) == len(where.q)
    assert sum(label.startswith("random") for label in where.labels) == random
    assert sum(label.startswith("far outside") for label in where.labels) == far
    assert where.inside == len(where.q) - far
