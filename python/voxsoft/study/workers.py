"""Workers that evaluate the trials: processes of this machine, any executor, or a Dask cluster."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.context import BaseContext
from multiprocessing.process import BaseProcess
from typing import Any, Final, Protocol, TypeVar

from voxsoft._memory import memory_limit
from voxsoft._worker_server import worker_context
from voxsoft.errors import MissingPackageError, StudyError
from voxsoft.metrics.own import OwnMetric, missing_metrics
from voxsoft.study.gate import Gate, SharedGate, keep_gate, through_gate

#: Seconds to wait for a Dask scheduler.
DASK_TIMEOUT: Final = 10.0
#: Seconds between two questions to a Dask scheduler for its workers: an answer takes as long as
#: some trials take this process.
_DASK_LOOK: Final = 1.0
#: Memory of a worker process with a small body: 25 MB were measured, its share of common pages
#: included, and as much again for larger ones.
_WORKER_BYTES: Final = 50 * 10**6
#: Seconds for the manager thread of a pool to notice that its processes were killed.
_MANAGER_PATIENCE: Final = 5.0

Answer = TypeVar("Answer")


class LostWorkersError(StudyError):
    """Workers that no trial can be handed to any more, nor come back from."""


def lost_workers(where: str) -> LostWorkersError:
    """Make the error of workers that are gone; `where` names them, or who hands trials to them."""
    return LostWorkersError(
        where,
        "the connection to the workers was lost",
        "see that they run, and start the study again; finished trials are kept",
    )


class Workers(Protocol):
    """Workers that evaluate trials, some side by side."""

    @property
    def where(self) -> str:
        """Name of the workers in an error."""
        ...

    @property
    def slots(self) -> int:
        """Number of trials that run side by side."""
        ...

    def submit(self, task: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Start a task, or queue it; one that is cancelled will never be done."""
        ...

    def recover(self) -> None:
        """Prepare for further tasks after a worker died (:class:`BrokenExecutor`)."""
        ...

    def close(self, *, now: bool) -> None:
        """Release everything that this object started, also running tasks if `now`."""
        ...


def make_workers(
    executor: Executor | None,
    scheduler: str | None,
    count: int | None,
    gate: Gate | None = None,
) -> Workers:
    """Choose the workers.

    Parameters
    ----------
    executor
        Any executor; it is used as it is and left open.
    scheduler
        Address of a running Dask scheduler, ``"tcp://host:port"``.
    count
        Processes on this machine; default: one for each core this process may use. With an
        executor: the number of trials to hand it at a time (default the same).
    gate
        Gate that the tasks of processes of this machine wait for.

    Raises
    ------
    StudyError
        Both an executor and a scheduler, a count below 1 or of more processes than fit in memory,
        workers that do not start, or a scheduler that does not answer.
    MissingPackageError
        A scheduler without the package `distributed`.
    """
    if executor is not None and scheduler is not None:
        raise StudyError("scheduler", "cannot be used together with an executor", "give one")
    if count is not None and count < 1:
        raise StudyError("workers", f"{count} is not possible; expected at least 1")
    if scheduler is not None:
        return DaskCluster(scheduler)
    slots = count or _usable_cores()
    if count is not None and executor is None and count * _WORKER_BYTES > memory_limit():
        raise StudyError(
            "workers",
            f"{slots} processes take about {slots * _WORKER_BYTES / 1e9:.1f} GB, and "
            f"{memory_limit() / 1e9:.1f} GB of memory are free",
            f"use one for each core, {_usable_cores()} here; at most "
            f"{max(1, memory_limit() // _WORKER_BYTES)} fit",
        )
    return LocalProcesses(slots, gate) if executor is None else ForeignExecutor(executor, slots)


class LocalProcesses:
    """Worker processes on this machine, which stay warm between trials."""

    where = "workers"

    def __init__(self, count: int, gate: Gate | None = None) -> None:
        self.slots, self._gate = count, gate
        self._start()

    def submit(self, task: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Start a task, or queue it.

        Raises
        ------
        BrokenExecutor
            A worker died; :meth:`recover` replaces the pool.
        """
        try:
            return self._pool.submit(through_gate, task, *arguments)
        except OSError as error:
            # The pool was starting a worker when it noticed that another one had died: it closes
            # the pipes of the new one.
            raise BrokenExecutor("a worker died while another one was started") from error

    def recover(self) -> None:
        """Replace the pool: a pool that lost a worker takes no more tasks."""
        self.close(now=True)
        self._start()

    def close(self, *, now: bool) -> None:
        """End the processes, also those that run a task if `now`."""
        if not now:
            self._pool.shutdown(cancel_futures=True)
            return
        for process in self._context.processes:
            if process.pid is not None:  # was started
                process.kill()
        # The manager thread of the pool closes its pipe; the exit of the program, which writes to
        # it, must not come first.
        ending = threading.Thread(
            target=self._pool.shutdown, kwargs={"cancel_futures": True}, daemon=True
        )
        ending.start()
        ending.join(_MANAGER_PATIENCE)

    def _start(self) -> None:
        context = worker_context()
        self._context = _RememberingContext(context)
        as_context: Any = self._context
        self._pool = ProcessPoolExecutor(
            self.slots,
            mp_context=as_context,
            initializer=_prepare_worker,
            initargs=(
                max(1, _usable_cores() // self.slots),
                None if self._gate is None else self._gate.for_pool(context),
            ),
        )
        try:
            self._pool.submit(os.getpid).result()
        except BrokenExecutor:
            raise StudyError(
                "workers",
                "the worker processes ended before they could start",
                'in a script, start the study below `if __name__ == "__main__":`, because the '
                "workers import the script; or pass executor=ThreadPoolExecutor()",
            ) from None


class _RememberingContext:
    """Multiprocessing context that records the processes it started, which a pool hides."""

    def __init__(self, context: BaseContext) -> None:
        self._context = context
        self.processes: list[BaseProcess] = []

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - whatever a context has
        return getattr(self._context, name)

    def Process(self, *arguments: Any, **options: Any) -> BaseProcess:  # noqa: ANN401
        """Make a process, as the pool calls it."""
        start: Any = self._context
        process: BaseProcess = start.Process(*arguments, **options)
        self.processes.append(process)
        return process


class ForeignExecutor:
    """User's executor, which stays open."""

    where = "executor"

    def __init__(self, executor: Executor, slots: int) -> None:
        self._executor, self.slots = executor, slots

    def submit(self, task: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Start a task, or queue it."""
        return self._executor.submit(task, *arguments)

    def recover(self) -> None:
        """Give up: only the user can replace a broken executor."""
        raise StudyError(
            "executor",
            "broke, as one of its workers died",
            "start the study again with a new executor; finished trials are kept. Without "
            "executor= the study replaces dead workers itself",
        )

    def close(self, *, now: bool) -> None:
        """Leave the executor to the user."""


class DaskCluster:
    """Running Dask cluster, which replaces lost workers and repeats their tasks itself."""

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise MissingPackageError(
                "scheduler", "needs the package distributed", "pip install distributed"
            ) from None
        client: Any = distributed.Client
        self.where = f"scheduler {address}"
        self._threads, self._looked = 0, -_DASK_LOOK
        try:
            self._client: Any = client(address, set_as_default=False, timeout=DASK_TIMEOUT)
        except (OSError, ValueError, TypeError) as error:  # TypeError: TLS without certificates
            raise StudyError(
                "scheduler",
                f'"{address}" does not answer: {error}',
                "start one with `dask scheduler`, and give its address, tcp://host:port; tls:// "
                "needs certificates in Dask's configuration",
            ) from None
        self._executor: Any = self._client.get_executor(pure=False)

    @property
    def slots(self) -> int:
        """Threads of all workers; a cluster without workers still takes a task, and waits.

        Raises
        ------
        LostWorkersError
            The scheduler does not answer.
        """
        now = time.monotonic()
        if now - self._looked >= _DASK_LOOK:
            with self._or_lost():
                threads: dict[str, int] = self._client.nthreads()
            self._threads, self._looked = sum(threads.values()), now
        return max(1, self._threads)

    def submit(self, task: Callable[..., Answer], *arguments: object) -> Future[Answer]:
        """Start a task, or queue it.

        Raises
        ------
        LostWorkersError
            The connection to the scheduler is closed.
        """
        with self._or_lost():
            future: Future[Answer] = self._executor.submit(task, *arguments)
        return future

    def recover(self) -> None:
        """Do nothing: the scheduler recovers by itself."""

    def close(self, *, now: bool) -> None:
        """Leave the cluster running."""
        with _quiet_dask():
            self._client.close()

    @contextmanager
    def _or_lost(self) -> Iterator[None]:
        """Say that the scheduler is gone where Dask fails."""
        try:
            yield
        except (OSError, RuntimeError):  # Dask's: a connection or a client that is closed
            raise lost_workers(self.where) from None


@contextmanager
def _quiet_dask() -> Iterator[None]:
    """Keep Dask from logging that a client is closed while it tries to connect again."""
    loggers = [logging.getLogger(f"distributed.{name}") for name in ("client", "utils")]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)


def require_metrics(workers: Workers, wanted: tuple[OwnMetric, ...]) -> None:
    """Check that workers know metrics that the user added, before any trial begins.

    Raises
    ------
    StudyError
        They do not: the metrics were typed into a session, or are in a module that the workers
        cannot import.
    """
    missing = workers.submit(missing_metrics, wanted).result() if wanted else ()
    if missing:
        homes = sorted({module for name, module in wanted if name in missing})
        raise StudyError(
            "workers",
            f"do not know the metric {', '.join(missing)} of {', '.join(homes)}",
            "register it at the top of a script or of a module that the workers can import, or "
            "pass executor=ThreadPoolExecutor()",
        )


def _usable_cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _prepare_worker(threads: int, gate: SharedGate | None) -> None:
    """Share the cores among workers, leave Ctrl-C to the main process, and end with it."""
    keep_gate(gate)
    os.environ.setdefault("RAYON_NUM_THREADS", str(threads))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    # A worker waits for tasks on a pipe that its siblings keep open, so it would outlive a main
    # process that was killed.
    parent = multiprocessing.parent_process()
    if parent is not None:
        with suppress(OSError):
            parent.join()
        os._exit(1)
