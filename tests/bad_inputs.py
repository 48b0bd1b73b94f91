"""Bad, hostile and odd URDFs as data: what is in the file, and what must be said about it.

`REFUSED` must be refused with one error; `ACCEPTED` look odd and must load, with the warnings named.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

import urdfs

Content = str | bytes | Callable[[], str | bytes]


@dataclass(frozen=True)
class Case:
    """A file and what becomes of it.

    Attributes:
        name: of the case.
        content: of the file; a function where it is large.
        code: of the error; of the warning, or empty, for what must load.
        words: what the message must hold.
        line: where the error must be, if known.
        element: what the error must name, if known.
        error: the error's class, by name.
        suffix: of the file's name.
        arguments: that follow the file on the command line.
        files: further files, by their path from the file's folder; ``-> path`` is a link.
        seconds: that an expansion may take, for those that would take all they get.
        links: number of links of what must load.
    """

    name: str
    content: Content
    code: str
    words: tuple[str, ...] = ()
    line: int | None = None
    element: str | None = None
    error: str = "DescriptionError"
    suffix: str = ".urdf"
    arguments: tuple[str, ...] = ()
    files: dict[str, Content] = field(default_factory=dict)
    seconds: int | None = None
    links: int | None = None

    def data(self) -> bytes:
        """The bytes of the file."""
        return data(self.content)


def data(content: Content) -> bytes:
    """Content as bytes."""
    content = content() if callable(content) else content
    return content if isinstance(content, bytes) else content.encode()


LINKS: Final = '<link name="a"/>\n<link name="b"/>'
LIMIT: Final = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
Z: Final = '<axis xyz="0 0 1"/>'
ENDS: Final = '<parent link="a"/><child link="b"/>'
JOINT_LINE: Final = 4


def robot(body: str, links: str = LINKS, attributes: str = ' name="r"', head: str = "") -> str:
    """A robot; with the default links its body starts on line `JOINT_LINE`."""
    return f"{head}<robot{attributes}>\n{links}\n{body}\n</robot>\n"


def joint(
    inner: str = LIMIT, *, name: str = "j", kind: str = "revolute", ends: str = ENDS, attributes: str = ""
) -> str:
    """A joint from a to b."""
    return f'<joint name="{name}" type="{kind}"{attributes}>{ends}{inner}</joint>'


def plain(inner: str = LIMIT, **options: str) -> str:
    """A robot of one joint."""
    return robot(joint(inner, **options))


def at_joint(case: str, inner: str, code: str, *words: str, error: str = "DescriptionError", **options: str) -> Case:
    """A mistake in the lone joint of a robot."""
    text = plain(inner, **options)
    return Case(case, text, code, words, JOINT_LINE, f"joint {options.get('name', 'j')!r}", error)


# ------------------------------------------------------------------------------------------- files and encodings

DECLARED: Final = '<?xml version="1.0" encoding="{}"?>\n'
BIG: Final = 20 * 2**20

FILES: Final = [
    Case("empty file", "", "not-xml", ("no element found",), 1),
    Case("only spaces", " \n \n", "not-xml", ("no element found",)),
    Case("only a comment", "<!-- robot -->", "not-xml", ("no element found",)),
    Case("no xml", "name: robot\nlinks: []\n", "not-xml", ("not well-formed",), 1),
    Case("json", '{"robot": 1}', "not-xml", ("not well-formed",)),
    Case("elf", b"\x7fELF\x02\x01\x01" + b"\x00" * 60, "encoding", ("NUL",), 1),
    Case("png", b"\x89PNG\r\n\x1a\n" + bytes(range(256)), "encoding", ("not UTF-8", "save the file as UTF-8")),
    Case("utf-16", plain().encode("utf-16"), "encoding", ("not UTF-8",), 1),
    Case("utf-16-le without mark", plain().encode("utf-16-le"), "encoding", ("NUL",)),
    Case("utf-32", plain().encode("utf-32"), "encoding", ("not UTF-8",)),
    Case("utf-16 declared", DECLARED.format("UTF-16") + plain(), "encoding", ("declares the encoding 'UTF-16'",), 1),
    Case("latin-1 declared", DECLARED.format("ISO-8859-1") + plain(), "encoding", ("'ISO-8859-1'", "UTF-8"), 1),
    Case("latin-1 bytes", plain(name="gelenk_ü").encode("latin-1"), "encoding", ("not UTF-8",), JOINT_LINE),
    Case("utf-7 declared", DECLARED.format("utf-7") + plain(), "encoding", ("'utf-7'",), 1),
    Case("an encoding of no name", DECLARED.format("") + plain(), "encoding", ("declares the encoding ''",), 1),
    Case("overlong utf-8", plain().replace("j", "\0").encode().replace(b"\0", b"\xc1\xaa"), "encoding", ("not UTF-8",)),
    Case("surrogates", plain().encode().replace(b'"j"', b'"\xed\xa0\x80"'), "encoding", ("not UTF-8",), JOINT_LINE),
    Case("NUL", plain().encode().replace(b'"j"', b'"j\0"'), "encoding", ("NUL character",), JOINT_LINE),
    Case("NUL by number", plain(name="j&#0;"), "not-xml", ("invalid character number",), JOINT_LINE),
    Case("escape by number", plain(name="j&#27;[31m"), "not-xml", ("invalid character number",), JOINT_LINE),
    Case("control character", plain(name="j\x07"), "not-xml", ("invalid token",), JOINT_LINE),
    Case("21 MB", lambda: plain() + " " * (BIG + 1), "too-large", ("larger than 20 MB",)),
    Case("21 MB of noise", lambda: b"\xff" * (BIG + 1), "too-large", ("larger than 20 MB",)),
]

# ------------------------------------------------------------------------------------------------------ markup

LAUGHS: Final = "".join(f'<!ENTITY l{i + 1} "{f"&l{i};" * 10}">' for i in range(9))

MARKUP: Final = [
    Case("truncated", plain()[:-10], "not-xml", ("no element found",), 4),
    Case("truncated in a tag", plain()[:60], "not-xml", ("unclosed token",)),
    Case("crossed tags", "<robot name='r'><link name='a'></robot></link>", "not-xml", ("mismatched tag",), 1),
    Case("two roots of the document", plain() + plain(), "not-xml", ("junk after document element",), 6),
    Case("text after the end", plain() + "and more", "not-xml", ("junk after document element",), 6),
    Case("text before the start", "robot: " + plain(), "not-xml", ("not well-formed",), 1),
    Case("duplicate attribute", plain(attributes=' name="k"'), "not-xml", ("duplicate attribute",), JOINT_LINE),
    Case("attribute without quotes", robot("", links="<link name=a/>"), "not-xml", ("not well-formed",), 2),
    Case("ampersand", robot("", links='<link name="a&b"/>'), "not-xml", ("not well-formed",), 2),
    Case("less than", robot("", links='<link name="a<b"/>'), "not-xml", ("not well-formed",), 2),
    Case("undefined entity", robot("", links='<link name="&name;"/>'), "not-xml", ("undefined entity",), 2),
    Case("declaration too late", "\n" + DECLARED.format("utf-8") + plain(), "not-xml",
         ("not at start", "delete what stands before <?xml on line 2"), 2),
    Case("dashes in a comment", robot("<!-- a -- b -->" + joint()), "not-xml", ("not well-formed",), JOINT_LINE),
    Case("DOCTYPE", "<!DOCTYPE robot>" + plain(), "doctype", ("DOCTYPE", "remove it"), 1),
    Case("entity", f'<!DOCTYPE robot [<!ENTITY a "b">]>{plain(name="&a;")}', "doctype", ("entities",), 1),
    Case("billion laughs", f'<!DOCTYPE robot [<!ENTITY l0 "lol">{LAUGHS}]>{plain(name="&l9;")}', "doctype"),
    Case(
        "external entity",
        f'<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>{robot("&a;")}',
        "doctype",
        ("DOCTYPE",),
    ),
    Case("external DTD", '<!DOCTYPE robot SYSTEM "http://127.0.0.1:9/x.dtd">' + plain(), "doctype", ("DOCTYPE",)),
    Case("parameter entity", '<!DOCTYPE r [<!ENTITY % p SYSTEM "/etc/hosts">%p;]>' + plain(), "doctype", ("DOCTYPE",)),
    Case("nested 300 000 deep", lambda: "<x>" * 300_000 + "</x>" * 300_000, "too-large", ("250000 elements",), 1),
    Case("five million elements", lambda: "<r>" + "<a/>" * 5_000_000 + "</r>", "too-large", ("250000 elements",), 1),
    Case("10⁵ attributes", lambda: robot("<x " + " ".join(f"a{i}=''" for i in range(10**5)) + "/>"), "too-large",
         ("more than 1000 attributes of an element",), JOINT_LINE),
    Case("an attribute of 15 MB", lambda: plain(name="j" * 15_000_000), "too-large",
         ("more than 100000 characters in an attribute",), JOINT_LINE),
]  # fmt: skip

# ------------------------------------------------------------------------------------------ the robot's elements

STRUCTURE: Final = [
    *(
        Case(f"root {tag}", f'<{tag} name="r"><link name="a"/></{tag}>', "root-element", (f"<{tag}>", "<robot>"), 1)
        for tag in ("sdf", "Robot", "ROBOT", "xacro", "html")
    ),
    Case("root mujoco", '<mujoco name="r"><link name="a"/></mujoco>', "mjcf", ("MuJoCo refuses it",), 1),
    Case("prefixed root", '<u:robot xmlns:u="http://u" name="r"><u:link name="a"/></u:robot>', "root-element",
         ("without a namespace prefix",), 1),
    Case("root of an undeclared prefix", '<u:robot name="r"><link name="a"/></u:robot>', "root-element",
         ("without a namespace prefix",), 1),
    Case("prefixed links", '<robot name="r" xmlns:u="http://u"><u:link name="a"/></robot>', "no-links", ("no links",)),
    Case("links in capitals", '<robot name="r"><Link name="a"/></robot>', "no-links", ("at least one <link>",), 1),
    Case("no links", '<robot name="r"/>', "no-links", ("has no links",), 1, "<robot>"),
    Case("a joint alone", robot(joint(), links=""), "no-links", ("has no links",), 1),
    Case("links below links", '<robot name="r"><links><link name="a"/></links></robot>', "no-links", ("no links",)),
    Case("robot without name", robot(joint(), attributes=""), "no-name", ('write <robot name="...">',), 1, "<robot>"),
    Case("robot with an empty name", robot(joint(), attributes=' name=""'), "no-name", ("has no name",), 1),
    Case("robot with a name of spaces", robot(joint(), attributes=' name=" "'), "no-name", ("has no name",), 1),
    Case("link without name", robot("<link/>"), "no-name", ('write <link name="...">',), JOINT_LINE, "<link>"),
    Case("link with an empty name", robot('<link name=""/>'), "no-name", ("has no name",), JOINT_LINE),
    Case("link with a name of spaces", robot('<link name="&#10; &#9;"/>'), "no-name", ("has no name",), JOINT_LINE),
    Case("joint without name", robot(joint().replace(' name="j"', "")), "no-name", ("<joint",), JOINT_LINE, "<joint>"),
    Case("joint with an empty name", plain(name=""), "no-name", ("has no name",), JOINT_LINE),
    Case("two links of a name", robot('<link name="a"/>'), "duplicate-name", ("link 'a'", "line 2"), JOINT_LINE),
    Case("two joints of a name", robot(joint() + "\n" + joint(), links=LINKS), "duplicate-name",
         ("joint 'j'", f"line {JOINT_LINE}"), JOINT_LINE + 1),
    Case("two roots", robot("", links=LINKS), "two-roots", ("2 root links: 'a', 'b'", "join them"), 1, "<robot>"),
    Case("a thousand roots", lambda: robot("".join(f'<link name="l{i}"/>' for i in range(1000))), "two-roots",
         ("1002 root links", "…"), 1),
    Case("roots with long names", robot("", links=f'<link name="{"x" * 50_000}"/><link name="{"y" * 50_000}"/>'),
         "two-roots", ("2 root links: 'xxx", "yyy'"), 1),
    Case("xacro in a URDF", robot('<xacro:property name="p" value="1"/>'), "unexpanded-xacro",
         ("<xacro:property>", "xmlns:xacro="), JOINT_LINE),
    Case("a macro in a URDF", robot('<xacro:macro name="m"/>'), "unexpanded-xacro", ("<xacro:macro>",), JOINT_LINE),
    Case("10⁵ links", lambda: robot("".join(f'<link name="l{i}"/>' for i in range(100_000))), "too-large",
         ("100002 links are more than 10000",), 1, "<robot>"),
]  # fmt: skip

BC: Final = '<parent link="b"/><child link="c"/>'
CB: Final = '<parent link="c"/><child link="b"/>'
ABC: Final = '<link name="a"/><link name="b"/>\n<link name="c"/>'

TREE: Final = [
    at_joint("self-loop", LIMIT, "self-loop", "joins 'b' to itself", ends='<parent link="b"/><child link="b"/>'),
    Case("cycle", robot(joint() + joint(name="k", ends='<parent link="b"/><child link="a"/>')), "cycle",
         ("link 'a'", "cycle"), 2, "link 'a'"),
    Case("isolated cycle", robot(joint(ends=BC) + joint(name="k", ends=CB), ABC),
         "cycle", ("link 'b'", "no root link leads to it"), 2, "link 'b'"),
    Case("isolated self-loop", robot(joint() + joint(name="k", ends='<parent link="c"/><child link="c"/>'), ABC),
         "self-loop", ("joint 'k'", "joins 'c' to itself"), 4),
    Case("two joints to a link", robot(f"{joint()}\n{joint(name='k', ends=CB)}", ABC), "two-parents",
         ("joint 'k'", "leads to 'b', as joint 'j' does"), 5, "joint 'k'"),
    Case("two joints between two links", robot(joint() + "\n" + joint(name="k")), "two-parents", ("joint 'k'",), 5),
    at_joint("unknown parent", LIMIT, "unknown-link", "its parent is 'x'", ends='<parent link="x"/><child link="b"/>'),
    at_joint("unknown child", LIMIT, "unknown-link", "its child is 'x'", ends='<parent link="a"/><child link="x"/>'),
    at_joint("link of other case", LIMIT, "unknown-link", "'A'", ends='<parent link="A"/><child link="b"/>'),
    at_joint("link with a space more", LIMIT, "unknown-link", "'a '", ends='<parent link="a "/><child link="b"/>'),
    at_joint("no parent", LIMIT, "no-link", "has no parent link", '<parent link="..."/>', ends='<child link="b"/>'),
    at_joint("no child", LIMIT, "no-link", "has no child link", ends='<parent link="a"/>'),
    at_joint("parent without link", LIMIT, "no-link", "has no parent link", ends='<parent/><child link="b"/>'),
    at_joint("parent with empty link", LIMIT, "no-link", "no parent", ends='<parent link=""/><child link="b"/>'),
    at_joint("child as text", LIMIT, "no-link", "no child link", ends='<parent link="a"/><child>b</child>'),
    at_joint("two parents", LIMIT, "duplicate-element", "has 2 <parent> elements", ends=f'{ENDS}<parent link="b"/>'),
    at_joint("two children", LIMIT, "duplicate-element", "has 2 <child> elements", ends=f'{ENDS}<child link="a"/>'),
    *(
        at_joint(f"two of {tag}", LIMIT + element * 2, "duplicate-element", f"<{tag}> elements", "keep one")
        for tag, element in (
            ("axis", '<axis xyz="0 0 1"/>'),
            ("origin", "<origin/>"),
            ("limit", LIMIT),
            ("mimic", '<mimic joint="j"/>'),
        )
    ),
    at_joint("joint named universe", LIMIT, "reserved-name", "rename the joint", name="universe"),
    *(
        at_joint(f"type {kind}", LIMIT, "joint-type", repr(kind), "use one of revolute", kind=kind)
        for kind in ("", "Revolute", "hinge", "ball", "screw", "spherical", "revolute ", "continous")
    ),
    Case("no type", plain().replace(' type="revolute"', ""), "joint-type", ("has no type",), JOINT_LINE, "joint 'j'"),
    at_joint("a type of 90 kB", LIMIT, "joint-type", "'xxx", "does not exist", kind="x" * 90_000),
]  # fmt: skip

# ------------------------------------------------------------------------------------------------------ numbers

NOT_NUMBERS: Final = (
    "1_0", "١", "１", "१", "1,5", "0x1p3", "0x10", "inf", "-inf", "Infinity", "nan", "NaN", "-nan", "1e999", "-1e999",
    "1e", "e5", ".", "+", "--1", "+-1", "1d3", "1.f", "1/2", "∞", "½", "²", "1e5.5", "1..2", "${x}",
    "true", "None", "pi", "1e+", "1-", "−1", "0b1", "1\u200b", "\ufeff1", "1j", "'1'",
)  # fmt: skip
COUNTS: Final = {
    "": 0, " ": 0, "1": 1, "1 2": 2, "1 2 3 4": 4, "1\u00a02\u00a03": 1, "1\u20032\u20033": 1, "1,2,3": 1, "1;2;3": 1,
    "1, 2": 2, "1 2 3 4 5 6": 6, "1\u30002\u30003": 1, "1\x852\x853": 1,
}  # fmt: skip

NUMBERS: Final = [
    *(
        at_joint(f"origin xyz {text!r}", f'{LIMIT}<origin xyz="{text} 0 0"/>', "number", repr(text), "3 finite numbers")
        for text in NOT_NUMBERS
    ),
    *(
        at_joint(f"axis of {count}: {text!r}", f'{LIMIT}<axis xyz="{text}"/>', "number-count", f"{count} values")
        for text, count in COUNTS.items()
    ),
    at_joint("origin rpy nan", f'{LIMIT}<origin rpy="0 nan 0"/>', "number", "<origin rpy=", "'nan'"),
    at_joint("origin rpy of 2", f'{LIMIT}<origin rpy="0 0"/>', "number-count", "<origin rpy='0 0'> has 2 values"),
    at_joint("origin xyz of none", f'{LIMIT}<origin xyz=""/>', "number-count", "has 0 values"),
    at_joint("origin of a fixed joint", '<origin xyz="0 0 x"/>', "number", "'x'", kind="fixed"),
    at_joint("origin of a floating joint", '<origin xyz="0 0 x"/>', "number", "'x'", kind="floating"),
    at_joint("axis nan", f'{LIMIT}<axis xyz="0 0 nan"/>', "number", "<axis xyz=", "'nan'"),
    *(
        at_joint(
            f"limit {name} {text!r}", LIMIT.replace(f'{name}="{old}"', f'{name}="{text}"'), code, f"<limit {name}="
        )
        for name, old in (("lower", "-1"), ("upper", "1"), ("effort", "1"), ("velocity", "1"))
        for text, code in (("", "number-count"), ("1 1", "number-count"), ("inf", "number"), ("1_0", "number"))
    ),
    at_joint("huge origin", f'{LIMIT}<origin xyz="1e10 0 0"/>', "number", "1e10 is larger than 1e+09"),
    at_joint("huge axis", f'{LIMIT}<axis xyz="1e200 0 0"/>', "number", "1e200 is larger than 1e+09"),
    at_joint("a number of 90 kB", f'{LIMIT}<origin xyz="{"1" * 90_000}x 0 0"/>', "number", "111 … 111", "finite"),
    at_joint("30 000 numbers", f'{LIMIT}<origin xyz="{"1 " * 30_000}"/>', "number-count", "has 30000 values"),
]

# ------------------------------------------------------------------------------- axes, limits, mimics, planar joints


def mimics(*mimic: str, kinds: tuple[str, ...] = ("revolute", "revolute", "revolute")) -> str:
    """Three joints in a chain with a mimic each, on lines of their own from `JOINT_LINE` on; "" is none."""
    joints = [
        joint(LIMIT + (f"<mimic {words}/>" if words else ""), name=f"j{i}", kind=kind, ends=ends)
        for i, (words, kind, ends) in enumerate(
            zip(mimic, kinds, (ENDS, BC, '<parent link="c"/><child link="d"/>'), strict=True)
        )
    ]
    return robot("\n".join(joints), ABC + '<link name="d"/>')


J0, J1, J2 = (f'joint="j{i}"' for i in range(3))

JOINTS: Final = [
    *(
        at_joint(f"axis {text}", f'{LIMIT}<axis xyz="{text}"/>', "zero-axis", *words)
        for text, words in {
            "0 0 0": ("the axis is zero", "unit vector"),
            "-0 0 0.0e5": ("the axis is zero",),
            "0 0 1e-400": ("the axis is zero",),
            "1e-200 0 0": ("1e-200 long and has no direction",),
            "1e-10 0 1e-10": ("has no direction",),
        }.items()
    ),
    Case("version 2", robot(joint(), attributes=' name="r" version="2.0"'), "urdf-version", ("'2.0'", "1.2"), 1),
    Case("version of words", robot(joint(), attributes=' name="r" version="x"'), "urdf-version", ("'x'", "1.0"), 1),
    at_joint("quaternion below 1.2", f'{LIMIT}<origin quat_xyzw="0 0 0 1"/>', "origin-quaternion", 'version="1.2"'),
    *(Case(f"quaternion {name}", plain(f"{LIMIT}<origin {text}/>").replace('"r"', '"r" version="1.2"'), code, words,
           JOINT_LINE, "joint 'j'")
      for name, text, code, words in (
          ("beside rpy", 'rpy="0 0 0" quat_xyzw="0 0 0 1"', "origin-quaternion", ("both",)),
          ("of zeros", 'quat_xyzw="0 0 0 0"', "origin-quaternion", ("no rotation", "0 0 0 1")),
          ("of three", 'quat_xyzw="0 0 1"', "number-count", ("3 values",)),
          ("of words", 'quat_xyzw="0 0 0 w"', "number", ("'w'",)),
      )),
    at_joint("axis without xyz", f"{LIMIT}<axis/>", "no-axis", "<axis> has no xyz"),
    at_joint("axis as rpy", f'{LIMIT}<axis rpy="0 0 1"/>', "no-axis", "<axis> has no xyz"),
    at_joint("planar about x", '<axis xyz="1 0 0"/>', "planar-axis", "turn the origin", kind="planar",
             error="UnsupportedError"),
    at_joint("planar without axis", "", "planar-axis", "Pinocchio ignores", kind="planar", error="UnsupportedError"),
    at_joint("planar about -z", '<axis xyz="0 0 -1"/>', "planar-axis", "x and y", kind="planar",
             error="UnsupportedError"),
    at_joint("planar with a zero axis", '<axis xyz="0 0 0"/>', "zero-axis", "zero", kind="planar"),
    *(at_joint(f"{kind} without limit", "", "no-limit", f"a {kind} joint needs a <limit>", kind=kind)
      for kind in ("revolute", "prismatic")),
    *(at_joint(f"limit without {name}", LIMIT.replace(f'{name}="1"', ""), "no-limit", f"no {name}")
      for name in ("effort", "velocity")),
    at_joint("continuous with half a limit", '<limit effort="1"/>', "no-limit", "no velocity", kind="continuous"),
    Case("mimic of no joint", mimics("", "", 'joint="j9"'), "mimic-unknown", ("mimics 'j9'",), 6, "joint 'j2'"),
    Case("mimic of a link", mimics("", "", 'joint="a"'), "mimic-unknown", ("mimics 'a'",), 6),
    Case("mimic without joint", mimics("", "", 'multiplier="2"'), "mimic-unknown", ("has no joint",), 6),
    Case("mimic of ''", mimics("", "", 'joint=""'), "mimic-unknown", ("its <mimic> has no joint",), 6),
    Case("mimic of itself", mimics("", J1, ""), "mimic-cycle", ("mimics itself",), 5, "joint 'j1'"),
    Case("mimics of each other", mimics(J1, J0, ""), "mimic-cycle", ("in the end mimics itself", "freely"), 4),
    Case("three mimics in a circle", mimics(J1, J2, J0), "mimic-cycle", ("in the end mimics itself",), 4),
    Case("mimic of a circle", mimics(J1, J2, J1), "mimic-cycle", ("in the end mimics itself",), 4, "joint 'j0'"),
    Case("mimic of a fixed joint", mimics("", J0, "", kinds=("fixed", "revolute", "revolute")), "mimic-type",
         ("'j0' is fixed",), 5, "joint 'j1'"),
    Case("mimic of a floating joint", mimics("", J0, "", kinds=("floating", "revolute", "revolute")), "mimic-type",
         ("'j0' is floating",), 5),
    Case("a floating mimic", mimics("", J0, "", kinds=("revolute", "floating", "revolute")), "mimic-type",
         ("'j1' is floating", "scalar joints"), 5),
    Case("a planar mimic", mimics("", J0, "", kinds=("revolute", "planar", "revolute")).replace(
        f"{LIMIT}<mimic", '<axis xyz="0 0 1"/><mimic'), "mimic-type", ("'j1' is planar",), 5),
    *(
        Case(f"mimic {name} {text!r}", mimics("", f'{J0} {name}="{text}"', ""), code, (f"<mimic {name}=",), 5)
        for name in ("multiplier", "offset")
        for text, code in (("", "number-count"), ("1_0", "number"), ("inf", "number"), ("1e12", "number"))
    ),
]  # fmt: skip

# ------------------------------------------------------------------------------------ what only Pinocchio refuses

PINOCCHIO: Final = [
    Case("CRLF in a link", robot(joint(ends='<parent link="a"/><child link="b\r\nc"/>'),
         '<link name="a"/><link name="b\r\nc"/>'), "pinocchio-frames", ("no link 'b c'",), error="EngineError"),
    Case("line break in a name", plain(name="a\nb"), "pinocchio-coordinates", ("'a\\nb'",), error="EngineError"),
    Case("line break in a link", robot(joint(ends='<parent link="a"/><child link="b\nc"/>'),
         '<link name="a"/><link name="b\nc"/>'), "pinocchio-frames", ("'b c'",), error="EngineError"),
    Case("1001 joints in a chain", lambda: urdfs.chain(1001, "fixed"), "pinocchio-size",
         ("1001 joints in a chain", "PoE"), error="UnsupportedError"),
    Case("201 coordinates", lambda: urdfs.chain(201), "pinocchio-size", ("201 velocities",), error="UnsupportedError"),
    Case("1500 joints", lambda: urdfs.chain(1500, "continuous"), "pinocchio-size", ("1500 velocities",),
         error="UnsupportedError"),
    Case("300 mimics of mimics", lambda: urdfs.robot(
        *(urdfs.joint(f"j{i}", "continuous", f"l{i}", f"l{i + 1}", mimic=(f"j{i + 1}", 1.0, 0.0) if i < 299 else None)
          for i in range(300)), links=" ".join(f"l{i}" for i in range(301))), "pinocchio-size", ("300",),
         error="UnsupportedError"),
]  # fmt: skip

REFUSED: Final = [*FILES, *MARKUP, *STRUCTURE, *TREE, *NUMBERS, *JOINTS, *PINOCCHIO]

# ------------------------------------------------------------------------------------------------ odd but right


def child_named(name: str) -> str:
    """A robot whose joint and child link have this name."""
    link = f'<link name="{name}"/>'
    return robot(joint(name=name, ends=f'<parent link="a"/><child link="{name}"/>'), f'<link name="a"/>\n{link}')


NAMES: Final = {
    "line feed": "b&#10;c", "tab": "b&#9;c", "carriage return": "b&#13;c", "slashes": "/b//c/", "dots": "../../b",
    "quotes": "&quot;b&apos;", "less than": "&lt;script&gt;", "ampersand": "b&amp;amp;c", "right to left": "שלום",
    "override": "b\u202ec", "astral": "😀&#x1F600;", "combining": "e\u0301", "spaces": " b  c ",
    "brackets": "[red]b[/]", "percent": "%s%n{0}", "dollar": "${b}$(c)", "backslash": "b\\nc",
    "newline of Unicode": "b\u2028c", "length": "b" * 99_000,
    "number": "1", "dash": "--tip", "controls": "b\u0085\u009b31mc", "zero width": "b\u200bc", "semicolon": "b;c,d=e",
}  # fmt: skip

ACCEPTED: Final = [
    *(Case(f"name with {name}", child_named(text), "", links=2) for name, text in NAMES.items()),
    Case("byte order mark", b"\xef\xbb\xbf" + plain().encode(), "", links=2),
    Case("declared utf-8", DECLARED.format("UTF-8") + plain(), "", links=2),
    Case("declared ascii", DECLARED.format("us-ascii") + plain(), "", links=2),
    Case("mark and declaration", b"\xef\xbb\xbf" + (DECLARED.format("utf-8") + plain()).encode(), "", links=2),
    Case("CRLF", plain().replace("\n", "\r\n"), "", links=2),
    Case("default namespace", robot(joint(), attributes=' xmlns="http://www.ros.org" name="r"'), "", links=2),
    Case("namespace of a joint", plain(attributes=' xmlns="http://www.ros.org"'), "", links=2),
    Case("namespace of an origin", plain(f'{LIMIT}<origin xmlns="u" xyz="1 2 3"/>'), "", links=2),
    Case("extension elements", robot('<g:world xmlns:g="http://g"><g:link/></g:world><e:x/>' + joint()), "", links=2),
    Case("attribute of an undeclared prefix", plain(attributes=' ext:id="1"'), "", links=2),
    Case("unknown elements", robot("<gazebo><link/><joint/></gazebo><transmission/>" + joint()), "", links=2),
    Case("unknown attributes", plain(attributes=' id="7"').replace("<limit", '<limit soft="x"'), "", links=2),
    Case("a capsule", robot(joint(), f'{LINKS[:-2]}><capsule_x/><collision_x/></link>'), "", links=2),
    Case("processing instruction", "<?a b?>" + plain(), "", links=2),
    Case("two byte order marks", b"\xef\xbb\xbf" * 2 + plain().encode(), "", links=2),
    Case("CDATA", robot("<![CDATA[<link name='z'/>]]>" + joint()), "", links=2),
    Case("comments", robot("<!-- <link name='z'/> -->" + joint()), "", links=2),
    Case("nested 400 deep", robot("<x>" * 400 + "</x>" * 400 + joint()), "", links=2),
    Case("10⁵ comments and texts", lambda: robot("a<!---->" * 100_000 + joint()), "", links=2),
    Case("a link alone", robot("", links='<link name="a"/>'), "", links=1),
    Case("joints before links", '<robot name="r">' + joint() + LINKS + "</robot>", "", links=2),
    Case("a number of 90 kB that is one", plain(f'{LIMIT}<origin xyz="0.{"3" * 90_000} 0 0"/>'), "", links=2),
    Case("numbers in all spellings", plain(f'{LIMIT}<origin xyz="+1. .5 -1E-3" rpy="00 1e0 -.0"/>'), "", links=2),
    Case("denormal origin", plain(f'{LIMIT}<origin xyz="1e-320 1e-400 0"/>'), "", links=2),
    Case("limits of no end", plain(LIMIT.replace("1", "1.7976931348623157e308")), "", links=2),
    Case("equal limits", plain(LIMIT.replace("-1", "1")), "", links=2),
    Case("axis of 2", plain(f'{LIMIT}<axis xyz="0 0 2"/>'), "axis-normalised", ("joint 'j'", "2 long"), links=2),
    Case("axis rounded to 3 digits", plain(f'{LIMIT}<axis xyz="0.577 0.577 0.577"/>'), "axis-normalised", links=2),
    Case("axis of 2e-9", plain(f'{LIMIT}<axis xyz="0 2e-9 0"/>'), "axis-normalised", ("2e-09 long",), links=2),
    Case("no bounds", plain('<limit effort="1" velocity="1"/>'), "limit-zero", ("lower and upper",), links=2),
    Case("no upper bound", plain('<limit lower="-1" effort="1" velocity="1"/>'), "limit-zero", ("upper",), links=2),
    Case("mimic on a fixed joint", mimics("", 'joint="nobody"', "", kinds=("revolute", "fixed", "revolute")),
         "mimic-fixed", ("joint 'j1'", "ignored"), links=4),
    Case("fixed joint with a bad axis", plain('<axis xyz="x"/>', kind="fixed"), "", links=2),
    Case("fixed joint with two axes", plain('<axis xyz="1 2"/><axis/>', kind="fixed"), "", links=2),
    Case("floating joint with a bad axis", plain('<axis xyz="x y"/>', kind="floating"), "", links=2),
    Case("planar joint with reversed limits", plain(Z + LIMIT.replace("-1", "2"), kind="planar"), "", links=2),
    *(Case(f"link named {name}", child_named(name), "", links=2) for name in ("root_joint", "world")),
    Case("link named universe", plain().replace('"b"', '"universe"'), "", links=2),
    Case("reversed limits", plain(LIMIT.replace("-1", "2")), "reversed-limits",
         ("2 is above its upper limit 1", "none"), links=2),
    Case("reversed slide", plain(LIMIT.replace("-1", "1e300"), kind="prismatic"), "reversed-limits",
         ("1e+300",), links=2),
]  # fmt: skip

# -------------------------------------------------------------- what Pinocchio refuses that is none of its business

PLAIN: Final = [
    *(Case(name, text, "pinocchio-plain", ("links and joints alone", words), links=2) for name, text, words in (
        ("limit with a space", plain(LIMIT.replace("-1", "-1 ")), "lower value"),
        ("numbers on lines of their own", plain(f'{LIMIT}<origin xyz="1\n2\n3"/>'), "origin"),
        ("negative effort", plain(LIMIT.replace('effort="1"', 'effort="-1"')), "effort"),
        ("material twice", robot('<material name="m"><color rgba="1 0 0 1"/></material>' * 2 + joint()), "material"),
        ("damping of words", plain(f'{LIMIT}<dynamics damping="x"/>'), "damping value (x)"),
        ("safety without numbers", plain(f"{LIMIT}<safety_controller/>"), "k_velocity"),
        ("limit of a fixed joint", plain('<limit lower="x"/>', kind="fixed"), "lower value (x)"),
        ("limit of a planar joint", plain(f'{Z}<limit upper="x"/>', kind="planar"), "upper value (x)"),
        ("limit of a floating joint", plain('<limit lower="x"/>', kind="floating"), "lower value (x)"),
        ("processing instruction inside", robot(f"<?a b?>{joint()}"), "PARSING_DECLARATION"),
        ("processing instruction at the end", plain() + "<?a b?>", "PARSING_DECLARATION"),
        ("nested 510 deep", robot("<x>" * 510 + "</x>" * 510 + joint()), "too deep"),
        ("nested 50 000 deep", lambda: robot("<x>" * 50_000 + "</x>" * 50_000 + joint()), "too deep"),
    )),
]  # fmt: skip
