"""The core's player of a body, with its commands and events as the protocol's types."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

import msgspec
import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import SimulationError
from voxsoft.simulation.setup.contact import Pose
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.probes import Probe
from voxsoft.studio.bodies.scene import scene_of
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.events import GrabState

#: Commands that the core's player carries out.
Command = (
    commands.Play
    | commands.Pause
    | commands.Step
    | commands.Reset
    | commands.Pace
    | commands.Load
    | commands.Grab
    | commands.Release
    | commands.Seek
    | commands.Live
    | commands.Pick
    | commands.Probe
)
#: Events of a player.
Event = events.Stat | events.Plot | events.Picked | events.MomentNews


class Shown(msgspec.Struct):
    """The frame in view, now or recorded: its time [s], loads and springs of then."""

    frame: int
    time: float
    loads: list[float]
    grabs: list[GrabState]


_EVENTS: Final = msgspec.json.Decoder(list[Event])
_STAT: Final = msgspec.json.Decoder(events.Stat)
_PLOT: Final = msgspec.json.Decoder(events.Plot)
_MOMENT: Final = msgspec.json.Decoder(events.MomentNews)
_SHOWN: Final = msgspec.json.Decoder(Shown)


class Player:
    """Plays a body.

    Parameters
    ----------
    body
        The body.
    probes
        Plotted probes.

    Raises
    ------
    VoxSoftError
        The body cannot be solved.
    """

    def __init__(self, body: StudioBody, probes: Sequence[Probe] | None = None) -> None:
        if body.refusal is not None:
            raise body.refusal
        self._core = scene_of(body, probes).play()

    def do(self, command: Command) -> list[Event]:
        """Execute a command.

        Raises
        ------
        SimulationError
            It cannot be done.
        """
        with _refusals():
            return _EVENTS.decode(self._core.command(msgspec.json.encode(command)))

    def advance(self, seconds: float, budget: float) -> list[Event]:
        """Let time go on by some seconds, or as far as a budget of the clock allows [s]."""
        return _EVENTS.decode(self._core.advance(seconds, budget))

    def go_to_rest(
        self,
        positions: NDArray[np.float64],
        state: events.SimulationState,
        sentence: str,
        *,
        residual: float,
        elastic: float,
        time: float | None = None,
        poses: Sequence[Pose] = (),
    ) -> list[Event]:
        """Take the state that a solver found, at a time [s] or now, with the objects in poses."""
        placed = [(pose.position, pose.rotation) for pose in poses]
        reported = self._core.go_to_rest(
            positions, state, sentence, residual, elastic, time, placed
        )
        return _EVENTS.decode(reported)

    def take_motion(self, times: NDArray[np.float64], positions: NDArray[np.float64]) -> None:
        """Take a motion that a solver found, (f, n, 3) positions [m], as frames to go back to."""
        self._core.take_motion(times, positions)

    def hold(self, sentence: str = "") -> None:
        """Stop time for now: a load or a pull lets it run again if it was asked to."""
        self._core.hold(sentence)

    def halt(self, sentence: str) -> None:
        """Stop time for good, and say why."""
        self._core.halt(sentence)

    def resume(self) -> None:
        """Go on from another body that was played."""
        self._core.resume()

    @property
    def state(self) -> events.SimulationState:
        """State of time, running or not, with the reason."""
        return self._core.state

    @property
    def frame(self) -> int:
        """The number of the frame that is looked at."""
        return self._core.frame

    @property
    def moving(self) -> bool:
        """True if time runs."""
        return self._core.moving

    @property
    def wants_play(self) -> bool:
        """True if time runs again once a load or a pull wakes the body."""
        return self._core.wants_play

    @property
    def unloaded(self) -> bool:
        """True if the body has its unloaded shape still."""
        return self._core.unloaded

    def stat(self) -> events.Stat:
        """All numbers of the moment."""
        return _STAT.decode(self._core.stat())

    def moment(self) -> events.MomentNews | None:
        """Present contacts, and poses of objects; None for a body without contact."""
        moment = self._core.moment()
        return None if moment is None else _MOMENT.decode(moment)

    def plot(self) -> events.Plot:
        """All rows of the plots."""
        return _PLOT.decode(self._core.plot())

    def shown(self) -> Shown:
        """The frame in view, now or recorded."""
        return _SHOWN.decode(self._core.shown())

    def positions(self) -> NDArray[np.float64]:
        """Positions of the vertices of the mesh in the frame in view [m], (n, 3)."""
        return self._core.positions()

    def packed(self, field: int, seq: int, display: _core.Display | None = None) -> bytes:
        """The frame in view as the page reads it, on the surface or on another display."""
        return self._core.pack_frame(field, seq & 0xFFFF_FFFF, display)


@contextmanager
def _refusals() -> Iterator[None]:
    try:
        yield
    except ValueError as error:
        where, what, hint = error.args
        raise SimulationError(where, what, hint) from None
