"""Write docs/courseworks.md: each question of the five courseworks, the command that answers it, and its check.

python scripts/courseworks_page.py           # write
python scripts/courseworks_page.py --check   # exit status 1 if it is not up to date
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from generated import write_or_check

PAGE = Path(__file__).resolve().parents[1] / "docs" / "courseworks.md"
ENGINES = "both engines: exit status 0"
IDENTITY = "sympy: exit status 0"


@dataclass(frozen=True)
class Row:
    """A question.

    Attributes:
        part: of the coursework.
        question: in short.
        command: what answers it, after ``pinscrew``; nothing if no one command does.
        quantities: what ``pinscrew check ROBOT --quantity`` takes an answer of one's own for.
        check: how the answer is checked where there are none.
    """

    part: str
    question: str
    command: str
    quantities: tuple[str, ...] = ()
    check: str = ENGINES

    @property
    def robot(self) -> str:
        """The robot that the command is about."""
        return self.command.split()[1]


def of(part: str, question: str, command: str, *quantities: str, check: str = ENGINES) -> Row:
    """A row."""
    return Row(part, question, command, quantities, check)


MEDICAL_4 = (
    of("a", "home pose g(0)", "derive spherical --part a", "M"),
    of("a", "axes ω and a point q of each", "derive spherical --part home", "omega1", "omega2", "q1", "q2"),
    of("b", "−ω × q and the twists ξ₁, ξ₂, ξ₃", "derive spherical --part a,b", "xi1", "xi2", "xi3"),
    of(
        "c",
        "e^ξ̂θ of each, term by term",
        "derive spherical --part c --detail full",
        "exp1",
        "exp2",
        "exp3",
    ),
    of("c", "the exponentials alone", "derive spherical --part c --detail result", "exp1"),
    of("d", "their products", "derive spherical --part c,d", "prod2", "prod3"),
    of("d", "the pose g(θ)", "derive spherical --part d --detail result", "T"),
    of("e", "ġ, term by term", "derive spherical --part e", "Tdot"),
    of("f", "Rᵀ, −Rᵀp and g⁻¹", "derive spherical --part f", "Tinv"),
    of("g", "V̂ᵇ = g⁻¹ġ", "derive spherical --part e,f,g", "Vbhat"),
    of("h", "Rᵀ, ṗ, Rᵀṗ, Ṙ, RᵀṘ and Vᵇ", "derive spherical --part h --detail full", "pdot", "Vb"),
    of("i", "g₁, g₂, g₃", "derive spherical --part i --detail full", "tail1", "tail2", "tail3"),
    of("i", "p̂, −Rᵀp̂ and the inverse adjoints", "derive spherical --part i --detail full", "Ad(inv(tail2))", "Adinv"),
    of("i", "ξ₁†, ξ₂†, ξ₃† and Jᵇ", "derive spherical --part i", "Jb1", "Jb2", "Jb3", "Jb"),
    of("j", "Vᵇ = Jᵇθ̇, which must be (h)", "derive spherical --part h,j", "Vb"),
    of("k", "the hybrid velocity", "derive spherical --part k", "Vh"),
    of("a–k", "all of it as one report", "derive spherical"),
    of(
        "a–k",
        "my own solution: which entry is wrong?",
        "check spherical --quantity xi2 --text '[0, -L_0, 0, -1, 0, 0]^T'",
        check="exit status 1 if one is",
    ),
    of("a–k", "what is printed wrongly", "derive spherical --errata"),
)
MEDICAL_3 = (
    of("a", "axes and home pose, frame 0 at the base", "derive planar_2r --part a", "M", "omega1", "q1"),
    of("a", "the same, frame 0 at the tip", "derive planar_2r --reference frame0 --part a"),
    of("b", "pitch, axis, magnitude of each twist, base", "derive planar_2r --part a,b,screws", "foot1", "foot2"),
    of("b", "the same, tip", "derive planar_2r --reference frame0 --part a,b,screws"),
    of("b", "the same as numbers", "screws planar_2r"),
    of("b", "as numbers, tip", "screws planar_2r --reference frame0"),
    of("c", "the twists, base", "derive planar_2r --part a,b", "xi1", "xi2"),
    of("c", "the twists, tip", "derive planar_2r --reference frame0 --part a,b"),
    of("d, e", "g(θ) by the product of exponentials, base", "derive planar_2r --part c,d", "T"),
    of("d, e", "the same, tip", "derive planar_2r --reference frame0 --part c,d"),
    of("e", "the tip's choice carried to the base is the same pose", "derive planar_2r --via frame0", "T"),
    of("e", "Jacobians, base", "derive planar_2r --part Js,Jb", "Js", "Jb"),
    of("e", "Jacobians, tip", "derive planar_2r --reference frame0 --part Js,Jb"),
    of("f", "the workspace of both choices, which coincide", "workspace planar_2r --compare"),
    of("a–f", "what is printed wrongly", "derive planar_2r --errata"),
)
ROBOTICS_2 = (
    of("Q1", "columns of R are orthonormal: R Rᵀ = I", "derive --identity rotation", check=IDENTITY),
    of("Q2", "R⁻¹ = Rᵀ, det R = 1 and not −1", "derive --identity rotation", check=IDENTITY),
    of("Q5", "R S(a) Rᵀ = S(R a)", "derive --identity rotation", check=IDENTITY),
    of("Q7", "link transforms of the SCARA", "derive scara --part geometric"),
    of("Q7", "its pose", "derive scara --part T", "T", "p"),
    of("Q8", "link transforms of the Stanford-type arm", "derive stanford --part geometric"),
    of("Q8", "its pose", "derive stanford --part T", "T", "p"),
    of("Q9", "the obstacle as the drone's pose gives it", "derive drone --tip obstacle --part T", "T"),
    of("Q9", "the same in numbers", "fk drone -q 10,30deg,60deg --tip obstacle"),
    of("Q10", "a gear pair: ratio, twists", "derive gear_pair --part twists"),
    of("Q10", "its ratio in numbers", "jacobian gear_pair --kind spatial"),
    of("Q10", "bevel gears", "derive bevel_pair --part twists"),
    of("Q10", "a lead screw: its pitch", "derive lead_screw --part twists"),
    of("Q11", "zᵢ, oᵢ, S(zᵢ) and zᵢ × (oₙ − oᵢ)", "derive scara --part geometric --detail full", "z0", "Jh1"),
    of("Q11", "the Jacobian of the SCARA by twists, too", "derive scara --part Jh,geometric", "Jh"),
    of("Q11", "why our third column has −1", "derive scara --part geometric"),
    of("Q11", "what is printed wrongly", "derive scara --errata"),
    of("Q13", "link transforms and position of the planar arm", "derive planar_rrr --part T,geometric", "p"),
    of("Q13", "its Jacobian", "derive planar_rrr --part Jh,geometric", "Jh"),
    of("Q13", "what is printed wrongly", "derive planar_rrr --errata"),
    of("bonus", "the Jacobian of the Stanford-type arm", "derive stanford --part Jh,geometric", "Jh"),
    of("Q8, bonus", "what is printed wrongly", "derive stanford --errata"),
)
VELOCITY = (
    of("model", "the Denavit-Hartenberg table", "dh anthropomorphic"),
    of("model", "link transforms", "derive anthropomorphic --part geometric"),
    of("model", "the pose", "derive anthropomorphic --part T", "T", "p"),
    of("model", "the Jacobian, column by column", "derive anthropomorphic --part Jh,geometric", "Jh", "v(Jh)", "w(Jh)"),
    of("forward", "ξ = J θ̇", "derive anthropomorphic --part k", "Vh"),
    of("forward", "the same in numbers", "velocity anthropomorphic -q 0.3,0.2,0.1 --qd 0.3,0.1,0.3 --kind hybrid"),
    of("inverse", "where it fails: det J_v", "derive anthropomorphic --part n", "det(v(Jh))"),
    of("inverse", "the profile integrated, and the rates recovered", "track anthropomorphic"),
    of("update", "the printed pose update, and how far it drifts", "track anthropomorphic --scheme coursework"),
    of("all", "what is printed wrongly", "derive anthropomorphic --errata"),
)
LECTURE = (
    of("one joint", "Vˢ, Vᵇ and Jˢ, Jᵇ", "derive one_joint --part h,Vs,Js,Jb", "Vs", "Vb"),
    of("one joint", "Ad_g from R and p̂R, and Vˢ = Ad_g Vᵇ", "derive one_joint --part Ad --detail full", "Ad"),
    of("one joint", "velocity of the tool's origin: V̂ˢq, V̂ᵇq", "derive one_joint --point 0,0,0@tool"),
    of("two joints", "V̂ˢ = ġg⁻¹", "derive two_joint --part spatial-velocity", "Vshat", "Vs"),
    of("two joints", "(∂g/∂θᵢ)g⁻¹ = (Ad ξᵢ)^, with its proof", "derive two_joint --part general-column", "Js1", "Js2"),
    of("two joints", "Jˢ, Jᵇ and Ad_g", "derive two_joint --part Js,Jb,Ad", "Js", "Jb", "Ad"),
    of("two joints", "V_AC = V_AB + Ad V_BC in both forms", "derive two_joint --via A"),
    of(
        "two joints",
        "a point's velocity in symbols, and at (0, ·)",
        "derive two_joint --point 0,0,0@tool --at joint1=0",
    ),
    of("two joints", "the same at (π/2, ·)", "derive two_joint --point 0,0,0@tool --at joint1=pi/2"),
    of("two joints", "the same at (·, π/2)", "derive two_joint --point 0,0,0@tool --at joint2=pi/2"),
    of("two joints", "the same in numbers", "velocity two_joint -q pi/2,0 --qd 1,1 --point 0,0,0"),
    of(
        "circles",
        "the circles of the velocities, drawn",
        "show two_joint --qd 1,0.5 --draw screws,circles --html circles.html",
    ),
    of("all", "what is printed wrongly", "derive two_joint --errata"),
)
COURSEWORKS = {
    "Medical robotics, assignment 4": MEDICAL_4,
    "Medical robotics, assignment 3": MEDICAL_3,
    "Robotics, assignment 2": ROBOTICS_2,
    "Velocity kinematics": VELOCITY,
    "Velocities lecture": LECTURE,
}
ROWS = [row for rows in COURSEWORKS.values() for row in rows]

INTRODUCTION = """\
# I have this question: type this

Each question and part of the five courseworks, the one command that answers it, and how an answer is checked. Every
command is run by the tests; `derive` proves its answer against both engines and reads it back from its own text.
`pinscrew list` says which arm is from which coursework; lengths are arguments, `pinscrew derive scara l1:=0.5`.

Where the last column names quantities, `pinscrew check ROBOT FILE --quantity NAME` says which entries of an answer of
your own are wrong ([check](check.md)). Questions 3, 4, 6 and 12 of Robotics, assignment 2 are not listed: they are not
among what this repository records of it.

This page is written by `scripts/courseworks_page.py`.

| from | part | the question | type this | check your own, or its check |
| --- | --- | --- | --- | --- |
"""


def page() -> str:
    """The page, in Markdown."""
    lines = []
    for coursework, rows in COURSEWORKS.items():
        for row in rows:
            command = f"`pinscrew {row.command}`" if row.command else "no one command yet"
            check = ", ".join(f"`{name}`" for name in row.quantities) or (row.check if row.command else "none")
            lines.append(f"| {coursework} | {row.part} | {row.question} | {command} | {check} |\n")
    return INTRODUCTION + "".join(lines)


if __name__ == "__main__":
    sys.exit(write_or_check(PAGE, page()))
