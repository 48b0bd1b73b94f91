"""`derive`: from a robot to its closed forms."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping, Sequence
from typing import Final, Literal, TypeAlias, get_args

import sympy as sp

from pinscrew.derivation import arguments, exact, reading
from pinscrew.derivation.chain import Variable, compose
from pinscrew.derivation.derivation import Derivation
from pinscrew.derivation.forms import Convention
from pinscrew.derivation.normal_forms import GrowthError
from pinscrew.ground.errors import InputError, UnsupportedError
from pinscrew.ground.escaping_code import Language, identifier
from pinscrew.robot.loading import RobotLike, load, robot_of
from pinscrew.robot.robot import Robot

__all__ = ["Naming", "derive"]

Naming: TypeAlias = Literal["theta", "d", "urdf"]

_RESERVED: Final = frozenset(
    {
        "T",
        "J",
        "q",
        "g",
        "M",
        "out",
        "lengths",
        "default_lengths",
        "pi",
        "E",
        "I",
        "sin",
        "cos",
        "sqrt",
        "fk",
        "jacobian",
        "np",
        "math",
    }
)
_ATOM: Final = re.compile(r"[cs]_?\d+(m\d+)*|d?theta_?\d*|x\d+")


def derive(
    robot: RobotLike,
    tip: str | None = None,
    *,
    reference: str | None = None,
    also: Sequence[str] = (),
    symbols: bool | Mapping[str, float] = False,
    names: Naming = "theta",
    convention: Convention = "mls",
    snap: float = exact.SNAP,
    loader: arguments.Loader | None = None,
) -> Derivation:
    """The closed forms of a frame's pose and Jacobians: exact, in symbols, from the robot's description alone.

    Of a xacro file the arguments are the symbols where lengths are affine in them; the file is evaluated again to
    find and to prove the coefficients. Of a URDF, numbers are taken for what they print: 0.333 is 333/1000, an
    angle of 1.5708 is π/2. Source of the equations: Murray, Li and Sastry, 1994, §2.3–2.4 and §3.2–3.4.

    Args:
        robot: a robot, or a name or path that `load` takes.
        tip: the frame; by default the robot's tip.
        reference: the frame in which it moves; by default the base. It may be any link: one fixed to the base is
            another choice of frame 0, between two others that move are the joints that lie between them.
        also: further frames, whose joints are read, numbered and named with the others.
        symbols: name the distinct lengths that are still numbers l1, l2, …; or these lengths (m), by name.
        names: call the joints' values θ1, θ2, … (``"theta"``), those of sliding joints d3 (``"d"``), or as the
            file does (``"urdf"``).
        convention: whose names and order of twists reports use: ``"mls"`` or ``"lynch-park"``.
        snap: by how much (rad) an angle may be changed to be exact; see `exact`.
        loader: how to load the robot's file with other xacro arguments; by default as `load` does.

    Raises:
        UnknownNameError, AmbiguousTipError: see `Robot.frame`.
        UnsupportedError: if more than 8 joints, or one that is floating or planar, move the frame, or their axes are
            at such angles that an entry of the pose has more than `normal_forms.MOST_TERMS` terms.
        InputError: if a symbol collides with another, or an option is none.
    """
    for option, known, what in ((names, Naming, "names"), (convention, Convention, "convention")):
        if option not in get_args(known):
            raise InputError("derive-option", f"{what}={option!r}", remedy=f"use one of {', '.join(get_args(known))}")
    if not 0.0 <= snap <= 0.1:
        raise InputError("derive-option", f"snap={snap}", remedy="give an angle from 0 to 0.1 rad")
    robot = robot_of(robot)
    tip = robot.frame(tip)
    reference = robot.base if reference is None else robot.frame(reference)
    also = tuple(map(robot.frame, also))
    frames = tuple(dict.fromkeys((tip, reference, *also)))
    joints = reading.printed(robot, frames)
    variables = _variables(joints, names)
    found = arguments.recover(robot, frames, joints, loader or _reload(robot))
    lengths: dict[sp.Symbol, sp.Expr] = {
        found.symbols[name]: sp.Rational(value.numerator, value.denominator) for name, value in found.values.items()
    }
    named = _Lengths(symbols, lengths)

    def value(joint: str, scalar: str, text: str) -> sp.Expr:
        expression = found.scalars.get((joint, scalar))
        if expression is not None:
            return expression
        return named.value(text) if scalar.startswith("xyz") else exact.length(text)

    snaps = exact.Snaps(snap)
    geometry = reading.geometry(joints, value, snaps)
    named.finish()
    _check_names(robot, list(lengths), list(variables.values()))
    back, path = _between(robot, reference, tip)
    used = {symbol for joint in geometry for symbol in joint.p.free_symbols | joint.offset.free_symbols}
    derivation = Derivation(
        robot=robot,
        tip=tip,
        reference=reference,
        also=also,
        lengths=lengths,
        remarks=tuple(f"argument {name} stays a number: {why}" for name, why in found.numeric.items()),
        snapped=tuple(snaps.found),
        convention=convention,
        chain=compose(geometry, back, path, variables, [s for s in lengths if s in used], robot.joint_names),
        geometry=geometry,
        variables=tuple(variables.values()),
    )
    try:
        _ = derivation.normal.partial  # what is too long to be of use is refused here, not in the middle of a report
    except GrowthError as error:
        remedy = "name a tip nearer to the base, or give exact angles (an axis of 0 0 1, not of 0.001 0 1)"
        raise UnsupportedError("derive-growth", str(error), file=robot.description.file, remedy=remedy) from None
    return derivation


def _between(robot: Robot, start: str, tip: str) -> tuple[list[str], list[str]]:
    """The joints from ``start`` inwards to where the ways to both frames part, and those from there out to ``tip``."""
    inwards = [joint.name for joint in robot.description.path(start)]
    outwards = [joint.name for joint in robot.description.path(tip)]
    while inwards and outwards and inwards[-1] == outwards[-1]:
        del inwards[-1], outwards[-1]
    return inwards, outwards[::-1]


def _reload(robot: Robot) -> arguments.Loader:
    given = robot.description.arguments
    return lambda change: load(robot.description.file, arguments={**given, **change})


def _variables(joints: Mapping[str, reading.Printed], names: Naming) -> dict[str, Variable]:
    """A variable for each moving joint, numbered from the base."""
    found = {}
    moving = [joint for joint in joints.values() if joint.type != "fixed"]
    for number, joint in enumerate(moving, 1):
        label, letter, latex = str(number), "theta", r"\theta"
        if names == "d" and joint.type == "prismatic":
            letter = latex = "d"
        plain, typeset = f"{letter}{label}", f"{latex}_{{{label}}}"
        rate = rf"\dot{{{latex}}}_{{{label}}}"
        if names == "urdf":
            plain = label = _identifier(joint.name)
            typeset = r"\mathrm{" + plain.replace("_", r"\_") + "}"
            rate = rf"\dot{{{typeset}}}"
        symbols = sp.Symbol(plain, real=True), sp.Symbol(f"d{plain}", real=True)
        found[joint.name] = Variable(joint.name, label, *symbols, (typeset, rate))
    return found


def _identifier(name: str) -> str:
    """A name as an identifier of every language, and of none of the functions' own variables."""
    for language in get_args(Language):
        name = identifier(name, language)
    return f"{name}_" if name in _RESERVED else name


class _Lengths:
    """Names for the distinct lengths of a file that has none."""

    def __init__(self, symbols: bool | Mapping[str, float], lengths: dict[sp.Symbol, sp.Expr]) -> None:
        self._lengths = lengths
        self._all = symbols is True
        self._wanted = {} if isinstance(symbols, bool) else dict(symbols)
        self._names: dict[sp.Expr, sp.Symbol] = {}
        self._used: set[str] = set()

    def value(self, text: str) -> sp.Expr:
        """A length, or plus or minus its name."""
        number = exact.length(text)
        if not number:
            return number
        size = abs(number)
        if size not in self._names and self._all:
            self._name(size, f"l{len(self._names) + 1}")
        for name, wanted in self._wanted.items():
            if size not in self._names and abs(float(size) - abs(wanted)) <= 1e-12 * abs(wanted):
                self._name(size, name)
        return number if size not in self._names else sp.sign(number) * self._names[size]

    def _name(self, size: sp.Expr, name: str) -> None:
        if name in self._used or name in map(str, self._lengths):
            raise _collision(name, "another length has it")
        self._used.add(name)
        self._names[size] = sp.Symbol(name, positive=True)
        self._lengths[self._names[size]] = size

    def finish(self) -> None:
        """Refuse names for lengths that do not occur."""
        for name, wanted in self._wanted.items():
            if name not in self._used:
                what = f"no length of {wanted} m is left to be called {name!r}"
                raise InputError("derive-option", what, remedy="give lengths that the file's origins have")


def _check_names(robot: Robot, lengths: Sequence[sp.Symbol], variables: Sequence[Variable]) -> None:
    taken = [str(s) for variable in variables for s in (variable.symbol, variable.rate)]
    for name in taken:
        if taken.count(name) > 1:
            raise _collision(name, "two joints have it")
    for symbol in lengths:
        name = str(symbol)
        if not name.isidentifier() or (name.isascii() and _identifier(name) != name) or keyword.iskeyword(name):
            raise _collision(name, "code and formulas need it for something else", robot)
        if name in taken or _ATOM.fullmatch(name):
            raise _collision(name, "a joint's value, or a sine or cosine, has it", robot)


def _collision(name: str, why: str, robot: Robot | None = None) -> InputError:
    what = f"the symbol {name!r} collides: {why}"
    remedy = 'rename it, or give the joints other names (names="urdf")'
    return InputError("symbol-collision", what, where=robot.name if robot else "", remedy=remedy)
