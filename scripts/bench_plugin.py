"""Measure `pytest --pinscrew` on ten arms of example-robot-data, and what the plugin adds to every other run.

    python scripts/bench_plugin.py [--rounds N] [--samples N]

The best of the rounds is shown; seconds of each robot are those of its own tests, and the first has the imports.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from xml.etree import ElementTree as ET

from pinscrew.description.catalogue import find

ARMS = ("ur3_robot", "ur5_robot", "ur10_robot", "ur3_gripper", "ur5_gripper", "panda", "kinova", "xarm7", "z1", "so101")


def run(folder: Path, *options: str) -> float:
    """Seconds of a run of pytest in a folder."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options]
    start = time.perf_counter()
    done = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return time.perf_counter() - start


IMPORT = """
import time, pytest
start = time.perf_counter()
import pinscrew.pytest_plugin
print(time.perf_counter() - start)
"""


def loading() -> float:
    """Seconds that pytest needs to load the plugin."""
    return float(subprocess.run([sys.executable, "-c", IMPORT], check=True, capture_output=True).stdout)


def by_robot(junit: Path) -> dict[str, float]:
    """Seconds of each file's tests."""
    found: dict[str, float] = {}
    for case in ET.parse(junit).iter("testcase"):  # noqa: S314 (our own file)
        name = case.get("classname", "")
        found[name] = found.get(name, 0.0) + float(case.get("time", "0"))
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--samples", type=int, default=100)
    asked = parser.parse_args()
    machine = f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
    print(f"{machine}, best of {asked.rounds} rounds")
    with tempfile.TemporaryDirectory() as name:
        folder, junit = Path(name), Path(name) / "junit.xml"
        files = [str(find(arm).file) for arm in ARMS]
        (folder / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
        arms = ["--pinscrew", f"--pinscrew-samples={asked.samples}", f"--junitxml={junit}", *files]
        times: list[float] = []
        loads: list[float] = []
        robots: dict[str, list[float]] = {}
        for _ in range(asked.rounds):
            loads.append(loading())
            times.append(run(folder, *arms))
            for robot, seconds in by_robot(junit).items():
                robots.setdefault(robot, []).append(seconds)
    for robot, each in robots.items():
        print(f"  {min(each):6.3f} s  {robot.rsplit('.', 2)[-2]}")
    print(f"{len(ARMS)} arms, {asked.samples} samples each: {min(times):.2f} s from start to end (goal: 5 s)")
    print(f"what the plugin adds to a run without --pinscrew: {1e3 * min(loads):.1f} ms")


if __name__ == "__main__":
    main()
