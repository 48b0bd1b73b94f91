"""What the commands take: robots with xacro arguments, configurations, numbers."""

from __future__ import annotations

import json
import math
from pathlib import Path

import click
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import urdfs
from command_line import ok, refusal, refused
from pinscrew.cli import fk
from pinscrew.cli.arguments import Named, configuration, number, robots
from pinscrew.description.catalogue import bundled
from pinscrew.ground.errors import PinscrewWarning
from pinscrew.ground.expressions import Unit

PI = math.pi

# ----------------------------------------------------------------------------------------------- numbers

NUMBERS = {
    "0": 0.0,
    "-1.0": -1.0,
    "+.5": 0.5,
    " 1e-3 ": 1e-3,
    "1_000": 1000.0,
    "pi": PI,
    "-pi/4": -PI / 4,
    "2pi": 2 * PI,
    "2 pi / 3": 2 * PI / 3,
    "-2*pi/3": -2 * PI / 3,
    "45deg": PI / 4,
    "-45 deg": -PI / 4,
    "0.5deg": math.radians(0.5),
    "1e1deg": math.radians(10),
    "90deg+0.1": PI / 2 + 0.1,
    "(30+60)deg": PI / 2,
    "90*deg": PI / 2,
    "deg": PI / 180,
    "2*(pi-1)": 2 * (PI - 1),
    "1-2-3": -4.0,
    "--1": 1.0,
    "1/3": 1 / 3,
}

GARBAGE = (
    "",
    " ",
    "x",
    "1..2",
    "1 2",
    "deg45",
    "45degrees",
    "45°",
    "pi pi",
    "__import__('os')",
    "__import__('os').system('true')",
    "().__class__",
    "pi.real",
    "[1][0]",
    "(lambda: 1)()",
    "abs(-1)",
    "1 if 1 else 2",
    "1if 1else 2",
    "1 < 2",
    "1 and 2",
    "not 1",
    "~1",
    "(x:=1)",
    "1j",
    "'1'",
    "b'1'",
    "f'1'",
    "None",
    "True",
    "False",
    "...",
    "nan",
    "inf",
    "1/0",
    "0/0",
    "1/(1-1)",
    "9**9",
    "9**9**9",
    "7//2",
    "7%2",
    "1<<9",
    "1e999",
    "-1e999",
    "1e308*10",
    "1e308*10-1e308*10",
    "1;2",
    "1#2\n3",
    "1\n+1)",
    "1\x00",
    "\udcff",
    "(" * 99,
    "(" * 49 + "1" + ")" * 50,
    "(" * 1000 + "1" + ")" * 1000,
    "-" * 1000 + "1",
    "1+" * 5000 + "1",
    "9" * 101,
)


@pytest.mark.parametrize(("text", "value"), NUMBERS.items())
def test_number(text: str, value: float) -> None:
    assert number(text, "-q", "rad") == pytest.approx(value, rel=1e-15, abs=0)


@pytest.mark.parametrize("text", GARBAGE)
def test_what_is_not_a_number(text: str) -> None:
    with pytest.raises(click.BadParameter) as caught:
        number(text, "-q", "rad", of="j1")
    assert caught.value.message.startswith("j1: ")
    assert caught.value.message.endswith("is not a number; write such as 0.1, pi/4 or 45deg")
    assert len(caught.value.message) < 300
    assert caught.value.param_hint == "-q"


@given(st.floats(allow_nan=False, allow_infinity=False))
@example(5e-324)
@example(-1.7976931348623157e308)
def test_every_float_is_read_as_it_is_written(value: float) -> None:
    assert number(repr(value), "-q") == value


UNITS = {
    "45deg": (PI / 4, "rad"),
    "0.5rad": (0.5, "rad"),
    "2cm": (0.02, "m"),
    "30mm": (0.03, "m"),
    "1.5 m": (1.5, "m"),
    "0.1": (0.1, ""),
    "pi/4": (PI / 4, ""),
    "pi/2 - 10deg": (PI / 2 - math.radians(10), "rad"),
    "1m - 2cm*3": (0.94, "m"),
    "90deg/rad": (PI / 2, ""),
    "2*pi*3mm": (2 * PI * 0.003, "m"),
    "-(1cm + 5mm)/2": (-0.0075, "m"),
}


@pytest.mark.parametrize("text", UNITS)
def test_units(text: str) -> None:
    value, unit = UNITS[text]
    for needed in ("rad", "m", ""):
        if unit in ("", needed):
            assert number(text, "-q", needed) == pytest.approx(value, rel=1e-15)
            continue
        with pytest.raises(click.BadParameter) as caught:
            number(text, "-q", needed, of="j1")
        name = {"rad": "an angle", "m": "a length", "": "a number"}
        assert caught.value.message.startswith(f"j1: {text!r} is {name[unit]}, where {name[needed]} is needed; write ")


@pytest.mark.parametrize("text", ["2cm + 1deg", "1deg - 1m", "2cm*2cm", "1deg*1mm", "1/deg", "1deg/2cm", "2/(1m)"])
def test_units_that_do_not_fit_together(text: str) -> None:
    with pytest.raises(click.BadParameter) as caught:
        number(text, "-q", "m")
    assert caught.value.message.startswith(f"in {text!r}, a")
    assert caught.value.message.endswith("; use one unit")


@pytest.mark.parametrize("unit", ["rad", "m"])
def test_a_number_without_a_unit_may_have_that_of_its_option(unit: Unit) -> None:
    for text, value in (("3", 0.003), ("3e0*1", 0.003), ("3rad", 3.0), ("3m", 3.0)):
        if text.endswith(unit) or text[-1].isdigit():
            assert number(text, "--tolerance", unit, plain=1e-3) == value


def test_degrees_typed_as_radians() -> None:
    """45 rad are 2578°; as 45° they would be within the limits."""
    limits = (-math.radians(95), math.radians(95))
    turns = urdfs.robot(
        urdfs.joint("a", "revolute", "base", "b", limits=limits),
        urdfs.joint("c", "continuous", "b", "d"),
        urdfs.joint("e", "prismatic", "d", "f", limits=(-1.0, 1.0)),
        links="base b d f",
    )
    robot = urdfs.load(turns)
    with pytest.warns(PinscrewWarning) as warned:
        q = configuration(robot, "90,45,7")
    assert [w.message.code for w in warned if isinstance(w.message, PinscrewWarning)] == ["looks-like-degrees"]
    assert "a = 90 rad is outside its limits; if degrees are meant, write 90deg" in str(warned[0].message)
    assert q.tolist() == [90.0, 45.0, 7.0]
    for quiet in ("90deg,0,0", "6.2,0,0", "-96,0,0", "1.5,0,0"):
        configuration(robot, quiet)


@given(st.text(st.sampled_from("0123456789.e+-*/() pideg"), max_size=30))
def test_any_text_is_a_finite_number_or_none(text: str) -> None:
    try:
        value = number(text, "-q")
    except click.BadParameter:
        return
    assert math.isfinite(value)


# ------------------------------------------------------------------------------------------ configurations

SMALL = urdfs.load(urdfs.rotated())  # j1, j2, j3
FLOATING = urdfs.load(urdfs.floating_middle())


@pytest.mark.parametrize(
    ("values", "q"),
    [
        (None, [0, 0, 0]),
        ("", [0, 0, 0]),
        ("-1.0,0.5,0.1", [-1, 0.5, 0.1]),
        (" 45deg , pi/4,1 ", [PI / 4, PI / 4, 1]),
        ("=1,2,3", [1, 2, 3]),
        ("j2=0.1", [0, 0.1, 0]),
        ("j3 = -pi/2 , j1=1", [1, 0, -PI / 2]),
        ("j1=1,j2=2,j3=3", [1, 2, 3]),
    ],
)
def test_configuration(values: str | None, q: list[float]) -> None:
    np.testing.assert_array_equal(configuration(SMALL, values), q)


def test_default_configuration_is_neutral_and_free() -> None:
    q = configuration(FLOATING, None)
    np.testing.assert_array_equal(q, FLOATING.neutral)
    q[0] = 1.0  # not the robot's own
    assert FLOATING.neutral[0] == 0.0
    moved = configuration(FLOATING, "free.x=2,wrist=1")
    names = [name for name, value in zip(FLOATING.coordinate_names, moved, strict=True) if value]
    assert names == ["free.x", "free.qw", "wrist"]
    assert moved.sum() == 4.0


ASK = {"fk": ("fk", "drone"), "jacobian": ("jacobian", "drone", "--kind", "body")}
WRONG = {
    "1,2": ("2 values", "drone", "3", "joint1, joint2, joint3"),
    "1": ("1 values", "drone", "3", "joint1, joint2, joint3"),
    "1,2,3,4": ("4 values", "3"),
    "1,2,3,": ("4 values", "3"),
    "1,,3": ("''", "number"),
    "1,two,3": ("'two'", "number", "pi/4", "45deg"),
    "joint1=1,2,3": ("'2'", "NAME=VALUE"),
    "joint2=1,=1": ("'=1'", "NAME=VALUE"),
    "joint1=": ("''", "number"),
    "joint1==1": ("'=1'", "number"),
    "joint1=1,joint1=2": ("'joint1'", "twice"),
    "__import__('os'),1,1": ("__import__('os')", "number"),
    "nan,0,0": ("'nan'", "number"),
    "1e999,0,0": ("'1e999'", "number"),
}
"""What is wrong, and what the message must say of it."""


@pytest.mark.parametrize("command", ASK.values(), ids=ASK)
@pytest.mark.parametrize(("values", "facts"), WRONG.items())
def test_wrong_configuration(command: tuple[str, ...], values: str, facts: tuple[str, ...]) -> None:
    message = refused(*command, "-q", values)
    assert "-q" in message
    assert [fact for fact in facts if fact not in message] == []


@pytest.mark.parametrize("command", ASK.values(), ids=ASK)
@pytest.mark.parametrize("name", ["elbow", "joint1.x"])
def test_unknown_joint(command: tuple[str, ...], name: str) -> None:
    expected = f"drone: there is no coordinate {name!r}; known are: joint1, joint2, joint3"
    assert refused(*command, "-q", f"joint2=1,{name}=1") == expected


def test_quaternions_must_have_unit_norm(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(urdfs.floating_middle())
    assert refused("fk", file, "-q", "free.qx=1").endswith("of 'free' has norm 1.41421; normalise it")


# ----------------------------------------------------------------------------------------------- robots


def test_words_to_robots() -> None:
    with click.Context(fk.command):
        found = robots(["scara", "l1:=0.4", "l2:=${x}:=1", "arm.urdf", "x:=", "y:=a b", "gears"])
    assert found == [
        Named("scara", {"l1": "0.4", "l2": "${x}:=1"}),
        Named("arm.urdf", {"x": "", "y": "a b"}),
        Named("gears"),
    ]


def test_xacro_arguments() -> None:
    said = json.loads(ok("fk", "scara", "l1:=0.5", "l2:=0.25", "--json").out)
    np.testing.assert_allclose(np.array(said["pose"])[:3, 3], [0.75, 0, 0], rtol=1e-15)


def test_packages_and_floating_bases(tmp_path: Path) -> None:
    (tmp_path / "arms").mkdir()
    (tmp_path / "arms" / "l.xacro").write_text('<r xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/></r>')
    file = tmp_path / "arm.xacro"
    include = '<xacro:include filename="$(find arms)/l.xacro"/>'
    file.write_text(f'<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">{include}</robot>')
    package = f"arms:={tmp_path / 'arms'}"
    said = json.loads(ok("fk", file, "--package", package, "--floating-base", "-q", "root_joint.x=3", "--json").out)
    assert said["base"] == "universe"
    assert said["pose"][0] == [1, 0, 0, 3]
    assert "arms" in refused("fk", file)
    assert refused("fk", file, "--package", "arms") == "Invalid value for '--package': 'arms' is not NAME:=PATH"


def test_options_may_come_anywhere() -> None:
    one = ok("fk", "--tip", "link2", "scara", "-q", "1,1,0", "l1:=0.5")
    other = ok("fk", "scara", "l1:=0.5", "--tip=link2", "-q=1,1,0")
    assert one == other


BAD_ROBOTS = {
    ("scara", "l9:=1"): ("xacro-argument", "scara_rrp.urdf.xacro", "'l9'", "l1:=0.4, l2:=0.3"),
    ("drone", "l9:=1"): ("xacro-argument", "drone.urdf", "l9", "leave them out"),
    ("scar",): ("unknown-robot", "'scar'", "known are: scara, scara_rrp"),
    ("planar2r",): ("unknown-robot", "'planar2r'", "known are: planar_2r"),
    ("",): ("unknown-robot", "''", "known are: "),
    ("arm.urdf",): ("no-file", "arm.urdf"),
    ("arm.urdf.xacro",): ("no-file", "arm.urdf.xacro"),
}
"""The code of the error, and what its message must say."""


@pytest.mark.parametrize("command", [("fk",), ("screws",), ("jacobian", "--kind", "body")], ids=lambda c: c[0])
@pytest.mark.parametrize(("words", "facts"), BAD_ROBOTS.items(), ids=map(" ".join, BAD_ROBOTS))
def test_bad_robot(command: tuple[str, ...], words: tuple[str, ...], facts: tuple[str, ...]) -> None:
    code, *facts_said = facts
    error = refusal(*command, *words)
    assert error.code == code
    assert [fact for fact in facts_said if fact not in str(error)] == []


@pytest.mark.parametrize("command", ["fk", "screws"])
def test_one_robot(command: str) -> None:
    several = refused(command, "drone", "gears")
    assert "one robot" in several
    assert "drone, gears" in several
    assert "ROBOT" in refused(command)
    assert "l1:=1" in refused(command, "l1:=1", "scara")
    error = refusal(command, "drone", "--tip", "hand")
    assert (error.code, error.where) == ("unknown-frame", "drone")
    assert "'hand'" in error.what
    assert "base" in str(error)


@pytest.mark.parametrize("command", ["fk", "screws"])
def test_no_default_tip(command: str, tmp_path: Path) -> None:
    file = tmp_path / "tree.urdf"
    file.write_text(urdfs.tree())
    error = refusal(command, file)
    assert (error.code, error.where) == ("ambiguous-tip", "tree")
    assert "l2, camera" in str(error)
    assert ok(command, file, "--tip", "camera").out


def test_files_that_are_no_robots(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text("<robot name='x'>\n<link name='base'>")
    error = refusal("fk", file)
    assert (error.code, error.where) == ("not-xml", f"{file}:2")
    file.write_bytes(b"\xff\xfe")
    assert refusal("fk", file).code == "encoding"
    assert refusal("fk", tmp_path).code == "unknown-robot"
    folder = tmp_path / "folder.urdf"
    folder.mkdir()
    assert refusal("fk", folder).code == "unreadable"


def test_names_are_completed() -> None:
    (argument,) = (p for p in fk.command.params if p.name == "words")
    context = click.Context(fk.command)
    assert [item.value for item in argument.shell_complete(context, "planar")] == ["planar_2r", "planar_rrr"]
    (item,) = argument.shell_complete(context, "./arm")
    assert (item.value, item.type) == ("./arm", "file")
    assert len(argument.shell_complete(context, "")) == len(bundled())
