"""What a file may say in earnest, but rarely means: misspelt kinematics, degrees for radians, millimetres for metres.

URDF has no schema that its readers hold files to, and both parsers pass over what they do not know: ``<orgin>`` is no
origin, ``ryp=`` no rotation, and the robot is another one than its author thinks. Of 903 public files the only elements
in joints that URDF does not know are ``joint_properties``, ``traits``, ``controller_gains`` and ``anchor``; none of
them is like a known one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from pinscrew.description.markup import Element

__all__ = ["Suspicion", "suspicions"]

_JOINT: Final = ("origin", "parent", "child", "axis", "limit", "mimic")
_ELEMENTS: Final[Mapping[str, tuple[str, ...]]] = {
    "robot": ("link", "joint"),
    "joint": _JOINT,
}
"""Kinematic elements, by what they stand in."""
_MEANT: Final = frozenset({"calibration", "dynamics", "safety_controller", "limits", "material", "gazebo"})
"""Words that are other elements' own, though they may be like one of `_ELEMENTS`."""
_ATTRIBUTES: Final[Mapping[str, tuple[str, ...]]] = {
    "joint": ("name", "type"),
    "origin": ("xyz", "rpy", "quat_xyzw"),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "mimic": ("joint", "multiplier", "offset"),
}
"""Attributes that kinematics depends on, by element."""

FAR: Final = 100.0
"""Metres from a joint to the next that are taken for millimetres."""
DEGREES: Final = 15.0
"""Limits in degrees are multiples of it, from 30 to `MOST_DEGREES`; ±10 rad, or ±1e16, are none."""
MOST_DEGREES: Final = 720.0


@dataclass(frozen=True, slots=True)
class Suspicion:
    """Something that looks wrong.

    Attributes:
        code: of the warning.
        element: where it is.
        joint: the joint that it is in, or None.
        words: what it is, and what would be right.
    """

    code: str
    element: Element
    joint: Element | None
    words: str


def suspicions(root: Element) -> Iterator[Suspicion]:
    """All that looks wrong in a file that passed the structural check; numbers once for each kind of mistake."""
    yield from _elements(root, None)
    for link in root.all("link"):
        for joint in link.all("joint"):
            words = "<joint> inside <link>, where it is none; close the link before it"
            yield Suspicion("misspelt", joint, None, words)
    numbers: dict[str, list[Suspicion]] = {}
    for joint in root.all("joint"):
        yield from _elements(joint, joint)
        for element in (joint, *joint.children):
            yield from _attributes(element, joint)
        for suspicion in _numbers(joint):
            numbers.setdefault(suspicion.code, []).append(suspicion)
    for first, *others in numbers.values():
        more = f" (and {len(others)} more like it)" if others else ""
        yield Suspicion(first.code, first.element, first.joint, first.words + more)


def _elements(parent: Element, joint: Element | None) -> Iterator[Suspicion]:
    known = _ELEMENTS[parent.tag]
    for element in parent.children:
        if element.tag not in known and element.tag not in _MEANT and (like := _like(element.tag, known)):
            words = f"<{element.tag}> is nothing in a <{parent.tag}>, and was passed over; did you mean <{like}>?"
            yield Suspicion("misspelt", element, joint, words)


def _attributes(element: Element, joint: Element) -> Iterator[Suspicion]:
    known = _ATTRIBUTES.get(element.tag, ())
    for name in element.attributes:
        if name not in known and (like := _like(name, known)):
            words = f"{name}= is nothing in <{element.tag}>, and was passed over; did you mean {like}=?"
            yield Suspicion("misspelt", element, joint, words)


def _like(word: str, known: Iterable[str]) -> str:
    """The known word that one was meant to be: by capitals, or by one mistake in four letters; ``""`` for none."""
    if ":" in word:
        return ""  # of an extension, in a namespace of its own
    distances = {each: _distance(word.lower(), each) for each in known}
    near = [each for each, distance in distances.items() if distance <= (1 if len(each) <= 5 else 2)]
    return min(near, key=distances.__getitem__, default="")


def _distance(a: str, b: str) -> int:
    """Letters left out, put in, changed or exchanged with the next: optimal string alignment (Damerau, 1964)."""
    if abs(len(a) - len(b)) > 2:
        return 3  # as good as any larger one
    rows = [list(range(len(b) + 1))]
    for i, x in enumerate(a, 1):
        rows.append([i])
        for j, y in enumerate(b, 1):
            step = min(rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + (x != y))
            if i > 1 and j > 1 and (x, a[i - 2]) == (b[j - 2], y):
                step = min(step, rows[i - 2][j - 2] + 1)
            rows[i].append(step)
    return rows[-1][-1]


def _numbers(joint: Element) -> Iterator[Suspicion]:
    for origin in joint.all("origin"):
        turned = max((abs(float(word)) for word in origin.attributes.get("rpy", "0").split()), default=0.0)
        if turned > math.tau:
            words = f"rpy={origin.attributes['rpy']!r} has more than a turn; angles are in radians, not in degrees"
            yield Suspicion("rpy-in-degrees", origin, joint, words)
        far = max((abs(float(word)) for word in origin.attributes.get("xyz", "0").split()), default=0.0)
        if far >= FAR:
            words = f"xyz={origin.attributes['xyz']!r} is {far:g} m away; lengths are in metres, not in millimetres"
            yield Suspicion("far-origin", origin, joint, words)
    if joint.attributes.get("type") != "revolute":
        return
    for limit in joint.all("limit"):
        ends = [float(limit.attributes.get(name, "0")) for name in ("lower", "upper")]
        if any(2.0 * DEGREES <= abs(end) <= MOST_DEGREES and end % DEGREES == 0.0 for end in ends):
            words = f"the limits {ends[0]:g} and {ends[1]:g} are more than a turn; they are in radians, not in degrees"
            yield Suspicion("limits-in-degrees", limit, joint, words)
