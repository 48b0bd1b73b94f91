"""What a file says its links look like."""

from __future__ import annotations

import math
import os
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.description import urdf, visuals
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError, PinscrewWarning
from pinscrew.view import mesh_files


def looks(inside: str, folder: Path, *, top: str = "", **options: bool) -> visuals.Looks:
    """The looks of a robot of one link with one visual, in a folder."""
    text = f'<robot name="r">{top}<link name="base"><visual>{inside}</visual></link></robot>'
    file = folder / "r.urdf"
    return visuals.read(urdf.parse(text, file), Packages(file, **options))


@pytest.mark.parametrize(
    ("solid", "kind", "size"),
    [
        ('<box size="1 2 3"/>', "box", (1.0, 2.0, 3.0)),
        ('<cylinder radius="0.1" length="2"/>', "cylinder", (0.1, 2.0)),
        ('<sphere radius=".5"/>', "sphere", (0.5,)),
        ('<capsule radius="0.1" length="2"/>', "capsule", (0.1, 2.0)),
    ],
)
def test_primitives(solid: str, kind: str, size: tuple[float, ...], tmp_path: Path) -> None:
    (visual,) = looks(f"<geometry>{solid}</geometry>", tmp_path).visuals
    assert (visual.link, visual.geometry.kind, visual.geometry.size) == ("base", kind, size)
    assert np.array_equal(visual.T_link_visual, np.eye(4))
    assert visual.color is None


def test_the_origin_is_roll_then_pitch_then_yaw(tmp_path: Path) -> None:
    origin = '<origin xyz="1 2 3" rpy="0.3 -0.4 0.5"/><geometry><sphere radius="1"/></geometry>'
    (visual,) = looks(origin, tmp_path).visuals
    expected = ps.lie.so3.exp([0, 0, 0.5]) @ ps.lie.so3.exp([0, -0.4, 0]) @ ps.lie.so3.exp([0.3, 0, 0])
    assert np.allclose(visual.T_link_visual[:3, :3], expected, rtol=0, atol=1e-15)
    assert visual.T_link_visual[:3, 3].tolist() == [1, 2, 3]


@pytest.mark.parametrize(
    ("material", "top"),
    [
        ('<material name="red"><color rgba="1 0 0 0.5"/></material>', ""),
        ('<material name="red"/>', '<material name="red"><color rgba="1 0 0 0.5"/></material>'),
        ('<material><color rgba="1 0 -1 0.5"/></material>', ""),
    ],
)
def test_colors_are_inline_or_by_name(material: str, top: str, tmp_path: Path) -> None:
    inside = f'<geometry><sphere radius="1"/></geometry>{material}'
    (visual,) = looks(inside, tmp_path, top=top).visuals
    assert visual.color == (1.0, 0.0, 0.0, 0.5)


@pytest.mark.parametrize(
    ("inside", "code"),
    [
        ('<geometry><box size="1 2"/></geometry>', "number-count"),
        ('<geometry><box size="1 2 nan"/></geometry>', "number"),
        ('<geometry><box size="1 2 1_0"/></geometry>', "number"),
        ('<geometry><sphere radius="-1"/></geometry>', "geometry"),
        ("<geometry><sphere/></geometry>", "geometry"),
        ("<geometry><cone/></geometry>", "geometry"),
        ("<geometry><mesh/></geometry>", "geometry"),
        ("", "geometry"),
        ('<geometry><sphere radius="1"/></geometry><origin xyz="1 2 inf"/>', "number"),
        ('<geometry><sphere radius="1"/></geometry><material><color rgba="1 1 1"/></material>', "number-count"),
        ('<geometry><mesh filename="http://example.org/a.stl"/></geometry>', "remote-file"),
        ('<geometry><mesh filename="../../outside.stl"/></geometry>', "outside"),
        ('<geometry><mesh filename="file:///etc/passwd"/></geometry>', "outside"),
    ],
)
def test_what_is_wrong_is_refused(inside: str, code: str, tmp_path: Path) -> None:
    with pytest.raises(DescriptionError) as caught:
        looks(inside, tmp_path)
    assert caught.value.code == code


def test_missing_meshes_are_warned_of_once(tmp_path: Path) -> None:
    visual = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    links = "".join(
        f'<link name="{name}">{visual.format(file)}</link>'
        for name, file in (("base", "a.stl"), ("tool", "package://nowhere/b.stl"))
    )
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="tool"/></joint>'
    file = tmp_path / "r.urdf"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = visuals.read(urdf.parse(f'<robot name="r">{links}{joint}</robot>', file), Packages(file))
    assert found == visuals.Looks((), ("base", "tool"))
    (warning,) = caught
    assert isinstance(warning.message, PinscrewWarning)
    assert warning.message.code == "no-mesh"
    assert "base, tool" in str(warning.message)


def stl(path: Path) -> None:
    """One triangle, in the binary form."""
    corners = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", 1) + corners)


def test_a_mesh_is_read_with_its_scale(tmp_path: Path) -> None:
    stl(tmp_path / "a.stl")
    found = looks('<geometry><mesh filename="a.stl" scale="1 2 3"/></geometry>', tmp_path)
    (visual,) = found.visuals
    assert visual.geometry.size == (1.0, 2.0, 3.0)
    ((part,),) = mesh_files.load(found.visuals, Packages(tmp_path / "r.urdf")).values()
    assert part.bounds.tolist() == [[0, 0, 0], [2, 3, 0]]
    assert np.allclose(part.normals, [[0, 0, 1]] * 3)
    assert part.faces.tolist() == [[0, 1, 2]]


def test_an_obj_may_not_name_files_elsewhere(tmp_path: Path) -> None:
    folder = tmp_path / "robot"
    folder.mkdir()
    (tmp_path / "secret.mtl").write_text("newmtl m\nKd 1 0 0\n")
    (folder / "a.obj").write_text("mtllib ../secret.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    found = looks('<geometry><mesh filename="a.obj"/></geometry>', folder)
    ((part,),) = mesh_files.load(found.visuals, Packages(folder / "r.urdf")).values()
    assert part.color != (1.0, 0.0, 0.0, 1.0)


def test_an_obj_has_the_colors_beside_it(tmp_path: Path) -> None:
    (tmp_path / "a.mtl").write_text("newmtl m\nKd 1 0 0\n")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    found = looks('<geometry><mesh filename="a.obj"/></geometry>', tmp_path)
    ((part,),) = mesh_files.load(found.visuals, Packages(tmp_path / "r.urdf")).values()
    assert part.color == (1.0, 0.0, 0.0, 1.0)


def test_a_pipe_beside_an_obj_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.mtl")
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    found = looks('<geometry><mesh filename="a.obj"/></geometry>', tmp_path)
    ((part,),) = mesh_files.load(found.visuals, Packages(tmp_path / "r.urdf")).values()
    assert len(part.faces) == 1


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_vertices_are_finite(bad: float, tmp_path: Path) -> None:
    triangle = struct.pack("<12fH", 0, 0, 1, 0, bad, 0, 1, 0, 0, 0, 1, 0, 0)
    (tmp_path / "a.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + triangle)
    found = looks('<geometry><mesh filename="a.stl"/></geometry>', tmp_path)
    with pytest.raises(DescriptionError, match="no finite numbers") as caught:
        mesh_files.load(found.visuals, Packages(tmp_path / "r.urdf"))
    assert (caught.value.code, Path(caught.value.file).name) == ("mesh-format", "a.stl")


@pytest.mark.parametrize(("name", "data"), [("a.stl", b"solid nothing"), ("a.ply", b"ply"), ("a.dae", b"<COLLADA/>")])
def test_a_file_that_is_no_mesh_is_named(name: str, data: bytes, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(data)
    found = looks(f'<geometry><mesh filename="{name}"/></geometry>', tmp_path)
    with pytest.raises(DescriptionError) as caught:
        mesh_files.load(found.visuals, Packages(tmp_path / "r.urdf"))
    assert (caught.value.code, Path(caught.value.file).name) == ("mesh-format", name)
