"""A `Track` as data: a document for JSON, a table as CSV, arrays as NPZ."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from pinscrew.ground.escaping import csv_row
from pinscrew.ground.typing import FloatArray
from pinscrew.motion.track import Track

__all__ = ["document", "to_csv", "to_npz"]

_TWIST = ("vx", "vy", "vz", "wx", "wy", "wz")


def document(track: Track, index: int) -> dict[str, Any]:
    """The run as plain data: what it says at one of its times, and its errors over all of them."""
    run = track.trajectory
    recovered, drift = track.recovered, run.drift
    names = run.robot.velocity_names
    return {
        "schema": "pinscrew.track/1",
        "robot": run.robot.name,
        "base": run.robot.base,
        "frame": run.frame,
        "profile": track.profile,
        "scheme": run.scheme,
        "method": track.method,
        "dt": run.dt,
        "steps": run.steps,
        "at": {
            "t": float(run.t[index]),
            "q": dict(zip(run.robot.coordinate_names, _plain(run.q[index]), strict=True)),
            "qd": dict(zip(names, _plain(run.qd[index]), strict=True)),
            "recovered": dict(zip(names, _plain(recovered.qd[index]), strict=True)),
            "linear_velocity": _plain(run.twists[index, :3]),
            "angular_velocity": _plain(run.twists[index, 3:]),
            "dx": _plain(run.increments[index, :3]),
            "dphi": _plain(run.increments[index, 3:]),
            "jacobian": {"rows": _TWIST, "columns": names, "values": _plain(track.jacobians[index])},
            "condition": _finite(recovered.condition[index]),
            "manipulability": float(recovered.manipulability[index]),
            "pose": _plain(run.poses[index]),
            "updated_pose": _plain(run.poses[index + 1]) if index < run.steps else None,
        },
        "largest_rate_error": track.rate_error,
        "drift": {
            "orthogonality": _most_and_last(drift.orthogonality),
            "position": _most_and_last(drift.position),
            "angle": _most_and_last(drift.angle),
            "last_column_lengths": _plain(drift.column_lengths[-1]),
        },
    }


def to_csv(track: Track) -> str:
    """A row for each time; columns such as ``q.joint1``, ``recovered.joint1``, ``vx``, ``T11`` and ``drift.angle``."""
    columns = dict(_columns(track))
    rows = (np.stack(list(columns.values()), axis=-1) + 0.0).tolist()
    return "".join(f"{csv_row(row)}\n" for row in (columns, *rows))


def to_npz(track: Track) -> bytes:
    """The arrays of a track and its trajectory by their names, for ``numpy.load``."""
    run, recovered = track.trajectory, track.recovered
    out = io.BytesIO()
    np.savez_compressed(
        out,
        t=run.t,
        q=run.q,
        qd=run.qd,
        recovered=recovered.qd,
        residual=recovered.residual,
        singular_values=recovered.singular_values,
        poses=run.poses,
        twists=run.twists,
        jacobians=track.jacobians,
        drift_orthogonality=run.drift.orthogonality,
        drift_column_lengths=run.drift.column_lengths,
        drift_position=run.drift.position,
        drift_angle=run.drift.angle,
    )
    return out.getvalue()


def _columns(track: Track) -> list[tuple[str, FloatArray]]:
    run, recovered = track.trajectory, track.recovered
    names = run.robot.velocity_names
    found = [("t", run.t)]
    found += [(f"q.{name}", run.q[:, i]) for i, name in enumerate(run.robot.coordinate_names)]
    found += [(f"qd.{name}", run.qd[:, i]) for i, name in enumerate(names)]
    found += [(f"recovered.{name}", recovered.qd[:, i]) for i, name in enumerate(names)]
    found += [(name, run.twists[:, i]) for i, name in enumerate(_TWIST)]
    found += [(f"T{i + 1}{j + 1}", run.poses[:, i, j]) for i in range(3) for j in range(4)]
    found += [(f"drift.column{i + 1}", run.drift.column_lengths[:, i]) for i in range(3)]
    found += [(f"drift.{name}", getattr(run.drift, name)) for name in ("orthogonality", "position", "angle")]
    return [*found, ("condition", recovered.condition), ("manipulability", recovered.manipulability)]


def _most_and_last(values: FloatArray) -> dict[str, float]:
    return {"largest": float(values.max()), "last": float(values[-1])}


def _plain(values: FloatArray) -> Any:
    return (values + 0.0).tolist()


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
