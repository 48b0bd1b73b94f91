"""What modules may import, by floors: read off their sources, for `test_layers`."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

SOURCE = Path(__file__).resolve().parents[1] / "src"

FLOORS = (
    {"ground"},
    {"errors", "lie", "description", "mathtext"},
    {"robot", "reporting"},
    {"engines", "engines.compiled"},
    {"witnesses"},
    {"verification", "derivation"},
    {"changes", "checking", "dh"},
    {"identification", "lockfile", "motion"},
    {"workspace"},
    {"view"},
    {""},  # the package itself, which names what it offers and loads it when it is used
    {"cli", "pytest_plugin"},
    {"__main__"},
)
"""The modules and packages below ``pinscrew``, from the ground up. Each imports only from itself and from below it."""

OUTSIDE = {
    "numpy": "",
    "yourdfpy": "description",
    "xacro": "description._xacro_worker",
    "pinocchio": "engines.pinocchio engines.pinocchio_model",
    "mujoco": "witnesses.mujoco description._mjcf_worker",
    "roboticstoolbox": "witnesses.roboticstoolbox",
    "llvmlite": "engines.compiled",
    "sympy": "derivation checking lie._symbolic",
    "latex2mathml": "derivation",
    "yaml": "motion",
    "scipy": "workspace",
    "distributed": "workspace",
    "tornado": "view",
    "trimesh": "view",
    "meshcat": "view",
    "matplotlib": "view",
    "click": "cli",
    "rich": "cli",
    "pytest": "pytest_plugin",
    "tomli": "changes",
}
"""Where an outside package may be imported: those modules, or in that package."""

How = Literal["at once", "later", "by name", "for types"]


@dataclass(frozen=True)
class Import:
    """An import: of what, and how.

    ``"at once"`` is done when the module is loaded, ``"later"`` in a function, ``"by name"`` by `import_module` of a
    name that stands in the source as a text (in a table, say), ``"for types"`` never while the program runs.
    """

    target: str
    line: int
    how: How


def modules() -> dict[str, str]:
    """The source of each module below pinscrew, by its name there; packages by theirs, pinscrew's by ``""``."""
    found = {}
    for path in sorted((SOURCE / "pinscrew").rglob("*.py")):
        parts = path.relative_to(SOURCE / "pinscrew").with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path.read_text(encoding="utf-8")
    return found


MODULES = modules()


def imports(source: str, known: Mapping[str, str] = MODULES) -> Iterator[Import]:
    """All imports of a source, those of names in a package as of the package's module where there is one."""

    def visit(node: ast.AST, how: How) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            yield from (Import(alias.name, node.lineno, how) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = "." * node.level + (node.module or "")
            for alias in node.names:
                module = f"{package}.{alias.name}"
                yield Import(module if inside(module) in known else package, node.lineno, how)
        elif isinstance(node, ast.Constant) and inside(node.value) and inside(node.value) in known:
            yield Import(str(node.value), node.lineno, "by name")  # the name of a module, in whatever table it stands
        elif (name := loaded_by_name(node)) is not None and inside(name) not in known:
            yield Import(name, node.lineno, "by name")
        inner = how
        if how == "at once" and isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)):
            inner = "later"
        elif for_types(node):
            inner = "for types"
        for child in ast.iter_child_nodes(node):
            yield from visit(child, inner)

    yield from visit(ast.parse(source), "at once")


def loaded_by_name(node: ast.AST) -> str | None:
    """What `import_module` or ``__import__`` is given, where that is a text."""
    if not isinstance(node, ast.Call) or not node.args:
        return None
    called = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
    given = node.args[0].value if isinstance(node.args[0], ast.Constant) else None
    return given if called in ("import_module", "__import__") and isinstance(given, str) else None


def for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def inside(target: object) -> str | None:
    """The name below pinscrew, or None for what is outside."""
    if target == "pinscrew":
        return ""
    return target.removeprefix("pinscrew.") if isinstance(target, str) and target.startswith("pinscrew.") else None


def unit(module: str) -> str:
    """The room that a module is in: the longest of its packages that has a floor of its own."""
    named = {name for floor in FLOORS for name in floor}
    parts = module.split(".")
    return next((p for n in range(len(parts), 0, -1) if (p := ".".join(parts[:n])) in named), parts[0])


def floor(module: str) -> int | None:
    return next((number for number, rooms in enumerate(FLOORS) if unit(module) in rooms), None)


def violations(module: str, source: str) -> list[str]:
    """What a module imports and must not."""
    found = []
    for each in imports(source):
        place = f"{module}:{each.line} imports {each.target}" + (" for types" if each.how == "for types" else "")
        name = inside(each.target)
        if each.target.startswith("."):
            found.append(f"{place}: write the whole name")
        elif name is None:
            package = each.target.split(".")[0]
            home = OUTSIDE.get(package)
            if package not in sys.stdlib_module_names and (home is None or not within(module, home)):
                found.append(f"{place}: that is for {home or 'nobody'}")
        elif module == "" and each.how == "at once" and unit(name) != "ground":
            found.append(f"{place}: the package loads nothing at once")
        elif floor(name) is None or name not in MODULES:
            found.append(f"{place}: there is no such module, or it has no floor")
        elif unit(name) != unit(module) and not below(name, module):
            found.append(f"{place}: floor {floor(module)} from floor {floor(name)}")
    return found


def below(name: str, module: str) -> bool:
    """Whether a module stands below another; a package's inner package may stand beside the package."""
    lower, upper = floor(name), floor(module)
    return lower < upper or (lower == upper and unit(name).split(".")[0] == unit(module).split(".")[0])


def within(module: str, home: str) -> bool:
    return not home or any(module == each or module.startswith(f"{each}.") for each in home.split())


def reachable(module: str) -> set[str]:
    """All that importing a module imports, at once or later, with outside packages by their own names."""
    found: set[str] = set()
    pending = [module]
    while pending:
        for each in imports(MODULES[pending.pop()]):
            name = inside(each.target)
            target = each.target.split(".")[0] if name is None else f"pinscrew.{name}"
            if target not in found:
                found.add(target)
                if name is not None and name in MODULES:
                    pending.append(name)
    return found


EVERY_WAY: tuple[How, ...] = ("at once", "later", "by name", "for types")
Graph = dict[str, set[str]]


def graph(sources: Mapping[str, str], ways: Iterable[How] = EVERY_WAY) -> Graph:
    """For each module, those of pinscrew that it imports in any of some ways."""
    drawn = {}
    for module, source in sources.items():
        names = {inside(each.target) for each in imports(source, sources) if each.how in ways}
        drawn[module] = {name for name in names if name in sources and name != module}
    return drawn


def circles(arrows: Graph) -> list[set[str]]:
    """The sets of modules that import each other in a loop: strongly connected components of more than one (Tarjan)."""
    order: dict[str, int] = {}
    lowest: dict[str, int] = {}
    waiting: list[str] = []
    found: list[set[str]] = []

    def visit(module: str) -> None:
        order[module] = lowest[module] = len(order)
        waiting.append(module)
        for target in sorted(arrows.get(module, ())):
            if target not in order:
                visit(target)
                lowest[module] = min(lowest[module], lowest[target])
            elif target in waiting:
                lowest[module] = min(lowest[module], order[target])
        if lowest[module] == order[module]:
            circle = set(waiting[waiting.index(module) :])
            del waiting[waiting.index(module) :]
            if len(circle) > 1:
                found.append(circle)

    for module in sorted(arrows):
        if module not in order:
            visit(module)
    return found


OURS = {"screws", "home", "homes", "twists", "T_base_child", "T_parent_joint", "axis", "motions_above", "reach"}
"""Attributes in which our own kinematics are."""


def kinematics_used(source: str) -> set[str]:
    """Those of `OURS` that a source reads, but for their shapes, which only say how many velocities a joint has."""
    tree = ast.parse(source)
    shapes = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Attribute) and node.attr == "shape"}
    read = (node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and id(node) not in shapes)
    return {node.attr for node in read} & OURS


def unwanted(source: str) -> list[str]:
    """Prints, asserts and excepts without an exception: a library talks and fails through its errors."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "print":
            found.append(f"{node.lineno}: print")
        elif isinstance(node, ast.Assert):
            found.append(f"{node.lineno}: assert")
        elif isinstance(node, ast.ExceptHandler) and node.type is None:
            found.append(f"{node.lineno}: except")
    return found
