"""The code that is written compiles, runs, and agrees with both engines."""

import ctypes
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pinscrew as ps
from pinscrew.derivation.code import LANGUAGES, code
from pinscrew.ground.errors import InputError

ROBOTS = [
    ("spherical_rrp", None),
    ("lead_screw", None),
    ("gear_pair", None),
    ("drone", "obstacle"),
    ("ur5_robot", "tool0"),
]


def derivation(robot: str, tip: str | None) -> Any:
    return ps.derive(ps.load(robot), tip, snap=2e-3)


def answers(d: Any, kind: str) -> tuple[Any, Any, Any]:
    """Coordinates, and poses and Jacobians of both engines."""
    q = np.random.default_rng(1).uniform(-1, 1, (10, d.robot.nq))
    engines = ps.PoE(d.robot), ps.Pinocchio(d.robot)
    return q, [e.fk(q, d.tip) for e in engines], [e.jacobian(q, d.tip, kind) for e in engines]


def tolerance(d: Any) -> float:
    return 1e-12 + 4 * sum(s.change for s in d.snapped)


@pytest.mark.parametrize(("robot", "tip"), ROBOTS)
@pytest.mark.parametrize("kind", ["spatial", "body", "hybrid"])
def test_python(robot: str, tip: str | None, kind: str) -> None:
    d = derivation(robot, tip)
    module: dict[str, Any] = {}
    exec(code(d, "python", kind), module)  # noqa: S102 (our own)
    q, poses, jacobians = answers(d, kind)
    for i, row in enumerate(q):
        for pose, J in zip(poses, jacobians, strict=True):
            assert abs(np.array(module["fk"](row)) - pose[i]).max() <= tolerance(d)
            assert abs(np.array(module["jacobian"](row)) - J[i]).max() <= tolerance(d)


@pytest.mark.parametrize(("robot", "tip"), ROBOTS)
def test_c(robot: str, tip: str | None, tmp_path: Path) -> None:
    d = derivation(robot, tip)
    source, library = tmp_path / "arm.c", tmp_path / "arm.so"
    source.write_text(code(d, "c", "body"), encoding="utf-8")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1", "-shared", "-fPIC"]
    done = subprocess.run(["gcc", *flags, str(source), "-o", str(library), "-lm"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    arm = ctypes.CDLL(str(library))
    lengths = (ctypes.c_double * max(1, len(d.lengths)))(*(float(v) for v in d.lengths.values()))
    q, poses, jacobians = answers(d, "body")
    for i, row in enumerate(q):
        T, J = (ctypes.c_double * 16)(), (ctypes.c_double * (6 * d.robot.nv))()
        values = (ctypes.c_double * len(row))(*row)
        arm.fk(values, lengths, T)
        arm.jacobian(values, lengths, J)
        for pose, jacobian in zip(poses, jacobians, strict=True):
            assert abs(np.array(T).reshape(4, 4) - pose[i]).max() <= tolerance(d)
            assert abs(np.array(J).reshape(6, -1) - jacobian[i]).max() <= tolerance(d)


def test_other_lengths() -> None:
    d = derivation("scara_rrp", None)
    module: dict[str, Any] = {}
    exec(code(d, "python", "body"), module)  # noqa: S102
    robot = ps.load("scara_rrp", l1=0.9, l2=0.1)
    q = [0.3, -0.4, 0.2]
    assert abs(np.array(module["fk"](q, l1=0.9, l2=0.1)) - ps.PoE(robot).fk(q)).max() < 1e-14


@pytest.mark.parametrize("language", LANGUAGES)
def test_header(language: str) -> None:
    text = code(derivation("spherical_rrp", None), language)
    for part in ("spherical_rrp", "frame tool in frame base", "joint3 (m)", "vx, vy, vz, wx, wy, wz", "L0 = 0.5"):
        assert part in text
    assert "1-" not in text.splitlines()[-1]


def test_lynch_park_order() -> None:
    d = ps.derive(ps.load("two_joint"), convention="lynch-park")
    module: dict[str, Any] = {}
    text = code(d, "python", "body")
    exec(text, module)  # noqa: S102
    assert "rows wx, wy, wz, vx, vy, vz" in text
    J = ps.PoE(d.robot).jacobian([0.1, 0.2], None, "body")
    assert abs(np.array(module["jacobian"]([0.1, 0.2])) - np.roll(J, 3, axis=0)).max() < 1e-15


def test_unknown_language() -> None:
    with pytest.raises(InputError, match="fortran"):
        code(derivation("two_joint", None), "fortran")


def test_python_needs_nothing(tmp_path: Path) -> None:
    file = tmp_path / "arm.py"
    file.write_text(code(derivation("two_joint", None), "python"), encoding="utf-8")
    done = subprocess.run([sys.executable, "-I", "-W", "error", str(file)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
