"""Robots by name and by path."""

from __future__ import annotations

import importlib.metadata
import json
import sys
from pathlib import Path
from typing import Any

import pytest

import pinscrew as ps
import urdfs
from pinscrew.description import catalogue
from pinscrew.ground.errors import DescriptionError, MissingExtraError, UnknownNameError, XacroError

ASSIGNED = {
    "spherical_rrp": "spherical_rrp.urdf.xacro",
    "planar_2r": "planar_2r.urdf",
    "scara_rrp": "scara_rrp.urdf.xacro",
    "stanford_rrp": "stanford_rrp.urdf.xacro",
    "planar_rrr": "planar_rrr.urdf.xacro",
    "drone": "drone.urdf",
    "anthropomorphic_rrr": "anthropomorphic_rrr.urdf.xacro",
    "one_joint": "one_joint.urdf.xacro",
    "two_joint": "two_joint.urdf.xacro",
    "gear_pair": "gear_pair.urdf.xacro",
    "bevel_pair": "bevel_pair.urdf.xacro",
    "lead_screw": "lead_screw.urdf.xacro",
}


def example_data() -> bool:
    try:
        importlib.metadata.distribution("example-robot-data")
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


needs_example_data = pytest.mark.skipif(not example_data(), reason="example-robot-data is not installed")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "arm.urdf"
    path.write_text(urdfs.tree())
    return path


# -------------------------------------------------------------------------------------------------- bundled


def test_bundled_robots_are_the_assignments() -> None:
    entries = catalogue.bundled()
    assert {entry.name: entry.file.name for entry in entries} == ASSIGNED
    for entry in entries:
        assert entry.file.is_file()
        assert entry.file.parent == catalogue.robots_directory()
        assert entry.tip == "tool"
        assert entry.title
        assert entry.coursework
    models = (path.name for path in catalogue.robots_directory().iterdir() if path.suffix in (".urdf", ".xacro"))
    assert set(models) == set(ASSIGNED.values())


def test_names_are_unique() -> None:
    entries = catalogue.bundled()
    names = [name for entry in entries for name in (entry.name, *entry.aliases)]
    assert len(names) == len(set(names))
    assert all(name == name.lower() and name == name.strip() for name in names)


@pytest.mark.parametrize("entry", catalogue.bundled(), ids=lambda entry: entry.name)
def test_bundled_robots_are_found_by_name_alias_and_path(entry: catalogue.Entry) -> None:
    for source in (entry.name, *entry.aliases, str(entry.file), entry.file):
        assert catalogue.find(source) is entry


def test_bundled_robots_keep_their_tip_and_name() -> None:
    """The drone has an obstacle at its tool, the only leaf; its tip is the tool, by whatever name it was loaded."""
    for source in ("drone", "quadcopter", catalogue.robots_directory() / "drone.urdf"):
        robot = ps.load(source)
        assert (robot.name, robot.tip) == ("drone", "tool")
    assert ps.load("drone", tip="obstacle").tip == "obstacle"
    assert ps.load("drone", floating_base=True).base == "universe"


def test_files_come_before_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file called as a robot is, in the working directory, is the file."""
    (tmp_path / "scara").write_text(urdfs.single_revolute())
    monkeypatch.chdir(tmp_path)
    assert ps.load("scara").joint_names == ("j",)


# ---------------------------------------------------------------------------------------------------- paths


@pytest.mark.parametrize(
    ("name", "expected"), [("arm.urdf", "arm"), ("arm.v2.urdf", "arm.v2"), ("arm.xml", "arm"), ("arm", "arm")]
)
@pytest.mark.parametrize("kind", [str, Path])
def test_paths(tmp_path: Path, name: str, expected: str, kind: Any) -> None:
    path = tmp_path / name
    path.write_text(urdfs.rotated())
    robot = ps.load(kind(path))
    assert (robot.name, robot.description.file) == (expected, str(path))
    assert robot.description.name == "small"
    assert robot.description.text == urdfs.rotated()


def test_xacro_paths(tmp_path: Path) -> None:
    path = tmp_path / "arm.urdf.xacro"
    xacro = urdfs.single_revolute().replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"')
    path.write_text(
        xacro.replace("<link", '<xacro:arg name="x" default="0.25"/><link', 1).replace("0.3 -0.2", "$(arg x) 0")
    )
    robot = ps.load(path)
    assert robot.name == "arm"
    assert robot.home()[0, 3] == 0.25
    longer = ps.load(path, x=0.75)
    assert longer.home()[0, 3] == 0.75
    assert dict(longer.description.arguments) == {"x": "0.75"}
    with pytest.raises(XacroError, match="declares no argument 'y'; declared are: x"):
        ps.load(path, y=1.0)


def test_a_path_has_no_tip_but_the_one_given(file: Path) -> None:
    assert ps.load(file).default_tip is None
    assert ps.load(file, tip="camera").tip == "camera"
    with pytest.raises(UnknownNameError, match="arm: there is no frame 'hand'; known are: base, column, l1"):
        ps.load(file, tip="hand")


def test_a_plain_urdf_takes_no_arguments(file: Path) -> None:
    with pytest.raises(
        DescriptionError, match="a plain URDF has no arguments, but l1, l2 came; leave them out"
    ) as caught:
        ps.load(file, l1=1.0, l2=2.0)
    assert caught.value.code == "xacro-argument"


@pytest.mark.parametrize("source", ["missing.urdf", "missing.urdf.xacro", "no/such/folder.xml", Path("scara")])
def test_no_such_file(source: Any) -> None:
    with pytest.raises(DescriptionError, match=f"^{source}: there is no such file$") as caught:
        ps.load(source)
    assert caught.value.code == "no-file"


@pytest.mark.parametrize(
    ("kind", "name", "error", "words"),
    [
        (Path, "folder", DescriptionError, r"folder: can't be read \(Is a directory\)"),
        (str, "folder.urdf", DescriptionError, r"folder.urdf: can't be read \(Is a directory\)"),
        (str, "folder", UnknownNameError, "there is no robot or file '.*/folder'"),
    ],
)
def test_a_directory_is_no_robot(tmp_path: Path, kind: Any, name: str, error: Any, words: str) -> None:
    (tmp_path / name).mkdir()
    with pytest.raises(error, match=words):
        ps.load(kind(tmp_path / name))


def test_what_is_no_urdf(tmp_path: Path) -> None:
    path = tmp_path / "data.json"
    path.write_text(json.dumps({"a": 1}))
    with pytest.raises(DescriptionError, match=r"data.json:1: not well-formed XML"):
        ps.load(path)


# ---------------------------------------------------------------------------------------------------- names


@pytest.mark.parametrize(
    ("source", "near"),
    [("scarra", "scara"), ("SCARA", "scara"), ("plannar_2r", "planar_2r"), ("rrp", "scara_rrp"), ("dron", "drone")],
)
def test_unknown_names_list_what_is_near(source: str, near: str) -> None:
    with pytest.raises(UnknownNameError, match=f"there is no robot or file '{source}'; known are: ") as caught:
        ps.load(source)
    assert near in caught.value.known
    assert caught.value.code == "unknown-robot"
    assert caught.value.name == source
    assert len(caught.value.known) == len(set(caught.value.known)) < 12


@pytest.mark.parametrize("source", ["zzzzqqqq", ""])
def test_where_nothing_is_near_all_are_listed(source: str) -> None:
    with pytest.raises(UnknownNameError) as caught:
        ps.load(source)
    assert set(ASSIGNED) <= set(caught.value.known)


# ----------------------------------------------------------------------------------------- example-robot-data


@needs_example_data
def test_example_robots() -> None:
    entries = catalogue.example_robots()
    names = [entry.name for entry in entries]
    assert len(names) == len(set(names)) > 50
    assert {"panda", "ur5_robot", "talos_reduced", "solo12"} <= set(names)
    assert all(entry.file.is_absolute() and entry.file.is_file() for entry in entries)
    assert not {name for entry in catalogue.bundled() for name in (entry.name, *entry.aliases)} & set(names)
    twins = [entry for entry in entries if entry.file.stem == "anymal"]
    assert len(twins) == 2
    assert all(entry.name == f"{entry.name.split('/')[0]}/anymal" for entry in twins)


@needs_example_data
def test_example_robots_load_by_name() -> None:
    panda = ps.load("panda")
    assert panda.joint_names[:7] == tuple(f"panda_joint{i + 1}" for i in range(7))
    assert panda.name == "panda"
    for entry in catalogue.example_robots():
        assert catalogue.find(entry.name) is entry


@needs_example_data
def test_example_robots_are_among_what_is_near() -> None:
    with pytest.raises(UnknownNameError) as caught:
        ps.load("ur5")
    assert {"ur5_robot", "ur5_gripper"} <= set(caught.value.known)


def test_without_example_data(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its absence is told where it is asked for, and else leaves the bundled robots alone."""

    def absent(name: str) -> None:
        raise importlib.metadata.PackageNotFoundError(name)

    catalogue.example_robots.cache_clear()
    monkeypatch.setattr(importlib.metadata, "distribution", absent)
    with pytest.raises(MissingExtraError, match=r'not installed; install it with: pip install "pinscrew\[robots\]"'):
        catalogue.example_robots()
    assert catalogue.find("scara").name == "scara_rrp"
    with pytest.raises(UnknownNameError) as caught:
        catalogue.find("zzzzqqqq")
    assert set(caught.value.known) == set(ASSIGNED)


@pytest.fixture
def descriptions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A package like robot_descriptions, whose modules name files."""
    package = tmp_path / "robot_descriptions"
    package.mkdir()
    (package / "__init__.py").write_text("")
    urdf = tmp_path / "arm.urdf"
    urdf.write_text('<robot name="arm"><link name="base"/></robot>')
    (package / "arm_description.py").write_text(f"URDF_PATH = {str(urdf)!r}")
    (package / "usd_description.py").write_text("USD_PATH = 'x.usd'")
    (package / "far_description.py").write_text("raise OSError('no network\\nat all')")
    monkeypatch.syspath_prepend(tmp_path)
    for name in [name for name in sys.modules if name.startswith("robot_descriptions")]:
        monkeypatch.delitem(sys.modules, name)
    return package


@pytest.mark.usefixtures("descriptions")
def test_modules_of_robot_descriptions_are_names() -> None:
    assert ps.load("arm_description").frame_names == ("base",)
    for name, code, words in (
        ("usd_description", "no-file", "has no robot's file"),
        ("far_description", "unreadable", "does not get it (OSError: no network at all)"),
    ):
        with pytest.raises(DescriptionError) as caught:
            ps.load(name)
        assert caught.value.code == code
        assert words in str(caught.value)
    for name in ("none_description", "os.path_description", "../arm_description"):
        with pytest.raises(UnknownNameError):
            ps.load(name)


def test_without_robot_descriptions(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(catalogue, "DESCRIPTIONS", "no_such_package")
    with pytest.raises(UnknownNameError):
        ps.load("arm_description")
