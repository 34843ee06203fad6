"""What is shown of a body, and when: the present or a stored frame, moving or still."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from voxsoft.errors import SimulationError
from voxsoft.simulation import Result
from voxsoft.simulation.result import Status
from voxsoft.studio import events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.canvas import Canvas, Moment
from voxsoft.studio.exports import Shown
from voxsoft.studio.hands import Hands
from voxsoft.studio.mover import Mover
from voxsoft.studio.pace import Pace, RealTimeFactor
from voxsoft.studio.past import Past, StoredFrame
from voxsoft.studio.plots import Plots
from voxsoft.studio.sentences import at_rest, diverged, time_text
from voxsoft.studio.wire import FrameFlag

#: How a search for rest may have ended, in the words of the page.
_STATES: Final[dict[str, events.SimulationState]] = {"ok": "at-rest", "diverged": "diverged"}
_IDLE: Final = Hands((), ())
#: What a run that is kept of a state is said to be.
_KEPT: Final[dict[events.SimulationState, Status]] = {"at-rest": "ok", "diverged": "diverged"}


@dataclass(eq=False)
class Playback:
    """One body at a time, and how it moves; it knows neither tabs nor threads.

    Attributes
    ----------
    body, canvas
        What is shown, and what draws it.
    state, sentence, progress
        How the simulation stands, in a word, in a sentence, and the part that is done.
    wants_play
        Whether time runs again once a load or a pull wakes the body.
    steps_left
        Frames until time stops, or None to go on.
    pace
        How fast time is shown.
    method
        The solver of the search for rest.
    frame
        Number of the present frame.
    past, shown
        Stored frames, and the one that is looked at; None for the present.
    plots
        What is plotted over time.
    result
        The state at rest that a solver found, while the body is in it.
    """

    body: StudioBody | None = None
    canvas: Canvas | None = None
    state: events.SimulationState = "empty"
    sentence: str = ""
    progress: float | None = None
    wants_play: bool = False
    steps_left: int | None = None
    pace: Pace = field(default_factory=Pace)
    method: str = "auto"
    frame: int = 0
    past: Past = field(default_factory=Past)
    shown: StoredFrame | None = None
    plots: Plots = field(default_factory=Plots)
    result: Result | None = None
    _mover: Mover | None = None
    _hands: Hands | None = None
    _speed: RealTimeFactor = field(default_factory=RealTimeFactor)
    _step_ms: float = 0.0

    def begin(self, body: StudioBody) -> None:
        """Take another body, unloaded and at time zero; what hands did to the one before stays."""
        if self._mover is not None and self._hands is None:
            self._hands = Hands.on(self._mover)
        self.body, self.canvas = body, Canvas(body)
        self.plots.begin(body)
        self._mover, self.result, self.shown = None, None, None
        self.past, self.frame = Past(), 0
        self.state, self.progress, self.pace.rest_in = "paused", None, None
        self.sentence = "" if body.refusal is None else f"Cannot be solved: {body.refusal}"
        if body.refusal is None and self._hands is not None:
            self._mover = None if self._hands.idle else self._hands.lay_on(body)
            self._hands = None

    def let_go(self) -> None:
        """Forget what hands did, as another document is opened."""
        self._hands = _IDLE

    def reset(self) -> None:
        """Go back to the unloaded shape at time zero."""
        self.wants_play = False
        self.shown, self.result = None, None
        self.past, self.frame = Past(), 0
        self.plots.clear()
        if self._mover is not None:
            self._mover.reset()
        self.state = "paused" if self.body is not None else "empty"
        self.sentence, self.progress, self.pace.rest_in = "", None, None

    def halt(self, state: events.SimulationState, sentence: str) -> None:
        """Stop time for good, and say why."""
        self.state, self.sentence, self.wants_play = state, sentence, False

    def play(self) -> None:
        """Let time run.

        Raises
        ------
        SimulationError
            There is no body.
        VoxSoftError
            The body cannot be solved.
        """
        self.require_mover()
        self.result = None
        self.state, self.sentence, self.progress = "playing", "", None
        self.steps_left = None
        self._speed.restart()

    def look_ahead(self) -> None:
        """Find out how soon the body comes to rest, to show it slowly enough to be seen.

        Raises
        ------
        VoxSoftError
            Nothing can move.
        """
        mover = self.require_mover()
        if mover.unloaded:
            self.pace.rest_in = mover.time_to_rest()

    def choose_pace(self, factor: float | None) -> None:
        """Take the user's pace, or None for the automatic one."""
        self.pace.chosen = factor
        self._speed.restart()

    def touched(self) -> None:
        """Hear that a hand is on a load or a pull: what it does is shown at once."""
        self.result, self.pace.rest_in = None, None

    def to_present(self) -> None:
        """Look at the present again."""
        if self.shown is not None:
            self.shown, self.state, self.sentence = None, "paused", ""

    def look_at(self, number: int, time: float | None = None) -> None:
        """Look at a stored frame by number, or by time [s] where one is given; time stops.

        The nearest that is still there is taken.

        Raises
        ------
        SimulationError
            No frame is stored.
        """
        stored = self.past.at(number) if time is None else self.past.at_time(time)
        if stored is None:
            raise SimulationError("seek", "no frame is stored yet", "press play first")
        self.wants_play = False
        self.shown, self.state, self.progress = stored, "past", None
        self.sentence = f"Frame {stored.number} of {self.past.last}"

    def take_frame(self, seconds: float, budget: float) -> None:
        """Move for the time between two frames, or as far as a budget of the clock allows [s].

        In slow motion there may be no step to take yet; then there is no frame either.
        """
        mover = self.require_mover()
        began = time.perf_counter()
        steps = mover.advance(seconds * self.pace.factor, budget)
        ended = time.perf_counter()
        self._speed.mark(mover.time, ended)
        if steps:
            self._step_ms = 1e3 * (ended - began) / steps
        elif mover.state == "moving":
            return
        self.frame += 1
        positions = mover.positions()
        self.past.keep(self.frame, mover.time, positions, mover.loads, mover.grabs())
        self.plots.record(mover, positions)
        if mover.state == "at-rest":
            self.state, self.sentence = "at-rest", at_rest(mover.time, mover.tolerance)
        elif mover.state == "diverged":
            self.halt("diverged", diverged(mover.time, mover.breakdown))
        if self.steps_left is not None:
            self.steps_left -= 1
            if self.steps_left <= 0 and self.moving:
                self.state = "paused"

    def go_to_rest(self, result: Result) -> None:
        """Take the state at rest that a solver found."""
        self.result, self.progress = result, None
        self.state = _STATES.get(result.status, "paused")
        said = f"{result.message[:1].upper()}{result.message[1:]}"
        self.sentence = f"{said}, in {time_text(result.seconds)}."
        mover = self.require_mover()
        for pull in mover.grabs():  # no solver knows of them
            mover.release(pull.id)
        mover.go_to_rest(result.positions, result.residual, result.elastic_energy)
        self.frame += 1
        self.past.keep(self.frame, self.time, result.positions, mover.loads)
        self.plots.record(mover, result.positions)

    @property
    def moving(self) -> bool:
        """Whether time runs."""
        return self.state == "playing"

    @property
    def time(self) -> float:
        """The time that is looked at [s]."""
        if self.shown is not None:
            return self.shown.time
        return 0.0 if self._mover is None else self._mover.time

    @property
    def moment(self) -> Moment:
        """What is to be drawn."""
        shown = self.shown
        positions = None if shown is None else shown.positions.astype(np.float64)
        number = self.frame if shown is None else shown.number
        return Moment(number, self._flags(), self.time, self._mover, positions)

    @property
    def factors(self) -> Sequence[float]:
        """How many times as large as in the design each load is."""
        if self._mover is None:
            return [1.0] * len(self.require_body().setup.design.loads)
        return self._mover.factors_of(self._mover.loads if self.shown is None else self.shown.loads)

    def release(self, number: int) -> bool:
        """Take a pull away; whether there was anything that could be pulled."""
        if self._mover is not None:
            self._mover.release(number)
        return self._mover is not None

    def stat(self) -> events.Stat:
        """All numbers of the moment."""
        body, mover = self.body, self._mover
        return events.Stat(
            topology=0 if body is None else body.topology,
            state=self.state,
            sentence=self.sentence or (self.pace.words if self.moving else ""),
            time=self.time,
            step_ms=self._step_ms,
            substeps=0 if mover is None else mover.steps,
            real_time_factor=self._speed.value if self.moving else 0.0,
            pace=self.pace.factor,
            pace_chosen=self.pace.chosen,
            residual=None if mover is None else mover.residual,
            elastic=None if mover is None else mover.elastic,
            kinetic=None if mover is None else mover.kinetic,
            frame=self.frame if self.shown is None else self.shown.number,
            first_frame=self.past.first,
            last_frame=self.past.last,
            frames_stored=len(self.past),
            bytes_stored=self.past.bytes,
            solver=self.method,
            progress=self.progress,
            loads=[] if body is None else body.load_values if mover is None else mover.loads,
            grabs=[] if mover is None else mover.grabs(),
        )

    def shown_as(self, name: str, text: str) -> Shown:
        """What is shown, for an export under a name, with the text of the design.

        Raises
        ------
        SimulationError
            There is no body.
        """
        body = self.require_body()
        plot = self.plots.whole()
        return Shown(
            name=name,
            text=text,
            body=body,
            positions=self.require_canvas().positions(self.moment),
            result=self.result if self.shown is None else None,
            columns=plot.names,
            units=plot.units,
            rows=plot.rows,
            factors=self.factors,
            pulls=self.pulls,
            status=_KEPT.get(self.state, "not-at-rest"),
            sentence=self._standing(),
            time=self.time,
        )

    @property
    def pulls(self) -> Sequence[events.GrabState]:
        """The springs that pull in what is shown."""
        if self.shown is not None:
            return self.shown.pulls
        return [] if self._mover is None else self._mover.grabs()

    def _standing(self) -> str:
        """How the shown state came about, in words."""
        if self.state == "at-rest":
            return f"at rest after {time_text(self.time)}"
        if self._mover is None or self._mover.unloaded:
            return "the unloaded shape"
        return f"as it stood at {time_text(self.time)}, not at rest"

    def require_body(self) -> StudioBody:
        """The body.

        Raises
        ------
        SimulationError
            There is none.
        """
        if self.body is None:
            raise SimulationError("view", "there is no body yet", "fix the design first")
        return self.body

    def require_canvas(self, vertex: int = 0) -> Canvas:
        """What draws the body, which must have a vertex on its surface.

        Raises
        ------
        SimulationError
            There is no body, or no such vertex.
        """
        body = self.require_body()
        if vertex >= len(body.surface.vertices):
            raise SimulationError("vertex", f"{vertex} is not on the surface")
        assert self.canvas is not None  # it comes with the body
        return self.canvas

    def require_mover(self) -> Mover:
        """What moves the body.

        Raises
        ------
        SimulationError
            There is no body.
        VoxSoftError
            The body cannot be solved.
        """
        body = self.require_body()
        if body.refusal is not None:
            raise body.refusal
        if self._mover is None:
            self._mover = Mover(body)
        return self._mover

    def _flags(self) -> int:
        flags = FrameFlag(0) if self.moving else FrameFlag.PAUSED
        if self.state == "diverged":
            flags |= FrameFlag.DIVERGED
        return flags | FrameFlag.AT_REST if self.state == "at-rest" else flags
