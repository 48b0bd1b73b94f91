"""The order of a file's links: one tree, parents before children."""

from __future__ import annotations

from collections.abc import Callable

from pinscrew.description.markup import Element
from pinscrew.ground.errors import DescriptionError

__all__ = ["tree_of"]


def tree_of(
    root: Element, links: dict[str, Element], joints: dict[str, Element], error: Callable[..., DescriptionError]
) -> tuple[tuple[str, ...], tuple[Element, ...]]:
    """The links in tree order, and the joint that leads to each but the first."""
    leading: dict[str, Element] = {}
    below: dict[str, list[str]] = {name: [] for name in links}
    for joint in joints.values():
        parent, child = (next(joint.all(tag)).attributes["link"] for tag in ("parent", "child"))
        if parent == child:
            raise error("self-loop", joint, f"joins {parent!r} to itself", "name two links")
        if child in leading:
            other = leading[child].attributes["name"]
            what = f"leads to {child!r}, as joint {other!r} does; a tree has one way to each link"
            raise error("two-parents", joint, what, "remove one of the two joints")
        leading[child] = joint
        below[parent].append(child)
    tops = [name for name in links if name not in leading]
    if len(tops) > 1:
        what = f"has {len(tops)} root links: {', '.join(map(repr, tops[:5]))}{', …' * (len(tops) > 5)}"
        raise error("two-roots", root, what, "join them all to one", label="<robot>")
    order = _depth_first(tops, below.__getitem__)
    if len(order) < len(links):
        reached = set(order)
        lost = next(name for name in links if name not in reached)
        what = "is on a cycle of joints, and no root link leads to it"
        raise error("cycle", links[lost], what, "break the cycle: URDF describes trees")
    return tuple(order), tuple(leading[name] for name in order[1:])


def _depth_first(tops: list[str], below: Callable[[str], list[str]]) -> list[str]:
    """All that hangs below ``tops``, parents before children; no recursion, since chains can be long."""
    order: list[str] = []
    stack = list(reversed(tops))
    while stack:
        name = stack.pop()
        order.append(name)
        stack.extend(reversed(below(name)))
    return order
