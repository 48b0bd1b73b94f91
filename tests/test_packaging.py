"""A wheel holds the robots, and pinscrew works from it as it does from a checkout."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

import pinscrew as ps
from pinscrew.description.catalogue import bundled, robots_directory

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (found,) = folder.glob("*.whl")
    return found


def installed(wheel: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run pinscrew from a folder that holds the wheel's files, not from this checkout."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-m", "pinscrew", *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


def test_the_wheel_holds_every_robot_and_the_type_marker(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {f"pinscrew/_robots/{entry.file.name}" for entry in bundled()} <= names
    assert {"pinscrew/py.typed", "pinscrew/_robots/catalogue.json"} <= names
    assert "pinscrew/_robots/profiles/anthropomorphic_rrr.yaml" in names
    assert not [name for name in names if name.startswith(("tests/", "scripts/"))]


def test_list_from_the_wheel(wheel: Path, tmp_path: Path) -> None:
    done = installed(wheel, tmp_path, "list", "--json")
    assert done.returncode == 0, done.stderr
    rows = json.loads(done.stdout)["robots"]
    assert [row["name"] for row in rows] == [entry.name for entry in bundled()]
    assert all(Path(row["file"]).is_relative_to(tmp_path) for row in rows)


def test_verify_from_the_wheel(wheel: Path, tmp_path: Path) -> None:
    done = installed(wheel, tmp_path, "verify", "scara", "l1:=0.7", "lead_screw", "--samples", "5", "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["ok"]
    assert [Path(robot["file"]).parent for robot in report["robots"]] == [tmp_path / "pinscrew" / "_robots"] * 2


def test_robots_of_a_checkout() -> None:
    assert robots_directory() == ROOT / "robots"


def test_the_citation_names_the_version() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["version"] == ps.__version__
