"""Pictures of workspaces: points in their plane, or in space and from three sides, with equal axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pinscrew.ground.errors import InputError
from pinscrew.ground.escaping import plot
from pinscrew.ground.typing import FloatArray
from pinscrew.view import figures
from pinscrew.workspace.density import density, dimensions
from pinscrew.workspace.measures import Measures, unit
from pinscrew.workspace.reachability_map import ReachabilityMap
from pinscrew.workspace.sweep import Sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["MAP_COLOURS", "SWEEP_COLOURS", "plot_comparison", "plot_map", "plot_sweep"]

SWEEP_COLOURS: Final = ("density", "manipulability", "condition", "singularity")
MAP_COLOURS: Final = ("manipulability", "density", "coverage")

MOST: Final = 20_000
"""Points of a picture: more are one blot."""
WORST_CONDITION: Final = 1e3
"""The largest condition number that has a colour of its own."""
FLAT: Final = 1e-9
"""Extent along an axis, as a part of the distance from the base, that is none."""
_NAMES: Final = "xyz"
_LABELS: Final = tuple(f"{name} [m]" for name in _NAMES)


@dataclass(frozen=True, slots=True)
class _Shading:
    """A number for each point, and what it is."""

    values: FloatArray
    label: str
    logarithmic: bool = False


def plot_sweep(sweep: Sweep, colour: str = "density") -> Figure:
    """A sweep's positions in the base frame.

    Args:
        sweep: what to draw; of more than 20 000 points so many at random.
        colour: what the colours tell: how close points lie (``"density"``), or of the frame's translation the
            manipulability, the condition number or the smallest singular value (``"singularity"``).

    Raises:
        InputError: if the colour can't tell anything, since the frame does not move.
        MissingExtraError: if matplotlib or, for densities, scipy is not installed.
    """
    some = _some(len(sweep.positions))
    points = sweep.positions[some]
    measures = Measures(sweep.translation.singular_values[some])
    if colour != "density" and not measures.rank:
        remedy = "colour it by density"
        raise InputError("colour", f"the frame never moves, so it has no {colour}", remedy=remedy)
    shading = _shading(points, measures, colour, sweep.metadata, len(sweep.q) / len(points))
    return _draw(points, shading, _title(sweep.metadata, len(sweep.q), len(points)))


def plot_map(reached: ReachabilityMap, colour: str = "manipulability") -> Figure:
    """A map's voxels in the base frame; from each side, the largest number among the voxels behind each other.

    Args:
        reached: what to draw.
        colour: what the colours tell: samples per voxel (``"density"``), the largest manipulability, or the part of
            all approach directions (``"coverage"``).

    Raises:
        InputError: if the map does not have what the colour is to tell.
        MissingExtraError: if matplotlib is not installed.
    """
    best = f"largest manipulability of translation [{unit(reached.metadata, reached.metadata['rank'])}]"
    shadings = {
        "manipulability": _Shading(reached.manipulability, best),
        "density": _Shading(reached.counts.astype(float), "samples per voxel", logarithmic=True),
        "coverage": _Shading(100.0 * reached.coverage, "approach directions met [%]"),
    }
    if colour not in shadings or np.isnan(shadings[colour].values).any():
        raise InputError("colour", f"the map has no {colour}", remedy=f"use {', '.join(MAP_COLOURS)}")
    meta = reached.metadata
    robot, frame = plot(meta["robot"]), plot(meta["frame"])
    title = f"{robot}: voxels of {meta['voxel']:g} m that {frame} reaches, {meta['samples']} samples"
    return _draw(reached.centres, shadings[colour], title, reached.voxel)


def plot_comparison(sweep: Sweep, others: FloatArray, reference: str) -> Figure:
    """A sweep's positions as crosses, and those from another choice of frame 0 as circles.

    Args:
        sweep: whose positions to draw.
        others: the same positions, from poses in ``reference`` brought to the base, shape (N, 3).
        reference: the other choice of frame 0.

    Raises:
        MissingExtraError: if matplotlib is not installed.
    """
    some = _some(len(sweep.positions))
    points, others = sweep.positions[some], others[some]
    plane = _Plane.of(points)
    if plane:
        figure, axes = _fitted(plane.coordinates(points))
    else:
        figure = figures.figure(7.0, 7.0)
        axes = figure.add_subplot(projection="3d")
    base = plot(sweep.metadata["base"])
    sets: Sequence[tuple[FloatArray, str, dict[str, Any]]] = (
        (points, f"frame 0 at {base}", {"marker": "x", "c": "tab:blue", "s": 14, "linewidths": 0.8}),
        (
            others,
            f"frame 0 at {plot(reference)}, brought to {base}",
            {"marker": "o", "edgecolors": "tab:orange", "facecolors": "none", "s": 34, "linewidths": 0.8},
        ),
    )
    for positions, label, style in sets:
        axes.scatter(*(plane.coordinates(positions).T if plane else positions.T), label=label, **style)
    _name_axes(axes, plane.labels if plane else _LABELS)
    figure.legend(loc="outside lower center", frameon=False)
    distance = float(np.linalg.norm(points - others, axis=1).max())
    title = _title(sweep.metadata, len(sweep.q), len(points))
    figure.suptitle(f"{title}\nlargest distance between × and ○: {distance:.1e} m", fontsize="medium")
    return figure


@dataclass(frozen=True, slots=True)
class _Plane:
    """The plane that points lie in.

    Attributes:
        across: unit vectors along the picture's axes, shape (2, 3).
        labels: of the picture's axes.
    """

    across: FloatArray
    labels: tuple[str, ...]

    @classmethod
    def of(cls, points: FloatArray) -> _Plane | None:
        """A plane of two base axes where that will do, else any; None if the points fill space."""
        if dimensions(points) == 3:
            return None
        flat = np.argsort(np.ptp(points, axis=0), kind="stable")
        two = sorted(flat[1:].tolist())
        if np.ptp(points[:, flat[0]]) <= FLAT * max(1.0, float(abs(points).max())):
            return cls(np.eye(3)[two], tuple(_LABELS[i] for i in two))
        across = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][:2]
        names = ("({})".format(", ".join(f"{x:.3g}" for x in row + 0.0)) for row in across)
        return cls(across, tuple(f"along {name} [m]" for name in names))

    def coordinates(self, points: FloatArray) -> FloatArray:
        """Where points are in the picture, shape (N, 2)."""
        placed: FloatArray = points @ self.across.T
        return placed


def _draw(points: FloatArray, shading: _Shading, title: str, edge: float | None = None) -> Figure:
    """Points, or cubes of that edge about them, with colours and a colour bar; the largest numbers are in front."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm, Normalize

    order = np.argsort(shading.values, kind="stable")
    points, values = points[order], shading.values[order]
    norm = (LogNorm if shading.logarithmic and values[0] > 0.0 else Normalize)(values[0], values[-1])
    style: dict[str, Any] = {"cmap": "viridis", "norm": norm}
    plane = _Plane.of(points)
    if plane:
        placed = plane.coordinates(points)
        figure, axes = _fitted(placed, edge or 0.0)
        panels = [axes]
        _panel(axes, placed, values, edge, 14.0, style)
        _name_axes(axes, plane.labels)
    else:
        x, y, z = np.maximum(np.ptp(points, axis=0), 0.1 * np.ptp(points, axis=0).max())
        figure = figures.figure(9.5, 8.0 * float(np.clip((z + y) / (x + y), 0.7, 1.3)) + 0.5)
        grid = figure.add_gridspec(2, 2, width_ratios=(x, y), height_ratios=(z, y))
        # As in a technical drawing: from the front, beside it the view along x, below it the view from above.
        panels = [figure.add_subplot(grid[place]) for place in ((0, 0), (0, 1), (1, 0))]
        for axes, (i, j) in zip(panels, ((0, 2), (1, 2), (0, 1)), strict=True):
            _panel(axes, points[:, [i, j]], values, edge, 6.0, style)
            _name_axes(axes, (_LABELS[i], _LABELS[j]))
        panels.append(figure.add_subplot(grid[1, 1], projection="3d"))
        few = _some(len(points))
        size = _size(len(points[few]), 6.0)
        x, y, z = points[few].T
        panels[3].scatter(x, y, zs=z, c=values[few], s=size, linewidths=0, **style)
        _name_axes(panels[3], _LABELS)
    bar = figure.colorbar(ScalarMappable(**style), ax=panels, label=shading.label, shrink=0.8)
    bar.ax.tick_params(labelsize="small")
    figure.suptitle(title, fontsize="medium")
    return figure


def _panel(
    axes: Any, placed: FloatArray, values: FloatArray, edge: float | None, size: float, style: dict[str, Any]
) -> None:
    """Points in one view, or squares with the largest number among the cubes behind them."""
    if edge is None:
        axes.scatter(*placed.T, c=values, s=_size(len(values), size), linewidths=0, **style)
        return
    indices = np.floor(placed / edge).astype(int)
    first = indices.min(axis=0)
    image = np.full(np.ptp(indices, axis=0) + 1, np.nan)
    np.fmax.at(image, tuple((indices - first).T), values)
    lines = [(first[i] + np.arange(image.shape[i] + 1)) * edge for i in range(2)]
    axes.pcolormesh(*lines, image.T, **style)


def _fitted(placed: FloatArray, edge: float = 0.0) -> tuple[Figure, Any]:
    """A figure of the shape of the points, with room for a colour bar, and axes about them that are no mere line."""
    extents = np.ptp(placed, axis=0) + edge
    extents = 1.06 * np.maximum(extents, (0.4 * extents.max()) or 1.0)
    ratio = extents[1] / extents[0]
    width = 6.0 / max(1.0, ratio)
    figure = figures.figure(width + 2.0, width * ratio + 1.0)
    figure.set_layout_engine("compressed")  # which knows of equal axes
    axes = figure.add_subplot()
    middle = 0.5 * (placed.min(axis=0) + placed.max(axis=0))
    axes.set_xlim(middle[0] - 0.5 * extents[0], middle[0] + 0.5 * extents[0])
    axes.set_ylim(middle[1] - 0.5 * extents[1], middle[1] + 0.5 * extents[1])
    return figure, axes


def _name_axes(axes: Any, labels: Sequence[str]) -> None:
    for name, label in zip(_NAMES, labels, strict=False):  # two or three
        getattr(axes, f"set_{name}label")(label)
        axes.locator_params(axis=name, nbins=5 if len(labels) == 3 else 7)
    axes.tick_params(labelsize="small")
    axes.set_aspect("equal")
    axes.grid(visible=True, linewidth=0.4, alpha=0.5)
    axes.set_axisbelow(True)


def _size(count: int, most: float) -> float:
    """Area of a marker (pt²), smaller for more points."""
    return float(np.clip(most * 1000.0 / count, 1.5, 2.0 * most))


def _some(count: int) -> NDArray[np.intp]:
    """Which points are drawn: at random, since every so many-th of a grid would be some of its lines."""
    if count <= MOST:
        return np.arange(count)
    return np.sort(np.random.default_rng(0).choice(count, MOST, replace=False))


def _title(metadata: dict[str, Any], count: int, drawn: int) -> str:
    grid = metadata.get("grid")
    robot, frame, base = (plot(metadata[key]) for key in ("robot", "frame", "base"))
    how = f"grid of {' × '.join(map(str, grid.values()))}" if grid else f"sample of {count}"
    part = "" if drawn == count else f", {drawn} drawn"
    return f"{robot}: positions of {frame} in {base}, {how}{part}"


def _shading(points: FloatArray, measures: Measures, colour: str, metadata: dict[str, Any], thinned: float) -> _Shading:
    if colour == "density":
        values, k = density(points)
        return _Shading(values * thinned, f"points per {('point', 'm', 'm²', 'm³')[k]}")
    if colour == "manipulability":
        factors = "".join(f"σ{'₁₂₃'[i]}" for i in range(measures.rank))
        return _Shading(
            measures.manipulability, f"manipulability of translation, {factors} [{unit(metadata, measures.rank)}]"
        )
    if colour == "condition":
        name = f"condition number of translation, σ₁/σ{'₁₂₃'[measures.rank - 1]}"
        return _Shading(np.minimum(measures.condition, WORST_CONDITION), name, logarithmic=True)
    if colour == "singularity":
        name = f"distance to singularity, σ{'₁₂₃'[measures.rank - 1]}"
        return _Shading(measures.smallest, f"{name} [{unit(metadata, 1)}]")
    raise InputError("colour", f"a sweep has no {colour}", remedy=f"use {', '.join(SWEEP_COLOURS)}")
