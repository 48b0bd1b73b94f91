"""The documentation as a site: `scripts/site` builds it, offline, and takes warnings for errors.

The pages are Markdown that reads as well where the repository is kept. Mathematics becomes MathML while the site is
built, so that a reader's browser fetches nothing.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

from docutils import nodes
from latex2mathml.converter import convert

from pinscrew.cli import command as pinscrew
from pinscrew.description.catalogue import bundled
from pinscrew.ground.escaping import html
from pinscrew.ground.version import __version__

REPOSITORY: Final = "https://github.com/OWNER/pinscrew"  # OWNER as in pyproject.toml

CARD: Final = """\
:::{{grid-item-card}} {title}
:img-top: gallery/{name}.png
<a href="robots/{name}.html">Move it</a> · <a href="robots/{name}-derivation.html">Derive it</a> · `{name}`
:::
"""

project = "pinscrew"
author = "The pinscrew developers"
copyright = author  # noqa: A001 (Sphinx's name)
release = version = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_design"]
exclude_patterns = ["gallery", "site"]
default_role = "py:obj"  # `Robot.frame` in a docstring
html_theme = "furo"
html_title = "pinscrew"
html_static_path = ["site"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = False
html_math_renderer = "mathml"
html_theme_options = {"source_repository": REPOSITORY, "source_branch": "main", "source_directory": "docs/"}
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4
suppress_warnings = ["misc.highlighting_failure"]  # Pygments colours no CSV
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
napoleon_use_rtype = False
napoleon_attr_annotations = False  # numpy.str_ would be a reference to "numpy.str"


def visit_math(self: Any, node: nodes.math) -> None:
    """A formula within a line."""
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def visit_math_block(self: Any, node: nodes.math_block) -> None:
    """A formula of its own."""
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def lead_to_the_repository(_app: Any, _page: str, source: list[str]) -> None:
    """Links out of docs/ lead to where the repository is kept."""
    source[0] = re.sub(r"\]\(\.\./([^)#]+)", rf"]({REPOSITORY}/blob/main/\1", source[0])


def show_the_robots(_app: Any, page: str, source: list[str]) -> None:
    """On the page of robots, a card for each that comes with pinscrew."""
    if page == "robots":
        cards = [CARD.format(title=html(entry.title), name=entry.name) for entry in bundled()]
        source[0] = source[0].replace("<!-- robots -->", "\n".join(cards))


def write_the_robots(app: Any, problem: Exception | None) -> None:
    """The live page and the derivation of each robot, which that page leads to."""
    if problem is None and app.builder.name == "html":
        folder = Path(app.outdir, "robots")
        folder.mkdir(exist_ok=True)
        for entry in bundled():
            page, paper = folder / f"{entry.name}.html", folder / f"{entry.name}-derivation.html"
            pinscrew(["show", entry.name, "--html", str(page)], standalone_mode=False)
            pinscrew(["derive", entry.name, "--format", "html", "-o", str(paper)], standalone_mode=False)


def setup(app: Any) -> dict[str, bool]:
    """Hook in what is above."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    app.connect("source-read", lead_to_the_repository)
    app.connect("source-read", show_the_robots)
    app.connect("build-finished", write_the_robots)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
