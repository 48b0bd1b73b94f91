"""A dask cluster for the tests of workspaces."""

from __future__ import annotations

from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session")
def cluster() -> Iterator[str]:
    """The address of a scheduler with two workers, each in a thread of this process."""
    distributed = pytest.importorskip("distributed")
    options = {"dashboard_address": ":0", "processes": False, "protocol": "tcp://"}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options) as running:
        yield running.scheduler_address
