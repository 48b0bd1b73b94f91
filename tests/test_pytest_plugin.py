"""The pytest plugin, in the repositories of others: what it collects, says, and leaves alone."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

import pinscrew as ps
import urdfs
from pinscrew import lockfile
from pinscrew.ground.errors import EngineError
from pinscrew.pytest_plugin import subject
from pinscrew.verification import run as verification

ARM = urdfs.robot(
    "\n" + urdfs.joint("shoulder", "revolute", "base", "upper", xyz="0 0 0.3"),
    "\n" + urdfs.joint("elbow", "revolute", "upper", "tool", xyz="0.4 0 0", axis="0 1 0"),
    links="base upper tool",
)
ELBOW_LINE = 3
XACRO = ARM.replace('name="small"', 'name="small" xmlns:xacro="http://www.ros.org/wiki/xacro"', 1).replace(
    '<link name="base"/>', '<xacro:arg name="l1" default="0.4"/><link name="base"/>', 1
)
XACRO = XACRO.replace('"0.4 0 0"', '"$(arg l1) 0 0"')
CHECKS = verification.check_names(100)
OPTIONS = ("--pinscrew", "--pinscrew-samples=2", "-p", "no:cacheprovider", "-p", "no:xdist", "-rfsE", "-W", "default")
LIGHT = ("-p", "no:hypothesispytest")
"""For processes of their own: that plugin takes a second to load."""


@pytest.fixture(scope="module", autouse=True)
def parsers() -> None:
    """Both engines' parsers loaded; `pytester` unloads what a run within this process loads first, and they mind."""
    verification.verify(urdfs.load(ARM), 0)


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    """Summaries are not cut off."""
    monkeypatch.setenv("COLUMNS", "400")


@pytest.fixture
def project(pytester: pytest.Pytester) -> pytest.Pytester:
    """A repository with an arm in ``robots/``."""
    write(pytester, "robots/arm.urdf", ARM)
    return pytester


def write(pytester: pytest.Pytester, name: str, text: str) -> Path:
    path = pytester.path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def run(pytester: pytest.Pytester, *options: str) -> pytest.RunResult:
    return pytester.runpytest_inprocess(*OPTIONS, *options)


def collected(pytester: pytest.Pytester, *options: str) -> list[str]:
    done = run(pytester, "--collect-only", "-q", *options)
    return [line for line in done.outlines if "::" in line]


def cases(junit: Path) -> list[ET.Element]:
    return list(ET.fromstring(junit.read_text(encoding="utf-8")).iter("testcase"))  # noqa: S314 (our own file)


def configure(pytester: pytest.Pytester, text: str) -> None:
    write(pytester, "pyproject.toml", text)


def disagree(monkeypatch: pytest.MonkeyPatch, old: str, new: str) -> None:
    """Let Pinocchio be given another robot than the PoE engine."""
    assert ARM.count(old) == 1
    other = urdfs.load(ARM.replace(old, new))
    monkeypatch.setattr(verification, "readers_of", lambda robot: (ps.PoE(robot), ps.Pinocchio(other)))


MOVED = ("0.4 0 0", "0.401 0 0")

# ------------------------------------------------------------------------------------------------ collection


def test_checks_are_those_of_a_report() -> None:
    assert tuple(check.name for check in verification.verify(urdfs.load(ARM), 0).checks) == CHECKS


def test_a_good_robot_passes(project: pytest.Pytester) -> None:
    assert collected(project) == [f"robots/arm.urdf::{name}" for name in ("load", *CHECKS)]
    done = run(project)
    done.assert_outcomes(passed=1 + len(CHECKS))
    done.stdout.fnmatch_lines(["pinscrew: robot files: 1, samples: 2, seed: 0"])
    assert done.ret == 0


def test_nothing_without_the_option(project: pytest.Pytester) -> None:
    """Not even numpy is loaded; the entry point works, in a process of its own."""
    configure(project, "[tool.pinscrew]\nnonsense = 1\n")
    project.makepyfile(
        """
        import sys

        def test_modules():
            ours = {name for name in sys.modules if name.partition(".")[0] == "pinscrew"}
            heavier = {name for name in ours if not name.startswith("pinscrew.ground")}
            assert heavier == {"pinscrew", "pinscrew.pytest_plugin"}
            assert not {"numpy", "pinocchio", "yourdfpy", "xacro", "click"} & set(sys.modules)
        """
    )
    done = project.runpytest_subprocess(*LIGHT)
    done.assert_outcomes(passed=1)
    done.stdout.no_fnmatch_line("*arm.urdf*")
    assert "pinscrew:" not in done.stdout.str()


@pytest.mark.parametrize(
    ("options", "count"),
    [
        (("-k", "forward"), 1),
        (("-k", "arm and Jacobian and not derivative"), 3),
        (("-m", "pinscrew"), 1 + len(CHECKS)),
        (("-m", "not pinscrew"), 0),
        (("robots/arm.urdf::forward kinematics",), 1),
        (("robots/arm.urdf::J_s = Ad(T) J_b in PoE", "robots/arm.urdf::load"), 2),
    ],
)
def test_selection(project: pytest.Pytester, options: tuple[str, ...], count: int) -> None:
    assert len(collected(project, "--strict-markers", *options)) == count


def test_collecting_reads_no_robot(project: pytest.Pytester) -> None:
    write(project, "robots/broken.urdf", "<robot")
    assert len(collected(project)) == 2 * (1 + len(CHECKS))


def test_what_is_collected(project: pytest.Pytester) -> None:
    """Not the macros that other files include, nor what is excluded; but what is listed."""
    for name in ("robots/macro.xacro", "vendor/a/other.urdf", "robots/whole.urdf.xacro", "robots/listed.xacro"):
        write(project, name, XACRO)
    write(project, "vendor/kept.urdf", ARM)
    configure(
        project,
        """
        [tool.pinscrew]
        exclude = ["vendor/**"]
        robots = [{ file = "robots/listed.xacro" }, { file = "vendor/kept.urdf" }]
        """,
    )
    loads = [one.partition("::")[0] for one in collected(project) if one.endswith("::load")]
    assert sorted(loads) == ["robots/arm.urdf", "robots/listed.xacro", "robots/whole.urdf.xacro", "vendor/kept.urdf"]


def test_no_robots_is_said(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("def test(): pass")
    run(pytester).stdout.fnmatch_lines(
        ["pinscrew: no robot files; name their folder, such as: pytest --pinscrew robots"]
    )


# -------------------------------------------------------------------------------------------------- failures


def test_disagreement(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """The joint, the frame, the configuration, the command to see it again; and no traceback."""
    disagree(monkeypatch, *MOVED)
    done = run(project, "-k", "forward or structure or load")
    done.assert_outcomes(passed=2, failed=1)
    done.stdout.fnmatch_lines(
        [
            "*_ arm.urdf: forward kinematics _*",
            "joint 'elbow': its origin is moved by [[]1, 0, 0] mm (1 mm) in Pinocchio, compared with PoE",
            "forward kinematics: error 1.*e-03 above 1.0e-12, largest at frame tool, joint elbow, *",
            "q = [[]*, *]",
            "again: pinscrew verify robots/arm.urdf --samples 2 --seed 0",
            "FAILED robots/arm.urdf::forward kinematics - joint 'elbow': *",
        ],
        consecutive=False,
    )
    assert "items.py" not in done.stdout.str()


def test_disagreement_in_a_line(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    disagree(monkeypatch, *MOVED)
    done = run(project, "-k", "forward", "--tb=line", "-o", "junit_family=xunit1", "--junitxml=junit.xml")
    done.stdout.fnmatch_lines([f"*robots?arm.urdf:{ELBOW_LINE}: joint 'elbow': its origin is moved by *"])
    (case,) = cases(project.path / "junit.xml")
    assert (case.get("file"), case.get("line")) == ("robots/arm.urdf", str(ELBOW_LINE - 1))  # pytest counts from 0


def test_junit(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    disagree(monkeypatch, *MOVED)
    run(project, "--junitxml=junit.xml")
    found = {case.get("name"): case for case in cases(project.path / "junit.xml")}
    assert set(found) == {"load", *CHECKS}
    assert {case.get("classname") for case in found.values()} == {"robots.arm.urdf"}
    properties = {p.get("name"): p.get("value") for p in found["forward kinematics"].iter("property")}
    assert properties["tolerance"] == "1.000e-12"
    assert 5e-4 < float(str(properties["error"])) < 2e-3
    (failure,) = found["forward kinematics"].iter("failure")
    assert str(failure.get("message")).startswith("joint 'elbow': its origin is moved by [1, 0, 0] mm")
    assert "\nq = [" in str(failure.text)
    assert not list(found["structure"].iter("failure"))


def test_other_coordinates(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing but the structure can be compared; that is said by the structure, or by what is asked without it."""
    disagree(monkeypatch, 'joint name="elbow"', 'joint name="knee"')
    for options, first, passed, skipped in (
        ((), "structure", 1, len(CHECKS) - 1),
        (("-k", "home"), "home poses", 0, 0),
    ):
        done = run(project, *options)
        done.assert_outcomes(passed=passed, failed=1, skipped=skipped)
        done.stdout.fnmatch_lines([f"FAILED robots/arm.urdf::{first} - joint 'elbow' is seen by PoE only"])


def test_a_broken_file(project: pytest.Pytester) -> None:
    """One line, once."""
    write(project, "robots/broken.urdf", ARM.replace('link name="tool"', 'link name="tol"'))
    done = run(project, "robots/broken.urdf")
    done.assert_outcomes(failed=1, skipped=len(CHECKS))
    (summary,) = [line for line in done.outlines if line.startswith("FAILED")]
    assert summary.startswith("FAILED robots/broken.urdf::load - robots/broken.urdf:3: joint 'elbow'")
    done.stdout.fnmatch_lines([f"SKIPPED [[]{len(CHECKS)}] *: broken.urdf can't be tested: see 'load'"])
    start = done.outlines.index(next(line for line in done.outlines if "_ broken.urdf: load _" in line))
    assert done.outlines[start + 1].startswith("robots/broken.urdf:3: joint 'elbow'")
    assert done.outlines[start + 2].startswith("=")
    run(project, "robots/broken.urdf", "-k", "Jacobian").assert_outcomes(failed=1, skipped=5)


def test_a_file_that_an_engine_refuses(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(robot: ps.Robot) -> Any:
        raise EngineError("pinocchio-refuses", "Pinocchio refuses the file", where=robot.description.file)

    monkeypatch.setattr(verification, "readers_of", refuse)
    done = run(project)
    done.assert_outcomes(passed=1, failed=1, skipped=len(CHECKS) - 1)
    done.stdout.fnmatch_lines(["FAILED robots/arm.urdf::structure - robots/arm.urdf: Pinocchio refuses the file"])


def test_a_mistake_of_ours_has_a_traceback(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: ps.Robot) -> Any:
        raise RuntimeError("a mistake")

    monkeypatch.setattr(verification, "readers_of", fail)
    run(project, "-k", "forward").stdout.fnmatch_lines(["*verify*", "E * RuntimeError: a mistake"])


def test_remarks_are_warnings(project: pytest.Pytester) -> None:
    write(project, "robots/long.urdf", ARM.replace("0 1 0", "0 2 0"))
    done = run(project, "robots/long.urdf")
    done.assert_outcomes(passed=1 + len(CHECKS), warnings=1)
    done.stdout.fnmatch_lines(["*PinscrewWarning: *long.urdf:3: joint 'elbow': *"])
    done = run(project, "robots/long.urdf", "-W", "error::pinscrew.PinscrewWarning")
    done.assert_outcomes(failed=1, skipped=len(CHECKS))
    done.stdout.fnmatch_lines(["FAILED robots/long.urdf::load - robots/long.urdf:3: joint 'elbow': *"])


# --------------------------------------------------------------------------------------------- configuration

TWO = """
[tool.pinscrew]
samples = 1
[[tool.pinscrew.robots]]
file = "robots/arm.urdf.xacro"
arguments = { l1 = 0.5 }
[[tool.pinscrew.robots]]
file = "robots/arm.urdf.xacro"
arguments = { l1 = 0.6 }
name = "long"
frames = ["tool"]
"""


def test_arguments_make_robots(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    write(pytester, "robots/arm.urdf.xacro", XACRO)
    configure(pytester, TWO)
    names = [f"robots/arm.urdf.xacro::{name}{id_}" for id_ in ("[l1=0.5]", "[long]") for name in ("load", *CHECKS)]
    assert collected(pytester) == names
    assert collected(pytester, "robots/arm.urdf.xacro::screw axes") == [n for n in names if "screw axes" in n]
    assert collected(pytester, "robots/arm.urdf.xacro::screw axes[long]") == [names[-len(CHECKS) + 2]]
    asked = []

    def remember(robot: ps.Robot, samples: int, *_: Any, **options: Any) -> Any:
        asked.append((robot.home("tool")[0, 3], samples, options["frames"]))
        return verify(robot, samples, **options)

    verify = verification.verify
    monkeypatch.setattr(subject, "verify", remember)
    pytester.runpytest_inprocess("--pinscrew", *OPTIONS[2:]).assert_outcomes(passed=len(names))
    assert asked == [(0.5, 1, None), (0.6, 1, ("tool",))]


def test_the_command_to_see_it_again(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    write(pytester, "robots/arm.urdf.xacro", XACRO)
    configure(pytester, TWO + 'packages = { arm_description = "robots" }\n')
    disagree(monkeypatch, *MOVED)
    done = run(pytester, "--pinscrew-seed=3", "robots/arm.urdf.xacro::forward kinematics[long]")
    command = "pinscrew verify robots/arm.urdf.xacro l1:=0.6 --package arm_description:=robots --frame tool"
    done.stdout.fnmatch_lines([f"again: {command} --samples 2 --seed 3"])


def test_packages_and_booleans(pytester: pytest.Pytester) -> None:
    text = XACRO.replace("<xacro:arg", '<xacro:arg name="sane" default="false"/><xacro:arg', 1)
    text = text.replace("</robot>", '<xacro:unless value="$(arg sane)"><nonsense</xacro:unless></robot>')
    write(pytester, "robots/arm.urdf.xacro", text.replace("<nonsense", '<joint name="dangling" type="fixed"/>'))
    include = '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    include += '<xacro:include filename="$(find my_arm)/arm.urdf.xacro"/></robot>'
    write(pytester, "other/whole.urdf.xacro", include)
    configure(
        pytester,
        """
        [[tool.pinscrew.robots]]
        file = "other/whole.urdf.xacro"
        packages = { my_arm = "robots" }
        arguments = { sane = true }
        """,
    )
    run(pytester, "other", "-k", "load or forward").assert_outcomes(passed=2)
    configure(pytester, "")
    done = run(pytester, "other", "-k", "load")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["FAILED other/whole.urdf.xacro::load - *my_arm*"])


def test_what_only_loading_can_find(pytester: pytest.Pytester) -> None:
    """Arguments and frames that do not exist."""
    write(pytester, "robots/arm.urdf.xacro", XACRO)
    configure(pytester, TWO.replace("l1 = 0.5", "l2 = 0.5").replace('["tool"]', '["tol"]'))
    done = run(pytester)
    done.assert_outcomes(passed=1, failed=2, skipped=2 * len(CHECKS) - 1)
    done.stdout.fnmatch_lines(
        [
            "FAILED robots/arm.urdf.xacro::load[[]l2=0.5] - *l2*l1*",
            "FAILED robots/arm.urdf.xacro::structure[[]long] - *there is no frame 'tol'*",
        ]
    )


def test_options_come_before_the_file(project: pytest.Pytester) -> None:
    configure(project, "[tool.pinscrew]\nsamples = 7\nseed = 5\ntolerance = 1e-30\n")
    assert project.runpytest_inprocess("--pinscrew", *OPTIONS[2:], "-k", "forward").parseoutcomes()["failed"] == 1
    done = run(project, "--pinscrew-tolerance=1e-9", "-k", "forward")
    done.assert_outcomes(passed=1)
    done.stdout.fnmatch_lines(["pinscrew: robot files: 1, samples: 2, seed: 5"])


KNOWN = "known are: samples, seed, tolerance, exclude, fail_on, robots"
KNOWN_ROBOT = "known are: file, name, arguments, packages, frames"
WRONG = {
    "unknown key": ("[tool.pinscrew]\nsample = 3", f"tool.pinscrew has a key 'sample', which does not exist; {KNOWN}"),
    "no table": ("[tool]\npinscrew = 3", "tool.pinscrew is 3; it must be a table"),
    "tool is no table": ("tool = 3", "pyproject.toml*"),
    "not TOML": ("[tool.pinscrew", "*pyproject.toml*"),
    "a text": ('[tool.pinscrew]\nsamples = "3"', "tool.pinscrew.samples is '3'; it must be an integer, 0 or more*"),
    "a boolean": ("[tool.pinscrew]\nsamples = true", "tool.pinscrew.samples is True; it must be an integer*"),
    "negative": ("[tool.pinscrew]\nseed = -1", "tool.pinscrew.seed is -1; it must be an integer, 0 or more*"),
    "zero": ("[tool.pinscrew]\ntolerance = 0", "tool.pinscrew.tolerance is 0; it must be a positive number*"),
    "NaN": ("[tool.pinscrew]\ntolerance = nan", "tool.pinscrew.tolerance is nan; it must be a positive number*"),
    "one text": ('[tool.pinscrew]\nexclude = "x"', "tool.pinscrew.exclude is 'x'; it must be a list of texts*"),
    "robots": ('[tool.pinscrew]\nrobots = ["x"]', "tool.pinscrew.robots is *; it must be a list of tables*"),
    "no file": ("[[tool.pinscrew.robots]]\nname = 'x'", f"tool.pinscrew.robots[[]0] has no key 'file'; {KNOWN_ROBOT}"),
    "unknown key of a robot": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\nargs = {}",
        f"tool.pinscrew.robots[[]0] has a key 'args', which does not exist; {KNOWN_ROBOT}",
    ),
    "a missing file": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/none.urdf'",
        "tool.pinscrew.robots[[]0].file: there is no file 'robots/none.urdf' in *",
    ),
    "a missing folder": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\npackages = { p = 'none' }",
        "tool.pinscrew.robots[[]0].packages.p: there is no folder 'none' in *",
    ),
    "a list as argument": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\narguments = { l1 = [1] }",
        "tool.pinscrew.robots[[]0].arguments is *; it must be a table of texts, numbers and booleans*",
    ),
    "no frames": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\nframes = []",
        "tool.pinscrew.robots[[]0].frames is *; it must be a list of one or more frames*",
    ),
    "twice": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\n" * 2,
        "two robots of 'arm.urdf' have neither arguments nor a name; give each a 'name' of its own",
    ),
    "twice by name": (
        "[[tool.pinscrew.robots]]\nfile = 'robots/arm.urdf'\nname = 'x'\n" * 2,
        "two robots of 'arm.urdf' are both called 'x'; give each a 'name' of its own",
    ),
}


@pytest.mark.parametrize(("text", "words"), WRONG.values(), ids=WRONG)
def test_wrong_configuration(project: pytest.Pytester, text: str, words: str) -> None:
    configure(project, text)
    write(project, "pytest.ini", "[pytest]\n")
    done = run(project, "-c", "pytest.ini")  # else pytest itself says what is no TOML
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    (line,) = [line for line in done.errlines if line.strip()]
    assert line.startswith("ERROR: pinscrew: pyproject.toml")
    done.stderr.fnmatch_lines([f"ERROR: *{words}"])


@pytest.mark.parametrize("option", ["--pinscrew-samples=-1", "--pinscrew-seed=-1", "--pinscrew-tolerance=-1e-9"])
def test_wrong_options(project: pytest.Pytester, option: str) -> None:
    done = run(project, option)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    name = option.partition("=")[0]
    done.stderr.fnmatch_lines([f"ERROR: pinscrew: {name} is -1*; it must be *"])


def test_xdist(project: pytest.Pytester) -> None:
    """Workers agree on the items, and say the same as one process does."""
    write(project, "robots/broken.urdf", "<robot")
    done = project.runpytest_subprocess(*LIGHT, "--pinscrew", "--pinscrew-samples=2", "-n2", "--dist=loadfile", "-rf")
    done.assert_outcomes(passed=1 + len(CHECKS), failed=1, skipped=len(CHECKS))
    done.stdout.fnmatch_lines(["FAILED robots/broken.urdf::load - robots/broken.urdf:1: not well-formed XML*"])


# ----------------------------------------------------------------------------------------- locks and fixtures


def test_lock(project: pytest.Pytester) -> None:
    """An item where there is a lock; it fails when the mechanism moves, at the joint that did."""
    file = project.path / "robots" / "arm.urdf"
    write(project, "robots/arm.urdf.lock", lockfile.text(ps.load(file)))
    assert collected(project)[-1] == "robots/arm.urdf::lock"
    run(project, "-k", "lock").assert_outcomes(passed=1)
    file.write_text(ARM.replace(*MOVED), encoding="utf-8")
    done = run(project)
    done.assert_outcomes(passed=1 + len(CHECKS), failed=1)
    done.stdout.fnmatch_lines(
        [
            "*elbow*1 mm*",
            "if that is meant: pinscrew lock robots/arm.urdf.lock",
            "FAILED robots/arm.urdf::lock - joint 'elbow': *",
        ]
    )
    done = run(project, "-k", "lock", "--tb=line")
    done.stdout.fnmatch_lines([f"*robots?arm.urdf:{ELBOW_LINE}: *"])


def test_notes_fail_where_the_settings_or_the_lock_say_so(project: pytest.Pytester) -> None:
    """``fail_on`` of the settings counts where the lock is silent, and the lock's own where it is not."""
    file = project.path / "robots" / "arm.urdf"
    robot = ps.load(file)
    write(project, "robots/arm.urdf.lock", lockfile.text(robot))
    file.write_text(ARM.replace('"elbow"', '"ellbow"'), encoding="utf-8")
    run(project, "-k", "lock").assert_outcomes(passed=1)
    for names, fails in (('["velocity"]', False), ('["velocity", "names"]', True)):
        configure(project, f"[tool.pinscrew]\nfail_on = {names}\n")
        done = run(project, "-k", "lock")
        done.assert_outcomes(passed=not fails, failed=fails)
    done.stdout.fnmatch_lines(["*; fails on names*", "FAILED robots/arm.urdf::lock - joint 'ellbow': *"])
    write(project, "robots/arm.urdf.lock", lockfile.text(robot, fail_on=["velocity"]))
    run(project, "-k", "lock").assert_outcomes(passed=1)
    write(project, "robots/arm.urdf.lock", lockfile.text(robot, fail_on=["names"]))
    configure(project, "[tool.pinscrew]\n")
    run(project, "-k", "lock").assert_outcomes(failed=1)


def test_a_broken_lock(project: pytest.Pytester) -> None:
    write(project, "robots/arm.urdf.lock", "{")
    done = run(project, "-k", "lock")
    done.assert_outcomes(failed=1)
    done.stdout.fnmatch_lines(["FAILED robots/arm.urdf::lock - *arm.urdf.lock*"])
    assert "items.py" not in done.stdout.str()


def test_fixture_robot(project: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths are from the rootdir, robots are kept, names work, errors are pinscrew's."""
    write(project, "robots/arm.urdf.xacro", XACRO)
    write(project, "pytest.ini", "[pytest]\n")
    write(
        project,
        "tests/test_arm.py",
        """
import pathlib, pytest, pinscrew

def test_robot(pinscrew_robot):
    robot = pinscrew_robot("robots/arm.urdf.xacro", l1=0.7)
    assert robot.home("tool")[0, 3] == 0.7
    assert pinscrew_robot("robots/arm.urdf.xacro", l1=0.7) is robot
    assert pinscrew_robot(pathlib.Path("robots/arm.urdf.xacro"), arguments={"l1": 0.8}).home("tool")[0, 3] == 0.8
    assert pinscrew_robot("robots/arm.urdf", floating_base=True).base == "universe"
    assert pinscrew_robot("scara", l1=0.5).tip == "tool"

def test_errors(pinscrew_robot):
    with pytest.raises(pinscrew.PinscrewError, match="no such file"):
        pinscrew_robot("arm.urdf")
""",
    )
    monkeypatch.chdir(project.path / "robots")  # where there is an arm.urdf
    run(project, "../tests").assert_outcomes(passed=2)


def test_fixture_same(project: pytest.Pytester) -> None:
    write(project, "robots/arm.urdf.xacro", XACRO)
    project.makepyfile(
        """
        def test_same(assert_same_mechanism, pinscrew_robot):
            assert_same_mechanism("robots/arm.urdf", "robots/arm.urdf.xacro")
            assert_same_mechanism("robots/arm.urdf", pinscrew_robot("robots/arm.urdf.xacro", l1=0.4))

        def test_tolerance(assert_same_mechanism, pinscrew_robot):
            longer = pinscrew_robot("robots/arm.urdf.xacro", l1=0.401)
            assert_same_mechanism("robots/arm.urdf", longer, tolerance=2e-3)
            assert_same_mechanism("robots/arm.urdf", longer, length=2e-3)

        def test_longer(assert_same_mechanism, pinscrew_robot):
            assert_same_mechanism("robots/arm.urdf", pinscrew_robot("robots/arm.urdf.xacro", l1=0.401), angle=1.0)
        """
    )
    done = run(project, "-k", "test_")
    done.assert_outcomes(passed=2, failed=1)
    done.stdout.fnmatch_lines(["*_ test_longer _*", "*elbow*1 mm*"])
    assert "mechanisms.py" not in done.stdout.str()


def test_the_documented_configuration(pytester: pytest.Pytester) -> None:
    page = (Path(__file__).parents[1] / "docs" / "pytest.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    xacro = XACRO.replace("<xacro:arg", '<xacro:arg name="l2" default="0.1"/><xacro:arg', 1)
    write(pytester, "robots/arm.urdf.xacro", xacro)
    configure(pytester, text)
    run(pytester).assert_outcomes(passed=2 * (1 + len(CHECKS)))
    for test in re.findall(r"`(robots/\S+::screw axes\[\S+\])`", page):
        assert collected(pytester, test) == [test]
