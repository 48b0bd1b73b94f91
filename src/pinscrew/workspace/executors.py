"""Who computes: processes of this machine, or the workers of a dask cluster."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from typing import Final

from pinscrew.errors import EngineError, InputError, MissingExtraError

__all__ = ["dask_executor", "process_pool"]

PATIENCE: Final = 4.0
"""Seconds in which a scheduler must answer."""


@contextmanager
def process_pool(jobs: int | None = None) -> Iterator[tuple[Executor, int]]:
    """Processes of this machine.

    They are spawned, so a script that makes them needs its ``if __name__ == "__main__":``.

    Args:
        jobs: how many; by default as many as there are cores.

    Yields:
        the executor, and how many workers it has.

    Raises:
        InputError: if ``jobs`` is not positive.
    """
    if jobs is not None and jobs < 1:
        raise InputError("jobs", f"jobs={jobs}", remedy="give 1 or more")
    workers = jobs or os.cpu_count() or 1
    # Workers are spawned, not forked: numpy's threads may hold locks.
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), initializer=_begin)
    try:
        yield pool, workers
    finally:
        pool.shutdown(cancel_futures=True)


def _begin() -> None:
    """In a worker: Ctrl-C is for the parent alone, and the end of the parent, however it comes, is the worker's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


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
    try:
        asyncio.run(asyncio.wait_for(_is_scheduler(address), PATIENCE))
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
