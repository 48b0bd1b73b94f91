"""The scene without a viewer: every drawable against what the engines say."""

from __future__ import annotations

import json

import numpy as np
import pytest
from view_support import ARMS, FREE, MIXED

import pinscrew as ps
import urdfs
from pinscrew.description.visuals import Looks
from pinscrew.ground.escaping import json_in_script
from pinscrew.ground.typing import FloatArray
from pinscrew.view import document, prepare, scene, twists
from pinscrew.view.model import Model, samples
from pinscrew.view.shapes import GROUPS, Drawable


def model_of(name: str) -> Model:
    if name in ("mixed", "free"):
        return Model.of(urdfs.load(MIXED if name == "mixed" else FREE, tip="tool"), Looks(()), {})
    return prepare.prepare(ps.load(name))


def middle(drawable: Drawable) -> FloatArray:
    return drawable.transform[:3, 3]


def direction(drawable: Drawable) -> FloatArray:
    """Where the z axis of a rod, a cone or a coil points."""
    z = drawable.transform[:3, 2]
    return z / np.linalg.norm(z)


@pytest.fixture(scope="module", params=[*ARMS, "mixed", "free"])
def model(request: pytest.FixtureRequest) -> Model:
    return model_of(request.param)


@pytest.fixture
def moved(model: Model) -> tuple[FloatArray, FloatArray]:
    """A configuration and velocities."""
    return samples(model.robot, 1, model.size, seed=1)[0], np.random.default_rng(2).normal(size=model.robot.nv)


def test_links_are_where_pinocchio_has_them(model: Model, moved: tuple[FloatArray, FloatArray]) -> None:
    built = scene.build(model, *moved)
    engine = ps.Pinocchio(model.robot)
    bound = 1e-12 * max(1.0, model.robot.reach)
    for name in model.robot.frame_names:
        expected = engine.fk(moved[0], name)
        assert abs(built.poses[name] - expected).max() <= bound
        for i, axis in enumerate("xyz"):
            rod = built.drawables["frames", name, axis]
            assert abs(middle(rod) - expected[:3, 3]).max() <= bound
            assert abs(direction(rod) - expected[:3, i]).max() <= 1e-12
        assert abs(middle(built.drawables["frames", name, "label"]) - expected[:3, 3]).max() <= bound


def test_axes_are_the_columns_of_the_spatial_jacobian(model: Model, moved: tuple[FloatArray, FloatArray]) -> None:
    q = moved[0]
    built = scene.build(model, *moved)
    engine = ps.Pinocchio(model.robot)
    motions = model.robot.mechanism.motions
    for motion in motions:
        if motion.twists.shape[1] != 1 or [m.v for m in motions].count(motion.v) > 1:
            continue
        shaft = built.drawables["screws", motion.joint.name, "axis-shaft"]
        column = engine.jacobian(q, motion.joint.child, "spatial")[:, motion.v]
        if motion.joint.type == "prismatic":
            assert abs(direction(shaft) - column[:3]).max() <= 1e-12
            assert not built.drawables["screws", motion.joint.name, "coil"].transform[:3, :3].any()
        else:
            assert abs(direction(shaft) - column[3:]).max() <= 1e-12
            moment = np.cross(middle(shaft), column[3:])
            assert abs(moment - column[:3]).max() <= 1e-11 * max(1.0, model.robot.reach)


def test_arrows_at_the_tip_are_its_velocity(model: Model, moved: tuple[FloatArray, FloatArray]) -> None:
    q, qd = moved
    built = scene.build(model, q, qd)
    tip = model.tip
    V = ps.Pinocchio(model.robot).velocity(q, qd, tip, "hybrid")
    scales = scene.arrow_scales(model, qd)
    for name, vector, scale in (("v", V[:3], scales[0]), ("w", V[3:], scales[1])):
        shaft, head = (built.drawables["velocity", tip, f"{name}-{part}"] for part in ("shaft", "head"))
        assert abs(middle(shaft) - built.poses[tip][:3, 3]).max() <= 1e-12 * max(1.0, model.robot.reach)
        end = middle(head) + head.transform[:3, 2]
        if np.linalg.norm(vector) * scale > 1e-6 * model.size:
            assert abs(end - middle(shaft) - scale * vector).max() <= 1e-10 * model.size


def test_circles_are_the_fields_of_the_twists(model: Model, moved: tuple[FloatArray, FloatArray]) -> None:
    q, qd = moved
    tip, size = model.tip, model.size
    built = scene.build(model, q, qd)
    J = ps.Pinocchio(model.robot).jacobian(q, tip, "spatial")
    owners = {name: J[:, i] * qd[i] for i, name in enumerate(model.robot.velocity_names) if J[:, i].any()}
    for owner, twist, prefix in [*((o, t, "") for o, t in owners.items()), (tip, J @ qd, "sum-")]:
        for at, which in ((np.zeros(3), "spatial"), (built.poses[tip][:3, 3], "body")):
            field = twist[:3] + np.cross(twist[3:], at)
            ring = built.drawables["circles", owner, f"{prefix}{which}-circle"]
            shaft = built.drawables["circles", owner, f"{prefix}{which}-shaft"]
            radius = np.linalg.norm(ring.transform[:3, 0])
            if radius > 0.0:
                # The circle passes through the point, about the axis; the velocity is tangent but for the pitch.
                assert abs(middle(ring) + ring.transform[:3, 0] - at).max() <= 1e-9 * max(size, radius)
                assert abs(np.cross(direction(ring), twist[3:])).max() <= 1e-9 * np.linalg.norm(twist[3:])
                on_axis = twist[:3] + np.cross(twist[3:], middle(ring))
                assert abs(np.cross(on_axis, direction(ring))).max() <= 1e-9 * max(1.0, float(abs(twist).max()))
                assert abs(field @ ring.transform[:3, 0]) <= 1e-9 * radius * max(1.0, float(np.linalg.norm(field)))
            if np.linalg.norm(field) > 1e-6:
                assert abs(np.cross(direction(shaft), field)).max() <= 1e-9 * max(1.0, float(np.linalg.norm(field)))


def test_the_ellipsoid_is_the_image_of_the_unit_ball(model: Model, moved: tuple[FloatArray, FloatArray]) -> None:
    q = moved[0]
    J = ps.Pinocchio(model.robot).jacobian(q, model.tip, "hybrid")[:3]
    drawn = scene.build(model, *moved).drawables["ellipsoid", model.tip, "manipulability"]
    assert abs(middle(drawn) - ps.Pinocchio(model.robot).fk(q, model.tip)[:3, 3]).max() <= 1e-11 * model.size
    bound = float(np.linalg.norm(model.scales.linear))
    scale = scene.ELLIPSOID * model.size / bound if bound else 0.0
    expected = np.sort(np.linalg.eigvalsh(J @ J.T))[::-1]
    half_axes = np.maximum(scale * np.sqrt(np.maximum(expected, 0.0)), scene.THINNEST * model.size)
    assert np.allclose(np.linalg.svd(drawn.transform[:3, :3])[1], half_axes, rtol=1e-7, atol=1e-9 * model.size)


def test_the_coil_of_a_lead_screw_has_its_pitch() -> None:
    model = model_of("lead_screw")
    coil = scene.build(model, [1.0]).drawables["screws", "joint1", "compound-coil"]
    radius = np.linalg.norm(coil.transform[:3, 0])
    assert coil.shape.parameters["rise"] * radius == pytest.approx(0.005 / (2 * np.pi), rel=1e-12)
    assert coil.shape.parameters["turns"] == twists.MOST_TURNS


def test_two_joints_as_the_lecture_draws_them() -> None:
    """A10 at θ = (0, 0): circles about the two joints through the origin and through the tool, on the y axis."""
    built = scene.build(model_of("two_joint"), [0.0, 0.0], [1.0, 1.0])
    for joint, centre in (("joint1", 0.2), ("joint2", 0.7)):
        for which, radius in (("spatial", centre), ("body", 1.1 - centre)):
            ring = built.drawables["circles", joint, f"{which}-circle"]
            assert np.allclose(middle(ring), [0, centre, 0], atol=1e-12)
            assert np.linalg.norm(ring.transform[:3, 0]) == pytest.approx(radius)
    assert np.allclose(middle(built.drawables["circles", "tool", "sum-body-circle"]), [0, 0.45, 0], atol=1e-12)
    assert np.allclose(direction(built.drawables["circles", "tool", "sum-body-shaft"]), [-1, 0, 0], atol=1e-12)
    assert np.allclose(direction(built.drawables["circles", "tool", "sum-spatial-shaft"]), [1, 0, 0], atol=1e-12)


def test_no_velocity_draws_nothing_of_it() -> None:
    model = model_of("scara_rrp")
    built = scene.build(model, [0.1, 0.2, 0.1], np.zeros(3))
    for drawable in (*built.group("velocity"), *built.group("circles")):
        assert not drawable.transform[:3, :3].any()
        assert np.isfinite(drawable.transform).all()


@pytest.mark.filterwarnings("ignore:.*lengths are in metres")
@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e4])
def test_sizes_follow_the_robot(scale: float) -> None:
    joint = urdfs.joint("j", "revolute", "base", "tool", xyz=f"{scale} 0 0", axis="0 0 1")
    model = Model.of(urdfs.load(urdfs.robot(joint, links="base tool")), Looks(()), {})
    shaft = scene.build(model, [0.0]).drawables["screws", "j", "axis-shaft"]
    assert np.linalg.norm(shaft.transform[:3, 2]) == pytest.approx(0.43 * scale, rel=0.1)


def test_a_robot_without_joints_or_size() -> None:
    model = Model.of(urdfs.load('<robot name="r"><link name="base"/></robot>'), Looks(()), {})
    built = scene.build(model, [])
    assert all(np.isfinite(drawable.transform).all() for drawable in built.drawables.values())
    json.loads(json_in_script(document.document(model, prepare.begin(model))))


def test_traces_and_clouds_are_tip_positions(model: Model) -> None:
    q = samples(model.robot, 1, model.size, seed=4)[0]
    trail = scene.trail(model, q)
    ends = ps.PoE(model.robot).fk(np.stack([model.robot.neutral, q]), model.tip)[:, :3, 3]
    assert np.allclose(trail[[0, -1]], ends, rtol=0, atol=1e-12 * max(1.0, model.robot.reach))
    assert scene.cloud(model).shape == (scene.CLOUD, 3)


def test_every_drawable_belongs_to_a_known_group(model: Model) -> None:
    built = scene.build(model, model.robot.neutral)
    assert {path[0] for path in built.drawables} <= set(GROUPS)
    assert all(drawable.path == path for path, drawable in built.drawables.items())
