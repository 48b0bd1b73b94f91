"""Every URDF of example-robot-data: the engines agree on each link, or the file is refused for what is wrong in it."""

from __future__ import annotations

import warnings
from typing import Final

import pytest

import pinscrew as ps
from pinscrew.description import catalogue
from pinscrew.ground.errors import DescriptionError, MissingExtraError, PinscrewWarning

try:
    ENTRIES = catalogue.example_robots()
except MissingExtraError as missing:
    pytest.skip(str(missing), allow_module_level=True)

REFUSED: Final = {
    "ur3": ("no-links", "has no links"),
    "alex_psyonic_hands": ("mimic-unknown", "no joint is called so"),
}
ACCEPTED: Final = [entry for entry in ENTRIES if entry.name not in REFUSED]


def name_of(entry: catalogue.Entry) -> str:
    return entry.name


def load(entry: catalogue.Entry, *, floating_base: bool = False) -> ps.Robot:
    """A robot; what was put right in its file is no news here."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PinscrewWarning)
        return ps.load(entry.name, floating_base=floating_base)


def test_the_corpus_is_whole() -> None:
    assert len(ENTRIES) >= 69  # as many as there are in 6.0.0
    assert REFUSED.keys() <= {entry.name for entry in ENTRIES}


@pytest.mark.parametrize("name", REFUSED)
def test_refused(name: str) -> None:
    code, words = REFUSED[name]
    with pytest.raises(DescriptionError) as caught:
        ps.load(name)
    error = caught.value
    assert error.code == code
    assert words in error.what
    assert error.remedy
    assert error.line is not None
    assert error.file == str(catalogue.find(name).file)


@pytest.mark.parametrize("entry", ACCEPTED, ids=name_of)
def test_engines_agree(entry: catalogue.Entry) -> None:
    report = ps.verify(load(entry), samples=5)
    assert report.ok, str(report)


@pytest.mark.parametrize("entry", ACCEPTED[::6], ids=name_of)
def test_engines_agree_on_floating_robots(entry: catalogue.Entry) -> None:
    report = ps.verify(load(entry, floating_base=True), samples=1)
    assert report.ok, str(report)


@pytest.mark.slow
@pytest.mark.parametrize("floating_base", [False, True])
@pytest.mark.parametrize("entry", ACCEPTED, ids=name_of)
def test_engines_agree_everywhere(entry: catalogue.Entry, floating_base: bool) -> None:
    report = ps.verify(load(entry, floating_base=floating_base), samples=100)
    assert report.ok, str(report)
