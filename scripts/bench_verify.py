"""Measure what users wait for: a cold `pinscrew verify`, `import pinscrew`, and batches of the PoE engine.

    python scripts/bench_verify.py [--rounds N]

All contenders are interleaved in each round; the best of the rounds is shown, ratios first.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Mapping

import numpy as np

import pinscrew as ps

CONFIGURATIONS = 100_000
FEW = 5_000  # Pinocchio is asked from a Python loop; its time per configuration does not depend on their number


def best(contenders: Mapping[str, Callable[[], object]], rounds: int) -> dict[str, float]:
    """Seconds of the fastest run of each contender, one run of each per round."""
    found = dict.fromkeys(contenders, float("inf"))
    for _ in range(rounds):
        for name, contender in contenders.items():
            start = time.perf_counter()
            contender()
            found[name] = min(found[name], time.perf_counter() - start)
    return found


def python(*arguments: str) -> Callable[[], object]:
    """A fresh interpreter with these arguments."""
    return lambda: subprocess.run([sys.executable, *arguments], check=True, capture_output=True)


def processes(rounds: int) -> None:
    """Cold starts."""
    seconds = best(
        {
            "numpy": python("-c", "import numpy"),
            "pinscrew": python("-c", "import numpy, pinscrew"),
            "verify": python("-m", "pinscrew", "verify", "--samples", "1000"),
        },
        rounds,
    )
    beyond = 1e3 * (seconds["pinscrew"] - seconds["numpy"])
    print(f"pinscrew verify, all bundled robots, 1000 samples each, cold: {seconds['verify']:.2f} s (goal: 10 s)")
    print(f"import pinscrew beyond numpy: {beyond:.0f} ms (goal: 150 ms)")


def batches(rounds: int) -> None:
    """The PoE engine at many configurations of a 7-joint arm, against Pinocchio from a Python loop."""
    robot = ps.load("xarm7")
    poe, pin = ps.PoE(robot), ps.Pinocchio(robot)
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (CONFIGURATIONS, robot.nq))
    few = q[:FEW]
    seconds = best(
        {
            "PoE fk": lambda: poe.fk(q),
            "PoE body Jacobian": lambda: poe.jacobian(q, None, "body"),
            "Pinocchio fk": lambda: pin.fk(few),
            "Pinocchio body Jacobian": lambda: pin.jacobian(few, None, "body"),
        },
        rounds,
    )
    print(f"{robot.name}, {robot.nq} joints, {CONFIGURATIONS} configurations, per configuration:")
    for what in ("fk", "body Jacobian"):
        own, other = seconds[f"PoE {what}"] / CONFIGURATIONS, seconds[f"Pinocchio {what}"] / FEW
        print(f"  {what}: PoE {1e6 * own:.2f} µs (goal: 1.5 µs), {other / own:.1f} times as fast as a loop", end="")
        print(f" over Pinocchio ({1e6 * other:.2f} µs)")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    rounds: int = parser.parse_args().rounds
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, best of {rounds} rounds")
    processes(rounds)
    batches(rounds)


if __name__ == "__main__":
    main()
