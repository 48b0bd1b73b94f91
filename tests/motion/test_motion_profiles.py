"""Velocity profiles: pieces, tables, their files, and everything that is wrong with them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import closed_forms as cf
import pinscrew as ps
from pinscrew.ground.errors import DescriptionError, InputError, PinscrewError, UnknownNameError
from pinscrew.motion.bundled_profiles import named

A8 = cf.AnthropomorphicRRR()
TABLE = ps.Profile.table(["a", "b"], [0.0, 1.0, 3.0], [[0, 1], [2, 1], [6, 0]])


def test_the_assignment_is_as_printed() -> None:
    arm = ps.load("anthropomorphic_rrr")
    profile = named("assignment", arm)
    assert (profile.start, profile.end, profile.names) == (0.0, 16.0, ("joint1", "joint2", "joint3"))
    t = np.arange(1601) / 100
    given = profile(t)[:, profile.columns(arm)]
    np.testing.assert_array_equal(given, [A8.given_rates(time) for time in t])


@pytest.mark.parametrize(("t", "before", "after"), [(1.0, 0.0, 0.1), (5.0, 0.5, 0.3), (6.0, 0.3, 0.2)])
def test_it_jumps_where_it_is_printed_to(t: float, before: float, after: float) -> None:
    profile = named("assignment", ps.load("anthropomorphic_rrr"))
    at, behind = profile([t, np.nextafter(t, 16.0)])[:, 0]
    assert at == pytest.approx(before, abs=1e-15)
    assert behind == pytest.approx(after, abs=1e-15)


def test_pieces_in_python() -> None:
    profile = ps.Profile.pieces({"a": [("-1 <= t < 1/2", "t*t"), ("1/2 ≤ t ≤ 2", 30)], "b": "45deg"}, "mine")
    np.testing.assert_array_equal(profile(-1), [1.0, np.pi / 180 * 45])
    np.testing.assert_array_equal(profile([[0.25, 0.5]])[..., 0], [[0.0625, 30.0]])
    assert profile([]).shape == (0, 2)
    assert repr(profile) == "<Profile 'mine': a, b, -1 to 2 s>"


def test_tables() -> None:
    np.testing.assert_array_equal(TABLE([0.0, 0.5, 1.0, 2.0, 3.0]), [[0, 1], [1, 1], [2, 1], [4, 0.5], [6, 0]])
    held = ps.Profile.table(["a", "b"], [0.0, 1.0, 3.0], [[0, 1], [2, 1], [6, 0]], "hold")
    np.testing.assert_array_equal(held([0.0, 0.5, 1.0, 2.0, 3.0])[:, 0], [0, 0, 2, 2, 6])


def test_columns_are_the_robots() -> None:
    robot = ps.load("planar_2r")
    profile = ps.Profile.table(["joint2", "joint1"], [0, 1], [[2, 1], [2, 1]])
    run = ps.integrate(robot, None, profile, 0.5)
    np.testing.assert_array_equal(run.qd[0], [1.0, 2.0])
    with pytest.raises(UnknownNameError, match="there is no velocity 'a'; known are: joint1, joint2"):
        TABLE.columns(robot)
    with pytest.raises(InputError, match="no rates of joint2, which planar_2r has"):
        ps.Profile.table(["joint1"], [0, 1], [[1], [1]]).columns(robot)


def test_csv(tmp_path: Path) -> None:
    file = tmp_path / "rates.csv"
    file.write_text("\ufefft, joint2 ,joint1\r\n0,0.5,-1e-3\r\n\r\n0.5,1,2\r\n", encoding="utf-8")
    profile = ps.Profile.read(file)
    assert profile.names == ("joint2", "joint1")
    np.testing.assert_allclose(profile(0.25), [0.75, 0.9995], rtol=1e-15)
    np.testing.assert_array_equal(ps.Profile.read(str(file), "hold")(0.25), [0.5, -1e-3])


@pytest.mark.parametrize("t", [-0.1, 3.1, np.nan, np.inf])
def test_times_outside(t: float) -> None:
    with pytest.raises(InputError, match="the profile is from 0 to 3 s") as caught:
        TABLE([0.0, t])
    assert caught.value.code == "profile-range"


def test_rates_that_are_not_finite() -> None:
    profile = ps.Profile.pieces({"a": [("0 <= t <= 2", "1/(t - 1)")]})
    assert profile(0.5) == -2.0
    with pytest.raises(InputError, match="the rate of a is not finite at t = 1 s"):
        profile([0.0, 1.0])
    with pytest.raises(InputError, match="t is no array of numbers"):
        profile("soon")


# ---------------------------------------------------------------------------------------------- bad files

PIECES = "rates:\n  joint1:\n    - {when: 0 <= t <= 1, rate: 0}\n    - {when: 1 < t <= 2, rate: 0.1*t}\n"


def changed(old: str, new: str) -> str:
    assert old in PIECES
    return PIECES.replace(old, new)


BAD_YAML = {
    "empty": ("", "profile-format", ":1: is no mapping; expected rates"),
    "a list": ("- 1\n- 2\n", "profile-format", ":1: is no mapping; expected rates"),
    "no rates": ("{}\n", "profile-format", ":1: 'rates' is missing"),
    "other key": ("rate: 1\n", "profile-format", ":1: 'rate' means nothing here; use rates"),
    "rates list": ("rates: [1, 2]\n", "profile-format", ":1: rates: is no mapping; expected one entry for each"),
    "key twice": (f"{PIECES}  joint1: 3\n", "duplicate-name", ":5: rates: 'joint1' is there twice"),
    "syntax": ("rates: {joint1: [\n", "profile-format", "is no YAML ("),
    "character": ("rates: \x01\n", "profile-format", "is no YAML ("),
    "alias": ("rates: *none\n", "profile-format", ":1: is no YAML (found undefined alias"),
    "two documents": (f"{PIECES}---\n{PIECES}", "profile-format", "is no YAML ("),
    "deep": ("rates: " + "[" * 600, "profile-format", "is nested too deeply"),
    "large": ("# " + "x" * 1_000_000, "too-large", "larger than 1 MB; use CSV"),
    "object": ("rates: !!python/object:os.system {joint1: 1}\n", "profile-interval", "no velocity has pieces"),
    "no piece": ("rates:\n  joint1: []\n", "profile-interval", "joint1: has no pieces"),
    "mapping": ("rates:\n  joint1: {a: 1}\n", "profile-format", ":2: joint1: is no list of pieces; write a list of"),
    "piece text": ("rates:\n  joint1: [soon]\n", "profile-format", ":2: joint1, piece 1: is no mapping; expected when"),
    "piece key": (
        changed("rate: 0}", "velocity: 0}"),
        "profile-format",
        ":3: joint1, piece 1: 'velocity' means nothing",
    ),
    "piece lacks": (changed(", rate: 0.1*t", ""), "profile-format", ":4: joint1, piece 2: 'rate' is missing"),
    "piece nested": (changed("rate: 0}", "rate: [0]}"), "profile-format", ":3: joint1, piece 1: 'rate' is no text"),
    "only constants": (
        "rates: {joint1: 1, joint2: 2}\n",
        "profile-interval",
        "no velocity has pieces, so it is not said",
    ),
    "gap": (changed("1 < t", "1.5 < t"), "profile-interval", ":4: joint1, piece 2: leaves a gap: it begins at 1.5 s"),
    "overlap": (changed("1 < t", "0.5 < t"), "profile-interval", ":4: joint1, piece 2: overlaps or is out of order"),
    "both": (changed("1 < t", "1 <= t"), "profile-interval", ":4: joint1, piece 2: both have t = 1 s"),
    "neither": (changed("t <= 1,", "t < 1,"), "profile-interval", ":4: joint1, piece 2: neither has t = 1 s"),
    "open begin": (changed("0 <= t", "0 < t"), "profile-interval", ":3: joint1, piece 1: lacks its own begin, 0 s"),
    "open end": (changed("t <= 2", "t < 2"), "profile-interval", ":4: joint1, piece 2: lacks its own end, 2 s"),
    "reversed": (changed("1 < t <= 2", "2 < t <= 1"), "profile-interval", ":4: joint1, piece 2: '2 < t <= 1' is empty"),
    "no interval": (changed("1 < t <= 2", "t > 1"), "profile-interval", ":4: joint1, piece 2: 't > 1' is no interval"),
    "no time": (changed("1 < t", "x < t"), "profile-interval", "'x < t <= 2' is no interval ('x ' is no arithmetic)"),
    "NaN": (changed("1 < t", "nan < t"), "profile-interval", "'nan < t <= 2' is no interval"),
    "other variable": (changed("0.1*t", "0.1*x"), "expression", ":4: joint1, piece 2: '0.1*x' is no arithmetic of t"),
    "a call": (changed("0.1*t", "__import__('os')"), "expression", "is no arithmetic of t; use numbers, pi"),
    "a power": (changed("0.1*t", "9**9**9"), "expression", "'9**9**9' is no arithmetic of t"),
    "empty rate": (changed("0.1*t", "''"), "expression", "'' is no arithmetic of t"),
    "division": (changed("0.1*t", "1/0"), "expression", ":4: joint1, piece 2: '1/0' has no value"),
    "other end": (
        f"{PIECES}  joint2:\n    - {{when: 0 <= t <= 3, rate: 0}}\n",
        "profile-interval",
        ":6: joint2: goes from 0 to 3 s, but joint1 from 0 to 2 s; let all do the same",
    ),
}
BAD_CSV = {
    "empty": ("", "profile-table", "0 rows of numbers; expected a header t,joint1"),
    "one row": ("t,joint1\n0,1\n", "profile-table", "1 rows of numbers; expected a header t,joint1,… and at least two"),
    "no header": ("0,1\n1,1\n", "profile-table", ":1: the first column is '0'; expected a header t,joint1"),
    "no name": ("t,\n0,1\n1,1\n", "profile-table", ":1: column 2 has no name"),
    "name twice": ("t,a,a\n0,1,1\n1,1,1\n", "duplicate-name", ":1: 'a' is there twice"),
    "columns": ("t,a\n0,1\n1,1,1\n", "profile-table", ":3: 3 columns, but the header has 2; expected t, a"),
    "text": ("t,a\n0,1\n1,one\n", "profile-table", ":3: a is 'one', no finite number; write such as 0.1"),
    "hole": ("t,a\n0,1\n1,\n", "profile-table", ":3: a is '', no finite number"),
    "NaN": ("t,a\n0,nan\n1,1\n", "profile-table", ":2: a is 'nan', no finite number"),
    "infinite": ("t,a\ninf,1\n1,1\n", "profile-table", ":2: t is 'inf', no finite number"),
    "underscore": ("t,a\n0,1_0\n1,1\n", "profile-table", ":2: a is '1_0', no finite number"),
    "unsorted": ("t,a\n1,1\n0,1\n", "profile-table", ":3: t = 0 s comes after 1 s; times must increase"),
    "same time": ("t,a\n0,1\n0,2\n", "profile-table", ":3: t = 0 s comes after 0 s"),
    "quotes": ('t,a\n0,"1\n', "profile-table", "is no CSV ("),
}
FILES = [(f"{name}.yaml", *rest) for name, rest in BAD_YAML.items()]
FILES += [(f"{name}.csv", *rest) for name, rest in BAD_CSV.items()]


@pytest.mark.parametrize(("name", "text", "code", "words"), FILES, ids=[name for name, *_ in FILES])
def test_bad_files(tmp_path: Path, name: str, text: str, code: str, words: str) -> None:
    file = tmp_path / name
    file.write_text(text, encoding="utf-8")
    with pytest.raises(DescriptionError) as caught:
        ps.Profile.read(file)
    assert caught.value.code == code
    assert str(caught.value).startswith(str(file))
    assert words in str(caught.value)


def test_files_that_are_not_there_or_of_another_kind(tmp_path: Path) -> None:
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    with pytest.raises(DescriptionError, match="there is no such file"):
        ps.Profile.read(tmp_path / "rates.yaml")
    with pytest.raises(DescriptionError, match="can't be read"):
        ps.Profile.read(folder)
    with pytest.raises(
        InputError, match=r"can't be read from a file with the suffix '\.txt'; use \.yaml, \.yml, \.csv"
    ):
        ps.Profile.read(tmp_path / "rates.txt")
    with pytest.raises(InputError, match="between='cubic'; use 'linear' or 'hold'"):
        ps.Profile.read(tmp_path / "rates.csv", "cubic")


def test_names_of_profiles() -> None:
    scara = ps.load("scara")
    for name in ("assignment", "homework"):
        with pytest.raises(
            UnknownNameError, match=f"there is no profile '{name}'; known are: assignment \\(for anthro"
        ):
            named(name, scara)


BAD_TABLES: dict[str, tuple[tuple[Any, ...], str]] = {
    "text": ((["a"], ["x", "y"], [[1], [1]]), "not-numbers"),
    "ragged": ((["a"], [0, 1], [[1], [1, 2]]), "not-numbers"),
    "one row": ((["a"], [0], [[1]]), "shape"),
    "columns": ((["a"], [0, 1], [[1, 2], [1, 2]]), "shape"),
    "rows": ((["a"], [0, 1, 2], [[1], [1]]), "shape"),
    "names": ((["a", "a"], [0, 1], [[1, 2], [1, 2]]), "duplicate-name"),
    "NaN": ((["a"], [0, 1], [[1], [np.nan]]), "not-finite"),
    "unsorted": ((["a"], [0, 2, 1], [[1], [1], [1]]), "profile-table"),
    "between": ((["a"], [0, 1], [[1], [1]], "spline"), "profile-table"),
}


@pytest.mark.parametrize(("given", "code"), BAD_TABLES.values(), ids=BAD_TABLES)
def test_bad_tables(given: tuple[Any, ...], code: str) -> None:
    with pytest.raises(InputError) as caught:
        ps.Profile.table(*given)
    assert caught.value.code == code


@pytest.mark.parametrize(
    ("rates", "words"),
    [
        ({}, "no velocity has pieces"),
        ({"a": None}, "'None' is no arithmetic of t"),
        ({"a": [("0 <= t <= 1",)]}, "a, piece 1: is no pair of an interval and a rate"),
        ({"a": [3]}, "a, piece 1: is no pair"),
        ({"a": [(0, 1)]}, "a, piece 1: 0 is no interval; write such as 0 <= t < 1"),
    ],
)
def test_bad_pieces(rates: Any, words: str) -> None:
    with pytest.raises(PinscrewError) as caught:
        ps.Profile.pieces(rates)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("rates", "wrong"),
    [
        ({"joint1": "10deg", "joint2": "0.1rad*t", "joint3": "2cm"}, None),
        ({"joint1": 0.1, "joint2": "pi/4", "joint3": 0.2}, None),
        ({"joint1": "10deg", "joint2": "2cm", "joint3": "2cm"}, ("joint2", "m/s", "rad/s")),
        ({"joint1": "10deg", "joint2": "1deg", "joint3": "10deg*t"}, ("joint3", "rad/s", "m/s")),
    ],
)
def test_rates_are_of_the_joints_units(rates: dict[str, str | float], wrong: tuple[str, str, str] | None) -> None:
    scara = ps.load("scara")
    assert scara.velocity_units == ("rad", "rad", "m")
    profile = ps.Profile.pieces({**rates, "joint1": [("0 <= t <= 1", rates["joint1"])]}, "mine")
    if wrong is None:
        np.testing.assert_array_equal(profile.columns(scara), [0, 1, 2])
        return
    with pytest.raises(InputError) as caught:
        profile.columns(scara)
    assert caught.value.code == "unit"
    words = f"the rate of {wrong[0]!r} is written in {wrong[1]}, but {scara.name} has it in {wrong[2]}"
    assert words in str(caught.value)


def test_pieces_of_one_velocity_have_one_unit() -> None:
    with pytest.raises(DescriptionError) as caught:
        ps.Profile.pieces({"joint1": [("0 <= t < 1", "10deg"), ("1 <= t <= 2", "2cm")]}, "mine")
    assert caught.value.code == "unit"
    ps.Profile.pieces({"joint1": [("0 <= t < 1", "10deg"), ("1 <= t <= 2", "0.3")]}, "mine")


@pytest.mark.parametrize("when", ["1 <= t <= 1", "2 <= t < 1"])
def test_a_piece_that_lasts_no_time(when: str) -> None:
    with pytest.raises(DescriptionError, match="is empty; the later time comes last") as caught:
        ps.Profile.pieces({"joint1": [(when, 0.1)]}, "mine")
    assert caught.value.code == "profile-interval"
