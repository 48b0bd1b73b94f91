"""``pinscrew derive``: what it prints, writes and refuses."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from pinscrew.cli import command
from pinscrew.derivation import proof
from pinscrew.ground.errors import PinscrewError


def run(*arguments: str) -> Result:
    return CliRunner().invoke(command, ["derive", *arguments])


def test_markdown_to_standard_output() -> None:
    done = run("two_joint", "--samples", "5", "--part", "d")
    assert done.exit_code == 0
    assert done.stdout.startswith(r"# Closed-form kinematics of two\_joint")
    assert "(d) Pose" in done.stdout
    assert "(e)" not in done.stdout


@pytest.mark.parametrize("form", ["markdown", "latex", "html", "notebook"])
def test_formats_to_a_file(form: str, tmp_path: Path) -> None:
    file = tmp_path / "out"
    done = run("one_joint", "l1:=0.7", "--samples", "3", "--format", form, "-o", str(file))
    assert done.exit_code == 0
    assert done.stdout == ""
    assert file.stat().st_size > 2000
    assert list(tmp_path.iterdir()) == [file]


def test_code() -> None:
    done = run("one_joint", "--code", "python", "--kind", "hybrid", "--samples", "3")
    assert done.exit_code == 0
    assert "hybrid Jacobian" in done.stdout


def test_symbols_by_name() -> None:
    done = run("planar_2r", "--symbol", "a=1", "--samples", "3", "--part", "a")
    assert done.exit_code == 0
    assert "$a$" in done.stdout


def test_errata() -> None:
    done = run("stanford", "--errata")
    assert done.exit_code == 0
    assert "question 8" in done.stdout


def test_a_failed_proof_is_status_1(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proof, "TOLERANCE", 0.0)
    done = run("one_joint", "--samples", "3")
    assert done.exit_code == 1
    assert "disagree" in done.stderr


BAD: list[tuple[list[str], Any]] = [
    (["one_joint", "--tip", "hand"], "unknown-frame"),
    (["one_joint", "--part", "z"], "derive-part"),
    (["planar_2r", "--symbol", "c1=1"], "symbol-collision"),
    (["planar_2r", "--symbol", "a=7"], "derive-option"),
    (["gear_pair", "--errata"], "no-errata"),
    (["one_joint", "-o", "/nowhere/out"], "unwritable"),
]


@pytest.mark.parametrize(("arguments", "code"), BAD, ids=str)
def test_bad_input(arguments: list[str], code: str) -> None:
    done = run(*arguments)
    assert isinstance(done.exception, PinscrewError)
    assert done.exception.code == code


def test_without_sympy() -> None:
    """One clear error; and nothing else of pinscrew needs it."""
    program = """
import sys
sys.modules["sympy"] = None
import importlib.util
found = importlib.util.find_spec
importlib.util.find_spec = lambda name, *more: None if name == "sympy" else found(name, *more)
import pinscrew, pinscrew.cli
try:
    pinscrew.derive
except pinscrew.PinscrewError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout == 'sympy is not installed; install it with: pip install "pinscrew[derive]"\n', done.stderr


def test_import_is_light() -> None:
    program = "import pinscrew.cli, sys; sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0


@pytest.mark.parametrize("value", ["a", "=1", "a=b"])
def test_bad_symbol(value: str) -> None:
    assert run("planar_2r", "--symbol", value).exit_code == 2
