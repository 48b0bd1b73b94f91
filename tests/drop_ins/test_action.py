"""The action for GitHub: valid, and its steps do what it says, run by the shell that GitHub runs them with."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
ACTION = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
STEPS = {step["name"]: step for step in ACTION["runs"]["steps"] if "run" in step}
SCHEMAS = [
    ("vendor.github-actions", "action.yml"),
    ("vendor.github-workflows", "examples/robot_repository/.github/workflows/kinematics.yml"),
    ("vendor.gitlab-ci", "examples/robot_repository/.gitlab-ci.yml"),
    ("vendor.github-workflows", ".github/workflows/ci.yml"),
    ("vendor.citation-file-format", "CITATION.cff"),
    ("vendor.github-issue-config", ".github/ISSUE_TEMPLATE/config.yml"),
    ("vendor.github-issue-forms", ".github/ISSUE_TEMPLATE/wrong_answer.yml"),
    ("vendor.github-issue-forms", ".github/ISSUE_TEMPLATE/wish.yml"),
]


@pytest.mark.parametrize(("schema", "file"), SCHEMAS)
def test_valid(schema: str, file: str) -> None:
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", schema, str(ROOT / file)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_invalid_is_seen(tmp_path: Path) -> None:
    wrong = tmp_path / "action.yml"
    wrong.write_text((ROOT / "action.yml").read_text(encoding="utf-8").replace("shell: bash", "shel: bash"))
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-actions", str(wrong)]
    assert subprocess.run(command, capture_output=True).returncode == 1


def test_no_input_is_part_of_a_script() -> None:
    """GitHub puts ``${{ }}`` into a script as it is, so that an input or a branch's name could be a command."""
    assert STEPS
    assert not [name for name, step in STEPS.items() if "${{" in step["run"]]


class Job:
    """A job that runs steps of the action in the working directory, as GitHub does, but installs nothing."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        programs = folder / "pinscrew" / "bin"
        programs.mkdir(parents=True)
        program = programs / "pinscrew"
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m pinscrew "$@"\n')
        program.chmod(0o755)
        self.reports = folder / "reports"
        self.reports.mkdir()
        self.summary = folder / "summary.md"

    def run(self, name: str, **inputs: str) -> subprocess.CompletedProcess[str]:
        """Run a step with these inputs, and the default ones."""
        step = STEPS[name]
        known = {f"inputs.{key}": value["default"] for key, value in ACTION["inputs"].items()}
        known |= {f"inputs.{key.replace('_', '-')}": value for key, value in inputs.items()}
        known |= {"steps.install.outputs.reports": str(self.reports)}

        def filled(text: str) -> str:
            return re.sub(r"\$\{\{ *(.*?) *\}\}", lambda match: known[match[1]], text)

        script = self.folder / "script.sh"
        script.write_text(step["run"])
        environment = {
            **os.environ,
            "RUNNER_TEMP": str(self.folder),
            "GITHUB_WORKSPACE": str(Path.cwd()),
            "GITHUB_STEP_SUMMARY": str(self.summary),
            **{key: filled(value) for key, value in step["env"].items()},
        }
        command = ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail", str(script)]
        where = Path.cwd() / filled(step["working-directory"])
        return subprocess.run(command, cwd=where, env=environment, capture_output=True, text=True)

    def results(self, name: str) -> list[dict[str, Any]]:
        """The results in a SARIF report."""
        (run,) = json.loads((self.reports / name).read_text(encoding="utf-8"))["runs"]
        found: list[dict[str, Any]] = run["results"]
        return found


@pytest.fixture
def job(tmp_path: Path) -> Job:
    folder = tmp_path / "runner"
    folder.mkdir()
    return Job(folder)


def test_what_passes(repository: Path, job: Job) -> None:
    """Without inputs, all robots that git knows, but for macros; and no name of a file is an option."""
    (repository / "robots").rename(repository / "--all")
    subprocess.run(["git", "add", "."], check=True)
    (repository / "unknown to git.urdf").write_text("<robot/>")
    done = job.run("Verify", samples="1")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 of 2 robots: both engines agree" in done.stdout
    assert done.stderr == ""
    assert job.results("verify.sarif") == []
    assert (job.reports / "verify.xml").read_text().count("<testsuite ") == 2
    assert job.summary.read_text().count("### ") == 2
    assert job.run("Check locks").returncode == 0


def test_what_fails(broken: Path, job: Job) -> None:
    """Annotations, SARIF and summary name files from the top, wherever the job works."""
    done = job.run("Verify", working_directory="robots", robots="*.urdf\narm.urdf.xacro l1:=0.5", samples="1")
    assert done.returncode == 2
    assert "::error file=robots/cart.urdf,line=7,title=pinscrew%3A zero-axis::" in done.stderr
    (result,) = job.results("verify.sarif")
    place = result["locations"][0]["physicalLocation"]
    assert place == {
        "artifactLocation": {"uri": "robots/cart.urdf", "uriBaseId": "%SRCROOT%"},
        "region": {"startLine": 7},
    }
    locks = job.run("Check locks")
    assert locks.returncode == 1
    assert "::error file=robots/arm.urdf.xacro,line=12,title=pinscrew%3A moved::" in locks.stderr
    assert [one["ruleId"] for one in job.results("lock.sarif")].count("moved") >= 1
    headings = [line for line in job.summary.read_text().splitlines() if line.startswith("### ")]
    assert headings[-1] == "### pinscrew lock: 0 of 2 mechanisms are those of their locks"
    assert broken.is_dir()


HOSTILE = '$(touch hacked) `touch hacked`; touch hacked && "; touch hacked; " | touch hacked'


def test_inputs_are_no_commands(repository: Path, job: Job) -> None:
    done = job.run("Verify", robots=HOSTILE, options=f"--seed 1 {HOSTILE}", samples=f"1 {HOSTILE}")
    assert done.returncode == 2
    assert not list(repository.rglob("hacked"))


def test_a_repository_without_robots(repository: Path, job: Job) -> None:
    subprocess.run(["git", "rm", "-q", "-r", "--cached", "robots"], check=True)
    done = job.run("Verify")
    assert done.returncode == 2
    assert done.stdout.startswith("::error::pinscrew found no .urdf and no .urdf.xacro")
    assert repository.is_dir()


@pytest.mark.slow
def test_installing() -> None:
    """As on GitHub, with all that pinscrew needs; it lies in an environment of its own."""
    with tempfile.TemporaryDirectory() as folder:  # pytest would keep its hundreds of megabytes
        output = Path(folder, "output")
        environment = {**os.environ, "RUNNER_TEMP": folder, "GITHUB_OUTPUT": str(output)}
        environment |= {"PYTHON": sys.executable, "SOURCE": str(ROOT)}
        script = ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail", "-c", STEPS["Install pinscrew"]["run"]]
        done = subprocess.run(script, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        (line,) = output.read_text().splitlines()
        assert Path(line.removeprefix("reports=")).is_dir()
        words = [Path(folder, "pinscrew", "bin", "pinscrew"), "verify", "scara", "--samples", "1"]
        assert subprocess.run(words, cwd=folder, capture_output=True).returncode == 0


def test_when_locks_are_checked() -> None:
    """Even if engines disagree, but not if there is no pinscrew, or nobody asked."""
    words = "!cancelled() && steps.install.outcome == 'success' && inputs.lock-check != 'false'"
    assert STEPS["Check locks"]["if"] == f"${{{{ {words} }}}}"
