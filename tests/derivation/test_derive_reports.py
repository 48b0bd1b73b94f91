"""Reports: complete, and readable by what is to read them: a browser without a network, TeX, a notebook."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest

import pinscrew as ps
from chromium import BROWSER, FLAGS
from pinscrew.derivation import reports
from pinscrew.derivation.blocks import Formula, Writeup
from pinscrew.derivation.parts import PARTS
from pinscrew.ground.errors import InputError


@cache
def make(robot: str, convention: Any = "mls", tip: str | None = None) -> Writeup:
    d = ps.derive(ps.load(robot), tip, convention=convention)
    return reports.report(d, d.prove(10))


def test_all_parts_of_the_coursework() -> None:
    keys = [section.key for section in make("spherical_rrp").sections]
    assert keys == ["given", *(key for key, letter in PARTS.items() if letter <= "m"), "proof"]
    letters = "".join(section.letter for section in make("spherical_rrp").sections)
    assert letters == "abcdefghijklm"


def test_parts_are_picked_by_letter_or_key() -> None:
    d = ps.derive(ps.load("two_joint"))
    proof = d.prove(5)
    found = reports.report(d, proof, ["i", "pose", "n"])
    assert [s.key for s in found.sections] == ["given", "pose", "body-jacobian", "singularities", "proof"]
    with pytest.raises(InputError, match="no part 'z'"):
        reports.report(d, proof, ["z"])


def test_markdown() -> None:
    text = reports.write(make("spherical_rrp"), "markdown")
    assert r"L_{0} - (L_{3} + \theta_{3}) s_{2}" in text
    assert "It is (h), entry for entry." in text
    assert text.count("$$") % 2 == 0
    assert "Everything agrees" in text


def test_lynch_park() -> None:
    text = reports.write(make("spherical_rrp", "lynch-park"), "markdown")
    assert r"e^{[\mathcal{S}_{1}] \theta_{1}}" in text
    assert "(ω, v)" in text
    assert r"\mathcal{S}_{2} = \begin{bmatrix} -1 \\ 0 \\ 0 \\ 0 \\ -L_{0} \\ 0 \end{bmatrix}" in text
    assert r"\xi" not in text


def test_lead_screw_has_its_pitch() -> None:
    text = reports.write(make("lead_screw"), "markdown")
    assert r"pitch $h = \frac{\mathrm{lead}}{2 \pi}$" in text


def test_a_failed_proof_is_loud() -> None:
    d = ps.derive(ps.load("two_joint"))
    wrong = d.pose.as_mutable()
    wrong[0, 3] = -wrong[0, 3]
    d.__dict__["pose"] = wrong.as_immutable()
    proof = d.prove(5)
    assert not proof.ok
    report = reports.report(d, proof)
    assert not report.ok
    assert "DISAGREES" in reports.write(report, "markdown")
    assert 'class="failed"' in reports.write(report, "html")


def test_unknown_format() -> None:
    with pytest.raises(InputError, match="pdf"):
        reports.write(make("two_joint"), "pdf")


def test_html_refers_to_nothing_outside() -> None:
    text = reports.write(make("spherical_rrp"), "html")
    body = text.replace("http://www.w3.org/1998/Math/MathML", "").replace("http-equiv=", "")
    assert "http" not in body
    assert not re.search(r"(src|href)=\"(?!#)", body)
    sources = re.findall(r"<pre>(.*?)</pre>", text)
    assert len(sources) == sum(isinstance(b, Formula) for s in make("spherical_rrp").sections for b in s.blocks)


SEEN = """() => {
  const maths = [...document.querySelectorAll('math')];
  const boxes = maths.map(m => m.getBoundingClientRect());
  const ratios = [];
  for (const table of document.querySelectorAll('mtable')) {
    const row = table.parentElement, bracket = row.querySelector(':scope > mo');
    if (bracket) ratios.push(bracket.getBoundingClientRect().height / table.getBoundingClientRect().height);
  }
  const text = maths.map(m => m.textContent).join(' ');
  return {count: maths.length, seen: boxes.filter(b => b.width > 3 && b.height > 5).length, ratios,
          raw: /\\\\\\\\|begin|frac|&/.test(text), font: document.fonts.check('16px "Writeup Math"'),
          cells: document.querySelectorAll('mtd').length, wide: document.body.scrollWidth > innerWidth};
}"""


@pytest.mark.skipif(not Path(BROWSER).exists(), reason="there is no Chromium")
@pytest.mark.parametrize(("robot", "convention"), [("spherical_rrp", "mls"), ("lead_screw", "lynch-park")])
def test_html_in_a_browser_without_a_network(robot: str, convention: str, tmp_path: Path) -> None:
    playwright = pytest.importorskip("playwright.sync_api")
    file = tmp_path / "report.html"
    file.write_text(reports.write(make(robot, convention), "html"), encoding="utf-8")
    with playwright.sync_playwright() as p:
        browser = p.chromium.launch(executable_path=BROWSER, args=list(FLAGS))
        context = browser.new_context(offline=True, viewport={"width": 1100, "height": 900})
        page = context.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.goto(file.as_uri())
        page.evaluate("document.fonts.ready")
        seen = page.evaluate(SEEN)
        page.locator("summary").first.click()
        source = page.locator("details[open] pre").first.inner_text()
        browser.close()
    assert not errors
    assert seen["count"] > 30
    assert seen["seen"] == seen["count"]  # every formula takes up room
    assert not seen["raw"]  # no TeX is left in them
    assert seen["font"]
    assert not seen["wide"]
    assert len(seen["ratios"]) > 20
    assert all(0.8 < ratio < 1.6 for ratio in seen["ratios"])  # brackets stretch to their matrices
    assert source.startswith(("g(0) = ", "M = "))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("robot", "convention", "tip"),
    [
        ("spherical_rrp", "mls", None),
        ("spherical_rrp", "lynch-park", None),
        ("gear_pair", "mls", None),
        ("lead_screw", "mls", None),
        ("ur5_robot", "mls", "tool0"),
    ],
)
def test_latex_compiles(robot: str, convention: str, tip: str | None, tmp_path: Path) -> None:
    tex = shutil.which("pdflatex") or shutil.which("tectonic")
    if tex is None:
        pytest.skip("there is no TeX")
    (tmp_path / "report.tex").write_text(reports.write(make(robot, convention, tip), "latex"), encoding="utf-8")
    options = ["-interaction=nonstopmode", "-halt-on-error"] if tex.endswith("pdflatex") else []
    done = subprocess.run([tex, *options, "report.tex"], cwd=tmp_path, capture_output=True, text=True, errors="replace")
    assert done.returncode == 0, done.stdout[-2000:]
    assert (tmp_path / "report.pdf").stat().st_size > 10_000
    log = tmp_path / "report.log"
    if log.exists():
        assert "Overfull \\hbox" not in log.read_text(errors="replace")


def test_notebook_is_valid() -> None:
    nbformat = pytest.importorskip("nbformat")
    text = reports.write(make("spherical_rrp"), "notebook")
    nbformat.validate(nbformat.reads(text, as_version=4))
    kinds = [cell["cell_type"] for cell in json.loads(text)["cells"]]
    assert kinds.count("code") >= 5


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_notebook_runs(tmp_path: Path) -> None:
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    book = nbformat.reads(reports.write(make("two_joint"), "notebook"), as_version=4)
    client = nbclient.NotebookClient(
        book, timeout=120, kernel_name="python3", resources={"metadata": {"path": tmp_path}}
    )
    client.execute()
    last = [cell for cell in book.cells if cell.cell_type == "code"][-1]
    assert "True" in last.outputs[0]["data"]["text/plain"]
