"""What docs/motion.md shows works: its Python runs, its profiles can be read, its numbers are the measured ones."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import pinscrew as ps

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "motion.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def test_python_runs() -> None:
    names: dict[str, Any] = {}
    exec("\n".join(body for tag, body in BLOCKS if tag == "python"), names)  # noqa: S102 (our own page)
    assert names["run"].poses.shape == (201, 4, 4)
    assert names["found"].qd.shape == (3,)


@pytest.mark.parametrize("suffix", ["yaml", "csv"])
def test_profiles_can_be_read(tmp_path: Path, suffix: str) -> None:
    (body,) = (body for tag, body in BLOCKS if tag == suffix)
    file = tmp_path / f"rates.{suffix}"
    file.write_text(body, encoding="utf-8")
    profile = ps.Profile.read(file)
    assert profile.names == ("joint1", "joint2", "joint3")
    assert profile([profile.start, profile.end]).shape == (2, 3)


@pytest.mark.parametrize(
    "row", [line for line in PAGE.splitlines() if re.match(r"\| `[a-z0-9-]+` \|.*(Euler|Runge)", line)]
)
def test_the_table_of_schemes(row: str) -> None:
    """The drift over the assignment's steps, to the digits given; what is rounding, to its power of ten."""
    name, *_, orthogonality, off = (cell.strip() for cell in row.strip("|").split("|"))
    drift = ps.track(ps.load("anthropomorphic_rrr"), scheme=name.strip("`")).trajectory.drift
    assert float(drift.orthogonality.max()) == pytest.approx(
        float(orthogonality), rel=0.05 if "-2" in orthogonality else 2
    )
    if off == "0":
        assert drift.position.max() == 0.0
    else:
        position, angle = re.fullmatch(r"(\S+) m, (\S+) rad", off).groups()  # type: ignore[union-attr]
        assert drift.position.max() == pytest.approx(float(position), rel=0.02)
        assert drift.angle.max() == pytest.approx(float(angle), rel=0.02)
