"""A lock that is not whole, or that someone edited, ends in one clear error of ours."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

import urdfs
from pinscrew import lockfile
from pinscrew.ground.errors import DescriptionError
from pinscrew.lockfile import content, parsing

ROBOT = urdfs.load(
    urdfs.robot(
        urdfs.joint("a", "revolute", "base", "l1", xyz="0.1 0 0.2", rpy="0.3 0 0", axis="0 1 0"),
        urdfs.joint("b", "prismatic", "l1", "l2", xyz="0.2 0 0", axis="1 0 0", mimic=("a", 0.5, 0.1)),
        urdfs.joint("c", "fixed", "l2", "l3", xyz="0.2 0 0"),
        urdfs.joint("d", "planar", "l3", "l4"),
        urdfs.joint("e", "continuous", "l4", "tool", axis="1 0 0", xyz="0 0 0.1"),
        links="base l1 l2 l3 l4 tool",
    ),
    tip="tool",
    floating_base=True,
)
TEXT: Final = lockfile.text(ROBOT)
LOCK: Final[dict[str, Any]] = json.loads(TEXT) | {"arguments": {"l1": "0.4"}}
REMEDY: Final = "write it anew with pinscrew lock and the robot's file"


def error_of(text: str, tmp_path: Path) -> DescriptionError:
    path = tmp_path / "arm.urdf.lock"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DescriptionError) as caught:
        lockfile.read(path)
    assert caught.value.file == str(path)
    assert str(caught.value).startswith(str(path))
    assert REMEDY in str(caught.value)
    return caught.value


def test_the_whole_lock_is_read(tmp_path: Path) -> None:
    """The layout of a lock is of no account, nor is the order of its keys."""
    path = tmp_path / "arm.urdf.lock"
    path.write_text(json.dumps(dict(reversed(LOCK.items())), indent=7), encoding="utf-8")
    robot = lockfile.read(path)
    assert robot.coordinate_names == ROBOT.coordinate_names
    assert dict(robot.description.arguments) == {"l1": "0.4"}
    assert (robot.floating_base, robot.tip) == (True, "tool")


# ------------------------------------------------------------------------------------------- broken keys


def places(value: Any, *path: str | int) -> Iterator[tuple[str | int, ...]]:
    """Where there is anything in a lock."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, *path, key)


def at(lock: Any, path: tuple[str | int, ...]) -> Any:
    for key in path:
        lock = lock[key]
    return lock


PLACES: Final = list(places(LOCK))
FREE: Final = {("robot",), ("source",), ("tip",), ("arguments",), ("arguments", "l1"), ("floating_base",)}
"""What a lock says of what it was made from; another value is wrong only if it can't be."""


def broken(path: tuple[str | int, ...], change: Callable[[Any, str | int], None]) -> str:
    lock = copy.deepcopy(LOCK)
    change(at(lock, path[:-1]), path[-1])
    return json.dumps(lock)


def remove(holder: Any, key: str | int) -> None:
    del holder[key]


def rename(holder: Any, key: str | int) -> None:
    if isinstance(holder, dict):
        holder[f"{key}_"] = holder.pop(key)
    else:
        holder.insert(int(key), holder[int(key)])


def replaced(by: Any) -> Callable[[Any, str | int], None]:
    def change(holder: Any, key: str | int) -> None:
        holder[key] = by

    return change


@pytest.mark.parametrize("path", PLACES, ids=lambda path: ".".join(map(str, path)))
def test_broken_everywhere(path: tuple[str | int, ...], tmp_path: Path) -> None:
    """Each thing in a lock left out, renamed or doubled, and of each wrong type."""
    whole = at(LOCK, path)
    for by in (None, True, {}, [], "", "x", 0.5, 10**400):
        if by == whole and type(by) is type(whole):
            continue
        allowed = (isinstance(by, str) and by and path in FREE - {("tip",), ("floating_base",)}) or (
            path == ("arguments",) and by == {}
        )
        if path == ("arguments", "l1") and isinstance(by, str):
            allowed = True
        if not allowed:
            error = error_of(broken(path, replaced(by)), tmp_path)
            assert error.code in {"lock-content", "lock-schema", "lock-edited"}, (by, error)
    if path not in FREE - {("robot",), ("source",)}:
        assert error_of(broken(path, remove), tmp_path).code in {"lock-content", "lock-schema", "lock-edited"}
    if path != ("arguments", "l1"):
        assert error_of(broken(path, rename), tmp_path).code in {"lock-content", "lock-schema", "lock-edited"}


WRONG: Final[dict[str, tuple[tuple[str | int, ...], Any, str]]] = {
    "other schema": (("schema",), "pinscrew.lock/2", "its schema is 'pinscrew.lock/2', and not 'pinscrew.lock/1'"),
    "no list": (("joints",), {}, "the lock.joints: is no list"),
    "type": (("joints", 1, "type"), "screwy", "the lock.joints[1].type: is 'screwy', and not one of revolute"),
    "absolute source": (("source",), "/etc/passwd", "the lock.source: is '/etc/passwd', and not a path relative"),
    "tip": (("tip",), "hand", "the lock.tip: is 'hand', which is no link"),
    "argument": (("arguments", "l1"), 0.5, "the lock.arguments: has the value 0.5 for 'l1', and not a text"),
    "floating": (("floating_base",), False, "the lock.floating_base: is false, and not true"),
    "parent": (("joints", 1, "parent"), "l2", "joint 'a': parent: is 'l2', to which no joint before it leads"),
    "child": (("joints", 2, "child"), "l1", "joint 'b': child: is 'l1', to which another joint leads"),
    "twice": (("joints", 2, "name"), "a", "joint 'a': name: is there twice"),
    "rows": (("joints", 1, "home"), [[1, 0, 0, 0]] * 3, "joint 'a': home: has 3 rows, and not 4"),
    "row": (("joints", 1, "home", 0), [1, 0, 0], "joint 'a': home[0]: has 3 numbers, and not 4"),
    "number": (("joints", 1, "home", 0, 3), "0.1", "joint 'a': home[0][3]: is '0.1', and not a finite number"),
    "bool": (("joints", 1, "home", 0, 3), True, "joint 'a': home[0][3]: is true, and not a finite number"),
    "stretched": (("joints", 1, "home", 0, 0), 1.00001, "joint 'a': home: is no rigid pose"),
    "mirrored": (("joints", 1, "home", 0, 0), -1, "joint 'a': home: is no rigid pose"),
    "bottom": (("joints", 1, "home", 3), [0, 0, 0, 2], "joint 'a': home: is no rigid pose"),
    "screw": (("joints", 1, "screw"), [0, 0, 0, 0, 0, 1], "joint 'a': screw: is no screw axis (v, ω) of a revolute"),
    "no unit": (("joints", 2, "screw"), [2, 0, 0, 0, 0, 0], "joint 'b': screw: is no screw axis (v, ω) of a prism"),
    "pitch": (("joints", 2, "screw"), [1, 0, 0, 1, 0, 0], "joint 'b': screw: is no screw axis (v, ω) of a prismatic"),
    "limits": (("joints", 1, "limits", "lower"), 3, "joint 'a': limits: has the lower limit 3 above the upper one, 2"),
    "mimic": (("joints", 2, "mimic", "joint"), "z", "the lock.joints: have 'b' mimic 'z', which is no joint with a"),
    "fixed mimic": (("joints", 2, "mimic", "joint"), "c", "the lock.joints: have 'b' mimic 'c', which is no joint wi"),
    "itself": (("joints", 2, "mimic", "joint"), "b", "the lock.joints: have 'b' mimic itself"),
    "screw of fixed": (("joints", 3, "screw"), [0] * 6, "joint 'c': screw: is nothing that a fixed joint has"),
    "unknown key": (("joints", 3, "pitch"), 1, "the lock.joints[3]: has 'pitch', which no lock has there"),
    "hash": (("hash",), "sha256:0", "its hash is not that of its content, so it was edited or merged by hand"),
    "moved": (("joints", 3, "home", 0, 3), 0.5, "its hash is not that of its content"),
    "limit moved": (("joints", 1, "limits", "upper"), 2.5, "its hash is not that of its content"),
}


@pytest.mark.parametrize(("path", "by", "words"), WRONG.values(), ids=WRONG)
def test_messages(path: tuple[str | int, ...], by: Any, words: str, tmp_path: Path) -> None:
    error = error_of(broken(path, replaced(by)), tmp_path)
    assert f"arm.urdf.lock: {words}" in str(error)


def test_mimics_in_a_circle(tmp_path: Path) -> None:
    lock = copy.deepcopy(LOCK)
    for joint, master in ((1, "b"), (2, "a")):
        lock["joints"][joint]["mimic"] = {"joint": master, "multiplier": 1, "offset": 0}
    assert "mimic itself" in error_of(json.dumps(lock), tmp_path).what


def test_floating_without_a_floating_joint(tmp_path: Path) -> None:
    lock = json.loads(lockfile.text(urdfs.load(urdfs.tree()))) | {"floating_base": True}
    assert "the first joint is no floating 'root_joint'" in error_of(json.dumps(lock), tmp_path).what


# ------------------------------------------------------------------------------------------- broken texts


def test_cut_short(tmp_path: Path) -> None:
    for size in range(0, len(TEXT) - 1, 37):
        error = error_of(TEXT[:size], tmp_path)
        assert error.code == "lock-syntax"
        assert error.line is not None


def test_merge_conflict(tmp_path: Path) -> None:
    lines = TEXT.splitlines()
    row = next(i for i, line in enumerate(lines) if '"hash"' in line)
    lines[row:row] = ["<<<<<<< HEAD", lines[row], "=======", lines[row], ">>>>>>> other"]
    error = error_of("\n".join(lines), tmp_path)
    assert (error.code, error.line, error.what) == ("lock-syntax", row + 1, "it has the marks of a merge conflict")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[]", "its schema is null"),
        ("3", "its schema is null"),
        ("{}", "its schema is null"),
        (TEXT.replace("0.1", "NaN", 1), "NaN is no number"),
        (TEXT.replace("0.1", "Infinity", 1), "Infinity is no number"),
        (TEXT.replace("0.1", "1e999", 1), "is Infinity, and not a finite number"),
        (TEXT.replace("0.1", "9" * 5000, 1), "is Infinity, and not a finite number"),
        (TEXT.replace('"tip"', '"robot"', 1), "'robot' is there twice"),
        (TEXT + "{}", "Extra data"),
        ("[" * 100_000, "recursion"),
        ('version = 1\n\n[[package]]\nname = "numpy"\n', "it is no whole JSON"),
    ],
)
def test_other_texts(text: str, words: str, tmp_path: Path) -> None:
    assert words in str(error_of(text, tmp_path))


def test_no_utf8_and_no_file(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf.lock"
    with pytest.raises(DescriptionError, match=r"write it with pinscrew lock .*arm\.urdf$") as caught:
        lockfile.read(path)
    assert caught.value.code == "not-locked"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(DescriptionError) as caught:
        lockfile.read(path)
    assert caught.value.code == "encoding"


@given(st.data())
def test_any_damage(data: st.DataObject) -> None:
    """A piece of a lock replaced by anything: an error of ours, or a lock of the same mechanism."""
    start = data.draw(st.integers(0, len(TEXT)))
    end = data.draw(st.integers(start, min(start + 40, len(TEXT))))
    text = TEXT[:start] + data.draw(st.text('0123456789.-e[]{}",: \nalnu', max_size=8)) + TEXT[end:]
    try:
        found = parsing.parse(text, Path("arm.urdf.lock")).hash
    except DescriptionError as error:
        found = error.code
    assert found == json.loads(TEXT)["hash"] or found.startswith("lock-")


def test_one_line_for_each_thing() -> None:
    """Rows, screws, limits and mimics have lines of their own, so that a diff shows what moved."""
    lines = TEXT.splitlines()
    assert TEXT.endswith("}\n")
    assert sum('"screw": [' in line for line in lines) == 3
    assert sum('"limits": {' in line for line in lines) == 3
    assert sum('"mimic": {"joint": "a", "multiplier": 0.5, "offset": 0.1}' in line for line in lines) == 1
    assert sum(re.fullmatch(r"        \[[^,]+(, [^,]+){3}\],?", line) is not None for line in lines) == 4 * 6
    assert f'"schema": "{content.SCHEMA}"' in lines[1]


def test_equal_limits_are_limits(tmp_path: Path) -> None:
    """A joint that may stand at one value only is none that is reversed."""
    joint = urdfs.joint("a", "revolute", "base", "tool", limits=(0.5, 0.5))
    path = tmp_path / "arm.urdf.lock"
    path.write_text(lockfile.text(urdfs.load(urdfs.robot(joint, links="base tool"))))
    assert lockfile.read(path).limits.tolist() == [[0.5, 0.5]]
