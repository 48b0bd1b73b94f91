"""How a robot is first seen: its tip, its configuration, and numbers that say what they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view_support import MIXED

import pinscrew as ps
import urdfs
from command_line import run
from pinscrew.description.visuals import Looks
from pinscrew.view import opening, prepare
from pinscrew.view.model import Model

Open = Callable[..., Any]


def tree(*joints: tuple[str, str, str]) -> str:
    """A robot of joints given as name, parent and child."""
    links = dict.fromkeys(name for joint in joints for name in joint[1:])
    return urdfs.robot(*(urdfs.joint(name, "revolute", a, b) for name, a, b in joints), links=" ".join(links))


ARM = (("a", "base", "upper"), ("b", "upper", "hand"), ("left_finger_joint", "hand", "left"), ("c", "left", "nail"))


@pytest.mark.parametrize(
    ("joints", "tip"),
    [
        ((*ARM, ("d", "base", "camera")), "hand"),  # not the nail, which most joints move
        ((*ARM, ("d", "base", "tcp")), "tcp"),
        ((*ARM, ("d", "upper", "tool0")), "tool0"),
        ((*ARM, ("d", "upper", "leftEELink")), "leftEELink"),
        ((*ARM, ("d", "upper", "wheel"), ("e", "wheel", "tire"), ("f", "tire", "knee")), "knee"),
        ((("thumb1", "palm", "t1"), ("thumb2", "t1", "t2"), ("finger", "palm", "f")), "t2"),  # a hand alone
        ((("a", "base", "first"), ("b", "base", "second")), "first"),
    ],
)
def test_the_tip(joints: Any, tip: str) -> None:
    assert opening.default_tip(urdfs.load(tree(*joints))) == tip


def test_a_tip_that_is_given_stays() -> None:
    assert opening.default_tip(urdfs.load(MIXED)) == "tool"
    assert opening.default_tip(urdfs.load(tree(*ARM), tip="nail")) == "nail"
    assert opening.default_tip(ps.load("scara")) == "tool"


def test_zero_within_the_limits_or_their_middle() -> None:
    limits = {"a": (-1, 1), "b": (0.5, 1.5), "c": (-3, -0.2), "d": (0, 2)}
    links = ["base", *limits]
    joints = [
        urdfs.joint(name, "revolute", *links[i : i + 2], limits=ends) for i, (name, ends) in enumerate(limits.items())
    ]
    robot = urdfs.load(urdfs.robot(*joints, links=" ".join(links)))
    assert opening.configuration(robot).tolist() == [0, 1, -1.6, 0]
    assert opening.beside_zero(robot) == ["b", "c"]


def test_panda(open_page: Open, tmp_path: Path) -> None:
    done = run("show", "panda", "--html", tmp_path / "page.html")
    assert done.err == "pinscrew: zero is outside the limits of panda_joint4: shown in the middle of them\n"
    page = open_page((tmp_path / "page.html").as_uri(), offline=True)
    assert page.input_value("#tip") == "panda_hand_tcp"
    assert "panda_joint4" in page.text_content("#opening")
    assert page.locator(".coordinate.outside").count() == 0
    start = [0.0] * 8
    start[3] = (-3.0718 - 0.0698) / 2
    assert page.evaluate("pinscrew.app.state.q") == pytest.approx(start, abs=1e-9)
    page.click("#zero")
    assert page.locator(".coordinate.outside").count() == 1
    page.click("#start")
    assert page.evaluate("pinscrew.app.state.q") == pytest.approx(start, abs=1e-9)
    assert page.said == []


def test_small_numbers_keep_four_digits(open_page: Open, tmp_path: Path) -> None:
    """A lead screw of 5 mm a turn moves 0.005/2π m a radian, which 0.0008 does not tell."""
    model = prepare.prepare(ps.load("lead_screw"))
    (tmp_path / "page.html").write_text(prepare.page(model, prepare.begin(model)), encoding="utf-8")
    page = open_page((tmp_path / "page.html").as_uri(), offline=True)
    cells = page.eval_on_selector_all(
        "#jacobian tbody tr td:first-of-type", "all => all.map(c => Number(c.textContent))"
    )
    assert cells[2] == pytest.approx(0.005 / (2 * np.pi), rel=2e-4)
    assert "7.958e-4 m" in page.text_content("#measures")
    shown = page.evaluate(
        "values => values.map(pinscrew.numbers.significant)", [0, 1e-15, -1e-5, 0.00123456, 0.0123456, -0.5, 123456.7]
    )
    assert shown == ["0", "0", "-1.000e-5", "0.001235", "0.01235", "-0.5000", "1.235e+5"]


def test_the_picture_of_a_robot_opens_so_too() -> None:
    text = urdfs.robot(urdfs.joint("a", "revolute", "base", "tool", limits=(1, 2)), links="base tool")
    model = Model.of(urdfs.load(text), Looks(()), {})
    assert prepare.begin(model).q.tolist() == [1.5]
    assert prepare.begin(model, [0.0]).q.tolist() == [0.0]
