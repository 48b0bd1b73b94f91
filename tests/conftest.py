"""Property tests give the same examples on every run and machine; `pytester` tests the pytest plugin.

xacro files are expanded in forks of one process (see `expansions`): that is where half of the tests' time would go.
"""

from collections.abc import Iterator
from unittest import mock

import pytest
from hypothesis import settings

from expansions import Expansions
from pinscrew.description import expand

pytest_plugins = ["pytester"]

settings.register_profile("pinscrew", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("pinscrew")


@pytest.fixture(scope="session", autouse=True)
def quick_expansions() -> Iterator[None]:
    """Those of this process; commands in processes of their own, and all of `limited`, have theirs."""
    with Expansions() as forks, mock.patch.object(expand, "subprocess", forks):
        yield
