"""Measure the first second: whole commands in fresh processes, beside what no command can do without.

    python scripts/bench_cold.py [--rounds N]

The measure is a process that imports numpy and Pinocchio and ends. All commands take turns; each time is the best of
the rounds. Run it twice: the first time may compile Python's files.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import time

MEASURE = "import numpy, pinocchio"
COMMANDS = (
    "--help",
    "screws scara",
    "fk scara -q 0,0,0",
    "jacobian scara -q 0,0,0 --kind body",
    "diff scara scara",
    "diff ur5_robot ur5_robot",
    "derive ur5_robot --tip tool0",
    "verify --samples 1000",
)


def seconds(arguments: list[str]) -> float:
    """How long a process of Python's takes."""
    start = time.perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=9)
    rounds: int = parser.parse_args().rounds
    contenders = {MEASURE: ["-c", MEASURE]} | {line: ["-m", "pinscrew", *line.split()] for line in COMMANDS}
    best = dict.fromkeys(contenders, float("inf"))
    for _ in range(rounds):
        for name, arguments in contenders.items():
            best[name] = min(best[name], seconds(arguments))
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, best of {rounds}")
    for name, value in best.items():
        print(f"{value / best[MEASURE]:6.2f} ×  {value:6.2f} s  {name}")


if __name__ == "__main__":
    main()
