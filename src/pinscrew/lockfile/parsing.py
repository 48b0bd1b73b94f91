"""The text of a lock file as its content: everything checked, nothing taken on trust."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NoReturn

import numpy as np

from pinscrew.changes.gates import GATES
from pinscrew.description.model import JOINT_TYPES, SCALAR_TYPES, JointType, Limits, Mimic, read_only
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.typing import FloatArray
from pinscrew.lockfile.content import SCHEMA, LockContent, LockedJoint
from pinscrew.robot.robot import FLOATING_JOINT, UNIVERSE

__all__ = ["parse"]

RIGID: Final = 1e-9
"""How far a pose may be from a rigid one, and a screw from the axis of its joint, for its size."""
_REMEDY: Final = "write it anew with pinscrew lock and the robot's file"
_CONFLICT: Final = re.compile(r"^(<{7}|>{7}) ", re.MULTILINE)
_LIMITS: Final = ("lower", "upper", "velocity", "effort")


class _At:
    """A value in a lock, and where it stands, for messages."""

    def __init__(self, value: Any, place: str, file: Path) -> None:
        self.value = value
        self.place = place
        self.file = file

    def refuse(self, what: str) -> NoReturn:
        """Raise what is wrong with it."""
        raise DescriptionError("lock-content", what, file=self.file, element=self.place, remedy=_REMEDY)

    def keys(self, required: tuple[str, ...], optional: tuple[str, ...] = ()) -> dict[str, _At]:
        """The values of an object with these keys and no others."""
        if not isinstance(self.value, dict):
            self.refuse("is no object")
        for key in required:
            if key not in self.value:
                self.refuse(f"has no {key!r}")
        for key in self.value:
            if key not in required + optional:
                self.refuse(f"has {key!r}, which no lock has there")
        return {key: _At(value, f"{self.place}.{key}", self.file) for key, value in self.value.items()}

    def items(self) -> list[_At]:
        """The values of a list."""
        if not isinstance(self.value, list):
            self.refuse("is no list")
        return [_At(value, f"{self.place}[{i}]", self.file) for i, value in enumerate(self.value)]

    def string(self) -> str:
        """Text that is not empty."""
        if not isinstance(self.value, str) or not self.value:
            self.refuse(f"is {_shown(self.value)}, and not a text")
        return self.value

    def number(self) -> float:
        """A finite number."""
        if not isinstance(self.value, float) or not math.isfinite(self.value):
            self.refuse(f"is {_shown(self.value)}, and not a finite number")
        return self.value

    def vector(self, size: int) -> FloatArray:
        """Finite numbers, shape (size,)."""
        items = self.items()
        if len(items) != size:
            self.refuse(f"has {len(items)} numbers, and not {size}")
        return read_only(np.array([item.number() for item in items]))


def parse(text: str, file: Path) -> LockContent:
    """What the text of a lock file holds.

    Args:
        text: the text.
        file: what to call it in messages.

    Raises:
        DescriptionError: if it is not a whole lock of this version, holds what no robot has, or does not have the hash
            that it states.
    """
    data = _json(text, file)
    stated = data.get("schema") if isinstance(data, dict) else None
    if stated != SCHEMA:
        what = f"its schema is {_shown(stated)}, and not {SCHEMA!r}"
        raise DescriptionError("lock-schema", what, file=file, remedy=_REMEDY)
    keys = ("schema", "robot", "source", "hash", "base", "joints")
    top = _At(data, "the lock", file).keys(keys, ("arguments", "floating_base", "tip", "fail_on"))
    base = top["base"].string()
    joints: dict[str, LockedJoint] = {}
    links = {base}
    for item in top["joints"].items():
        joint = _joint(item, links, joints)
        joints[joint.name] = joint
        links.add(joint.child)
    _check_mimics(joints, top["joints"])
    content = LockContent(
        robot=top["robot"].string(),
        source=_source(top["source"]),
        base=base,
        joints=tuple(joints.values()),
        arguments=_arguments(top.get("arguments")),
        floating_base=_floating(top.get("floating_base"), joints),
        tip=_tip(top.get("tip"), links),
        fail_on=_fail_on(top.get("fail_on")),
    )
    if top["hash"].string() != content.hash:
        what = "its hash is not that of its content, so it was edited or merged by hand"
        raise DescriptionError("lock-edited", what, file=file, remedy=_REMEDY)
    return content


def _json(text: str, file: Path) -> Any:
    """The JSON text, all numbers as floats."""
    conflict = _CONFLICT.search(text)
    if conflict is not None:
        line = text.count("\n", 0, conflict.start()) + 1
        what = "it has the marks of a merge conflict"
        raise DescriptionError("lock-syntax", what, file=file, line=line, remedy=_REMEDY)
    try:
        return json.loads(text, parse_int=float, parse_constant=_no_constant, object_pairs_hook=_without_doubles)
    except json.JSONDecodeError as error:
        what, line = f"it is no whole JSON ({error.msg})", error.lineno
        raise DescriptionError("lock-syntax", what, file=file, line=line, remedy=_REMEDY) from None
    except (ValueError, RecursionError) as error:
        raise DescriptionError("lock-syntax", f"it is no such JSON ({error})", file=file, remedy=_REMEDY) from None


def _no_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(pairs)
    if len(values) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"{next(name for name in names if names.count(name) > 1)!r} is there twice")
    return values


def _source(at: _At) -> str:
    source = at.string()
    if source.startswith("/") or "\0" in source:
        at.refuse(f"is {source!r}, and not a path relative to the lock")
    return source


def _arguments(at: _At | None) -> Mapping[str, str]:
    if at is None:
        return {}
    if not isinstance(at.value, dict):
        at.refuse("is no object")
    for name, value in at.value.items():
        if not isinstance(value, str):
            at.refuse(f"has the value {_shown(value)} for {name!r}, and not a text")
    return dict(at.value)


def _floating(at: _At | None, joints: Mapping[str, LockedJoint]) -> bool:
    if at is None:
        return False
    if at.value is not True:
        at.refuse(f"is {_shown(at.value)}, and not true")
    first = next(iter(joints.values()), None)
    if first is None or (first.name, first.parent, first.type) != (FLOATING_JOINT, UNIVERSE, "floating"):
        at.refuse(f"is true, but the first joint is no floating {FLOATING_JOINT!r} from {UNIVERSE!r}")
    return True


def _tip(at: _At | None, links: set[str]) -> str | None:
    if at is None:
        return None
    if at.string() not in links:
        at.refuse(f"is {at.value!r}, which is no link")
    return at.string()


def _fail_on(at: _At | None) -> frozenset[str] | None:
    if at is None:
        return None
    names = [item.string() for item in at.items()]
    for name in names:
        if name not in GATES:
            at.refuse(f"has {name!r}, and not what can be failed on: {', '.join(GATES)}")
    return frozenset(names)


def _joint(at: _At, links: set[str], above: Mapping[str, LockedJoint]) -> LockedJoint:
    """A joint whose parent is among the links so far, and whose child is not."""
    parts = at.keys(("name", "type", "parent", "child", "home"), ("screw", "limits", "mimic"))
    name, kind = parts["name"].string(), _type(parts["type"])
    at.place = f"joint {name!r}"
    for key, part in parts.items():
        part.place = f"{at.place}: {key}"
    parent, child = parts["parent"].string(), parts["child"].string()
    if name in above:
        parts["name"].refuse("is there twice")
    if parent not in links:
        parts["parent"].refuse(f"is {parent!r}, to which no joint before it leads")
    if child in links:
        parts["child"].refuse(f"is {child!r}, to which another joint leads")
    home = _pose(parts["home"])
    if kind not in SCALAR_TYPES:
        for key in ("screw", "limits", "mimic"):
            if key in parts:
                parts[key].refuse(f"is nothing that a {kind} joint has")
        return LockedJoint(name, kind, parent, child, home)
    for key in ("screw", "limits"):
        if key not in parts:
            at.refuse(f"has no {key!r}")
    screw = _screw(parts["screw"], kind, home)
    mimic = _mimic(parts["mimic"]) if "mimic" in parts else None
    return LockedJoint(name, kind, parent, child, home, screw, _limits(parts["limits"]), mimic)


def _type(at: _At) -> JointType:
    known = next((kind for kind in JOINT_TYPES if kind == at.value), None)
    if known is None:
        at.refuse(f"is {_shown(at.value)}, and not one of {', '.join(JOINT_TYPES)}")
    return known


def _pose(at: _At) -> FloatArray:
    rows = at.items()
    if len(rows) != 4:
        at.refuse(f"has {len(rows)} rows, and not 4")
    pose = read_only(np.stack([row.vector(4) for row in rows]))
    R = pose[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        defect = float(abs(R.T @ R - np.eye(3)).max())
        proper = bool(np.linalg.det(R) > 0.0)
    # A comparison with NaN is false, so the good ones are asked for.
    if not (defect <= RIGID and proper and pose[3].tolist() == [0.0, 0.0, 0.0, 1.0]):
        at.refuse("is no rigid pose")
    return pose


def _screw(at: _At, kind: JointType, home: FloatArray) -> FloatArray:
    """A unit screw that goes through the child's frame: a line without pitch, or a direction."""
    screw = at.vector(6)
    v, omega = screw[:3], screw[3:]
    direction, wanted = (v, np.zeros(3)) if kind == "prismatic" else (omega, np.cross(home[:3, 3], omega))
    rest = omega if kind == "prismatic" else v
    with np.errstate(over="ignore", invalid="ignore"):
        unit = abs(float(direction @ direction) - 1.0) <= RIGID
        fits = float(abs(rest - wanted).max()) <= RIGID * max(1.0, float(abs(home[:3, 3]).max()))
    if not (unit and fits):
        at.refuse(f"is no screw axis (v, ω) of a {kind} joint at this pose")
    return screw


def _limits(at: _At) -> Limits:
    parts = at.keys(_LIMITS)
    lower, upper, velocity, effort = (
        absent if parts[key].value is None else parts[key].number()
        for key, absent in zip(_LIMITS, (-math.inf, math.inf, math.inf, math.inf), strict=True)
    )
    if lower > upper:
        at.refuse(f"has the lower limit {lower:g} above the upper one, {upper:g}")
    return Limits(lower, upper, velocity, effort)


def _mimic(at: _At) -> Mimic:
    parts = at.keys(("joint", "multiplier", "offset"))
    return Mimic(parts["joint"].string(), parts["multiplier"].number(), parts["offset"].number())


def _check_mimics(joints: Mapping[str, LockedJoint], at: _At) -> None:
    """Every joint that mimics leads, over others, to one that does not."""
    for joint in joints.values():
        seen, mimic = {joint.name}, joint.mimic
        while mimic is not None:
            master = joints.get(mimic.joint)
            if master is None or master.screw is None:
                at.refuse(f"have {joint.name!r} mimic {mimic.joint!r}, which is no joint with a single value")
            if master.name in seen:
                at.refuse(f"have {joint.name!r} mimic itself")
            seen.add(master.name)
            mimic = master.mimic


def _shown(value: Any) -> str:
    """A value of JSON in a message."""
    return repr(value) if isinstance(value, str) else json.dumps(value)
