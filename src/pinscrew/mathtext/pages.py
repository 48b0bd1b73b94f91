"""The formulas of a whole text, in LaTeX: of Markdown, LaTeX, a notebook, or a page with MathML."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Final

from pinscrew.mathtext import mathml

__all__ = ["formulas"]

_INLINE: Final = r"(?<![\\$])\$((?:[^$\\]|\\.)+)\$"
_MARKDOWN: Final = re.compile(r"\$\$\n(.*?)\n\$\$|" + _INLINE, re.DOTALL)
_LATEX: Final = re.compile(r"^\\fitted\{(.*)\}$|" + _INLINE, re.MULTILINE)


def formulas(text: str, form: str) -> Iterator[str]:
    """The formulas of a text, in order; ``form`` is ``"markdown"``, ``"latex"``, ``"notebook"`` or ``"html"``.

    Raises:
        InputError: MathML cannot be read.
    """
    if form == "html":
        yield from mathml.formulas(text)
    elif form == "notebook":
        for cell in json.loads(text)["cells"]:
            if cell["cell_type"] == "markdown":
                yield from formulas("".join(cell["source"]), "markdown")
    else:
        for match in (_LATEX if form == "latex" else _MARKDOWN).finditer(text):
            yield match[1] or match[2]
