"""One solution of a problem at a time: what it remembers on its way is that of one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock, get_ident
from typing import Any

from voxsoft.errors import SimulationError


class SolveLock:
    """Lets the threads that solve one setup wait for each other.

    Contact, tendons, supplies and growth remember in the problem where they have come to. A
    solution begins all of it anew, so that each has the bits that it has alone.

    Examples
    --------
    >>> lock = SolveLock()
    >>> with lock.held():
    ...     with lock.held():
    ...         pass
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: setup: is being solved, and was to be solved again from within \
that. Try: wait for its end, or make another Setup for what progress shows
    """

    def __init__(self) -> None:
        self._lock = Lock()
        # The thread that solves, and the one that reports progress, which is another.
        self._busy: set[int] = set()

    @contextmanager
    def held(self) -> Iterator[None]:
        """Wait for the end of the solution of another thread, and keep others waiting.

        Raises
        ------
        SimulationError
            It is this thread's own solution: a progress callback that solves what it watches.
        """
        me = get_ident()
        if me in self._busy:
            what = "is being solved, and was to be solved again from within that"
            hint = "wait for its end, or make another Setup for what progress shows"
            raise SimulationError("setup", what, hint)
        with self._lock, self._working(me):
            yield

    def reported(self, progress: Callable[..., Any] | None) -> Callable[..., Any] | None:
        """A progress callback of a solution that has the lock: it cannot wait for its end."""
        if progress is None:
            return None

        def report(*arguments: Any) -> Any:  # noqa: ANN401 - whatever the callback takes
            with self._working(get_ident()):
                return progress(*arguments)

        return report

    @contextmanager
    def _working(self, thread: int) -> Iterator[None]:
        self._busy.add(thread)
        try:
            yield
        finally:
            self._busy.discard(thread)

    def __reduce__(self) -> tuple[type[SolveLock], tuple[()]]:
        """A copy has a lock of its own: it makes a problem of its own."""
        return SolveLock, ()
