"""The child process of `expand`: reads a request from standard input, answers on standard output, as JSON.

xacro evaluates what a file says and opens what it names. Here its evaluation goes through `_xacro_expressions`, its
opening of files through the package roots, and the whole process has limits on time, memory and what it may write.
"""

from __future__ import annotations

import sys

if __name__ == "__main__" and not getattr(sys.flags, "safe_path", False):
    del sys.path[0]  # this script's folder, whose modules must not shadow anyone's

import contextlib
import io
import json
import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeVar
from xml.dom import minidom

import xacro
from xacro import substitution_args

from pinscrew.description import _xacro_expressions as expressions
from pinscrew.description import _xacro_places as places
from pinscrew.description import markup
from pinscrew.description._xacro_arguments import NeedsError, XacroArguments
from pinscrew.description._xacro_methods import TooLongError, method
from pinscrew.description.packages import Packages, is_file
from pinscrew.ground.children import end_with_parent, limit
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.words import brief, one_line

_MACROS: Final = ("arg", "dotify", "tokenize", "abs_filename", "load_yaml")
_E = TypeVar("_E", bound=BaseException)
MOST_CALLS: Final = 3
"""Calls of macros that a message names."""
_MESSAGES: Final = ("message", "warning", "error", "fatal", "print_location")


class _RefusedError(Exception):
    """What is wrong is known, and has a code and a remedy, and maybe a place."""

    def __init__(self, code: str, what: str, remedy: str = "", place: places.Place | None = None) -> None:
        super().__init__(what)
        self.code = code
        self.remedy = remedy
        self.place = place


class _TimeUpError(BaseException):
    """The processor time is used up; no ``except Exception`` on the way keeps it."""


class _Session:
    """One expansion: the files it reads and the arguments they declare."""

    def __init__(self, request: Mapping[str, Any]) -> None:
        self.file = Path(request["file"])
        declared = {name: Path(path) for name, path in request["packages"].items()}
        self.packages = Packages(self.file, declared, request["allow_outside"])
        self.arguments = XacroArguments(request["arguments"])
        self.macros: dict[str, str] = {}

    def expand(self) -> tuple[str, list[places.Place]]:
        """The text of the expansion, and where each of its elements comes from."""
        self._confine()
        try:
            document = xacro.process_file(str(self.file), mappings=self.arguments)
        except Exception as error:
            self._need(_cause(error, NeedsError))
            raise
        self._need(None)
        for name in self.arguments.unknown():
            raise _RefusedError("xacro-argument", f"declares no argument {name!r}", self.arguments.listed())
        root = document.documentElement
        if self.macros and root.tagName == "robot" and not any(_is_link(node) for node in root.childNodes):
            what = f"only defines macros, and no robot: {', '.join(map(brief, self.macros))}"
            remedy = f"include it in a file of yours that calls one: {next(iter(self.macros.values()))}"
            raise _RefusedError("xacro-macros", what, remedy)
        text: str = document.toprettyxml(indent="  ")
        try:
            size = len(text.encode())
        except UnicodeEncodeError:  # ${'\ud800'} is half of a character
            raise _RefusedError("encoding", "its expansion holds what is no character") from None
        if size > markup.MAX_BYTES:
            raise _RefusedError("too-large", f"its expansion is larger than {markup.MAX_BYTES // 2**20} MB")
        return text, places.places_below(root)

    def _need(self, because: NeedsError | None) -> None:
        """Say which arguments are missing, all of them at once."""
        needs = self.arguments.needs(because)
        if needs:
            remedy = self.arguments.listed()
            raise _RefusedError("xacro-argument", f"needs {needs}", remedy, self.arguments.at(because))

    def _confine(self) -> None:
        """Put ourselves between xacro and what it would evaluate and open."""
        given = xacro._global_symbols["xacro"]
        functions = {name: given[name] for name in (*_MACROS, *_MESSAGES)}
        symbols: dict[str, Any] = {**expressions.MATH, **expressions.FUNCTIONS}
        symbols.update({name: functions[name] for name in ("load_yaml", "abs_filename", "dotify")})
        for name, members in (("math", expressions.MATH), ("python", expressions.FUNCTIONS), ("xacro", functions)):
            symbols[name] = xacro.NameSpace()
            dict.update(symbols[name], members)
        xacro._global_symbols = symbols
        xacro.safe_eval = lambda text, known, _=None: expressions.evaluate(text, known, _attribute)
        relative = xacro.abs_filename_spec
        xacro.abs_filename_spec = lambda name: self._resolve(name) or relative(name)
        xacro.parse = self._parse
        xacro.open = lambda name: io.StringIO(self._read(Path(name)))
        substitution_args._eval = self._evaluate_argument
        substitution_args._eval_find = lambda name: str(self.packages.find(name))

    def _resolve(self, name: str) -> str | None:
        """The path that a ``package://`` or ``file://`` stands for."""
        scheme = name.partition("://")[0]
        return str(self.packages.resolve(name)) if scheme in ("package", "file") and "://" in name else None

    def _read(self, path: Path) -> str:
        """The text of a file that may be read."""
        if not is_file(self.packages.check(path)):
            raise self.arguments.absent(path)
        return markup.read(path)

    def _parse(self, _: None, name: str) -> minidom.Document:
        """What xacro's own ``parse`` makes of a file: read by us, checked, and with the places of its elements."""
        path = Path(name)
        try:
            text = self._read(path)
        except FileNotFoundError as error:
            xacro.filestack.pop()  # the file is not the one that asks for it
            raise xacro.XacroException(f"{error.strerror}: {name}", exc=error) from error
        root = markup.parse(text, path)
        self.arguments.note(root, path)
        if path == self.file:
            self.macros = {e.attributes.get("name", ""): _example(e) for e in root.all("xacro:macro")}
        return places.parse(text, path)

    def _evaluate_argument(self, text: str, context: dict[str, Any]) -> str:
        """The value of ``$(eval text)``."""
        arguments = context["arg"]

        def argument(name: str) -> Any:
            return substitution_args.convert_value(arguments[name], "auto")

        functions = {
            **expressions.MATH,
            **expressions.FUNCTIONS,
            "true": True,
            "false": False,
            "arg": argument,
            "env": substitution_args._eval_env,
            "optenv": substitution_args._eval_optenv,
            "find": substitution_args._eval_find,
            "dirname": lambda: str(self.file.resolve().parent),
        }
        symbols = {**{name: argument(name) for name in arguments}, **functions}
        return str(expressions.evaluate(text, symbols, _attribute))


def _is_link(node: minidom.Node) -> bool:
    return node.nodeType == minidom.Node.ELEMENT_NODE and node.nodeName == "link"


def _example(macro: markup.Element) -> str:
    """How a macro is called, with the parameters that have no default."""
    required: list[str] = []
    rest = macro.attributes.get("params", "")
    while rest.strip():
        name, default, rest = xacro.parse_macro_arg(rest)
        if default is None and not name.startswith("*"):
            required.append(f' {name}="…"')
    return f"<xacro:{macro.attributes.get('name', '')}{''.join(required)}/>"


def _attribute(value: Any, name: str) -> Any:
    """What ``value.name`` means: a method that may be called, a member of a namespace, an entry of a YAML file."""
    bound = method(value, name, xacro.YamlListWrapper, xacro.YamlDictWrapper)
    if bound is not None:
        return bound
    if isinstance(value, str) and name in ("format", "format_map"):
        raise expressions.ForbiddenError(f"the attribute {name} of a str, which reaches attributes; use '%s' % value")
    if isinstance(value, (xacro.NameSpace, xacro.YamlDictWrapper)):
        try:
            return value[name]
        except KeyError:
            raise NameError(f"name {name!r} is not defined") from None
    raise expressions.ForbiddenError(f"the attribute {name} of a {type(value).__name__}")


def _limit(seconds: int, memory: int) -> None:
    """Let the system end this process if it takes more; of processor time it gets a second more to say where it was."""

    def end(*_: object) -> None:
        raise _TimeUpError

    signal.signal(signal.SIGXCPU, end)
    limit(seconds, memory)


def _cause(error: BaseException | None, kind: type[_E]) -> _E | None:
    """The outermost exception of a kind among those that xacro has wrapped."""
    while error is not None and not isinstance(error, kind):
        error = getattr(error, "exc", None)
    return error


def _explain(error: BaseException, main: str, seconds: int) -> dict[str, Any]:
    """What went wrong, from the outermost error that says so, and where."""
    at = places.trace(error)
    place: tuple[str, int | None] | None = at.place
    where = _by_calls(at)
    code, what, remedy = "xacro", _short(str(error)) or type(error).__name__, ""
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, _RefusedError):
            code, what, remedy = cause.code, str(cause), cause.remedy
            place, where = cause.place, ""
        elif isinstance(cause, DescriptionError):
            code, what, remedy = cause.code, cause.what, cause.remedy
            if cause.line is not None or cause.file != main:  # otherwise it is about what the main file asks for
                place, where = (cause.file, cause.line), ""
        elif isinstance(cause, (expressions.ForbiddenError, TooLongError)):
            code, what = "xacro-forbidden", f"may not use {cause}"
            remedy = "use arithmetic, comparison, conditionals, and xacro's, Python's plain and math functions"
        elif isinstance(cause, RecursionError):
            code, what = "xacro-limit", "includes or expands itself without end"
        elif isinstance(cause, MemoryError):
            code, what = "xacro-limit", "its expansion takes too much memory"
        elif isinstance(cause, _TimeUpError):
            code, what = "xacro-limit", f"its expansion takes more than {seconds} s of processor time"
            remedy = "look for macros that call others again and again, and for huge numbers"
        else:
            cause = getattr(cause, "exc", None)
            continue
        break
    file, line = place or ((xacro.filestack or [main])[-1], None)
    return {"code": code, "error": f"{where}{_short(what)}", "remedy": _short(remedy), "file": file, "line": line}


def _by_calls(at: places.Trace) -> str:
    """The macros that an error is in, such as ``in macro "arm", called from robot.xacro:40: ``."""
    words = []
    for call in at.calls[:MOST_CALLS]:
        file, line = call.place or ("", 0)
        words.append(f'in macro "{_short(call.macro)}", called from {_short(Path(file).name)}:{line}')
    if len(at.calls) > MOST_CALLS:
        words.append(f"… ({len(at.calls)} calls)")
    return f"{', '.join(words)}: " if words else ""


def _short(text: str) -> str:
    return one_line(brief(text))


def main() -> None:
    """Answer one request."""
    end_with_parent()
    request = json.load(sys.stdin)
    answer: dict[str, Any] = {"file": request["file"]}
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
        try:
            _limit(request["seconds"], request["memory"])
            answer["text"], found = _Session(request).expand()
            answer["files"] = files = list(dict.fromkeys(file for file, _ in found))
            index = {file: i for i, file in enumerate(files)}
            answer["places"] = [(index[file], line) for file, line in found]
        except (Exception, _TimeUpError) as error:  # whatever xacro raises is an error of the file
            answer.update(_explain(error, request["file"], request["seconds"]))
    answer["warnings"] = [line for line in map(_short, said.getvalue().splitlines()) if line][:20]
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
