"""A plugin for pytest: with ``--pinscrew`` each check of each robot is a test, and fixtures are for tests of one's own.

Every run of pytest loads this module, wherever pinscrew is installed. So it imports nothing but pytest, and without
the option it does nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import pytest

if TYPE_CHECKING:
    from pinscrew.robot.robot import Robot

__all__ = ["assert_same_mechanism", "pinscrew_robot", "pytest_addoption", "pytest_configure"]

_SAME: Final = 1e-9
"""Metres, and radians, within which two mechanisms are the same unless a test says otherwise."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options; those without a value leave it to the rootdir's pyproject.toml."""
    group = parser.getgroup("pinscrew", "kinematics of URDF files (pinscrew)")
    group.addoption("--pinscrew", action="store_true", help="Test *.urdf and *.urdf.xacro: do two engines agree?")
    group.addoption("--pinscrew-samples", type=int, metavar="N", help="Random configurations per robot (100).")
    group.addoption("--pinscrew-seed", type=int, metavar="N", help="Seed of the random configurations (0).")
    group.addoption("--pinscrew-tolerance", type=float, metavar="X", help="Largest error that is rounding (1e-12).")


def pytest_configure(config: pytest.Config) -> None:
    """Name the marker; with the option, read the configuration and start to collect."""
    config.addinivalue_line("markers", "pinscrew: a check of a robot's file, made by --pinscrew.")
    if config.getoption("pinscrew"):
        from pinscrew.pytest_plugin.collection import Collector
        from pinscrew.pytest_plugin.settings import read

        config.pluginmanager.register(Collector(read(config)), "pinscrew-collector")


@pytest.fixture(scope="session")
def pinscrew_robot(pytestconfig: pytest.Config) -> Callable[..., Robot]:
    """A function that loads a robot as ``pinscrew.load`` does: ``pinscrew_robot("robots/arm.urdf.xacro", l1=0.4)``.

    A relative path is one from pytest's rootdir, whatever the current folder. A robot is loaded once per session and
    the same object given to every test that asks for it with the same arguments; robots can't be changed.
    """
    from pinscrew.pytest_plugin.mechanisms import Robots

    return Robots(pytestconfig.rootpath)


@pytest.fixture(scope="session")
def assert_same_mechanism(pinscrew_robot: Callable[..., Robot]) -> Callable[..., None]:
    """A function that fails the test if two robots differ: ``assert_same_mechanism("arm.urdf", "arm.urdf.xacro")``.

    Either may be a `Robot` or what `pinscrew_robot` loads. The message is ``pinscrew.diff``'s. ``tolerance`` is in
    metres and in radians (1e-9); ``length=`` and ``angle=`` set each on its own.
    """
    from pinscrew.pytest_plugin.mechanisms import difference

    def check(
        a: Robot | str | Path,
        b: Robot | str | Path,
        tolerance: float = _SAME,
        *,
        length: float | None = None,
        angle: float | None = None,
    ) -> None:
        __tracebackhide__ = True
        robots = (pinscrew_robot(one) if isinstance(one, (str, Path)) else one for one in (a, b))
        words = difference(
            *robots,
            length=tolerance if length is None else length,
            angle=tolerance if angle is None else angle,
        )
        if words:
            pytest.fail(words, pytrace=False)

    return check
