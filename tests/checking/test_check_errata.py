"""The printed mistakes of the courseworks, found by `check` itself."""

from __future__ import annotations

import json

import pytest

import pinscrew as ps
from command_line import run
from pinscrew.checking.coursework import check_errata


def test_two_joint() -> None:
    found = check_errata("two_joint")
    assert (found.located, len(found.found)) == (10, 10)
    by_place = {(each.erratum.quantity, each.erratum.printed): each.slip for each in found.found}
    assert by_place["body hat", "-l1*s2*dtheta1"] == "the sign of entry (2, 4)"
    assert by_place["body Jacobian", "-l1*c2 - l2"] == "entry (1, 2): the term -l1*c2 is too many"
    assert by_place["body velocity", "-l1*dtheta1"] == "the sign"
    assert "no single slip explains it" in str(found)


@pytest.mark.slow
def test_all() -> None:
    """Every entry of the list comes out by itself, and no other entry of its matrix; nine in ten are explained."""
    found = check_errata()
    assert (found.located, len(found.found)) == (96, 96)
    assert found.explained >= 90
    unexplained = [each.erratum.slip for each in found.found if not each.slip]
    assert set(unexplained) <= {"copied", "term", "formula", "sign", "name"}


def test_command() -> None:
    done = run("check", "planar_2r", "--errata", "--json")
    assert done.status == 0
    document = json.loads(done.out)
    assert document["schema"] == "pinscrew.check-errata/1"
    assert document["located"] == len(document["errata"]) > 10
    assert "located" in run("check", "planar_2r", "--errata", "--format", "markdown").out
    assert run("check", "gear_pair", "--errata").status == 2
    assert run("check", "planar_2r", "--errata", "--format", "html").status == 2
    with pytest.raises(ps.PinscrewError, match="there are errata for"):
        check_errata("gear_pair")
