"""The page in a real browser: what it draws and prints against both engines."""

from __future__ import annotations

import base64
import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from view_support import ARMS, FREE, MIXED, wait_until

import pinscrew as ps
import urdfs
from pinscrew.description import urdf
from pinscrew.description.visuals import Looks
from pinscrew.engines.measures import generic_ranks
from pinscrew.ground.typing import KINDS, FloatArray
from pinscrew.robot.robot import Robot
from pinscrew.view import prepare, scene
from pinscrew.view.meshcat import View
from pinscrew.view.model import Model, samples
from pinscrew.view.shapes import GROUPS

Open = Callable[..., Any]

SAME = "JSON.stringify(pinscrew.app.state.q) === JSON.stringify(value)"


OFTEN = {"spherical_rrp", "mixed", "free"}
"""One of the courseworks', and two with mimics and every kind of joint."""


def some(*names: str) -> list[Any]:
    """Those of `OFTEN` in every run, the others in slow ones: each page takes Chromium a second."""
    return [pytest.param(name, marks=() if name in OFTEN else pytest.mark.slow) for name in names]


def robot_of(name: str) -> Robot:
    if name in ("mixed", "free"):
        return urdfs.load(MIXED if name == "mixed" else FREE, tip="tool")
    return ps.load(name, tip="panda_link8") if name == "panda" else ps.load(name)


def model_of(name: str) -> Model:
    if name in ("mixed", "free"):
        return Model.of(robot_of(name), Looks(()), {})
    return prepare.prepare(robot_of(name))


def saved(model: Model, folder: Path, **options: Any) -> str:
    """The page of a model as a file, and its address."""
    file = folder / "page.html"
    file.write_text(prepare.page(model, prepare.begin(model, **options)), encoding="utf-8")
    return file.as_uri()


def drag(page: Any, name: str, value: float) -> None:
    """Move a slider, as the browser tells of it."""
    slider = page.locator(f'input[type=range][aria-label="{name}, slider"]')
    slider.evaluate("(slider, x) => { slider.value = x; slider.dispatchEvent(new Event('input')); }", value)


def table(page: Any, name: str) -> FloatArray:
    """The numbers in a table of the panel."""
    cells = page.evaluate(
        "name => [...document.getElementById(name).tBodies[0].rows]"
        ".map(row => [...row.querySelectorAll('td')].map(cell => cell.textContent))",
        name,
    )
    return np.array([[float(text) for text in row] for row in cells])


def poses(page: Any) -> dict[str, FloatArray]:
    """The pose of each link, from the scene tree."""
    found = page.evaluate("pinscrew.app.tree.poses()")
    return {name: np.array(T).reshape(4, 4) for name, T in found}


def moving(robot: Robot, tip: str) -> list[int]:
    """The velocities that move a frame: those of Pinocchio's Jacobian that are not zero everywhere."""
    J = ps.Pinocchio(robot).jacobian(samples(robot, 3, 1.0, seed=3), tip, "body")
    return [i for i in range(robot.nv) if J[:, :, i].any()]


def check(page: Any, robot: Robot, tip: str, q: FloatArray) -> None:
    """The links and the numbers of a page against both engines."""
    bound = 1e-9 * max(1.0, robot.reach)
    seen, engines = poses(page), (ps.PoE(robot), ps.Pinocchio(robot))
    for name in robot.frame_names:
        for engine in engines:
            assert abs(seen[name] - engine.fk(q, name)).max() <= bound
    half_digit = 0.5e-4 + 1e-9
    assert abs(table(page, "pose") - engines[1].fk(q, tip)).max() <= half_digit
    for kind in KINDS:
        page.select_option("#kind", kind)
        columns = moving(robot, tip)
        heads = page.eval_on_selector_all("#jacobian thead th", "all => all.map(one => one.title)")
        assert heads == ["", *(robot.velocity_names[i] for i in columns), "V"]
        J = engines[1].jacobian(q, tip, kind)
        assert abs(table(page, "jacobian")[:, :-1] - J[:, columns]).max(initial=0.0) <= half_digit
        assert abs(np.delete(J, columns, axis=1)).max(initial=0.0) == 0.0


@pytest.mark.parametrize("name", some(*ARMS, "panda"))
def test_a_slider_moves_the_arm_as_both_engines_say(name: str, open_page: Open) -> None:
    model = model_of(name)
    robot = model.robot
    q = np.round(samples(robot, 1, model.size, seed=7)[0], 6)  # Chromium's sliders keep 15 digits
    with View(model, prepare.begin(model), 17600) as view:
        page = open_page(view.url)
        for coordinate, value in zip(robot.coordinate_names, q, strict=True):
            drag(page, coordinate, value)
        wait_until(page, SAME, q.tolist())
        check(page, robot, model.tip, q)
        wait_until(page, "pinscrew.app.live.connected")
        for _ in range(100):
            if np.array_equal(view.q, q):
                break
            page.wait_for_timeout(20)
        assert np.array_equal(view.q, q)
        view.q = robot.neutral
        wait_until(page, SAME, robot.neutral.tolist())
        check(page, robot, model.tip, robot.neutral)
        assert page.said == []


@pytest.mark.parametrize("name", some(*ARMS, "panda", "mixed", "free"))
def test_the_file_computes_as_pinocchio_does_without_a_network(name: str, open_page: Open, tmp_path: Path) -> None:
    model = model_of(name)
    robot, tip = model.robot, model.tip
    configurations = samples(robot, 100, model.size, seed=8)
    page = open_page(saved(model, tmp_path), offline=True)
    answers = page.evaluate(
        """([configurations, tip]) => configurations.map((q) => {
          const robot = pinscrew.app.robot, moved = robot.displacements(q);
          return [robot.pose(tip, moved), ...["spatial", "body", "hybrid"].map((k) => robot.jacobian(tip, k, moved))];
        })""",
        [configurations.tolist(), tip],
    )
    engine = ps.Pinocchio(robot)
    bound = 1e-12 * max(1.0, robot.reach, model.size)
    T = np.array([answer[0] for answer in answers]).reshape(-1, 4, 4)
    assert abs(T - engine.fk(configurations, tip)).max() <= bound
    for i, kind in enumerate(KINDS, 1):
        J = np.array([answer[i] for answer in answers]).reshape(-1, robot.nv, 6).swapaxes(1, 2)
        assert abs(J - engine.jacobian(configurations, tip, kind)).max() <= bound
    q = configurations[0]
    page.evaluate("q => pinscrew.app.move(q)", q.tolist())
    check(page, robot, tip, q)
    assert page.said == []
    assert [url for url in page.asked if not url.startswith(("file:", "data:"))] == []
    assert len([url for url in page.asked if url.startswith("file:")]) == 1


@pytest.mark.parametrize("name", some(*ARMS, "mixed", "free"))
def test_everything_is_drawn_where_the_scene_has_it(name: str, open_page: Open, tmp_path: Path) -> None:
    model = model_of(name)
    page = open_page(saved(model, tmp_path, draw=GROUPS), offline=True)
    for seed in (9, 10):
        q = samples(model.robot, 1, model.size, seed=seed)[0]
        qd = np.random.default_rng(seed).normal(size=model.robot.nv)
        page.evaluate("([q, qd]) => pinscrew.app.set({ q, qd })", [q.tolist(), qd.tolist()])
        drawn = {tuple(json.loads(k)): v for k, v in page.evaluate("pinscrew.app.tree.transforms()").items()}
        expected = scene.build(model, q, qd).drawables
        assert set(drawn) == set(expected)
        for path, drawable in expected.items():
            error = abs(np.array(drawn[path]).reshape(4, 4) - drawable.transform).max()
            assert error <= 1e-9 * max(1.0, model.size, float(abs(drawable.transform).max())), path
    assert page.said == []


def test_another_tip_and_kind(open_page: Open, tmp_path: Path) -> None:
    model = model_of("mixed")
    page = open_page(saved(model, tmp_path), offline=True)
    q = samples(model.robot, 1, model.size, seed=11)[0]
    page.evaluate("q => pinscrew.app.move(q)", q.tolist())
    page.select_option("#tip", "e")
    check(page, model.robot, "e", q)
    J = ps.PoE(model.robot).jacobian(q, "e", "hybrid")
    for i, rows in enumerate((J[:3], J[3:])):
        shown = [
            float(word) for word in page.text_content(f"#measures tbody tr:nth-child({i + 1}) td:nth-child(3)").split()
        ]
        values = np.linalg.svd(rows, compute_uv=False)[: len(shown)]
        np.testing.assert_allclose(shown, values, rtol=6e-4, atol=0.5e-4 + 1e-9)
    assert page.said == []


def test_buttons(open_page: Open, tmp_path: Path) -> None:
    model = model_of("mixed")
    page = open_page(saved(model, tmp_path, q=[0.1, 0.2, 0.3, 0.4]), offline=True)
    state = "pinscrew.app.state.q"
    assert page.evaluate(state) == [0.1, 0.2, 0.3, 0.4]
    page.click("#upper")
    assert page.evaluate(state) == [np.pi, 0.6, 2.0, 2.0]
    page.click("#lower")
    assert page.evaluate(state) == [-np.pi, -0.4, -2.0, -2.0]
    page.click("#random")
    low, high = np.array([[-np.pi, np.pi], [-0.4, 0.6], [-2, 2], [-2, 2]]).T
    q = np.array(page.evaluate(state))
    assert ((low <= q) & (q <= high)).all()
    assert len(set(q)) == 4
    page.click("#zero")
    assert page.evaluate(state) == [0, 0, 0, 0]
    shown = page.eval_on_selector_all(".mimic .numbers", "cells => cells.map(c => c.textContent)")
    assert shown == ["0.3000", "-0.04000"]


def test_check_boxes_choose_what_is_drawn(open_page: Open, tmp_path: Path) -> None:
    page = open_page(saved(model_of("scara_rrp"), tmp_path), offline=True)
    for group in GROUPS:
        box = page.locator(f"#draw input[name={group}]")
        for wanted in (not box.is_checked(), box.is_checked()):
            box.set_checked(wanted)
            visible = page.evaluate("g => pinscrew.app.tree.node('rigid', g).object.visible", group)
            assert visible == wanted


@pytest.mark.parametrize(
    ("name", "q", "words"),
    [
        ("scara_rrp", [0.3, 0.0, 0.1], "singular: a direction of the position is lost"),
        ("scara_rrp", [0.3, 0.4, 0.1], "of the position: joint2 = 0.000"),
        ("spherical_rrp", [0.3, 0.4, -0.8], "singular: a direction of the position is lost"),
        ("gear_pair", [0.3], ""),
    ],
)
def test_singularities_are_named(name: str, q: list[float], words: str, open_page: Open, tmp_path: Path) -> None:
    page = open_page(saved(model_of(name), tmp_path, q=q), offline=True)
    page.wait_for_timeout(400)
    assert words in page.text_content("#warning")
    assert bool(words) == bool(page.text_content("#warning"))


@pytest.mark.parametrize(("lower", "words"), [(-2.0, ""), (0.2, " (outside the limits)")])
def test_a_singularity_near_by_is_met(lower: float, words: str, open_page: Open, tmp_path: Path) -> None:
    """To rounding: a straight elbow is at 0, not at -0.001; and where it can't be reached, that is said."""
    arm = urdfs.robot(
        urdfs.joint("shoulder", "revolute", "base", "upper"),
        urdfs.joint("elbow", "revolute", "upper", "lower", xyz="0.5 0 0", limits=(lower, 2.0)),
        urdfs.joint("mount", "fixed", "lower", "tool", xyz="0.4 0 0"),
        links="base upper lower tool",
    )
    model = Model.of(urdfs.load(arm), Looks(()), {})
    page = open_page(saved(model, tmp_path, q=[0.3, 0.45]), offline=True)
    page.wait_for_timeout(400)
    near = page.evaluate("pinscrew.app.robot.singularityNear('tool', pinscrew.app.generic, [0.3, 0.45], 5000)")
    assert near["q"][1] == pytest.approx(0.0, abs=1e-6)
    assert page.text_content("#warning").endswith(f"of the position: elbow = 0.000{words}")


BAD_NAMES = (
    "a/b",
    "/",
    'it\'s "quoted"',
    "<img src=x onerror=window.pwned=1>",
    "</script><script>window.pwned=1</script>",
    "<!--",
    "${window.pwned=1}",
    "__proto__",
    "constructor",
    "..",
)


def test_names_are_text(open_page: Open, tmp_path: Path) -> None:
    def quoted(name: str) -> str:
        return name.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")

    links = ["base", *BAD_NAMES]
    text = "".join(f'<link name="{quoted(link)}"/>' for link in links)
    for parent, child in itertools.pairwise(links):
        text += (
            f'<joint name="{quoted(child)}" type="continuous"><parent link="{quoted(parent)}"/>'
            f'<child link="{quoted(child)}"/><origin xyz="0.3 0 0.1"/><axis xyz="0 0 1"/></joint>'
        )
    robot = Robot.from_description(urdf.parse(f'<robot name="{quoted(BAD_NAMES[4])}">{text}</robot>', "bad.urdf"))
    model = Model.of(robot, Looks(()), {})
    with View(model, prepare.begin(model, draw=GROUPS), 17600) as view:
        for url, offline in ((view.url, False), (saved(model, tmp_path, draw=GROUPS), True)):
            page = open_page(url, offline=offline)
            page.click("#random")
            page.wait_for_timeout(300)
            assert page.evaluate("window.pwned") is None
            assert page.said == []
            labels = page.eval_on_selector_all(".label.frames", "all => all.map(one => one.textContent)")
            assert labels == links
            shown = page.eval_on_selector_all(".coordinate .name", "all => all.map(one => one.textContent)")
            assert tuple(shown) == BAD_NAMES
            assert page.text_content("#name") == BAD_NAMES[4]
            assert set(poses(page)) == set(links)
            rigid = "Object.keys(pinscrew.app.tree.node('rigid', 'frames').children).length"
            assert page.evaluate(rigid) == len(links)


@pytest.mark.parametrize("name", ["scara", *some("planar_rrr", "stanford", "mixed")])
def test_one_manipulability(name: str, open_page: Open, tmp_path: Path) -> None:
    """The same as a sweep's, of position and rotation apart, whatever Jacobian is shown; 0 where singular."""
    model = model_of(name)
    robot, tip = model.robot, model.tip
    page = open_page(saved(model, tmp_path), offline=True)
    ranks = generic_ranks(ps.PoE(robot), tip)
    singular = robot.neutral  # a SCARA, stretched out
    for q in (singular, *samples(robot, 3, model.size, seed=5)):
        page.evaluate("q => pinscrew.app.move(q)", q.tolist())
        J = ps.Pinocchio(robot).jacobian(q, tip, "hybrid")
        texts = set()
        for kind in KINDS:
            page.select_option("#kind", kind)
            shown = page.evaluate("pinscrew.app.shown.measures")
            for part, rows, rank in (("position", J[:3], ranks[0]), ("rotation", J[3:], ranks[1])):
                expected = np.linalg.svd(rows, compute_uv=False)[:rank].prod() if rank else None
                assert shown[part]["manipulability"] == (None if rank == 0 else pytest.approx(expected, abs=1e-9))
                values = np.linalg.svd(rows, compute_uv=False)[:rank]
                np.testing.assert_allclose(shown[part]["values"], values, rtol=0, atol=1e-9)
                assert shown[part]["rank"] == np.linalg.matrix_rank(rows, tol=1e-6 * max(values, default=1.0))
            texts.add(page.text_content("#measures tbody"))
        assert len(texts) == 1
        if name == "scara":  # the line on singularities judges its position, and so does the first line of the table
            cells = page.eval_on_selector_all(
                "#measures tbody tr:first-child > *", "all => all.map(c => c.textContent)"
            )
            lost = q is singular
            assert (cells[0], cells[4]) == ("position", "2 of 3" if lost else "3 of 3")
            assert (cells[1] == "0 m³") == (cells[3] == "∞") == lost
            assert ("singular:" in page.text_content("#warning")) == lost


SHORTENED = {
    ("_shoulder", "elbow"): ["_shoulder", "elbow"],
    ("_a", "_b"): ["a", "b"],
    ("__", "_"): ["__", "_"],
    ("left_arm_1", "left_arm_2"): ["1", "2"],
    ("left_arm_1", "left_leg_1"): ["arm", "leg"],
    ("_x_1", "_y_1"): ["x", "y"],
    ("shoulder_pan_joint", "elbow_joint"): ["shoulder_pan", "elbow"],
    ("joint_", "joint_2"): ["joint_", "joint_2"],
    ("only_one",): ["only_one"],
}


@pytest.mark.parametrize(
    "names", [pytest.param(names, marks=() if i in (0, 4) else pytest.mark.slow) for i, names in enumerate(SHORTENED)]
)
def test_columns_are_named_without_what_all_names_share(
    names: tuple[str, ...], open_page: Open, tmp_path: Path
) -> None:
    """A name that begins with an underscore froze the page for ever."""
    links = [f"l{k}" for k in range(len(names) + 1)]
    joints = [urdfs.joint(name, "continuous", *links[k : k + 2]) for k, name in enumerate(names)]
    robot = urdfs.load(urdfs.robot(*joints, links=" ".join(links)))
    page = open_page(saved(Model.of(robot, Looks(()), {}), tmp_path), offline=True)
    heads = page.eval_on_selector_all("#jacobian th", "all => all.map(one => one.textContent)")
    assert [head for head in heads if head in SHORTENED[names]] == SHORTENED[names]


@pytest.mark.parametrize("name", some("ur5_robot", "panda"))
def test_the_twist_stays_in_sight(name: str, open_page: Open, tmp_path: Path) -> None:
    """However many columns there are; a laptop's screen has all of six joints."""
    page = open_page(saved(model_of(name), tmp_path))
    page.set_viewport_size({"width": 1280, "height": 800})
    ends = page.evaluate(
        "[...document.querySelectorAll('#jacobian tr')].map(row => row.lastElementChild.getBoundingClientRect().right)"
    )
    assert max(ends) <= 1280.0
    wide, room = page.evaluate(
        "(box => [box.scrollWidth, box.clientWidth])(document.querySelector('#jacobian').closest('.scroll'))"
    )
    assert wide <= room or name == "panda"


def test_an_animation_plays_to_its_end(open_page: Open) -> None:
    model = model_of("two_joint")
    with View(model, prepare.begin(model), 17600) as view:
        page = open_page(view.url)
        wait_until(page, "pinscrew.app.live.connected")
        view.animate(np.linspace([0, 0], [1, -1], 10), fps=100)
        wait_until(page, SAME, [1, -1])
        assert page.is_visible("#player")
        assert page.evaluate("pinscrew.app.trace.length") > 1


def test_a_page_sees_that_python_has_gone_and_works_on(open_page: Open) -> None:
    model = model_of("two_joint")
    view = View(model, prepare.begin(model), 17600)
    page = open_page(view.url)
    wait_until(page, "pinscrew.app.live.connected")
    assert page.text_content("#status") == "live"
    view.close()
    wait_until(page, "pinscrew.app.live.connected === false", seconds=5.0)
    assert "gone" in page.text_content("#status")
    drag(page, "joint1", 0.5)
    check(page, model.robot, model.tip, np.array([0.5, 0.0]))


@pytest.mark.slow
def test_the_whole_robot_is_in_sight(open_page: Open, tmp_path: Path) -> None:
    for name in ARMS:
        page = open_page(saved(model_of(name), tmp_path), offline=True)
        outside = page.evaluate(
            """() => {
              const { viewer, tree } = pinscrew.app;
              return tree.corners().map((c) => c.project(viewer.camera))
                .filter((c) => Math.abs(c.x) > 1 || Math.abs(c.y) > 1 || Math.abs(c.z) > 1).length;
            }"""
        )
        assert outside == 0
        for label in ("#pose-title", "#jacobian-title", "#draw", "#tip", "#kind"):
            assert page.locator(label).is_visible()
        colored = page.evaluate(
            """async () => {
              const image = new Image();
              image.src = pinscrew.app.viewer.capture_image();
              await image.decode();
              const canvas = document.createElement("canvas");
              [canvas.width, canvas.height] = [image.width, image.height];
              const context = canvas.getContext("2d");
              context.drawImage(image, 0, 0);
              const { data } = context.getImageData(0, 0, image.width, image.height);
              let count = 0;
              for (let i = 0; i < data.length; i += 4) {
                count += Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 60;
              }
              return count / (image.width * image.height);
            }"""
        )
        assert 0.003 < colored < 0.6, name


def test_a_picture(browser: Any) -> None:
    model = model_of("scara_rrp")
    made = prepare.picture(model, prepare.begin(model, [0.3, 0.5, 0.1]), 640, 480)
    context = browser.new_context()
    page = context.new_page()
    size, shades = page.evaluate(
        """async (data) => {
          const image = new Image();
          image.src = "data:image/png;base64," + data;
          await image.decode();
          const canvas = document.createElement("canvas");
          [canvas.width, canvas.height] = [image.width, image.height];
          const context = canvas.getContext("2d");
          context.drawImage(image, 0, 0);
          const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
          let count = 0;
          for (let i = 0; i < pixels.length; i += 4) {
            count += pixels[i + 1] > pixels[i] + 60;  // the green link
          }
          return [[image.width, image.height], count];
        }""",
        base64.b64encode(made).decode(),
    )
    context.close()
    assert size == [640, 480]
    assert shades > 300
