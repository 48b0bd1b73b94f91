"""What modules may import, by layers: read off their sources, for `test_layers`."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "src"

LAYERS = {
    "errors": 0,
    "words": 0,
    "memory": 0,
    "counts": 0,
    "processes": 0,
    "error_codes": 0,
    "expressions": 0,
    "files": 0,
    "typing": 0,
    "lie": 0,
    "screw": 0,
    "description": 1,
    "mechanism": 2,
    "robot": 2,
    "loading": 2,
    "manifold": 2,
    "engines": 3,
    "verification": 4,
    "changes": 4,
    "derivation": 4,
    "findings": 4,
    "lockfile": 4,
    "motion": 4,
    "workspace": 4,
    "view": 5,
    "cli": 6,
    "pytest_plugin": 6,
    "__main__": 6,
    "": 6,  # the package itself, which names what it offers and loads it when it is used
}
"""The layer of each module or package directly below ``pinscrew``."""

WITHIN_LAYER: dict[str, set[str]] = {
    "errors": {"words"},
    "expressions": {"errors"},
    "counts": {"errors"},
    "processes": {"counts"},
    "files": {"errors"},
    "typing": {"errors"},
    "lie": {"errors", "typing"},
    "screw": {"errors", "typing", "lie"},
    "robot": {"mechanism"},
    "loading": {"robot"},
    "manifold": {"mechanism", "robot"},
    "lockfile": {"changes", "findings"},
    "changes": {"findings", "verification"},
    "verification": {"findings"},
    "workspace": {"lockfile"},
    "cli": {""},
    "__main__": {"cli"},
}
"""What of its own layer, beside itself, a module may import."""

OUTSIDE = {
    "numpy": "",
    "yourdfpy": "description",
    "xacro": "description._xacro_worker",
    "pinocchio": "engines.pinocchio",
    "mujoco": "engines.mujoco",
    "roboticstoolbox": "engines.roboticstoolbox",
    "llvmlite": "engines.compiled",
    "sympy": "derivation",
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
    "tomllib": "pytest_plugin",
    "tomli": "pytest_plugin",
}
"""Where an outside package may be imported: that module, or in that package."""


@dataclass(frozen=True)
class Import:
    """An import: of what, and whether it is done as soon as the module is loaded."""

    target: str
    line: int
    at_once: bool


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

    def visit(node: ast.AST, at_once: bool) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            yield from (Import(alias.name, node.lineno, at_once) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            package = "." * node.level + (node.module or "")
            for alias in node.names:
                module = f"{package}.{alias.name}"
                yield Import(module if inside(module) in known else package, node.lineno, at_once)
        for child in ast.iter_child_nodes(node):
            later = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) or for_types(node)
            yield from visit(child, at_once and not later)

    yield from visit(ast.parse(source), True)


def for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def inside(target: str) -> str | None:
    """The name below pinscrew, or None for what is outside."""
    if target == "pinscrew":
        return ""
    return target.removeprefix("pinscrew.") if target.startswith("pinscrew.") else None


def unit(module: str) -> str:
    """The module or package directly below pinscrew that a module is in."""
    return module.split(".", maxsplit=1)[0]


def violations(module: str, source: str) -> list[str]:
    """What a module imports and must not."""
    found = []
    for one in imports(source):
        place = f"{module}:{one.line} imports {one.target}"
        name = inside(one.target)
        if one.target.startswith("."):
            found.append(f"{place}: write the whole name")
        elif name is None:
            package = one.target.split(".")[0]
            home = OUTSIDE.get(package)
            if package not in sys.stdlib_module_names and (home is None or not within(module, home)):
                found.append(f"{place}: that is for {home or 'nobody'}")
        elif module == "":
            if one.at_once:
                found.append(f"{place}: the package loads nothing at once")
        elif unit(name) not in LAYERS:
            found.append(f"{place}: there is no such module, or it has no layer")
        elif LAYERS[unit(name)] >= LAYERS[unit(module)] and unit(name) not in beside(unit(module)):
            found.append(f"{place}: layer {LAYERS[unit(module)]} from layer {LAYERS[unit(name)]}")
    return found


def beside(name: str) -> set[str]:
    """What of its own layer something directly below pinscrew may import."""
    return {name} | WITHIN_LAYER.get(name, set())


def within(module: str, home: str) -> bool:
    return home in ("", module) or module.startswith(f"{home}.")


def reachable(module: str) -> set[str]:
    """All that importing a module imports, at once or later, with outside packages by their own names."""
    found: set[str] = set()
    pending = [module]
    while pending:
        for one in imports(MODULES[pending.pop()]):
            name = inside(one.target)
            target = one.target.split(".")[0] if name is None else f"pinscrew.{name}"
            if target not in found:
                found.add(target)
                if name is not None and name in MODULES:
                    pending.append(name)
    return found


def loaded_at_once(sources: Mapping[str, str]) -> dict[str, set[str]]:
    """For each module, those of pinscrew that are loaded while it is."""
    names = {m: {inside(one.target) for one in imports(s, sources) if one.at_once} for m, s in sources.items()}
    return {module: {name for name in found if name in sources} for module, found in names.items()}


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
