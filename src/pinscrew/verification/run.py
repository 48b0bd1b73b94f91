"""`verify`: the same questions to two engines, on every frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from pinscrew.engines.base import Engine
from pinscrew.ground.counts import whole
from pinscrew.ground.errors import InputError
from pinscrew.robot.loading import RobotLike, robot_of
from pinscrew.robot.robot import Robot
from pinscrew.verification import comparison, compiled, diagnosis, differences, structure
from pinscrew.verification.configurations import Configurations, configurations, speeds
from pinscrew.verification.outcome import Check
from pinscrew.verification.report import Report
from pinscrew.witnesses.mjcf import readers_of

__all__ = ["TOLERANCE", "check_names", "verify"]

TOLERANCE: Final = 1e-12
"""Of errors in which metres are divided by max(1, size): ten times the worst of some thousand public robots."""

BLOCK_BYTES: Final = 2**26
"""Memory for the answers of one engine to one block of configurations."""

_STRUCTURE, _HOME, _SCREWS = "structure", "home poses", "screw axes"


def verify(
    robot: RobotLike,
    samples: int = 1000,
    seed: int = 0,
    *,
    tolerance: float = TOLERANCE,
    frames: Sequence[str] | None = None,
    engines: tuple[Engine, Engine] | None = None,
) -> Report:
    """Compare two engines on a robot: structure, home poses, screw axes, FK, Jacobians and their derivatives.

    They are compared on every frame at zero, at the limits' corners and middle, at random within the limits and
    far outside; each engine's Jacobians are also held against each other and against finite differences of its
    own FK. With 10 000 samples or more `Batch` is compared too, where it can be compiled. Metres are divided by
    max(1, size of the robot), columns of Jacobians by the largest multiplier of what mimics their joint; NaN is a
    failure.

    Args:
        robot: a robot, or a name or path that `load` takes.
        samples: random configurations within the limits; a quarter as many are taken far outside.
        seed: of the random configurations.
        tolerance: largest scaled error that is rounding.
        frames: the frames to compare; by default all.
        engines: two engines to compare instead of `PoE` and `Pinocchio` of this robot, or MuJoCo of an MJCF.

    Raises:
        InputError: if ``samples`` or ``seed`` is negative or no whole number, ``tolerance`` is not positive and
            finite, or ``frames`` is empty.
        UnknownNameError: if there is no such frame.
        EngineError, UnsupportedError: if Pinocchio does not take the robot.
    """
    samples, seed = whole("samples", samples, 0), whole("seed", seed, 0)
    if not 0.0 < tolerance < math.inf:
        raise InputError("tolerance", f"tolerance={tolerance}", remedy="give a positive number, such as 1e-12")
    robot = robot_of(robot)
    names = tuple(robot.frame(frame) for frame in (robot.frame_names if frames is None else frames))
    if not names:
        raise InputError("frames", "there are no frames to compare", remedy="leave frames out to compare all")
    pair = engines or readers_of(robot)
    known = tuple(name for name in names if all(name in engine.robot.frame_names for engine in pair))
    remarks = structure.compare(*pair)
    where = configurations(robot, samples, seed)
    checks = [Check(_STRUCTURE, float(len(remarks)), 0.0, remarks=remarks)]
    with np.errstate(invalid="ignore", over="ignore"):  # what is not finite fails its check; no need to warn
        if known and structure.same_coordinates(*pair):
            many = engines is None and bool(compiled.check_names(samples))
            checks += _numbers(robot, pair, known, where, tolerance, many=many)
        failed = [check for check in checks if not check.ok]
        blame = diagnosis.diagnose(pair, failed, tolerance) if failed else ()
    joints = {joint.name: joint for joint in robot.description.joints}
    blamed = [joints.get(difference.joint) for difference in blame]
    return Report(
        robot=robot.name,
        file=robot.description.file,
        arguments=dict(robot.description.arguments),
        engines=(pair[0].name, pair[1].name),
        frames=len(known),
        samples=samples,
        configurations=len(where.q),
        seed=seed,
        tolerance=tolerance,
        reach=robot.reach,
        checks=tuple(checks),
        diagnosis=tuple(difference.words for difference in blame),
        blamed=tuple(difference.joint for difference in blame),
        lines=tuple(None if joint is None else joint.line for joint in blamed),
        files=tuple((joint and joint.file) or robot.description.file for joint in blamed),
    )


def check_names(samples: int) -> tuple[str, ...]:
    """The names of the checks of a report on so many samples, in its order, where the engines are the default ones.

    A robot whose structure the engines see differently has the first only, if their coordinates differ by it.
    """
    engines = ("PoE", "Pinocchio")
    identities = (check.name for engine in engines for check in comparison.compare_identities(engine, TOLERANCE))
    own = map(differences.check_name, engines)
    return (
        _STRUCTURE,
        _HOME,
        _SCREWS,
        *comparison.compare_answers(TOLERANCE),
        *identities,
        *own,
        *compiled.check_names(samples),
    )


def _numbers(
    robot: Robot,
    engines: tuple[Engine, Engine],
    frames: tuple[str, ...],
    where: Configurations,
    tolerance: float,
    *,
    many: bool,
) -> list[Check]:
    """All checks of numbers, in the order in which a report shows them; of `Batch` too if they are many."""
    fastest = speeds(robot)
    home = comparison.Worst(_HOME, tolerance)
    screws = comparison.Worst(_SCREWS, tolerance)
    answers = comparison.compare_answers(tolerance)
    identities = [comparison.compare_identities(engine.name, tolerance) for engine in engines]
    leaves = differences.difference_frames(robot, frames)
    extra = compiled.CompiledChecks(robot, leaves, frames, tolerance) if many else None
    for block in where.blocks(_block_length(robot, len(frames))):
        scales, start = where.scales[block], block.start
        a, b = (engine.answers(where.q[block], where.qd[block], frames) for engine in engines)
        if start == 0:  # configuration 0 is zero
            home.see(comparison.pose_error(a.poses[:1], b.poses[:1], scales[:1]))
            at_zero = a.jacobians["spatial"][:1], b.jacobians["spatial"][:1]
            screws.see(comparison.jacobian_error(*at_zero, scales[:1]) / fastest)
        comparison.see_answers(answers, a, b, scales, fastest, start)
        for checks, own in zip(identities, (a, b), strict=True):
            comparison.see_identities(checks, own, scales, fastest, start)
        if extra is not None:
            extra.see(where.q[block], a, scales, start)
    worst = [home, screws, *answers.values(), *identities[0], *identities[1]]
    done = [w.check(robot, frames, where) for w in worst]
    points = where.take(np.linspace(0, where.inside - 1, differences.POINTS).astype(int))
    for engine in engines:
        check = differences.compare_differences(engine, points.q, points.scales, leaves)
        done.append(check.check(robot, leaves, points))
    return done + ([w.check(robot, extra.frames, where) for w in extra.worst] if extra is not None else [])


def _block_length(robot: Robot, frames: int) -> int:
    numbers = frames * (16 + 2 * 3 * 6 * robot.nv)
    return max(1, BLOCK_BYTES // (8 * max(1, numbers)))
