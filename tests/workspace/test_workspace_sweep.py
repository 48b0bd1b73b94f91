"""Sweeps against the closed forms of the coursework, against numpy and against scipy."""

from __future__ import annotations

import sys
import tracemalloc
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import qmc

import closed_forms
import pinscrew as ps
import urdfs
from pinscrew.engines.measures import manipulability
from pinscrew.ground.errors import InputError, MissingExtraError, PinscrewError, UnknownNameError
from pinscrew.lockfile import fingerprint
from pinscrew.workspace.axes import axes, sobol
from pinscrew.workspace.comparison import from_reference
from pinscrew.workspace.measures import Measures

ROUNDING = 1e-12
load = cache(ps.load)
A2 = closed_forms.Planar2RBase()


# ------------------------------------------------------------------------------------- A2, part (f)


def test_a2_is_the_grid_of_the_coursework() -> None:
    """1036 points, each where the closed form has it."""
    swept = ps.sweep(load("planar_2r"))
    q = A2.workspace_grid()
    assert len(swept.q) == len(q) == 1036
    np.testing.assert_allclose(swept.q, q, rtol=0, atol=1e-15)
    np.testing.assert_allclose(swept.poses, [A2.fk(each, {}) for each in q], rtol=0, atol=ROUNDING)
    np.testing.assert_array_equal(swept.positions, swept.poses[:, :3, 3])
    assert swept.metadata["grid"] == {"joint1": 28, "joint2": 37}


def test_a2_both_choices_of_frame_0_coincide() -> None:
    robot = load("planar_2r")
    swept = ps.sweep(robot)
    carried = from_reference(robot, swept.q, "tool", "frame0")
    np.testing.assert_allclose(carried, swept.poses, rtol=0, atol=ROUNDING)
    tip = closed_forms.Planar2RTip()
    truth = [tip.base_from_frame0() @ tip.fk(q, {}) for q in swept.q]
    np.testing.assert_allclose(carried, truth, rtol=0, atol=ROUNDING)


def test_a2_a_choice_that_is_not_the_same_frame_does_not_coincide() -> None:
    """An arm whose frame 0 has its second screw wrong is seen."""
    robot = load("planar_2r")
    swept = ps.sweep(robot)
    wrong = ps.load("planar_2r")
    motions = wrong.mechanism.motions
    twist = motions[1].twists.copy()
    twist[2] += 1e-9
    object.__setattr__(motions[1], "twists", twist)
    carried = from_reference(wrong, swept.q, "tool", "frame0")
    assert np.linalg.norm((carried - swept.poses)[:, :3, 3], axis=1).max() > 1e-10


@pytest.mark.parametrize("name", ["spherical_rrp", "stanford_rrp", "two_joint"])
def test_other_arms_from_another_frame_0(name: str) -> None:
    robot = load(name)
    swept = ps.sweep(robot, samples=50)
    np.testing.assert_allclose(from_reference(robot, swept.q, "tool", robot.base), swept.poses, rtol=0, atol=ROUNDING)


def test_a_mimic_has_no_screw_of_its_own_to_compare() -> None:
    robot = load("lead_screw")
    with pytest.raises(InputError, match="no coordinate and screw of its own") as caught:
        from_reference(robot, np.zeros((1, robot.nq)), robot.tip, robot.base)
    assert caught.value.code == "frame0"


# ---------------------------------------------------------------------------------------- measures


def test_a5_manipulability_is_that_of_the_closed_form() -> None:
    """√det(J Jᵀ) of rows 1 and 2 of J^h; the rotation is three times the same axis, so √3."""
    arm, L = closed_forms.PlanarRRR(), {"l1": 0.5, "l2": 0.4, "l3": 0.3}
    swept = ps.sweep(load("planar_rrr"), samples=256)
    J = np.array([arm.jacobian_hybrid(q, L)[:2] for q in swept.q])
    w = np.sqrt(np.linalg.det(J @ J.transpose(0, 2, 1)))
    assert (swept.translation.rank, swept.rotation.rank) == (2, 1)
    np.testing.assert_allclose(swept.translation.manipulability, w, rtol=1e-10)
    np.testing.assert_allclose(swept.rotation.manipulability, np.sqrt(3.0), rtol=ROUNDING)
    eigenvalues = np.linalg.eigvalsh(J @ J.transpose(0, 2, 1))
    np.testing.assert_allclose(swept.translation.smallest, np.sqrt(eigenvalues[:, 0]), rtol=1e-8)
    np.testing.assert_allclose(swept.translation.condition**2, eigenvalues[:, 1] / eigenvalues[:, 0], rtol=1e-8)


def test_a2_manipulability_is_the_cosine() -> None:
    """y = c1 + s12 and z = 1 + s1 - c12 give det ∂(y, z)/∂θ = -c2."""
    swept = ps.sweep(load("planar_2r"))
    np.testing.assert_allclose(swept.translation.manipulability, abs(np.cos(swept.q[:, 1])), rtol=0, atol=ROUNDING)
    singular = abs(abs(swept.q[:, 1]) - np.pi / 2) < 1e-9
    assert singular.sum() == 2 * 28
    assert (swept.translation.condition[singular] > 1e15).all()


def test_ranks_do_not_depend_on_where_one_looks() -> None:
    """At a singular configuration the arm still has its rank, and the smallest singular value is 0."""
    swept = ps.sweep(load("planar_2r"), grid=0.1, ranges={"joint1": (0, 0), "joint2": (np.pi / 2, np.pi / 2)})
    assert (len(swept.q), swept.translation.rank) == (1, 2)
    np.testing.assert_allclose(swept.translation.smallest, 0.0, atol=ROUNDING)


def test_what_never_moves_has_no_measures() -> None:
    """A drone's first link rises and never turns; a tool on its joint's axis turns and never moves."""
    swept = ps.sweep(load("drone"), frame=load("drone").frame_names[1], samples=4)
    assert (swept.translation.rank, swept.rotation.rank) == (1, 0)
    for each in (swept.rotation.manipulability, swept.rotation.smallest, swept.rotation.condition):
        assert each.shape == (4,)
        assert np.isnan(each).all()
    np.testing.assert_array_equal(swept.translation.manipulability, 1.0)
    still = ps.sweep(urdfs.load(urdfs.single_revolute()), samples=4)
    assert (still.translation.rank, still.rotation.rank) == (0, 1)


@pytest.mark.parametrize("rank", [1, 2, 3])
def test_manipulability_without_singular_values(rank: int) -> None:
    rng = np.random.default_rng(rank)
    J = rng.normal(size=(200, 3, rank)) @ rng.normal(size=(200, rank, 7))
    values = np.linalg.svd(J, compute_uv=False)[:, :rank]
    np.testing.assert_allclose(manipulability(J, rank), Measures(values).manipulability, rtol=1e-6)


def test_no_manipulability_of_rank_0() -> None:
    assert np.isnan(manipulability(np.zeros((3, 3, 2)), 0)).all()


def test_jacobians_are_kept_if_asked_for() -> None:
    arm, L = closed_forms.PlanarRRR(), {"l1": 0.5, "l2": 0.4, "l3": 0.3}
    robot = load("planar_rrr")
    swept = ps.sweep(robot, samples=32, kind="LOCAL")
    assert swept.jacobians is not None
    np.testing.assert_allclose(swept.jacobians, [arm.jacobian_body(q, L) for q in swept.q], rtol=0, atol=ROUNDING)
    hybrid = ps.sweep(robot, samples=32, kind="hybrid").jacobians
    np.testing.assert_allclose(hybrid, [arm.jacobian_hybrid(q, L) for q in swept.q], rtol=0, atol=ROUNDING)
    assert ps.sweep(robot, samples=32).jacobians is None


def test_another_engine() -> None:
    robot = load("scara")
    a, b = ps.sweep(robot, samples=64), ps.sweep(robot, samples=64, engine=ps.Pinocchio(robot))
    np.testing.assert_allclose(a.poses, b.poses, rtol=0, atol=ROUNDING)
    assert (a.metadata["engine"], b.metadata["engine"]) == ("Batch", "Pinocchio")


# ------------------------------------------------------------------------------------ grids, samples


def test_samples_are_those_of_scipy() -> None:
    robot = load("scara")
    lower, upper = robot.limits.T
    truth = qmc.scale(qmc.Sobol(3, scramble=True, seed=np.random.default_rng(7)).random(64), lower, upper)
    np.testing.assert_allclose(ps.sweep(robot, samples=64, seed=7).q, truth, rtol=0, atol=1e-15)
    assert abs(ps.sweep(robot, samples=64, seed=8).q - truth).max() > 0.1


def test_another_number_than_a_power_of_two_is_taken_without_a_word() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(ps.sweep(load("scara"), samples=100.0).q) == 100


def test_a_step_that_does_not_divide_the_range_is_shortened() -> None:
    swept = ps.sweep(load("planar_2r"), grid={"joint1": 0.5, "joint2": 3.0}, ranges={"joint1": (0.0, 1.2)})
    np.testing.assert_allclose(swept.q[::3, 0], [0.0, 0.4, 0.8, 1.2], rtol=0, atol=1e-15)
    np.testing.assert_allclose(swept.q[:3, 1], [-np.pi / 2, 0.0, np.pi / 2], rtol=0, atol=1e-15)


def test_joints_without_limits_turn_once() -> None:
    """A grid of a full turn leaves out its end, which is its beginning."""
    robot = urdfs.load(urdfs.continuous())
    assert [(axis.lower, axis.upper, axis.turn) for axis in axes(robot, "tool")] == [(-np.pi, np.pi, True)] * 2
    q = ps.sweep(robot, grid=np.pi / 2).q
    np.testing.assert_allclose(q[:4, 1], [-np.pi, -np.pi / 2, 0.0, np.pi / 2], rtol=0, atol=1e-15)
    assert len(np.unique(q, axis=0)) == len(q) == 16


def test_only_what_moves_the_frame_is_swept() -> None:
    robot = load("scara")
    swept = ps.sweep(robot, frame="link1")
    assert list(swept.metadata["ranges"]) == ["joint1"]
    assert (swept.q[:, 1:] == 0.0).all()
    assert len(np.unique(swept.q[:, 0])) == len(swept.q) == 73


def test_a_mimic_follows_its_coordinate() -> None:
    robot = load("lead_screw")
    swept = ps.sweep(robot, samples=16)
    np.testing.assert_allclose(swept.poses, ps.Pinocchio(robot).fk(swept.q), rtol=0, atol=ROUNDING)


def test_planar_joints_need_ranges_of_their_displacements() -> None:
    robot = urdfs.load(urdfs.planar())
    with pytest.raises(InputError, match=r"'table\.x' is -inf to inf; give finite ends"):
        ps.sweep(robot)
    swept = ps.sweep(robot, samples=8, ranges={"table.x": (0, 1), "table.y": (0, 2)})
    assert list(swept.metadata["units"].values()) == ["rad", "m", "m", "rad", "rad"]
    assert (swept.translation.rank, swept.rotation.rank) == (3, 3)


REFUSED = {
    "both": ({"grid": 0.1, "samples": 3}, "grid", "both a grid and samples"),
    "zero": ({"grid": 0.0}, "grid", "the step of 'joint1' is 0"),
    "negative": ({"grid": -0.1}, "grid", "the step of 'joint1' is -0.1"),
    "nan": ({"grid": float("nan")}, "grid", "the step of 'joint1' is nan"),
    "no number": ({"grid": "5"}, "grid", "the step of 'joint1' is 5"),
    "large": ({"grid": 4.0}, "grid", "larger than its range"),
    "tiny": ({"grid": 5e-324}, "grid", "give a larger step"),
    "a missing step": ({"grid": {"joint1": 0.1}}, "grid", "no step for 'joint2'"),
    "no samples": ({"samples": 0}, "samples", "samples=0"),
    "half a sample": ({"samples": 0.5}, "samples", "samples=0.5"),
    "infinite samples": ({"samples": float("inf")}, "samples", "samples=inf"),
    "more than Sobol has": ({"samples": 2e9}, "memory", "GiB of memory"),
    "seed": ({"samples": 1, "seed": -1}, "seed", "seed=-1"),
    "reversed": ({"ranges": {"joint1": (1, 0)}}, "range", "reversed"),
    "infinite": ({"ranges": {"joint1": (0, float("inf"))}}, "range", "finite"),
    "no range": ({"ranges": {"joint1": 3}}, "range", "two numbers"),
    "memory": ({"grid": 1e-6}, "memory", "make a reachability map"),
    "overflow": ({"grid": 1e-300}, "memory", "make a reachability map"),
    "fixed": ({"frame": "frame0"}, "nothing-moves", "no joint moves the frame 'frame0'"),
    "kind": ({"kind": "geometric"}, "jacobian-kind", "is not a kind"),
}


@pytest.mark.parametrize(("arguments", "code", "words"), REFUSED.values(), ids=REFUSED)
def test_refused(arguments: dict[str, object], code: str, words: str) -> None:
    with pytest.raises(PinscrewError, match=words) as caught:
        ps.sweep(load("planar_2r"), **arguments)  # type: ignore[arg-type]
    assert caught.value.code == code


def test_names_are_checked() -> None:
    robot = load("scara")
    with pytest.raises(UnknownNameError, match="known are: joint1, joint2, joint3"):
        ps.sweep(robot, ranges={"joint4": (0, 1)})
    with pytest.raises(UnknownNameError, match="no coordinate that moves the frame 'joint2'"):
        ps.sweep(robot, frame="link1", grid={"joint2": 0.1})
    with pytest.raises(InputError, match="'joint2' does not move the frame 'link1'"):
        ps.sweep(robot, frame="link1", ranges={"joint2": (0, 1)})
    with pytest.raises(InputError, match=r"no step for 'joint3'; give one, such as joint3=0\.01"):
        ps.sweep(robot, grid=0.1)


def test_poses_of_floating_bases_have_no_range() -> None:
    with pytest.raises(InputError, match="'root_joint' moves the frame 'tool'") as caught:
        ps.sweep(load("scara", floating_base=True))
    assert caught.value.code == "floating"


def test_sobol_ends() -> None:
    robot = load("planar_2r")
    with pytest.raises(InputError, match="at most 1073741824"):
        sobol(axes(robot, "tool"), 2**30 + 1, 0)


def test_without_scipy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Grids do without."""
    monkeypatch.setitem(sys.modules, "scipy.stats", None)
    assert len(ps.sweep(load("planar_2r")).q) == 1036
    with pytest.raises(MissingExtraError, match=r"pinscrew\[workspace\]"):
        ps.sweep(load("planar_2r"), samples=4)


# --------------------------------------------------------------------------------------------- files


def test_saved_and_loaded(tmp_path: Path) -> None:
    robot = load("scara", l1=0.5)
    swept = ps.sweep(robot, samples=8, seed=3, kind="spatial")
    swept.save(tmp_path / "a.npz")
    again = ps.Sweep.load(tmp_path / "a.npz")
    assert again.metadata == swept.metadata
    assert again.metadata["fingerprint"] == fingerprint(robot)
    assert (again.metadata["samples"], again.metadata["seed"], again.metadata["arguments"]) == (8, 3, {"l1": "0.5"})
    for one, other in ((swept.q, again.q), (swept.poses, again.poses), (swept.jacobians, again.jacobians)):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(swept.translation.singular_values, again.translation.singular_values)
    swept.save(tmp_path / "b.npz")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_files_are_read_with_suspicion(tmp_path: Path) -> None:
    whole = tmp_path / "a.npz"
    ps.sweep(load("scara"), samples=4).save(whole)
    data = whole.read_bytes()
    rng = np.random.default_rng(0)
    bad = [b"", b"PK\x03\x04", data[: len(data) // 2], data[100:], np.random.default_rng(1).bytes(500)]
    bad += [data[:i] + bytes([data[i] ^ 0xFF]) + data[i + 1 :] for i in rng.integers(0, len(data), 200)]
    refused = 0
    for text in bad:
        (tmp_path / "b.npz").write_bytes(text)
        try:
            ps.Sweep.load(tmp_path / "b.npz")
        except InputError as error:
            refused += 1
            assert error.code == "workspace-file"  # noqa: PT017 (some flips are harmless)
    assert refused > 100
    with pytest.raises(InputError, match="can't be read") as caught:
        ps.Sweep.load(tmp_path / "none.npz")
    assert caught.value.code == "no-file"


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({}, "its schema is None"),
        ({"metadata": np.array("{")}, "Expecting"),
        ({"metadata": np.array('{"schema": "pinscrew.reachability/1"}')}, "its schema is 'pinscrew.reachability/1'"),
        ({"metadata": np.array('{"schema": "pinscrew.sweep/1"}')}, "the array 'q' is not in it"),
        (
            {
                "metadata": np.array('{"schema": "pinscrew.sweep/1"}'),
                "q": np.zeros((2, 3)),
                "poses": np.zeros((1, 4, 4)),
                "translation": np.zeros((2, 2)),
                "rotation": np.zeros((2, 2)),
            },
            "different lengths",
        ),
    ],
)
def test_other_npz_files(tmp_path: Path, arrays: dict[str, np.ndarray], words: str) -> None:
    np.savez(tmp_path / "a.npz", **arrays)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=words):
        ps.Sweep.load(tmp_path / "a.npz")


def test_no_pickle(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", metadata=np.array([print], dtype=object))
    with pytest.raises(InputError, match=r"no pinscrew\.sweep/1 file"):
        ps.Sweep.load(tmp_path / "a.npz")


def test_an_archive_that_swells_is_not_opened(tmp_path: Path) -> None:
    """120 MB of zeros in 120 kB, under a name of ours: the memory of none of it is taken."""
    whole = tmp_path / "a.npz"
    ps.sweep(load("scara"), samples=4).save(whole)
    with np.load(whole) as archive:
        arrays = dict(archive)
    np.savez_compressed(tmp_path / "b.npz", **{**arrays, "q": np.zeros((5_000_000, 3))})
    tracemalloc.start()
    with pytest.raises(InputError, match="compressed, of more than 100 MB"):
        ps.Sweep.load(tmp_path / "b.npz")
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()
    np.savez_compressed(tmp_path / "c.npz", **arrays)
    assert len(ps.Sweep.load(tmp_path / "c.npz").q) == 4


def test_an_archive_of_something_else_is_refused_before_it_is_read(tmp_path: Path) -> None:
    np.savez(tmp_path / "b.npz", q=np.zeros(5_000_000))
    tracemalloc.start()
    with pytest.raises(InputError, match="its schema is None"):
        ps.Sweep.load(tmp_path / "b.npz")
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()
