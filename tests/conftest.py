"""Property tests give the same examples on every run and machine; `pytester` tests the pytest plugin.

xacro files are expanded in forks of one process (see `expansions`): that is where half of the tests' time would go.
"""

import os
from collections.abc import Iterator
from unittest import mock

import pytest
from hypothesis import settings

from expansions import Expansions
from pinscrew.description import expand

pytest_plugins = ["pytester"]

settings.register_profile("pinscrew", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("pinscrew")


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int | None:
    """One more than there are cores, for `-n auto`: a test that waits for a browser or a child leaves one idle."""
    return None if config.option.numprocesses != "auto" else (os.cpu_count() or 1) + 1


@pytest.fixture(scope="session", autouse=True)
def quick_expansions() -> Iterator[None]:
    """Those of this process; commands in processes of their own, and all of `limited`, have theirs."""
    with Expansions() as forks, mock.patch.object(expand, "subprocess", forks):
        yield
