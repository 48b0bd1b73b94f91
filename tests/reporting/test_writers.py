"""What each role of a sentence, a table and a closing line become in text and Markdown."""

from __future__ import annotations

from pinscrew.reporting import Account, Document, ResultTable, Sentence, Strong, to_markdown, to_text

FAULT = Sentence("the axis is turned", "fault", "axis-turned")
NOTE = Sentence("it was called 'a'", "note", "joint-renamed")
REMARK = Sentence("tips come apart")
TABLE = ResultTable(("check", ""), (("axes", Strong("FAIL")), ("names", "ok")))


def account(*sentences: Sentence, table: ResultTable | None = None) -> Account:
    return Account("arm", "arm: 1 change", table, sentences, notes_heading="Without a change:")


def test_markdown() -> None:
    assert to_markdown(Document("t", accounts=(account(FAULT, NOTE, REMARK),))).splitlines() == [
        "### arm: 1 change",
        "",
        "- **axis-turned**: the axis is turned",
        "- tips come apart",
        "",
        "Without a change:",
        "",
        "- joint-renamed: it was called 'a'",
    ]
    assert "Without a change" not in to_markdown(Document("t", accounts=(account(FAULT),)))
    rows = to_markdown(Document("t", accounts=(account(table=TABLE),))).splitlines()[2:]
    assert rows == ["| check | |", "|---|---|", "| axes | **FAIL** |", "| names | ok |"]


def test_text() -> None:
    document = Document("t", accounts=(account(FAULT, NOTE, REMARK),), closing="1 of 2")
    assert to_text(document).split("\n") == [
        "arm: 1 change",
        "  the axis is turned",
        "  note: it was called 'a'",
        "  tips come apart",
        "1 of 2",
    ]
    assert to_text(Document("t", accounts=(account(table=TABLE),))) == "arm: 1 change\ncheck\naxes   FAIL\nnames  ok"
