"""An MJCF with its includes put in place, and without what moves nothing: what MuJoCo's compiler is given.

Meshes, textures, shapes, masses, actuators and sensors are left out, so that no file but the included ones is opened,
and these are confined as those of xacro. What MuJoCo's schema does not know is left in, for MuJoCo to refuse.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from pinscrew.description import markup
from pinscrew.description.packages import Packages, is_file
from pinscrew.description.structure import MAX_LINKS
from pinscrew.ground import escaping
from pinscrew.ground.errors import DescriptionError, UnsupportedError
from pinscrew.ground.words import brief

__all__ = ["PlainMjcf", "plain"]

MAX_DEPTH: Final = 400
"""Deepest nesting of elements; MuJoCo's own reader of XML takes 500."""

_OTHER_SECTIONS: Final = {
    *("option", "size", "visual", "statistic", "asset", "custom", "contact", "deformable"),
    *("tendon", "actuator", "sensor", "keyframe", "extension"),
}
_IN_DEFAULT: Final = {"default", "joint", "site", "equality"}
_NOT_IN_BODIES: Final = {"geom", "inertial", "camera", "light"}
_UNSUPPORTED: Final = {"composite", "flexcomp", "plugin", "attach"}
"""What makes bodies by rules of its own, or takes them from another model's file."""
_UNUSED: Final = {
    "compiler": "meshdir texturedir assetdir strippath discardvisual balanceinertia settotalmass inertiafromgeom "
    "inertiagrouprange boundmass boundinertia fusestatic usethread fitaabb exactmeshinertia saveinertial alignfree",
    "body": "user gravcomp mocap sleep",
    "joint": "user group stiffness damping armature frictionloss springdamper springref margin solreflimit solimplimit "
    "solreffriction solimpfriction",
    "freejoint": "group align",
    "site": "user group material rgba",
    "equality": "solref solimp",
}
"""Attributes that move nothing and may refer to what is left out."""
_COMPILER: Final = '<compiler inertiafromgeom="false" boundmass="1" boundinertia="1" fusestatic="false"/>'
"""Bodies without a mass are given some, or MuJoCo would not compile them; all bodies are kept."""
_LOOPS: Final = ("connect", "weld", "tendon", "flex", "flexvert", "flexstrain")


@dataclass(slots=True)
class PlainMjcf:
    """What `plain` makes of a file.

    Attributes:
        name: the model's.
        places: file and line that each line of the text comes from.
        joints: where each named joint is written.
        notes: what the file says and the text does not, in words.
        loops: how many of each element would close loops or pull bodies together.
    """

    name: str
    places: list[markup.Place] = field(default_factory=list)
    joints: dict[str, markup.Place] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    _lines: list[str] = field(default_factory=list)
    loops: Counter[str] = field(default_factory=Counter)

    @property
    def text(self) -> str:
        """The MJCF, a line for each tag."""
        return "\n".join(self._lines)

    def line(self, element: markup.Element, text: str) -> None:
        """Add a line that an element is the source of."""
        self._lines.append(text)
        self.places.append((element.file, element.line))


def plain(root: markup.Element, packages: Packages) -> PlainMjcf:
    """The kinematics in an MJCF.

    Args:
        root: its root element.
        packages: which files it may include.

    Raises:
        DescriptionError: if an include is not there, outside, or repeated, the file is nested too deep, or it has more
            bodies than are taken.
        UnsupportedError: if it has what makes bodies in another way than by writing them.
    """
    out = PlainMjcf(root.attributes.get("model", "") or packages.file.stem)
    _includes(root, packages)
    _size(root)
    out.line(root, f'<mujoco model="{escaping.xml(out.name)}">')
    for section in root.children:
        if section.tag == "tendon":
            out.loops["tendon"] += len(section.children)
        if section.tag not in _OTHER_SECTIONS:
            _write(section, section.tag, out)
    out.line(root, _COMPILER)
    out.line(root, "</mujoco>")
    if out.loops:
        found = ", ".join(f"{count} {kind}{'s' * (count > 1)}" for kind, count in sorted(out.loops.items()))
        out.notes.append(f"has {found} in <equality> or <tendon>; what they close or pull is not modelled")
    return out


def _includes(root: markup.Element, packages: Packages) -> None:
    """Put the elements of included files in the place of each ``<include>``; MuJoCo takes a file once.

    A path is relative to the main file's folder or, if there is none, to the including file's.
    """
    seen = {packages.file.resolve()}
    stack = [root]
    while stack:
        element = stack.pop()
        children: list[markup.Element] = []
        for child in element.children:
            children += _included(child, packages, seen) if child.tag == "include" else [child]
        while any(child.tag == "include" for child in children):  # a file that begins with another one
            children = [
                deeper
                for child in children
                for deeper in (_included(child, packages, seen) if child.tag == "include" else [child])
            ]
        element.children = children
        stack += children


def _included(element: markup.Element, packages: Packages, seen: set[Path]) -> list[markup.Element]:
    name = element.attributes.get("file", "")

    def refused(what: str, remedy: str) -> DescriptionError:
        label = f"include {brief(name)!r}"
        return DescriptionError(
            "mjcf-include", what, file=element.file, line=element.line, element=label, remedy=remedy
        )

    if not name:
        raise refused("names no file", 'write <include file="…"/>')
    folders = packages.file.parent, Path(element.file).parent
    path = packages.check(next((f / name for f in folders if is_file(f / name)), folders[0] / name))
    if path in seen:
        raise refused("is included before; MuJoCo takes a file once", "remove one of the two, or the circle")
    seen.add(path)
    if not is_file(path):
        raise refused("is not there", "give a path relative to the main file")
    root = markup.parse(markup.read(path), path)
    if root.tag not in ("mujoco", "mujocoinclude"):
        raise refused(f"has <{root.tag}> at its top", "write <mujocoinclude>")
    return root.children


def _size(root: markup.Element) -> None:
    """Refuse at once what is nested too deep, or has too many bodies once its replicates are written out."""
    total = 0
    level: list[tuple[markup.Element, int]] = [(root, 1)]
    for _ in range(MAX_DEPTH):
        below: list[tuple[markup.Element, int]] = []
        for element, above in level:
            times = above * _count(element) if element.tag == "replicate" else above
            total += times * (element.tag in ("body", "site", "joint"))
            if total > MAX_LINKS or times > MAX_LINKS:
                what = f"more than {MAX_LINKS} bodies, joints and sites"
                raise DescriptionError("too-large", what, file=element.file, line=element.line)
            below += [(child, times) for child in element.children]
        level = below
        if not level:
            return
    element = level[0][0]
    what = f"elements are nested deeper than {MAX_DEPTH}"
    raise DescriptionError("too-large", what, file=element.file, line=element.line)


def _count(element: markup.Element) -> int:
    text = element.attributes.get("count", "").strip()
    if len(text) > 9 and text.isdigit():
        return MAX_LINKS + 1
    return int(text) if text.isdigit() else 1  # MuJoCo says what is wrong with it


def _write(element: markup.Element, section: str, out: PlainMjcf) -> None:
    """The lines of an element and all below it that kinematics depends on."""
    attributes = dict(element.attributes)
    kind = "equality" if section == "equality" and element.tag == "joint" else element.tag
    for name in _UNUSED.get("site" if kind == "site" else kind, "").split():
        if attributes.pop(name, "false") == "true" and name in ("align", "alignfree"):
            out.notes.append(f"<{element.tag} {name}> turns a free body's frame by its inertia; it is kept as written")
    if section == "worldbody" and element.tag in ("joint", "freejoint") and "name" in attributes:
        out.joints.setdefault(attributes["name"], (element.file, element.line))
    words = "".join(f' {escaping.xml(name)}="{escaping.xml(value)}"' for name, value in attributes.items())
    kept = list(_kept(element, section, out))
    out.line(element, f"<{element.tag}{words}{'' if kept else '/'}>")
    for child in kept:
        _write(child, section, out)
    if kept:
        out.line(element, f"</{element.tag}>")


def _kept(element: markup.Element, section: str, out: PlainMjcf) -> Iterator[markup.Element]:
    for child in element.children:
        if section == "default" and child.tag not in _IN_DEFAULT:
            continue
        if section == "equality" and child.tag in _LOOPS:
            out.loops[child.tag] += child.attributes.get("active") != "false"
            continue
        if section == "worldbody":
            if child.tag in _UNSUPPORTED:
                what = f"<{child.tag}> is not supported"
                remedy = "write its bodies out: MuJoCo can save the compiled model as MJCF"
                raise UnsupportedError("mjcf-unsupported", what, file=child.file, line=child.line, remedy=remedy)
            if child.tag in _NOT_IN_BODIES:
                continue
        yield child
