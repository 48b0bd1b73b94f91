"""The numerical proof: closed forms against both engines, at random configurations and lengths."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Final
from xml.etree import ElementTree as ET

import numpy as np
import sympy as sp

from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.numeric import evaluate
from pinscrew.description import urdf
from pinscrew.engines.base import Answers
from pinscrew.ground.counts import whole
from pinscrew.ground.errors import PinscrewWarning
from pinscrew.ground.typing import KINDS, FloatArray, JacobianKind
from pinscrew.lie import se3
from pinscrew.robot.robot import Robot

__all__ = ["TOLERANCE", "Compared", "Proof", "prove", "relative", "variant"]

TOLERANCE: Final = 1e-12
"""Of differences in which metres are divided by max(1, size), as in `verify`."""
SNAPPED: Final = 4.0
"""How many times the sum of all changes by snapping a Jacobian's entry may move, metres divided by the size."""


@dataclass(frozen=True, slots=True)
class Compared:
    """The largest difference of one closed form from one engine.

    Attributes:
        what: the closed form, such as ``"pose"`` or ``"body Jacobian"``.
        engine: the engine's name.
        error: the largest difference over all samples, metres divided by max(1, size).
        tolerance: what it may be.
        given: whether against the robot's own file at its own lengths; otherwise with random lengths.
    """

    what: str
    engine: str
    error: float
    tolerance: float
    given: bool

    @property
    def ok(self) -> bool:
        """Whether the difference is within the tolerance; NaN is not."""
        return self.error <= self.tolerance


@dataclass(frozen=True, slots=True)
class Proof:
    """What both engines say to the closed forms.

    Attributes:
        samples: random configurations.
        seed: of the random numbers.
        lengths: how many sets of random lengths.
        comparisons: each closed form against each engine.
        symbolic: whether g⁻¹ġ and J^b θ̇ are one expression, as they must be; None for a large arm, where they
            are not formed.
    """

    samples: int
    seed: int
    lengths: int
    comparisons: tuple[Compared, ...]
    symbolic: bool | None

    @property
    def ok(self) -> bool:
        """Whether everything agrees."""
        return self.symbolic is not False and all(compared.ok for compared in self.comparisons)

    @property
    def largest(self) -> float:
        """The largest difference at random lengths, which snapping does not touch."""
        errors = [c.error for c in self.comparisons if not c.given]
        return float(np.max(errors)) if errors else 0.0


def prove(derivation: ClosedForms, samples: int = 100, seed: int = 0) -> Proof:
    """Compare g, g⁻¹, ġ, the Jacobians and the velocities with `PoE` and `Pinocchio`.

    Once with the robot's own file, at its own lengths; and once with ``samples`` robots that differ in their
    lengths, each at one configuration, where rotations are the exact ones. Joint values are within ±π and ±1 m.

    Args:
        derivation: the closed forms.
        samples: random configurations.
        seed: of the random numbers.

    Raises:
        InputError: if ``samples`` is not positive, or ``seed`` negative.
        EngineError: if Pinocchio does not take the robot.
    """
    samples, seed = whole("samples", samples, 1), whole("seed", seed, 0)
    rng = np.random.default_rng(seed)
    m = len(derivation.coordinates)
    sliding = {joint.master.symbol for joint in derivation.chain.joints if not joint.revolute}
    turning = {joint.master.symbol for joint in derivation.chain.joints if joint.revolute}
    ranges = np.array(
        [np.pi if v.symbol in turning or v.symbol not in sliding else 1.0 for v in derivation.coordinates]
    )
    q, qd = rng.uniform(-1.0, 1.0, (samples, m)) * ranges, rng.uniform(-1.0, 1.0, (samples, m))
    given = {s: np.full(samples, float(value)) for s, value in derivation.lengths.items()}
    drawn = {s: rng.uniform(0.5, 1.5, samples) * (float(v) or 1.0) for s, v in derivation.lengths.items()}
    moved = 1e-12 + SNAPPED * sum(snapped.change for snapped in derivation.snapped)
    comparisons = _compare(derivation, [derivation.robot] * samples, q, qd, given, tolerance=moved, given_file=True)
    if drawn or derivation.snapped:
        count = samples if drawn else 1
        robots = [variant(derivation, {s: float(x[i]) for s, x in drawn.items()}) for i in range(count)]
        robots = robots if drawn else robots * samples
        comparisons += _compare(derivation, robots, q, qd, drawn, tolerance=TOLERANCE, given_file=False)
    symbolic = None if derivation.large else derivation.velocities_agree
    return Proof(samples, seed, samples if drawn else 0, tuple(comparisons), symbolic)


def _compare(
    derivation: ClosedForms,
    robots: list[Robot],
    q: FloatArray,
    qd: FloatArray,
    lengths: Mapping[sp.Symbol, FloatArray],
    *,
    tolerance: float,
    given_file: bool,
) -> list[Compared]:
    from pinscrew.engines.pinocchio import Pinocchio
    from pinscrew.engines.poe import PoE

    d = derivation
    forms = {"pose g": d.pose, **{f"{kind} Jacobian": d.jacobian(kind) for kind in KINDS}}
    if not d.large:  # the velocities of a large arm are its Jacobians times rates, and not formed
        forms |= {
            "inverse g⁻¹": d.inverse,
            "rate ġ": d.pose_rate,
            "spatial velocity": d.spatial_velocity,
            "body velocity": d.body_velocity,
            "hybrid velocity": d.hybrid_velocity,
        }
    ours = dict(zip(forms, evaluate(d, list(forms.values()), q, qd, lengths), strict=True))
    found = []
    for engine in (PoE, Pinocchio):
        theirs = _answers(engine, d, robots, q, qd)
        scale = np.maximum(1.0, abs(theirs["pose g"][:, :3, 3]).max(axis=1) + robots[0].reach)[:, None, None]
        for name, mine in ours.items():
            difference = abs(mine - theirs[name])
            if mine.shape[1] == 4:
                difference[:, :3, 3:] /= scale
            else:
                difference[:, :3] /= scale
            error = float(difference.max(initial=0.0))
            error = error if np.isfinite(difference).all() else np.inf
            found.append(Compared(name, engine.name, error, tolerance, given_file))
    return found


def _answers(engine: type, d: ClosedForms, robots: list[Robot], q: FloatArray, qd: FloatArray) -> dict[str, FloatArray]:
    """What an engine says, in the shapes of the closed forms; successive samples of one robot are asked at once."""
    edges = [i for i, robot in enumerate(robots) if i == 0 or robot is not robots[i - 1]]
    parts: list[dict[str, FloatArray]] = []
    for start, end in pairwise([*edges, len(robots)]):
        robot = robots[start]
        columns = [robot.velocity_names.index(v.joint) for v in d.coordinates]
        full, rates = np.zeros((end - start, robot.nq)), np.zeros((end - start, robot.nv))
        full += robot.neutral
        places = [robot.coordinate_names.index(v.joint) for v in d.coordinates]
        full[:, places], rates[:, columns] = q[start:end], qd[start:end]
        pose, jacobians = relative(engine(robot).answers(full, rates, [d.tip, d.reference]))
        part = {"pose g": pose, "inverse g⁻¹": se3.inverse(pose)}
        for kind, full_jacobian in jacobians.items():
            J = full_jacobian[:, :, columns]
            part[f"{kind} Jacobian"], part[f"{kind} velocity"] = J, J @ qd[start:end, :, None]
        part["rate ġ"] = se3.hat(part["spatial velocity"][:, :, 0]) @ pose
        parts.append(part)
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def relative(answers: Answers) -> tuple[FloatArray, dict[JacobianKind, FloatArray]]:
    """The pose (N, 4, 4) of the first frame in the second, and the Jacobians (N, 6, nv) of this motion.

    With g_AC = g_AB g_BC the body velocities are V_AC = Ad(g_BC⁻¹) V_AB + V_BC (MLS, proposition 2.15): B is here the
    frame that the motion is seen from, and what is left after its own velocity is the velocity in it.
    """
    pose = se3.inverse(answers.poses[:, 1]) @ answers.poses[:, 0]
    body = answers.jacobians["body"][:, 0] - se3.adjoint(se3.inverse(pose)) @ answers.jacobians["body"][:, 1]
    turned = np.concatenate([pose[:, :3, :3] @ body[:, :3], pose[:, :3, :3] @ body[:, 3:]], axis=1)
    return pose, {"spatial": se3.adjoint(pose) @ body, "body": body, "hybrid": turned}


def variant(derivation: ClosedForms, lengths: Mapping[sp.Symbol, float], *, follow: bool = True) -> Robot:
    """The joints that matter as a robot with these lengths, its rotations and axes the exact ones.

    Joints that are only followed hang on the base. Unless they ``follow``, joints move on their own.
    """
    d = derivation
    base = d.robot.base
    by_name = {joint.name: joint for joint in d.robot.description.joints}
    on_path = {joint.name for frame in (d.tip, d.reference, *d.also) for joint in d.robot.description.path(frame)}
    root = ET.Element("robot", name="variant")
    ET.SubElement(root, "link", name=base)
    for joint in d.geometry:
        parent = by_name[joint.name].parent if joint.name in on_path else base
        child = by_name[joint.name].child if joint.name in on_path else f"{by_name[joint.name].child} aside"
        ET.SubElement(root, "link", name=child)
        element = ET.SubElement(root, "joint", name=joint.name, type=joint.type)
        ET.SubElement(element, "parent", link=parent)
        ET.SubElement(element, "child", link=child)
        xyz = " ".join(_number(x, lengths) for x in joint.p)
        ET.SubElement(element, "origin", xyz=xyz, rpy=" ".join(_number(x, lengths) for x in joint.rpy))
        if joint.type == "fixed":
            continue
        ET.SubElement(element, "axis", xyz=" ".join(_number(x, lengths) for x in joint.axis))
        ET.SubElement(element, "limit", lower="-100", upper="100", effort="1", velocity="1")
        if follow and joint.master != joint.name:
            multiplier, offset = _number(joint.multiplier, lengths), _number(joint.offset, lengths)
            ET.SubElement(element, "mimic", joint=joint.master, multiplier=multiplier, offset=offset)
    with warnings.catch_warnings():  # whatever is to be said of the file was said when that was read
        warnings.simplefilter("ignore", PinscrewWarning)
        description = urdf.parse(ET.tostring(root, encoding="unicode"), "variant")
    return Robot.from_description(description, tip=d.tip)


def _number(expression: sp.Expr, lengths: Mapping[sp.Symbol, float]) -> str:
    """A double, all its digits; an axis or angle needs them."""
    value = float(expression.xreplace(dict(lengths)))
    return repr(value + 0.0)
