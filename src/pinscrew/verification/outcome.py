"""What a comparison of two engines finds, as plain data: no format is known here."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["Check", "ErrorPlace", "ReportData"]


@dataclass(frozen=True, slots=True)
class ErrorPlace:
    """Where the largest error of a check is.

    Attributes:
        frame: the frame, or ``""``.
        joint: the velocity whose column it is in, or the joint that moves the frame.
        configuration: which configuration, such as ``"random 17"`` (with the report's seed).
        q: its coordinates.
    """

    frame: str = ""
    joint: str = ""
    configuration: str = ""
    q: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Check:
    """One comparison over all frames and configurations.

    Attributes:
        name: what was compared.
        error: the largest error; metres were divided by the robot's size where that is above one.
        tolerance: what it may be.
        place: where that was.
        remarks: differences in words, for what is not a number.
    """

    name: str
    error: float
    tolerance: float
    place: ErrorPlace = ErrorPlace()
    remarks: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the error is within the tolerance; NaN is not."""
        return self.error <= self.tolerance


@dataclass(frozen=True)
class ReportData:
    """The outcome of `verify` for one robot.

    Attributes:
        robot: the robot's name.
        file: its file.
        arguments: its xacro arguments.
        engines: names of the two engines.
        frames: how many frames were compared.
        samples: random configurations within limits.
        configurations: configurations in all.
        seed: of the random configurations.
        tolerance: what counts as rounding.
        reach: the robot's size (m).
        checks: one per comparison.
        diagnosis: where the robots of the engines differ first, in words; empty if they agree.
        blamed: the joint that each line of the diagnosis is about, or ``""``.
        lines: the line of that joint, or None.
        files: the file that has that line: `file`, or one that a xacro file includes.
    """

    robot: str
    file: str
    arguments: Mapping[str, str]
    engines: tuple[str, str]
    frames: int
    samples: int
    configurations: int
    seed: int
    tolerance: float
    reach: float
    checks: tuple[Check, ...]
    diagnosis: tuple[str, ...] = field(default=())
    blamed: tuple[str, ...] = field(default=())
    lines: tuple[int | None, ...] = field(default=())
    files: tuple[str, ...] = field(default=())

    @property
    def ok(self) -> bool:
        """Whether every check passed."""
        return all(check.ok for check in self.checks)

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that did not pass."""
        return tuple(check for check in self.checks if not check.ok)

    @property
    def worst(self) -> Check:
        """The check with the largest error for its tolerance."""
        return max(self.checks, key=_badness)

    @property
    def largest_difference(self) -> float:
        """The largest scaled error of the checks that hold to rounding: all but structure and differences."""
        return max((c.error for c in self.checks if c.tolerance == self.tolerance), default=math.nan)


def _badness(check: Check) -> float:
    if math.isnan(check.error):  # worse than anything
        return math.inf
    if check.tolerance > 0.0:
        return check.error / check.tolerance
    return math.inf if check.error > 0.0 else 0.0
