"""What the model draws about joints: a screw for each that has one axis, and where its name stands."""

from __future__ import annotations

import numpy as np
import pytest
from view_support import FREE

import urdfs
from pinscrew.description.visuals import Looks
from pinscrew.view import twists
from pinscrew.view.model import Model

ARM = urdfs.robot(
    urdfs.joint("turn", "revolute", "base", "a", axis="0 0 1", limits=(-1.0, 2.0)),
    urdfs.joint("slide", "prismatic", "a", "tool", xyz="2 0 0", axis="1 0 0", limits=(-0.1, 0.3)),
    links="base a tool",
)


def made(text: str) -> Model:
    return Model.of(urdfs.load(text), Looks(()), {})


def test_a_model_holds_what_it_was_made_of() -> None:
    robot = urdfs.load(ARM)
    model = Model.of(robot, Looks(()), {})
    assert model.robot is robot
    assert model.engine.robot is robot


def test_screws_stand_still_in_what_carries_them() -> None:
    """A screw is drawn in the base's frame at zero, and moved by the joints before its own: -1 is none."""
    model = made(ARM)
    screws = {body.owner: body for body in model.bodies if body.group == "screws"}
    assert {owner: body.motion for owner, body in screws.items()} == {"turn": -1, "slide": 0}
    for body in screws.values():
        np.testing.assert_array_equal(body.home, np.eye(4))


@pytest.mark.parametrize(("joint", "axis"), [("turn", [0.0, 0.0, 1.0]), ("slide", [1.0, 0.0, 0.0])])
def test_the_name_stands_beyond_the_arrow(joint: str, axis: list[float]) -> None:
    model = made(ARM)
    (body,) = (body for body in model.bodies if body.group == "screws" and body.owner == joint)
    (label,) = (part for part in body.parts if part.shape.kind == "label")
    assert label.shape.text == joint
    along = float(label.transform[:3, 3] @ axis) - (2.0 if joint == "slide" else 0.0)
    assert along > twists.FRONT * model.size


def test_a_free_body_has_no_screw() -> None:
    model = made(FREE)
    single = {motion.joint.name for motion in model.robot.mechanism.motions if motion.twists.shape[1] == 1}
    assert len(single) < len(model.robot.mechanism.motions)
    assert {body.owner for body in model.bodies if body.group == "screws"} == single


def test_colours_are_between_0_and_1() -> None:
    for text in (ARM, FREE):
        for part in (part for body in made(text).bodies for part in body.parts):
            assert len(part.color) == 4
            assert all(0.0 <= channel <= 1.0 for channel in part.color)
