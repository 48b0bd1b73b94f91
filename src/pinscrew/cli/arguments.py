"""What several commands take: robots with xacro arguments, and configurations."""

from __future__ import annotations

import math
import os
import re
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click
from click.shell_completion import CompletionItem

from pinscrew.ground import expressions
from pinscrew.ground.errors import InputError, PinscrewWarning
from pinscrew.ground.expressions import Unit

if TYPE_CHECKING:
    from pinscrew.ground.typing import FloatArray
    from pinscrew.robot.robot import Robot

__all__ = [
    "Named",
    "amount",
    "configuration",
    "json_option",
    "number",
    "options",
    "pairs",
    "q_option",
    "robot",
    "robot_argument",
    "robots",
    "tip_option",
    "values_by_name",
]

_F = TypeVar("_F", bound=Callable[..., Any])

_ASSIGNMENT: Final = re.compile(r"([^\s:=]+):=(.*)", re.DOTALL)


@dataclass(slots=True)
class Named:
    """A robot as the command line names it.

    Attributes:
        source: a name or a path.
        arguments: its xacro arguments.
        options: of how to load it, for `pinscrew.load`.
    """

    source: str
    arguments: dict[str, float | str] = field(default_factory=dict)
    options: dict[str, Any] = field(default_factory=dict)

    def load(self) -> Robot:
        """The robot."""
        from pinscrew.robot.loading import load

        return load(self.source, arguments=self.arguments, **self.options)


def _complete(_ctx: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    from pinscrew.description.catalogue import bundled

    names = [entry.name for entry in bundled() if entry.name.startswith(incomplete)]
    return [CompletionItem(name) for name in names] or [CompletionItem(incomplete, type="file")]


def robot_argument(*, required: bool = True, then: str = "", metavar: str = "") -> Callable[[_F], _F]:
    """The ROBOT [ARG:=VALUE]... of a command, as a tuple of words for `robots`; ``then`` names what else may follow."""
    argument = click.argument(
        "words",
        nargs=-1,
        required=required,
        metavar=metavar or (f"ROBOT [ARG:=VALUE]...{then}" if required else "[ROBOT [ARG:=VALUE]...]..."),
        shell_complete=_complete,
    )
    options = (
        click.option(
            "--package",
            "packages",
            multiple=True,
            metavar="NAME:=PATH",
            expose_value=False,
            callback=_keep_packages,
            help="Where a ROS package is, for $(find NAME) and package://NAME; may be repeated.",
        ),
        click.option(
            "--allow-outside",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Let files outside the robot's own folder and the packages be read, by xacro and for meshes.",
        ),
        click.option(
            "--strict",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Refuse what is warned of otherwise: misspelt elements, degrees for radians and the like.",
        ),
        click.option(
            "--floating-base",
            is_flag=True,
            expose_value=False,
            callback=_keep,
            help="Let the root link float: x, y, z and a quaternion x, y, z, w come first in the coordinates.",
        ),
    )

    def decorate(function: _F) -> _F:
        for decorator in (*reversed(options), argument):
            function = decorator(function)
        return function

    return decorate


_OPTIONS: Final = "pinscrew.load"


def _keep(ctx: click.Context, param: click.Parameter, value: Any) -> None:
    """Keep the value of an option of `robot_argument` for `robots`."""
    ctx.meta.setdefault(_OPTIONS, {})[param.name] = value


def _keep_packages(ctx: click.Context, param: click.Parameter, values: Sequence[str]) -> None:
    packages = {}
    for value in values:
        assignment = _ASSIGNMENT.fullmatch(value)
        if assignment is None:
            raise click.BadParameter(f"{value!r} is not NAME:=PATH")
        packages[assignment[1]] = assignment[2]
    _keep(ctx, param, packages)


def options() -> dict[str, Any]:
    """The options of `robot_argument` as they were given, for `pinscrew.load`."""
    found: dict[str, Any] = click.get_current_context().meta.get(_OPTIONS, {})
    return found


def robots(words: Sequence[str]) -> list[Named]:
    """The robots that the words of a command line name, each with the arguments that follow it."""
    found: list[Named] = []
    for word in words:
        assignment = _ASSIGNMENT.fullmatch(word)
        if assignment is None:
            name, equals, value = word.partition("=")
            if found and equals and name.isidentifier() and not os.path.exists(word):  # noqa: PTH110 (no error for any text)
                raise click.UsageError(f"{word!r} is no robot; an argument is written {name}:={value}")
            found.append(Named(word, options=options()))
        elif not found:
            raise click.UsageError(f"the argument {word} comes before any robot")
        else:
            found[-1].arguments[assignment[1]] = assignment[2]
    return found


def robot(words: Sequence[str]) -> Named:
    """The one robot that the words of a command line name."""
    found = robots(words)
    if len(found) != 1:
        numbers = re.fullmatch(r"[-+.\d].*", found[-1].source) and not os.path.exists(found[-1].source)  # noqa: PTH110
        hint = "; separate the values of -q by commas" if numbers else ""
        raise click.UsageError(f"expected one robot, but got {', '.join(named.source for named in found)}{hint}")
    return found[0]


tip_option = click.option("--tip", metavar="FRAME", help="The frame; by default the robot's tip.")
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
q_option = click.option(
    "-q",
    "values",
    metavar="VALUES",
    help="Joint values in rad and m, separated by commas: numbers in the order of the joints, or NAME=VALUE "
    "pairs (the others are 0). Write 45deg, pi/4, -2*pi/3, 2cm or 30mm. By default all are 0.",
)


def number(text: str, option: str | None = None, unit: Unit = "", *, plain: float = 1.0, of: str = "") -> float:
    """The value that an option gives as an expression: ``-0.5``, ``pi/4``, ``45deg``, ``2cm`` or ``2*(pi-1)``.

    Args:
        text: what was written.
        option: whose it is; not needed in its own callback.
        unit: what is needed.
        plain: what a number without a unit is multiplied by, for an option whose name has a unit of its own.
        of: whose value it is, where an option has several.

    Raises:
        click.BadParameter: if it is none, or of another unit.
    """
    about = f"{of}: " if of else ""
    try:
        value, given = expressions.quantity(text)
        expressions.check_unit(text, given, unit)
    except InputError as error:
        if error.code == "unit":
            raise click.BadParameter(f"{about}{error}", param_hint=option) from None
        shown = text if len(text) <= expressions.LONGEST else f"{text[: expressions.LONGEST]}…"
        what = f"{about}{shown!r} is not a number; write such as {expressions.EXAMPLES[unit]}"
        raise click.BadParameter(what, param_hint=option) from None
    return value if given else value * plain


def amount(unit: Unit, *, plain: float = 1.0) -> Callable[[click.Context, click.Parameter, str | None], float | None]:
    """The callback of an option that takes one quantity, such as ``5cm``, that is not negative."""

    def read(_ctx: click.Context, _param: click.Parameter, text: str | None) -> float | None:
        if text is None:
            return None
        value = number(text, unit=unit, plain=plain)
        if value < 0.0:
            raise click.BadParameter(f"{text.strip()!r} is negative")
        return value

    return read


def pairs(words: Iterable[str], form: str, option: str | None = None) -> dict[str, str]:
    """Words such as NAME=VALUE, by their names.

    Args:
        words: the words.
        form: what they must be, in words.
        option: whose they are; not needed in its own callback.

    Raises:
        click.BadParameter: if a word is none, or a name is given twice.
    """
    found: dict[str, str] = {}
    for word in words:
        name, equals, text = (part.strip() for part in word.partition("="))
        if not equals or not name:
            raise click.BadParameter(f"{word.strip()!r} is not {form}", param_hint=option)
        if name in found:
            raise click.BadParameter(f"{name!r} is given twice", param_hint=option)
        found[name] = text
    return found


def values_by_name(text: str, robot: str, names: Sequence[str], units: Sequence[Unit], option: str) -> dict[str, float]:
    """The numbers of an option like ``-q``: one for each of the names, or NAME=VALUE pairs, whose names may be any.

    Args:
        text: what was written.
        robot: the robot's name.
        names: the names that there are.
        units: what each is of.
        option: whose they are.

    Raises:
        click.BadParameter: if it can't be read, or has another number of values than there are names.
    """
    words = text.removeprefix("=").split(",")  # -q=1 is -q with the value "=1" to click
    if any("=" in word for word in words):
        given = pairs(words, "NAME=VALUE; give all values by name, or none", option)
    elif len(words) == len(names):
        given = dict(zip(names, words, strict=True))
    else:
        what = f"{len(words)} values, but {robot} takes {len(names)}: {', '.join(names) or 'none'}"
        raise click.BadParameter(what, param_hint=option)
    needed = dict(zip(names, units, strict=True))
    return {name: number(value, option, needed.get(name, ""), of=name) for name, value in given.items()}


def configuration(robot: Robot, values: str | None) -> FloatArray:
    """The configuration that ``-q`` gives, shape (nq,).

    Raises:
        click.BadParameter: if it can't be read, or has another number of values than the robot.
        UnknownNameError: if it names a joint that does not exist.
    """
    if values is None or not values.strip():
        return robot.neutral.copy()
    given = values_by_name(values, robot.name, robot.coordinate_names, robot.coordinate_units, "-q")
    q = robot.configuration(given)
    _warn_of_degrees(robot, q)
    return q


def _warn_of_degrees(robot: Robot, q: FloatArray) -> None:
    """Say where angles look like degrees: more than a turn, outside the limits, and within them as degrees."""
    for name, unit, value, (lower, upper) in zip(
        robot.coordinate_names, robot.coordinate_units, q.tolist(), robot.limits.tolist(), strict=True
    ):
        if unit != "rad" or abs(value) <= math.tau or lower <= value <= upper:
            continue
        if lower <= math.radians(value) <= upper:
            remark = f"{name} = {value:g} rad is outside its limits; if degrees are meant, write {value:g}deg"
            warnings.warn(PinscrewWarning("looks-like-degrees", remark, file=robot.description.file), stacklevel=3)
