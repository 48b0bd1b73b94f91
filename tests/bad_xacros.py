"""Bad and hostile xacro files as data, like `bad_inputs`: none may run code, read elsewhere, or take for ever."""

from __future__ import annotations

from typing import Final
from xml.sax.saxutils import quoteattr

from bad_inputs import Case, Content

NS: Final = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LIMIT_WORDS: Final = "takes more than"


def xacro(body: str, attributes: str = "") -> str:
    """A xacro file of two links' robot; ``body`` starts on line 4."""
    joint = '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
    return f'<robot name="r" {NS}{attributes}>\n<link name="a"/><link name="b"/>\n{joint}\n{body}\n</robot>\n'


def case(
    name: str,
    body: str,
    code: str,
    *words: str,
    files: dict[str, Content] | None = None,
    arguments: tuple[str, ...] = (),
    seconds: int | None = None,
) -> Case:
    """A xacro file that is refused."""
    return Case(
        name,
        xacro(body),
        code,
        words,
        error="XacroError",
        suffix=".urdf.xacro",
        arguments=arguments,
        files=files or {},
        seconds=seconds,
    )


def value(name: str, text: str, code: str, *words: str, seconds: int | None = None) -> Case:
    """A xacro file that asks for the value of a text."""
    return case(name, f"<xacro:if value={quoteattr(text)}/>", code, *words, seconds=seconds)


# ------------------------------------------------------------------------------------------------- expressions

FORBIDDEN: Final = {
    "(lambda: ().__class__)()": "a call of what is not a named function",
    "(lambda: 1)": "Lambda",
    "[].__class__": "the attribute __class__",
    "''.__class__.__mro__": "the attribute __mro__",
    "().__class__.__bases__[0].__subclasses__()": "the attribute",
    "''.format": "the attribute format of a str",
    "''.format_map(dict())": "the attribute format_map of a str",
    "''.encode": "the attribute encode of a str",
    "''.zfill(10**9)": "the attribute zfill of a str",
    "'x'.center(10**9)": "the attribute center of a str",
    "''.translate([])": "the attribute translate of a str",
    "'x'.expandtabs(10**9)": "the attribute expandtabs of a str",
    "[].append(1)": "the attribute append of a list",
    "[].extend([])": "the attribute extend of a list",
    "dict().update(a=1)": "the attribute update of a dict",
    "dict().setdefault": "the attribute setdefault of a dict",
    "dict().pop": "the attribute pop of a dict",
    "(1,).sort": "the attribute sort of a tuple",
    "b''.join([])": "the attribute join of a bytes",
    "''.split.__self__": "the attribute __self__",
    "''.split.func": "the attribute func of a function",
    "dict.keys": "the attribute keys of a type",
    "dict().keys().mapping": "the attribute mapping of a dict_keys",
    "','.join(['x'*10**5]*10)": "a join of more than 100000 characters",
    "('x'*10**5).join(['', '', ''])": "a join of more than 100000 characters",
    "''.join('' for i in range(10**5) for j in range(10**5))": "a join of more than 100000 characters",
    "('a'*10**5).replace('a', 'bb')": "a replace to more than 100000 characters",
    "('a'*10**4).replace('', 'b'*100)": "a replace to more than 100000 characters",
    "'aa'.replace('a', 'b'*10**5, 2)": "a replace to more than 100000 characters",
    "(1).real": "the attribute real of a int",
    "math.__class__": "the attribute __class__",
    "math.sin.__self__": "the attribute __self__",
    "xacro.__init__": "the attribute __init__",
    "xacro.load_yaml.__globals__": "the attribute __globals__",
    "python.str.mro()": "the attribute mro of a type",
    "python.__getattr__": "the attribute __getattr__",
    "__import__('os')": "the name __import__",
    "__builtins__": "the name __builtins__",
    "__attribute(1, 'a')": "the name __attribute",
    "__power(9, 9)": "the name __power",
    "(x := 1)": "NamedExpr",
    "f''": "JoinedStr",
    "await x": "Await",
    "[*[1]]": "Starred",
    "max(*[1])": "an unpacked argument",
    "1 << 10**10": "LShift",
    "1 >> 1": "RShift",
    "[1] @ [1]": "MatMult",
    "1 | 2": "BitOr",
    "9**9**9": "power of more than 4096 bits",
    "2**-10**9": "power of more than 4096 bits",
    "'a'**2": "power of what is no number",
    "[0]*10**9": "sequence repeated",
    "10**9*'a'": "sequence repeated",
    "('a'*10**5)*10**5": "sequence repeated",
    "((2**2000*2**2000)*(2**2000*2**2000))*2": "product of more than 4096 bits",
    "'%1000000000d' % 1": "a format with a width",
    "'%*d' % (10**9, 1)": "a format with a width",
    "'%.1000000000f' % 1": "a format with a width",
    "b'%1000000000d' % 1": "a format of bytes",
    "round(5, -10**9)": "rounding to more than",
    "python.round(5, ndigits=-10**9)": "rounding to more than",
    "range(10**12)": "range of more than",
    "python.range(10**12)": "range of more than",
    "[x for x in range(10**9)]": "range of more than",
    "-" * 9000 + "1": "nested too deeply",
    "1" + "+1" * 4000: "nested too deeply",
    "a" + ".a" * 4000: "nested too deeply",
    "1 if 1 else " * 700 + "1": "nested too deeply",
    "1 " * 10_000: "an expression of more than",
}
FAILING: Final = {
    "nosuch": "name 'nosuch' is not defined",
    "open('/etc/passwd')": "name 'open' is not defined",
    "eval('1')": "'eval' is not defined",
    "exec('1')": "'exec' is not defined",
    "getattr(1, 'real')": "'getattr' is not defined",
    "globals()": "'globals' is not defined",
    "vars()": "'vars' is not defined",
    "python.vars()": "'vars' is not defined",
    "python.type(1)": "'type' is not defined",
    "math.factorial(10**7)": "'factorial' is not defined",
    "factorial(10**7)": "'factorial' is not defined",
    "math.comb(10**6, 10**5)": "'comb' is not defined",
    "math.perm(10**6)": "'perm' is not defined",
    "math.nosuch": "'nosuch' is not defined",
    "python.keys()": "'keys' is not defined",
    "','.join([1])": "has no len()",
    "'a'.index('b')": "substring not found",
    "'a'.split('')": "empty separator",
    "'a'.startswith(1)": "must be str",
    "dict(a=1).get()": "at least 1 argument",
    "1/0": "division by zero",
    "1 % 0": "modulo by zero",
    "math.sqrt(-1)": "math domain error",
    "2.0**10000": "out of range",
    "int('9'*5000)": "limit",
    "[1, 2][5]": "index out of range",
    "'a' + 1": "can only concatenate",
    "1 +": "invalid syntax",
    "1; 2": "invalid syntax",
    "import os": "invalid syntax",
    "yield": "invalid syntax",
    "x = 1": "invalid syntax",
    "f'{1}'": "unterminated",
    "'{0.__class__}'.format(1)": "unterminated",
    "(" * 4000 + ")" * 4000: "too many nested parentheses",
    "xacro.fatal('no \\x1b[2J\\n\\x07 more')": "no \\x1b[2J\\n\\x07 more",
    "xacro.fatal('x'*100000)": "xxx … xxx",
    "xacro.tokenize('a', 'z-a')": "bad character range",
}
ENDLESS: Final = (
    "[1 for i in range(10**5) for j in range(10**5)]",
    "str([[0]*10**5]*10**5)",
    "sum([[0]*10**5]*10**5, [])",
    "xacro.tokenize('" + "a" * 40 + "!', 'a]*([a]*)*[b')",
)

EXPRESSIONS: Final = [
    *(value(f"${{{text[:40]}}}", f"${{{text}}}", "xacro-forbidden", words) for text, words in FORBIDDEN.items()),
    *(value(f"${{{text[:40]}}}", f"${{{text}}}", "xacro", words) for text, words in FAILING.items()),
    *(value(f"${{{text[:40]}}}", f"${{{text}}}", "xacro-limit", LIMIT_WORDS, seconds=1) for text in ENDLESS),
    value("10⁵ parentheses", "${" + "(" * 50_000 + ")" * 50_000 + "}", "too-large", "100000 characters"),
    *(
        value(f"$(eval {text[:40]})", f"$(eval {text})", "xacro-forbidden", words)
        for text, words in FORBIDDEN.items()
        if ")" not in text and "$" not in text
    ),
    *(
        value(f"$(eval {text[:40]})", f"$(eval {text})", "xacro", words)
        for text, words in {
            "__import__('os').name": "never closed",
            "nosuch": "'nosuch' is not defined",
            "1/0": "division by zero",
            "arg('nosuch')": "never closed",
            "math": "'math' is not defined",
        }.items()
    ),
    value("lone surrogate", "${xacro.fatal('\\ud800')}", "xacro", "\\ud800"),
    Case("lone surrogate in a name", xacro('<link name="${\'\\ud800\'}"/>'), "encoding", ("no character",),
         error="XacroError", suffix=".xacro"),
    Case("escape in a name", xacro('<link name="${\'\\x1b[31m\'}"/>'), "not-xml", ("not well-formed",),
         suffix=".xacro"),
    Case("NUL in a name", xacro('<link name="${\'\\x00\'}"/>'), "not-xml", ("not well-formed",), suffix=".xacro"),
]  # fmt: skip

# ---------------------------------------------------------------------------------------------- arguments, macros

MACROS: Final = [
    case("undeclared argument", '<xacro:arg name="l1" default="1"/>', "xacro-argument", "no argument 'l2'",
         "declared are: l1", arguments=("l2:=2",)),
    case("argument of a file without any", "", "xacro-argument", "'x'", "declared are: none", arguments=("x:=1",)),
    Case("argument of a plain URDF", xacro(""), "xacro-argument", ("a plain URDF has no arguments", "x"),
         arguments=("x:=1",)),
    case("argument without default", '<xacro:arg name="x"/>', "xacro", "default"),
    case("undefined argument", '<link name="$(arg x)"/>', "xacro-argument", "case.urdf.xacro:4: needs x:=…",
         "declared are: none"),
    case("undefined argument in an expression", "<link name=\"${xacro.arg('x')}\"/>", "xacro-argument",
         ":4: needs x:="),
    case("undefined arguments", '<xacro:arg name="l" default="2"/>\n<link name="$(arg x)"/>\n'
         "<xacro:if value=\"${1 == 2}\"/><link name=\"${xacro.arg('y')}\" x=\"$(arg l) $(arg z) $(arg x)\"/>",
         "xacro-argument", ":5: needs x:=…, y:=…, z:=…; declared are: l:=2"),
    case("undefined argument and another mistake", '<link name="$(arg x)"/><xacro:nosuch/>', "xacro-argument", "x:=…"),
    case("an argument for which there is no file", '<xacro:arg name="model" default="r9"/><xacro:include '
         'filename="config/$(arg model)/x.xacro"/>', "xacro-argument", ":4: needs model:=… (one of r1, r2); declared "
         "are: model:=r9", files={"config/r1/x": "", "config/r2/x": "", "config/r3.txt": ""}),
    case("an argument for which there is no YAML", '<xacro:arg name="model" default=""/>'
         "<xacro:property name=\"y\" value=\"${xacro.load_yaml('$(arg model).yaml')}\"/><x y=\"${y}\"/>",
         "xacro-argument", ":4: needs model:=… (one of r1, r2)", files={"r1.yaml": "", "r2.yaml": "", "r3.txt": ""},
         arguments=("model:=r7",)),
    case("two arguments of arg", '<link name="$(arg x y)"/>', "xacro", "only specify one arg"),
    case("unknown command", '<link name="$(anon x)"/>', "xacro", "Unknown substitution command"),
    case("command", '<link name="$(command ls)"/>', "xacro", "Unknown substitution command"),
    case("unset variable", '<link name="$(env PINSCREW_NO_SUCH)"/>', "xacro", "PINSCREW_NO_SUCH", "not set"),
    case("undefined property", '<link name="${x}"/>', "xacro", "name 'x' is not defined"),
    case("undefined property in a condition", '<xacro:if value="${x}"/>', "xacro", "'x' is not defined"),
    case("a condition of words", '<xacro:if value="maybe"/>', "xacro", "not a boolean expression"),
    case("circular properties", '<xacro:property name="p" value="${q}"/><xacro:property name="q" value="${p}"/>'
         '<xacro:if value="${p}"/>', "xacro", "circular"),
    case("property that is no name", '<xacro:property name="1x" value="1"/>', "xacro", "valid python identifiers"),
    case("property of two underscores", '<xacro:property name="__x" value="1"/>', "xacro", "double underscore"),
    case("property without name", '<xacro:property value="1"/>', "xacro", "name"),
    case("unknown macro", "<xacro:nosuch/>", "xacro", "unknown macro name: xacro:nosuch"),
    case("missing parameter", '<xacro:macro name="m" params="x"/><xacro:m/>', "xacro", "Undefined parameters [x]"),
    case("unknown parameter", '<xacro:macro name="m" params="x"/><xacro:m x="1" y="2"/>', "xacro",
         'Invalid parameter "y"'),
    case("missing block", '<xacro:macro name="m" params="*x"/><xacro:m/>', "xacro", "Not enough blocks"),
    case("unknown block", '<xacro:insert_block name="x"/>', "xacro", 'Undefined block "x"'),
    case("call of no macro", "<xacro:call/>", "xacro", "macro"),
    case("macro that calls itself", '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "xacro-limit",
         "without end"),
    case("macros that call each other", '<xacro:macro name="m"><xacro:n/></xacro:macro>'
         '<xacro:macro name="n"><xacro:m/></xacro:macro><xacro:m/>', "xacro-limit", "without end"),
    case("3¹⁵ expansions", '<xacro:macro name="m0"><link/></xacro:macro>'
         + "".join(f'<xacro:macro name="m{i + 1}">{f"<xacro:m{i}/>" * 3}</xacro:macro>' for i in range(15))
         + "<xacro:m15/>", "xacro-limit", LIMIT_WORDS, seconds=1),
    case("2³⁰ letters", "".join(f'<xacro:property name="p{i + 1}" value="${{p{i}}}${{p{i}}}"/>' for i in range(30))
         + '<xacro:property name="p0" value="x"/><xacro:if value="${p30}"/>', "xacro-limit", seconds=2),
    case("25 MB of links", "".join(f'<xacro:property name="p{i + 1}" value="${{p{i}}}${{p{i}}}"/>' for i in range(24))
         + '<xacro:property name="p0" value="x"/><link name="${p24}${p23}"/>', "too-large", "its expansion is larger"),
    case("catastrophic parameters", f'<xacro:macro name="m" params="a:={"x" * 60}&apos;"/>', "xacro-limit",
         LIMIT_WORDS, seconds=1),
    case("parameter called as a guard", '<xacro:macro name="m" params="__attribute"><xacro:if value="${[].append}"/>'
         '</xacro:macro><xacro:m __attribute="${max}"/>', "xacro-forbidden", "the attribute append of a list",
         'in macro "m", called from case.urdf.xacro:4: '),
    case("power called as a guard", '<xacro:macro name="m" params="__power"><xacro:if value="${9**9**9}"/>'
         '</xacro:macro><xacro:m __power="${max}"/>', "xacro-forbidden", "power of more"),
    Case("a macro's links twice", xacro('<xacro:macro name="m"><link name="c"/></xacro:macro><xacro:m/><xacro:m/>'),
         "duplicate-name", ("link 'c'",), suffix=".xacro"),
    Case("only macros", f'<robot name="r" {NS}>\n<xacro:macro name="arm" params="prefix *origin parent:=x n">'
         '<link name="${prefix}"/></xacro:macro><xacro:macro name="leg"/></robot>', "xacro-macros",
         ("only defines macros, and no robot: arm, leg; include it", '<xacro:arm prefix="…" n="…"/>'),
         error="XacroError", suffix=".xacro"),
    Case("no robot", f'<a {NS}><xacro:if value="0"/></a>', "root-element", ("<a>",), suffix=".xacro"),
    Case("xacro without its namespace", '<robot name="r"><xacro:property name="p" value="1"/></robot>', "xacro",
         error="XacroError", suffix=".xacro"),
    Case("xacro that is not XML", f'<robot name="r" {NS}><link name="a">', "not-xml", ("no element found",),
         error="XacroError", suffix=".xacro"),
    Case("xacro with a DOCTYPE", f"<!DOCTYPE robot>{xacro('')}", "doctype", ("remove it",), 1, error="XacroError",
         suffix=".xacro"),
    Case("xacro with entities", f'<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]>{xacro("&a;")}', "doctype",
         ("DOCTYPE",), 1, error="XacroError", suffix=".xacro"),
    Case("xacro in UTF-16", xacro("").encode("utf-16"), "encoding", ("not UTF-8",), 1, suffix=".xacro"),
    Case("empty xacro", "", "not-xml", ("no element found",), error="XacroError", suffix=".xacro"),
    Case("xacro nested 10⁵ deep", lambda: xacro("<x>" * 100_000 + "</x>" * 100_000), "xacro-limit", ("without end",),
         error="XacroError", suffix=".xacro"),
    Case("xacro of 240 000 elements", lambda: xacro("<x><y/></x>" * 120_000), "xacro-limit", (LIMIT_WORDS,),
         error="XacroError", suffix=".xacro", seconds=1),
]  # fmt: skip

# ---------------------------------------------------------------------------------------------------- other files


def include(name: str, file: str, code: str, *words: str, files: dict[str, Content] | None = None) -> Case:
    """A xacro file that includes another."""
    return case(name, f'<xacro:include filename="{file}"/>', code, *words, files=files)


def yaml(name: str, file: str, code: str, *words: str, files: dict[str, Content] | None = None, **more: int) -> Case:
    """A xacro file that loads a YAML file."""
    body = f"<xacro:if value=\"${{str(xacro.load_yaml('{file}'))}}\"/>"
    return case(name, body, code, *words, files=files, seconds=more.get("seconds"))


OUTSIDE: Final = ("outside its own folder", "--allow-outside")
ITSELF: Final = f'<robot {NS}><xacro:include filename="more.xacro"/></robot>'
BOMB: Final = "l0: &l0 [x, x]\n" + "".join(
    f"l{i + 1}: &l{i + 1} [{', '.join([f'*l{i}'] * 9)}]\n" for i in range(9)
)  # fmt: skip

OTHERS: Final = [
    include("include of a system file", "/etc/hostname", "outside", "/etc/hostname", *OUTSIDE),
    include("include from above", "../secret.xacro", "outside", *OUTSIDE, files={"../secret.xacro": "<robot/>"}),
    include("include from above what is not there", "../nosuch.xacro", "outside", *OUTSIDE),
    include("include by a detour", "sub/../../secret.xacro", "outside", *OUTSIDE, files={"sub/x": ""}),
    include("include of a link outside", "link.xacro", "outside", *OUTSIDE,
            files={"link.xacro": "-> ../secret.xacro", "../secret.xacro": "<robot/>"}),
    include("include in a linked folder", "folder/passwd", "outside", *OUTSIDE, files={"folder": "-> /etc"}),
    include("include of a link in a circle", "link.xacro", "unreadable", "link.xacro",
            files={"link.xacro": "-> link.xacro"}),
    include("include by a wild card", "/etc/host*", "outside", *OUTSIDE),
    include("include by a wild card above", "../*.xacro", "outside", *OUTSIDE, files={"../secret.xacro": "<robot/>"}),
    include("include of the process", "/proc/self/environ", "outside", *OUTSIDE),
    include("include of a device", "/dev/zero", "outside", *OUTSIDE),
    include("include of home", "${xacro.abs_filename('/etc/passwd')}", "outside", *OUTSIDE),
    include("include by argument", "$(eval '/etc' + '/passwd')", "outside", *OUTSIDE),
    include("include of an address", "http://127.0.0.1:9/x.xacro", "xacro", "there is no such file"),
    include("include of nothing", "nosuch.xacro", "xacro", "there is no such file", "nosuch.xacro"),
    include("include of a folder", "sub", "xacro", "there is no such file", files={"sub/x": ""}),
    include("include of the empty name", "", "xacro", "there is no such file"),
    include("include of bad XML", "more.xacro", "not-xml", "more.xacro:2", files={"more.xacro": "<robot>\n<a>"}),
    include("include of a DOCTYPE", "more.xacro", "doctype", "more.xacro:1", files={"more.xacro": "<!DOCTYPE r><r/>"}),
    include("include of a DOCTYPE by another name", "x.yaml", "doctype", "x.yaml:1",
            files={"x.yaml": f'<!DOCTYPE r [<!ENTITY e "1">]><r {NS}><x v="&e;"/></r>'}),
    include("include of UTF-16", "more.xacro", "encoding", "more.xacro:1", "not UTF-8",
            files={"more.xacro": "<robot/>".encode("utf-16")}),
    include("include of a mistake", "more.xacro", "xacro", "more.xacro:1: ", "division by zero",
            files={"more.xacro": f'<robot {NS}><xacro:if value="${{1/0}}"/></robot>'}),
    include("include of itself", "more.xacro", "xacro-limit", "without end", files={"more.xacro": ITSELF}),
    include("include of 21 MB", "more.xacro", "too-large", "more.xacro", "20 MB",
            files={"more.xacro": lambda: " " * (20 * 2**20 + 1)}),
    include("unknown package", "$(find nosuch)/x.xacro", "unknown-package", "'nosuch'", "--package nosuch:=PATH"),
    include("package by a path", "$(find ../..)/etc/hostname", "unknown-package", "'../..'"),
    include("package of an absolute path", "$(find /etc)/hostname", "unknown-package", "'/etc'"),
    include("two packages", "$(find a b)/x.xacro", "xacro", "exactly one argument"),
    case("above a package", '<xacro:include filename="$(find pkg)/../secret.xacro"/>', "outside", *OUTSIDE,
         files={"../p/pkg/x": "", "../p/secret.xacro": "<robot/>"}, arguments=("--package", "pkg:=../p/pkg")),
    case("package that is nowhere", '<xacro:include filename="$(find pkg)/x"/>', "unknown-package", "'pkg'",
         arguments=("--package", "pkg:=/nosuch")),
    yaml("YAML of a system file", "/etc/passwd", "outside", *OUTSIDE),
    yaml("YAML from above", "../secret.yaml", "outside", *OUTSIDE, files={"../secret.yaml": "a: 1"}),
    yaml("YAML by a link", "link.yaml", "outside", *OUTSIDE, files={"link.yaml": "-> /etc/passwd"}),
    yaml("YAML that is not there", "nosuch.yaml", "xacro", "no such file"),
    yaml("YAML with Python", "a.yaml", "xacro", "could not determine a constructor",
         files={"a.yaml": "!!python/object/apply:os.system ['true']"}),
    yaml("YAML that is broken", "a.yaml", "xacro", "a.yaml", files={"a.yaml": "a: [1, 2\nb: }"}),
    yaml("YAML nested deep", "a.yaml", "xacro-limit", files={"a.yaml": "[" * 5_000 + "]" * 5_000}),
    yaml("YAML bomb", "a.yaml", "xacro-limit", files={"a.yaml": BOMB}, seconds=2),
    yaml("YAML of 10 MB", "a.yaml", "xacro-limit", LIMIT_WORDS, files={"a.yaml": lambda: "- 1\n" * 2_500_000},
         seconds=1),
    yaml("YAML with an attack in a unit", "a.yaml", "xacro-forbidden", "__class__",
         files={"a.yaml": "a: !degrees '[].__class__'"}),
    yaml("YAML in latin-1", "a.yaml", "encoding", "a.yaml:1", files={"a.yaml": "a: ü".encode("latin-1")}),
    case("attribute of YAML", "<xacro:if value=\"${xacro.load_yaml('a.yaml').pop()}\"/>", "xacro", "no key 'pop'",
         files={"a.yaml": "a: 1"}),
    case("underscores of YAML", "<xacro:if value=\"${xacro.load_yaml('a.yaml').__class__}\"/>", "xacro-forbidden",
         "__class__", files={"a.yaml": "__class__: 1"}),
]  # fmt: skip

REFUSED: Final = [*EXPRESSIONS, *MACROS, *OTHERS]
