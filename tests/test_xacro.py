"""xacro files that must work: what we expand is what xacro itself expands, wherever that is safe."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import pytest
import xacro

import command_line
import pinscrew as ps
from pinscrew.description import catalogue, markup
from pinscrew.description.expand import expand
from pinscrew.description.packages import Packages
from pinscrew.ground.errors import DescriptionError, PinscrewWarning, XacroError

NS: Final = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LINKS: Final = '<link name="a"/><link name="b"/>'


def robot(body: str) -> str:
    return f'<robot name="r" {NS}>\n{LINKS}\n{body}\n</robot>\n'


def joint(xyz: str) -> str:
    return f'<joint name="j" type="fixed"><parent link="a"/><child link="b"/><origin xyz="{xyz}"/></joint>'


def write(folder: Path, files: Mapping[str, str]) -> Path:
    """Files in a folder; the first is the robot's."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder / next(iter(files))


def plain(file: Path, arguments: Mapping[str, str] | None = None) -> str:
    """What xacro itself makes of a file."""
    text: str = xacro.process_file(str(file), mappings=dict(arguments or {})).toprettyxml(indent="  ")
    return text


VALUES: Final = {
    "1": "1",
    "${1}": "1",
    "${0.1 + 0.2}": "0.30000000000000004",
    "${2*3 - 4/8}": "5.5",
    "${7 // 2} ${7 % 4} ${-7 % 4}": "3 3 1",
    "${2**10}": "1024",
    "${2**-1}": "0.5",
    "${2**0.5}": "1.4142135623730951",
    "${pi/2}": "1.5707963267948966",
    "${math.pi}": "3.141592653589793",
    "${sin(pi/6)} ${math.sin(math.pi/6)}": "0.49999999999999994 0.49999999999999994",
    "${radians(90)} ${degrees(pi)}": "1.5707963267948966 180.0",
    "${hypot(3, 4)} ${atan2(1, 1)}": "5.0 0.7853981633974483",
    "${1 if 2 > 1 else 0}": "1",
    "${1 &lt; 2 &lt; 3 and not (1 == 2)}": "True",
    "${'a' in ['a', 'b']} ${3 not in [1, 2]}": "True True",
    "${max(1, 2, 3)} ${min([4, 5])} ${abs(-2)}": None,
    "${python.abs(-2)} ${python.sum([1, 2])}": "2 3",
    "${len([1, 2, 3])} ${python.len('abcd')}": "3 4",
    "${round(2.567, 1)} ${round(2.5)} ${round(-2, -1)}": "2.6 2 0",
    "${int('7')} ${float('1.5')} ${str(2)} ${bool(0)}": "7 1.5 2 False",
    "${[1, 2, 3][1]} ${[1, 2, 3][-1]} ${[1, 2, 3, 4][1:3]}": "2 3 [2, 3]",
    "${(1, 2)[0]} ${dict(a=1)['a']}": "1 1",
    "${[2*x for x in [1, 2, 3]]}": "[2, 4, 6]",
    "${[x for x in python.range(10) if x % 3 == 0]}": "[0, 3, 6, 9]",
    "${[(x, y) for x in [1, 2] for y in [3, 4]]}": "[(1, 3), (1, 4), (2, 3), (2, 4)]",
    "${sum([x**2 for x in python.range(4)])}": None,
    "${python.sum([x**2 for x in python.range(4)])}": "14",
    "${list(map(str, [1, 2]))}": "['1', '2']",
    "${python.sorted([3, 1, 2])}": "[1, 2, 3]",
    "${python.any([0, 1])} ${python.all([0, 1])}": "True False",
    "${list(python.zip([1, 2], [3, 4]))} ${list(python.enumerate('ab'))}": "[(1, 3), (2, 4)] [(0, 'a'), (1, 'b')]",
    "${'%s_link' % 'left'} ${'%.3f' % pi} ${'%03d' % 7}": "left_link 3.142 007",
    "${'%s_%d' % ('arm', 2)}": "arm_2",
    "${'ab' + 'cd'} ${'ab' * 2} ${[0] * 3}": "abcd abab [0, 0, 0]",
    "$${1} $$(x)": "${1} $(x)",
    "$(eval 1 + 2)": "3",
    "$(eval [1, 2][1])": "2",
    "$(eval 2 if true else 3)": "2",
    "$(optenv PINSCREW_NO_SUCH some words)": "some words",
    "$(optenv PINSCREW_NO_SUCH)x": "x",
    "${xacro.tokenize('a, b;c d')}": "['a', 'b', 'c', 'd']",
    "${xacro.tokenize('a:b', ':')[1]}": "b",
    "${xacro.dotify(dict(a=dict(b=3))).a.b}": "3",
    "${'1 2 3'.split()} ${'1 2 3'.split()[1]} ${'a,b,,c'.split(',')} ${'a,b,c'.split(',', 1)}": None,
    "${[float(x) for x in '1 2 3'.split()]}": "[1.0, 2.0, 3.0]",
    "${'a b'.split(sep=' ', maxsplit=1)} ${'a.b.c'.rsplit('.', maxsplit=1)[0]}": "['a', 'b'] a.b",
    "${'Left'.lower()} ${'left'.upper()} ${' x '.strip()} ${'xyx'.strip('x')} ${'left'.capitalize()}": None,
    "${' '.join(['1', '2'])} ${','.join(str(2*x) for x in [1, 2])} ${''.join([])}": "1 2 2,4 ",
    "${'left_leg'.startswith('left')} ${'left_leg'.endswith(('arm', 'leg'))}": "True True",
    "${'left_leg'.replace('left', 'right')} ${'aaa'.replace('a', 'bb', 2)} ${'ab'.replace('', '-')}": None,
    "${'abc'.index('b')} ${'abcb'.count('b')} ${'abc'.find('z')} ${[1, 2].index(2)} ${(1, 1).count(1)}": "1 2 -1 1 2",
    "${dict(a=1).get('a')} ${dict(a=1).get('b', 7)} ${dict(a=1).get('b')}": "1 7 None",
    "${list(dict(a=1, b=2).keys())} ${list(dict(a=1).values())} ${list(dict(a=1).items())}": None,
    "${'a' in dict(a=1).keys()} ${[k + str(v) for k, v in dict(a=1, b=2).items()]}": "True ['a1', 'b2']",
    "${'1.5'.isdigit()} ${'15'.isdigit()} ${'a=b'.partition('=')[2]}": "False True b",
    "${list(map('ab'.count, 'abb'))}": "[1, 1, 1]",
}


@pytest.mark.parametrize(("text", "expected"), VALUES.items(), ids=VALUES)
def test_values(text: str, expected: str | None, tmp_path: Path) -> None:
    """Each as an attribute: that xacro makes the same of it (but for functions that only we have), and its value."""
    file = write(tmp_path, {"r.xacro": robot(f'<x value="{text}"/>')})
    expanded = expand(file, {})
    if ("min(" not in text and "sum([x**2" not in text) or "python.sum" in text:
        assert expanded == plain(file)
    if expected is not None:
        (x,) = markup.parse(expanded, file).all("x")
        assert x.attributes["value"] == expected


FILES: Final[dict[str, tuple[dict[str, str], dict[str, str]]]] = {
    "arguments": (
        {},
        {
            "r.xacro": robot(
                '<xacro:arg name="l" default="0.5"/><xacro:arg name="p" default="x"/>'
                '<xacro:property name="l" value="$(arg l)"/>'
                + joint("${l} ${2*l} $(eval l + 1)")
                + "<x value=\"$(arg p) ${xacro.arg('p')}\"/>"
            )
        },
    ),
    "arguments given": ({"l": "2"}, {"r.xacro": robot('<xacro:arg name="l" default="1"/>' + joint("$(arg l) 0 0"))}),
    "an argument after another": (
        {},
        {
            "r.xacro": robot(
                '<xacro:arg name="a" default="1"/><xacro:arg name="b" default="$(arg a)2"/><x v="$(arg b)"/>'
            )
        },
    ),
    "conditions": (
        {"real": "true"},
        {
            "r.xacro": robot(
                '<xacro:arg name="real" default="false"/><xacro:if value="$(arg real)"><x/></xacro:if>'
                '<xacro:unless value="${1 == 1}"><y/></xacro:unless><xacro:if value="0"><z/></xacro:if>'
            )
        },
    ),
    "macros": (
        {},
        {
            "r.xacro": robot(
                '<xacro:macro name="leg" params="side y:=0.1 up:=${pi/2} *origin **more">'
                '<x name="${side}_leg" y="${y}" up="${up}"><xacro:insert_block name="origin"/>'
                '<xacro:insert_block name="more"/></x></xacro:macro>'
                '<xacro:leg side="left"><origin xyz="${1+1} 0 0"/><m><p/><q/></m></xacro:leg>'
                '<xacro:leg side="right" y="-0.1"><origin xyz="0 0 0"/><m/></xacro:leg>'
                '<xacro:call macro="leg" side="dynamic"><origin/><m/></xacro:call>'
            )
        },
    ),
    "macros of macros": (
        {},
        {
            "r.xacro": robot(
                '<xacro:macro name="a" params="n"><x n="${n}"/><xacro:if value="${n > 0}"><xacro:a n="${n - 1}"/>'
                '</xacro:if></xacro:macro><xacro:a n="5"/>'
            )
        },
    ),
    "properties": (
        {},
        {
            "r.xacro": robot(
                '<xacro:property name="w" value="${2*h}"/><xacro:property name="h" value="0.5"/>'
                '<xacro:property name="b"><y v="${w}"/></xacro:property><x v="${w} ${w + h}"/>'
                '<xacro:insert_block name="b"/>'
                '<xacro:property name="h" value="1"/><x v="${h} ${w}"/><xacro:property name="h" remove="true"/>'
                '<xacro:property name="h" default="3"/><x v="${h}"/>'
                '<xacro:property name="s" value="\'12\'"/><x v="${s + s}"/><xacro:property name="t" value="true"/>'
                '<xacro:if value="${t}"><t/></xacro:if>'
            )
        },
    ),
    "properties in comprehensions": (
        {},
        {
            "r.xacro": robot(
                '<xacro:property name="n" value="3"/><xacro:property name="d" value="${n/2}"/>'
                '<xacro:macro name="m" params="k"><x v="${[k*d*i for i in python.range(n) if i &lt; k]}"/>'
                '</xacro:macro><xacro:m k="2"/>'
            )
        },
    ),
    "elements and attributes": (
        {},
        {
            "r.xacro": robot(
                '<xacro:property name="tag" value="box"/><xacro:element xacro:name="${tag}">'
                '<xacro:attribute name="size" value="${tag}2"/></xacro:element>'
            )
        },
    ),
    "includes": (
        {},
        {
            "robot/r.xacro": robot(
                '<xacro:include filename="parts/*.xacro"/><xacro:include filename="parts/wheel.xacro" ns="w"/>'
                '<xacro:include filename="nosuch.xacro" optional="true"/><xacro:wheel/><xacro:w.wheel/>'
                '<x v="${w.radius}"/>'
            ),
            "robot/parts/wheel.xacro": f'<r {NS}><xacro:property name="radius" value="0.3"/><xacro:macro name="wheel">'
            '<w r="${radius}"/></xacro:macro><xacro:include filename="deep/rim.xacro"/></r>',
            "robot/parts/deep/rim.xacro": f"<r {NS}><rim/></r>",
        },
    ),
    "YAML": (
        {},
        {
            "r.xacro": robot(
                '<xacro:property name="c" value="${xacro.load_yaml(\'config/arm.yaml\')}"/>'
                "<x a=\"${c['l'][1]} ${c.l[0]} ${c['joint']['max']} ${c.joint.max} ${c.name} ${c.list[0].x}\"/>"
                '<x a="${c.angle} ${c.length} ${len(c.l)} ${[2*l for l in c.l]}"/>'
            ),
            "config/arm.yaml": "l: [0.1, 0.2]\njoint: {max: 1.5}\nname: arm\nlist: [{x: 7}]\n"
            "angle: !degrees 180\nlength: !millimeters 2*500\n",
        },
    ),
    "methods of YAML": (
        {},
        {
            "r.xacro": robot(
                '<xacro:property name="c" value="${xacro.load_yaml(\'arm.yaml\')}"/>'
                "<x a=\"${list(c.keys())} ${c.get('no', 3)} ${c.joints.index('b')} ${c['text'].split()[1]}\"/>"
                "<x a=\"${[k for k, v in c.limits.items()]} ${sorted(list(c['limits'].values()))[0]}\"/>"
                "<x a=\"${c.get('limits')['a']} ${'joints' in c.keys()} ${'_'.join(c.joints)} ${c.text.upper()}\"/>"
            ),
            "arm.yaml": "joints: [a, b]\nlimits: {a: 2, b: 1}\ntext: some words\n",
        },
    ),
    "arguments that are only used": (
        {"sim": "true", "prefix": "p_"},
        {"r.xacro": robot('<xacro:if value="$(arg sim)"><x v="$(arg prefix)a ${xacro.arg(\'prefix\')}"/></xacro:if>')},
    ),
    "extensions and comments": (
        {},
        {
            "r.xacro": robot(
                '<!-- ${1+1} --><!-- xacro:eval-comments --><!-- ${1+1} --><g:x xmlns:g="http://g" v="${1}"/>'
            )
        },
    ),
    "Unicode": ({}, {"r.xacro": robot('<xacro:property name="ü" value="שלום"/><x v="${ü}😀 &amp;&lt;&quot;"/>')}),
}


@pytest.mark.parametrize("name", FILES)
def test_files(name: str, tmp_path: Path) -> None:
    arguments, files = FILES[name]
    file = write(tmp_path, files)
    assert expand(file, arguments) == plain(file, arguments)


@pytest.mark.parametrize("entry", [e for e in catalogue.bundled() if e.file.suffix == ".xacro"], ids=lambda e: e.name)
def test_bundled_robots(entry: catalogue.Entry) -> None:
    assert expand(entry.file, {}) == plain(entry.file)
    arguments = {name: str(float(value) * 1.5) for name, value in catalogue.declared_arguments(entry.file).items()}
    assert expand(entry.file, arguments) == plain(entry.file, arguments)
    expanded = ps.Robot.from_description(ps.load(entry.name, arguments=arguments).description)
    assert dict(expanded.description.arguments) == arguments


# ------------------------------------------------------------------------------------------ what xacro can't do alone


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<x v="$(env PINSCREW_TEST) $(optenv PINSCREW_TEST no)"/>', "here here"),
        ("<x v=\"$(eval env['x'] if false else 1)\"/>", "1"),
        ('<x v="${[n for n in range(3)]} ${sorted([2, 1])} ${sum([1, 2])}"/>', "[0, 1, 2] [1, 2] 3"),
    ],
)
def test_more_values(body: str, expected: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PINSCREW_TEST", "here")
    file = write(tmp_path, {"r.xacro": robot(body)})
    (x,) = markup.parse(expand(file, {}), file).all("x")
    assert x.attributes["v"] == expected


ARM: Final = f'<r {NS}><xacro:property name="length" value="0.25"/></r>'
USES_ARM: Final = robot('<xacro:include filename="$(find arm)/urdf/arm.xacro"/>' + joint("${length} 0 0"))
PACKAGE: Final = "<package><name>arm</name></package>"


def length(file: Path, **options: object) -> float:
    """The length that a robot of `USES_ARM` found in the package."""
    return float(ps.load(file, **options).home("b")[0, 3])  # type: ignore[arg-type]


def test_find_declared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = write(tmp_path, {"r/r.xacro": USES_ARM, "else/where/urdf/arm.xacro": ARM})
    assert length(file, packages={"arm": tmp_path / "else" / "where"}) == 0.25
    monkeypatch.chdir(tmp_path)
    assert length(Path("r/r.xacro"), packages={"arm": "else/where"}) == 0.25


def test_find_by_the_command_line(tmp_path: Path) -> None:
    file = write(tmp_path, {"r/r.xacro": USES_ARM, "arm/urdf/arm.xacro": ARM})
    done = command_line.ok("fk", file, "--json", "--package", f"arm:={tmp_path / 'arm'}")
    assert json.loads(done.out)["pose"][0][3] == 0.25


def test_find_in_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = write(tmp_path, {"r/r.xacro": USES_ARM, "ws/share/arm/urdf/arm.xacro": ARM, "other/share/x": ""})
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join(map(str, (tmp_path / "other", tmp_path / "ws"))))
    assert length(file) == 0.25
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    with pytest.raises(XacroError) as caught:
        ps.load(file)
    assert caught.value.code == "unknown-package"
    ros = write(tmp_path, {"src/deep/er/package.xml": PACKAGE, "src/deep/er/urdf/arm.xacro": ARM}).parents[2]
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(ros))
    assert length(file) == 0.25


def test_find_upwards(tmp_path: Path) -> None:
    """The file's own package, by its folder's name or the one in its package.xml."""
    for folder in ("arm", "arm_v2"):
        inside = {
            f"{folder}/robots/r.xacro": USES_ARM,
            f"{folder}/urdf/arm.xacro": ARM,
            f"{folder}/package.xml": PACKAGE,
        }
        assert length(write(tmp_path, inside)) == 0.25


WORKSPACE: Final = {
    "siblings": ("ws/robot/urdf/r.xacro", "ws/arm", ("ws/robot/package.xml",)),
    "a sibling of another name": ("ws/robot/urdf/r.xacro", "ws/arm_v2", ("ws/robot/package.xml",)),
    "a repository": ("repo/robots/robot/r.xacro", "repo/common/parts/arm_v2", ("repo/.git/HEAD",)),
    "a submodule": ("repo/robots/robot/r.xacro", "repo/common/arm", ("repo/.git",)),
    "repositories of a workspace": ("ws/src/a/robot/r.xacro", "ws/src/b/arm", ("ws/src/a/.git/HEAD",)),
    "a workspace": ("ws/src/robot/r.xacro", "ws/src/b/c/arm_v2", ()),
}


@pytest.mark.parametrize("name", WORKSPACE)
def test_packages_beside_the_file(name: str, tmp_path: Path) -> None:
    """What is found may be read: by include, by YAML, and by the path that it is found at, in every spelling."""
    robot_file, arm, more = WORKSPACE[name]
    bodies = {
        "find": '<xacro:include filename="$(find arm)/urdf/arm.xacro"/>',
        "file": '<xacro:include filename="file://$(find arm)/urdf/arm.xacro"/>',
        "package": '<xacro:include filename="package://arm/urdf/arm.xacro"/>',
        "path": f'<xacro:include filename="{tmp_path}/{arm}/urdf/arm.xacro"/>',
        "YAML": '<xacro:property name="y" value="${xacro.load_yaml(\'$(find arm)/arm.yaml\')}"/>'
        '<xacro:property name="length" value="${y.l}"/>',
    }
    files = {f"{arm}/package.xml": PACKAGE, f"{arm}/urdf/arm.xacro": ARM, f"{arm}/arm.yaml": "l: 0.25"}
    write(tmp_path, {**files, **dict.fromkeys(more, "<package><name>robot</name></package>")})
    for body in bodies.values():
        assert length(write(tmp_path, {robot_file: robot(body + joint("${length} 0 0"))})) == 0.25


@pytest.mark.parametrize("body", ["$(find arm)/urdf/arm.xacro", "../arm/urdf/arm.xacro", "$(find arm)/../x.xacro"])
def test_what_is_no_package_may_not_be_read(body: str, tmp_path: Path) -> None:
    """A folder beside a package may be anyone's: only with a ``package.xml`` is it one."""
    include = f'<xacro:include filename="{body}"/>'
    own = {"ws/robot/package.xml": "<package><name>robot</name></package>", "ws/x.xacro": ARM}
    file = write(tmp_path, {"ws/robot/r.xacro": robot(include + joint("0 0 0")), "ws/arm/urdf/arm.xacro": ARM, **own})
    if "x.xacro" in body:
        write(tmp_path, {"ws/arm/package.xml": PACKAGE})
    with pytest.raises(XacroError) as caught:
        ps.load(file)
    assert caught.value.code == "outside"


def test_nothing_is_remembered(tmp_path: Path) -> None:
    """Two robots with packages of one name get each their own."""
    lengths = []
    for value in ("0.25", "0.75"):
        file = write(
            tmp_path, {f"{value}/r.xacro": USES_ARM, f"{value}/arm/urdf/arm.xacro": ARM.replace("0.25", value)}
        )
        lengths.append(length(file, packages={"arm": file.parent / "arm"}))
    assert lengths == [0.25, 0.75]


def test_outside_if_allowed(tmp_path: Path) -> None:
    outside = write(tmp_path, {"else/arm.xacro": ARM})
    body = f'<xacro:include filename="../else/arm.xacro"/><xacro:include filename="{outside}"/>{joint("${length} 0 0")}'
    file = write(tmp_path, {"r/r.xacro": robot(body)})
    with pytest.raises(XacroError, match="outside its own folder"):
        ps.load(file)
    assert length(file, allow_outside=True) == 0.25
    assert json.loads(command_line.ok("fk", file, "--json", "--allow-outside").out)["pose"][0][3] == 0.25


def test_links(tmp_path: Path) -> None:
    """A file's folder is where it is named, as for xacro itself, and where it is, as for a workspace of links."""
    body = '<xacro:include filename="more.xacro"/>' + joint("${length} 0 0")
    file = write(tmp_path, {"src/r.xacro": robot(body), "src/arm.xacro": ARM})
    (file.parent / "more.xacro").symlink_to("arm.xacro")
    assert length(file) == 0.25
    named = write(tmp_path, {"share/more.xacro": ARM.replace("0.25", "0.75")}).with_name("r.xacro")
    named.symlink_to(file)
    assert length(named) == 0.75
    (tmp_path / "share" / "more.xacro").unlink()
    (tmp_path / "share" / "more.xacro").symlink_to(file.with_name("arm.xacro"))
    assert length(named) == 0.25


# ---------------------------------------------------------------------------------------------------- what is said


def test_warnings_are_passed_on(tmp_path: Path) -> None:
    body = "<xacro:if value=\"${xacro.warning('mind the gap') == 'x'}\"/><xacro:include filename=\"no*.xacro\"/>"
    file = write(tmp_path, {"r.xacro": robot(body + joint("0 0 0"))})
    with pytest.warns(PinscrewWarning) as caught:
        ps.load(file)
    assert all(warning.message.code == "xacro" for warning in caught)  # type: ignore[union-attr]
    said = [str(warning.message) for warning in caught]
    assert all(message.startswith(f"{file}: ") for message in said)
    assert any("mind the gap" in message for message in said)
    assert any("matched no files" in message for message in said)


def test_lines_are_those_of_the_source(tmp_path: Path) -> None:
    """What is wrong in the expansion is told at the element that it comes from, in the file and macro that has it."""
    bad = joint("0 ${'x'} 0")
    file = write(tmp_path, {"r.xacro": robot("<!-- one -->\n" * 5 + bad)})
    with pytest.raises(DescriptionError) as caught:
        ps.load(file)
    assert (caught.value.file, caught.value.line) == (str(file), 8)
    more = f'<r {NS}>\n\n<xacro:macro name="m">\n\n{bad}\n</xacro:macro>\n</r>'
    file = write(tmp_path, {"s.xacro": robot('<xacro:include filename="more.xacro"/><xacro:m/>'), "more.xacro": more})
    with pytest.raises(DescriptionError) as caught:
        ps.load(file)
    assert (caught.value.file, caught.value.line) == (str(tmp_path / "more.xacro"), 5)
    assert str(caught.value).startswith(f"{tmp_path / 'more.xacro'}:5: joint 'j': ")


def trouble(file: Path, **arguments: object) -> XacroError:
    """The error of a file that can't be expanded."""
    with pytest.raises(XacroError) as caught:
        ps.load(file, **arguments)  # type: ignore[arg-type]
    return caught.value


def test_places_of_errors(tmp_path: Path) -> None:
    """Through includes and macros: where the mistake is, in which macros, and where they were called."""
    util = (
        f'<r {NS}>\n<xacro:macro name="inner" params="x">\n<a>\n<b v="${{1/x}}"/></a></xacro:macro>\n'
        '<xacro:macro name="outer" params="x">\n\n<xacro:inner x="${x}"/></xacro:macro></r>'
    )
    files = {"sub/util.xacro": util}

    def place(body: str) -> str:
        error = trouble(
            write(tmp_path, {"r.xacro": robot(f'<xacro:include filename="sub/util.xacro"/>\n{body}'), **files})
        )
        assert error.code == "xacro"
        return f"{Path(error.file).relative_to(tmp_path)}:{error.line}: {error.what}"

    inner = 'sub/util.xacro:4: in macro "inner", called from '
    assert place('<xacro:inner x="0"/>').startswith(f"{inner}r.xacro:4: division by zero")
    calls = f'{inner}util.xacro:7, in macro "outer", called from r.xacro:5: division by zero'
    assert place('\n<xacro:outer x="0"/>').startswith(calls)
    # The value of a parameter is the caller's, and so is what it calls a macro with.
    assert place('<c>\n<xacro:inner x="${1/0}"/></c>').startswith("r.xacro:5: division by zero")
    assert place('<xacro:outer x="1" y="2"/>').startswith('r.xacro:4: Invalid parameter "y"')
    assert place('<c v="1"/><c>text\n${no}</c>').startswith("r.xacro:4: name 'no' is not defined")
    assert place('<xacro:property name="p" value="${1/0}"/>\n\n<c v="${p}"/>').startswith("r.xacro:6: division by zero")
    deep = "".join(f'<xacro:macro name="m{i}"><xacro:m{i + 1}/></xacro:macro>' for i in range(6))
    assert "… (6 calls): unknown macro name: xacro:m6" in place(f"{deep}<xacro:m0/>")


def test_places_of_warnings_and_joints(tmp_path: Path) -> None:
    body = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 2"/>'
    more = f'<r {NS}>\n\n{body}<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></r>'
    file = write(tmp_path, {"r.xacro": robot('\n\n<xacro:include filename="more.xacro"/>'), "more.xacro": more})
    with pytest.warns(PinscrewWarning, match="2 long") as caught:
        loaded = ps.load(file)
    (warning,) = (w.message for w in caught)
    assert isinstance(warning, PinscrewWarning)
    assert (warning.file, warning.line) == (str(tmp_path / "more.xacro"), 3)
    assert loaded.description.joints[0].line == 3


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    file = write(tmp_path, {"r.xacro": robot('<xacro:include filename="pipe.xacro"/>')})
    os.mkfifo(tmp_path / "pipe.xacro")
    assert "there is no such file" in trouble(file).what
    write(tmp_path, {"r.xacro": robot("<x v=\"${xacro.load_yaml('pipe.xacro')}\"/>")})
    assert "there is no such file" in trouble(file).what


def test_xacro_in_a_urdf(tmp_path: Path) -> None:
    """By its content: macros, or values in attributes, under a declared namespace."""
    bodies = ('<xacro:property name="l" value="0.25"/>' + joint("${l} 0 0"), joint("${1/4} 0 0"))
    for body in bodies:
        file = write(tmp_path, {"r.urdf": robot(body)})
        with pytest.warns(PinscrewWarning, match="was expanded first") as caught:
            assert length(file) == 0.25
        assert [w.message.code for w in caught] == ["xacro-content"]  # type: ignore[union-attr]
    file = write(tmp_path, {"r.urdf": robot('<xacro:arg name="l" default="1"/>' + joint("$(arg l) 0 0"))})
    with pytest.warns(PinscrewWarning):
        assert length(file, l=2) == 2.0
    for body in (joint("1 0 0") + "<!-- <xacro:m/> ${x} -->", "<gazebo>${x}</gazebo>" + joint("1 0 0")):
        assert length(write(tmp_path, {"r.urdf": robot(body)})) == 1.0
    write(tmp_path, {"r.urdf": robot(joint("${1} 0 0")).replace(NS, "")})
    with pytest.raises(DescriptionError, match="not a finite number"):
        ps.load(tmp_path / "r.urdf")


def test_arguments_are_numbers_or_words(tmp_path: Path) -> None:
    body = '<xacro:arg name="length" default="1"/><xacro:arg name="tip" default="x"/>' + joint("$(arg length) 0 0")
    file = write(tmp_path, {"r.xacro": robot(body)})
    assert length(file, length=0.1 + 0.2) == 0.1 + 0.2
    np.testing.assert_array_equal(ps.load(file, arguments={"length": "2", "tip": "y"}).home("b")[:3, 3], [2, 0, 0])


def test_arguments_of_included_files(tmp_path: Path) -> None:
    more = f'<r {NS}><xacro:arg name="l" default="1"/></r>'
    body = '<xacro:include filename="more.xacro"/>' + joint("$(arg l) 0 0")
    file = write(tmp_path, {"r.xacro": robot(body), "more.xacro": more})
    assert length(file, l=3) == 3.0
    with pytest.raises(XacroError) as caught:
        ps.load(file, m=3)
    assert caught.value.code == "xacro-argument"
    assert "declared are: l" in str(caught.value)


def test_the_default_packages_are_those_of_the_file(tmp_path: Path) -> None:
    file = write(tmp_path, {"r.xacro": robot(joint("1 2 3"))})
    assert expand(file, {}) == expand(file, {}, Packages(file))
