"""What ``pinscrew workspace`` prints of a sweep or a map."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from pinscrew.cli import output
from pinscrew.workspace.measures import Measures, unit

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray
    from pinscrew.workspace.reachability_map import ReachabilityMap
    from pinscrew.workspace.sweep import Sweep

__all__ = ["of_map", "of_sweep", "print_map", "print_sweep"]


def of_sweep(sweep: Sweep, others: FloatArray | None, reference: str | None) -> dict[str, Any]:
    """A sweep as a document, with the comparison to positions from another choice of frame 0 if there are any."""
    meta, positions = sweep.metadata, sweep.positions
    document = {
        "schema": "pinscrew.workspace/1",
        **meta,
        "configurations": len(positions),
        "positions": {name: _range(positions[:, i], "m") for i, name in enumerate("xyz")},
        "translation": _measured(sweep.translation, meta, "m"),
        "rotation": _measured(sweep.rotation, meta, "rad"),
    }
    if others is not None:
        distance = float(np.linalg.norm(positions - others, axis=1).max())
        document["comparison"] = {"frame0": reference, "largest_distance": distance}
    return document


def of_map(reached: ReachabilityMap) -> dict[str, Any]:
    """A map as a document."""
    centres, half = reached.centres, 0.5 * reached.voxel
    return {
        "schema": "pinscrew.workspace-map/1",
        **reached.metadata,
        "voxels": len(reached),
        "volume": reached.volume,
        "positions": {n: _range(centres[:, i] + [[-half], [half]], "m") for i, n in enumerate("xyz")},
        "manipulability": _range(reached.manipulability, unit(reached.metadata, reached.metadata["rank"])),
        "coverage": _range(reached.coverage, "1"),
        "samples_per_voxel": _range(reached.counts, "1"),
    }


def _measured(measures: Measures, metadata: dict[str, Any], of: str) -> dict[str, Any]:
    return {
        "rank": measures.rank,
        "manipulability": _range(measures.manipulability, unit(metadata, measures.rank, of)),
        "smallest": _range(measures.smallest, unit(metadata, 1, of)),
        "condition": _range(measures.condition, "1"),
    }


def _range(values: Any, unit: str) -> dict[str, Any]:
    """Least, median and largest value; None for what is not finite, which JSON does not have."""
    statistics = {"least": np.min(values), "median": np.median(values), "largest": np.max(values)}
    return {**{k: float(x) + 0.0 if math.isfinite(x) else None for k, x in statistics.items()}, "unit": unit}


def print_sweep(document: dict[str, Any]) -> None:
    """Print a sweep's document for reading."""
    grid = document.get("grid")
    how = f"a grid of {' × '.join(map(str, grid.values()))}" if grid else f"seed {document['seed']}"
    names = f"{document['frame']} in {document['base']}"
    output.say(f"{document['robot']}, {names}: {document['configurations']} configurations, {how}")
    rows = dict(document["positions"])
    for part, of in (("translation", document["translation"]), ("rotation", document["rotation"])):
        if not of["rank"]:
            output.say(f"there is no {part}")
            continue
        rows[f"{part}: manipulability"] = of["manipulability"]
        rows[f"{part}: smallest singular value"] = of["smallest"]
        rows[f"{part}: condition number"] = of["condition"]
    _print(rows)
    if "comparison" in document:
        compared = document["comparison"]
        where = f"from frame 0 at {compared['frame0']}, brought to {document['base']}"
        output.say(f"{where}: positions differ by {compared['largest_distance']:.1e} m at most")


def print_map(document: dict[str, Any]) -> None:
    """Print a map's document for reading."""
    names = f"{document['frame']} in {document['base']}"
    samples = f"{document['samples']} samples, seed {document['seed']}"
    output.say(f"{document['robot']}, {names}: {document['voxels']} voxels of {document['voxel']:g} m, {samples}")
    output.say(f"volume {document['volume']:.6g} m³")
    rows = {**document["positions"], "samples per voxel": document["samples_per_voxel"]}
    rows["part of approach directions"] = document["coverage"]
    if document["rank"]:
        rows["largest manipulability"] = document["manipulability"]
    _print(rows)


def _print(rows: dict[str, dict[str, Any]]) -> None:
    table = output.table("", "least", "median", "largest", "unit")
    for name, row in rows.items():
        numbers = ("∞" if row[key] is None else f"{row[key]:.6g}" for key in ("least", "median", "largest"))
        table.add_row(name, *numbers, "" if row["unit"] == "1" else row["unit"])
    output.console().print(table)
