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
import resource
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import xacro
from xacro import substitution_args

from pinscrew.description import _xacro_expressions as expressions
from pinscrew.description import markup
from pinscrew.description.packages import Packages, is_file
from pinscrew.ground.errors import DescriptionError
from pinscrew.ground.words import brief, one_line

_MACROS: Final = ("arg", "dotify", "tokenize", "abs_filename", "load_yaml")
_MESSAGES: Final = ("message", "warning", "error", "fatal", "print_location")


class _RefusedError(Exception):
    """What is wrong is known, and has a code and a remedy."""

    def __init__(self, code: str, what: str, remedy: str = "") -> None:
        super().__init__(what)
        self.code = code
        self.remedy = remedy


class _Session:
    """One expansion: the files it reads and the arguments they declare."""

    def __init__(self, request: Mapping[str, Any]) -> None:
        self.file = Path(request["file"])
        self.arguments: dict[str, str] = request["arguments"]
        declared = {name: Path(path) for name, path in request["packages"].items()}
        self.packages = Packages(self.file, declared, request["allow_outside"])
        self.declared: dict[str, None] = {}

    def expand(self) -> str:
        self._confine()
        document = xacro.process_file(str(self.file), mappings=dict(self.arguments))
        for name in self.arguments:
            if name not in self.declared:
                known = ", ".join(self.declared) or "none"
                raise _RefusedError("xacro-argument", f"declares no argument {name!r}", f"declared are: {known}")
        text: str = document.toprettyxml(indent="  ")
        try:
            size = len(text.encode())
        except UnicodeEncodeError:  # ${'\ud800'} is half of a character
            raise _RefusedError("encoding", "its expansion holds what is no character") from None
        if size > markup.MAX_BYTES:
            raise _RefusedError("too-large", f"its expansion is larger than {markup.MAX_BYTES // 2**20} MB")
        return text

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
        xacro.open = self._open
        substitution_args._eval = self._evaluate_argument
        substitution_args._eval_find = lambda name: str(self.packages.find(name))

    def _open(self, name: str, mode: str = "r") -> io.StringIO:
        """What xacro's own ``open`` gets: the text of a file that may be read."""
        if mode != "r":
            raise _RefusedError("xacro-forbidden", "opens a file to write it")
        path = self.packages.check(Path(name))
        if not is_file(path):
            raise FileNotFoundError(2, "there is no such file", name)
        text = markup.read(path)
        if path.suffix not in (".yaml", ".yml"):
            self._note_arguments(markup.parse(text, path))
        return io.StringIO(text)

    def _note_arguments(self, element: markup.Element) -> None:
        pending = [element]
        while pending:
            element = pending.pop()
            if element.tag == "xacro:arg":
                self.declared[element.attributes.get("name", "")] = None
            pending.extend(reversed(element.children))

    def _evaluate_argument(self, text: str, context: dict[str, Any]) -> str:
        """The value of ``$(eval text)``."""
        arguments = context.get("arg", {})

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


def _attribute(value: Any, name: str) -> Any:
    """What ``value.name`` means in an expression: a member of a namespace, an entry of a YAML file."""
    if isinstance(value, (xacro.NameSpace, xacro.YamlDictWrapper)):
        try:
            return value[name]
        except KeyError:
            raise NameError(f"name {name!r} is not defined") from None
    raise expressions.ForbiddenError(f"the attribute {name} of a {type(value).__name__}")


def _limit(seconds: int, memory: int) -> None:
    """Let the system end this process if it takes more."""
    limits = {resource.RLIMIT_CPU: seconds, resource.RLIMIT_FSIZE: 0, resource.RLIMIT_CORE: 0}
    if sys.platform == "linux":  # macOS does not enforce it, and refuses to set it
        limits[resource.RLIMIT_AS] = memory
    for which, most in limits.items():
        hard = resource.getrlimit(which)[1]
        resource.setrlimit(which, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def _explain(error: BaseException) -> dict[str, Any]:
    """What went wrong, from the innermost error that says so: xacro wraps them."""
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, _RefusedError):
            return {"code": cause.code, "error": _short(str(cause)), "remedy": _short(cause.remedy)}
        if isinstance(cause, DescriptionError):
            place = {"file": cause.file, "line": cause.line}
            return {"code": cause.code, "error": _short(cause.what), "remedy": _short(cause.remedy), **place}
        if isinstance(cause, expressions.ForbiddenError):
            remedy = "use arithmetic, comparison, conditionals, and xacro's, Python's plain and math functions"
            return {"code": "xacro-forbidden", "error": f"may not use {_short(str(cause))}", "remedy": remedy}
        if isinstance(cause, RecursionError):
            return {"code": "xacro-limit", "error": "includes or expands itself without end"}
        if isinstance(cause, MemoryError):
            return {"code": "xacro-limit", "error": "its expansion takes too much memory"}
        cause = getattr(cause, "exc", None)
    return {"code": "xacro", "error": _short(str(error)) or type(error).__name__}


def _short(text: str) -> str:
    return one_line(brief(text))


def main() -> None:
    """Answer one request."""
    request = json.load(sys.stdin)
    _limit(request["seconds"], request["memory"])
    answer: dict[str, Any] = {}
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
        try:
            answer["text"] = _Session(request).expand()
        except Exception as error:  # whatever xacro raises is an error of the file
            answer = {"file": (xacro.filestack or [request["file"]])[-1], **_explain(error)}
    answer["warnings"] = [line for line in map(_short, said.getvalue().splitlines()) if line][:20]
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
