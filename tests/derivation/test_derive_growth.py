"""What grows without bound is refused in time; what is long is written in short lines that say the same."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from test_read_back import value_of

import pinscrew as ps
from pinscrew.derivation import reports
from pinscrew.derivation.arguments import MOST_ARGUMENTS
from pinscrew.ground.errors import InputError, UnsupportedError
from pinscrew.mathtext import evaluate, read_latex, symbols
from urdfs import joint, robot

WIDEST_SEEN = 130


def odd_arm(joints: int) -> str:
    """Joints with no two axes parallel or perpendicular."""
    rng = np.random.default_rng(4)

    def numbers(digits: int) -> str:
        return " ".join(f"{x:.{digits}f}" for x in rng.uniform(0.1, 1.0, 3))

    parts = [
        joint(f"j{i}", "revolute", f"l{i}", f"l{i + 1}", xyz=numbers(3), rpy=numbers(6), axis=numbers(4))
        for i in range(joints)
    ]
    return robot(*parts, links=" ".join(f"l{i}" for i in range(joints + 1)))


def load(text: str, folder: Path) -> ps.Robot:
    (folder / "arm.urdf").write_text(text, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ps.load(folder / "arm.urdf")


@pytest.mark.parametrize(("joints", "code"), [(8, "derive-growth"), (20, "derive-size")])
def test_arms_that_grow_too_long_are_refused_at_once(joints: int, code: str, tmp_path: Path) -> None:
    with pytest.raises(UnsupportedError) as caught:
        ps.derive(load(odd_arm(joints), tmp_path))
    assert caught.value.code == code


def test_four_joints_at_odd_angles_are_not_too_long(tmp_path: Path) -> None:
    d = ps.derive(load(odd_arm(4), tmp_path))
    assert max(len(element.terms) for element in d.normal.pose.flat) == 3**4


def test_many_arguments_are_not_all_examined(tmp_path: Path) -> None:
    names = [f"a{i}" for i in range(200)]
    arguments = "".join(f'<xacro:arg name="{name}" default="0.5"/>' for name in names)
    text = robot(joint("j", "revolute", "base", "tool", xyz="$(arg a0) 0 0", axis="0 0 1"), links="base tool")
    text = text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ', 1).replace(
        ">", f">{arguments}", 1
    )
    (tmp_path / "arm.xacro").write_text(text, encoding="utf-8")
    d = ps.derive(ps.load(tmp_path / "arm.xacro"))
    assert [str(symbol) for symbol in d.lengths] == ["a0"]
    assert len(d.remarks) == 199
    assert sum(str(MOST_ARGUMENTS) in remark for remark in d.remarks) == 200 - MOST_ARGUMENTS


@pytest.fixture(scope="module")
def panda() -> str:
    d = ps.derive("panda", "panda_hand_tcp")
    return reports.write(reports.report(d, d.prove(2), ["T", "Jb", "Js"]), "markdown")


def test_no_line_of_a_long_report_is_wider_than_a_page(panda: str) -> None:
    for line in panda.splitlines():
        if not line.startswith("\\") and " = " in line and "bmatrix" not in line and "$" not in line:
            seen = re.sub(r"\\(left|right|dot|theta|tfrac|sqrt|dagger|hat|xi)|[{}_ ^]", "", line)
            assert len(seen) <= WIDEST_SEEN, line


def test_the_sums_with_names_of_their_own_give_what_both_engines_say(panda: str) -> None:
    rng = np.random.default_rng(8)
    q = rng.uniform(-2.0, 2.0, 7)
    values: dict[str, float] = {}
    assert "k_{1} =" in panda
    for section in panda.split("\n## ")[1:]:
        pairs = re.findall(r"^([a-zA-Z]_\{\d+\}) = (.+)$", section, re.MULTILINE)
        waiting = [(left.replace("{", "").replace("}", ""), read_latex(right)) for left, right in pairs]
        for left, tree in sorted(waiting, key=lambda pair: (pair[0][0] != "k", int(pair[0][2:]))):
            known = {s: values[s] if s[0] == "k" else value_of(s, q, q, {}) for s in symbols(tree)}
            values[left] = float(evaluate(tree, known))
        for engine in (ps.PoE(ps.load("panda")), ps.Pinocchio(ps.load("panda"))):
            full = np.zeros(engine.robot.nq)
            full[[engine.robot.joint_names.index(f"panda_joint{i}") for i in range(1, 8)]] = q
            answers = {
                "(d)": engine.fk(full, "panda_hand_tcp"),
                "(i)": engine.jacobian(full, "panda_hand_tcp", "body")[:, :7],
                "(l)": engine.jacobian(full, "panda_hand_tcp", "spatial")[:, :7],
            }
            name = "g" if section.startswith("(d)") else "J"
            answer = answers.get(section[:3])
            if answer is None:
                continue
            entries = [(left, values.pop(left)) for left in list(values) if left[0] == name]
            for left, value in entries:
                assert value == pytest.approx(answer[int(left[2]) - 1, int(left[3]) - 1], abs=1e-12), left
            values |= dict(entries) if isinstance(engine, ps.PoE) else {}


def test_equal_takes_texts_and_lists_and_refuses_what_is_none() -> None:
    d = ps.derive("spherical")
    assert d.equal(d.pose[2, 3], "L0 - s2*(L3 + theta3)")
    assert not d.equal(d.pose[2, 3], "L0 + s2*(L3 + theta3)")
    assert d.equal("c1^2 + sin(theta1)**2", 1)
    assert d.equal("0.1*c1", "c1/10")
    assert d.equal(d.pose[:3, 3], [["-(L3 + theta3)*s1*c2"], ["(L3 + theta3)*c1*c2"], ["L0 - (L3 + theta3)*s2"]])
    wrong = ["__import__('os')", "L9", "1/0", "9**9**9", "x" * 20_000, "(1, 2)", "c1 s1", "True", "1e999999999", "c1.x"]
    for text in wrong:
        with pytest.raises(InputError) as caught:
            d.equal(text, 1)
        assert caught.value.code == "formula", text
