"""What reports and code say, read back from their text by the library: every matrix, in every format."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import pytest
from random_arms import awkward_arm, puma, random_arm

import pinscrew as ps
import urdfs
from pinscrew.derivation import proof, read_back, reports
from pinscrew.derivation.code import LANGUAGES, code
from pinscrew.derivation.forms import ClosedForms
from pinscrew.derivation.parts import PARTS
from pinscrew.derivation.read_back_code import read_back_code
from pinscrew.description import catalogue

NAMES = [entry.name for entry in catalogue.bundled()]
FORMATS = ("markdown", "latex", "notebook", "html")
NOT_PROVED = proof.Proof(0, 0, 0, (), None)


@cache
def derivation(name: str, convention: Any = "mls") -> Any:
    return ps.derive(ps.load(name), convention=convention)


def text(d: Any, form: str, parts: tuple[str, ...] = ()) -> str:
    return reports.write(reports.report(d, NOT_PROVED, parts), form)


@cache
def markdown(name: str) -> str:
    return text(derivation(name), "markdown")


def check(d: ClosedForms, forms: tuple[str, ...], parts: tuple[str, ...] = ()) -> None:
    for form in forms:
        found = read_back.read_back(d, written := text(d, form, parts), form)
        if form in ("markdown", "latex"):
            assert found.matrices + found.general == written.count(r"\begin{bmatrix}")
        assert found.alone == 0
        assert found.general <= 13
        assert found.matrices >= 20
        assert found.largest < (1e-11 if d.exact else 1e-5)


@pytest.mark.parametrize("name", NAMES)
def test_every_matrix_of_every_format(name: str) -> None:
    check(derivation(name), ("html", FORMATS[NAMES.index(name) % 3]), () if derivation(name).follows else tuple(PARTS))


@pytest.mark.parametrize("name", NAMES[:2])
def test_the_other_book(name: str) -> None:
    check(derivation(name, "lynch-park"), FORMATS)


@pytest.mark.parametrize("seed", range(3))
def test_awkward_arms(seed: int) -> None:
    any_arm(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3, 50))
def test_more_awkward_arms(seed: int) -> None:
    any_arm(seed)


def any_arm(seed: int) -> None:
    names: Any = ("urdf", "theta", "d")[seed % 3]
    convention: Any = ("mls", "lynch-park")[seed // 3 % 2]
    robot = urdfs.load(awkward_arm(seed) if seed % 2 == 0 else random_arm(seed, 2, ("30", "45", "any")[seed // 2 % 3]))
    d = ps.derive(robot, symbols=seed % 4 < 2, names=names, convention=convention)
    check(d, ("latex", "html"))
    for language in LANGUAGES:
        read_back_code(d, code(d, language, "spatial"), language, "spatial")


@pytest.mark.slow
@pytest.mark.parametrize(("name", "tip"), [("ur5_robot", "tool0"), ("panda", "panda_link8"), ("puma", None)])
def test_large_arms(name: str, tip: str | None) -> None:
    robot = urdfs.load(puma()) if name == "puma" else ps.load(name)
    d = ps.derive(robot, tip, symbols=name != "panda")
    check(d, FORMATS)
    for language in LANGUAGES:
        read_back_code(d, code(d, language), language, "body")


@pytest.mark.parametrize("frames", [("link1", "tool"), ("tool", "base"), ("base", "link2")])
def test_between_any_frames(frames: tuple[str, str]) -> None:
    check(ps.derive(ps.load("anthropomorphic_rrr"), frames[1], reference=frames[0]), ("markdown",))


# ----------------------------------------------------------------------------------- a check must be seen to fail


def broken(name: str, written: str, form: str = "markdown") -> bool:
    try:
        read_back.read_back(derivation(name), written, form)
    except read_back.ReadBackError as error:
        return error.code == "read-back"
    return False


def matrices(written: str) -> list[tuple[int, int]]:
    """Where the matrices of entries are."""
    found = re.finditer(r"\\begin\{bmatrix\}((?:(?!\\begin).)*?)\\end\{bmatrix\}", written)
    return [m.span(1) for m in found if not re.search(r"R|\\omega|\\xi|\\hat", m[1])]


@pytest.mark.parametrize(
    ("what", "old", "new"),
    [
        ("sign", "-", ""),
        ("sign", " + ", " - "),
        ("opening parenthesis", "(", ""),
        ("pair of parentheses", r"\((L_\{3\} \+ \\theta_\{3\})\)", r"\1"),
        ("dot", r"\\dot\{\\theta\}", r"\\theta"),
        ("index", "_{1}", "_{2}"),
        ("function", "c_", "s_"),
        ("zero", " 0 ", " 1 "),
        ("factor", r"L_\{0\} ", ""),
        ("column", " & ", " "),
    ],
)
def test_a_slip_anywhere_is_seen(what: str, old: str, new: str) -> None:
    name, written = "spherical_rrp", markdown("spherical_rrp")
    pattern = old if "\\" in old else re.escape(old)
    places = [
        start + match.start() for start, end in matrices(written) for match in re.finditer(pattern, written[start:end])
    ]
    assert len(places) > 2, what
    for place in places[:: max(1, len(places) // 6)]:
        spoilt = written[:place] + re.sub(pattern, new, written[place:], count=1)
        assert spoilt != written
        assert broken(name, spoilt), spoilt[place - 60 : place + 60]


@pytest.mark.parametrize(("form", "old", "new"), [
    ("latex", r"-s_{2} \dot{\theta}_{1}", r"s_{2} \dot{\theta}_{1}"),
    ("notebook", r"-s_{2} \\dot{\\theta}_{1}", r"s_{2} \\dot{\\theta}_{1}"),
    ("html", "<mo>&#x002D9;</mo>", "<mo>&#x000A8;</mo>"),
    ("html", '<mo stretchy="false">&#x00028;</mo><msub><mi>L</mi>', "<msub><mi>L</mi>"),
])  # fmt: skip
def test_a_slip_in_other_formats_is_seen(form: str, old: str, new: str) -> None:
    written = text(derivation("spherical_rrp"), form)
    assert old in written
    assert broken("spherical_rrp", written.replace(old, new), form)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (r"c_{2} = \cos \theta_{2}", r"c_{2} = \sin \theta_{2}"),
        (r"\theta_{2} = -\frac{N_{1} \theta_{1}}{N_{2}}", r"\theta_{2} = \frac{N_{1} \theta_{1}}{N_{2}}"),
        ("0.001 (N_{1} + N_{2})", "0.001 N_{1} + N_{2}"),
        (r"\dot{\theta}_{2} = -\frac", r"\dot{\theta}_{2} = \frac"),
    ],
)
def test_a_slip_in_what_is_explained_is_seen(old: str, new: str) -> None:
    assert old in markdown("gear_pair")
    assert broken("gear_pair", markdown("gear_pair").replace(old, new, 1))


def test_two_symbols_that_print_alike_are_refused() -> None:
    d = ps.derive(ps.load("two_joint"), names="urdf")
    object.__setattr__(d, "lengths", {**d.lengths, type(next(iter(d.lengths)))("joint_1"): 1})
    with pytest.raises(read_back.ReadBackError, match="printed alike"):
        read_back.read_back(d, "", "markdown")


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_slip_in_code_is_seen(language: str) -> None:
    d = derivation("spherical_rrp")
    right = code(d, language)
    read_back_code(d, right, language, "body")
    for old, new in (("cos(", "sin("), ("L3", "L0"), ("-", "+"), ("s2", "c2")):
        place = right.rindex(old)
        with pytest.raises(read_back.ReadBackError):
            read_back_code(d, right[:place] + new + right[place + len(old) :], language, "body")
    with pytest.raises(read_back.ReadBackError, match="cannot be read"):
        read_back_code(d, right.replace("jacobian", "jakobian"), language, "body")
    with pytest.raises(read_back.ReadBackError, match="off by"):
        read_back_code(d, right, language, "spatial")


def test_reports_say_that_they_were_read_back(monkeypatch: pytest.MonkeyPatch) -> None:
    d = derivation("one_joint")
    whole = reports.report(d, NOT_PROVED)
    for form in FORMATS:
        said = re.search(r"This text was read back: (\d+) matrices", reports.written(d, whole, form))
        assert said
        assert int(said[1]) == read_back.read_back(d, reports.write(whole, form), form).matrices
    spoilt = markdown("one_joint").replace("c_{1}", "s_{1}")
    with monkeypatch.context() as patched:
        patched.setitem(reports._FORMATS, "markdown", lambda _: spoilt)
        with pytest.raises(read_back.ReadBackError):
            reports.written(d, whole, "markdown")
