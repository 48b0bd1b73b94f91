"""`pinscrew expand`: the text that every other command reads, and where each part of it comes from."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path

import pytest
import xacro

import pinscrew as ps
from command_line import ok, refused
from pinscrew.description.catalogue import bundled

ARM = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="length" default="0.4"/>
  <xacro:include filename="part--one.xacro"/>
  <link name="base"/>
  <xacro:part name="a" parent="base"/>
  <xacro:part name="b" parent="a"/>
</robot>
"""
PART = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="part" params="name parent">
    <link name="${name}"/>
    <joint name="to_${name}" type="continuous">
      <parent link="${parent}"/><child link="${name}"/>
      <origin xyz="0 0 $(arg length)"/><axis xyz="0 0 1"/>
    </joint>
  </xacro:macro>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    (tmp_path / "part--one.xacro").write_text(PART)
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(ARM)
    return file


def test_it_is_what_xacro_makes(arm: Path) -> None:
    expected = xacro.process_file(str(arm), mappings={"length": "0.5"}).toprettyxml(indent="  ")
    assert ok("expand", str(arm), "length:=0.5").out == expected


@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_it_is_what_is_loaded(name: str, tmp_path: Path) -> None:
    file = tmp_path / "expanded.urdf"
    assert ok("expand", name, "-o", str(file), "--sources").out == ""
    assert ps.diff(ps.load(name), ps.load(file)).same


def test_sources(arm: Path) -> None:
    """Each link and joint by the line that it was written on; a comment may not hold two dashes."""
    lines = ok("expand", str(arm), "--sources").out.splitlines()
    told = {}
    for before, line in itertools.pairwise(lines):
        if found := re.fullmatch(r' *<(?:link|joint) name="(\w+)".*', line):
            told[found[1]] = before.strip()
    folder = str(arm.parent).replace("--", "- -")
    part = f"{folder}/part- -one.xacro"
    assert told == {
        "base": f"<!-- {folder}/arm.urdf.xacro:4 -->",
        "a": f"<!-- {part}:3 -->",
        "to_a": f"<!-- {part}:4 -->",
        "b": f"<!-- {part}:3 -->",
        "to_b": f"<!-- {part}:4 -->",
    }
    plain = ok("expand", str(arm)).out.splitlines()
    assert [line for line in lines if not line.strip().startswith("<!-- /")] == plain


def test_json(arm: Path) -> None:
    document = json.loads(ok("expand", str(arm), "length:=0.5", "--json").out)
    assert (document["schema"], document["arguments"]) == ("pinscrew.expand/1", {"length": "0.5"})
    assert document["urdf"] == ok("expand", str(arm), "length:=0.5").out
    assert {place["line"] for place in document["places"]} == {1, 3, 4, 5, 6}


def test_a_plain_urdf_is_printed_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "a.urdf"
    file.write_text('<robot name="a"><link name="b"/></robot>')
    assert ok("expand", str(file), "--sources").out == file.read_text() + "\n"
    assert "has no arguments" in refused("expand", str(file), "x:=1")


def test_nothing_is_written_where_it_fails(arm: Path, tmp_path: Path) -> None:
    (tmp_path / "part--one.xacro").unlink()
    assert "no such file" in refused("expand", str(arm), "-o", str(tmp_path / "out.urdf"))
    assert not (tmp_path / "out.urdf").exists()
