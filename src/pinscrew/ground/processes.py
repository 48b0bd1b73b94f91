"""Processes of this machine, for work that is done apart."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import threading
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from pinscrew.ground.children import end_with_parent
from pinscrew.ground.counts import whole

__all__ = ["cores", "job_count", "process_pool"]

_T = TypeVar("_T")


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
    """Processes of this machine, which end with this block, and with this process, however it ends.

    They are spawned, so a script that makes them needs its ``if __name__ == "__main__":``.

    Args:
        jobs: how many; see `job_count`.

    Yields:
        the executor, and how many workers it has.

    Raises:
        InputError: if ``jobs`` is not positive.
    """
    workers = job_count(jobs)
    pool = _Pool(workers)
    try:
        yield pool, workers
    except BaseException:
        pool.kill()  # nobody waits for what is being done
        raise
    finally:
        pool.shutdown(cancel_futures=True)


class _Pool(Executor):
    """Worker processes, each asked through a pipe of its own by a thread of its own.

    Python's own pool has queues for all workers together. These need named semaphores, which outlive a process that
    is killed; what tidies up after it then complains on standard error. A pipe needs nothing, and closes by itself.
    """

    def __init__(self, workers: int) -> None:
        self._threads = ThreadPoolExecutor(workers, "pinscrew-worker", initializer=_deaf_to_interrupts)
        self._own = threading.local()
        self._lock = threading.Lock()
        self._workers: list[_Worker] = []
        self._broken = False

    def submit(self, fn: Callable[..., _T], /, *args: Any, **kwargs: Any) -> Future[_T]:
        return self._threads.submit(self._ask, fn, args, kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)
        if wait:
            for worker in self._workers:
                worker.end()

    def kill(self) -> None:
        """End all workers in the middle of whatever they do."""
        with self._lock:
            self._broken = True
            for worker in self._workers:
                worker.process.kill()

    def _ask(self, function: Callable[..., _T], args: Any, kwargs: Any) -> _T:
        """In a thread: the answer of the worker that this thread has, or starts."""
        worker: _Worker | None = getattr(self._own, "worker", None)
        if worker is None:
            worker = self._own.worker = self._start()
        question = pickle.dumps((function, args, kwargs))
        try:
            worker.connection.send_bytes(question)
            answered = worker.connection.recv_bytes()
        except (EOFError, OSError):
            raise self._broken_by("a worker ended before it had answered") from None
        answer: _T
        answer, error, where = pickle.loads(answered)  # noqa: S301 (from our own worker)
        if error is not None:
            raise error from _ElsewhereError(where)
        return answer

    def _start(self) -> _Worker:
        with self._lock:
            if self._broken:
                raise BrokenExecutor("another worker has ended")
            try:
                worker = _Worker()
            except RuntimeError as error:  # a script without its main guard, in a worker that imports it
                raise self._broken_by(str(error)) from None
            self._workers.append(worker)
            return worker

    def _broken_by(self, reason: str) -> BrokenExecutor:
        self._broken = True
        return BrokenExecutor(reason)


class _ElsewhereError(Exception):
    """The traceback of an error in a worker, as text: the cause of what is raised here."""


class _Worker:
    """A process that answers through a pipe. It ends when the pipe closes, or when the thread that started it ends."""

    def __init__(self) -> None:
        # Spawned, not forked: numpy's and Pinocchio's threads may hold locks.
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process: BaseProcess = context.Process(target=_work, args=(theirs,), daemon=True)
        try:
            self.process.start()
        finally:
            theirs.close()

    def end(self) -> None:
        self.connection.close()
        self.process.join()
        self.process.close()


def _deaf_to_interrupts() -> None:
    """In a thread: let Ctrl-C pass, and have workers inherit that, so that it is for the parent alone."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


def _work(connection: Connection) -> None:
    """In a worker: answer until nobody asks any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    end_with_parent(parent.pid if parent is not None else None)
    threading.Thread(target=_watch_parent, daemon=True).start()  # where the system does not tell
    with suppress(EOFError, OSError):
        while True:
            connection.send_bytes(_answer(connection.recv_bytes()))


def _answer(question: bytes) -> bytes:
    try:
        function, args, kwargs = pickle.loads(question)  # noqa: S301 (from our parent)
        return pickle.dumps((function(*args, **kwargs), None, ""))
    except Exception as error:
        where = traceback.format_exc()
        answer = pickle.dumps((None, RuntimeError(f"{type(error).__name__}: {error}"), where))
        with suppress(Exception):  # an error that does not survive the trip
            copied = pickle.dumps((None, error, where))
            pickle.loads(copied)  # noqa: S301 (our own)
            answer = copied
        return answer


def _watch_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
