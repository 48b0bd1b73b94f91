"""Every error and warning of pinscrew: one base class, a small tree below it.

A message has the form *where: what; what to do*. Its parts are attributes, and ``code`` is a short stable
word for the kind of mistake, so that a program need not read the sentence.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, TypeVar

from pinscrew.ground.words import brief, one_line

__all__ = [
    "AmbiguousTipError",
    "DescriptionError",
    "EngineError",
    "InputError",
    "MissingExtraError",
    "PinscrewError",
    "PinscrewWarning",
    "UnknownNameError",
    "UnsupportedError",
    "ViewError",
    "XacroError",
]

_E = TypeVar("_E", bound=Exception)

LONGEST: Final = 1200
"""Characters of what is wrong, and of the remedy, in a message."""
MOST_NAMES: Final = 40
"""Names that a message lists; ``known`` has them all."""


class PinscrewError(Exception):
    """Base of all errors that pinscrew raises on purpose.

    Attributes:
        code: stable word for the kind of mistake, such as ``"zero-axis"``.
        what: what is wrong.
        where: the place, or ``""``.
        remedy: what would be right, or ``""``.
    """

    def __init__(self, code: str, what: str, *, where: str = "", remedy: str = "") -> None:
        self.code = code
        self.what = what
        self.where = where
        self.remedy = remedy
        # Names and paths may hold anything, at any length; the attributes keep them as they are.
        message = f"{brief(where)}: {brief(what, LONGEST)}" if where else brief(what, LONGEST)
        super().__init__(one_line(f"{message}; {brief(remedy, LONGEST)}" if remedy else message))

    def __reduce__(self) -> tuple[Any, ...]:
        # Subclasses take other arguments than Exception keeps, so pickle must not call them to copy an error.
        return _restore, (type(self), self.args, self.__dict__)


def _restore(kind: type[_E], arguments: tuple[Any, ...], attributes: dict[str, Any]) -> _E:
    error = kind.__new__(kind, *arguments)
    error.args = arguments
    error.__dict__.update(attributes)
    return error


class DescriptionError(PinscrewError):
    """A robot's file, or one that goes with it, can't be used as it is.

    Attributes:
        file: the file, or a name for text that came from elsewhere; for xacro the one that has the element.
        line: line of the element in the file, or ``None``.
        element: the element, such as ``joint 'elbow'``, or ``""``.
    """

    def __init__(
        self,
        code: str,
        what: str,
        *,
        file: str | Path,
        line: int | None = None,
        element: str = "",
        remedy: str = "",
    ) -> None:
        self.file = str(file)
        self.line = line
        self.element = element
        where = self.file if line is None else f"{self.file}:{line}"
        super().__init__(code, f"{element}: {what}" if element else what, where=where, remedy=remedy)


class XacroError(DescriptionError):
    """A xacro file can't be expanded: an undeclared argument, a forbidden expression, a failed macro."""


class UnsupportedError(DescriptionError):
    """The file is valid, but asks for something that pinscrew or one of its engines does not do."""


class InputError(PinscrewError, ValueError):
    """An argument of a call has the wrong shape, value or unit."""


class UnknownNameError(PinscrewError, LookupError):
    """A robot, frame, joint or xacro argument that does not exist.

    Attributes:
        name: the name that was asked for.
        known: the names that exist.
    """

    def __init__(self, code: str, kind: str, name: str, known: tuple[str, ...], *, where: str = "") -> None:
        self.name = name
        self.known = known
        listed = ", ".join(known[:MOST_NAMES]) if known else "none"
        if len(known) > MOST_NAMES:
            listed += f", … ({len(known)} in all)"
        super().__init__(code, f"there is no {kind} {name!r}", where=where, remedy=f"known are: {listed}")


class AmbiguousTipError(PinscrewError, ValueError):
    """The robot has several leaves, so there is no default tip.

    Attributes:
        leaves: the leaf frames, any of which can be the tip.
    """

    def __init__(self, robot: str, leaves: tuple[str, ...]) -> None:
        self.leaves = leaves
        super().__init__(
            "ambiguous-tip",
            f"{len(leaves)} leaves and no default tip",
            where=robot,
            remedy=f"name a frame; the leaves are: {', '.join(leaves)}",
        )


class MissingExtraError(PinscrewError, ImportError):
    """An optional dependency is not installed.

    Attributes:
        extra: the extra of pinscrew that installs it.
    """

    def __init__(self, what: str, extra: str) -> None:
        self.extra = extra
        super().__init__("missing-extra", what, remedy=f'install it with: pip install "pinscrew[{extra}]"')


class EngineError(PinscrewError, RuntimeError):
    """An engine refused a robot that the description accepts; the message carries the engine's own words."""


class ViewError(PinscrewError, RuntimeError):
    """A robot can't be shown: the view's server or the browser fails."""


class PinscrewWarning(UserWarning):
    """Something in a file was put right or ignored; the message says what, where and how.

    Attributes:
        code: stable word for the kind of remark, such as ``"axis-normalised"``.
        what: the remark.
        file: the file that it is about, or ``""``.
        line: line of the element in the file, or ``None``.
    """

    def __init__(self, code: str, what: str, *, file: str | Path = "", line: int | None = None) -> None:
        self.code = code
        self.what = what
        self.file = str(file)
        self.line = line
        where = self.file if line is None else f"{self.file}:{line}"
        super().__init__(f"{where}: {what}" if where else what)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.args, self.__dict__)
