"""Gates that must not pass: a lock of another file, and notes that are to fail in ``diff``, ``lock`` and pytest."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import pinscrew as ps
import urdfs
from command_line import ok, refused, run
from pinscrew import lockfile
from pinscrew.changes import gates
from pinscrew.changes.gates import GATES
from pinscrew.ground.errors import DescriptionError, InputError

ARM = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "l1", xyz="0 0 0.3"),
    urdfs.joint("j2", "revolute", "l1", "l2", xyz="0.4 0 0", axis="0 1 0"),
    urdfs.joint("eye", "fixed", "l1", "camera", xyz="0 0.1 0"),
    links="base l1 l2 camera",
)
NEW_TIP = '<link name="probe"/><joint name="p" type="fixed"><parent link="l2"/><child link="probe"/></joint></robot>'
EDITS = {
    "robot": (('name="small"', 'name="other"'), {"names"}),
    "joint": (('"j2"', '"elbow"'), {"names"}),
    "link": (('"l1"', '"upper"'), {"names"}),
    "tip": (('"l2"', '"tool"'), {"names", "tips"}),
    "another tip": (("</robot>", NEW_TIP.replace('"l2"', '"l1"')), {"frames", "tips"}),
    "velocity": (('velocity="1"', 'velocity="2"'), {"velocity", "limits"}),
    "effort": (('effort="1"', 'effort="2"'), {"effort", "limits"}),
    "frame": (("</robot>", NEW_TIP), {"frames", "tips"}),
}
"""An edit that moves nothing, and the gates that it must not pass, beside ``all``."""


def edited(old: str, new: str) -> str:
    text = ARM.replace(old, new)
    assert text != ARM
    return text


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an arm and its lock, and no settings above it."""
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.urdf").write_text(ARM)
    (tmp_path / "before.urdf").write_text(ARM)
    ok("lock", "arm.urdf")
    return tmp_path


# --------------------------------------------------------------------------------------- a lock of another file


def test_a_copied_lock_is_no_lock_of_the_copy(here: Path) -> None:
    """The attack: copy a robot with its lock, and edit the copy, which the lock never looks at."""
    (here / "b.urdf").write_text(ARM.replace("0.4 0 0", "0.5 0 0"))
    shutil.copy(here / "arm.urdf.lock", here / "b.urdf.lock")
    for words in (("b.urdf",), ("b.urdf.lock",), ("./b.urdf",), (str(here / "b.urdf"),)):
        message = refused_check(*words)
        assert "b.urdf.lock: it was made from 'arm.urdf', and not from" in message
    assert run("lock", "--check").status == 2
    assert "and not from" in refused("lock", "b.urdf.lock"), "nor is it written anew from the other file"
    with pytest.raises(DescriptionError) as caught:
        lockfile.check("b.urdf.lock")
    assert caught.value.code == "lock-other"
    (here / "b.urdf").unlink()
    assert "and not from" in refused_check("b.urdf"), "the file that was named need not be there"


def refused_check(*words: str) -> str:
    done = run("lock", "--check", *words)
    assert done.status == 2
    return done.err


def test_a_lock_is_not_written_beside_another_file(here: Path) -> None:
    (here / "b.urdf").write_text(ARM)
    before = sorted(here.iterdir())
    assert "b.urdf.lock: it was made from 'arm.urdf'" in refused("lock", "arm.urdf", "--output", "b.urdf.lock")
    assert sorted(here.iterdir()) == before


def test_links_are_the_file_that_they_lead_to(here: Path) -> None:
    (here / "link.urdf").symlink_to("arm.urdf")
    shutil.copy(here / "arm.urdf.lock", here / "link.urdf.lock")
    assert "the same" in ok("lock", "--check", "link.urdf").out


@pytest.mark.parametrize("source", ["../arm.urdf", "sub/../../arm.urdf", ".."])
def test_sources_outside_are_refused(here: Path, source: str) -> None:
    folder = here / "locks"
    folder.mkdir()
    lock = folder / "arm.urdf.lock"
    text = (here / "arm.urdf.lock").read_text()
    lock.write_text(text.replace('"source": "arm.urdf"', f'"source": "{source}"'))
    with pytest.raises(DescriptionError, match="which is outside its folder") as caught:
        lockfile.check(lock)
    assert caught.value.code == "lock-outside"
    assert "outside its folder" in refused("lock", str(lock))
    if source == "../arm.urdf":
        assert lockfile.check(lock, allow_outside=True).same
    lock.write_text(text.replace('"source": "arm.urdf"', '"source": "sub/../..arm.urdf"'))
    (folder / "..arm.urdf").write_text(ARM)
    (folder / "sub").mkdir()
    assert lockfile.check(lock).same, "a name may begin with dots"


# --------------------------------------------------------------------------------------------- notes that fail


@pytest.mark.parametrize("name", EDITS)
def test_each_note_has_its_gates(here: Path, name: str) -> None:
    """In `ps.diff`, ``diff`` and ``lock --check`` alike, an edit fails under its own gates and under no others."""
    edit, expected = EDITS[name]
    (here / "arm.urdf").write_text(edited(*edit))
    a, b = ps.load("before.urdf"), ps.load("arm.urdf")
    for gate in GATES:
        fails = gate in expected | {"all"}
        changes = ps.diff(a, b, fail_on=[gate])
        assert (changes.same, changes.passes, bool(changes.failing)) == (True, not fails, fails), gate
        assert lockfile.check("arm.urdf.lock", fail_on=[gate]).passes is not fails
        assert run("diff", "before.urdf", "arm.urdf", "--fail-on", gate).status == fails
        assert run("lock", "--check", "--fail-on", gate).status == fails
    assert ps.diff(a, b).passes
    assert {gate for gate in expected if gate in ok("diff", "before.urdf", "arm.urdf").out.splitlines()[-1]}


def test_limits_of_coordinates_fail_anyway(here: Path) -> None:
    (here / "arm.urdf").write_text(edited('lower="-2.0"', 'lower="-2.1"'))
    assert run("diff", "before.urdf", "arm.urdf").status == 1
    assert run("lock", "--check", "--fail-on", "names").status == 1


def test_what_was_let_pass_is_said_in_one_line(here: Path) -> None:
    assert "let pass" not in ok("diff", "before.urdf", "arm.urdf").out
    text = edited('"j2"', '"elbow"').replace('velocity="1"', 'velocity="2"').replace('"l2"', '"tool"')
    (here / "arm.urdf").write_text(text)
    passed = "let pass: 1 of names, 1 of tips, 2 of velocity (--fail-on names,tips,velocity)"
    assert ok("diff", "before.urdf", "arm.urdf").out.splitlines()[-1] == f"  {passed}"
    assert ok("lock", "--check").out.splitlines()[-1].endswith(f"; {passed}")
    assert f"- {passed}" in ps.diff(ps.load("before.urdf"), ps.load("arm.urdf")).to_markdown()
    done = run("diff", "before.urdf", "arm.urdf", "--fail-on", "names,velocity")
    assert done.status == 1
    assert "the motion is the same, 4 notes (4 to fail on)" in done.out.splitlines()[0]
    assert "let pass" not in done.out
    done = run("lock", "--check", "--fail-on", "velocity")
    assert done.out.splitlines()[0] == "arm.urdf.lock: CHANGED"
    assert "; fails on velocity" in done.out
    assert done.out.splitlines()[-1].endswith("; let pass: 1 of names, 1 of tips (--fail-on names,tips)")


def test_reports_of_what_fails(here: Path) -> None:
    (here / "arm.urdf").write_text(edited('"j2"', '"elbow"'))
    for words in (("diff", "before.urdf", "arm.urdf"), ("lock", "--check")):
        assert ok(*words, "--sarif", "x.sarif", "--junit", "x.xml", "--json")
        assert levels(here) == ["note"]
        assert 'failures="0"' in (here / "x.xml").read_text()
        done = run(*words, "--fail-on", "names", "--sarif", "x.sarif", "--junit", "x.xml", "--json")
        assert done.status == 1
        assert levels(here) == ["error"]
        assert 'failures="1"' in (here / "x.xml").read_text()
        data = json.loads(done.out)
        row = data["locks"][0] if words[0] == "lock" else data
        assert (row["same"], row["passes"], row["fail_on"]) == (True, False, ["names"])
        assert data.get("ok", False) is False


def levels(folder: Path) -> list[str]:
    (log,) = json.loads((folder / "x.sarif").read_text())["runs"]
    return [result["level"] for result in log["results"]]


# -------------------------------------------------------------------------------------------------- settings


def test_a_lock_says_what_fails_its_check(here: Path) -> None:
    """It is part of the lock and not of its hash, is kept when the lock is written anew, and can be replaced."""
    plain = (here / "arm.urdf.lock").read_text()
    ok("lock", "arm.urdf", "--fail-on", "velocity,names")
    text = (here / "arm.urdf.lock").read_text()
    assert '  "fail_on": ["names", "velocity"],\n' in text
    assert json.loads(text)["hash"] == json.loads(plain)["hash"]
    (here / "arm.urdf").write_text(edited('velocity="1"', 'velocity="2"'))
    assert run("lock", "--check").status == 1
    assert not lockfile.check("arm.urdf.lock").passes
    assert run("lock", "--check", "--fail-on", "effort").status == 0, "the command line comes first"
    (here / "pyproject.toml").write_text('[tool.pinscrew]\nfail_on = ["effort"]\n')
    assert run("lock", "--check").status == 1, "the lock comes before the settings"
    for name in ("arm.urdf", "arm.urdf.lock"):
        ok("lock", name)
        assert '"fail_on": ["names", "velocity"]' in (here / "arm.urdf.lock").read_text()
    ok("lock", "arm.urdf.lock", "--fail-on", "")
    assert '"fail_on": []' in (here / "arm.urdf.lock").read_text()


def test_settings(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The nearest pyproject.toml says what fails where neither the command line nor the lock does."""
    (here / "arm.urdf").write_text(edited('"j2"', '"elbow"'))
    (here / "pyproject.toml").write_text('[tool.pinscrew]\nfail_on = ["names"]\n')
    assert run("lock", "--check").status == 1
    assert run("diff", "before.urdf", "arm.urdf").status == 1
    assert run("diff", "before.urdf", "arm.urdf", "--fail-on", "").status == 0
    (here / "sub").mkdir()
    monkeypatch.chdir(here / "sub")
    assert run("diff", "../before.urdf", "../arm.urdf").status == 1
    (here / "sub" / ".git").mkdir()
    assert run("diff", "../before.urdf", "../arm.urdf").status == 0, "another repository"
    (here / "sub" / "pyproject.toml").write_text('[tool.other]\nfail_on = ["names"]\n')
    assert gates.fail_on(here / "sub") == frozenset()


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('[tool.pinscrew]\nfail_on = "names"\n', "settings"),
        ("[tool.pinscrew]\nfail_on = [1]\n", "settings"),
        ("[tool]\npinscrew = 1\n", "settings"),
        ("[tool.pinscrew\n", "settings"),
        pytest.param("a = " + "[" * 100_000, "settings", id="nested"),
        ('[tool.pinscrew]\nfail_on = ["name"]\n', "fail-on"),
    ],
)
def test_wrong_settings(here: Path, text: str, code: str) -> None:
    (here / "pyproject.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        gates.fail_on(here)
    assert caught.value.code == code
    assert "pyproject.toml" in refused("lock", "--check")
    assert "pyproject.toml" in refused("diff", "before.urdf", "arm.urdf")


@pytest.mark.usefixtures("here")
def test_what_there_is_not_to_fail_on() -> None:
    for words in (("diff", "before.urdf", "arm.urdf"), ("lock", "--check"), ("lock", "arm.urdf")):
        assert "there is no 'name' to fail on; known are: names, tips" in refused(*words, "--fail-on", "name")
    robot = ps.load("arm.urdf")
    with pytest.raises(InputError, match="no 'name' to fail on"):
        ps.diff(robot, robot, fail_on=["name"])
    with pytest.raises(InputError, match="no 'name' to fail on"):
        lockfile.text(robot, fail_on="name")
