"""What is public says what it is, and the example of the package does what it shows."""

from __future__ import annotations

import ast
import doctest
import importlib
import inspect
from collections.abc import Iterator
from typing import Any

import pytest

import pinscrew as ps
from layering import MODULES

SCRIPTS = {"__main__", "description._mjcf_worker", "description._xacro_worker"}
"""Modules that run, and are not for import."""


def documented(name: str, value: Any) -> Iterator[tuple[str, str]]:
    """The docstrings of a function or class, and of the methods and properties that the class defines."""
    if inspect.isclass(value):
        text = value.__doc__ or ""
        yield name, "" if text.startswith(f"{value.__name__}(") else text  # what a dataclass writes for want of one
        for each, member in vars(value).items():
            function = getattr(member, "__func__", member)  # of a class or static method
            if not each.startswith("_") and (inspect.isfunction(function) or isinstance(function, property)):
                inherited = (getattr(getattr(base, each, None), "__doc__", None) for base in value.__mro__)
                yield f"{name}.{each}", next(filter(None, inherited), "")
    elif inspect.isroutine(value) and value.__name__ == name:  # not a decorator that another function made
        yield name, value.__doc__ or ""


def undocumented(names: dict[str, Any]) -> list[str]:
    return [place for name, value in names.items() for place, text in documented(name, value) if not text.strip()]


@pytest.mark.parametrize("module", MODULES)
def test_modules_say_what_they_are(module: str) -> None:
    text = ast.get_docstring(ast.parse(MODULES[module])) or ""
    assert text.partition("\n\n")[0].rstrip().endswith((".", "?", ":"))


@pytest.mark.parametrize("module", sorted(set(MODULES) - SCRIPTS))
def test_public_names_say_what_they_are(module: str) -> None:
    """Each name in ``__all__`` exists, and each function, class, method and property among them has a docstring."""
    loaded = importlib.import_module(f"pinscrew.{module}".rstrip("."))
    names = {name: getattr(loaded, name) for name in getattr(loaded, "__all__", ())}
    assert undocumented(names) == []
    private = module.rpartition(".")[2].startswith("_")
    defines = any(isinstance(node, (ast.FunctionDef, ast.ClassDef)) for node in ast.parse(MODULES[module]).body)
    assert names or private or not defines, "a module says in __all__ what it offers"


def test_what_says_nothing_is_found() -> None:
    class Mute:
        def method(self) -> None: ...

        @property
        def value(self) -> None: ...

        @classmethod
        def make(cls) -> None: ...

        def _private(self) -> None: ...

    class Told(Mute):
        """Says something."""

        def method(self) -> None:
            """And so does its method."""

    class Heir(Told):
        """Inherits what is said."""

        def method(self) -> None: ...

    def mute() -> None: ...

    names = {"Mute": Mute, "Told": Told, "Heir": Heir, "mute": mute, "x": 1}
    assert undocumented(names) == ["Mute", "Mute.method", "Mute.value", "Mute.make", "mute"]


def test_package() -> None:
    """The package offers what it names, and nothing else is a wrong attribute."""
    assert dir(ps) == sorted(ps.__all__)
    assert all(getattr(ps, name) is not None for name in ps.__all__)
    with pytest.raises(AttributeError, match="module 'pinscrew' has no attribute 'Nothing'"):
        _ = ps.Nothing


def test_example_of_the_package() -> None:
    results = doctest.testmod(ps, raise_on_error=True)
    assert results.attempted == 3
