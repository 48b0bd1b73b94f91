"""Random arms: the closed forms equal both engines at 1e-12, whatever the angles."""

import pytest
from random_arms import random_arm

import pinscrew as ps
import urdfs

ANGLES = ("30", "45", "any")
SMALL = [("30", 3, 0), ("45", 3, 0), ("any", 3, 0), ("30", 4, 1), ("45", 4, 0), ("any", 4, 0)]
LARGE = [(angles, joints, seed) for angles in ANGLES for joints in (3, 4, 5, 6) for seed in range(1, 4)]


def check(angles: str, joints: int, seed: int) -> None:
    d = ps.derive(urdfs.load(random_arm(100 * joints + seed, joints, angles)))
    assert d.exact == (angles != "any")
    assert not d.snapped
    proof = d.prove(20, seed)
    assert proof.ok, [c for c in proof.comparisons if not c.ok]
    assert all(c.tolerance <= 1e-12 for c in proof.comparisons)


@pytest.mark.parametrize(("angles", "joints", "seed"), SMALL)
def test_small(angles: str, joints: int, seed: int) -> None:
    check(angles, joints, seed)


@pytest.mark.slow
@pytest.mark.parametrize(("angles", "joints", "seed"), LARGE)
def test_large(angles: str, joints: int, seed: int) -> None:
    check(angles, joints, seed)


def test_six_joints() -> None:
    """A UR5: three parallel axes, printed to 11 digits."""
    d = ps.derive(ps.load("ur5_robot"), "tool0", symbols=True)
    assert d.exact
    proof = d.prove(20)
    assert proof.ok
    assert proof.largest < 1e-13
    assert "c234" in {str(s) for s in d.pose.free_symbols}
