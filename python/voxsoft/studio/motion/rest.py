"""The search for the state at rest, on a thread of its own."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol

from voxsoft.errors import VoxSoftError
from voxsoft.jobs.nearness import digits_lost
from voxsoft.simulation import Result, Setup, simulate
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.simulation.solving.choice import DYNAMICS, kind_of, settings_at_rest
from voxsoft.simulation.solving.dynamics import DEFAULT_MAX_TIME, DEFAULT_RECORD_INTERVAL
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.sentences import time_text
from voxsoft.units import format_percent

#: Largest size of the frames of a film while it is solved for [bytes].
ROOM: Final = 256 * 1024 * 1024


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
        Factor on each load of the design.
    method
        The solver.
    listener
        Receiver of the events.
    """

    def __init__(
        self, body: StudioBody, factors: Sequence[float], method: str, listener: Listener
    ) -> None:
        super().__init__(name="studio-rest", daemon=True)
        self._body, self._factors, self._method = body, factors, method
        self._listener = listener
        self._stopped = threading.Event()
        self._largest = 0.0
        self._end: float | None = None

    @property
    def as_designed(self) -> bool:
        """True if loads and solver are those of the design, not changed by hand."""
        return self._method == "auto" and all(factor == 1.0 for factor in self._factors)

    def stop(self) -> None:
        """Give the search up; its listener hears no more of it."""
        self._stopped.set()

    def run(self) -> None:
        """Search."""
        say: Callable[[], None]
        try:
            setup = self._body.under(self._factors)
            result = simulate(setup, progress=self._tell, **self._settings(setup))
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

    def _settings(self, setup: Setup) -> dict[str, Any]:
        """Settings of the search: rest; with contact and supplies the design's goal, as a film."""
        design = setup.design
        if not (has_contact(design) or has_supplies(design)):
            return {**settings_at_rest(), "method": self._method}
        chosen = {} if self._method == "auto" else {"method": self._method}
        solver = design.solver.replace(**chosen)
        if kind_of(design, solver) not in DYNAMICS:
            return chosen
        self._end = solver.end_time
        lasts = solver.end_time or solver.max_time or DEFAULT_MAX_TIME
        most = max(1, ROOM // (8 * setup.mesh.vertices.size))
        interval = max(DEFAULT_RECORD_INTERVAL, solver.time_step or 0.0, lasts / most)
        return {**chosen, "frames": True, "record_interval": interval}

    def _tell(self, steps: int, when: float, residual: float) -> None:
        if self._stopped.is_set():
            raise _StoppedError
        if self._end is not None:
            sentence = f"Solving for the motion: {time_text(when)} of {time_text(self._end)}"
            self._listener.searching(self, sentence, min(1.0, when / self._end))
            return
        if math.isfinite(residual):
            self._largest = max(self._largest, residual)
        left = f"residual {format_percent(residual)} of the load"
        sentence = f"Solving for equilibrium: step {steps:,}, {left}"
        self._listener.searching(self, sentence, digits_lost(residual, self._largest))
