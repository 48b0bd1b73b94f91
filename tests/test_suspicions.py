"""What a file may say in earnest but rarely means: each is named, and no public file is accused."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Final

import pytest

import pinscrew as ps
import urdfs
from command_line import run
from pinscrew.description import urdf
from pinscrew.description.catalogue import bundled, example_robots
from pinscrew.ground.errors import DescriptionError, PinscrewWarning

ARM: Final = """<robot name="arm">
  <link name="base"/>
  <link name="tool"/>
  <joint name="j" type="revolute">
    <parent link="base"/>
    <child link="tool"/>
    <origin xyz="0 0 0.5" rpy="0 0 1"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""


def edited(old: str, new: str) -> str:
    assert ARM.count(old) == 1, old
    return ARM.replace(old, new)


def warned(text: str, *, strict: bool = False) -> list[PinscrewWarning]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        urdf.parse(text, "arm.urdf", strict=strict)
    return [each.message for each in caught if isinstance(each.message, PinscrewWarning)]


MISSPELT: Final = {
    "orgin": (edited("<origin ", "<orgin "), 7, "<orgin>", "<origin>"),
    "Origin": (edited("<origin ", "<Origin "), 7, "<Origin>", "<origin>"),
    "ryp": (edited("rpy=", "ryp="), 7, "ryp=", "rpy="),
    "RPY": (edited("rpy=", "RPY="), 7, "RPY=", "rpy="),
    "xzy": (edited('xyz="0 0 0.5"', 'xzy="0 0 0.5"'), 7, "xzy=", "xyz="),
    "quat_wxyz": (edited("rpy=", "quat_wxyz="), 7, "quat_wxyz=", "quat_xyzw="),
    "axes": (edited("<axis ", "<axes "), 8, "<axes>", "<axis>"),
    "mimick": (edited("    <limit", '    <mimick joint="k"/><limit'), 9, "<mimick>", "<mimic>"),
    "Limit": (edited("    <limit", '    <Limit lower="0"/><limit'), 9, "<Limit>", "<limit>"),
    "lowr": (edited("lower=", "lowr="), 9, "lowr=", "lower="),
    "joints": (edited('<link name="tool"/>', '<link name="tool"/><joints/>'), 3, "<joints>", "<joint>"),
    "jiont": (edited('<link name="tool"/>', '<link name="tool"/><jiont/>'), 3, "<jiont>", "<joint>"),
    "Link": (edited('<link name="tool"/>', '<link name="tool"/><Link name="b"/>'), 3, "<Link>", "<link>"),
}


@pytest.mark.parametrize(("text", "line", "wrong", "right"), MISSPELT.values(), ids=MISSPELT)
def test_misspelt_kinematics(text: str, line: int, wrong: str, right: str) -> None:
    found = [remark for remark in warned(text) if remark.code == "misspelt"]
    assert [(remark.line, remark.file) for remark in found] == [(line, "arm.urdf")]
    assert wrong in str(found[0])
    assert str(found[0]).endswith(f"did you mean {right}?")
    with pytest.raises(DescriptionError) as caught:
        urdf.parse(text, "arm.urdf", strict=True)
    assert caught.value.line in (line, 4)  # that of the joint, where a limit that is not there is told first


def test_multipler() -> None:
    follower = urdfs.joint("k", "revolute", "base", "b", mimic=("j", 2.0, 0.0)).replace("multiplier", "multipler")
    text = ARM.replace("</robot>", f'<link name="b"/>{follower}</robot>')
    (remark,) = warned(text)
    assert (remark.code, "joint 'k'" in str(remark), "multiplier=" in str(remark)) == ("misspelt", True, True)


def test_a_joint_inside_a_link() -> None:
    inside = '<link name="b"><joint name="k" type="fixed"/></link>'
    text = ARM.replace('<link name="base"/>', f"{inside}").replace('link="base"', 'link="b"')
    (remark,) = warned(text)
    assert (remark.code, remark.line) == ("misspelt", 2)
    assert "<joint> inside <link>" in str(remark)


KNOWN: Final = (
    "<calibration rising='0'/>", "<dynamics damping='1'/>", "<safety_controller k_velocity='1'/>",
    "<joint_properties/>", "<traits/>", "<controller_gains/>", "<anchor/>", "<ext:orgin/>", "<hardwareInterface/>",
)  # fmt: skip


@pytest.mark.parametrize("element", KNOWN)
def test_other_elements_are_not_accused(element: str) -> None:
    assert warned(edited("    <limit", f"    {element}<limit"), strict=True) == []
    assert warned(edited('xyz="0 0 0.5"', 'xyz="0 0 0.5" ext:rpyy="x" reference="y"')) == []
    for top in ("gazebo", "transmission", "sensor", "material", "ros2_control", "mujoco"):
        assert warned(edited('<link name="tool"/>', f'<link name="tool"/><{top}/>')) == []


NUMBERS: Final = {
    "rpy of 90": (edited('rpy="0 0 1"', 'rpy="0 90 0"'), "rpy-in-degrees", 7),
    "a turn is none": (edited('rpy="0 0 1"', 'rpy="0 0 6.283"'), "", 0),
    "millimetres": (edited('xyz="0 0 0.5"', 'xyz="0 -333 0"'), "far-origin", 7),
    "99 m": (edited('xyz="0 0 0.5"', 'xyz="0 0 99"'), "", 0),
    "limits of 90": (edited('lower="-1" upper="1"', 'lower="-90" upper="90"'), "limits-in-degrees", 9),
    "limits of 0 and 30": (edited('lower="-1" upper="1"', 'lower="0" upper="30"'), "limits-in-degrees", 9),
    "10 rad": (edited('lower="-1" upper="1"', 'lower="-10" upper="10"'), "", 0),
    "no limits": (edited('lower="-1" upper="1"', 'lower="-1e16" upper="1e16"'), "", 0),
    "two turns": (edited('lower="-1" upper="1"', 'lower="-12.566" upper="12.566"'), "", 0),
    "reversed": (edited('lower="-1" upper="1"', 'lower="1" upper="-1"'), "reversed-limits", 4),
}


@pytest.mark.parametrize(("text", "code", "line"), NUMBERS.values(), ids=NUMBERS)
def test_numbers_that_look_wrong(text: str, code: str, line: int) -> None:
    assert [(remark.code, remark.line) for remark in warned(text)] == ([(code, line)] if code else [])
    if code:
        with pytest.raises(DescriptionError) as caught:
            urdf.parse(text, "arm.urdf", strict=True)
        assert (caught.value.code, caught.value.line) == (code, line)


def test_a_slide_may_have_long_limits() -> None:
    text = edited('lower="-1" upper="1"', 'lower="0" upper="50"').replace("revolute", "prismatic")
    assert warned(text) == []


def test_each_kind_of_number_is_told_once() -> None:
    """A file in millimetres has as many far origins as joints."""
    joints = [urdfs.joint(f"j{i}", "fixed", f"l{i}", f"l{i + 1}", xyz="0 0 500") for i in range(5)]
    (remark,) = warned(urdfs.robot(*joints, links=" ".join(f"l{i}" for i in range(6))))
    assert remark.code == "far-origin"
    assert str(remark).endswith("(and 4 more like it)")


def test_strict_everywhere(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(MISSPELT["orgin"][0])
    with pytest.warns(PinscrewWarning, match="did you mean"):
        assert ps.load(file).nq == 1
    with pytest.raises(DescriptionError):
        ps.load(file, strict=True)
    for command in (("verify", "--samples", "1"), ("screws",), ("fk",), ("jacobian", "--kind", "body"), ("lock",)):
        done = run(*command, str(file), "--strict")
        assert done.status == 2, command
        assert "did you mean <origin>?" in done.err
    assert list(tmp_path.iterdir()) == [file]
    lax = run("screws", str(file))
    assert (lax.status, "did you mean <origin>?" in lax.err) == (0, True)


@pytest.mark.filterwarnings("error::pinscrew.PinscrewWarning")
@pytest.mark.parametrize("name", [entry.name for entry in bundled()])
def test_bundled_robots_are_beyond_suspicion(name: str) -> None:
    ps.load(name, strict=True)


def test_no_public_file_is_accused() -> None:
    """Of those of example-robot-data: no misspelling at all, and no number taken for another unit."""
    codes = {}
    for entry in example_robots():
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                ps.load(entry.file)
            except DescriptionError:
                continue
        codes[entry.name] = {w.message.code for w in caught if isinstance(w.message, PinscrewWarning)}
    accused = {"misspelt", "rpy-in-degrees", "limits-in-degrees", "far-origin", "reversed-limits"}
    assert {name: found & accused for name, found in codes.items() if found & accused} == {}
    assert len(codes) > 50
