"""The arguments of a xacro file: which it declares and uses, and which it lacks, told all at once."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final

from pinscrew.description.markup import Element
from pinscrew.ground.words import brief

__all__ = ["NeedsError", "XacroArguments"]

_USES: Final = re.compile(r"""\$\(\s*arg\s+([^\s()$]+)\s*\)|\barg\(\s*['"]([^'"]+)['"]\s*\)""")
_STAND_IN: Final = "0"
"""The value of an argument that is missing, so that the others that are can be found: a number, false, a text."""
MOST_CHOICES: Final = 30
"""Values that are offered for an argument."""


class NeedsError(FileNotFoundError):
    """A file is not there since an argument that is part of its name has a value for which there is none.

    Attributes:
        argument: the argument's name.
        choices: values for which there are files.
    """

    def __init__(self, path: str, argument: str, choices: tuple[str, ...]) -> None:
        super().__init__(2, "there is no such file", path)
        self.argument = argument
        self.choices = choices


class XacroArguments(dict[str, str]):
    """The values of the arguments, those given and then the defaults: what xacro looks ``$(arg name)`` up in.

    Attributes:
        declared: the defaults of those that the files read so far declare, None where there is none.
        used: file and line where each that they use is used first.
        missing: those that were used and had no value.
    """

    def __init__(self, given: Mapping[str, str]) -> None:
        super().__init__(given)
        self.given = dict(given)
        self.declared: dict[str, str | None] = {}
        self.used: dict[str, tuple[str, int]] = {}
        self.missing: dict[str, None] = {}

    def __missing__(self, name: str) -> str:
        self.missing[name] = None
        return _STAND_IN

    def note(self, root: Element, file: Path) -> None:
        """Take down what the elements of a file declare and use."""
        pending = [root]
        while pending:
            element = pending.pop()
            attributes = element.attributes
            if element.tag == "xacro:arg":
                self.declared.setdefault(attributes.get("name", ""), attributes.get("default"))
            for text in (*attributes.values(), element.text):
                for match in _USES.finditer(text):
                    self.used.setdefault(match[1] or match[2], (str(file), element.line))
            pending.extend(reversed(element.children))

    def unknown(self) -> list[str]:
        """The arguments that were given, and that no file declares or uses."""
        return [name for name in self.given if name not in self.declared and name not in self.used]

    def listed(self) -> str:
        """The declared arguments, and their defaults."""
        rows = (name if default is None else f"{name}:={default}" for name, default in self.declared.items())
        return f"declared are: {', '.join(map(brief, rows)) or 'none'}"

    def needs(self, because: NeedsError | None) -> str:
        """What to say of the arguments that are missing, and of one for whose value there is no file; "" if none is."""
        choices = {} if because is None else {because.argument: because.choices}
        wanted = dict.fromkeys([*self.missing, *choices])
        return ", ".join(f"{brief(name)}:=…{_offer(choices.get(name, ()))}" for name in wanted)

    def at(self, because: NeedsError | None) -> tuple[str, int] | None:
        """Where the first of these is used."""
        for name in (*self.missing, *(() if because is None else (because.argument,))):
            if name in self.used:
                return self.used[name]
        return None

    def absent(self, path: Path) -> FileNotFoundError:
        """The error for a file that is not there: one that names the argument whose value is part of its name."""
        folder, part = path.parent, path.name
        while not folder.is_dir() and folder != folder.parent:
            folder, part = folder.parent, folder.name
        for name, value in (*self.items(), *((name, _STAND_IN) for name in self.missing)):
            if value and part in (value, f"{value}{Path(part).suffix}"):
                choices = tuple(_beside(folder, Path(part).suffix if part != value else None))
                if choices:
                    return NeedsError(str(path), name, choices)
        return FileNotFoundError(2, "there is no such file", str(path))


def _beside(folder: Path, suffix: str | None) -> Iterator[str]:
    """The names of the folders in a folder, or of its files with this suffix, without it."""
    for child in sorted(folder.iterdir()):
        if suffix is None and child.is_dir():
            yield child.name
        elif suffix is not None and child.suffix == suffix:
            yield child.stem


def _offer(choices: tuple[str, ...]) -> str:
    if not choices:
        return ""
    return f" (one of {', '.join(choices[:MOST_CHOICES])}{', …' * (len(choices) > MOST_CHOICES)})"
