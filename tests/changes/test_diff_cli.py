"""``pinscrew diff``: robots, files, git revisions; exit status and messages."""

from __future__ import annotations

import json
import math
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import urdfs
from command_line import ok, process, refused, run
from pinscrew.changes import revision

ARM = urdfs.single_revolute()
MOVED = ARM.replace("0.3 -0.2 0.5", "0.3 -0.2 0.501")

PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="height" value="0.5"/>
</robot>
"""
XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="l1" default="0.3"/>
  <xacro:include filename="parts/parts.xacro"/>
  <link name="base"/><link name="tool"/>
  <joint name="j" type="continuous">
    <parent link="base"/><child link="tool"/><origin xyz="$(arg l1) 0 ${height}"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")


def git(folder: Path, *words: str) -> None:
    settings = ["-c", "user.name=A", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"]
    subprocess.run(["git", *settings, *words], cwd=folder, check=True, capture_output=True)


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two commits: of an arm, of a xacro file in a folder with what it includes, and of changes of both."""
    for name in [name for name in os.environ if name.startswith("GIT_")]:
        monkeypatch.delenv(name)
    root = tmp_path / "work"
    (root / "cell" / "parts").mkdir(parents=True)
    git(tmp_path, "init", "-q", "-b", "main", "work")
    (root / "arm.urdf").write_text(ARM)
    (root / "cell" / "arm.urdf.xacro").write_text(XACRO)
    (root / "cell" / "parts" / "parts.xacro").write_text(PARTS)
    (root / "cell" / "mesh.STL").write_bytes(b"\x00" * 100)
    git(root, "add", ".")
    git(root, "commit", "-q", "-m", "one")
    (root / "arm.urdf").write_text(MOVED)
    (root / "cell" / "parts" / "parts.xacro").write_text(PARTS.replace("0.5", "0.6"))
    (root / "later.urdf").write_text(ARM)
    git(root, "add", ".")
    git(root, "commit", "-q", "-m", "two")
    monkeypatch.chdir(root)
    return root


def test_exit_status(tmp_path: Path) -> None:
    before, after = tmp_path / "before.urdf", tmp_path / "after.urdf"
    before.write_text(ARM)
    after.write_text(MOVED)
    assert ok("diff", before, before).out == f"{before} → {before}: the motion is the same\n"
    done = run("diff", before, after)
    assert (done.status, done.err) == (1, "")
    assert done.out.splitlines()[1] == (
        "  joint 'j': its axis is moved by 1 mm along z, in the frame of 'base'; what follows goes along (line 1)"
    )
    assert ok("diff", before, after, "--tolerance-mm", "2")
    assert run("diff", before, after, "--tolerance-mm", "0.9", "--tolerance-deg", "9").status == 1
    assert "no-such.urdf" in refused("diff", before, tmp_path / "no-such.urdf")


def test_as_a_process() -> None:
    done = process("diff", "two_joint", "planar_2r", "--json")
    assert (done.returncode, done.stderr) == (1, "")
    assert json.loads(done.stdout)["schema"] == "pinscrew.diff/1"


def test_robots_by_name_with_arguments() -> None:
    done = run("diff", "scara", "l1:=0.4", "scara", "l1:=0.5", "--json")
    assert done.status == 1
    document = json.loads(done.out)
    assert (document["a"], document["b"]) == ("scara l1:=0.4", "scara l1:=0.5")
    assert [change["kind"] for change in document["changes"]] == ["axis-moved", "limits"]
    assert document["changes"][0]["length"] == pytest.approx(0.1)


def test_markdown(tmp_path: Path) -> None:
    page = tmp_path / "diff.md"
    assert run("diff", "scara", "scara", "l1:=0.5", "--markdown", page).status == 1
    assert page.read_text().startswith("### scara → scara l1:=0.5: 2 changes")
    assert refused("diff", "scara", "scara", "--markdown", tmp_path / "no" / "diff.md").endswith(
        "(No such file or directory)"
    )


@pytest.mark.parametrize("words", [[], ["scara"], ["scara", "drone", "one_joint"]])
def test_two_robots(words: list[str]) -> None:
    done = run("diff", *words)
    assert (done.status, done.out) == (2, "")


def test_negative_tolerance() -> None:
    assert "'-1' is negative" in refused("diff", "scara", "scara", "--tolerance-mm", "-1")
    assert "'1deg' is an angle" in refused("diff", "scara", "scara", "--tolerance-mm", "1deg")
    assert "'1mm' is a length" in refused("diff", "scara", "scara", "--tolerance-deg", "1mm")


@pytest.mark.parametrize(
    ("option", "texts"),
    [("--tolerance-mm", ("10", "10mm", "1cm", "0.01m")), ("--tolerance-deg", ("0.1", "0.1deg", "pi/1800 rad"))],
)
def test_tolerances_in_any_unit(option: str, texts: tuple[str, ...], tmp_path: Path) -> None:
    """All the same: 9.99 mm (0.0999°) are within it, 10.01 mm (0.1001°) are not."""
    for part, status in ((0.999, 0), (1.001, 1)):
        moved = {"--tolerance-mm": (0.01 * part, 0.0), "--tolerance-deg": (0.0, math.radians(0.1) * part)}[option]
        files = []
        for name, (x, turn) in (("a", (0.0, 0.0)), ("b", moved)):
            text = urdfs.robot(
                urdfs.joint("slide", "prismatic", "base", "link", axis="0 0 1"),
                urdfs.joint("mount", "fixed", "link", "tool", xyz=f"{x!r} 0 0", rpy=f"{turn!r} 0 0"),
                links="base link tool",
            )
            files.append(tmp_path / f"{name}.urdf")
            files[-1].write_text(text)
        for text in texts:
            assert run("diff", *map(str, files), option, text).status == status


# ---------------------------------------------------------------------------------------------------- git


@needs_git
@pytest.mark.parametrize("word", ["HEAD~1:arm.urdf", "HEAD~1:./arm.urdf", "main~1:arm.urdf", "HEAD~1:cell/../arm.urdf"])
def test_a_revision(repository: Path, word: str) -> None:
    done = run("diff", word, "arm.urdf")
    assert (done.status, done.err) == (1, "")
    assert done.out.startswith(f"{word} → arm.urdf: 1 change\n")
    assert ok("diff", "HEAD:arm.urdf", "arm.urdf")
    assert repository.joinpath("arm.urdf").read_text() == MOVED


@needs_git
def test_findings_about_a_revision_are_in_the_working_tree(repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A forge shows lines of the files that were checked out."""
    monkeypatch.delenv("GITHUB_WORKSPACE", raising=False)
    assert "::error file=arm.urdf,line=1," in run("diff", "HEAD~1:arm.urdf", "HEAD:arm.urdf", "--github").err
    monkeypatch.chdir(repository / "cell")
    monkeypatch.setenv("GITHUB_WORKSPACE", str(repository))
    assert "::error file=arm.urdf,line=1," in run("diff", "HEAD~1:arm.urdf", "HEAD:../arm.urdf", "--github").err


@needs_git
def test_from_a_folder_of_the_repository(repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repository / "cell")
    for word in ("HEAD~1:../arm.urdf", "HEAD~1:arm.urdf"):
        assert run("diff", word, "../arm.urdf").status == 1
    assert ok("diff", "HEAD:./arm.urdf.xacro", "arm.urdf.xacro")


@needs_git
def test_a_xacro_file_has_what_it_includes(repository: Path) -> None:
    done = run("diff", "HEAD~1:cell/arm.urdf.xacro", "cell/arm.urdf.xacro", "--json")
    assert done.status == 1
    (change,) = json.loads(done.out)["changes"]
    assert (change["kind"], change["length"]) == ("tip-moved", pytest.approx(0.1))
    assert ok("diff", "HEAD~1:cell/arm.urdf.xacro", "HEAD~1:cell/arm.urdf.xacro", "l1:=0.3")
    assert repository.is_dir()


@needs_git
def test_lock_files_of_a_revision(repository: Path) -> None:
    pytest.importorskip("pinscrew.lockfile.writing")
    assert run("lock", "arm.urdf").status == 0
    lock = next(repository.glob("*.lock"))
    git(repository, "add", ".")
    git(repository, "commit", "-q", "-m", "three")
    assert run("diff", f"HEAD:{lock.name}", "HEAD~2:arm.urdf").status == 1
    assert ok("diff", lock.name, "arm.urdf")


@needs_git
def test_messages_name_the_revision(repository: Path) -> None:
    (repository / "arm.urdf").write_text(ARM.replace('child link="tool"', 'child link="tol"'))
    (repository / "cell" / "parts" / "parts.xacro").write_text(PARTS.replace("height", "depth"))
    git(repository, "commit", "-q", "-a", "-m", "broken")
    assert refused("diff", "HEAD:arm.urdf", "HEAD~1:arm.urdf").startswith("HEAD:arm.urdf:1: joint 'j': ")
    assert refused("diff", "HEAD:cell/arm.urdf.xacro", "HEAD~1:arm.urdf").startswith("HEAD:cell/arm.urdf.xacro:6: ")
    (repository / "arm.urdf").write_text(ARM.replace("0 1 0", "0 2 0"))
    git(repository, "commit", "-q", "-a", "-m", "long axis")
    done = process("diff", "HEAD:arm.urdf", "HEAD~2:arm.urdf")
    assert "pinscrew: warning: HEAD:arm.urdf:1: joint 'j': the axis is 2 long" in done.stderr


@needs_git
def test_places_in_what_a_xacro_includes(repository: Path) -> None:
    """A changed joint of an included file is told at its line there, from a folder and from a revision."""
    namespace = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    joint = ARM[ARM.index("<joint") : ARM.index("</joint>") + len("</joint>")]
    rest = ARM.replace(joint, '<xacro:include filename="parts/joint.xacro"/>')
    (repository / "cell" / "r.xacro").write_text(rest.replace("<robot", f"<robot {namespace}"))
    for axis in ("0 1 0", "1 0 0"):
        text = f"<r {namespace}>\n\n{joint.replace('0 1 0', axis)}</r>"
        (repository / "cell" / "parts" / "joint.xacro").write_text(text)
        git(repository, "add", ".")
        git(repository, "commit", "-q", "-m", axis)
    for b, file in (("HEAD:cell/r.xacro", "parts/joint.xacro"), ("cell/r.xacro", "cell/parts/joint.xacro")):
        done = run("diff", "HEAD~1:cell/r.xacro", b, "--json")
        (change,) = json.loads(done.out)["changes"]
        assert (change["file"], change["line"]) == (file, 3)
        assert f"({file}:3)" in run("diff", "HEAD~1:cell/r.xacro", b).out


@needs_git
def test_what_git_does_not_have(repository: Path) -> None:
    assert refused("diff", "HEAD~9:arm.urdf", "arm.urdf").startswith(
        "HEAD~9:arm.urdf: git knows no revision 'HEAD~9'; give a commit, branch or tag"
    )
    assert refused("diff", "HEAD~1:later.urdf", "arm.urdf") == (
        "HEAD~1:later.urdf: there is no file 'later.urdf' in revision 'HEAD~1'; give its path from the top of the "
        "repository, or ./path"
    )
    for word in ("HEAD:cell", "HEAD:../arm.urdf", "HEAD:/etc/passwd"):
        assert "there is no file" in refused("diff", word, "arm.urdf")
    assert "git knows no revision '--output=x'" in refused("diff", "arm.urdf", "--", "--output=x:arm.urdf")
    assert not (repository / "x").exists()
    assert "git knows no revision 'http'" in refused("diff", "http://example.org/arm.urdf", "arm.urdf")


@needs_git
def test_no_repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))
    message = refused("diff", "HEAD:arm.urdf", "scara")
    assert message.startswith("HEAD:arm.urdf: git says: fatal: not a git repository")
    assert message.endswith("; run it inside the repository that has the revision")


def test_no_git(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    message = refused("diff", "HEAD:arm.urdf", "scara")
    assert message == (
        "a revision needs git, which can't be run (No such file or directory); install git, or give two files"
    )


def test_a_file_with_a_colon_is_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("C:arm.urdf").write_text(ARM)
    assert ok("diff", "C:arm.urdf", "C:arm.urdf")
    assert not revision.is_revision("C:arm.urdf")
    assert revision.is_revision("D:arm.urdf")
    assert not revision.is_revision("scara")
