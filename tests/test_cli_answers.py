"""The numbers that ``screws``, ``fk`` and ``jacobian`` print, in every format, against the engines asked directly."""

from __future__ import annotations

import csv
import io
import json
import re
from itertools import pairwise, product
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import pinscrew as ps
import urdfs
from command_line import ok, refusal, refused, run
from pinscrew.ground.typing import FloatArray

DRONE = ps.load("drone")  # a plain URDF loads without a child process
Q = (0.3, -0.7, 0.1)

# ------------------------------------------------------------------------------------------------ screws

OPTIONS = [
    pytest.param(robot, words, id=" ".join((robot, *words)))
    for robot, words in (
        ("scara", ("l1:=0.5", "--order", "w,v")),
        ("drone", ()),
        ("drone", ("--tip", "link2")),
        ("drone", ("--at", "body", "--tip", "obstacle")),
        ("planar_2r", ("--at", "body", "--order", "w,v")),
        ("planar_2r", ("--reference", "frame0")),
        ("planar_2r", ("--reference", "frame0", "--order", "w,v", "--tip", "link2")),
    )
]


def expected(robot: str, words: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    """Screw axes and home pose as Python gives them."""
    arguments = dict(word.split(":=") for word in words if ":=" in word)
    options = {name[2:]: value for name, value in pairwise(words) if name.startswith("--")}
    loaded = ps.load(robot, arguments=arguments)
    tip, reference = options.get("tip"), options.get("reference")
    axes = loaded.screws(tip, at=options.get("at", "space"), reference=reference)
    if options.get("order") == "w,v":
        axes = axes[[3, 4, 5, 0, 1, 2]]
    return axes, loaded.home(tip, reference=reference)


def from_json(text: str) -> tuple[Any, Any]:
    document = json.loads(text)
    return document["screws"], document["home"]


def from_python(text: str) -> tuple[Any, Any]:
    names: dict[str, Any] = {}
    exec(text, names)  # noqa: S102 (it is what the command is for)
    return names["screws"], names["M"]


def from_matlab(text: str) -> tuple[Any, Any]:
    blocks = dict(re.findall(r"^(\w+) = \[\n(.*?)\n\];$", text, re.MULTILINE | re.DOTALL))
    return tuple([[float(x) for x in row.split()] for row in blocks[name].split("\n")] for name in ("screws", "M"))


def from_latex(text: str) -> tuple[Any, Any]:
    text = re.sub(r" \\times 10\^\{(-?\d+)\}", r"e\1", text)
    bodies = re.findall(r"\\\[ \S+ =\n\\begin\{bmatrix\}\n(.*?)\n\\end\{bmatrix\} \\\]", text, re.DOTALL)
    screws, home = ([[float(x) for x in row[:-3].split("&")] for row in body.split("\n")] for body in bodies)
    return screws, home


READERS = {"json": from_json, "python": from_python, "matlab": from_matlab, "latex": from_latex}


@pytest.mark.parametrize(("robot", "words"), OPTIONS)
def test_screws(robot: str, words: tuple[str, ...]) -> None:
    """All digits in every format but LaTeX, which is for reading: it has nine, and no rounding of zero."""
    axes, home = expected(robot, words)
    for form, reader in READERS.items():
        done = ok("screws", robot, *words, "--format", form)
        assert done.err == ""
        relative, absolute = (1e-8, 1e-12) if form == "latex" else (0.0, 0.0)
        for found, truth in zip(reader(done.out), (axes, home), strict=True):
            np.testing.assert_allclose(found, truth, rtol=relative, atol=absolute, err_msg=form)
        assert "-0.0," not in done.out
        assert not re.search(r"-0(\.0)?\b(?!\.)", done.out), "no minus zeros"
    rows = list(csv.reader(io.StringIO(ok("screws", robot, *words, "--format", "csv").out)))
    order = ["wx", "wy", "wz", "vx", "vy", "vz"] if "w,v" in words else ["vx", "vy", "vz", "wx", "wy", "wz"]
    assert rows[0] == ["joint", *order]
    assert [row[0] for row in rows[1:]] == list(ps.load(robot).velocity_names)
    np.testing.assert_array_equal(np.array([row[1:] for row in rows[1:]], dtype=float).T, axes)


def test_screws_say_what_they_are() -> None:
    words = ("screws", "drone", "--at", "body", "--order", "w,v")
    said = json.loads(ok(*words, "--json").out)
    assert {name: said[name] for name in ("schema", "robot", "base", "tip", "at", "rows", "columns")} == {
        "schema": "pinscrew.screws/1",
        "robot": "drone",
        "base": "base",
        "tip": "tool",
        "at": "body",
        "rows": ["wx", "wy", "wz", "vx", "vy", "vz"],
        "columns": ["joint1", "joint2", "joint3"],
    }
    comment = "body screw axes in tool: rows wx, wy, wz, vx, vy, vz; columns joint1, joint2, joint3"
    assert f"# {comment}\n" in ok(*words, "--format", "python").out
    assert f"% {comment}\n" in ok(*words, "--format", "matlab").out
    assert r"\mathcal{B}" in ok(*words, "--format", "latex").out
    assert r"\mathcal{S}" in ok("screws", "drone", "--format", "latex").out
    assert json.loads(ok("screws", "planar_2r", "--reference", "frame0", "--json").out)["base"] == "frame0"


def test_screws_table() -> None:
    lines = ok("screws", "scara", "l1:=0.5").out.splitlines()
    assert lines[0] == "scara_rrp: space screw axes of tool, in base (m, rad; pitch in m/rad)"
    assert re.split(r"  +", lines[1].strip()) == ["joint", "twist (v, ω)", "direction", "through", "pitch", "magnitude"]
    assert [re.split(r"  +", line.strip()) for line in lines[2:5]] == [
        ["joint1", "[0, 0, 0, 0, 0, 1]", "[0, 0, 1]", "[0, 0, 0]", "0", "1"],
        ["joint2", "[0, -0.5, 0, 0, 0, 1]", "[0, 0, 1]", "[0.5, 0, 0]", "0", "1"],
        ["joint3", "[0, 0, -1, 0, 0, 0]", "[0, 0, -1]", "[0, 0, 0]", "translation", "1"],
    ]
    assert lines[5:7] == ["", "home pose M: tool in base at zero"]
    home = [line.split() for line in lines[-4:]]
    np.testing.assert_array_equal(np.array(home, dtype=float)[:, 3], [0.8, 0, 0, 1])


def test_screws_table_tells_the_pitch_of_a_lead_screw() -> None:
    lines = ok("screws", "lead_screw").out.splitlines()
    row = re.split(r"  +", lines[2].strip())
    assert row[4] == f"{0.005 / (2 * np.pi):.6g}"
    assert lines[3] == "joint2 follows joint1 times 0.000795775, and is in its screw"


def test_screws_table_leaves_out_what_does_not_move_the_tip(tmp_path: Any) -> None:
    """Joints of another branch have no screw, and mimics of another branch are in none."""
    other = urdfs.joint("c", "revolute", "base", "z", mimic=("a", 2.0, 0.0))
    robot = urdfs.robot(
        urdfs.joint("a", "revolute", "base", "x"), urdfs.joint("b", "revolute", "base", "y"), other, links="base x y z"
    )
    file = tmp_path / "tree.urdf"
    file.write_text(robot)
    lines = ok("screws", file, "--tip", "x").out.splitlines()
    assert "not moving x: b" in lines
    assert not any("follows" in line for line in lines)
    assert "c follows a times 2, and is in its screw" in ok("screws", file, "--tip", "z").out.splitlines()


def test_screws_without_joints(tmp_path: Any) -> None:
    file = tmp_path / "still.urdf"
    file.write_text(urdfs.only_fixed())
    screws, home = from_python(ok("screws", file, "--format", "python").out)
    assert screws.shape == (6, 0)
    np.testing.assert_array_equal(home, urdfs.load(urdfs.only_fixed()).home())
    assert ok("screws", file, "--format", "csv").out == "joint,vx,vy,vz,wx,wy,wz\n"
    assert ok("screws", file).out.startswith("still: space screw axes of tool")


def test_screws_refuse() -> None:
    moving = refusal("screws", "2r", "--reference", "link1")
    assert (moving.code, moving.where) == ("reference", "planar_2r")
    assert "'link1'" in moving.what
    unknown = refusal("screws", "2r", "--reference", "frame9")
    assert (unknown.code, unknown.where) == ("unknown-frame", "planar_2r")
    assert "'frame9'" in unknown.what
    together = refusal("screws", "2r", "--reference", "frame0", "--at", "body")
    assert "reference" in together.remedy
    for option, value in (("--order", "v"), ("--format", "yaml")):
        message = refused("screws", "2r", option, value)
        assert option in message
        assert repr(value) in message


# --------------------------------------------------------------------------------------- fk and jacobian


def asked_directly(frame: str, q: tuple[float, ...]) -> tuple[pin.Model, pin.Data, int]:
    """Pinocchio's own functions, on the text of the robot, which needs no mapping of coordinates."""
    model = pin.buildModelFromXML(DRONE.description.text)
    data = model.createData()
    pin.computeJointJacobians(model, data, np.array(q))
    pin.updateFramePlacements(model, data)
    return model, data, model.getFrameId(frame)


@pytest.mark.parametrize("frame", ["tool", "link2", "base"])
def test_fk(frame: str) -> None:
    _, data, index = asked_directly(frame, Q)
    truth = data.oMf[index].homogeneous
    words = ("fk", "drone", "-q", ",".join(map(str, Q)), "--tip", frame)
    done = ok(*words, "--json")
    said = json.loads(done.out)
    np.testing.assert_allclose(said["pose"], truth, atol=1e-15)
    assert done.err == ""
    assert said["q"] == dict(zip(("joint1", "joint2", "joint3"), Q, strict=True))
    assert (said["schema"], said["robot"], said["base"], said["frame"]) == (
        "pinscrew.fk/1", "drone", "base", frame
    )  # fmt: skip
    assert 0.0 <= said["difference"] < 1e-15
    done = ok(*words)
    assert done.out.splitlines()[0] == f"{frame} in base:"
    printed = [[float(x) for x in line.split()] for line in done.out.splitlines()[1:]]
    np.testing.assert_allclose(printed, truth, atol=0.5000001e-6)
    assert re.fullmatch(r"PoE and Pinocchio differ by \d\.\de[+-]\d\d\n", done.err)


KINDS = {"spatial": pin.WORLD, "body": pin.LOCAL, "hybrid": pin.LOCAL_WORLD_ALIGNED}
SYNONYMS = {"WORLD": "spatial", "LOCAL": "body", "LOCAL_WORLD_ALIGNED": "hybrid"}


@pytest.mark.parametrize(("kind", "frame"), list(product((*KINDS, *SYNONYMS), ["tool", "link2"])))
def test_jacobian(kind: str, frame: str) -> None:
    model, data, index = asked_directly(frame, Q)
    name = SYNONYMS.get(kind, kind)
    truth = pin.getFrameJacobian(model, data, index, KINDS[name])
    words = ("jacobian", "drone", "-q", ",".join(map(str, Q)), "--kind", kind, "--tip", frame)
    said = json.loads(ok(*words, "--json").out)
    np.testing.assert_allclose(said["jacobian"], truth, atol=1e-15)
    assert (said["schema"], said["kind"], said["frame"]) == ("pinscrew.jacobian/1", name, frame)
    assert said["rows"] == ["vx", "vy", "vz", "wx", "wy", "wz"]
    assert said["columns"] == ["joint1", "joint2", "joint3"]
    assert 0.0 <= said["difference"] < 1e-15
    done = ok(*words)
    heading, *rows = done.out.splitlines()
    assert heading == f"{name} Jacobian of {frame}; columns: joint1, joint2, joint3"
    assert [row.split()[0] for row in rows] == said["rows"]
    np.testing.assert_allclose([[float(x) for x in row.split()[1:]] for row in rows], truth, atol=0.5000001e-6)
    assert done.err.startswith("PoE and Pinocchio differ by ")


@pytest.mark.parametrize(
    ("values", "q"),
    [
        ("-1.0,0.5,0.1", (-1.0, 0.5, 0.1)),
        ("2cm,pi/4,0.1rad", (0.02, np.pi / 4, 0.1)),
        ("joint3=0.1,joint1=-pi/2", (-np.pi / 2, 0.0, 0.1)),
        (None, (0.0, 0.0, 0.0)),
    ],
)
def test_values(values: str | None, q: tuple[float, ...]) -> None:
    given = [] if values is None else ["-q", values]
    said = json.loads(ok("fk", "drone", *given, "--json").out)
    assert tuple(said["q"].values()) == pytest.approx(q, rel=1e-15)
    _, data, index = asked_directly("tool", q)
    np.testing.assert_allclose(said["pose"], data.oMf[index].homogeneous, atol=1e-15)


def test_a_kind_is_due() -> None:
    done = run("jacobian", "drone")
    assert (done.status, done.out) == (2, "")
    assert "Error: Missing option '--kind'. Choose from:" in done.err
    assert refused("jacobian", "drone", "--kind", "geometric").startswith("Invalid value for '--kind'")


def test_without_coordinates(tmp_path: Any) -> None:
    file = tmp_path / "still.urdf"
    file.write_text(urdfs.only_fixed())
    said = json.loads(ok("jacobian", file, "--kind", "body", "--json").out)
    assert said["jacobian"] == [[]] * 6
    assert ok("fk", file).out
    assert refused("fk", file, "-q", "1") == "Invalid value for -q: 1 values, but still takes 0: none"


@pytest.mark.parametrize("command", [("fk",), ("jacobian", "--kind", "spatial")], ids=lambda words: words[0])
@pytest.mark.parametrize("form", [(), ("--json",)], ids=["text", "json"])
def test_engines_that_disagree(
    command: tuple[str, ...], form: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The answer, by how much they differ, and status 1."""

    class Off(ps.Pinocchio):
        def fk(self, *args: Any, **options: Any) -> FloatArray:
            T = np.array(super().fk(*args, **options))
            T[0, 3] += 1e-3
            return T

        def jacobian(self, *args: Any, **options: Any) -> FloatArray:
            J = np.array(super().jacobian(*args, **options))
            J[0, 0] += 1e-3
            return J

    name, *words = command
    right = run(name, "drone", *words, *form)
    monkeypatch.setattr(ps, "Pinocchio", Off)
    wrong = run(name, "drone", *words, *form)
    assert (right.status, wrong.status) == (0, 1)
    if form:
        difference = json.loads(wrong.out)["difference"]
        assert 1e-4 < difference < 1e-2
        assert json.loads(wrong.out) == {**json.loads(right.out), "difference": difference}
    else:
        assert wrong.out == right.out
        assert re.search(r"differ by \d\.\de-0[34]", wrong.err)
