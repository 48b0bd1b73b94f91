"""Pictures of workspaces: what is drawn where, in which colours, with which words."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.distance import cdist

import pinscrew as ps
import urdfs
from pinscrew.ground.errors import InputError, MissingExtraError
from pinscrew.view import figures, plot_workspace
from pinscrew.workspace.comparison import from_reference
from pinscrew.workspace.density import density, dimensions
from pinscrew.workspace.voxels import Voxels, voxel_keys


@cache
def a2() -> ps.Sweep:
    return ps.sweep(ps.load("planar_2r"))


def offsets(collection: Any) -> np.ndarray:
    return np.asarray(collection.get_offsets())


def by_rows(points: np.ndarray) -> np.ndarray:
    """Points in an order that does not depend on how they came."""
    return points[np.lexsort(points.T[::-1])]


def test_a2_is_drawn_in_its_plane_with_equal_axes() -> None:
    figure = plot_workspace.plot_sweep(a2())
    axes, bar = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("y [m]", "z [m]")
    assert axes.get_aspect() == 1.0
    assert bar.get_ylabel() == "points per m²"
    np.testing.assert_array_equal(by_rows(offsets(axes.collections[0])), by_rows(a2().positions[:, 1:]))


@pytest.mark.parametrize(
    ("colour", "label"),
    [
        ("manipulability", "manipulability of translation, σ₁σ₂ [m²/rad²]"),
        ("condition", "condition number of translation, σ₁/σ₂"),
        ("singularity", "distance to singularity, σ₂ [m/rad]"),
    ],
)
def test_colours_tell_what_they_say(colour: str, label: str) -> None:
    figure = plot_workspace.plot_sweep(a2(), colour)
    axes, bar = figure.axes
    assert bar.get_ylabel() == label
    measures = a2().translation
    truth = {
        "manipulability": measures.manipulability,
        "condition": np.minimum(measures.condition, 1e3),
        "singularity": measures.smallest,
    }
    np.testing.assert_array_equal(axes.collections[0].get_array(), np.sort(truth[colour]))


def test_both_choices_are_drawn_over_each_other() -> None:
    robot = ps.load("planar_2r")
    others = from_reference(robot, a2().q, "tool", "frame0")[:, :3, 3]
    figure = plot_workspace.plot_comparison(a2(), others, "frame0")
    (axes,) = figure.axes
    crosses, circles = axes.collections
    np.testing.assert_array_equal(offsets(crosses), a2().positions[:, 1:])
    np.testing.assert_array_equal(offsets(circles), others[:, 1:])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [
        "frame 0 at base",
        "frame 0 at frame0, brought to base",
    ]
    assert "distance between × and ○" in figure.get_suptitle()
    moved = plot_workspace.plot_comparison(a2(), others + 0.25, "frame0")
    assert moved.get_suptitle().endswith(": 4.3e-01 m")


def test_space_is_drawn_from_three_sides_and_in_perspective() -> None:
    swept = ps.sweep(ps.load("scara"), samples=64)
    figure = plot_workspace.plot_sweep(swept, "manipulability")
    *sides, space, bar = figure.axes
    assert [(axes.get_xlabel(), axes.get_ylabel()) for axes in sides] == [
        ("x [m]", "z [m]"),
        ("y [m]", "z [m]"),
        ("x [m]", "y [m]"),
    ]
    for axes, columns in zip(sides, ([0, 2], [1, 2], [0, 1]), strict=True):
        assert axes.get_aspect() == 1.0
        drawn = by_rows(offsets(axes.collections[0]))
        np.testing.assert_array_equal(drawn, by_rows(swept.positions[:, columns]))
    assert space.name == "3d"
    assert bar.get_ylabel() == "manipulability of translation, σ₁σ₂σ₃ [m³ per (rad or m)³]"


def test_a_plane_that_is_none_of_the_base() -> None:
    """The two directions in it are named by their vectors."""
    joint = urdfs.joint("j", "revolute", "base", "mid", rpy="0.5 0.3 0")
    arm = urdfs.load(urdfs.robot(joint, urdfs.joint("m", "fixed", "mid", "tool", xyz="1 0 0"), links="base mid tool"))
    swept = ps.sweep(arm, grid=0.1)
    axes = plot_workspace.plot_sweep(swept).axes[0]
    assert axes.get_xlabel().startswith("along (")
    np.testing.assert_allclose(np.linalg.norm(offsets(axes.collections[0]), axis=1), 1.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", ["lead_screw", "one_joint"])
def test_lines_and_circles(name: str, tmp_path: Path) -> None:
    swept = ps.sweep(ps.load(name), samples=16)
    for colour in plot_workspace.SWEEP_COLOURS:
        figure = plot_workspace.plot_sweep(swept, colour)
        assert len(offsets(figure.axes[0].collections[0])) == 16
    figures.save(figure, tmp_path / "a.png")
    with Image.open(tmp_path / "a.png") as image:
        assert image.width > 300


def test_many_points_are_thinned() -> None:
    swept = ps.sweep(ps.load("planar_2r"), samples=25_000)
    figure = plot_workspace.plot_sweep(swept)
    assert len(offsets(figure.axes[0].collections[0])) == 20_000
    assert figure.get_suptitle().endswith("sample of 25000, 20000 drawn")
    whole, _ = density(swept.positions)
    thinned = np.asarray(figure.axes[0].collections[0].get_array())
    np.testing.assert_allclose(np.median(thinned), np.median(whole), rtol=0.02)


def reached(points: np.ndarray, best: np.ndarray) -> ps.ReachabilityMap:
    """A map of a voxel for each point."""
    n = len(points)
    voxels = Voxels.reduced([Voxels(voxel_keys(points, 0.1), np.full(n, 2), best, np.full(n, 3, np.uint64))])
    meta = {"robot": "arm", "frame": "tool", "voxel": 0.1, "samples": 9, "rank": 3, "units": {"j": "rad"}}
    return ps.ReachabilityMap(voxels, meta)


def test_maps_show_the_largest_number_behind_each_square() -> None:
    points = np.array([[0.05, 0.05, 0.05], [0.05, 0.15, 0.05], [0.15, 0.05, 0.15], [0.25, 0.35, 0.45]])
    figure = plot_workspace.plot_map(reached(points, np.array([1.0, 5.0, 2.0, 3.0])))
    front = np.asarray(figure.axes[0].collections[0].get_array())  # rows are z, columns x
    assert front.shape == (5, 3)
    assert front[0, 0] == 5.0
    assert front[1, 1] == 2.0
    assert front[4, 2] == 3.0
    assert figure.axes[-1].get_ylabel() == "largest manipulability of translation [m³/rad³]"
    coverage = plot_workspace.plot_map(reached(points, points[:, 0]), "coverage")
    assert coverage.axes[-1].get_ylabel() == "approach directions met [%]"
    shown = coverage.axes[0].collections[0].get_array()
    assert shown is not None
    assert shown.max() == 100.0 * 2 / 64


def test_colours_that_tell_nothing() -> None:
    robot = ps.load("drone")
    roll = ps.sweep(robot, samples=4, ranges={"joint1": (0, 0)})
    assert roll.translation.rank == 1
    points = np.array([[0.0, 0.0, 0.0]])
    for wrong in (
        lambda: plot_workspace.plot_sweep(a2(), "coverage"),
        lambda: plot_workspace.plot_map(reached(points, np.ones(1)), "condition"),
        lambda: plot_workspace.plot_map(reached(points, np.full(1, np.nan))),
        lambda: plot_workspace.plot_sweep(_still(), "manipulability"),
    ):
        with pytest.raises(InputError) as caught:
            wrong()
        assert caught.value.code == "colour"
    figure = plot_workspace.plot_sweep(_still())
    assert figure.axes[1].get_ylabel() == "points per point"


def _still() -> ps.Sweep:
    """An arm that turns its tool about the tool's origin."""
    return ps.sweep(urdfs.load(urdfs.single_revolute()), samples=4)


def test_density_counts_neighbours() -> None:
    """Within 4 % of the extent, by all distances."""
    rng = np.random.default_rng(0)
    for k in (1, 2, 3):
        points = np.zeros((300, 3))
        points[:, :k] = rng.random((300, k))
        points = points @ np.linalg.qr(rng.normal(size=(3, 3)))[0].T
        found, dimension = density(points)
        radius = 0.04 * np.ptp(points, axis=0).max()
        counts = (cdist(points, points) <= radius).sum(axis=1)
        ball = {1: 2 * radius, 2: np.pi * radius**2, 3: 4 / 3 * np.pi * radius**3}[k]
        assert dimension == dimensions(points) == k
        np.testing.assert_allclose(found, counts / ball, rtol=1e-12)


def test_without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.spatial", None)
    with pytest.raises(MissingExtraError, match=r"pinscrew\[workspace\]"):
        plot_workspace.plot_sweep(a2())
