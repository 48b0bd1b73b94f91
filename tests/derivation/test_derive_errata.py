"""Each printed mistake disagrees with both engines, and what is right agrees with both."""

import pytest

import pinscrew as ps
from pinscrew.derivation import errata
from pinscrew.ground.errors import InputError

ALL = errata.errata()


@pytest.mark.parametrize("erratum", ALL, ids=lambda e: e.where)
def test_printed_is_wrong_and_right_is_right(erratum: errata.Erratum) -> None:
    for verdict in errata.verdicts(erratum):
        assert verdict.printed_error > errata.WRONG
        assert verdict.right_error <= errata.TOLERANCE
        assert verdict.ok


@pytest.mark.parametrize("erratum", ALL, ids=lambda e: e.where)
def test_the_check_would_notice(erratum: errata.Erratum) -> None:
    """Exchanged, the two must fail."""
    from dataclasses import replace

    swapped = replace(erratum, printed=erratum.right, right=erratum.printed)
    assert not any(verdict.ok for verdict in errata.verdicts(swapped))


def test_every_arm_with_errata_has_them() -> None:
    assert {e.arm for e in ALL} == {"A1", "A2", "A4", "A5", "A8", "A10"}
    assert {e.part for e in ALL if e.arm == "A1"} == set("efghik")


def test_report() -> None:
    report = errata.report(ps.load("two_joint"))
    assert report.ok
    assert len(report.sections) == len(errata.errata("two_joint"))
    with pytest.raises(InputError, match="no printed mistakes"):
        errata.report(ps.load("drone"))
