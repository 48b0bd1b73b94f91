"""Hostile names through every command and every format, read back by a reader of that format which is not ours.

One arm has all names of `hostile.NAMES`, of its links and of its joints. What is for reading may show a name in other
spellings than the file's: unseen characters as escapes, on one line, as Python writes a text. `missing` knows them.
"""

from __future__ import annotations

import ast
import csv
import html.parser
import io
import json
import re
import subprocess
import tokenize
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from shutil import which
from typing import Any, Final
from xml.etree import ElementTree as ET

import click
import numpy as np
import pytest

from broken import Altered
from command_line import Done, run
from hostile import NAMES, SCRIPT, xml_attribute
from pinscrew.cli import _COMMANDS
from pinscrew.cli.output import FILE
from pinscrew.engines.pinocchio import Pinocchio
from pinscrew.ground.escaping import visible
from pinscrew.ground.words import one_line

Reader = Callable[[str], list[str]]

LONGEST: Final = 400
"""Of longer names a sentence shows both ends."""
ACCEPTED: Final = {title: name for title, name in NAMES.items() if name.strip()}
"""A name of spaces alone is refused as none."""
FEW: Final = [
    "script in a formula", "docstring with code", "unfinished escape", "end of a comment", "line break", "TeX",
    "interpolation", "row of a table", "command of GitHub after a break", "breaks of Unicode", "tag", "block of MATLAB",
]  # fmt: skip
"""For what takes long, two at a time."""


def arm(names: list[str], turned: float = 0.0, name: str = "arm") -> str:
    """A chain whose joints and links have the names."""
    parents = ["base", *names]
    links = "".join(f'<link name="{xml_attribute(link)}"/>' for link in parents)
    joints = "".join(
        f'<joint name="{xml_attribute(child)}" type="revolute"><parent link="{xml_attribute(parent)}"/>'
        f'<child link="{xml_attribute(child)}"/><origin xyz="0.1 0 0.2" rpy="{turned} 0 0"/>'
        f'<axis xyz="0 {i % 2} {1 - i % 2}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        for i, (parent, child) in enumerate(zip(parents, names, strict=False))
    )
    return f'<robot name="{xml_attribute(name)}">{links}{joints}</robot>'


def missing(names: list[str], texts: list[str], reader: Reader) -> list[str]:
    """The names that are not among data, or that no sentence for reading has in one of the spellings there."""
    if reader in DATA:
        return [name for name in names if name not in texts]
    joined = [" ".join(text.split()) for text in texts]
    forms = {name: {visible(name), one_line(name), repr(name)[1:-1]} for name in names}
    return [
        name for name in names if not any(" ".join(form.split()) in text for form in forms[name] for text in joined)
    ]


# ------------------------------------------------------------------------------------------------ readers


class Page(html.parser.HTMLParser):
    def __init__(self, page: str) -> None:
        super().__init__()
        self.texts: list[str] = [""]
        self.elements: list[str] = []
        self.handlers: list[str] = []
        self.scripts: list[str] = []
        self.feed(page)
        self.close()

    def handle_data(self, data: str) -> None:
        if self.lasttag in ("script", "style"):
            self.scripts.append(data)
        self.texts.append(data)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append(tag)
        self.handlers += [name for name, value in attrs if name.startswith("on") or "javascript:" in (value or "")]
        self.texts += [value for _, value in attrs if value]


def of_a_terminal(text: str) -> list[str]:
    lines = text.split("\n")
    assert [line for line in lines if not line.isprintable()] == []
    assert [line for line in lines if line.lstrip().startswith("::") or re.search(r"##\w*\[", line)] == []
    plain = text.replace(r"\x3a", ":").replace(r"\x23", "#")
    return [plain, re.sub(r" *\n *", "", plain)]  # a table may wrap a name


def of_json(text: str) -> list[str]:
    def strings(value: Any) -> Iterator[str]:
        if isinstance(value, str):
            yield value
        elif isinstance(value, dict):
            for key, inner in value.items():
                yield from (key, *strings(inner))
        elif isinstance(value, list):
            for inner in value:
                yield from strings(inner)

    assert text.replace("\n", "").isprintable() or not re.search("[\0-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e]", text)
    return list(strings(json.loads(text, parse_constant=pytest.fail)))


def of_npz(text: str) -> list[str]:
    """Of the metadata, which no terminal sees."""
    return of_json(json.dumps(json.loads(text)))


def of_sarif(text: str) -> list[str]:
    strings = [re.sub(r"\{\{(\d+)\}\}", r"{\1}", string) for string in of_json(text)]
    return [*strings, *(string.replace("\\[", "[") for string in strings)]


def of_csv(text: str) -> list[str]:
    cells = [cell for row in csv.reader(io.StringIO(text, newline="")) for cell in row]
    assert [cell for cell in cells if cell.startswith(("=", "+", "@", "\t", "\r"))] == []
    assert [cell for cell in cells if cell.startswith("-") and not re.fullmatch(r"-[\d.e+-]+", cell)] == []
    columns = [cell.partition(".")[2] for cell in cells]  # such as q.joint1
    return [*columns, *(re.sub("^'(?='*[=+\\-@\t\r\uff1d])", "", cell) for cell in cells)]


def of_xml(text: str) -> list[str]:
    root = ET.fromstring(text.encode())  # noqa: S314 (our own)
    texts = [part for element in root.iter() for part in (element.text, element.tail, *element.attrib.values())]
    return [part for part in texts if part]


def of_urdf(text: str) -> list[str]:
    assert [line for line in text.split("\n") if not line.isprintable() or line.lstrip().startswith("::")] == []
    return of_xml(text)


def of_markdown(text: str) -> list[str]:
    reader = pytest.importorskip("markdown_it").MarkdownIt("gfm-like", {"linkify": False})
    page = Page(reader.render(text))
    assert set(page.elements) <= {
        "p", "h1", "h2", "h3", "ul", "li", "table", "thead", "tbody", "tr", "th", "td", "span", "strong", "code"
    }  # fmt: skip
    assert page.handlers == []
    return ["".join(page.texts)]


FORMULA: Final = re.compile(r"\$\$[^$]*\$\$|(?<!>)\$[^$\n]*\$(?!<)")
"""What a reader of Markdown that knows no mathematics would take for emphasis."""


def of_markdown_with_formulas(text: str) -> list[str]:
    return of_markdown(FORMULA.sub("", text))


def of_github(text: str) -> list[str]:
    lines = [line for line in text.split("\n") if line]
    matches = [re.fullmatch(r"::(?:error|warning|notice) ([^:]*)::(.*)", line) for line in lines]
    said = [match[2] for match in matches if match]
    assert len(said) >= 1
    others = [line for line, match in zip(lines, matches, strict=True) if not match]
    assert [line for line in others if line.startswith("::") or not line.isprintable()] == []
    return [line.replace("%0A", "\n").replace("%0D", "\r").replace("%25", "%") for line in said]


def of_html(text: str) -> list[str]:
    page = Page(text)
    assert page.handlers == []
    assert not any(script.strip().startswith(SCRIPT) for script in page.scripts)
    for script in page.scripts:
        if script.lstrip().startswith("{"):
            page.texts += of_json(script)
    return [*page.texts, "".join(page.texts)]


def of_python(text: str) -> list[str]:
    tree = ast.parse(text)
    allowed = (ast.Expr, ast.Import, ast.ImportFrom, ast.FunctionDef, ast.Assign)
    assert [node for node in tree.body if not isinstance(node, allowed)] == []
    calls = [node.value for node in tree.body if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)]
    assert calls == []
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    comments = [token.string for token in tokens if token.type == tokenize.COMMENT]
    return [ast.get_docstring(tree, clean=False) or "", *(comment.replace(r"\x3a", ":") for comment in comments)]


def of_c(text: str) -> list[str]:
    if which("gcc"):
        command = ["gcc", "-std=c11", "-trigraphs", "-Wall", "-Werror", "-Wno-bidi-chars", "-fsyntax-only", "-xc", "-"]
        done = subprocess.run(command, input=text, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    comment, _, code = text.removeprefix("/*").partition("*/")
    assert "/*" not in code
    assert not re.search(r"system|main|return", code)
    return [comment.replace(r"*\x2f", "*/").replace(r"/\x2a", "/*").replace(r"?\x3f", "??").replace(r"\x2f\x2a", "/*")]


def commented(mark: str) -> Callable[[str], list[str]]:
    """A reader of a language whose comments go from a mark to the end of the line; code has no text at all."""

    def read(text: str) -> list[str]:
        lines = text.split("\n")
        comments = [line.lstrip()[1:] for line in lines if line.lstrip().startswith(mark)]
        code = [line for line in lines if not line.lstrip().startswith(mark)]
        assert [line for line in code if not re.fullmatch(r"[\w\s.,;:=+\-*/^()\[\]{}<>]*", line, re.ASCII)] == []
        assert [line for line in comments if line.startswith(("{", "}", "=")) or not line.isprintable()] == []
        return [re.sub(r"\\x(7b|7d|25|3d|23)", lambda m: chr(int(m[1], 16)), line) for line in comments]

    return read


def of_latex(text: str) -> list[str]:
    """TeX's own meaning of marks: none of a name's backslashes, braces or dollars is one, so no command is new."""
    words = set(re.findall(r"\\([A-Za-z]+)", text))
    assert words.isdisjoint({"input", "write", "def", "catcode", "csname", "openin", "read", "immediate"})
    assert "^^" not in text
    return [re.sub("|".join(map(re.escape, _LATEX)), lambda mark: _LATEX[mark[0]], text)]


_LATEX: Final = {
    r"\textbackslash{}": "\\", r"\textasciitilde{}": "~", r"\textasciicircum{}": "^", r"\textless{}": "<",
    r"\textgreater{}": ">", r"\textbar{}": "|", r"\textasciigrave{}": "`", r"\symbol{34}": '"', "-{}": "-",
    r"\{": "{", r"\}": "}", r"\$": "$", r"\&": "&", r"\#": "#", r"\_": "_", r"\%": "%",
}  # fmt: skip


def of_notebook_cell(lines: list[str]) -> list[str]:
    return of_markdown_with_formulas("".join(lines))


def of_notebook(text: str) -> list[str]:
    cells = json.loads(text)["cells"]
    for cell in cells:
        if cell["cell_type"] == "code":
            ast.parse("".join(cell["source"]))
    return [
        *of_json(text),
        *(text for cell in cells if cell["cell_type"] == "markdown" for text in of_notebook_cell(cell["source"])),
    ]


# ------------------------------------------------------------------------------------------------ all names at once

DATA: Final[set[Reader]] = {of_json, of_npz, of_csv, of_urdf}
REPORTS: Final[dict[str, Reader]] = {"junit": of_xml, "markdown": of_markdown, "sarif": of_sarif}

COMMANDS: Final[list[tuple[str, tuple[str, ...], Reader]]] = [
    ("fk", ("--json",), of_json),
    ("jacobian", ("--kind", "body"), of_a_terminal),
    ("jacobian", ("--kind", "body", "--json"), of_json),
    ("screws", (), of_a_terminal),
    ("screws", ("--json",), of_json),
    ("screws", ("--format", "csv"), of_csv),
    ("screws", ("--format", "python"), of_python),
    ("screws", ("--format", "matlab"), commented("%")),
    ("lock", ("--output", "OUT.urdf.lock"), of_json),
    ("track", ("--profile", "profile.csv", "--method", "pinv", "--json"), of_json),
    ("track", ("--profile", "profile.csv", "--method", "pinv"), of_a_terminal),
    ("track", ("--profile", "profile.csv", "--method", "pinv", "--csv", "OUT.csv"), of_csv),
    ("workspace", ("--samples", "5", "--json"), of_json),
    ("workspace", ("--samples", "5", "--npz", "OUT.npz"), of_npz),
    ("workspace", ("--samples", "5", "--jobs", "1", "--map", "OUT.npz"), of_npz),
    ("velocity", ("--qd", "RATES", "--json"), of_json),
    ("dh", (), of_a_terminal),
    ("dh", ("--json",), of_json),
    ("dh", ("--format", "csv"), of_csv),
    ("dh", ("--format", "markdown"), of_markdown),
    ("dh", ("--format", "latex"), of_latex),
    ("dh", ("--format", "python"), of_python),
    ("dh", ("--format", "matlab"), commented("%")),
    ("expand", (), of_urdf),
    ("expand", ("--sources", "-o", "OUT.urdf"), of_urdf),
    ("diff", ("turned.urdf",), of_a_terminal),
    ("diff", ("turned.urdf", "--json"), of_json),
    ("diff", ("turned.urdf", "--github"), of_github),
    *(("diff", ("turned.urdf", f"--{form}", f"OUT.{form}"), reader) for form, reader in REPORTS.items()),
    ("lock", ("--check",), of_a_terminal),
    ("lock", ("--check", "--json"), of_json),
    ("lock", ("--check", "--github"), of_github),
    *(("lock", ("--check", f"--{form}", f"OUT.{form}"), reader) for form, reader in REPORTS.items()),
]
"""What names all joints or links."""
ids = [" ".join((command, *words)) for command, words, _ in COMMANDS]


@pytest.fixture(scope="module")
def names() -> list[str]:
    return [name for name in ACCEPTED.values() if len(name) <= LONGEST]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, names: list[str]) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    (folder / "arm.urdf").write_text(arm(names))
    (folder / "turned.urdf").write_text(arm(names, 0.1))
    (folder / "stripped.urdf").write_text(arm(stripped(names)))
    header = io.StringIO()
    csv.writer(header).writerow(["t", *stripped(names)])
    rows = (f"{t}{',0.1' * len(stripped(names))}\n" for t in (0, 0.01))
    (folder / "profile.csv").write_text(header.getvalue() + "".join(rows), newline="")
    return folder


def stripped(names: list[str]) -> list[str]:
    """The names that a table of rates can have: there spaces around a name are none of it."""
    return [name for name in names if name == name.strip()]


@pytest.mark.parametrize(("command", "words", "reader"), COMMANDS, ids=ids)
def test_all_at_once(
    command: str,
    words: tuple[str, ...],
    reader: Reader,
    names: list[str],
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    words = tuple(str(tmp_path / word) if word.startswith("OUT") else word for word in filled(words, names))
    if "--check" in words:
        monkeypatch.chdir(tmp_path)
        for text in (folder / "turned.urdf", folder / "arm.urdf"):
            Path("arm.urdf").write_text(text.read_text())
            if text.name == "turned.urdf":
                assert run("lock", "arm.urdf").status == 0
    if command == "track":
        names = stripped(names)
    if command == "lock" and "--output" in words:  # a lock lies beside its robot, or is allowed elsewhere
        words = (*words, "--allow-outside")
    file = "stripped.urdf" if command == "track" else "arm.urdf"
    done = run(command, file, *words)
    assert done.status in (0, 1), done.err
    assert [line for line in done.err.split("\n") if not line.isprintable()] == []
    assert "Traceback" not in done.err
    assert missing(names, reader(written(done, words)), reader) == []


# ------------------------------------------------------------------------------------------------ two at a time


def pairs(titles: list[str]) -> list[tuple[str, str]]:
    return [(titles[i], titles[(i + 1) % len(titles)]) for i in range(0, len(titles), 2)]


PAIRS: Final = [
    pytest.param(*pair, id=" and ".join(pair), marks=() if pair in pairs(FEW) else pytest.mark.slow)
    for pair in dict.fromkeys((*pairs(FEW), *pairs([title for title in ACCEPTED if len(ACCEPTED[title]) <= LONGEST])))
]
DERIVATIONS: Final[list[tuple[tuple[str, ...], Reader]]] = [
    (("--format", "markdown"), of_markdown_with_formulas),
    (("--format", "latex"), of_latex),
    (("--format", "html"), of_html),
    (("--format", "notebook"), of_notebook),
    (("--code", "python"), of_python),
    (("--code", "c"), of_c),
    (("--code", "matlab"), commented("%")),
    (("--code", "julia"), commented("#")),
]


def structure(text: str, words: tuple[str, ...]) -> list[str]:
    """The elements of a page, or of the page that Markdown becomes; of LaTeX its commands but for characters."""
    if "markdown" in words:
        reader = pytest.importorskip("markdown_it").MarkdownIt("gfm-like", {"linkify": False})
        text = reader.render(FORMULA.sub("", text))
    if "latex" in words:
        return re.findall(r"\\(?!text[a-z]+\{\}|symbol\{34\})[A-Za-z]+", text)
    return [element for element in Page(text).elements if element != "span"]


@pytest.mark.parametrize(("words", "reader"), DERIVATIONS, ids=[words[1] for words, _ in DERIVATIONS])
@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_derivations(first: str, second: str, words: tuple[str, ...], reader: Reader, tmp_path: Path) -> None:
    """Names of joints, of the tip and of the file; a page has no element more than that of harmless names."""
    names = [ACCEPTED[first], ACCEPTED[second]]
    file = tmp_path / (names[0].replace("/", "")[:60] + ".urdf")
    file.write_text(arm(names))
    harmless = tmp_path / "arm.urdf"
    harmless.write_text(arm(["one", "two"]))
    done, twin = (run("derive", path, *words, "--samples", "2") for path in (file, harmless))
    assert (done.status, done.err) == (0, "")
    if "--format" in words and "notebook" not in words:
        assert structure(done.out, words) == structure(twin.out, words)
    assert missing(names, reader(done.out), reader) == []


@pytest.mark.slow
@pytest.mark.parametrize(("command", "words", "reader"), [each for each in COMMANDS if each[0] != "lock"])
@pytest.mark.parametrize("title", ACCEPTED)
def test_one_by_one(
    title: str, command: str, words: tuple[str, ...], reader: Reader, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each name alone, so that none hides what another does; the longest too, where a command tells it whole."""
    name = ACCEPTED[title]
    if command == "track" and name != name.strip():
        pytest.skip("no table of rates can have this name")
    monkeypatch.chdir(tmp_path)
    Path("arm.urdf").write_text(arm([name]))
    Path("turned.urdf").write_text(arm([name], 0.1))
    header = io.StringIO()
    csv.writer(header).writerow(["t", name])
    Path("profile.csv").write_text(f"{header.getvalue()}0,0.1\n0.01,0.1\n", newline="")
    words = filled(words, [name])
    done = run(command, "arm.urdf", *words)
    assert done.status in (0, 1), done.err
    texts = reader(written(done, words))
    if len(name) <= LONGEST:
        assert missing([name], texts, reader) == []


@pytest.mark.parametrize(
    ("words", "reader"),
    [
        ((), of_a_terminal),
        (("--json",), of_json),
        (("--github",), of_github),
        *(((f"--{form}", f"OUT.{form}"), reader) for form, reader in REPORTS.items()),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, tuple) else "",
)
def test_disagreements(words: tuple[str, ...], reader: Reader, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`verify` with Pinocchio 1 mm off in every frame: the blamed joint is named."""

    def off(answers: Any, *_: Any) -> None:
        answers.poses[..., 0, 3] += 1e-3

    def engine(robot: Any) -> Any:
        return Altered(Pinocchio(robot), off)

    monkeypatch.setattr("pinscrew.Pinocchio", engine)  # first, while what it gets from the other is the real one
    monkeypatch.setattr("pinscrew.engines.pinocchio.Pinocchio", engine)
    monkeypatch.delenv("GITHUB_STEP_SUMMARY", raising=False)
    monkeypatch.chdir(tmp_path)
    for title in FEW:
        Path("arm.urdf").write_text(arm([ACCEPTED[title]]))
        done = run("verify", "arm.urdf", "--samples", "1", *words)
        assert done.status == 1, done.err
        assert missing([ACCEPTED[title]], reader(written(done, words)), reader) == []


def written(done: Done, words: tuple[str, ...]) -> str:
    """What a command with these words wrote, to a file, to standard output or, for GitHub, to standard error."""
    out = next((Path(word) for word in words if word.split("/")[-1].startswith("OUT")), None)
    if out is not None and out.suffix == ".npz":
        with np.load(out, allow_pickle=False) as arrays:
            assert [name for name in arrays if not name.isidentifier()] == []
            return str(arrays["metadata"])
    return out.read_bytes().decode() if out else done.err if "--github" in words else done.out


def filled(words: tuple[str, ...], names: list[str]) -> tuple[str, ...]:
    """The words with a rate for each joint where these are to stand."""
    return tuple(",".join(["0.1"] * len(names)) if word == "RATES" else word for word in words)


# ------------------------------------------------------------------------------------------------ command lines

WORDS: Final = {
    "lone surrogates": "a\udc80b\udcff",  # of bytes that are no UTF-8: an argument has no others
    "line breaks": "a\n::error::trapped\r\n##[error]",
    "escapes": "\x1b[31m\x9b0m\u202e",
    "5000 digits": "9" * 5000,
}
OPTIONS: Final = [
    pytest.param(
        command,
        option,
        id=f"{command} {option}",
        marks=() if command == "derive" or option is None else pytest.mark.slow,
    )
    for command, module in _COMMANDS.items()
    for option in (
        None,
        *(
            option.opts[-1]
            for option in import_module(module).command.params
            if isinstance(option, click.Option) and not option.is_flag and option.type is not FILE
        ),
    )
]


@pytest.mark.parametrize(("command", "option"), OPTIONS)
def test_words(command: str, option: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is no robot, and no value, of each command: one short line says so, as it may be shown."""
    monkeypatch.chdir(tmp_path)
    Path("arm.urdf").write_text(arm(["one"]))
    for word in WORDS.values():
        words = ("arm.urdf", word) if option is None else ("arm.urdf", f"{option}={word}")
        if command in ("diff", "verify", "lock") and option is None:
            words = (word, "arm.urdf")
        done = run(command, *words)
        assert (done.status, done.out.count("\n") < 10) == (2, True), done
        lines = done.err.removesuffix("\n").split("\n")
        assert lines[-1].startswith(("Error: ", "pinscrew: "))
        assert len(lines) <= 4
        assert [line for line in lines if not line.isprintable() or len(line) > 2000] == []
        assert [line for line in lines if line.startswith("::") or "##[" in line] == []


# ------------------------------------------------------------------------------------------------ figures

FIGURES: Final = {
    "rates": ("track", "--profile", "profile.csv", "--method", "pinv", "--plot"),
    "positions": ("workspace", "--samples", "20", "--plot"),
}


@pytest.mark.parametrize("words", FIGURES.values(), ids=FIGURES)
@pytest.mark.parametrize(
    "titles",
    [
        pytest.param(pair, marks=() if i == 0 else pytest.mark.slow, id="-".join(pair))
        for i, pair in enumerate(
            [
                ("unfinished formula", "script in a formula"),
                ("TeX", "display"),
                ("tag", "breaks of Unicode"),
                ("interpolation", "line break"),
                ("specials of TeX", "end of a comment"),
            ]
        )
    ],
)
def test_figures(
    words: tuple[str, ...], titles: tuple[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The names of robot, frame and velocities stand in the picture as they are, and nothing else is in it."""
    monkeypatch.chdir(tmp_path)
    names = [NAMES[title] for title in titles]
    Path("arm.urdf").write_text(arm(names, name=names[0]))
    with Path("profile.csv").open("w", newline="") as file:
        csv.writer(file).writerows([["t", *names], [0, 0.1, 0.1], [0.01, 0.1, 0.1]])
    done = run(words[0], "arm.urdf", *words[1:], "OUT.svg")
    assert (done.status, done.err) == (0, "")
    picture = ET.parse("OUT.svg")  # noqa: S314
    assert {
        element.tag for element in picture.iter() if element.tag.endswith(("}script", "}foreignObject", "}a"))
    } == set()
    shown = "\n".join("".join(element.itertext()) for element in picture.iter() if element.tag.endswith("}text"))
    wanted = names if words[0] == "track" else names[-1:]
    assert [name for name in wanted if visible(name) not in shown] == []
