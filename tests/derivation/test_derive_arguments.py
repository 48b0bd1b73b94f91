"""xacro arguments as symbols: exactly those that enter as lengths, and why the others do not."""

from pathlib import Path

import pytest
import sympy as sp

import pinscrew as ps
from pinscrew.derivation import arguments
from pinscrew.derivation.reading import printed
from pinscrew.ground.errors import PinscrewError
from urdfs import joint, robot

XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="a" default="0.4"/><xacro:arg name="b" default="0.3"/><xacro:arg name="tilt" default="0.5"/>
  <xacro:arg name="square" default="0.7"/><xacro:arg name="colour" default="red"/><xacro:arg name="drawn" default="2"/>
  <xacro:arg name="long" default="true"/>
  <xacro:property name="a" value="$(arg a)"/><xacro:property name="b" value="$(arg b)"/>
  <xacro:property name="s" value="$(arg square)"/>
  <link name="base"/><link name="mid"/><link name="tool"/>
  <joint name="one" type="revolute"><parent link="base"/><child link="mid"/>
    <origin xyz="${a/2} ${s*s} ${2*b - a/3 + 0.1}" rpy="0 0 $(arg tilt)"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="$(arg drawn)"/></joint>
  <joint name="two" type="prismatic"><parent link="mid"/><child link="tool"/>
    <origin xyz="${PRODUCT} 0 0"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


def load(tmp_path: Path, product: str) -> ps.Robot:
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(XACRO.replace("PRODUCT", product), encoding="utf-8")
    return ps.load(file)


def test_lengths_are_symbols_and_the_rest_is_explained(tmp_path: Path) -> None:
    d = ps.derive(load(tmp_path, "b"))
    a, b = sp.symbols("a b", positive=True)
    assert dict(d.lengths) == {a: sp.Rational(2, 5), b: sp.Rational(3, 10)}
    assert d.screws[0].q - sp.ImmutableMatrix(
        [a / 2, sp.Rational(49, 100), 2 * b - a / 3 + sp.Rational(1, 10)]
    ) == sp.zeros(3, 1)
    why = "\n".join(d.remarks)
    assert "tilt stays a number: it enters a rotation" in why
    assert "square stays a number: positions are not affine in it" in why
    assert "colour stays a number: its value 'red' is no number" in why
    assert "drawn stays a number: it does not enter" in why
    assert d.prove(10).ok


def test_a_product_of_arguments_is_not_affine(tmp_path: Path) -> None:
    d = ps.derive(load(tmp_path, "a*b"))
    assert len(d.lengths) == 1
    assert d.prove(10).ok


def test_few_evaluations() -> None:
    robot = ps.load("planar_rrr")
    calls = []

    def loader(change: dict[str, str]) -> ps.Robot:
        calls.append(change)
        return ps.load("planar_rrr", arguments=change)

    found = arguments.recover(robot, ["tool"], printed(robot, ["tool"]), loader)
    assert list(found.symbols) == ["l1", "l2", "l3"]
    assert len(calls) == found.evaluations == 4  # one for each length, one that proves


def test_given_arguments_are_the_values() -> None:
    d = ps.derive(ps.load("scara", l1=0.7))
    assert [float(v) for v in d.lengths.values()] == [0.7, 0.3]


def test_numbers_of_a_urdf() -> None:
    text = robot(
        joint("j", "revolute", "base", "mid", xyz="0.333 0 -0.0825", rpy="1.5708 0 0.785398", axis="0 0 2"),
        joint("k", "revolute", "mid", "tool", xyz="0.0825 0 0.333", rpy="0 0 0.3", axis="0.57735 0.57735 0.57735"),
        links="base mid tool",
    )
    import warnings

    import urdfs

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        arm = urdfs.load(text)
    d = ps.derive(arm, symbols=True)
    l1, l2 = sp.symbols("l1 l2", positive=True)
    assert dict(d.lengths) == {l1: sp.Rational(333, 1000), l2: sp.Rational(33, 400)}
    assert d.screws[0].q == sp.ImmutableMatrix([l1, 0, -l2])
    assert [(s.printed, s.value) for s in d.snapped] == [("1.5708", sp.pi / 2), ("0.785398", sp.pi / 4)]
    assert not d.exact  # 0.3 rad
    proof = d.prove(10)
    assert proof.ok
    assert proof.largest < 1e-13
    given = [c for c in proof.comparisons if c.given]
    assert max(c.error for c in given) > 1e-12  # what the file says is not what it means
    strict = ps.derive(arm, snap=0.0)
    assert not strict.snapped
    assert strict.prove(10).ok


BAD = [
    ({"names": "joint"}, "derive-option"),
    ({"convention": "dh"}, "derive-option"),
    ({"snap": 1.0}, "derive-option"),
    ({"tip": "hand"}, "unknown-frame"),
    ({"symbols": {"c1": 1.0}}, "symbol-collision"),
    ({"symbols": {"theta2": 1.0}}, "symbol-collision"),
    ({"symbols": {"not a name": 1.0}}, "symbol-collision"),
    ({"symbols": {"lambda": 1.0}}, "symbol-collision"),
    ({"symbols": {"x0": 1.0}}, "symbol-collision"),
    ({"symbols": {"l1": 17.0}}, "derive-option"),
]


@pytest.mark.parametrize(("options", "code"), BAD, ids=str)
def test_bad_input(options: dict[str, object], code: str) -> None:
    with pytest.raises(PinscrewError) as caught:
        ps.derive(ps.load("planar_2r"), **options)  # type: ignore[arg-type]
    assert caught.value.code == code


@pytest.mark.parametrize(("text", "code"), [("chain", "derive-size"), ("planar", "derive-joint")])
def test_robots_without_closed_forms(text: str, code: str) -> None:
    import urdfs

    arm = urdfs.load(urdfs.chain(9) if text == "chain" else urdfs.planar())
    with pytest.raises(PinscrewError) as caught:
        ps.derive(arm)
    assert caught.value.code == code
    if text == "chain":
        assert ps.derive(arm, "8").prove(3).ok


def test_mimics_of_all_kinds() -> None:
    import urdfs

    for build in (urdfs.mimic, urdfs.mimic_chain, urdfs.mimic_continuous, urdfs.rotated, urdfs.only_fixed, urdfs.tree):
        arm = urdfs.load(build())
        tip = arm.frame_names[-1]
        assert ps.derive(arm, tip).prove(10).ok, build.__name__


@pytest.mark.parametrize("xyz", ["1e-99999999 0 0", "0e99999999 0 0", f"1.{'3' * 5000} 0 0"])
def test_numbers_without_measure(xyz: str, tmp_path: Path) -> None:
    """A file's number is a double: as a fraction the first would have a hundred million digits."""
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/>'
    text = f'<robot name="r"><link name="a"/><link name="b"/>{joint}<origin xyz="{xyz}"/></joint></robot>'
    (tmp_path / "r.urdf").write_text(text)
    home = ps.derive(ps.load(tmp_path / "r.urdf")).home
    assert float(home[0, 3]) == pytest.approx(float(xyz.split(maxsplit=1)[0]), abs=1e-15)
    assert home[0, 3].p.bit_length() < 200
