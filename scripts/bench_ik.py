"""Measure inverse kinematics: how many of a thousand reachable targets are solved, and how long one takes.

    python scripts/bench_ik.py [--targets N]

Targets are Pinocchio's poses at random configurations within the limits, and what is solved is checked by it. The
times are the best of three rounds.
"""

from __future__ import annotations

import argparse
import os
import platform
import time
import warnings

import numpy as np

import pinscrew as ps

ARMS = {
    "spherical": None,
    "planar_2r": None,
    "scara": None,
    "stanford": None,
    "planar_rrr": None,
    "drone": None,
    "anthropomorphic": None,
    "one_joint": None,
    "two_joint": None,
    "gear_pair": None,
    "bevel_pair": None,
    "lead_screw": None,
    "ur5_robot": "tool0",
    "panda": "panda_hand_tcp",
    "xarm7": None,
}
"""Robots, and the frame where there is more than one tip."""


def measure(name: str, frame: str | None, count: int) -> str:
    """A line of the table."""
    robot = ps.load(name)
    engines = ps.PoE(robot), ps.Pinocchio(robot)
    lower, upper = robot.limits.T
    # Another seed than that of the starts, which would be the very configurations.
    T = engines[1].fk(np.random.default_rng(1).uniform(lower, upper, (count, robot.nq)), frame)
    few = T[:20]
    batch = single = float("inf")
    for _ in range(3):
        start = time.perf_counter()
        solution = ps.ik(robot, T, frame=frame, engines=engines)
        batch = min(batch, (time.perf_counter() - start) / count)
        start = time.perf_counter()
        for one in few:
            ps.ik(robot, one, frame=frame, engines=engines)
        single = min(single, (time.perf_counter() - start) / len(few))
    good = solution.solved
    errors = f"{solution.position_error[good].max():11.1e} {solution.angle_error[good].max():11.1e}"
    return f"{robot.name:20} {100 * good.mean():9.1f} % {errors} {1e3 * batch:12.2f} {1e3 * single:12.1f}"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--targets", type=int, default=1000)
    count: int = parser.parse_args().targets
    warnings.simplefilter("ignore", ps.PinscrewWarning)
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, {count} targets each")
    print(f"{'robot':20} {'solved':>11} {'error, m':>11} {'error, rad':>11} {'ms in batch':>12} {'ms alone':>12}")
    for name, frame in ARMS.items():
        print(measure(name, frame, count))


if __name__ == "__main__":
    main()
