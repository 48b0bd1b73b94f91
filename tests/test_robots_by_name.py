"""Whatever takes a robot takes what `ps.load` takes, and says so where it gets something else."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.ground.errors import InputError, UnknownNameError

Q: Final = [0.1, 0.2, 0.3]

TAKE_A_ROBOT: Final[dict[str, Callable[[Any], Any]]] = {
    "Batch": lambda robot: ps.Batch(robot).fk(Q),
    "PoE": lambda robot: ps.PoE(robot).fk(Q),
    "Pinocchio": lambda robot: ps.Pinocchio(robot).fk(Q),
    "check": lambda robot: str(ps.check(robot, "p", "[1, 2, 3]")),
    "check_file": lambda robot: str(ps.check_file(robot, Path(__file__).parent / "data" / "answers.json")),
    "classify_singularity": lambda robot: ps.classify_singularity(robot, Q).singular_values,
    "derive": lambda robot: str(ps.derive(robot).pose),
    "diff": lambda robot: str(ps.diff(robot, "planar_2r")),
    "diff, second": lambda robot: str(ps.diff("planar_2r", robot)),
    "find_singularities": lambda robot: len(ps.find_singularities(robot, task="position")),
    "identify": lambda robot: str(ps.identify(robot, Q, ps.PoE("scara").fk(Q))),
    "ik": lambda robot: ps.ik(robot, ps.PoE("scara").fk(Q), starts=2).q,
    "integrate": lambda robot: ps.integrate(robot, Q, lambda _: [1.0, 0.0, 0.0], dt=0.1, steps=2).q,
    "reachability": lambda robot: ps.reachability(robot, voxel=0.2, samples=100).counts,
    "show": lambda robot: ps.show(robot, open_browser=False).close(),
    "sweep": lambda robot: ps.sweep(robot, samples=10).q,
    "track": lambda robot: ps.track(robot, lambda _: [1.0, 0.0, 0.0], 0.1, duration=0.2).trajectory.q,
    "verify": lambda robot: ps.verify(robot, samples=2).ok,
    "witness": lambda robot: ps.witness("mujoco", robot).fk(Q),
}


@pytest.mark.parametrize("question", TAKE_A_ROBOT.values(), ids=TAKE_A_ROBOT)
def test_a_name_is_the_robot_of_that_name(question: Callable[[Any], Any]) -> None:
    file = Path(ps.load("scara").description.file)
    expected = question(ps.load("scara"))
    for robot in ("scara", file):
        np.testing.assert_equal(question(robot), expected)


@pytest.mark.parametrize("question", TAKE_A_ROBOT.values(), ids=TAKE_A_ROBOT)
def test_what_is_no_robot(question: Callable[[Any], Any]) -> None:
    with pytest.raises(InputError) as caught:
        question(3.0)
    assert caught.value.code == "not-a-robot"
    with pytest.raises(UnknownNameError) as unknown:
        question("skara")
    assert "scara" in str(unknown.value)


def test_every_public_function_of_a_robot_is_tried() -> None:
    signatures = {name: inspect.signature(getattr(ps, name)) for name in ps.__all__ if callable(getattr(ps, name))}
    taking = {name for name, of in signatures.items() for each in of.parameters.values() if "RobotLike" in str(each)}
    assert taking == {name.partition(",")[0] for name in TAKE_A_ROBOT}
    mistaken = [name for name, of in signatures.items() if ": 'Robot'" in str(of)]
    assert mistaken == ["Trajectory"], "what a function made may hold the robot"
