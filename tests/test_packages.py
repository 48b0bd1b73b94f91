"""Where packages are found, which files may be read, and which mesh files a robot may name."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import pytest

from pinscrew.description.meshes import mesh_file
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError


@pytest.fixture(autouse=True)
def no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A workspace: the package arm with a robot and meshes, its neighbour hand, and files outside."""
    for name, text in {
        "ws/arm/package.xml": "<package>\n <name> arm_description </name>\n</package>",
        "ws/arm/urdf/arm.urdf": "<robot/>",
        "ws/arm/meshes/link.stl": "solid",
        "ws/arm/meshes/skin.png": "png",
        "ws/hand/meshes/palm.stl": "solid",
        "secret.stl": "secret",
        "secret.png": "secret",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path.resolve()


def arm(folder: Path, declared: Mapping[str, Path] | None = None, *, allow_outside: bool = False) -> Packages:
    return Packages(folder / "ws/arm/urdf/arm.urdf", declared or {}, allow_outside)


def refused(code: str, call: object, *arguments: object) -> DescriptionError:
    """The error of a call, which has this code and names the robot's file."""
    with pytest.raises(DescriptionError) as caught:
        call(*arguments)  # type: ignore[operator]
    assert caught.value.code == code
    assert str(caught.value).isprintable()
    return caught.value


# --------------------------------------------------------------------------------------------------------- find


def test_own_package(folder: Path) -> None:
    """By its folder's name and by the one in its package.xml; and its neighbours, which still may not be read."""
    packages = arm(folder)
    assert packages.find("arm") == packages.find("arm_description") == folder / "ws/arm"
    assert packages.find("hand") == folder / "ws/hand"
    refused("outside", packages.resolve, "package://hand/meshes/palm.stl")
    assert packages.resolve("package://arm/meshes/link.stl") == folder / "ws/arm/meshes/link.stl"


def test_declared_packages(folder: Path) -> None:
    packages = arm(folder, {"hand": folder / "ws/hand", "arm": folder / "ws/hand", "no": folder / "nosuch"})
    assert packages.find("hand") == packages.find("arm") == folder / "ws/hand"
    assert packages.resolve("package://hand/meshes/palm.stl") == folder / "ws/hand/meshes/palm.stl"
    refused("unknown-package", packages.find, "no")


@pytest.mark.parametrize("name", ["nosuch", "", ".", "..", "../arm", "a/b", "/etc", "arm\n", "a b", "x" * 5000, "ar*"])
def test_unknown_packages(name: str, folder: Path) -> None:
    error = refused("unknown-package", arm(folder).find, name)
    assert "--package" in error.remedy
    assert len(str(error)) < 2000
    assert error.file == str(folder / "ws/arm/urdf/arm.urdf")


def test_ament(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    share = folder / "install/share"
    (share / "gripper").mkdir(parents=True)
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nosuch{os.pathsep}{os.pathsep}{folder / 'install'}")
    assert arm(folder).find("gripper") == share / "gripper"
    assert share in arm(folder).roots()


def test_ros_1(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By folder and by name, four levels down, not inside packages, hidden folders or links; the first wins."""
    for path, name in {
        "src/a/gripper_v2": "gripper",
        "src/a/gripper_v2/inner": "inner",
        "src/.hidden": "hidden",
        "src/1/2/3/deep": "deep",
        "src/1/2/3/4/deeper": "deeper",
        "other/gripper": "gripper",
    }.items():
        (folder / path).mkdir(parents=True)
        (folder / path / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (folder / "src/loop").symlink_to(folder / "src")
    (folder / "src/broken").symlink_to("nowhere")
    monkeypatch.setenv("ROS_PACKAGE_PATH", f"{folder / 'src'}{os.pathsep}{folder / 'other'}{os.pathsep}/nosuch")
    packages = arm(folder)
    assert packages.find("gripper") == packages.find("gripper_v2") == folder / "src/a/gripper_v2"
    assert packages.find("deep") == folder / "src/1/2/3/deep"
    for name in ("inner", "hidden", "deeper"):
        refused("unknown-package", packages.find, name)


def test_package_files_that_are_none(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, data in {"empty": b"", "binary": b"\xff\xfe\x00", "nameless": b"<package/>"}.items():
        (folder / "src" / name).mkdir(parents=True)
        (folder / "src" / name / "package.xml").write_bytes(data)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(folder / "src"))
    assert arm(folder).find("binary") == folder / "src/binary"
    refused("unknown-package", arm(folder).find, "nosuch")


# -------------------------------------------------------------------------------------------------- roots, check


def test_roots(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(folder / "src"))
    roots = arm(folder, {"hand": folder / "ws/hand"}).roots()
    assert set(roots) == {folder / part for part in ("ws/arm/urdf", "ws/arm", "ws/hand", "src")}


def test_a_file_in_no_package(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = folder / "lone/arm.urdf"
    file.parent.mkdir()
    file.write_text("<robot/>")
    assert set(Packages(file).roots()) == {folder / "lone"}
    monkeypatch.chdir(file.parent)
    assert set(Packages(Path("arm.urdf")).roots()) == {folder / "lone"}
    assert Packages(Path("arm.urdf")).check(Path("arm.urdf")) == file


def test_check_follows_links(folder: Path) -> None:
    packages = arm(folder)
    inside, outside, circle = (folder / f"ws/arm/{name}" for name in ("inside", "outside", "circle"))
    inside.symlink_to("meshes")
    outside.symlink_to(folder)
    circle.symlink_to("circle")
    assert packages.check(inside / "link.stl") == folder / "ws/arm/meshes/link.stl"
    refused("outside", packages.check, outside / "secret.stl")
    assert arm(folder, allow_outside=True).check(outside / "secret.stl") == folder / "secret.stl"
    assert refused("unreadable", packages.check, circle / "x").file == str(packages.file)
    refused("unreadable", packages.check, Path("a\0b"))


def test_check_is_not_by_letters(folder: Path) -> None:
    """The folder arm_2 is not below the folder arm, though its name starts so."""
    (folder / "ws/arm_2").mkdir()
    refused("outside", arm(folder).check, folder / "ws/arm_2/x")
    refused("outside", arm(folder).check, folder / "ws/arm/../hand/meshes/palm.stl")


# ------------------------------------------------------------------------------------------------ meshes, resolve


@pytest.mark.parametrize(
    "uri",
    [
        "../meshes/link.stl",
        "./../meshes//link.stl",
        "package://arm/meshes/link.stl",
        "package://arm_description/urdf/../meshes/link.stl",
        "model://arm/meshes/link.stl",
        "file://{}/ws/arm/meshes/link.stl",
        "file://{}/ws/arm/meshes/lin%6B.stl",
        "{}/ws/arm/meshes/link.stl",
    ],
)
def test_meshes(uri: str, folder: Path) -> None:
    assert mesh_file(uri.format(folder), arm(folder)) == folder / "ws/arm/meshes/link.stl"


@pytest.mark.parametrize(
    ("uri", "code"),
    [
        ("../../../secret.stl", "outside"),
        ("/etc/passwd", "outside"),
        ("{}/secret.stl", "outside"),
        ("file://{}/secret.stl", "outside"),
        ("file:///etc/passwd", "outside"),
        ("file://{}/ws/arm/%2e%2e/%2e%2e/secret.stl", "outside"),
        ("package://arm/../../secret.stl", "outside"),
        ("package://arm//etc/passwd", "outside"),
        ("package://hand/meshes/palm.stl", "outside"),
        ("package://nosuch/x.stl", "unknown-package"),
        ("package:///etc/passwd", "unknown-package"),
        ("package://../secret.stl", "unknown-package"),
        ("package://", "unknown-package"),
        ("http://127.0.0.1:9/x.stl", "remote-file"),
        ("https://example.org/x.stl", "remote-file"),
        ("HTTP://example.org/x.stl", "remote-file"),
        ("ftp://example.org/x.stl", "remote-file"),
        ("file://server/share/x.stl", "remote-file"),
        ("smb://server/x", "remote-file"),
        ("://", "remote-file"),
        ("data:model/stl;base64,AAAA", "no-mesh"),
        ("file:/etc/passwd", "no-mesh"),
        ("nosuch.stl", "no-mesh"),
        ("package://arm/nosuch.stl", "no-mesh"),
        ("package://arm", "no-mesh"),
        ("package://arm/meshes", "no-mesh"),
        ("", "no-mesh"),
        (".", "no-mesh"),
        ("x" * 5000, "no-mesh"),
        ("a\nb\x1b[31m", "no-mesh"),
        ("file:///%00", "unreadable"),
        ("a\0b", "unreadable"),
    ],
)
def test_meshes_that_may_not_be_read(uri: str, code: str, folder: Path) -> None:
    error = refused(code, mesh_file, uri.format(folder), arm(folder))
    assert len(str(error)) < 2000


def test_meshes_by_links(folder: Path) -> None:
    (folder / "ws/arm/meshes/good.stl").symlink_to("link.stl")
    (folder / "ws/arm/meshes/bad.stl").symlink_to(folder / "secret.stl")
    (folder / "ws/arm/meshes/gone.stl").symlink_to("nowhere.stl")
    assert mesh_file("../meshes/good.stl", arm(folder)) == folder / "ws/arm/meshes/link.stl"
    refused("outside", mesh_file, "../meshes/bad.stl", arm(folder))
    refused("no-mesh", mesh_file, "../meshes/gone.stl", arm(folder))
    assert mesh_file("../meshes/bad.stl", arm(folder, allow_outside=True)) == folder / "secret.stl"


# ------------------------------------------------------------------------------------------------------- COLLADA

COLLADA = "http://www.collada.org/2005/11/COLLADASchema"


def collada(folder: Path, images: str, name: str = "link.dae") -> Path:
    """A COLLADA file with these images in its library."""
    file = folder / "ws/arm/meshes" / name
    file.write_text(f'<COLLADA xmlns="{COLLADA}"><library_images>{images}</library_images></COLLADA>')
    return file


def image(path: str) -> str:
    return f'<image id="i"><init_from>{path}</init_from></image>'


@pytest.mark.parametrize(
    "images",
    [
        "",
        image("skin.png"),
        image(" ../meshes/skin.png\n"),
        image("file:{}/skin.png"),
        image("file://{}/ws/arm/meshes/skin.png"),
        image("package://arm/meshes/skin.png"),
        image("data:image/png;base64,iVBORw0K"),
        '<image><init_from><ref>skin.png</ref></init_from></image><x sid="a">words</x>',
        image("not_there.png"),
    ],
)
def test_images_inside(images: str, folder: Path) -> None:
    file = collada(folder, images.format(folder))
    assert mesh_file("package://arm/meshes/link.dae", arm(folder)) == file


@pytest.mark.parametrize(
    ("images", "code"),
    [
        (image("/etc/passwd"), "outside"),
        (image("\n /etc/passwd "), "outside"),
        (image("{}/secret.png"), "outside"),
        (image("../../../secret.png"), "outside"),
        (image("%2e%2e/%2e%2e/%2e%2e/secret.png"), "outside"),
        (image("file:///etc/passwd"), "outside"),
        (image("file://{}/secret.png"), "outside"),
        (image("<![CDATA[/etc/passwd]]>"), "outside"),
        (image("&#47;etc/passwd"), "outside"),
        (image("/etc/<!-- -->passwd"), "outside"),
        (image("../../..<x/>/ws/arm/meshes/skin.png"), "outside"),
        (image("skin.png") + image("/etc/passwd"), "outside"),
        ("<image><init_from><ref>/etc/passwd</ref></init_from></image>", "outside"),
        ("<init_from>/etc/passwd</init_from>", "outside"),
        ("<my_init_from>/etc/passwd</my_init_from>", "outside"),
        (f'<c:image xmlns:c="{COLLADA}"><c:init_from>/etc/passwd</c:init_from></c:image>', "outside"),
        (image("http://127.0.0.1:9/x.png"), "remote-file"),
        (image("https://example.org/x.png"), "remote-file"),
        (image("//example.org/x.png"), "outside"),
        (image("\0"), "encoding"),
        ("<unclosed>", "not-xml"),
        (image("%00"), "unreadable"),
    ],
)
def test_images_outside(images: str, code: str, folder: Path) -> None:
    collada(folder, images.replace("{}", str(folder)))
    refused(code, mesh_file, "../meshes/link.dae", arm(folder))
    collada(folder, images.replace("{}", str(folder)), "LINK.DAE")
    refused(code, mesh_file, "../meshes/LINK.DAE", arm(folder))


def test_images_by_links(folder: Path) -> None:
    (folder / "ws/arm/meshes/linked.png").symlink_to(folder / "secret.png")
    collada(folder, image("linked.png"))
    refused("outside", mesh_file, "../meshes/link.dae", arm(folder))


def test_a_doctype_in_a_mesh(folder: Path) -> None:
    file = collada(folder, "")
    file.write_text('<!DOCTYPE a [<!ENTITY e SYSTEM "file:///etc/passwd">]><a>&e;</a>')
    error = refused("doctype", mesh_file, "../meshes/link.dae", arm(folder))
    assert (error.file, error.line) == (str(file), 1)
