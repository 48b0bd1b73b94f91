"""Names that attack whatever they are written to: markup, code, spreadsheets, terminals, logs, files.

`NAMES` may stand in a URDF, as the name of a link or joint, as they are (`xml_attribute` writes them there). `TEXTS`
are those, and what XML can't hold but a file's name, or a caller, can.
"""

from __future__ import annotations

from typing import Final

SCRIPT: Final = "document.title=1337"
"""What a page must never run."""

NAMES: Final[dict[str, str]] = {
    # Markup
    "tag": f"<script>{SCRIPT}</script>",
    "image": f"<img src=x onerror={SCRIPT}>",
    "end of a script": f"</script><script>{SCRIPT}</script>",
    "end of a title": f"</title></style></textarea></pre><svg onload={SCRIPT}>",
    "attribute": f'" onload="{SCRIPT}" x="',
    "attribute in single quotes": f"' onload='{SCRIPT}' x='",
    "comment": f"--><script>{SCRIPT}</script><!--",
    "CDATA": f"]]><script>{SCRIPT}</script><![CDATA[",
    "entities": "&lt;b&gt; &amp;amp; &#60; &nbsp; &bogus;",
    "script in a formula": rf"shoulder`$\text{{<script>{SCRIPT}</script>}}$`",
    "script in a subscript": rf"a_{{\text{{<img src=x onerror={SCRIPT}>}}}}",
    "script of a template": "{{7*7}} ${7*7} <%= 7*7 %>",
    # Markdown
    "link": f"[a](javascript:{SCRIPT})",
    "picture": "![a](http://127.0.0.1:9/a.png)",
    "row of a table": "a | b |\n|---|---|\n| c",
    "pipe after a backslash": "a\\|b",
    "emphasis": "*a* _b_ **c** __d__ ~~e~~ `f` ``g``",
    "heading": "# a #",
    "item": "- a",
    "numbered": "1. a",
    "numbered with a bracket": "12) a",
    "underline": "===",
    "rule": "***",
    "quotation": "> a",
    "fence": "```\ncode\n```",
    "address": "http://127.0.0.1:9/ www.example.org a@example.org",
    "reference": "[a]: http://127.0.0.1:9/",
    "code by indent": "    code",
    "spaces": "  a  b  ",
    # LaTeX
    "TeX": r"\input{/etc/passwd}\write18{touch x}",
    "TeX by carets": "^^5cinput ^^M",
    "end of a document": r"}\end{document}",
    "specials of TeX": "#$%&_{}~^\\",
    "display": "$$x$$ \\[x\\] \\(x\\)",
    "unfinished formula": "$",
    "comment of TeX": "% rest",
    "dashes and quotes": "--- ''a`` \"b\"",
    # Code
    "docstring": '"""\nimport os\nos.abort()\n"""',
    "docstring with code": 't""" + str(__import__("os").abort()) + """',
    "unfinished escape": r"a\u2",
    "unfinished escape in bytes": r"\x",
    "name of a character": r"\N{nothing}",
    "backslash at the end": "a\\",
    "end of a comment": "*/ int main(void){return 1;} /*",
    "start of a comment": "/* // #= %{ {- (*",
    "trigraphs": "??/ ??> what??!",
    "line continued": "a\\\nb ...\nc",
    "block of MATLAB": "%{",
    "end of a block of MATLAB": "%}",
    "quote of MATLAB": "'; system('touch x'); '",
    "interpolation": "$(touch x) `touch x` ${IFS} $(run(`touch x`))",
    "format": "%s%n%d {0} {} {x!r} %(a)s %{a}",
    "block of Julia": "=#; run(`touch x`); #=",
    "coding": "-*- coding: utf-7 -*-",
    "code by UTF-7": "+AAo-raise SystemExit",
    "line break": "a\nraise SystemExit(1)",
    "carriage return": "a\rraise SystemExit(1)",
    "both": "a\r\nraise SystemExit(1)",
    "breaks of Unicode": "a\u2028b\u2029c\u0085d",
    "keyword": "class",
    "number": "1e9",
    "private": "_shoulder",
    "prototype": "__proto__",
    "constructor": "constructor",
    # Spreadsheets
    "formula": '=HYPERLINK("http://127.0.0.1:9/","a")',
    "formula by plus": "+1+1",
    "formula by minus": "-1+1",
    "formula by at": "@SUM(1,1)",
    "formula after a tab": "\t=1+1",
    "formula after a quote": "'=1+1",
    "formula in full width": "\uff1d1+1",
    "cells": 'a,"b";c\td',
    # Terminals and logs
    "colour": "\x9b31mred\x9b0m",
    "title of a window": "\x9d0;title\x9c",
    "controls": "a\x7fb\x80c\x90d\x9fe",
    "command of GitHub": "::error file=a::trapped",
    "command of GitHub after a break": "a\n::error::trapped",
    "command of GitHub after spaces": "   ::stop-commands::x",
    "command by hashes": "##[error]trapped",
    "command of Azure": "a ##vso[task.setvariable variable=x]y",
    "percent": "%0A::error::trapped%25",
    "rich": "[red]a[/red] [link=http://127.0.0.1:9/]b[/link]",
    "override": "a\u202eb\u2066c\u2069d\u202c",
    "marks": "\u200ea\u200fb\u061cc",
    "zero width": "a\u200bb\u200cc\u2060d\ufeffe",
    # Letters
    "Hebrew": "שלום",
    "astral": "😀𝔸",
    "combining": "e\u0301 " + "a" + "\u0301" * 50,
    "not assigned": "a\u0378b\U000e0001c",
    "private use": "a\ue000b\U0010fffdc",
    "not a character": "a\ufdd0b\U0001fffec",
    # Files and command lines
    "path": "../../../etc/passwd",
    "absolute": "/dev/null",
    "drive": "C:\\a\\b",
    "option": "--help",
    "arguments": "a:=b c=d,e;f",
    "quotes of a shell": "a'b\"c`d$e!f",
    "255 bytes": "b" * 255,
    "256 bytes": "é" * 128,
    "90 000 digits": "1" * 90_000,
    "dot": ".",
    "space": " ",
}

TEXTS: Final[dict[str, str]] = {
    **NAMES,
    "empty": "",
    "C0": "".join(map(chr, range(32))),
    "escape": "\x1b[31mred\x1b]0;title\x07\x1b\\",
    "surrogate": "a\udc80b\ud800c",
    "end of Unicode": "\ufffe\uffff\U0010ffff",
}


def xml_attribute(text: str) -> str:
    """A name as the value of an attribute, between quotes, written without the code under test."""
    return "".join(f"&#{ord(c)};" if c in "<&\"'\r\n\t>" or ord(c) > 126 else c for c in text)
