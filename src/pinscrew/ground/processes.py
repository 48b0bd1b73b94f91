"""Processes of this machine, for work that is done apart."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager

from pinscrew.ground.counts import whole

__all__ = ["cores", "job_count", "process_pool"]


def job_count(jobs: int | None = None) -> int:
    """A number of processes, checked; by default the cores that this one may use.

    Raises:
        InputError: if it is not positive.
    """
    return cores() if jobs is None else whole("jobs", jobs, 1)


def cores() -> int:
    """How many cores this process may use; where the system does not say, all that there are."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def process_pool(jobs: int | None = None) -> Iterator[tuple[Executor, int]]:
    """Processes of this machine.

    They are spawned, so a script that makes them needs its ``if __name__ == "__main__":``.

    Args:
        jobs: how many; see `job_count`.

    Yields:
        the executor, and how many workers it has.

    Raises:
        InputError: if ``jobs`` is not positive.
    """
    workers = job_count(jobs)
    # Spawned, not forked: numpy's and Pinocchio's threads may hold locks.
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
