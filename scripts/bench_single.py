"""One configuration at a time: what a call costs, each engine beside Pinocchio's own calls.

    python scripts/bench_single.py [ROBOT FRAME]...

All contenders take turns, many times; the best of each counts. Ratios are to Pinocchio's bare Python calls, so other
work on the machine disturbs them less than it does the times.
"""

from __future__ import annotations

import sys
import timeit
from collections.abc import Callable
from typing import Any, Final

import numpy as np
import pinocchio as pin

import pinscrew as ps

ROUNDS: Final = 60
CALLS: Final = 300
FEW: Final = 20
ARMS: Final = ("ur5_robot", "tool0", "panda", "panda_hand", "spherical_rrp", "tool")


def bare(engine: ps.Pinocchio, frame: str) -> Callable[[Any], Any]:
    """Pinocchio's own calls, with their names looked up once."""
    model, data = engine.model, engine.model.createData()
    index, local = model.getFrameId(frame), pin.ReferenceFrame.LOCAL
    columns, place, jacobian = pin.computeJointJacobians, pin.updateFramePlacement, pin.getFrameJacobian

    def ask(x: Any) -> Any:
        columns(model, data, x)
        return place(model, data, index).homogeneous, jacobian(model, data, index, local)

    return ask


def unbound(engine: ps.Engine, frame: str) -> Callable[[Any], Any]:
    """The same question, checked each time."""
    ask = engine.fk_jacobian
    return lambda q: ask(q, frame, "body")


def measure(name: str, frame: str) -> dict[str, float]:
    """Microseconds of a call, by contender."""
    robot = ps.load(name)
    frame = frame if frame in robot.frame_names else robot.tip
    poe, pinocchio, batch = ps.PoE(robot), ps.Pinocchio(robot), ps.Batch(robot)
    q = np.random.default_rng(0).uniform(-1.0, 1.0, robot.nq)
    x = np.random.default_rng(0).uniform(-1.0, 1.0, pinocchio.model.nq)
    contenders: dict[str, tuple[Callable[[Any], Any], Any]] = {"Pinocchio's own calls": (bare(pinocchio, frame), x)}
    for engine in (pinocchio, batch, poe):
        contenders[f"{engine.name}, bound"] = engine.bind(frame, "body"), q
        contenders[f"{engine.name}, unbound"] = unbound(engine, frame), q
    best = dict.fromkeys(contenders, np.inf)
    for _ in range(ROUNDS):
        for label, (ask, given) in contenders.items():
            calls = CALLS if "own" in label or ("bound" in label.split(", ")[-1:] and "PoE" not in label) else 20
            names = {"ask": ask, "q": given}
            best[label] = min(best[label], timeit.timeit("ask(q)", globals=names, number=calls) / calls * 1e6)
    return best


def main() -> None:
    """Print a table for each arm."""
    words = sys.argv[1:] or list(ARMS)
    for name, frame in zip(words[::2], words[1::2], strict=True):
        times = measure(name, frame)
        base = times["Pinocchio's own calls"]
        print(f"{name}, pose and body Jacobian")
        for label, time in times.items():
            print(f"  {label:<22} {time / base:7.2f}   {time:8.2f} µs")


if __name__ == "__main__":
    main()
