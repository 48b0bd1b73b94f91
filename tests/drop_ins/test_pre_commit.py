"""The hooks for pre-commit, run by pre-commit."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import identify.identify
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = ROOT / ".pre-commit-hooks.yaml"
HOOKS = yaml.safe_load(MANIFEST.read_text(encoding="utf-8"))


def pre_commit(folder: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "pre_commit", *map(str, words)]
    environment = {**os.environ, "PRE_COMMIT_HOME": str(folder / "pre-commit")}
    return subprocess.run(command, capture_output=True, text=True, env=environment)


def configured(folder: Path, *hooks: dict[str, Any]) -> Path:
    """A configuration with these hooks, in whose place pinscrew is not installed anew."""
    file = folder / "hooks.yaml"
    local = [{**hook, "language": "system"} for hook in hooks]
    file.write_text(yaml.safe_dump({"repos": [{"repo": "local", "hooks": local}]}))
    return file


def test_the_hooks_are_valid(tmp_path: Path) -> None:
    done = pre_commit(tmp_path, "validate-manifest", MANIFEST)
    assert done.returncode == 0, done.stdout
    files = [ROOT / ".pre-commit-config.yaml", ROOT / "examples" / "robot_repository" / ".pre-commit-config.yaml"]
    done = pre_commit(tmp_path, "validate-config", *files)
    assert done.returncode == 0, done.stdout


def test_the_example_uses_the_hooks_that_there_are() -> None:
    text = (ROOT / "examples" / "robot_repository" / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    (repo,) = yaml.safe_load(text)["repos"]
    assert [hook["id"] for hook in repo["hooks"]] == [hook["id"] for hook in HOOKS]


def test_this_repository_uses_its_own_hooks() -> None:
    (repo,) = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))["repos"]
    own = {hook["id"]: hook for hook in repo["hooks"]}
    for hook in HOOKS:
        same = ("entry", "args", "types", "require_serial", "pass_filenames", "files")
        assert {name: own[hook["id"]].get(name) for name in same} == {name: hook.get(name) for name in same}


@pytest.mark.parametrize("name", ["arm.urdf", "arm.urdf.xacro", "arm.xacro"])
def test_pre_commit_knows_the_files(name: str) -> None:
    (verify, _) = HOOKS
    assert set(verify["types"]) <= identify.identify.tags_from_filename(name)


def test_hooks_pass(repository: Path, tmp_path: Path) -> None:
    done = pre_commit(tmp_path, "run", "--all-files", "--verbose", "--config", configured(tmp_path, *HOOKS))
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("Passed") == 2
    assert "2 of 2 robots: both engines agree" in done.stdout, "the macro is no robot"
    assert "2 of 2 mechanisms are those of their locks" in done.stdout
    assert subprocess.run(["git", "diff", "--quiet"], cwd=repository).returncode == 0


def test_hooks_fail(broken: Path, tmp_path: Path) -> None:
    done = pre_commit(tmp_path, "run", "--all-files", "--config", configured(tmp_path, *HOOKS))
    assert done.returncode == 1
    assert done.stdout.count("Failed") == 2
    assert "robots/cart.urdf:7: joint 'slide': the axis is zero" in done.stdout
    assert "robots/arm.urdf.xacro.lock: MOVED" in done.stdout
    assert broken.is_dir()


@pytest.mark.slow
def test_the_hooks_install_pinscrew(repository: Path, tmp_path: Path) -> None:
    """As for a user: pre-commit clones this repository and installs it with pip."""
    done = pre_commit(tmp_path, "try-repo", ROOT, "--all-files", "--verbose")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("Passed") == 2
    assert repository.is_dir()
