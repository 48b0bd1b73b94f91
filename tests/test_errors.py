"""Errors: their parts, their codes, the page about them, and that they survive a trip between processes."""

import ast
import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from pinscrew.ground import error_codes, errors

ROOT = Path(__file__).resolve().parents[1]
SOURCES = sorted((ROOT / "src" / "pinscrew").rglob("*.py"))

EXAMPLES = [
    errors.PinscrewError("shape", "q is long", where="arm", remedy="shorten it"),
    errors.DescriptionError("cycle", "is round", file="a.urdf", line=3, element="joint 'j'", remedy="cut it"),
    errors.XacroError("xacro", "fails", file=Path("a.xacro")),
    errors.UnsupportedError("planar-axis", "not z", file="a.urdf"),
    errors.InputError("seed", "seed=-1"),
    errors.UnknownNameError("unknown-frame", "frame", "tol", ("base", "tool"), where="arm"),
    errors.AmbiguousTipError("hand", ("thumb", "index")),
    errors.MissingExtraError("numba is not installed", "fast"),
    errors.ViewError("server", "has stopped"),
    errors.EngineError("pinocchio-refuses", "no", where="a.urdf"),
]


def codes_in_use() -> Iterator[tuple[str, str, str]]:
    """The callee, code and file of every call that makes an error or a warning."""
    makers = {name for name in vars(errors) if name.endswith("Error")} | {"error", "warn", "PinscrewWarning", "whole"}
    makers = makers - {"MissingExtraError", "AmbiguousTipError"} | {
        "_RefusedError"
    }  # these two have a code of their own
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
                callee = getattr(node.func, "id", getattr(node.func, "attr", ""))
                if callee in makers and isinstance(node.args[0].value, str):
                    yield callee, node.args[0].value, path.name


def test_every_code_in_use_is_listed() -> None:
    for callee, code, file in codes_in_use():
        listed = error_codes.WARNINGS if callee in {"warn", "PinscrewWarning"} else error_codes.ERRORS
        assert code in listed, f"{code} in {file}"


def test_every_listed_code_is_in_use() -> None:
    texts = [path.read_text(encoding="utf-8") for path in SOURCES if path.name != "error_codes.py"]
    for code in error_codes.ERRORS | error_codes.WARNINGS:
        assert any(f'"{code}"' in text for text in texts), code


def test_the_page_is_up_to_date() -> None:
    script = ROOT / "scripts" / "errors_page.py"
    done = subprocess.run([sys.executable, script, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("error", EXAMPLES, ids=lambda error: type(error).__name__)
def test_pickling_keeps_everything(error: errors.PinscrewError) -> None:
    copy = pickle.loads(pickle.dumps(error))  # noqa: S301 (our own bytes)
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)


def test_pickling_keeps_warnings() -> None:
    warning = errors.PinscrewWarning("axis-normalised", "joint 'j': the axis is long", file="a.urdf", line=3)
    copy = pickle.loads(pickle.dumps(warning))  # noqa: S301 (our own bytes)
    assert (type(copy), str(copy), vars(copy)) == (errors.PinscrewWarning, str(warning), vars(warning))
    assert str(warning) == "a.urdf:3: joint 'j': the axis is long"


def test_messages_say_where_what_and_what_to_do() -> None:
    assert str(EXAMPLES[0]) == "arm: q is long; shorten it"
    assert str(EXAMPLES[1]) == "a.urdf:3: joint 'j': is round; cut it"
    assert str(EXAMPLES[4]) == "seed=-1"
    assert str(EXAMPLES[5]) == "arm: there is no frame 'tol'; known are: base, tool"
    assert str(EXAMPLES[6]) == "hand: 2 leaves and no default tip; name a frame; the leaves are: thumb, index"


def test_long_lists_of_names_are_cut() -> None:
    error = errors.UnknownNameError("unknown-frame", "frame", "x", tuple(f"link{i}" for i in range(100)))
    assert str(error).endswith("link39, … (100 in all)")
    assert len(error.known) == 100


def test_one_base_class() -> None:
    assert all(issubclass(type(error), errors.PinscrewError) for error in EXAMPLES)
    assert isinstance(EXAMPLES[4], ValueError)
    assert isinstance(EXAMPLES[5], LookupError)
    assert isinstance(EXAMPLES[7], ImportError)
