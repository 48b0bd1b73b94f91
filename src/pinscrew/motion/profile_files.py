"""Reading profiles: pieces from YAML, tables from CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pinscrew.description import markup
from pinscrew.ground.errors import InputError
from pinscrew.motion.pieces import Piece, Pieces, Spot, expression
from pinscrew.motion.rates import Rates
from pinscrew.motion.samples import Between, Samples, check_between

if TYPE_CHECKING:
    import yaml

    from pinscrew.ground.expressions import Expression

__all__ = ["SUFFIXES", "read"]

SUFFIXES: Final = (".yaml", ".yml", ".csv")
MOST_YAML: Final = 1_000_000
"""Characters of a profile in YAML, which is read slowly; a CSV file may have twenty times as many."""


def read(path: Path, between: Between = "linear") -> Rates:
    """The rates in a file; see `Profile.read`."""
    check_between(between)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        what = f"a profile can't be read from a file with the suffix {path.suffix!r}"
        raise InputError("profile-format", what, where=str(path), remedy=f"use {', '.join(SUFFIXES)}")
    text = markup.read(path)
    return _table(text, str(path), between) if suffix == ".csv" else _pieces(text, str(path))


# --------------------------------------------------------------------------------------------------- YAML


def _pieces(text: str, source: str) -> Pieces:
    """The document is read as text with lines, and never as objects: nothing in it is run or made."""
    import yaml

    if len(text) > MOST_YAML:
        raise Spot(source).error("too-large", f"larger than {MOST_YAML / 1e6:g} MB", "use CSV for a large table")
    try:
        document = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        line = None if error.problem_mark is None else error.problem_mark.line + 1
        raise Spot(source, line).error("profile-format", f"is no YAML ({error.problem or error.context})") from None
    except yaml.YAMLError as error:
        raise Spot(source).error("profile-format", f"is no YAML ({error})") from None
    except RecursionError:
        raise Spot(source).error("profile-format", "is nested too deeply") from None
    top = dict(_entries(document, Spot(source, 1), ("rates",), required=("rates",)))
    rates = dict(_entries(top["rates"], Spot(source, _line(top["rates"]), "rates")))
    return Pieces({name: _rates(name, node, source) for name, node in rates.items()}, source)


def _rates(name: str, node: yaml.Node, source: str) -> list[Piece] | Expression:
    """The pieces of a velocity, or the one expression for all times."""
    if node.id == "scalar":
        return expression(node.value, Spot(source, _line(node), name))
    if node.id != "sequence":
        remedy = "write a list of {when: 0 <= t <= 1, rate: 0.1*t}, or one rate for all times"
        raise Spot(source, _line(node), name).error("profile-format", "is no list of pieces", remedy)
    found = []
    for i, each in enumerate(node.value, 1):
        place = Spot(source, _line(each), f"{name}, piece {i}")
        parts = dict(_entries(each, place, ("when", "rate"), required=("when", "rate")))
        for key, part in parts.items():
            if part.id != "scalar":
                raise place.error("profile-format", f"{key!r} is no text", "write such as 0 <= t <= 1, and 0.1*t")
        found.append(Piece.of(parts["when"].value, parts["rate"].value, place))
    return found


def _entries(
    node: yaml.Node | None, place: Spot, known: tuple[str, ...] = (), required: tuple[str, ...] = ()
) -> Iterator[tuple[str, yaml.Node]]:
    """The entries of a mapping, each key once and, if some are known, one of them."""
    if node is None or node.id != "mapping":
        expected = " and ".join(known) if known else "one entry for each velocity"
        raise place.error("profile-format", "is no mapping", f"expected {expected}")
    seen: set[str] = set()
    for key, value in node.value:
        name = key.value if key.id == "scalar" else "?"
        where = Spot(place.source, _line(key), place.element)
        if name in seen:
            raise where.error("duplicate-name", f"{name!r} is there twice", "remove one of them")
        if known and name not in known:
            raise where.error("profile-format", f"{name!r} means nothing here", f"use {', '.join(known)}")
        seen.add(name)
        yield name, value
    for name in required:
        if name not in seen:
            raise place.error("profile-format", f"{name!r} is missing", f"expected {' and '.join(required)}")


def _line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1


# ---------------------------------------------------------------------------------------------------- CSV


def _table(text: str, source: str, between: Between) -> Samples:
    """A header ``t,joint1,joint2`` and rows of numbers."""
    rows = csv.reader(io.StringIO(text, newline=""), strict=True)
    header: list[str] = []
    values: list[list[float]] = []
    try:
        for row in rows:
            cells = [cell.strip() for cell in row]
            if not any(cells):
                continue
            place = Spot(source, rows.line_num)
            if not header:
                header = _header(cells, place)
                continue
            if len(cells) != len(header):
                what = f"{len(cells)} columns, but the header has {len(header)}"
                raise place.error("profile-table", what, f"expected {', '.join(header)}")
            values.append([_number(cell, name, place) for cell, name in zip(cells, header, strict=True)])
            if len(values) > 1 and not values[-1][0] > values[-2][0]:
                what = f"t = {values[-1][0]:g} s comes after {values[-2][0]:g} s"
                raise place.error("profile-table", what, "times must increase from row to row")
    except csv.Error as error:
        raise Spot(source, rows.line_num).error("profile-table", f"is no CSV ({error})") from None
    if len(values) < 2:
        what = f"{len(values)} rows of numbers"
        raise Spot(source).error("profile-table", what, "expected a header t,joint1,… and at least two rows")
    return Samples(header[1:], [row[0] for row in values], [row[1:] for row in values], between, source)


def _header(cells: list[str], place: Spot) -> list[str]:
    if cells[0] != "t":
        raise place.error("profile-table", f"the first column is {cells[0]!r}", "expected a header t,joint1,…")
    for i, name in enumerate(cells):
        if not name:
            raise place.error("profile-table", f"column {i + 1} has no name", "expected a header t,joint1,…")
        if name in cells[:i]:
            raise place.error("duplicate-name", f"{name!r} is there twice", "remove one of them")
    return cells


def _number(cell: str, name: str, place: Spot) -> float:
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise place.error("profile-table", f"{name} is {cell!r}, no finite number", "write such as 0.1 or -1e-3")
    return value
