"""What several commands take: robots with xacro arguments, and configurations."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click
from click.shell_completion import CompletionItem

if TYPE_CHECKING:
    from pinscrew.robot import Robot
    from pinscrew.typing import FloatArray

__all__ = [
    "Named",
    "configuration",
    "json_option",
    "number",
    "q_option",
    "robot_argument",
    "robots",
    "tip_option",
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
        from pinscrew.loading import load

        return load(self.source, arguments=self.arguments, **self.options)


def _complete(_ctx: click.Context, _param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    from pinscrew.description.catalogue import bundled

    names = [entry.name for entry in bundled() if entry.name.startswith(incomplete)]
    return [CompletionItem(name) for name in names] or [CompletionItem(incomplete, type="file")]


def robot_argument(*, required: bool = True) -> Callable[[_F], _F]:
    """The ROBOT [ARG:=VALUE]... of a command, as a tuple of words for `robots`."""
    argument = click.argument(
        "words",
        nargs=-1,
        required=required,
        metavar="ROBOT [ARG:=VALUE]..." if required else "[ROBOT [ARG:=VALUE]...]...",
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


def robots(words: Sequence[str]) -> list[Named]:
    """The robots that the words of a command line name, each with the arguments that follow it."""
    found: list[Named] = []
    options = click.get_current_context().meta.get(_OPTIONS, {})
    for word in words:
        assignment = _ASSIGNMENT.fullmatch(word)
        if assignment is None:
            found.append(Named(word, options=options))
        elif not found:
            raise click.UsageError(f"the argument {word} comes before any robot")
        else:
            found[-1].arguments[assignment[1]] = assignment[2]
    return found


def robot(words: Sequence[str]) -> Named:
    """The one robot that the words of a command line name."""
    found = robots(words)
    if len(found) != 1:
        raise click.UsageError(f"expected one robot, but got {', '.join(named.source for named in found)}")
    return found[0]


tip_option = click.option("--tip", metavar="FRAME", help="The frame; by default the robot's tip.")
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
q_option = click.option(
    "-q",
    "values",
    metavar="VALUES",
    help="Joint values in rad and m, separated by commas: numbers in the order of the joints, or NAME=VALUE "
    "pairs (the others are 0). Write 45deg, pi/4 or -2*pi/3. By default all are 0.",
)

_OPERATORS: Final[dict[type[ast.operator], Callable[[float, float], float]]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
_CONSTANTS: Final = {"pi": math.pi, "deg": math.pi / 180.0}
_UNIT: Final = re.compile(r"(?<=[0-9.)])\s*(deg|pi)\b")
_LONGEST: Final = 100


def number(text: str) -> float:
    """The value of an expression such as ``-0.5``, ``pi/4``, ``45deg`` or ``2*(pi-1)``.

    Raises:
        click.BadParameter: if it is none.
    """
    shown = text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"
    problem = _bad(f"{shown!r} is not a number; write such as 0.1, pi/4 or 45deg")
    if len(text) > _LONGEST:
        raise problem
    try:
        value = _value(ast.parse(_UNIT.sub(r"*\1", text.strip()), mode="eval").body)
    except (SyntaxError, ValueError, ZeroDivisionError, OverflowError, RecursionError, MemoryError):
        raise problem from None
    if not math.isfinite(value):
        raise problem
    return value


def _bad(message: str) -> click.BadParameter:
    return click.BadParameter(message, param_hint="-q")


def _value(node: ast.expr) -> float:
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)) and not isinstance(node.value, bool):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id in _CONSTANTS:
        return _CONSTANTS[node.id]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.UAdd, ast.USub)):
        value = _value(node.operand)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _OPERATORS[type(node.op)](_value(node.left), _value(node.right))
    raise ValueError("not arithmetic")


def configuration(robot: Robot, values: str | None) -> FloatArray:
    """The configuration that ``-q`` gives, shape (nq,).

    Raises:
        click.BadParameter: if it can't be read, or has another number of values than the robot.
        UnknownNameError: if it names a joint that does not exist.
    """
    import numpy as np

    if values is None or not values.strip():
        return robot.neutral.copy()
    words = values.removeprefix("=").split(",")  # -q=1 is -q with the value "=1" to click
    if any("=" in word for word in words):
        pairs = [word.partition("=") for word in words]
        names = [name.strip() for name, _, _ in pairs]
        bare = [name for name, (_, equals, _) in zip(names, pairs, strict=True) if not equals]
        if bare:
            raise _bad(f"{bare[0]!r} has no name; give all values by name, or none")
        twice = [name for i, name in enumerate(names) if name in names[:i]]
        if twice:
            raise _bad(f"{twice[0]!r} is given twice")
        return robot.configuration({name: number(value) for name, (_, _, value) in zip(names, pairs, strict=True)})
    if len(words) != robot.nq:
        known = ", ".join(robot.coordinate_names) or "none"
        raise _bad(f"{len(words)} values, but {robot.name} takes {robot.nq}: {known}")
    return np.array([number(word) for word in words])
