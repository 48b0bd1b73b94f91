"""The progress bar: there where a person sees it, and silent elsewhere."""

from __future__ import annotations

import io
from contextlib import redirect_stderr

import pytest

from pinscrew.cli.progress import progress


class Terminal(io.StringIO):
    """Standard error as a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    monkeypatch.setenv("TERM", "xterm")
    return Terminal()


def test_a_person_sees_it(terminal: Terminal) -> None:
    with redirect_stderr(terminal), progress("counting [red]", 3) as advance:
        advance()
        advance(2, "done")
    shown = terminal.getvalue()
    assert "counting [red]" in shown
    assert "done" in shown
    assert "3/3" in shown


def test_two_steps_are_some(terminal: Terminal) -> None:
    with redirect_stderr(terminal), progress("counting", 2) as advance:
        advance(2)
    assert "2/2" in terminal.getvalue()


def test_one_step_needs_none(terminal: Terminal) -> None:
    with redirect_stderr(terminal), progress("counting", 1) as advance:
        advance()
    assert terminal.getvalue() == ""


def test_elsewhere_it_is_silent() -> None:
    unseen = io.StringIO()
    with redirect_stderr(unseen), progress("counting", 3) as advance:
        advance(3, "done")
    assert unseen.getvalue() == ""
