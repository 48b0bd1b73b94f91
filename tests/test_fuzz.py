"""Random robots, on which the engines must agree, and valid files broken at random, which must hurt nobody."""

from __future__ import annotations

import copy
import math
import random
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Final
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import pinscrew as ps
import urdfs
from pinscrew.description import catalogue, markup, urdf
from pinscrew.description.expand import expand
from pinscrew.description.structure import MAX_NUMBER
from pinscrew.ground.errors import PinscrewError, PinscrewWarning
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import FLOATING_JOINT, UNIVERSE

TOLERANCE: Final = 1e-12
SLOW: Final = pytest.mark.slow
QUICK: Final = settings(max_examples=100, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
LONG: Final = settings(QUICK, max_examples=1000)


def parse(text: str) -> ps.Robot:
    """The robot of a text; that axes are normalised is no news here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        return ps.Robot.from_description(urdf.parse(text, "fuzz.urdf"))


# ------------------------------------------------------------------------------------------------- random robots

ODD: Final = st.text(
    st.characters(codec="utf-8", exclude_categories=("Cc", "Cs"), include_characters="\n\t\r"), min_size=1, max_size=8
)
NAMES: Final = st.one_of(st.from_regex(r"[a-z_][a-z0-9_]{0,8}", fullmatch=True), ODD).filter(
    lambda name: (
        name.strip(" \t\r\n")
        and name not in (UNIVERSE, FLOATING_JOINT)
        and "\ufffe" not in name
        and "\uffff" not in name
    )
)
KINDS: Final = (*urdfs.SCALAR, *urdfs.SCALAR, "fixed", "planar", "floating")


@st.composite
def robots(draw: st.DrawFn) -> tuple[str, float]:
    """A random tree of up to 9 joints and the metres that its lengths are in, its elements in any order."""
    count = draw(st.integers(0, 9))
    scale = 10.0 ** draw(st.integers(-9, 6))
    links = draw(st.lists(NAMES, min_size=count + 1, max_size=count + 1, unique=True))
    names = draw(st.lists(NAMES, min_size=count, max_size=count, unique=True))
    kinds = [draw(st.sampled_from(KINDS)) for _ in range(count)]
    scalar = [i for i, kind in enumerate(kinds) if kind in urdfs.SCALAR]
    order = draw(st.permutations(scalar))  # a joint may mimic those before it here, wherever they are in the file
    number = st.floats(-1.0, 1.0).map(lambda x: round(x, draw(st.integers(1, 17))))
    elements = [f"<link name={quoteattr(name)}/>" for name in links]
    for i, (name, kind) in enumerate(zip(names, kinds, strict=True)):
        xyz = " ".join(repr(scale * draw(number)) for _ in range(3))
        rpy = " ".join(repr(math.pi * draw(number)) for _ in range(3))
        parts = [
            f"<parent link={quoteattr(links[draw(st.integers(0, i))])}/>",
            f"<child link={quoteattr(links[i + 1])}/>",
        ]
        if draw(st.booleans()):
            parts.append(f'<origin xyz="{xyz}" rpy="{rpy}"/>')
        if kind == "planar":
            parts.append('<axis xyz="0 0 1"/>')
        elif kind in urdfs.SCALAR:
            axis = draw(st.lists(st.integers(-5, 5), min_size=3, max_size=3).filter(any))
            parts.append(f'<axis xyz="{axis[0]} {axis[1]} {axis[2]}"/>')
            reach = scale if kind == "prismatic" else 1.0
            parts.append(f'<limit lower="{-reach!r}" upper="{2 * reach!r}" effort="1" velocity="1"/>')
            earlier = order[: order.index(i)]
            if earlier and draw(st.booleans()):
                master = draw(st.sampled_from(earlier))
                # Metres per radian, radians per metre: what keeps angles small and lengths of the robot's size.
                unit = (scale if kind == "prismatic" else 1.0) / (scale if kinds[master] == "prismatic" else 1.0)
                multiplier, offset = 2 * draw(number) * unit, draw(number) * reach
                words = f'joint={quoteattr(names[master])} multiplier="{multiplier!r}" offset="{offset!r}"'
                if max(abs(multiplier), abs(offset)) < MAX_NUMBER:
                    parts.append(f"<mimic {words}/>")
        inner = "".join(draw(st.permutations(parts)))
        elements.append(f'<joint name={quoteattr(name)} type="{kind}">{inner}</joint>')
    return f'<robot name="fuzz">{"".join(draw(st.permutations(elements)))}</robot>', scale


def sample(robot: ps.Robot, scale: float) -> tuple[FloatArray, FloatArray]:
    """Three configurations with lengths of the robot's size."""
    q, qd = urdfs.sample(robot, 3)
    for motion in robot.mechanism.motions:
        if motion.joint.mimic is None:
            lengths = {"prismatic": 1, "planar": 2, "floating": 3}.get(motion.joint.type, 0)
            q[:, motion.q : motion.q + lengths] *= scale
    return q, qd


def agree(text: str, scale: float) -> None:
    """Both engines' answers are the same to 12 digits of what each entry can be, whatever the robot's size.

    `verify` divides by max(1, size) instead, and by nothing for Jacobians, which is not fair to robots whose mimics
    have multipliers of hundreds; it is asked about the others.
    """
    robot = parse(text)
    q, qd = sample(robot, scale)
    a, b = (engine.answers(q, qd, robot.frame_names) for engine in (ps.PoE(robot), ps.Pinocchio(robot)))
    J = np.stack(list(a.jacobians.values()))
    linear, angular = (abs(part).max(axis=(0, 1, 2, 3)) for part in (J[..., :3, :], J[..., 3:, :]))
    size = max(robot.reach, abs(a.poses[..., :3, 3]).max())
    linear += size * angular
    turn = max(1.0, angular.max(initial=0.0))
    same(a.poses[..., :3, :3], b.poses[..., :3, :3], turn)
    same(a.poses[..., :3, 3], b.poses[..., :3, 3], turn * size)
    for kind, J in a.jacobians.items():
        same(J[..., :3, :], b.jacobians[kind][..., :3, :], turn * linear)
        same(J[..., 3:, :], b.jacobians[kind][..., 3:, :], turn * angular)
    for kind, dJ in a.derivatives.items():
        other = b.derivatives[kind]
        same(dJ[..., 3:, :], other[..., 3:, :], turn * angular.sum() * angular)
        same(dJ[..., :3, :], other[..., :3, :], turn * (angular.sum() * linear + linear.sum() * angular))
    if all(motion.joint.mimic is None for motion in robot.mechanism.motions):
        assert ps.verify(robot, samples=2).ok


def same(a: FloatArray, b: FloatArray, largest: FloatArray | float) -> None:
    """Whether two arrays are equal to rounding of numbers that can be this large; NaN is not."""
    assert (abs(a - b) <= TOLERANCE * largest).all(), abs(a - b).max()


@QUICK
@given(robots())
def test_engines_agree(robot: tuple[str, float]) -> None:
    agree(*robot)


@SLOW
@LONG
@given(robots())
def test_engines_agree_on_many(robot: tuple[str, float]) -> None:
    agree(*robot)


# -------------------------------------------------------------------------------------------------- broken files

VALID: Final = (
    *urdfs.ROBOTS.values(),
    catalogue.find("drone").file.read_text(),
    catalogue.find("planar_2r").file.read_text(),
)
WORDS: Final = (
    *("", " ", "0", "-0", "1", "-1", "0.5", "1e-9", "1e-320", "1e2", "1e300", "nan", "inf", "1_0", "1,5", "0x1", "x"),
    *("0 0 0", "1 0 0", "0 0 -1", "0 0 1", "1 2 3", "1 2", "1 2 3 4", "1e-9 0 0", "3 4 5e2", "nan 0 0", "\u00a01 2 3"),
    *("fixed", "revolute", "continuous", "prismatic", "planar", "floating", "universe", "base", "tool", "j", "a"),
    *("${x}", "../..", "é", "שלום", "😀", "a\nb", "\u202e", "<&>'\"", "x" * 300),
)
TAGS: Final = (
    "robot",
    "link",
    "joint",
    "parent",
    "child",
    "origin",
    "axis",
    "limit",
    "mimic",
    "xacro:macro",
    "a:b",
    "é",
)
ATTRIBUTES: Final = (
    "name",
    "type",
    "link",
    "xyz",
    "rpy",
    "lower",
    "upper",
    "effort",
    "velocity",
    "joint",
    "multiplier",
)
BYTES: Final = (
    b"\0",
    b"<",
    b">",
    b"&",
    b'"',
    b"'",
    b"\xff",
    b"\xef\xbb\xbf",
    b"<!DOCTYPE a>",
    b"<!--",
    b"]]>",
    b"&a;",
    b"/>",
)


def mutate_bytes(data: bytes, rng: random.Random) -> bytes:
    at, end = sorted((rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)))
    end = min(end, at + rng.choice((1, 1, 1, 5, 50, len(data))))
    piece = rng.choice((b"", bytes([rng.randrange(256)]), rng.choice(BYTES), data[at:end] * 2, data[at:end][::-1]))
    return data[:at] + piece + data[end:]


def mutate_element(root: ET.Element, rng: random.Random) -> None:
    element = rng.choice(list(root.iter()))
    parents = {child: parent for parent in root.iter() for child in parent}
    parent = parents.get(element, root)
    others = list(root.iter())
    what = rng.randrange(9)
    if what == 0 and element is not root:
        parent.remove(element)
    elif what == 1 and element is not root:
        parent.insert(rng.randrange(len(parent) + 1), copy.deepcopy(element))
    elif what == 2:
        rng.choice(others).append(copy.deepcopy(element))
    elif what == 3 and len(element) > 1:
        element[:] = rng.sample(list(element), len(element))
    elif what == 4:
        element.tag = rng.choice(TAGS)
    elif what == 5 and element.attrib:
        del element.attrib[rng.choice(list(element.attrib))]
    elif what == 6:
        element.set(rng.choice(ATTRIBUTES), rng.choice(WORDS))
    elif element.attrib:
        other = rng.choice([value for e in others for value in e.attrib.values()])
        element.set(rng.choice(list(element.attrib)), rng.choice((other, rng.choice(WORDS))))


def mutate(text: str, rng: random.Random) -> bytes:
    """The text with up to three elements changed, or as many bytes, or both."""
    root = ET.fromstring(text)  # noqa: S314 (our own)
    elements, bytes_ = rng.choice(((1, 0), (2, 0), (3, 0), (0, 1), (0, 2), (1, 1)))
    for _ in range(elements):
        mutate_element(root, rng)
    data = ET.tostring(root, encoding="utf-8") if elements else text.encode()
    for _ in range(bytes_):
        data = mutate_bytes(data, rng)
    return data


def survive(data: bytes) -> str:
    """What becomes of a file, which must be agreement or an error of pinscrew: its code."""
    error: PinscrewError
    try:
        robot = parse(markup.decode(data, "fuzz.urdf"))
        frame = robot.frame_names[-1]
        assert np.isfinite(ps.PoE(robot).jacobian(robot.neutral, frame, "spatial")).all()
        report = ps.verify(robot, samples=1)
    except PinscrewError as caught:
        error = caught
    else:
        assert report.ok, str(report)
        return "ok"
    assert str(error).isprintable()
    assert len(str(error)) < 3000
    return error.code


def break_one(seed: int) -> str:
    rng = random.Random(seed)  # noqa: S311 (not for secrets)
    return survive(mutate(rng.choice(VALID), rng))


@QUICK
@given(st.integers(0, 2**32))
def test_broken_files(seed: int) -> None:
    break_one(seed)


def test_broken_files_break_in_many_ways() -> None:
    """The mutations reach most checks, and leave some files right."""
    found = {break_one(seed) for seed in range(300)}
    assert {"ok", "not-xml", "no-name", "duplicate-name", "unknown-link", "two-roots", "number"} <= found
    assert len(found) > 15


@SLOW
@pytest.mark.parametrize("thousand", range(10))
def test_many_broken_files(thousand: int) -> None:
    for seed in range(1000 * thousand, 1000 * (thousand + 1)):
        break_one(seed)


EXPRESSIONS: Final = (
    *("1/0", "nosuch", "9**9**9", "[].__class__", "'a'*10**9", "xacro.load_yaml('/etc/passwd')", "'", "(", "pi", "1"),
    *("max([])", "range(10**12)", "x:=1", "lambda: 1", "xacro.fatal('no')", "'%9999d' % 1", "[1][9]", "{}", "a.b.c"),
)


def survive_xacro(folder: Path, text: str, rng: random.Random) -> None:
    """The same for a xacro file, some of whose expressions are changed."""
    for _ in range(rng.randrange(3)):
        text = text.replace(
            rng.choice(("${l1}", "${pi}", "$(arg l1)", "pi", "l1", "0")), f"${{{rng.choice(EXPRESSIONS)}}}", 1
        )
    data = text.encode()
    for _ in range(rng.randrange(3)):
        data = mutate_bytes(data, rng)
    file = folder / "fuzz.xacro"
    file.write_bytes(data)
    message = ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        try:
            survive(expand(file, {}).encode())
        except PinscrewError as error:
            message = str(error)
    assert message.isprintable()


def xacros(count: int) -> Callable[[Path], None]:
    texts = [entry.file.read_text() for entry in catalogue.bundled() if entry.file.suffix == ".xacro"]

    def test(tmp_path: Path) -> None:
        rng = random.Random(1)  # noqa: S311
        for _ in range(count):
            survive_xacro(tmp_path, rng.choice(texts), rng)

    return test


test_broken_xacros = xacros(20)
test_many_broken_xacros = SLOW(xacros(200))
