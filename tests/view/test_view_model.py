"""What is drawn of a robot, as numbers: where its solids stand, how large it counts, which frame is its tip."""

from __future__ import annotations

import math

import numpy as np
import pytest
from view_support import FREE, MIXED

import pinscrew as ps
import urdfs
from pinscrew.description.visuals import Geometry, Looks, Visual
from pinscrew.ground.errors import UnknownNameError
from pinscrew.view.mesh_files import MeshPart
from pinscrew.view.model import CROWDED, SMALLEST, Body, Model, samples

ARM = urdfs.robot(
    urdfs.joint("turn", "revolute", "base", "a", axis="0 0 1", limits=(-1.0, 2.0)),
    urdfs.joint("slide", "prismatic", "a", "tool", xyz="2 0 0", axis="0 0 1", limits=(-0.1, 0.3)),
    links="base a tool",
)
"""The tool is 2 m from a vertical axis, on a vertical slide."""
T = np.array([[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 1.0, 3.0], [0.0, 0.0, 0.0, 1.0]])
"""Turned by 90° about z, and away from the origin."""


def model(*solids: Visual, text: str = ARM, meshes: dict[Visual, tuple[MeshPart, ...]] | None = None) -> Model:
    return Model.of(urdfs.load(text), Looks(tuple(solids)), meshes or {})


def visual(kind: str, *size: float, link: str = "base", color: tuple[float, ...] | None = None) -> Visual:
    return Visual(link, Geometry(kind, size), T, color)  # type: ignore[arg-type]


def bodies(found: Model, group: str) -> dict[str, Body]:
    return {body.owner: body for body in found.bodies if body.group == group}


def stretched(*factors: float) -> np.ndarray:
    return T @ np.diag([*factors, 1.0])


def test_solids_stand_where_the_file_has_them() -> None:
    ends = [T @ [[0.5, 0, 0, 0], [0, 0.5, 0, 0], [0, 0, 0.5, z], [0, 0, 0, 1]] for z in (-2.0, 2.0)]
    wanted = [
        ("box", stretched(1, 2, 3)),
        ("cylinder", stretched(0.5, 0.5, 4)),
        ("sphere", stretched(0.5, 0.5, 0.5)),
        ("cylinder", stretched(0.5, 0.5, 4)),
        ("sphere", ends[0]),
        ("sphere", ends[1]),
    ]
    solids = visual("box", 1, 2, 3), visual("cylinder", 0.5, 4), visual("sphere", 0.5), visual("capsule", 0.5, 4)
    body = bodies(model(*solids), "links")["base"]
    assert [part.shape.kind for part in body.parts] == [kind for kind, _ in wanted]
    assert [part.name for part in body.parts] == ["0", "1", "2", "3", "4", "5"]
    for part, (_, transform) in zip(body.parts, wanted, strict=True):
        np.testing.assert_allclose(part.transform, transform, rtol=0, atol=1e-15)


def test_meshes_are_kept_once_and_have_their_own_colour_first() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 4.0, 0.0]])
    plain, red = (MeshPart(corners, corners, np.array([[0, 1, 2]]), color) for color in (None, (1.0, 0.0, 0.0, 1.0)))
    first, second = visual("mesh", 1, 1, 2, color=(0.0, 1.0, 0.0, 1.0)), visual("mesh", 3, 1, 1, link="a")
    found = model(first, second, meshes={first: (plain, red), second: (red,)})
    assert found.meshes == (plain, red)
    parts = bodies(found, "links")["base"].parts
    assert [(part.name, part.shape.mesh, part.color) for part in parts] == [
        ("0", 0, (0.0, 1.0, 0.0, 1.0)),
        ("1", 1, (1.0, 0.0, 0.0, 1.0)),
    ]
    np.testing.assert_allclose(parts[0].transform, stretched(1, 1, 2), rtol=0, atol=1e-15)
    (part,) = bodies(found, "links")["a"].parts
    assert (part.shape.mesh, part.color) == (1, (1.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ("solid", "low", "high"),
    [
        (visual("box", 2, 4, 6), (-1, 1, 0), (3, 3, 6)),  # turned, x is along y
        (visual("cylinder", 0.5, 4), (0.5, 1.5, 1), (1.5, 2.5, 5)),
        (visual("cylinder", 1.5, 4), (-0.5, 0.5, 1), (2.5, 3.5, 5)),  # beyond the origins on all sides
        (visual("sphere", 0.5), (0.5, 1.5, 2.5), (1.5, 2.5, 3.5)),
    ],
)
def test_the_size_is_that_of_reach_and_solids(solid: Visual, low: tuple[float, ...], high: tuple[float, ...]) -> None:
    """The reach of the arm is 2 m, its origins are from 0 to 2 along x; three quarters of the extent at least."""
    corners = np.array([low, high, (0.0, 0.0, 0.0), (2.0, 0.0, 0.0)])
    extent = float(np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)))
    assert model(solid).size == pytest.approx(max(min(2.0, extent), 0.75 * extent), rel=1e-12)


def test_sizes_of_robots_without_any() -> None:
    single = '<robot name="r"><link name="base"/></robot>'
    assert model(text=single).size == SMALLEST
    assert model().size == 2.0


def test_many_joints_are_drawn_smaller() -> None:
    links = [f"l{i}" for i in range(4 * CROWDED + 1)]
    text = urdfs.robot(
        *(urdfs.joint(f"j{i}", "revolute", *links[i : i + 2], xyz="0.1 0 0") for i in range(4 * CROWDED)),
        links=" ".join(links),
    )
    assert model(text=text).size == pytest.approx(0.1 * 4 * CROWDED * 0.5, rel=1e-12)


def test_the_tip_is_the_one_that_was_asked_for() -> None:
    robot = urdfs.load(ARM)
    assert Model.of(robot, Looks(()), {}).tip == "tool"
    other = Model.of(robot, Looks(()), {}, "a")
    assert other.tip == "a"
    labels = {owner: len(body.parts) for owner, body in bodies(other, "frames").items()}
    assert set(labels) == {"base", "a", "tool"}
    axes = {owner: body.parts[0].transform for owner, body in bodies(other, "frames").items()}
    lengths = {owner: float(np.linalg.norm(T[:3, 2])) / other.size for owner, T in axes.items()}
    assert lengths["a"] == lengths["base"] > 1.2 * lengths["tool"]
    assert 0.05 < lengths["tool"] < lengths["a"] < 0.25
    with pytest.raises(UnknownNameError):
        Model.of(robot, Looks(()), {}, "nowhere")


def test_scales_are_the_most_that_each_velocity_does() -> None:
    scales = model().scales
    np.testing.assert_allclose(scales.linear, [2.0, 1.0], rtol=1e-12)  # 2 m from the axis; along the slide
    np.testing.assert_allclose(scales.field, [2.0, 1.0], rtol=1e-12)
    np.testing.assert_allclose(scales.angular, [1.0, 0.0], atol=1e-15)
    # An elbow at 1 m, the tool 1 m farther: it is within 2 m of the shoulder, which it reaches only stretched.
    two = urdfs.joint("a", "continuous", "base", "a"), urdfs.joint("b", "continuous", "a", "b", xyz="1 0 0")
    fixed = urdfs.joint("c", "fixed", "b", "tool", xyz="1 0 0")
    assert 1.95 < model(text=urdfs.robot(*two, fixed, links="base a b tool")).scales.linear[0] <= 2.0
    near = urdfs.robot(urdfs.joint("turn", "revolute", "base", "tool", xyz="3 0 0", axis="0 0 1"), links="base tool")
    scales = model(text=near).scales
    assert scales.linear.tolist() == [0.0]  # the tool is on the axis
    assert scales.field.tolist() == [pytest.approx(3.0)]  # what passes the origin is not


def test_limits_of_velocities() -> None:
    fast = urdfs.joint("fast", "revolute", "base", "a").replace('velocity="1"', 'velocity="2.5"')
    none, still = urdfs.joint("none", "continuous", "a", "b"), fast.replace("2.5", "0").replace("fast", "still")
    still = still.replace('"base"', '"b"').replace('link="a"', 'link="tool"')
    assert 'velocity="2.5"' in fast
    found = model(text=urdfs.robot(fast, none, still, links="base a b tool"))
    assert found.scales.limits.tolist() == [2.5, 1.0, 1.0]


@pytest.mark.parametrize("text", [ARM, MIXED, FREE])
def test_samples_are_within_limits_or_what_stands_for_them(text: str) -> None:
    robot = urdfs.load(text, tip="tool")
    q = samples(robot, 500, 0.7, seed=3)
    lower, upper = robot.limits.T
    stands_for = np.where(robot.mechanism.coordinates.slides, 0.7, math.pi)
    free = {m.q + 3 + i for m in robot.mechanism.motions if m.joint.type == "floating" for i in range(4)}
    for i in range(robot.nq):
        if i in free:
            continue
        low = lower[i] if math.isfinite(lower[i]) else -stands_for[i]
        high = upper[i] if math.isfinite(upper[i]) else stands_for[i]
        assert low <= q[:, i].min() <= low + 0.02 * (high - low)
        assert high - 0.02 * (high - low) <= q[:, i].max() <= high
    if free:
        np.testing.assert_allclose(np.linalg.norm(q[:, sorted(free)], axis=1), 1.0, rtol=1e-12)
    assert not np.array_equal(q, samples(robot, 500, 0.7, seed=4))
    ps.PoE(robot).fk(q, "tool")


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_limits_as_wide_as_numbers_go(kind: str) -> None:
    """Their difference is no number."""
    text = urdfs.robot(urdfs.joint("a", kind, "base", "tool", limits=(-1.7e308, 1.7e308)), links="base tool")
    assert abs(samples(urdfs.load(text), 50, 0.7)).max() <= 1e6 * math.pi
    assert np.isfinite(model(text=text).scales.linear).all()
