"""`diff`: what changed between two robots."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

from pinscrew.changes.attributes import attributes, driven, opposite, renames
from pinscrew.changes.changes import Changes
from pinscrew.changes.distance import columns, largest
from pinscrew.changes.gates import gates
from pinscrew.changes.geometry import Features, Poses, link_steps
from pinscrew.changes.matching import Matching, match
from pinscrew.changes.outcome import Change, Displacement, Near
from pinscrew.changes.placement import placement
from pinscrew.changes.walk import walk
from pinscrew.changes.wording import degrees, millimetres
from pinscrew.ground.errors import InputError
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import Robot

__all__ = ["TOLERANCE", "diff"]

TOLERANCE: Final = 1e-9
"""Metres, and radians, that count as no change unless told otherwise."""
ROUNDING: Final = 1e-11
"""Radians, and metres per metre of the robot's size, within which two computed poses are the same."""


def diff(
    a: RobotLike, b: RobotLike, *, length: float = TOLERANCE, angle: float = TOLERANCE, fail_on: Iterable[str] = ()
) -> Changes:
    """What an edit changed: from robot ``a`` to robot ``b``.

    Two robots are the same if joints of one name (or, where names changed, of one place in the tree) have the same
    screws and are driven by the same coordinates within the same limits, and the leaf frames have the same home
    poses. Origins slid along axes, frames chosen anew, names, order and format are notes. An edit of a joint moves
    everything below it; only that joint is named.

    Args:
        a: the robot before: a robot, or a name or path that `load` takes.
        b: likewise the robot after.
        length: largest displacement of an axis or tip frame, or change of a limit, that counts as none (m).
        angle: likewise largest angle (rad).
        fail_on: what of the notes is to fail `Changes.passes`, such as ``["names", "velocity"]``; docs/diff.md lists
            them.

    Raises:
        InputError: if a tolerance is negative or not finite, or there is no such thing to fail on.
    """
    a, b = robot_of(a), robot_of(b)
    for name, value in (("length", length), ("angle", angle)):
        if not 0.0 <= value < math.inf:
            raise InputError("tolerance", f"{name} = {value} is no tolerance", remedy="give 0 or a positive number")
    near = Near(length, angle)
    matching = match(a.description, b.description)
    poses_a, poses_b = Poses(a.description), Poses(b.description)
    drives = driven(a), driven(b)
    leaves = frozenset(a.description.leaves), frozenset(b.description.leaves)
    tips = [
        (x, y, index)
        for x, y, index in link_steps(a.description, b.description, matching)
        if x in leaves[0] or y in leaves[1]
    ]
    either = {
        i
        for i, step in enumerate(matching.steps)
        if step.a and step.b and opposite(drives[0].get(step.a.name), drives[1].get(step.b.name), near.of(step.b))
    }
    features = Features(poses_a, poses_b, matching.steps, tips, either, near)
    changes: list[Change] = []
    notes: list[Change] = []
    for step, met in zip(matching.steps, walk(matching.steps, poses_a, poses_b, features), strict=True):
        placed = placement(step, met, poses_a, poses_b, leaves, near)
        if step.a and step.b:
            more = attributes(step, placed, matching.joints, drives, near)
            names = renames(step, a.description, b.description)
            changes += [*names[0], *more[0]]
            notes += [*names[1], *more[1]]
        else:
            changes += placed.changes
            notes += placed.notes
    notes += _whole(a, b, matching)
    places = columns(a, b, matching.joints)
    common = [(x, y) for x, y, _ in tips]
    displacement = None if places is None else largest(a, b, places, common)
    computed = Near(max(length, ROUNDING * max(poses_a.size, poses_b.size)), max(angle, ROUNDING))
    if not changes and displacement is not None:
        changes += _together(displacement, computed)
    return Changes(
        a.name, b.name, tuple(changes), tuple(notes), displacement, b.description.file, gates(fail_on), computed
    )


def _together(displacement: Displacement, near: Near) -> list[Change]:
    """The change of a tip that moved by more than the tolerance although each joint keeps within it.

    A joint that turned by 0.015 rad, with 0.02 allowed, carries a tip 1 m away by 15 mm; many small ones add up.
    """
    if displacement.length <= near.length and displacement.angle <= near.angle:
        return []
    far = displacement.length > near.length
    tip = (displacement.length_at if far else displacement.angle_at).frame
    size_of = millimetres(displacement.length) if far else degrees(displacement.angle)
    words = f"tip frame {tip!r} is displaced by up to {size_of}, though no joint on its own is beyond the tolerance"
    return [Change("tip-moved", "", tip, words, displacement.length, displacement.angle)]


def _whole(a: Robot, b: Robot, matching: Matching) -> list[Change]:
    """Notes about the robot as a whole: its name, its base and the order of its coordinates."""
    notes = []
    if a.description.name != b.description.name:
        words = f"the robot is called {b.description.name!r} instead of {a.description.name!r}"
        notes.append(Change("robot-renamed", "", "", words))
    if a.base != b.base and a.base not in b.description.links:
        notes.append(Change("link-renamed", "", b.base, f"the base link {b.base!r} was called {a.base!r}"))
    order = [matching.joints.get(name) for name in a.joint_names]
    if order != list(b.joint_names) and set(order) == set(b.joint_names):
        moved = [now for before, now in zip(order, b.joint_names, strict=True) if before != now]
        words = f"the coordinates of {', '.join(map(repr, moved))} have other places in q"
        notes.append(Change("order", "", "", words))
    return notes
