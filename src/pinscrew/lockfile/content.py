"""What a lock file holds, and how it is laid out: JSON by hand, a line for each row, screw, limit and mimic."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from pinscrew.description.model import JointType, Limits, Mimic
from pinscrew.ground.escaping import json_text
from pinscrew.ground.typing import FloatArray

__all__ = ["SCHEMA", "LockContent", "LockedJoint"]

SCHEMA: Final = "pinscrew.lock/1"


@dataclass(frozen=True, slots=True)
class LockedJoint:
    """A joint in a lock.

    Attributes:
        name: its name.
        type: its type.
        parent: the link above.
        child: the link below.
        home: pose of the child link in the base frame at `Robot.neutral`, rounded, shape (4, 4).
        screw: its spatial screw axis (v, ω) there, rounded, shape (6,); None for fixed, planar and floating joints,
            whose pose says everything.
        limits: as the file states them; None where there is no screw.
        mimic: None where it has a coordinate of its own.
    """

    name: str
    type: JointType
    parent: str
    child: str
    home: FloatArray
    screw: FloatArray | None = None
    limits: Limits | None = None
    mimic: Mimic | None = None


@dataclass(frozen=True, slots=True)
class LockContent:
    """A lock: the mechanism, and what it was made from.

    Attributes:
        robot: the robot's name in its file.
        source: the robot's file, relative to the lock's folder, with forward slashes.
        arguments: the xacro arguments that were given.
        floating_base: whether the root link was made to float.
        tip: the default tip, where one was named.
        base: the base link.
        joints: all joints in tree order.
        fail_on: what of the notes fails its check; None where the lock does not say.
    """

    robot: str
    source: str
    base: str
    joints: tuple[LockedJoint, ...]
    arguments: Mapping[str, str] = field(default_factory=dict)
    floating_base: bool = False
    tip: str | None = None
    fail_on: frozenset[str] | None = None

    @property
    def hash(self) -> str:
        """``sha256:…`` of the schema and the mechanism as it is laid out: base and joints."""
        canonical = f"{SCHEMA}\n{self._mechanism()}"
        return f"sha256:{hashlib.sha256(canonical.encode('utf-8', 'surrogatepass')).hexdigest()}"

    def text(self) -> str:
        """The lock file."""
        heading = [("schema", SCHEMA), ("robot", self.robot), ("source", self.source)]
        lines = [f'  "{key}": {_string(value)},' for key, value in heading]
        if self.arguments:
            pairs = (f"    {_string(name)}: {_string(value)}" for name, value in sorted(self.arguments.items()))
            lines.append('  "arguments": {\n' + ",\n".join(pairs) + "\n  },")
        if self.floating_base:
            lines.append('  "floating_base": true,')
        if self.tip is not None:
            lines.append(f'  "tip": {_string(self.tip)},')
        if self.fail_on is not None:
            lines.append(f'  "fail_on": [{", ".join(map(_string, sorted(self.fail_on)))}],')
        lines.append(f'  "hash": "{self.hash}",')
        return "\n".join(("{", *lines, self._mechanism(), "}", ""))

    def _mechanism(self) -> str:
        joints = ",\n".join("    {\n" + ",\n".join(_joint(joint)) + "\n    }" for joint in self.joints)
        return f'  "base": {_string(self.base)},\n  "joints": ' + (f"[\n{joints}\n  ]" if joints else "[]")


def _joint(joint: LockedJoint) -> Iterator[str]:
    for key in ("name", "type", "parent", "child"):
        yield f'      "{key}": {_string(getattr(joint, key))}'
    rows = ",\n".join(f"        {_vector(row)}" for row in joint.home)
    yield f'      "home": [\n{rows}\n      ]'
    if joint.screw is not None:
        yield f'      "screw": {_vector(joint.screw)}'
    if joint.limits is not None:
        limits = joint.limits
        values = {"lower": limits.lower, "upper": limits.upper, "velocity": limits.velocity, "effort": limits.effort}
        yield '      "limits": {' + ", ".join(f'"{key}": {_number(value)}' for key, value in values.items()) + "}"
    if joint.mimic is not None:
        mimic = joint.mimic
        factors = f'"multiplier": {_number(mimic.multiplier)}, "offset": {_number(mimic.offset)}'
        yield f'      "mimic": {{"joint": {_string(mimic.joint)}, {factors}}}'


def _string(text: str) -> str:
    """The text as JSON has it; bytes of a file's name that are no UTF-8 as escapes."""
    return json_text(text)


def _number(value: float) -> str:
    """The fewest digits that are this number, zero without a sign, infinity as null."""
    return repr(float(value) + 0.0).removesuffix(".0") if math.isfinite(value) else "null"


def _vector(values: FloatArray) -> str:
    return f"[{', '.join(map(_number, values.tolist()))}]"
