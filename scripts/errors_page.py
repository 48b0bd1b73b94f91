"""Write docs/errors.md from the errors' docstrings and the list of their codes.

python scripts/errors_page.py           # write
python scripts/errors_page.py --check   # exit status 1 if it is not up to date
"""

from __future__ import annotations

import inspect
import sys
from pathlib import Path

from generated import write_or_check
from pinscrew.ground import error_codes, errors

PAGE = Path(__file__).resolve().parents[1] / "docs" / "errors.md"

INTRODUCTION = """\
# Errors

Every error that pinscrew raises on purpose is a `pinscrew.PinscrewError`. Its message says *where: what; what to do*,
and its parts are attributes. `code` is a stable word for the kind of mistake. On the command line such an error is one
line on standard error, a mistake in the command itself comes with how it is used, and the exit status is 2. The classes
are in `pinscrew.errors`.

This page is written by `scripts/errors_page.py`.

## Classes
"""


def classes() -> list[type[errors.PinscrewError]]:
    """The error classes, bases before their subclasses."""
    found = [value for value in vars(errors).values() if inspect.isclass(value)]
    return [value for value in found if issubclass(value, errors.PinscrewError)]


def section(kind: type[errors.PinscrewError]) -> str:
    """A class: its name, bases and docstring."""
    bases = ", ".join(f"`{base.__name__}`" for base in kind.__bases__)
    summary, _, rest = inspect.cleandoc(kind.__doc__ or "").partition("\n\n")
    lines = [f"### `{kind.__name__}`", "", f"{summary} Base: {bases}."]
    attributes = rest.removeprefix("Attributes:\n")
    if attributes:
        lines.append("")
        for line in attributes.splitlines():
            name, _, what = line.strip().partition(": ")
            lines.append(f"- `{name}`: {what}" if line.startswith("    ") and line[4] != " " else f"  {line.strip()}")
    return "\n".join(lines)


def table(codes: dict[str, str]) -> str:
    """Codes and what they mean."""
    return "\n".join(
        ["| code | meaning |", "| --- | --- |", *(f"| `{code}` | {text} |" for code, text in codes.items())]
    )


def page() -> str:
    """The page, in Markdown."""
    parts = [INTRODUCTION, *(f"{section(kind)}\n" for kind in classes())]
    parts += [f"## Codes of errors\n\n{table(error_codes.ERRORS)}\n"]
    parts += ["## Codes of warnings\n"]
    parts += ["What is put right or ignored in a file is a `pinscrew.PinscrewWarning`, with a `code`.\n"]
    return "\n".join([*parts, table(error_codes.WARNINGS), ""])


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page()))
