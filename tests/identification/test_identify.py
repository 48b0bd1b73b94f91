"""Which convention a matrix is in: foreign conventions are named rightly, and what is wrong is never called unique."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest
from scipy.spatial.transform import Rotation

import pinscrew as ps
from command_line import ok, refused, run
from pinscrew.ground.errors import InputError
from pinscrew.identification.observers import observed
from pinscrew.identification.run import TRIED
from pinscrew.identification.turns import SEQUENCES, from_angles, from_quaternion, to_angles, to_quaternion
from pinscrew.verification.configurations import configurations

ARMS = ["spherical_rrp", "scara", "anthropomorphic", "ur5_robot", "panda"]
KINDS = {"spatial": "WORLD", "body": "LOCAL", "hybrid": "LOCAL_WORLD_ALIGNED"}
TIPS = {"ur5_robot": "tool0", "panda": "panda_hand"}


def places(robot: ps.Robot, count: int = 2, seed: int = 0) -> np.ndarray[Any, Any]:
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, robot.nq))


def turning(robot: ps.Robot) -> np.ndarray[Any, Any]:
    return np.array([unit == "rad" for unit in robot.velocity_units])


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("kind", KINDS)
def test_pinocchio_s_own(name: str, kind: str) -> None:
    """By Pinocchio itself: its model, its enum, no code of ours. Its q is ours, as no joint here is continuous."""
    robot = ps.load(name)
    frame = TIPS.get(name, "tool")
    model = pinocchio.buildModelFromXML(robot.description.text, mimic=True)
    data, q = model.createData(), places(robot)
    frame_id, which = model.getFrameId(frame), getattr(pinocchio, KINDS[kind])
    J = np.array([pinocchio.computeFrameJacobian(model, data, each, frame_id, which).copy() for each in q])
    found = ps.identify(robot, q, J)
    assert found.verdict == "unique", str(found)
    candidate = found.candidates[0]
    names = {candidate.words, *candidate.aliases}
    assert f"the {kind} Jacobian of {frame} (Pinocchio {KINDS[kind]})" in names
    assert np.allclose(found.convert(J), J, atol=1e-15)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("seed", range(4))
def test_all_axes_at_once(name: str, seed: int) -> None:
    """(ω, v), millimetres or centimetres, per degree, transposed, permuted and flipped columns."""
    robot, rng = ps.load(name), np.random.default_rng(seed)
    frame, kind = TIPS.get(name, "tool"), ["spatial", "body", "hybrid"][seed % 3]
    q = places(robot, 2, seed)
    ours = ps.Pinocchio(robot).jacobian(q, frame, kind)
    moved = [i for i in range(robot.nv) if abs(ours[:, :, i]).max() > 0.0]
    order, signs = rng.permutation(moved), rng.choice([-1.0, 1.0], len(moved))
    unit, degrees, turned, angular = rng.choice([1.0, 0.001, 0.01]), rng.random() < 0.5, rng.random() < 0.5, seed % 2
    given = ours[:, :, order] * signs
    given = np.concatenate([given[:, :3] / unit, given[:, 3:]], axis=1)
    given = given * np.where(turning(robot)[order] & degrees, np.pi / 180.0, 1.0)
    given = np.concatenate([given[:, 3:], given[:, :3]], axis=1) if angular else given
    given = np.swapaxes(given, 1, 2) if turned else given
    found = ps.identify(robot, q, given)
    assert found.verdict == "unique", str(found)
    assert np.allclose(found.convert(given), ours, atol=1e-12)
    scope: dict[str, Any] = {"np": np, "J": given}
    exec(found.code, scope)  # noqa: S102 (what it is for)
    assert np.allclose(scope["ours"], ours, atol=1e-12)


def test_what_it_says() -> None:
    robot = ps.load("ur5_robot")
    q = places(robot, 1)[0]
    J = ps.Pinocchio(robot).jacobian(q, "tool0", "hybrid")
    foreign = np.concatenate([J[3:], 1000.0 * J[:3]]).T
    found = ps.identify("ur5_robot", q, foreign)
    said = "the hybrid Jacobian of tool0 (Pinocchio LOCAL_WORLD_ALIGNED), rows (ω, v), in mm, transposed"
    assert said in (found.candidates[0].words, *found.candidates[0].aliases)
    fields = found.to_document()["candidates"][0]
    assert (fields["order"], fields["unit"], fields["layout"], fields["kind"]) == ("w,v", 0.001, "transposed", "hybrid")
    assert fields["joints"] == list(robot.velocity_names)
    assert fields["signs"] == [1] * 6


@pytest.mark.parametrize("digits", [4, 6])
def test_printed_digits(digits: int) -> None:
    """Four printed digits are not 1e-6; a digit that is off by two is seen."""
    robot = ps.load("panda")
    q = places(robot, 3)
    J = np.round(ps.Pinocchio(robot).jacobian(q, "panda_hand", "body"), digits)
    found = ps.identify(robot, q, J)
    assert found.verdict == "unique"
    assert "the body Jacobian of panda_hand (Pinocchio LOCAL)" in (
        found.candidates[0].words,
        *found.candidates[0].aliases,
    )
    J[1, 0, 2] += 2.0 * 10.0**-digits
    assert ps.identify(robot, q, J).verdict == "none"


def test_single_precision() -> None:
    robot = ps.load("panda")
    q = places(robot)
    J = ps.Pinocchio(robot).jacobian(q, "panda_hand", "spatial").astype(np.float32)
    assert ps.identify(robot, q, J).verdict == "unique"


@pytest.mark.parametrize("name", ARMS)
def test_what_is_wrong_is_never_unique(name: str) -> None:
    robot, rng = ps.load(name), np.random.default_rng(0)
    frame, q = TIPS.get(name, "tool"), places(robot)
    J = ps.Pinocchio(robot).jacobian(q, frame, "body")
    for _ in range(6):
        wrong = J.copy()
        row, column = rng.integers(6), rng.integers(robot.nv)
        wrong[1, row, column] += rng.choice([1e-6, -0.1])
        assert ps.identify(robot, q, wrong).verdict == "none"
    half = np.concatenate([J[:, :3], np.roll(J[:, 3:], 1, axis=1)], axis=1)
    noise = rng.normal(size=J.shape)
    mixed = np.stack([J[0], ps.Pinocchio(robot).jacobian(q[1], frame, "hybrid")])
    for wrong in (half, noise, 2.0 * J, mixed):
        assert ps.identify(robot, q, wrong).verdict == "none"
    assert ps.identify(robot, np.degrees(q), J).verdict == "none"


def test_another_robot_s() -> None:
    robot = ps.load("ur5_robot")
    q = places(robot)
    other = ps.Pinocchio(ps.load("ur3_robot")).jacobian(q, "tool0", "body")
    assert ps.identify(robot, q, other).verdict == "none"


def test_zero_is_ambiguous_and_more_is_asked_for() -> None:
    """At zero the body and the hybrid Jacobian of a frame that stands as the base are one."""
    robot = ps.load("scara")
    pin = ps.Pinocchio(robot)
    found = ps.identify(robot, np.zeros(3), pin.jacobian(np.zeros(3), "tool", "hybrid"))
    assert found.verdict == "ambiguous"
    assert found.code
    with pytest.raises(InputError) as caught:
        found.convert(np.zeros((6, 3)))
    assert caught.value.code == "not-identified"
    assert found.ask is not None
    again = ps.identify(robot, [np.zeros(3), found.ask], pin.jacobian([np.zeros(3), found.ask], "tool", "hybrid"))
    assert again.verdict == "unique"


@pytest.mark.parametrize("name", ["spherical_rrp", "ur5_robot", "panda"])
def test_twists(name: str) -> None:
    robot, rng = ps.load(name), np.random.default_rng(1)
    frame, q = TIPS.get(name, "tool"), places(robot)
    qd = rng.normal(size=(2, robot.nv))
    for kind in ("spatial", "body", "hybrid"):
        V = ps.Pinocchio(robot).velocity(q, qd, frame, kind)
        foreign = np.concatenate([V[:, 3:], 1000.0 * V[:, :3]], axis=1)
        found = ps.identify(robot, q, qd, foreign)
        assert found.verdict == "unique", str(found)
        assert np.allclose(found.convert(foreign), V, atol=1e-12)
        assert found.candidates[0].writing is not None
        assert (found.candidates[0].writing.order, found.candidates[0].writing.unit) == ("w,v", "mm")
        assert ps.identify(robot, q, qd, foreign + 1e-4 * np.eye(6)[2]).verdict == "none"


# ------------------------------------------------------------------------------------------------- poses


def poses(name: str, count: int = 2) -> tuple[ps.Robot, Any, Any]:
    robot = ps.load(name)
    q = places(robot, count)
    return robot, q, ps.Pinocchio(robot).fk(q, TIPS[name])


FOREIGN = {
    "UR": lambda p, R: np.concatenate([p, R.as_rotvec()], axis=1),
    "KUKA A B C": lambda p, R: np.concatenate([1000.0 * p, R.as_euler("ZYX", degrees=True)], axis=1),
    "Fanuc W P R, Yaskawa": lambda p, R: np.concatenate([1000.0 * p, R.as_euler("xyz", degrees=True)], axis=1),
    "ROS roll pitch yaw": lambda p, R: np.concatenate([p, R.as_euler("xyz")], axis=1),
    "Stäubli Rx Ry Rz": lambda p, R: np.concatenate([1000.0 * p, R.as_euler("XYZ", degrees=True)], axis=1),
    "Kawasaki O A T, Doosan": lambda p, R: np.concatenate([1000.0 * p, R.as_euler("ZYZ", degrees=True)], axis=1),
    "ABB, MuJoCo": lambda p, R: np.concatenate([1000.0 * p, R.as_quat()[:, [3, 0, 1, 2]]], axis=1),
    "ROS, scipy": lambda p, R: np.concatenate([p, -R.as_quat()], axis=1),
}


@pytest.mark.parametrize("name", ["ur5_robot", "panda"])
@pytest.mark.parametrize("vendor", FOREIGN)
def test_poses_of_vendors(name: str, vendor: str) -> None:
    robot, q, T = poses(name)
    given = FOREIGN[vendor](T[:, :3, 3], Rotation.from_matrix(T[:, :3, :3]))
    found = ps.identify(robot, q, given)
    assert found.verdict == "unique", str(found)
    words = [found.candidates[0].words, *found.candidates[0].aliases]
    assert any(f"the pose of {TIPS[name]} in {robot.base}, as " in each and f"({vendor})" in each for each in words)
    assert np.allclose(found.convert(given), T, atol=1e-9)
    given[1, 4] += 1e-4
    assert ps.identify(robot, q, given).verdict == "none"


@pytest.mark.parametrize("form", ["matrix", "inverse", "transposed", "mm", "position last"])
def test_other_poses(form: str) -> None:
    robot, q, T = poses("ur5_robot")
    vector = np.concatenate([Rotation.from_matrix(T[:, :3, :3]).as_quat(), T[:, :3, 3]], axis=1)
    scaled = T.copy()
    scaled[:, :3, 3] *= 1000.0
    given = {"matrix": T, "inverse": np.linalg.inv(T), "transposed": np.swapaxes(T, 1, 2), "mm": scaled}
    found = ps.identify(robot, q, given.get(form, vector))
    assert found.verdict == "unique", str(found)
    # An inverse is the base in the tool as well, which is as good a name.
    meant = np.linalg.inv(T) if form == "inverse" else T
    assert np.allclose(found.convert(given.get(form, vector)), meant, atol=1e-9)


def test_turns_are_scipy_s() -> None:
    angles = np.random.default_rng(0).uniform(-3.0, 3.0, (40, 3))
    locked = np.array([[0.3, b, 0.4] for b in (0.0, np.pi, np.pi / 2, -np.pi / 2)])
    for sequence in (*SEQUENCES, *map(str.upper, SEQUENCES)):
        for given in (angles, locked):
            R = Rotation.from_euler(sequence, given).as_matrix()
            assert np.allclose(from_angles(sequence, given), R, atol=1e-14)
            assert np.allclose(from_angles(sequence, to_angles(sequence, R)), R, atol=1e-14)
    turned = Rotation.from_rotvec(angles)
    assert np.allclose(from_quaternion(turned.as_quat()), turned.as_matrix(), atol=1e-14)
    assert np.allclose(from_quaternion(to_quaternion(angles)), turned.as_matrix(), atol=1e-14)


# ------------------------------------------------------------------------------------------ files, bad input


def test_command(tmp_path: Path) -> None:
    robot = ps.load("scara")
    J = ps.Pinocchio(robot).jacobian([0.3, 0.5, 0.1], "tool", "body")
    table = tmp_path / "J.csv"
    np.savetxt(table, np.concatenate([J[3:], J[:3]]), delimiter=",")
    done = ok("identify", "scara", "-q", "0.3,0.5,0.1", "--matrix", table)
    assert done.out.startswith("the body Jacobian of tool (Pinocchio LOCAL), rows (ω, v)")
    q = places(robot)
    archive = tmp_path / "samples.npz"
    np.savez(archive, q=q, T=ps.Pinocchio(robot).fk(q, "tool"))
    document = json.loads(ok("identify", "scara", "--samples", archive, "--json").out)
    assert (document["schema"], document["verdict"], document["samples"]) == ("pinscrew.identify/1", "unique", 2)
    assert {document["candidates"][0][key] for key in ("quantity", "encoding")} == {"pose", "matrix"}
    np.savez(archive, q=q, J=np.random.default_rng(0).normal(size=(2, 6, 3)))
    done = run("identify", "scara", "--samples", archive)
    assert (done.status, done.out) == (1, "none of the conventions that are known\n")


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("1,2\n3\n", "different lengths"),
        ("1,x\n", "is no number"),
        ("", "holds no numbers"),
        ("1,nan,3\n", "shape"),
        ("1,2,3\n4,5,6\n", "shape"),
    ],
)
def test_bad_tables(content: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "J.csv"
    file.write_text(content)
    assert says in refused("identify", "scara", "--matrix", file) or "NaN" in refused(
        "identify", "scara", "--matrix", file
    )


HUGE = b"{'descr': '<f8', 'fortran_order': False, 'shape': (10000000000000000, 3)}".ljust(117) + b"\n"


def test_bad_archives(tmp_path: Path) -> None:
    file = tmp_path / "a.npz"
    np.savez(file, q=np.zeros(3), J=np.array([object()]))
    assert "no archive of plain arrays" in refused("identify", "scara", "--samples", file)
    np.savez(file, q=np.zeros(3))
    assert "lacks its arrays" in refused("identify", "scara", "--samples", file)
    file.write_bytes(b"PK\x03\x04 not really")
    assert "no archive of plain arrays" in refused("identify", "scara", "--samples", file)
    for member, flag in ((b"\x93NUMPY\x01\0v\0" + HUGE, 0), (b"", 1)):  # more than any memory has; encrypted
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr("q.npy", member)
        data = file.read_bytes()
        directory = data.index(b"PK\x01\x02")
        file.write_bytes(data[: directory + 8] + bytes([flag]) + data[directory + 9 :])
        assert "no archive of plain arrays" in refused("identify", "scara", "--samples", file)
    assert "no such file" in refused("identify", "scara", "--samples", tmp_path / "b.npz")
    assert "give --samples" in refused("identify", "scara")


@pytest.mark.parametrize(
    "given",
    [(np.zeros((5, 3)),), (np.full((6, 3), np.nan),), (np.zeros(3),), (np.zeros(2), np.zeros(6)), (), ("x",)],
)
def test_bad_arrays(given: tuple[Any, ...]) -> None:
    with pytest.raises(InputError) as caught:
        ps.identify("scara", np.zeros(3), *given)
    assert caught.value.code in ("shape", "not-finite", "not-numbers")


def test_no_joints_and_one(tmp_path: Path) -> None:
    """With one joint many conventions are one or can't be told apart: never a wrong one."""
    found = ps.identify("one_joint", [0.4], ps.Pinocchio(ps.load("one_joint")).jacobian([0.4], "tool", "spatial"))
    words = [name for each in found.candidates for name in (each.words, *each.aliases)]
    assert any(each.startswith("the spatial Jacobian of tool") for each in words)
    still = tmp_path / "still.urdf"
    still.write_text("<robot name='s'><link name='base'/></robot>")
    with pytest.raises(InputError):
        ps.identify(ps.load(still), np.zeros((1, 0)), np.zeros((1, 6, 0)))


@pytest.mark.parametrize("shape", ["J", "rpy"])
def test_many_that_fit_are_never_one(shape: str) -> None:
    """At zero, where all frames stand alike, dozens fit under many names; none is hidden behind the first ones'."""
    robot = ps.load("panda")
    q = robot.neutral
    T = ps.Pinocchio(robot).fk(q, "panda_link2")
    R = Rotation.from_matrix(T[:3, :3])
    given = {
        "J": ps.Pinocchio(robot).jacobian(q, "panda_link2", "hybrid"),
        "rpy": np.concatenate([T[:3, 3], R.as_euler("xyz")]),
    }
    found = ps.identify(robot, q, given[shape])
    assert found.verdict == "ambiguous"
    assert 2 <= len(found.candidates) <= 8
    assert found.ask is not None


def test_a_humanoid() -> None:
    """A hundred frames, and ten thousand pairs of them."""
    robot = ps.load("talos_full_v2")
    q = places(robot)
    found = ps.identify(robot, q, ps.Pinocchio(robot).fk(q, "gripper_left_base_link"))
    assert found.verdict == "unique"
    words = (found.candidates[0].words, *found.candidates[0].aliases)
    assert f"the pose of gripper_left_base_link in {robot.base}, as 4×4 matrix" in words


def test_what_is_asked_tells_them_apart_best() -> None:
    """Of the places that are looked at, the one at which the two nearest of the candidates are farthest apart."""
    robot = ps.load("scara")
    pin = ps.Pinocchio(robot)
    found = ps.identify(robot, np.zeros(3), pin.jacobian(np.zeros(3), "tool", "hybrid"))
    assert found.ask is not None
    observers = [each.observer for each in found.candidates if each.observer is not None]
    tried = configurations(robot, TRIED, 0)
    tried_q = [q for label, q in zip(tried.labels, tried.q, strict=True) if label.startswith("random")]
    assert any(np.array_equal(found.ask, q) for q in tried_q)

    def nearest(q: np.ndarray[Any, Any]) -> float:
        seen = [observed(pin, each, q[None]) for each in observers]
        return min(float(abs(a - b).max()) for k, a in enumerate(seen) for b in seen[:k])

    assert nearest(found.ask) == pytest.approx(max(map(nearest, tried_q)))
