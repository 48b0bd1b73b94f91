"""Edits of real robots, with what a diff has to say about each."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from xml.etree import ElementTree as ET

import numpy as np
from diff_edits import Edited, pose, turn

MICRO = 1e-6


@dataclass(frozen=True)
class Row:
    """An edit.

    Attributes:
        robot: a URDF of example-robot-data.
        edit: what is done to it.
        kinds: of all notes where the motion is the same, else of all changes.
        joints: the joints that changes must name, and no others.
        length, angle: what the one change must give (m, rad), where that is known.
        names: b's names of joints and links by those in a, where they differ.
        moves: whether Pinocchio must see the tips move; limits and new joints move none.
    """

    robot: str
    edit: Callable[[Edited], None]
    kinds: set[str]
    joints: set[str] = field(default_factory=set)
    length: float | None = None
    angle: float | None = None
    names: Callable[[str], str] = str
    moves: bool = True


# ---------------------------------------------------------------------------------------- the motion is the same


def slid(joint: str, far: float) -> Callable[[Edited], None]:
    return lambda e: e.reexpress(joint, pose(far * e.axis(joint)))


def reexpressed(joint: str, *, shift: float = 0.0, free: bool = False) -> Callable[[Edited], None]:
    """A joint's frame turned anyhow and slid along its axis; with ``free`` moved anyhow, too."""

    def edit(e: Edited) -> None:
        R = turn("x", 0.4) @ turn("y", -1.1) @ turn("z", 2.0)
        e.reexpress(joint, pose((0.02, -0.03, 0.05) if free else shift * e.axis(joint), R))

    return edit


def relinked(old: str, new: str) -> Callable[[Edited], None]:
    return lambda e: e.rename_link(old, new)


def rejointed(old: str, new: str) -> Callable[[Edited], None]:
    return lambda e: e.rename_joint(old, new)


def prefixed(e: Edited) -> None:
    for element in e.root.findall("joint"):
        e.rename_joint(element.get("name", ""), f"left/{element.get('name')}")
    for element in e.root.findall("link"):
        e.rename_link(element.get("name", ""), f"left/{element.get('name')}")


def backwards(e: Edited) -> None:
    e.root[:] = reversed(e.root[:])


def longer_axis(joint: str) -> Callable[[Edited], None]:
    return lambda e: e.set_axis(joint, 3.0 * e.axis(joint))


def other_rpy(e: Edited) -> None:
    for origin in e.root.iter("origin"):
        r, p, y = (float(x) for x in origin.get("rpy", "0 0 0").split())
        origin.set("rpy", f"{r + np.pi!r} {np.pi - p!r} {y + np.pi!r}")


def reformatted(e: Edited) -> None:
    ET.indent(e.root, "\t\t")
    e.root.insert(0, ET.Comment(" edited "))
    for element in e.root.iter("origin"):
        element.set("xyz", "  ".join(f"{float(x):+.20e}" for x in element.get("xyz", "0 0 0").split()))


def visual(link: str) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        (element,) = (x for x in e.root.findall("link") if x.get("name") == link)
        ET.SubElement(ET.SubElement(ET.SubElement(element, "visual"), "geometry"), "sphere", radius="0.1")

    return edit


def camera(link: str) -> Callable[[Edited], None]:
    return lambda e: e.attach("camera_joint", "fixed", link, "camera", pose((0.1, 0.2, 0.3), turn("x", 1.0)))


def inserted_without_moving(above: str) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        X = pose((0.01, 0.02, 0.03), turn("z", 0.7))
        e.insert("bracket", "fixed", above, X)
        e.set_origin(above, np.linalg.inv(X) @ e.origin(above))

    return edit


def on_world(e: Edited) -> None:
    (root,) = {x.get("name") for x in e.root.findall("link")} - {x.get("link") for x in e.root.findall("joint/child")}
    e.attach("world_joint", "fixed", "the_world", str(root), pose())
    e.root.find("link[last()]").set("name", "the_world")  # type: ignore[union-attr]


def taken_out(joint: str) -> Callable[[Edited], None]:
    return lambda e: e.remove(joint)


def rates(joint: str) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        limit = e.joint(joint).find("limit")
        assert limit is not None
        limit.set("effort", "12345")
        limit.set("velocity", "0.0625")

    return edit


def folded_offset(joint: str, offset: float, *, sliding: bool = False) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        axis = e.axis(joint)
        e.move(joint, pose(offset * axis) if sliding else pose(R=turn(axis, offset)))
        e.mimic(joint).set("offset", repr(-offset))

    return edit


def opposite_mimic(joint: str) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        e.set_axis(joint, -e.axis(joint))
        e.mimic(joint).set("multiplier", repr(-float(e.mimic(joint).get("multiplier", "1"))))

    return edit


def by_another(joint: str, other: str) -> Callable[[Edited], None]:
    """Let a joint mimic another of the same master, instead of the master."""

    def edit(e: Edited) -> None:
        mine, its = (float(e.mimic(name).get("multiplier", "1")) for name in (joint, other))
        e.mimic(joint).set("joint", other)
        e.mimic(joint).set("multiplier", repr(mine / its))

    return edit


def in_turn(*edits: Callable[[Edited], None]) -> Callable[[Edited], None]:
    def edit(e: Edited) -> None:
        for one in edits:
            one(e)

    return edit


def prefix(name: str) -> str:
    return f"left/{name}"


SAME = {
    "slid 1 mm": Row("panda", slid("panda_joint4", 1e-3), {"origin-slid"}),
    "slid 0.5 m": Row("ur5_robot", slid("elbow_joint", -0.5), {"origin-slid"}),
    "slid 1 µm": Row("tiago", slid("arm_3_joint", MICRO), {"origin-slid"}),
    "a slide moved anyhow": Row(
        "tiago", lambda e: e.reexpress("torso_lift_joint", pose((0.1, 0.2, 0.3))), {"origin-slid"}
    ),
    "turned frame": Row("panda", reexpressed("panda_joint2"), {"frame-re-expressed"}),
    "turned and slid frame": Row("ur5_robot", reexpressed("wrist_1_joint", shift=0.2), {"frame-re-expressed"}),
    "fixed frame moved": Row("baxter", reexpressed("left_torso_arm_mount", free=True), {"frame-re-expressed"}),
    "two frames": Row(
        "talos_left_arm",
        in_turn(reexpressed("arm_left_3_joint", shift=0.1), reexpressed("arm_left_4_joint", shift=-0.1)),
        {"frame-re-expressed"},
    ),
    "every frame": Row(
        "z1", in_turn(*(reexpressed(f"joint{i}", shift=0.1 * i) for i in range(1, 6))), {"frame-re-expressed"}
    ),
    "link renamed": Row("panda", relinked("panda_link4", "elbow"), {"link-renamed"}),
    "tip renamed": Row(
        "ur5_robot",
        relinked("tool0", "flange"),
        {"link-renamed"},
        names=lambda name: "flange" if name == "tool0" else name,
    ),
    "base renamed": Row("panda", relinked("panda_link0", "base"), {"link-renamed"}),
    "joint renamed": Row(
        "kinova",
        rejointed("j2s6s200_joint_3", "elbow"),
        {"joint-renamed"},
        names=lambda name: "elbow" if name == "j2s6s200_joint_3" else name,
    ),
    "master renamed": Row(
        "panda",
        rejointed("panda_finger_joint1", "grip"),
        {"joint-renamed"},
        names=lambda name: "grip" if name == "panda_finger_joint1" else name,
    ),
    "all renamed": Row("talos_full_v2", prefixed, {"joint-renamed", "link-renamed"}, names=prefix),
    "backwards": Row("romeo_small", backwards, {"order"}),
    "backwards, one chain": Row("ur5_robot", backwards, set()),
    "axis not normalised": Row("panda", longer_axis("panda_joint3"), set()),
    "rpy the other way": Row("xarm7", other_rpy, set()),
    "format": Row("baxter", reformatted, set()),
    "visual": Row("panda", visual("panda_link8"), set()),
    "camera": Row("kinova", camera("j2s6s200_link_3"), {"frame-added"}),
    "camera at the tip": Row("ur5_robot", camera("tool0"), {"frame-added"}),
    "bracket": Row("panda", inserted_without_moving("panda_joint5"), {"frame-added"}),
    "bracket before a fixed joint": Row("panda", inserted_without_moving("panda_hand_joint"), {"frame-added"}),
    "a link less": Row("panda", taken_out("panda_joint8"), {"frame-removed"}),
    "on a world": Row("panda", on_world, {"frame-added"}),
    "effort and velocity": Row("xarm7", rates("joint3"), {"velocity", "effort"}),
    "offset folded, sliding": Row(
        "panda", folded_offset("panda_finger_joint2", 0.01, sliding=True), {"mimic-re-expressed"}
    ),
    "offset folded, turning": Row("romeo", folded_offset("LFinger22", 0.3), {"mimic-re-expressed"}),
    "mimic turned round": Row("baxter", opposite_mimic("r_gripper_r_finger_joint"), {"mimic-re-expressed"}),
    "mimic of a mimic": Row(
        "talos_full_v2",
        by_another("gripper_left_fingertip_1_joint", "gripper_left_inner_double_joint"),
        {"mimic-re-expressed"},
    ),
    "robot renamed": Row("panda", lambda e: e.root.set("name", "franka"), {"robot-renamed"}),
    "frame turned, all renamed": Row(
        "xarm7",
        in_turn(reexpressed("joint4", shift=0.1), prefixed),
        {"joint-renamed", "link-renamed", "frame-re-expressed"},
        names=prefix,
    ),
}

# ---------------------------------------------------------------------------------------- the motion changed


def axis_turned(joint: str, angle: float) -> Callable[[Edited], None]:
    return lambda e: e.set_axis(joint, turn(e.across(joint), angle) @ e.axis(joint))


def origin_turned(joint: str, angle: float) -> Callable[[Edited], None]:
    return lambda e: e.move(joint, pose(R=turn(e.across(joint), angle)))


def origin_moved(joint: str, far: float) -> Callable[[Edited], None]:
    return lambda e: e.move(joint, pose(far * e.across(joint)))


def axis_moved_alone(joint: str, far: float) -> Callable[[Edited], None]:
    return lambda e: e.reexpress(joint, pose(far * e.across(joint)))


def zero_shifted(joint: str, angle: float) -> Callable[[Edited], None]:
    return lambda e: e.move(joint, pose(R=turn(e.axis(joint), angle)))


def moved(joint: str, *shift: float) -> Callable[[Edited], None]:
    return lambda e: e.move(joint, pose(shift))  # type: ignore[arg-type]


def limits(joint: str, lower: float, upper: float) -> Callable[[Edited], None]:
    """Move a joint's limits by so much."""
    return lambda e: e.set_limits(joint, e.limits(joint)[0] + lower, e.limits(joint)[1] + upper)


def mimic(follower: str, **values: str) -> Callable[[Edited], None]:
    return lambda e: e.mimic(follower).attrib.update(values)


def typed(joint: str, kind: str) -> Callable[[Edited], None]:
    return lambda e: e.joint(joint).set("type", kind)


def no_mimic(joint: str) -> Callable[[Edited], None]:
    return lambda e: e.joint(joint).remove(e.mimic(joint))


def names_swapped(one: str, other: str) -> Callable[[Edited], None]:
    return in_turn(rejointed(one, "waits"), rejointed(other, one), rejointed("waits", other))


def rehung(joint: str, link: str) -> Callable[[Edited], None]:
    return lambda e: e._part(joint, "parent").set("link", link)


def ten_times(e: Edited) -> None:
    for joint in e.root.findall("joint"):
        name = joint.get("name", "")
        e.set_origin(name, pose(10.0 * e.origin(name)[:3, 3], e.origin(name)[:3, :3]))


J4, E, J6 = "panda_joint4", "elbow_joint", "j2s6s200_joint_6"
LEFT, TIP1 = "gripper_left_inner_double_joint", "gripper_left_fingertip_1_joint"

CHANGED = {
    "axis turned by 1 µrad": Row("panda", axis_turned(J4, MICRO), {"axis-turned"}, {J4}, 0, MICRO),
    "axis turned by 1°": Row("ur5_robot", axis_turned(E, 0.0175), {"axis-turned"}, {E}, 0, 0.0175),
    "axis x instead of z": Row("kinova", axis_turned(J6, np.pi / 2), {"axis-turned"}, {J6}, 0, np.pi / 2),
    "first axis turned": Row("xarm7", axis_turned("joint1", 1e-3), {"axis-turned"}, {"joint1"}, 0, 1e-3),
    "slide turned": Row(
        "tiago", axis_turned("torso_lift_joint", MICRO), {"axis-turned"}, {"torso_lift_joint"}, 0, MICRO
    ),
    "origin turned by 1 µrad": Row("panda", origin_turned(J4, MICRO), {"axis-turned"}, {J4}, 0, MICRO),
    "origin turned by 2°": Row("z1", origin_turned("joint2", 0.035), {"axis-turned"}, {"joint2"}, 0, 0.035),
    "origin turned in a tree": Row("baxter", origin_turned("left_e0", 0.01), {"axis-turned"}, {"left_e0"}, 0, 0.01),
    "mount turned": Row(
        "baxter",
        lambda e: e.move("right_torso_arm_mount", pose(R=turn("y", 0.01))),
        {"link-moved"},
        {"right_torso_arm_mount"},
        0,
        0.01,
    ),
    "origin moved by 1 µm": Row("panda", origin_moved(J4, MICRO), {"axis-moved"}, {J4}, MICRO, 0),
    "origin moved by 4 mm": Row(
        "ur5_robot", origin_moved("wrist_2_joint", 4e-3), {"axis-moved"}, {"wrist_2_joint"}, 4e-3, 0
    ),
    "origin moved, last joint": Row("kinova", origin_moved(J6, MICRO), {"axis-moved"}, {J6}, MICRO, 0),
    "origin moved in a hand": Row(
        "tiago", origin_moved("hand_ring_flex_2_joint", 1e-4), {"axis-moved"}, {"hand_ring_flex_2_joint"}, 1e-4, 0
    ),
    "origin moved in a leg": Row(
        "romeo_small", origin_moved("LKneePitch", 0.01), {"axis-moved"}, {"LKneePitch"}, 0.01, 0
    ),
    "origin moved askew": Row("ur5_robot", moved(E, 0.003, 0.0, 0.004), {"axis-moved"}, {E}, 0.005, 0),
    "axis moved alone by 1 µm": Row("panda", axis_moved_alone(J4, MICRO), {"axis-moved"}, {J4}, MICRO, 0),
    "axis moved alone by 3 mm": Row("ur5_robot", axis_moved_alone(E, 3e-3), {"axis-moved"}, {E}, 3e-3, 0),
    "moved and turned": Row(
        "talos_left_arm",
        in_turn(origin_moved("arm_left_4_joint", 4e-3), origin_turned("arm_left_4_joint", 0.01)),
        {"axis-turned"},
        {"arm_left_4_joint"},
        4e-3,
        0.01,
    ),
    "zero shifted by 1 µrad": Row(
        "panda", zero_shifted("panda_joint7", MICRO), {"zero-shifted"}, {"panda_joint7"}, 0, MICRO
    ),
    "zero shifted by 0.5°": Row(
        "ur5_robot", zero_shifted("shoulder_pan_joint", 0.0087), {"zero-shifted"}, {"shoulder_pan_joint"}, 0, 0.0087
    ),
    "zero of a wheel": Row(
        "tiago", zero_shifted("wheel_left_joint", 0.1), {"zero-shifted"}, {"wheel_left_joint"}, 0, 0.1
    ),
    "zero of a slide": Row(
        "tiago", moved("torso_lift_joint", 0, 0, MICRO), {"zero-shifted"}, {"torso_lift_joint"}, MICRO, 0
    ),
    "slide moved across": Row(
        "tiago", origin_moved("torso_lift_joint", 1e-3), {"link-moved"}, {"torso_lift_joint"}, 1e-3, 0
    ),
    "moved along the axis": Row("panda", moved(J4, 0, 0, 2e-3), {"link-moved"}, {J4}, 2e-3, 0),
    "tip moved along the axis": Row(
        "talos_left_arm", moved("gripper_left_joint", 1e-3, 0, 0), {"tip-moved"}, {"gripper_left_joint"}, 1e-3, 0
    ),
    "tool moved by 1 µm": Row(
        "panda", moved("panda_hand_tcp_joint", 0, 0, MICRO), {"tip-moved"}, {"panda_hand_tcp_joint"}, MICRO, 0
    ),
    "tool turned by 1 µrad": Row(
        "ur5_robot",
        lambda e: e.move("ee_fixed_joint", pose(R=turn("y", MICRO))),
        {"tip-moved"},
        {"ee_fixed_joint"},
        0,
        MICRO,
    ),
    "hand moved": Row("panda", moved("panda_hand_joint", 0, 0, 5e-3), {"link-moved"}, {"panda_hand_joint"}, 5e-3, 0),
    "flange moved": Row("panda", moved("panda_joint8", 0, 1e-3, 0), {"link-moved"}, {"panda_joint8"}, 1e-3, 0),
    "limits widened": Row("panda", limits(J4, -0.1, 0.1), {"limits"}, {J4}, 0, 0.1, moves=False),
    "limits narrowed by 1 µrad": Row(
        "xarm7", limits("joint2", 0, -MICRO), {"limits"}, {"joint2"}, 0, MICRO, moves=False
    ),
    "limits of a slide": Row(
        "tiago", limits("torso_lift_joint", 0, 0.05), {"limits"}, {"torso_lift_joint"}, 0.05, 0, moves=False
    ),
    "limits of a mimic": Row(
        "panda", limits("panda_finger_joint2", 0, 0.01), {"limits"}, {"panda_finger_joint2"}, 0.01, 0, moves=False
    ),
    "multiplier": Row("panda", mimic("panda_finger_joint2", multiplier="0.5"), {"mimic"}, {"panda_finger_joint2"}),
    "multiplier by 1e-6": Row("talos_full_v2", mimic(TIP1, multiplier="-1.000001"), {"mimic"}, {TIP1}),
    "multiplier, others above a tip": Row("talos_full_v2", mimic(LEFT, multiplier="1.1"), {"mimic"}, {LEFT}),
    "multiplier's sign": Row(
        "baxter", mimic("r_gripper_r_finger_joint", multiplier="1"), {"mimic"}, {"r_gripper_r_finger_joint"}
    ),
    "offset by 1 µrad": Row("romeo", mimic("LFinger22", offset="1e-6"), {"mimic"}, {"LFinger22"}, 0, MICRO),
    "offset of a slide": Row(
        "panda", mimic("panda_finger_joint2", offset="0.002"), {"mimic"}, {"panda_finger_joint2"}, 0.002, 0
    ),
    "other master": Row("romeo", mimic("LFinger22", joint="RHand"), {"mimic"}, {"LFinger22"}),
    "mimic no more": Row("panda", no_mimic("panda_finger_joint2"), {"mimic"}, {"panda_finger_joint2"}, moves=False),
    "mimic now": Row("ur5_robot", mimic("wrist_2_joint", joint=E), {"mimic"}, {"wrist_2_joint"}, moves=False),
    "continuous": Row("ur5_robot", typed("wrist_3_joint", "continuous"), {"type"}, {"wrist_3_joint"}, moves=False),
    "prismatic": Row("panda", typed(J4, "prismatic"), {"type"}, {J4}),
    "fixed": Row("kinova", typed(J6, "fixed"), {"type"}, {J6}, moves=False),
    "no longer fixed": Row(
        "panda",
        in_turn(
            typed("panda_hand_joint", "revolute"), limits("panda_hand_joint", -1.0, 1.0), rates("panda_hand_joint")
        ),
        {"type"},
        {"panda_hand_joint"},
        moves=False,
    ),
    "turned round": Row("panda", lambda e: e.reverse(J4), {"axis-reversed", "limits"}, {J4}),
    "turned round, no limits": Row("kinova", lambda e: e.set_axis(J6, -e.axis(J6)), {"axis-reversed"}, {J6}),
    "names swapped": Row(
        "panda", names_swapped("panda_joint2", "panda_joint4"), {"names-swapped"}, {"panda_joint2", J4}
    ),
    "joint taken out": Row("xarm7", taken_out("joint4"), {"joint-removed"}, {"joint4"}, moves=False),
    "joint put in": Row(
        "panda", lambda e: e.insert("extra", "revolute", J4, pose()), {"joint-added"}, {"extra"}, moves=False
    ),
    "joint put in, and all moved": Row(
        "panda",
        lambda e: e.insert("extra", "prismatic", J4, pose((0, 0, 0.1))),
        {"joint-added"},
        {"extra"},
        0.1,
        0,
        moves=False,
    ),
    "joint at the tip": Row(
        "ur5_robot",
        lambda e: e.attach("grip", "prismatic", "tool0", "finger", pose()),
        {"joint-added"},
        {"grip"},
        moves=False,
    ),
    "spacer": Row(
        "panda",
        lambda e: e.insert("spacer", "fixed", "panda_hand_joint", pose((0, 0, 0.01))),
        {"joint-added"},
        {"spacer"},
        0.01,
        0,
    ),
    "tip taken away": Row(
        "ur5_robot",
        taken_out("wrist_3_link-tool0_fixed_joint"),
        {"tip-removed"},
        {"wrist_3_link-tool0_fixed_joint"},
        moves=False,
    ),
    "hung elsewhere": Row("tiago", rehung("head_2_joint", "arm_1_link"), {"parent"}, {"head_2_joint"}),
    "10 m, axis turned by 1 µrad": Row("panda", axis_turned(J4, MICRO), {"axis-turned"}, {J4}, 0, MICRO),
    "10 m, origin moved by 1 µm": Row(
        "panda", origin_moved("panda_joint2", MICRO), {"axis-moved"}, {"panda_joint2"}, MICRO, 0
    ),
    "10 m, zero shifted by 1 µrad": Row("ur5_robot", zero_shifted(E, MICRO), {"zero-shifted"}, {E}, 0, MICRO),
    "two joints": Row(
        "panda",
        in_turn(origin_moved("panda_joint2", 1e-3), axis_turned("panda_joint6", 1e-3)),
        {"axis-moved", "axis-turned"},
        {"panda_joint2", "panda_joint6"},
    ),
    "two joints in a row": Row(
        "panda",
        in_turn(origin_moved("panda_joint3", 1e-3), moved(J4, 2e-3, 0, 0)),
        {"axis-moved"},
        {"panda_joint3", J4},
    ),
    "both arms": Row(
        "baxter",
        in_turn(zero_shifted("left_s1", 1e-3), origin_moved("right_w1", 1e-3)),
        {"zero-shifted", "axis-moved"},
        {"left_s1", "right_w1"},
    ),
    "chosen anew and moved": Row(
        "panda", in_turn(reexpressed(J4, shift=0.1), axis_turned(J4, 0.01)), {"axis-turned"}, {J4}, None, 0.01
    ),
    "chosen anew above": Row(
        "ur5_robot",
        in_turn(reexpressed("shoulder_lift_joint", shift=0.1), moved("wrist_3_link-tool0_fixed_joint", 0, 0, 1e-3)),
        {"tip-moved"},
        {"wrist_3_link-tool0_fixed_joint"},
        1e-3,
        0,
    ),
    "all renamed, one moved": Row(
        "xarm7", in_turn(origin_moved("joint4", 1e-3), prefixed), {"axis-moved"}, {"left/joint4"}, 1e-3, 0, names=prefix
    ),
    "frame re-expressed as it moves": Row(
        "panda",
        in_turn(reexpressed(J4, shift=0.02), lambda e: e.move(J4, pose((0, 0, 0), turn(e.axis(J4), 0.01)))),
        {"zero-shifted"},
        {J4},
        0,
        0.01,
    ),
}


def scaled(name: str) -> bool:
    """Whether a row's robot is ten times as large."""
    return re.match("10 m", name) is not None
