"""The workers of a dask cluster."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Final

from pinscrew.ground.errors import EngineError, MissingExtraError

__all__ = ["dask_executor"]

PATIENCE: Final = 4.0
"""Seconds in which a scheduler must answer."""


@contextmanager
def dask_executor(address: str) -> Iterator[tuple[Executor, int]]:
    """The workers of a dask cluster, which must have pinscrew too.

    Args:
        address: of its scheduler, such as ``tcp://10.0.0.1:8786``.

    Yields:
        the executor, and how many threads the workers have.

    Raises:
        MissingExtraError: if dask's ``distributed`` is not installed.
        EngineError: if no scheduler answers at the address, or it has no workers.
    """
    try:
        from distributed import Client
    except ModuleNotFoundError:
        raise MissingExtraError("distributed is not installed", "dask") from None
    # A Client that meets a stranger at the address may wait for ever, or not end: a short question comes first.
    # It is asked in a thread of its own, since this one may be in an event loop: Jupyter's is.
    try:
        with ThreadPoolExecutor(1) as asking:
            asking.submit(asyncio.run, asyncio.wait_for(_is_scheduler(address), PATIENCE)).result()
    except Exception as error:  # whatever the stranger made distributed raise
        what = f"no dask scheduler answers ({str(error) or type(error).__name__})"
        raise EngineError("scheduler", what, where=address, remedy="give such as tcp://127.0.0.1:8786") from None
    client = Client(address, timeout=PATIENCE, set_as_default=False)
    with client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise EngineError("scheduler", "the cluster has no workers", where=address, remedy="start some")
        yield client.get_executor(), threads


async def _is_scheduler(address: str) -> None:
    """Ask who is there; an error if it is no scheduler of dask's."""
    from distributed import Security, rpc

    async with rpc(address, connection_args=Security().get_connection_args("client")) as there:
        found = await there.identity()
    if found.get("type") != "Scheduler":
        raise OSError(f"it is a {found.get('type')}")
