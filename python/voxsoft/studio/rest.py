"""The search for the state at rest, on a thread of its own."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from typing import Protocol

from voxsoft.errors import VoxSoftError
from voxsoft.jobs.nearness import digits_lost
from voxsoft.simulation import Result, simulate
from voxsoft.simulation.choice import settings_at_rest
from voxsoft.studio.body import StudioBody
from voxsoft.units import format_percent


class Listener(Protocol):
    """Who is told of a search; every call comes from the search's own thread."""

    def searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        """The search goes on: a sentence, and the part that is done."""
        ...

    def found(self, search: RestSearch, result: Result) -> None:
        """The search has ended."""
        ...

    def not_found(self, search: RestSearch, sentence: str) -> None:
        """The search could not be done."""
        ...


class _StoppedError(Exception):
    """The search was given up because something else was asked."""


class RestSearch(threading.Thread):
    """Solves a body for rest until it is found, or until :meth:`stop`.

    Parameters
    ----------
    body
        The body.
    factors
        How many times as large as in the design each load is.
    method
        The solver.
    listener
        Who is told.
    """

    def __init__(
        self, body: StudioBody, factors: Sequence[float], method: str, listener: Listener
    ) -> None:
        super().__init__(name="studio-rest", daemon=True)
        self._body, self._factors, self._method = body, factors, method
        self._listener = listener
        self._stopped = threading.Event()
        self._largest = 0.0

    def stop(self) -> None:
        """Give the search up; its listener hears no more of it."""
        self._stopped.set()

    def run(self) -> None:
        """Search."""
        say: Callable[[], None]
        try:
            setup = self._body.under(self._factors)
            settings = {**settings_at_rest(), "method": self._method}
            result = simulate(setup, progress=self._tell, **settings)
            say = lambda: self._listener.found(self, result)  # noqa: E731
        except _StoppedError:
            return
        except VoxSoftError as error:
            sentence = str(error)
            say = lambda: self._listener.not_found(self, sentence)  # noqa: E731
        except BaseException as error:  # whatever it was, the page must not wait for ever
            sentence = f"{type(error).__name__}: {error}"
            say = lambda: self._listener.not_found(self, sentence)  # noqa: E731
        if not self._stopped.is_set():
            say()

    def _tell(self, steps: int, _: float, residual: float) -> None:
        if self._stopped.is_set():
            raise _StoppedError
        if math.isfinite(residual):
            self._largest = max(self._largest, residual)
        left = f"residual {format_percent(residual)} of the load"
        sentence = f"Solving for equilibrium: step {steps:,}, {left}"
        self._listener.searching(self, sentence, digits_lost(residual, self._largest))
