"""Gate before the trials of a study: while it is closed, running trials end and none begins.

Trials wait for it in the worker processes, so that closing also holds the trials that a pool has
taken already. The shared values are replaced with every pool, and the main process takes no lock
of them: a worker that is killed can leave one locked.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from ctypes import c_int32
from multiprocessing.context import BaseContext
from multiprocessing.sharedctypes import Synchronized
from typing import Any, Final, TypeVar

#: Seconds between two checks of a closed gate.
_LOOK: Final = 0.02

Answer = TypeVar("Answer")


class Gate:
    """Gate that holds back the trials of a study that have not begun.

    It is closed and opened by any thread of the process that runs the study. Workers of this
    machine stop and go on at once; trials handed to another executor, or to a cluster, go on.

    Examples
    --------
    >>> gate = Gate()
    >>> gate.close()
    >>> gate.closed, gate.begun
    (True, 0)
    >>> gate.open()
    """

    def __init__(self) -> None:
        self._closed = False
        self._shared: SharedGate | None = None
        self._stored = 0

    @property
    def closed(self) -> bool:
        """True while no trial may begin."""
        return self._closed

    @property
    def begun(self) -> int:
        """Number of trials that have begun on workers of this machine, and are not stored yet."""
        if self._shared is None:
            return 0
        return max(0, int(self._shared.begun.get_obj().value) - self._stored)

    @property
    def waiting(self) -> int:
        """Number of workers that hold a trial back because the gate is closed."""
        return 0 if self._shared is None else int(self._shared.waiting.get_obj().value)

    def close(self) -> None:
        """Let no further trial begin."""
        self._set(closed=True)

    def open(self) -> None:
        """Let trials begin."""
        self._set(closed=False)

    def stored(self) -> None:
        """Count a trial of a worker as stored."""
        self._stored += 1

    def for_pool(self, context: BaseContext) -> SharedGate:
        """Make the values that a new pool of processes shares with this one."""
        self._shared, self._stored = SharedGate(context), 0
        self._set(closed=self._closed)
        return self._shared

    def _set(self, *, closed: bool) -> None:
        self._closed = closed
        if self._shared is not None:
            self._shared.closed.value = closed


class SharedGate:
    """The worker's side of a gate; it reaches the workers as they are started."""

    def __init__(self, context: BaseContext) -> None:
        self.closed: Any = context.RawValue(c_int32, 0)
        self.begun: Synchronized[int] = context.Value(c_int32, 0)
        self.waiting: Synchronized[int] = context.Value(c_int32, 0)

    def through(self, task: Callable[..., Answer], *arguments: object) -> Answer:
        """Run a task once the gate is open."""
        if not self._entered():
            _count(self.waiting, 1)
            while not self._entered():
                time.sleep(_LOOK)
            _count(self.waiting, -1)
        return task(*arguments)

    def _entered(self) -> bool:
        if self.closed.value:
            return False
        # Counted before the second check: a gate that is closed with none counted holds all.
        _count(self.begun, 1)
        if not self.closed.value:
            return True
        _count(self.begun, -1)
        return False


def _count(number: Synchronized[int], change: int) -> None:
    with number.get_lock():
        number.value += change


_gate_of_worker: SharedGate | None = None


def keep_gate(gate: SharedGate | None) -> None:
    """Remember the gate of this worker process, as it starts."""
    global _gate_of_worker
    _gate_of_worker = gate


def through_gate(task: Callable[..., Answer], *arguments: object) -> Answer:
    """Run a task in a worker process, once its gate is open."""
    gate = _gate_of_worker
    return task(*arguments) if gate is None else gate.through(task, *arguments)
