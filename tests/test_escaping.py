"""Each format's escapes, read back by a reader of that format which is not ours."""

from __future__ import annotations

import ast
import csv
import html.parser
import io
import json
import keyword
import re
import subprocess
import tokenize
from collections.abc import Callable, Sequence
from pathlib import Path
from shutil import which
from xml.etree import ElementTree as ET

import pytest

from hostile import TEXTS
from pinscrew.ground import escaping
from pinscrew.ground import escaping_code as code

EVERY = pytest.mark.parametrize("text", TEXTS.values(), ids=TEXTS)


def seen(text: str) -> str:
    """What a format for reading shows: unprintable characters as Python's escapes."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


class Reader(html.parser.HTMLParser):
    """The texts, elements and attributes of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.text, self.elements, self.attributes = "", [], {}
        self.feed(page)
        self.close()

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(tag)
        self.attributes.update(attrs)

    def handle_comment(self, data: str) -> None:
        self.elements.append(f"<!--{data}")


# ------------------------------------------------------------------------------------------------ markup and data


@EVERY
def test_xml_document(text: str) -> None:
    """What stands in a document as it is, not as references, is read as before, and a terminal or a log obeys none."""
    text = re.sub("[^\t\n -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "", text)
    raw = f"<a>{text.replace('&', '&amp;').replace('<', '&lt;').replace('>', '&gt;')}</a>"
    safe = escaping.xml_document(raw)
    assert ET.fromstring(safe).text == ET.fromstring(raw).text  # noqa: S314
    assert not re.search("[\x7f-\x9f\u202a-\u202e\u2066-\u2069]|^\\s*::|##\\w*\\[", safe, re.MULTILINE)


@EVERY
def test_html(text: str) -> None:
    safe = escaping.html(text)
    page = Reader(f"<p title=\"{safe}\" lang='{safe}'>{safe}</p>")
    wanted = re.sub("[\0\ud800-\udfff]", "\ufffd", text)
    assert page.elements == ["p"]
    assert page.text == page.attributes["title"] == page.attributes["lang"] == wanted


@EVERY
def test_xml(text: str) -> None:
    safe = escaping.xml(text)
    assert escaping.mathml(text) == safe
    element = ET.fromstring(f"<svg a=\"{safe}\" b='{safe}'>{safe}</svg>")  # noqa: S314
    wanted = re.sub("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\ufffd", text)
    assert list(element) == []
    assert (element.text or "") == element.get("a") == element.get("b") == wanted
    assert escaping.xml_characters(text) == wanted


@EVERY
def test_json(text: str) -> None:
    for written in (escaping.json_text({text: [text, 1.5]}), escaping.json_text({text: [text, 1.5]}, None)):
        assert json.loads(written) == {text: [text, 1.5]}
        assert seen(written.replace("\n", "")).count("\\x") == written.count("\\x")  # no control as it is
        assert "##[" not in written
        written.encode()
    assert "\n" not in escaping.json_text([text], None)


@EVERY
def test_json_in_a_script(text: str) -> None:
    """The element ends where it should, and holds the text."""
    page = Reader(f"<script>{escaping.json_in_script([text])}</script><i></i>")
    assert page.elements == ["script", "i"]
    assert json.loads(page.text) == [text]


def test_json_has_no_infinity() -> None:
    with pytest.raises(ValueError, match="JSON"):
        escaping.json_text([float("inf")])


@EVERY
def test_csv(text: str) -> None:
    rows = list(
        csv.reader(io.StringIO(f"{escaping.csv_row([text, -0.5, 'b'])}\n{escaping.csv_row(['c', text])}\n", newline=""))
    )
    first = rows[0][0]
    assert rows == [[first, "-0.5", "b"], ["c", first]]
    assert not first.startswith(tuple("=+-@\t\r\n＝＋－＠"))
    marked = re.match("'+[=+\\-@\t\r\n＝＋－＠]", first)
    assert (first[1:] if marked else first) == text


@pytest.mark.parametrize("text", ["::error::a", " ::error::a", "##[error]a"])
def test_a_row_of_csv_is_no_command(text: str) -> None:
    assert not escaping.csv_row([text]).lstrip().startswith(("::", "##"))


@EVERY
def test_sarif(text: str) -> None:
    message = escaping.sarif_message(text)
    assert not re.search(r"(?<!\\)\[[^\[\]]*\]\(", message)
    assert not re.search(r"(?<!\{)\{\d+\}", message)
    assert re.sub(r"\{\{(\d+)\}\}", r"{\1}", message).replace("\\[", "[") == seen(text).replace("\\[", "[")


# ------------------------------------------------------------------------------------------------ for reading


@EVERY
def test_terminal(text: str) -> None:
    shown = escaping.terminal(text)
    assert shown.isprintable()
    assert not shown.strip().startswith("::")
    assert not re.search(r"##\w*\[", shown)
    assert shown.replace(r"\x3a", ":").replace(r"\x23", "#") == seen(text)


@EVERY
def test_github(text: str) -> None:
    """By the rules of the runner: a command is a line, properties are apart by commas, %-escapes are undone."""
    line = f"::error file={escaping.github_property(text)},line=1::{escaping.github_data(text)}"
    assert len(line.splitlines()) == 1
    match = re.fullmatch(r"::error ([^:]*)::(.*)", line)
    assert match
    properties = dict(each.split("=", 1) for each in match[1].split(","))
    assert set(properties) == {"file", "line"}
    escapes = {"%0D": "\r", "%0A": "\n", "%3A": ":", "%2C": ",", "%25": "%"}
    for value in (properties["file"], match[2]):
        assert seen(re.sub("%(0D|0A|3A|2C|25)", lambda m: escapes[m[0]], value)) == seen(text)


@EVERY
def test_markdown(text: str) -> None:
    """A paragraph, in a line, a heading, an item, a cell: that and no more, with the text in it."""
    markdown = pytest.importorskip("markdown_it")
    reader = markdown.MarkdownIt("gfm-like", {"linkify": False})
    for frame in ("{}", "a {} b", "# {}", "- {}", "| a |\n|---|\n| {} |"):
        page = Reader(reader.render(frame.format(escaping.markdown(text))))
        assert set(page.elements) <= {"p", "h1", "ul", "li", "table", "thead", "tbody", "tr", "th", "td", "span"}
        assert page.elements.count("td") == frame.count("{} |")
        assert page.elements.count("li") == frame.count("- {}")
        assert page.elements.count("span") == text.count("$")
        assert seen(text).strip() in page.text.replace("\n", "")


@EVERY
def test_latex(text: str) -> None:
    """No character reaches TeX with the meaning that TeX gives it, but for the commands that stand for characters."""
    written = escaping.latex(text)
    words = "text(backslash|asciitilde|asciicircum|less|greater|bar|asciigrave)"
    command = rf"\\{words}\{{\}}|\\symbol\{{34\}}|\\[{{}}$&#_%]|-\{{\}}(?=-)"
    assert not re.search(r"[\\{}$&#_%~^]", re.sub(command, "", written))
    assert "--" not in written
    assert "\n" not in written


@EVERY
def test_plot(text: str) -> None:
    """matplotlib takes none of it for a formula, and shows the text."""
    from matplotlib.text import Text

    shown, formula = Text()._preprocess_math(escaping.plot(text))
    assert formula is False or text.strip() == ""
    wanted = text if len(text) <= 60 else f"{text[:30]}…{text[-30:]}"
    assert shown == seen(wanted)
    assert escaping.plot(text).replace(r"\$", "$") == seen(wanted)


# ------------------------------------------------------------------------------------------------ code


@EVERY
def test_python(text: str) -> None:
    source = f'"""A {code.python_docstring(text)}."""\n# {code.python_comment(text)}\nx = {code.python_string(text)}\n'
    tree = ast.parse(source.encode())
    assert ast.get_docstring(tree, clean=False) == f"A {text}."
    assert ast.literal_eval(tree.body[1].value) == text  # type: ignore[attr-defined]
    assert len(tree.body) == 2
    encoding, _ = tokenize.detect_encoding(iter([f"# {code.python_comment(text)}\n".encode()]).__next__)
    assert encoding == "utf-8"


@EVERY
def test_identifiers(text: str) -> None:
    languages: tuple[code.Language, ...] = ("python", "c", "matlab", "julia")
    for language in languages:
        name = code.identifier(text, language)
        assert re.fullmatch("[A-Za-z][A-Za-z0-9_]{0,63}", name)
        assert not keyword.iskeyword(name) or language != "python"
        assert code.identifier(name, language) == name


@pytest.mark.parametrize(
    ("language", "word"), [("python", "match"), ("c", "double"), ("matlab", "end"), ("julia", "function")]
)
def test_words_are_no_identifiers(language: code.Language, word: str) -> None:
    assert code.identifier(word, language) == f"{word}_"


def test_identifiers_keep_what_they_can() -> None:
    assert code.identifier("shoulder_pan2", "c") == "shoulder_pan2"
    assert code.identifier("elbow joint-1", "julia") == "elbow_joint_1"


@pytest.mark.skipif(which("gcc") is None, reason="gcc is not installed")
def test_c(tmp_path: Path) -> None:
    """All at once, trigraphs on and warnings errors: the literals' bytes are the texts', the comments hold nothing."""
    texts = [text for text in TEXTS.values() if "\0" not in text]
    lines = ["#include <stdio.h>", "#include <string.h>", "int main(void) {"]
    for text in texts:
        comment = code.c_comment(text)
        assert seen(comment) == comment
        lines += [
            f"  /* {comment} */",
            f"  // {comment}",
            f'  puts("#"); fputs({code.c_string(text)}, stdout); putchar(0);',
        ]
    source = tmp_path / "texts.c"
    source.write_text("\n".join([*lines, "  return 0;", "}", ""]))
    flags = ["-std=c11", "-trigraphs", "-Wall", "-Wextra", "-Werror", "-Wno-overlength-strings", "-Wno-bidi-chars"]
    subprocess.run(["gcc", *flags, "-o", tmp_path / "texts", source], check=True, capture_output=True)
    out = subprocess.run([tmp_path / "texts"], check=True, capture_output=True).stdout
    assert out.split(b"\0")[:-1] == [b"#\n" + text.encode("utf-8", "surrogatepass") for text in texts]


@EVERY
def test_matlab(text: str) -> None:
    """By MATLAB's rules: pieces between quotes, where two are one, and numbers of 16 bits."""
    literal = code.matlab_string(text)
    assert literal.isprintable()
    units = b""
    for quoted, numbers in re.findall(r"'((?:[^']|'')*)'|char\(\[([\d ]+)\]\)", literal):
        units += quoted.replace("''", "'").encode("utf-16-le", "surrogatepass")
        units += b"".join(int(n).to_bytes(2, "little") for n in numbers.split())
    assert units.decode("utf-16-le", "surrogatepass") == text
    assert re.fullmatch(r"\[?(('([^']|'')*'|char\(\[[\d ]+\]\))(, )?)+\]?", literal)
    comment = code.matlab_comment(text)
    assert comment.isprintable()
    assert not comment.lstrip().startswith(("{", "}", "%"))


@EVERY
def test_julia(text: str) -> None:
    """By Julia's rules: escapes as in C with ``\\U``, and no dollar that is not behind a backslash."""
    literal = code.julia_string(text)
    body = re.fullmatch(r'"((?:[^"\\$]|\\[\\"$]|\\U[0-9a-f]{8})*)"', literal)
    assert body
    value = re.sub(r"\\(?:U([0-9a-f]{8})|(.))", lambda m: chr(int(m[1], 16)) if m[1] else m[2], body[1])
    assert value == re.sub("[\ud800-\udfff]", "\ufffd", text)
    comment = code.julia_comment(text)
    assert comment.isprintable()
    assert not comment.startswith("=")
    assert "#=" not in comment
    assert "=#" not in comment


@pytest.mark.parametrize("text", ["a", "shoulder_pan", "a b", "é", "שלום", "😀", "a-b.c/d"])
def test_what_is_harmless_stays_readable(text: str) -> None:
    functions: Sequence[Callable[[str], str]] = (
        escaping.html, escaping.xml, escaping.terminal, escaping.github_data, escaping.plot, escaping.sarif_message,
        code.python_docstring, code.python_comment, code.c_comment, code.matlab_comment, code.julia_comment,
    )  # fmt: skip
    assert {function(text) for function in functions} == {text}
    assert escaping.csv_row([text]) == text
    assert escaping.json_text(text) == f'"{text}"'
