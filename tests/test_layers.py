"""The floors of the house: imports run downwards only, in whatever way, and each outside package has its one place."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from layering import (
    FLOORS,
    MODULES,
    SOURCE,
    circles,
    floor,
    graph,
    imports,
    kinematics_used,
    reachable,
    unit,
    unwanted,
    violations,
)

LONGEST = 300
LONG: dict[str, str] = {}
"""Modules with more lines, and why they are not split."""

# ------------------------------------------------------------------------------------------------ layers


def test_every_module_has_a_layer() -> None:
    assert [module for module in MODULES if floor(module) is None] == []
    assert {name for rooms in FLOORS for name in rooms} == {unit(module) for module in MODULES}


def test_the_house_stays_small() -> None:
    assert len(FLOORS) <= 13
    assert len({unit(module) for module in MODULES}) <= 24


def test_the_page_shows_the_floors() -> None:
    page = (SOURCE.parent / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d+) \| ([^|]+) \|", page, re.MULTILINE)
    shown = {
        int(number): {"" if name == "pinscrew" else name for name in re.findall(r"`(.+?)`", names)}
        for number, names in rows
    }
    assert shown == dict(enumerate(FLOORS))


@pytest.mark.parametrize("module", MODULES)
def test_imports_run_downwards(module: str) -> None:
    assert violations(module, MODULES[module]) == []


PINOCCHIOS = "that is for engines.pinocchio engines.pinocchio_model"

BAD = {
    "upwards": ("lie.so3", "from pinscrew.robot.robot import Robot", "floor 1 from floor 2"),
    "in a function": ("lie.screw", "def f():\n    import pinscrew.engines.poe", "floor 1 from floor 3"),
    "a module as a name": ("robot.robot", "from pinscrew.engines import poe", "floor 2 from floor 3"),
    "several names": ("description.urdf", "from pinscrew import ground, robot", "floor 1 from floor 2"),
    "by name": ("robot.robot", "import_module('pinscrew.view.notebook')", "floor 2 from floor 9"),
    "in a table": ("robot.robot", "TABLE = {'html': 'pinscrew.view.notebook'}", "floor 2 from floor 9"),
    "beside": ("lie.so3", "from pinscrew.description.model import Joint", "floor 1 from floor 1"),
    "the package": ("engines.poe", "import pinscrew as ps", "floor 3 from floor 10"),
    "the package's names": ("verification.run", "from pinscrew import PoE", "floor 5 from floor 10"),
    "the command line": ("verification.formats", "from pinscrew.cli.output import console", "floor 5 from floor 11"),
    "relative": ("lie.so3", "from . import se3", "write the whole name"),
    "relative, up": ("lie.so3", "from ..robot import Robot", "write the whole name"),
    "nothing": ("cli.fk", "import pinscrew.nothing", "there is no such module, or it has no floor"),
    "nothing, by name": ("cli.fk", "__import__('pinscrew.nothing')", "there is no such module, or it has no floor"),
    "at once": ("", "from pinscrew.robot.loading import load", "the package loads nothing at once"),
    "pinocchio": ("engines.poe", "import pinocchio as pin", PINOCCHIOS),
    "a part of pinocchio": (
        "robot.robot",
        "from pinocchio.utils import zero",
        PINOCCHIOS,
    ),
    "yourdfpy": ("robot.robot", "import yourdfpy", "that is for description"),
    "xacro": ("description.expand", "import xacro", "that is for description._xacro_worker"),
    "xacro by name": (
        "description.expand",
        "importlib.import_module('xacro')",
        "that is for description._xacro_worker",
    ),
    "click": ("verification.formats", "def f():\n    import click", "that is for cli"),
    "a prefix": ("click_things", "import rich", "that is for cli"),
    "scipy": ("lie.so3", "import scipy.linalg", "that is for workspace"),
}


@pytest.mark.parametrize(("module", "source", "words"), BAD.values(), ids=BAD)
def test_the_checker_sees(module: str, source: str, words: str) -> None:
    (found,) = violations(module, source)
    assert found.startswith(f"{module}:{len(source.splitlines())} imports ")
    assert found.endswith(f": {words}")


def test_the_checker_sees_imports_for_types() -> None:
    source = "if TYPE_CHECKING:\n    from pinscrew.engines.base import Engine"
    (found,) = violations("robot.mechanism", source)
    assert found == "robot.mechanism:2 imports pinscrew.engines.base for types: floor 2 from floor 3"


@pytest.mark.parametrize(
    ("module", "source"),
    [
        (
            "cli.fk",
            "import numpy.linalg\nimport json\nimport pinscrew as ps\nfrom pinscrew.lie import se3\nimport rich",
        ),
        ("engines.pinocchio", "import pinocchio.utils\nfrom pinscrew.engines.base import Engine"),
        ("lie.se3", "from pinscrew.lie import so3\nfrom pinscrew.ground.typing import KINDS"),
        (
            "",
            "def f():\n    import pinscrew.robot.robot\nif TYPE_CHECKING:\n    from pinscrew.robot.loading import load",
        ),
    ],
)
def test_the_checker_accepts(module: str, source: str) -> None:
    assert violations(module, source) == []


def test_no_circles() -> None:
    """No module needs, in any way, one that needs it."""
    assert circles(graph(MODULES)) == []


LOOPS = {
    "at once": "from pinscrew.a import x",
    "in a function": "def f():\n    from pinscrew import a",
    "for types": "if TYPE_CHECKING:\n    import pinscrew.a",
    "by name": "import importlib\ndef f():\n    return importlib.import_module('pinscrew.a')",
    "in a table": "_HOMES = {'a': 'pinscrew.a'}",
}


@pytest.mark.parametrize("source", LOOPS.values(), ids=LOOPS)
def test_a_circle_is_seen(source: str) -> None:
    loop = {"a": "import pinscrew.b", "b": "from pinscrew import c", "c": source, "d": "import pinscrew.a"}
    assert circles(graph(loop)) == [{"a", "b", "c"}]
    assert circles(graph({**loop, "b": ""})) == []


def test_how_a_module_is_imported() -> None:
    source = (
        "import pinscrew.a\nif TYPE_CHECKING:\n    import pinscrew.b\ndef f():\n    import pinscrew.c\n'pinscrew.d'"
    )
    found = {each.target[-1]: each.how for each in imports(source, dict.fromkeys("abcd", ""))}
    assert found == {"a": "at once", "b": "for types", "c": "later", "d": "by name"}


# ------------------------------------------------------------------------------ independence of the engines


def test_engines_do_not_know_each_other() -> None:
    assert "pinscrew.engines.poe" not in reachable("engines.pinocchio")
    assert not {"pinscrew.engines.pinocchio", "pinocchio"} & reachable("engines.poe")
    assert "pinocchio" in reachable("engines.pinocchio"), "the search sees what there is"


def test_pinocchio_does_not_use_our_kinematics() -> None:
    assert kinematics_used(MODULES["engines.pinocchio"]) == set()
    assert {"twists", "homes"} <= kinematics_used(MODULES["engines.poe"])
    assert kinematics_used("robot.home(); m.twists.shape[1]; m.twists[0]") == {"home", "twists"}
    assert not any(one.target.startswith("pinscrew.lie") for one in imports(MODULES["engines.pinocchio"]))


# ------------------------------------------------------------------------------------------------- style


@pytest.mark.parametrize("module", MODULES)
def test_modules_are_short(module: str) -> None:
    lines = MODULES[module].count("\n")
    assert lines <= LONGEST or module in LONG, f"{lines} lines: split it, or say in LONG why not"


@pytest.mark.parametrize("module", MODULES)
def test_no_prints_asserts_or_bare_excepts(module: str) -> None:
    assert unwanted(MODULES[module]) == []


def test_unwanted_is_seen() -> None:
    source = "print(1)\nassert x\ntry:\n    f.print()\nexcept:\n    pass\n"
    assert sorted(unwanted(source)) == ["1: print", "2: assert", "5: except"]


# ------------------------------------------------------------------------------------------ what is loaded


def python(code: str) -> str:
    """What a program prints in a fresh process."""
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_importing_pinscrew_is_light() -> None:
    heavy = "pinocchio yourdfpy xacro trimesh meshcat sympy matplotlib click rich scipy numpy"
    loaded = python("import pinscrew, sys; print(*{name.split('.')[0] for name in sys.modules})").split()
    assert "pinscrew" in loaded
    assert not set(heavy.split()) & set(loaded)


def test_help_is_light() -> None:
    """Showing help loads neither parsers nor engines."""
    code = "import sys; from pinscrew.cli import command as run; run(['fk', '-h'], standalone_mode=False)"
    code += "; print(*sys.modules)"
    loaded = {name.split(".")[0] for name in python(code).split()}
    assert not {"pinocchio", "yourdfpy", "trimesh", "numpy", "rich"} & loaded


def test_without_pinocchio() -> None:
    """Lie groups, screws, loading and the product of exponentials need none; the other engine says what it lacks."""
    code = """
import sys
sys.modules["pinocchio"] = None
import numpy as np
import pinscrew as ps
robot = ps.load("scara", l1=0.5)
T = ps.PoE(robot).fk([0.1, 0.2, 0.3])
S, q = robot.screws(), [0.1, 0.2, 0.3]
product = np.linalg.multi_dot([*(ps.lie.se3.exp(S[:, i] * q[i]) for i in range(3)), robot.home()])
print(abs(product - T).max() < 1e-15, ps.Screw.from_twist(S[:, 1]).pitch == 0.0)
try:
    ps.Pinocchio
except ImportError as error:
    print(error.name)
"""
    assert python(code).split() == ["True", "True", "pinocchio"]
