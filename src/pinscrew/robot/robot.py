"""A robot: its description, and what follows from it at zero: home poses and screw axes of every frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final, Literal

import numpy as np

from pinscrew.description.model import Description, Joint, Rebuilt
from pinscrew.ground.displays import Displayed
from pinscrew.ground.errors import AmbiguousTipError, DescriptionError, InputError, UnknownNameError
from pinscrew.ground.expressions import Unit
from pinscrew.ground.typing import FloatArray
from pinscrew.lie import se3
from pinscrew.robot.mechanism import Mechanism, mechanism_of

__all__ = ["FLOATING_JOINT", "UNIVERSE", "Robot"]

UNIVERSE: Final = "universe"
"""The base of a robot that floats, by the name that Pinocchio has for it."""
FLOATING_JOINT: Final = "root_joint"
"""The joint between `UNIVERSE` and the root link of a robot that floats; Pinocchio's own name for it."""


@dataclass(frozen=True, eq=False, repr=False)
class Robot(Rebuilt, Displayed):
    """A robot at zero, derived from its description alone. Make one with `pinscrew.load` or `from_description`.

    Coordinates ``q`` stand in the order of `joint_names`, which is tree order: parents before children, depth
    first, siblings as in the file. Revolute and continuous joints have one angle (rad), prismatic joints one
    displacement (m), planar joints x, y and θ, floating joints x, y, z and a unit quaternion x, y, z, w. Mimic
    joints have none. Velocities ``qd`` are the coordinates' rates, except that planar and floating joints move
    with the child link's twist in its own frame, as in Pinocchio: (vx, vy, ωz) and (v, ω).

    Attributes:
        name: the robot's name.
        description: what the file says.
        floating_base: whether the root link floats in a frame `UNIVERSE`, which then is the base.
        default_tip: the tip frame where none is given; None for the lone leaf.
        mechanism: coordinates, screws and poses at zero, for engines.
    """

    name: str
    description: Description
    floating_base: bool = False
    default_tip: str | None = None
    mechanism: Mechanism = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "mechanism", mechanism_of(self.description))
        if self.default_tip is not None:
            self.frame(self.default_tip)

    @classmethod
    def from_description(
        cls, description: Description, *, name: str = "", tip: str | None = None, floating_base: bool = False
    ) -> Robot:
        """The robot of a description.

        Args:
            description: what the file says.
            name: a name for the robot; by default the one in the file.
            tip: the default tip frame; by default the lone leaf.
            floating_base: let the root link float in a frame `UNIVERSE`, which becomes the base.

        Raises:
            UnknownNameError: if there is no frame ``tip``.
            DescriptionError: if a floating base needs a name that the file uses for something else.
        """
        if floating_base:
            description = _floating(description)
        return cls(name or description.name, description, floating_base, tip)

    def __repr__(self) -> str:
        return f"<Robot {self.name!r}: {self.nq} coordinates, {len(self.frame_names)} frames, base {self.base!r}>"

    @property
    def base(self) -> str:
        """The root link, in whose frame all poses are."""
        return self.description.root

    @property
    def frame_names(self) -> tuple[str, ...]:
        """All links, base first, in tree order."""
        return self.description.links

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The joints with coordinates of their own, in the order of ``q``."""
        return self.mechanism.coordinates.joint_names

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """One name per entry of ``q``: the joint's, or such as ``root_joint.qx``. Length `nq`."""
        return self.mechanism.coordinates.names

    @property
    def velocity_names(self) -> tuple[str, ...]:
        """One name per entry of ``qd``: the joint's, or such as ``root_joint.wx``. Length `nv`."""
        return self.mechanism.coordinates.velocity_names

    @property
    def coordinate_units(self) -> tuple[Unit, ...]:
        """Of each entry of ``q``: ``"rad"``, ``"m"``, or ``""`` of a quaternion's. Length `nq`."""
        return self.mechanism.coordinates.units

    @property
    def velocity_units(self) -> tuple[Unit, ...]:
        """Of each entry of ``qd``, per second: ``"rad"`` or ``"m"``. Length `nv`."""
        return self.mechanism.coordinates.velocity_units

    @property
    def nq(self) -> int:
        """Length of ``q``."""
        return len(self.coordinate_names)

    @property
    def nv(self) -> int:
        """Length of ``qd``, and number of columns of each Jacobian; `nq` but for floating joints."""
        return len(self.velocity_names)

    @property
    def limits(self) -> FloatArray:
        """Lower and upper limit of each entry of ``q``, shape (nq, 2); infinite where there is none."""
        return self.mechanism.coordinates.limits

    @property
    def neutral(self) -> FloatArray:
        """The configuration of home poses and screw axes, shape (nq,): zeros, but for quaternions' w."""
        return self.mechanism.coordinates.neutral

    @property
    def reach(self) -> float:
        """Length (m) of the longest way from the base to a frame over the joints' origins, at zero."""
        return self.mechanism.reach

    @property
    def tip(self) -> str:
        """The default tip frame: the one the catalogue names, or the lone leaf.

        Raises:
            AmbiguousTipError: if there are several leaves and none is named.
        """
        if self.default_tip is not None:
            return self.default_tip
        leaves = self.description.leaves
        if len(leaves) != 1:
            raise AmbiguousTipError(self.name, leaves)
        return leaves[0]

    def frame(self, name: str | None = None) -> str:
        """The frame's name, checked to exist; the default tip for None.

        Raises:
            UnknownNameError: if there is no such frame.
            AmbiguousTipError: if a default is asked for and there is none.
        """
        if name is None:
            return self.tip
        if name not in self.mechanism.homes:
            raise UnknownNameError("unknown-frame", "frame", name, self.frame_names, where=self.name)
        return name

    def motions_above(self, frame: str) -> tuple[int, ...]:
        """Indices in ``mechanism.motions`` of the joints that move ``frame``, from the base outwards.

        Raises:
            UnknownNameError: if there is no such frame.
        """
        found: list[int] = []
        index = self.mechanism.motion_above[self.frame(frame)]
        while index >= 0:
            found.append(index)
            index = self.mechanism.motions[index].parent
        return tuple(reversed(found))

    def home(self, tip: str | None = None, *, reference: str | None = None) -> FloatArray:
        """The home pose M: the pose of ``tip`` at `neutral`, shape (4, 4).

        Args:
            tip: the frame; by default `tip`.
            reference: another frame fixed to the base, to give the pose in; by default the base.

        Raises:
            UnknownNameError, AmbiguousTipError: see `frame`.
            InputError: if ``reference`` moves.
        """
        T_base_tip = self.mechanism.homes[self.frame(tip)]
        if reference is None:
            return T_base_tip.copy()
        return se3.inverse(self._fixed(reference)) @ T_base_tip

    def screws(
        self,
        tip: str | None = None,
        *,
        at: Literal["space", "body"] = "space",
        reference: str | None = None,
    ) -> FloatArray:
        """Screw axes of the velocities that move ``tip``, as twists (v, ω) at `neutral`: shape (6, nv).

        They are the columns of the spatial (``at="space"``) or body (``at="body"``) Jacobian at zero: Lynch and
        Park's space and body screw axes. Columns of joints that don't move ``tip`` are zero; a column whose
        coordinate drives several joints (mimics) is the sum of their screws, each times its multiplier.
        ``mechanism.motions`` has the joints' own.

        Args:
            tip: the frame; by default `tip`.
            at: give the twists in the base frame or, for ``"body"``, in the tip frame.
            reference: another frame fixed to the base, to give space screw axes in; by default the base.

        Raises:
            UnknownNameError, AmbiguousTipError: see `frame`.
            InputError: if ``reference`` moves or is given with ``at="body"``, or ``at`` is neither.
        """
        tip = self.frame(tip)
        screws = np.zeros((6, self.nv))
        for index in self.motions_above(tip):
            motion = self.mechanism.motions[index]
            screws[:, motion.velocities] += motion.multiplier * motion.twists
        if at == "body":
            if reference is not None:
                what = "body screw axes are in the tip's own frame"
                raise InputError("reference", what, remedy="leave reference out")
            return se3.adjoint(se3.inverse(self.mechanism.homes[tip])) @ screws
        if at != "space":
            raise InputError("at", f"at={at!r}", remedy="use 'space' or 'body'")
        if reference is None:
            return screws
        return se3.adjoint(se3.inverse(self._fixed(reference))) @ screws

    def _fixed(self, reference: str) -> FloatArray:
        """Pose in the base of a frame that must not move."""
        above = self.mechanism.motion_above
        if above[self.frame(reference)] >= 0:
            fixed = ", ".join(name for name in self.frame_names if above[name] < 0)
            what, remedy = f"the frame {reference!r} moves", f"the frames fixed to the base are: {fixed}"
            raise InputError("reference", what, where=self.name, remedy=remedy)
        return self.mechanism.homes[reference]

    def configuration(self, values: Mapping[str, float]) -> FloatArray:
        """The configuration with these coordinates, by name, and the others as in `neutral`: shape (nq,).

        Raises:
            UnknownNameError: if a name is no coordinate's.
        """
        q = self.neutral.copy()
        for name, value in values.items():
            if name not in self.coordinate_names:
                known = self.coordinate_names
                raise UnknownNameError("unknown-coordinate", "coordinate", name, known, where=self.name)
            q[self.coordinate_names.index(name)] = value
        return q


def _floating(description: Description) -> Description:
    """The description with a floating joint from `UNIVERSE` to its root link."""
    joint_names = [joint.name for joint in description.joints]
    for name, taken in ((FLOATING_JOINT, joint_names), (UNIVERSE, description.links)):
        if name in taken:
            what = f"a floating base needs the name {name!r}, which the file uses"
            raise DescriptionError("reserved-name", what, file=description.file, remedy=f"rename {name!r}")
    joint = Joint(
        name=FLOATING_JOINT,
        type="floating",
        parent=UNIVERSE,
        child=description.root,
        T_parent_joint=np.eye(4),
        axis=np.zeros(3),
    )
    links, joints = (UNIVERSE, *description.links), (joint, *description.joints)
    return replace(description, links=links, joints=joints)
