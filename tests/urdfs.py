"""Small robots as URDF text, each with one thing that engines get wrong, and random trees of all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from hypothesis import strategies as st

from pinscrew.description import urdf
from pinscrew.ground.typing import FloatArray
from pinscrew.robot.robot import Robot

SCALAR: Final = ("revolute", "continuous", "prismatic")


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    *,
    xyz: str = "0 0 0",
    rpy: str = "0 0 0",
    axis: str = "0 0 1",
    limits: tuple[float, float] = (-2.0, 2.0),
    mimic: tuple[str, float, float] | None = None,
) -> str:
    """A ``<joint>``; ``mimic`` is the joint to follow, the multiplier and the offset."""
    parts = [f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/>']
    if kind not in ("fixed", "floating"):
        parts.append(f'<axis xyz="{axis}"/>')
    if kind in ("revolute", "prismatic"):
        parts.append(f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="1" velocity="1"/>')
    if mimic:
        parts.append(f'<mimic joint="{mimic[0]}" multiplier="{mimic[1]}" offset="{mimic[2]}"/>')
    return f'<joint name="{name}" type="{kind}">{"".join(parts)}</joint>'


def robot(*joints: str, links: str) -> str:
    """A ``<robot>`` with these links, named in one string."""
    elements = [f'<link name="{link}"/>' for link in links.split()]
    return f'<robot name="small">{"".join(elements)}{"".join(joints)}</robot>'


def load(text: str, *, tip: str | None = None, floating_base: bool = False) -> Robot:
    """The robot of a text."""
    return Robot.from_description(urdf.parse(text, "small.urdf"), tip=tip, floating_base=floating_base)


def single_revolute() -> str:
    return robot(joint("j", "revolute", "base", "tool", xyz="0.3 -0.2 0.5", axis="0 1 0"), links="base tool")


def prismatic() -> str:
    slide = joint("j", "prismatic", "base", "tool", xyz="0.1 0.2 0.3", rpy="0.4 0 0", axis="0 0.6 -0.8")
    return robot(slide, links="base tool")


def continuous() -> str:
    return robot(
        joint("j", "continuous", "base", "mid", xyz="0.2 0 0", axis="1 0 0"),
        joint("k", "continuous", "mid", "tool", xyz="0 0.5 0", axis="0 0.6 0.8"),
        links="base mid tool",
    )


def tree() -> str:
    """Two arms on a column, one of them with a fixed tip."""
    return robot(
        joint("lift", "prismatic", "base", "column", xyz="0 0 0.1"),
        joint("left", "revolute", "column", "l1", xyz="0 0.2 0.3", axis="1 0 0"),
        joint("left2", "continuous", "l1", "l2", xyz="0 0 0.4", axis="0 1 0"),
        joint("right", "revolute", "column", "r1", xyz="0 -0.2 0.3", axis="-1 0 0"),
        joint("mount", "fixed", "r1", "camera", xyz="0.05 0 0", rpy="0 1.2 0"),
        links="base column l1 l2 r1 camera",
    )


def mimic() -> str:
    return robot(
        joint("j", "revolute", "base", "mid", xyz="0.1 0 0.2", axis="0 1 0"),
        joint("k", "revolute", "mid", "tool", xyz="0.4 0 0", axis="0.6 0 0.8", mimic=("j", -0.75, 0.3)),
        links="base mid tool",
    )


def mimic_chain() -> str:
    """The master comes last in the file and is furthest from the base; a slide mimics a mimic of it."""
    return robot(
        joint("a", "prismatic", "base", "la", axis="1 0 0", mimic=("b", 0.25, -0.1)),
        joint("b", "revolute", "la", "lb", xyz="0.3 0 0", axis="0 1 0", mimic=("c", -2.0, 0.5)),
        joint("c", "revolute", "lb", "tool", xyz="0.2 0.1 0", rpy="0.3 0 0", axis="0 0 1"),
        links="base la lb tool",
    )


def mimic_continuous() -> str:
    """A continuous joint follows a revolute one, and a revolute joint a continuous one."""
    return robot(
        joint("r", "revolute", "base", "l1", xyz="0 0 0.2", axis="0 1 0"),
        joint("c", "continuous", "l1", "l2", xyz="0.2 0 0", axis="0 0 1", mimic=("r", 3.0, 0.2)),
        joint("d", "continuous", "l2", "l3", xyz="0 0.2 0", axis="1 0 0"),
        joint("s", "revolute", "l3", "tool", xyz="0 0 0.2", axis="0 1 0", mimic=("d", 0.5, -1.0)),
        links="base l1 l2 l3 tool",
    )


def planar() -> str:
    return robot(
        joint("arm", "revolute", "base", "mid", xyz="0 0 0.3", rpy="0.2 0.1 0", axis="1 0 0"),
        joint("table", "planar", "mid", "plate", xyz="0.1 0.2 0", rpy="0 0.5 0"),
        joint("wrist", "revolute", "plate", "tool", xyz="0.3 0 0", axis="0 1 0"),
        links="base mid plate tool",
    )


def floating_middle() -> str:
    return robot(
        joint("arm", "revolute", "base", "mid", xyz="0 0 0.3", axis="1 0 0"),
        joint("free", "floating", "mid", "body", xyz="0.1 0.2 0", rpy="0 0.5 0.1"),
        joint("wrist", "prismatic", "body", "tool", xyz="0.3 0 0", axis="0 1 0"),
        links="base mid body tool",
    )


def no_joints() -> str:
    return robot(links="base")


def only_fixed() -> str:
    return robot(joint("f", "fixed", "base", "tool", xyz="0.1 0.2 0.3", rpy="1 2 3"), links="base tool")


def same_names() -> str:
    """Joints and the links below them share names."""
    return robot(
        joint("arm", "revolute", "base", "arm", xyz="0 0 0.3", axis="1 0 0"),
        joint("tool", "fixed", "arm", "tool", xyz="0 0.4 0", rpy="0 0.5 0"),
        links="base arm tool",
    )


def unsorted_siblings() -> str:
    """Pinocchio sorts siblings by name; the file's order is z, a, m."""
    return robot(
        *(
            joint(name, "revolute", "base", f"link_{name}", xyz=f"{x} 0 0", axis=axis)
            for name, x, axis in (("z", 0.1, "1 0 0"), ("a", 0.2, "0 1 0"), ("m", 0.3, "0 0 1"))
        ),
        joint("b", "prismatic", "link_z", "tool", axis="0 1 0"),
        links="base link_m link_z link_a tool",
    )


def rotated() -> str:
    """Origins turned about all axes, through the singular pitch of rpy."""
    return robot(
        joint("j1", "revolute", "base", "l1", xyz="0.1 -0.4 0.2", rpy="0.7 -1.1 2.9", axis="0.6 0 -0.8"),
        joint("turn", "fixed", "l1", "l2", xyz="0.2 0 0.1", rpy="3 1.5707963267948966 -2"),
        joint("j2", "prismatic", "l2", "l3", xyz="0 0.3 0", rpy="-2 0.4 0.3", axis="0 -0.28 0.96"),
        joint("j3", "continuous", "l3", "tool", xyz="0.3 0 0.2", rpy="0 0 -3", axis="0 -1 0"),
        links="base l1 l2 l3 tool",
    )


BUILDERS: Final[tuple[Callable[[], str], ...]] = (
    single_revolute,
    prismatic,
    continuous,
    tree,
    mimic,
    mimic_chain,
    mimic_continuous,
    planar,
    floating_middle,
    no_joints,
    only_fixed,
    same_names,
    unsorted_siblings,
    rotated,
)
ROBOTS: Final[dict[str, str]] = {build.__name__: build() for build in BUILDERS}


def chain(length: int, kind: str = "revolute") -> str:
    """Joints j1, j2, … about z, from link 0 to link ``length``, each 1 m along x from the one before."""
    steps = (joint(f"j{i + 1}", kind, str(i), str(i + 1), xyz="1 0 0") for i in range(length))
    return robot(*steps, links=" ".join(map(str, range(length + 1))))


def sample(robot: Robot, size: int, seed: int = 0) -> tuple[FloatArray, FloatArray]:
    """Coordinates (size, nq), with unit quaternions, and velocities (size, nv)."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-3.0, 3.0, (size, robot.nq))
    for motion in robot.mechanism.motions:
        if motion.joint.type == "floating":
            quaternion = rng.normal(size=(size, 4))
            q[:, motion.q + 3 : motion.q + 7] = quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True)
    return q, rng.uniform(-1.0, 1.0, (size, robot.nv))


AXES: Final = ("1 0 0", "0 1 0", "0 0 -1", "0.6 0.8 0", "-0.28 0 0.96", "0.48 0.6 0.64")


@st.composite
def trees(draw: st.DrawFn) -> str:
    """A random tree of up to 8 joints, written in any order, whose mimics follow any scalar joint."""
    count = draw(st.integers(1, 8))
    kinds = [draw(st.sampled_from((*SCALAR, *SCALAR, "fixed", "planar", "floating"))) for _ in range(count)]
    numbers = st.lists(st.integers(-300, 300), min_size=3, max_size=3)
    scalar: list[str] = []
    joints = []
    for i, kind in enumerate(kinds):
        name = f"j{draw(st.integers(0, 9))}{i}"
        mimic = None
        if kind in SCALAR and scalar and draw(st.booleans()):
            factors = [draw(st.integers(-20, 20)) / 10 for _ in range(2)]
            mimic = (draw(st.sampled_from(scalar)), *factors)
        if kind in SCALAR:
            scalar.append(name)
        xyz, rpy = (" ".join(str(n / 100) for n in draw(numbers)) for _ in range(2))
        axis = "0 0 1" if kind == "planar" else draw(st.sampled_from(AXES))
        parent = f"l{draw(st.integers(0, i))}"
        joints.append(joint(name, kind, parent, f"l{i + 1}", xyz=xyz, rpy=rpy, axis=axis, mimic=mimic))
    links = " ".join(f"l{i}" for i in range(count + 1))
    return robot(*draw(st.permutations(joints)), links=links)
