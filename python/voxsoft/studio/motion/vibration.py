"""A natural vibration of the equilibrium that is shown, drawn slowly and large enough to see."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.simulation import Modes, Result, modes
from voxsoft.studio.protocol import events

#: Duration of a drawn swing, whatever the frequency [s]: quick enough to be seen as motion.
PERIOD: Final = 1.5
#: Drawn amplitude of the vertex that moves farthest, as a part of the largest extent of the body.
REACH: Final = 0.08


@dataclass(frozen=True, eq=False)
class Vibration:
    """The modes of an equilibrium, and which of them is drawn.

    Attributes
    ----------
    topology, frame
        The body, and the frame that shows the equilibrium.
    positions
        Positions of its vertices in equilibrium, (n, 3) [m].
    found
        Its modes.
    mode
        The one that is drawn, from 0; None where the body stands still.
    started
        Time of its start, on the monotonic clock [s].
    """

    topology: int
    frame: int
    positions: NDArray[np.float64]
    found: Modes
    mode: int | None = None
    started: float = 0.0

    @property
    def amplitude(self) -> float:
        """Drawn amplitude of the vertex that moves farthest [m]."""
        return REACH * float(np.ptp(self.positions, axis=0).max())

    def with_mode(self, mode: int | None) -> Self:
        """Draw another mode from now on.

        Raises
        ------
        SimulationError
            There is no such mode.
        """
        count = len(self.found.frequencies)
        if mode is not None and mode >= count:
            raise SimulationError("mode", f"{mode} is none of {count}", "count from 0")
        return replace(self, mode=mode, started=time.monotonic())

    def now(self) -> NDArray[np.float64]:
        """Present positions of the drawn vertices, (n, 3) [m]."""
        if self.mode is None:
            return self.positions
        phase = 2.0 * math.pi * (time.monotonic() - self.started) / PERIOD
        moved: NDArray[np.float64] = (
            self.positions + self.amplitude * math.sin(phase) * self.found.shapes[self.mode]
        )
        return moved

    def event(self) -> events.Vibration:
        """Event for the page."""
        return events.Vibration(
            topology=self.topology,
            frame=self.frame,
            frequencies=self.found.frequencies.tolist(),
            mode=self.mode,
            amplitude=self.amplitude,
            period=PERIOD,
        )


class ModesSearch(threading.Thread):
    """Looks for the modes of an equilibrium on a thread of its own.

    Parameters
    ----------
    result
        Gives the equilibrium.
    report
        Called with its vertices and its modes.
    fail
        Called with why there are none.
    """

    def __init__(
        self,
        result: Callable[[], Result],
        report: Callable[[NDArray[np.float64], Modes], None],
        fail: Callable[[VoxSoftError], None],
    ) -> None:
        super().__init__(name="studio-modes", daemon=True)
        self._result, self._report, self._fail = result, report, fail

    def run(self) -> None:
        """Look for them."""
        try:
            result = self._result()
            self._report(result.positions, modes(result))
        except VoxSoftError as error:
            self._fail(error)
