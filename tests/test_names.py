"""One thing has one name, and one name means one thing."""

from __future__ import annotations

import ast
from collections import defaultdict
from typing import Final

import pytest

from layering import MODULES, imports, inside, unit

ALLOWED: Final = {
    "Element": "of a file, and of the algebra of sines and cosines; never in one sentence",
    "Place": "the same alias, written again for the child process that loads nothing of ours",
}


def types(source: str) -> set[str]:
    """Names of the classes and type aliases that a module shows to others."""
    names = set()
    for node in ast.parse(source).body:
        if isinstance(node, ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names |= {node.target.id} if "TypeAlias" in ast.unparse(node.annotation) else set()
    return {name for name in names if not name.startswith("_")}


def test_no_type_has_another_ones_name() -> None:
    homes: dict[str, list[str]] = defaultdict(list)
    for module, source in MODULES.items():
        for name in types(source):
            homes[name].append(module)
    twice = {name: modules for name, modules in homes.items() if len(modules) > 1 and name not in ALLOWED}
    assert twice == {}
    assert [name for name in ALLOWED if len(homes[name]) < 2] == [], "no longer needed"


@pytest.mark.parametrize("module", MODULES)
def test_private_modules_stay_in_their_room(module: str) -> None:
    private = []
    for each in imports(MODULES[module]):
        name = inside(each.target)
        if name and any(part.startswith("_") and part != "__main__" for part in name.split(".")):
            private += [name] if unit(name) != unit(module) else []
    assert private == []
