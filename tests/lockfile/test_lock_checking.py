"""Which edits of a robot's file pass the check of its lock, and which don't."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np
import pytest

import pinscrew as ps
import urdfs
from pinscrew import lockfile
from pinscrew.description import catalogue
from pinscrew.ground.errors import DescriptionError
from pinscrew.lockfile import places

ARM: Final = urdfs.robot(
    urdfs.joint("j1", "revolute", "base", "l1", xyz="0.1 -0.4 0.2", rpy="0.7 -1.1 2.9", axis="0.6 0 -0.8"),
    urdfs.joint("mount", "fixed", "l1", "l2", xyz="0.2 0 0.1", rpy="3 1.5 -2"),
    urdfs.joint("j2", "prismatic", "l2", "l3", xyz="0 0.3 0", rpy="-2 0.4 0.3", axis="0 -0.28 0.96"),
    urdfs.joint("j3", "revolute", "l3", "l4", xyz="0.3 0 0.2", rpy="0 0 -3", axis="0 -1 0", mimic=("j1", 0.5, 0.2)),
    urdfs.joint("j4", "continuous", "l4", "tool", xyz="0.1 0.2 0.3", axis="0 0 1"),
    urdfs.joint("eye", "fixed", "l4", "camera", xyz="0 0 0.05", rpy="0 0.1 0"),
    links="base l1 l2 l3 l4 tool camera",
)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """The arm, with its lock beside it."""
    path = tmp_path / "arm.urdf"
    path.write_text(ARM, encoding="utf-8")
    write(path)
    return path


def write(path: Path, **options: object) -> Path:
    lock = places.beside(str(path))
    lock.write_text(lockfile.text(ps.load(path, **options), lock), encoding="utf-8")  # type: ignore[arg-type]
    return lock


def checked(path: Path, text: str) -> lockfile.LockCheck:
    assert text != path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    return lockfile.check(f"{path}.lock")


def edit(old: str, new: str) -> Callable[[], str]:
    assert old in ARM
    return lambda: ARM.replace(old, new, 1)


def swapped() -> str:
    """The names of two joints exchanged."""
    return ARM.replace('joint name="j1"', 'joint name="x"').replace('name="j4"', 'name="j1"').replace('"x"', '"j4"')


VISUAL: Final = '<visual><geometry><sphere radius="1"/></geometry></visual>'
FORMATTING: Final = {
    "a remark": edit("><", ">\n<!-- a remark -->\n<"),
    "digits": edit("0.3 0 0.2", "0.30 0.0 2e-1"),
    "the last bit": edit("0.1 -0.4 0.2", "0.1 -0.4 0.20000000000000004"),
    "a visual": edit('<link name="l1"/>', f'<link name="l1">{VISUAL}</link>'),
    "a longer axis": edit("0.6 0 -0.8", "0.60000000003 0 -0.80000000004"),
}


@pytest.mark.parametrize("text", FORMATTING.values(), ids=FORMATTING)
def test_formatting_passes(text: Callable[[], str], file: Path) -> None:
    found = checked(file, text())
    assert found.same
    assert found.changes is None, "the fingerprint is enough"


def turned_frame() -> str:
    """The frame of l1 turned and shifted along its axis, with all that is fixed to it placed anew."""
    joint = urdfs.load(ARM).description.joints
    shift = np.eye(4)
    shift[:3, :3] = ps.lie.so3.exp(0.7 * joint[0].axis)
    shift[:3, 3] = 0.25 * joint[0].axis
    xyz, rpy = _origin(joint[0].T_parent_joint @ shift)
    axis = " ".join(repr(x) for x in (shift[:3, :3].T @ joint[0].axis).tolist())
    below = _origin(np.linalg.inv(shift) @ joint[1].T_parent_joint)
    text = ARM.replace('xyz="0.1 -0.4 0.2" rpy="0.7 -1.1 2.9"', f'xyz="{xyz}" rpy="{rpy}"').replace("0.6 0 -0.8", axis)
    return text.replace('xyz="0.2 0 0.1" rpy="3 1.5 -2"', f'xyz="{below[0]}" rpy="{below[1]}"')


def _origin(T: np.ndarray) -> tuple[str, str]:
    """A pose as ``xyz`` and ``rpy``, R = Rz(y) Ry(p) Rx(r)."""
    R = T[:3, :3]
    angles = (math.atan2(R[2, 1], R[2, 2]), math.asin(-R[2, 0]), math.atan2(R[1, 0], R[0, 0]))
    return tuple(" ".join(repr(float(x)) for x in values) for values in (T[:3, 3], angles))  # type: ignore[return-value]


PLACED_ANEW: Final = {
    "an intermediate frame": turned_frame,
    "velocity": edit('effort="1" velocity="1"', 'effort="1" velocity="2"'),
    "effort": edit('effort="1" velocity="1"', 'effort="2" velocity="1"'),
    "the robot's name": edit('name="small"', 'name="other"'),
    "an intermediate link's name": lambda: ARM.replace('"l2"', '"flange"'),
}


@pytest.mark.parametrize("text", PLACED_ANEW.values(), ids=PLACED_ANEW)
def test_what_the_motion_does_not_depend_on_passes_with_a_note(text: Callable[[], str], file: Path) -> None:
    found = checked(file, text())
    assert found.same
    assert found.changes is not None
    assert found.changes.notes


MOVED: Final = {
    "axis flipped": edit("0.6 0 -0.8", "-0.6 0 0.8"),
    "axis turned": edit("0.6 0 -0.8", "0.600001 0 -0.8"),
    "direction turned": edit("0 -0.28 0.96", "0 -0.280001 0.96"),
    "origin by a micrometre": edit("0.1 -0.4 0.2", "0.1 -0.400001 0.2"),
    "origin turned": edit("0.7 -1.1 2.9", "0.7 -1.1 2.900001"),
    "origin behind a mimic": edit("0.1 0.2 0.3", "0.1 0.200000003 0.3"),
    "a leaf": edit("0 0 0.05", "0 0 0.050001"),
    "a leaf turned": edit("0 0.1 0", "0 0.100001 0"),
    "joints swapped": swapped,
    "type": edit('"continuous"', '"fixed"'),
    "limits": edit('lower="-2.0"', 'lower="-2.001"'),
    "no limits": edit('"j1" type="revolute"', '"j1" type="continuous"'),
    "multiplier": edit('multiplier="0.5"', 'multiplier="0.501"'),
    "offset": edit('offset="0.2"', 'offset="0.201"'),
    "no mimic": edit('<mimic joint="j1" multiplier="0.5" offset="0.2"/>', ""),
    "a joint more": edit("</robot>", f'<link name="new"/>{urdfs.joint("n", "revolute", "tool", "new")}</robot>'),
    "parent": edit('<parent link="l4"/><child link="camera"/>', '<parent link="l3"/><child link="camera"/>'),
}


@pytest.mark.parametrize("text", MOVED.values(), ids=MOVED)
def test_what_moves_fails(text: Callable[[], str], file: Path) -> None:
    found = checked(file, text())
    assert not found.same
    assert found.changes is not None
    assert all(change.words for change in found.changes.changes)


def test_the_direction_is_from_the_lock_to_the_file(file: Path) -> None:
    found = checked(file, ARM.replace('lower="-2.0"', 'lower="-1.0"', 1))
    assert found.changes is not None
    (change,) = found.changes.changes
    assert (change.kind, change.joint, change.line) == ("limits", "j1", 1)
    assert "narrowed" in change.words


# ------------------------------------------------------------------------------------- rounding never fails


def forgetful(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fingerprints are never equal, as on a machine that rounds ties the other way."""
    monkeypatch.setattr("pinscrew.lockfile.checking.fingerprint", lambda _: "sha256:")


# Three of the catalogue; small robots of every kind follow, and all public ones in a slow sweep.
@pytest.mark.parametrize("name", ["spherical_rrp", "anthropomorphic_rrr", "lead_screw"])
def test_rounding_passes(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    forgetful(monkeypatch)
    entry = catalogue.find(name)
    file = tmp_path / entry.file.name
    file.write_bytes(entry.file.read_bytes())
    found = lockfile.check(write(file))
    assert found.changes is not None
    assert (found.same, found.changes.notes) == (True, ())


@pytest.mark.filterwarnings("ignore:.*lengths are in metres")
@pytest.mark.parametrize("name", urdfs.ROBOTS)
@pytest.mark.parametrize("scale", [1.0, 1e-4, 1e6])
def test_rounding_passes_at_any_size(name: str, scale: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    forgetful(monkeypatch)
    file = tmp_path / "arm.urdf"
    text = urdfs.ROBOTS[name]
    if scale != 1.0:
        text = scaled(text, scale)
    file.write_text(text)
    found = lockfile.check(write(file))
    assert found.changes is not None
    assert (found.same, found.changes.notes) == (True, ())


def scaled(text: str, scale: float) -> str:
    """All origins multiplied."""
    parts = text.split('<origin xyz="')
    for i, part in enumerate(parts[1:], 1):
        xyz, rest = part.split('"', 1)
        parts[i] = " ".join(repr(float(x) * scale / 3.0) for x in xyz.split()) + '"' + rest
    return '<origin xyz="'.join(parts)


# --------------------------------------------------------------------------------------- what a lock is of


def test_arguments_base_and_tip_are_the_locks(tmp_path: Path) -> None:
    file = tmp_path / "scara.urdf.xacro"
    file.write_bytes(catalogue.find("scara").file.read_bytes())
    lock = write(file, l1=0.5, floating_base=True, tip="link2")
    found = lockfile.check(lock)
    assert found.changes is None
    assert (dict(found.robot.description.arguments), found.robot.tip) == ({"l1": "0.5"}, "link2")
    assert found.robot.floating_base
    lock.write_text(lock.read_text().replace('"l1": "0.5"', '"l1": "0.6"'))
    assert not lockfile.check(lock).same, "an argument edited in the lock makes another robot"
    lock.write_text(lock.read_text().replace('"l1"', '"l9"'))
    with pytest.raises(DescriptionError) as caught:
        lockfile.check(lock)
    assert caught.value.code == "xacro-argument"


def test_locks_elsewhere(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The source is relative to the lock, whatever the working directory."""
    folder = tmp_path / "locks" / "deep"
    folder.mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    lock = folder / "arm.urdf.lock"
    for source in (file, Path("arm.urdf")):
        lock.write_text(lockfile.text(ps.load(source), lock))
        assert '"source": "../../arm.urdf"' in lock.read_text()
        assert lockfile.check(lock, allow_outside=True).same
        assert lockfile.check(Path("locks/deep/arm.urdf.lock"), allow_outside=True).same
        with pytest.raises(DescriptionError, match="is outside its folder") as caught:
            lockfile.check(lock)
        assert caught.value.code == "lock-outside"


def test_without_the_source(file: Path) -> None:
    file.unlink()
    with pytest.raises(DescriptionError, match=r"there is no 'arm.urdf', from which it was made") as caught:
        lockfile.check(f"{file}.lock")
    assert caught.value.code == "lock-source"


def test_a_source_that_is_broken_now(file: Path) -> None:
    file.write_text(ARM[:-20])
    with pytest.raises(DescriptionError) as caught:
        lockfile.check(f"{file}.lock")
    assert (caught.value.code, caught.value.file) == ("not-xml", str(file))


def test_a_tip_that_is_gone(file: Path) -> None:
    write(file, tip="tool")
    file.write_text(ARM.replace('"tool"', '"hand"'))
    with pytest.raises(ps.PinscrewError, match="no frame 'tool'"):
        lockfile.check(f"{file}.lock")


# ------------------------------------------------------------------------------------------------- places


def test_names_of_locks() -> None:
    assert places.beside("a/arm.urdf") == Path("a/arm.urdf.lock")
    assert places.beside("arm.urdf.xacro") == Path("arm.urdf.xacro.lock")
    assert not places.is_lock("Cargo.lock")
    assert not places.is_lock("urdf.lock")
    with pytest.raises(DescriptionError, match="is no file, and a lock stands beside") as caught:
        places.beside("scara")
    assert caught.value.code == "lock-name"
    with pytest.raises(DescriptionError, match="ends in none of") as caught:
        places.beside(__file__)
    assert caught.value.code == "lock-name"


def test_locks_below(tmp_path: Path) -> None:
    for name in ("b/arm.urdf.lock", "a/x/arm.xacro.lock", "a/arm.urdf.xacro.lock", "a/poetry.lock", "a/arm.urdf"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    for name in (".git/arm.urdf.lock", "a/.venv/lib/arm.urdf.lock"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    found = [path.relative_to(tmp_path).as_posix() for path in places.below(tmp_path)]
    assert found == ["a/arm.urdf.xacro.lock", "a/x/arm.xacro.lock", "b/arm.urdf.lock"]
