"""The thread that moves the body in real time and packs what the tabs see.

Long because every command about time and pictures is obeyed here, on one thread.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from functools import singledispatchmethod
from typing import Final

import numpy as np

from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.simulation import Result
from voxsoft.simulation.check import CheckReport
from voxsoft.studio import commands, events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.canvas import Canvas, Moment
from voxsoft.studio.exports import Shown
from voxsoft.studio.frames import AT_REST, DIVERGED, PAUSED
from voxsoft.studio.mover import Mover
from voxsoft.studio.outlet import Outlet
from voxsoft.studio.past import Past, StoredFrame
from voxsoft.studio.plots import Plots
from voxsoft.studio.rest import RestSearch
from voxsoft.studio.sentences import at_rest, diverged
from voxsoft.studio.tab import Tab

#: Time between two frames [s].
FRAME_TIME: Final = 1.0 / 60.0
#: Part of it that stepping may take; the rest is for packing and for other threads.
SHARE_OF_FRAME: Final = 0.8
#: Time between two statistics, and between two batches of rows for the plots [s].
STAT_TIME: Final = 0.1
PLOT_TIME: Final = 1.0 / 15.0
_STATES: Final[dict[str, events.SimulationState]] = {"ok": "at-rest", "diverged": "diverged"}


class Engine(threading.Thread):
    """Owns the body that is shown; everything it does is done on its own thread.

    Parameters
    ----------
    outlet
        Where events and frames go.
    """

    def __init__(self, outlet: Outlet) -> None:
        super().__init__(name="studio-engine", daemon=True)
        self._outlet = outlet
        self._inbox: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._body: StudioBody | None = None
        self._report: CheckReport | None = None
        self._smooth: bytes | None = None
        self._mover: Mover | None = None
        self._past = Past()
        self._shown: StoredFrame | None = None
        self._state: events.SimulationState = "empty"
        self._sentence = ""
        self._wants_play = False
        self._steps_left: int | None = None
        self._method: str = "auto"
        self._frame = 0
        self._plots = Plots()
        self._canvas: Canvas | None = None
        self._search: RestSearch | None = None
        self._progress: float | None = None
        self._result: Result | None = None
        self._last_stat = self._last_plot = 0.0
        self._speed = self._step_ms = 0.0

    # Asked by other threads

    def run(self) -> None:
        """Do what is asked, and move the body meanwhile, until the end."""
        while True:
            try:
                task = self._inbox.get(block=not self._moving)
            except queue.Empty:
                self._guarded(self._advance)
                continue
            if task is None:
                return
            self._guarded(task)

    def end(self) -> None:
        """Stop the thread."""
        self._inbox.put(None)

    def show(self, body: StudioBody) -> None:
        """Take another body, at rest and at time zero."""
        self._inbox.put(lambda: self._show(body))

    def wait_for_body(self) -> None:
        """Say that a body is being meshed, unless one is moving meanwhile."""
        self._inbox.put(self._wait_for_body)

    def stay(self, sentence: str) -> None:
        """Say why the body that was being meshed does not come."""
        self._inbox.put(lambda: self._stay(sentence))

    def tell_report(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        """Pass on what the doctor says of a body, if it is still the one that is shown."""
        self._inbox.put(lambda: self._tell_report(body, report, smooth))

    def forget(self) -> None:
        """Stop time, as another document is opened."""
        self._inbox.put(self._forget)

    def welcome(self, tab: Tab) -> None:
        """Show a new tab what there is."""
        self._inbox.put(lambda: self._welcome(tab))

    def repaint(self, tab: Tab) -> None:
        """Give a tab that took a frame the picture as it is now, if it has changed since."""
        self._inbox.put(lambda: self._paint(tab))

    def obey(self, command: commands.Command, tab: Tab) -> None:
        """Do what a command asks; what cannot be done is told to its tab."""

        def task() -> None:
            try:
                self._obey(command, tab)
            except VoxSoftError as error:
                said = events.Error(
                    seq=command.seq, where=error.where, what=error.what, hint=error.hint
                )
                self._outlet.tell_one(tab, said)

        self._inbox.put(task)

    def shown(self, name: str, text: str, seconds: float = 30.0) -> Shown:
        """What is shown now, for an export; it is taken between two frames.

        Raises
        ------
        SimulationError
            There is no body, or the engine is too busy to answer.
        """
        answers: queue.SimpleQueue[Shown | VoxSoftError] = queue.SimpleQueue()

        def task() -> None:
            try:
                answers.put(self._shown_now(name, text))
            except VoxSoftError as error:
                answers.put(error)

        self._inbox.put(task)
        try:
            answer = answers.get(timeout=seconds)
        except queue.Empty:
            raise SimulationError("studio", "is too busy to answer", "try again") from None
        if isinstance(answer, VoxSoftError):
            raise answer
        return answer

    # On its own thread

    @property
    def _moving(self) -> bool:
        return self._state == "playing"

    def _guarded(self, task: Callable[[], None]) -> None:
        """Do a task; whatever goes wrong is said, and the thread lives on."""
        try:
            task()
        except VoxSoftError as error:
            self._halt("paused", str(error))
        except BaseException as error:  # a panic of the core too: the thread must live on
            self._halt("paused", f"{type(error).__name__}: {error}")

    def _halt(self, state: events.SimulationState, sentence: str) -> None:
        self._state, self._sentence, self._wants_play = state, sentence, False
        self._stat()

    def _show(self, body: StudioBody) -> None:
        self._stop_search()
        self._body, self._canvas = body, Canvas(body)
        self._plots.begin(body)
        self._report = self._result = self._smooth = None
        self._mover = None
        self._shown = None
        self._past, self._frame = Past(), 0
        self._state = "paused"
        self._sentence = "" if body.refusal is None else f"Cannot be solved: {body.refusal}"
        self._outlet.tell(body.event())
        for mode in {tab.view.mode for tab in self._outlet.tabs()}:
            self._outlet.topology(self._canvas.topology(mode), mode)
        self._forget_pictures()
        self._outlet.tell(self._plots.whole())
        if self._wants_play:
            self._play()
        self._paint_all()
        self._stat()

    def _wait_for_body(self) -> None:
        if not self._moving and self._search is None:
            self._state, self._sentence = "meshing", "Meshing"
            self._stat()

    def _stay(self, sentence: str) -> None:
        if self._state == "meshing":
            self._state = "empty" if self._body is None else "paused"
            self._sentence = sentence
            self._stat()

    def _tell_report(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        if body is not self._body:
            return
        self._report, self._smooth = report, smooth
        self._outlet.tell(self._body_event(body))
        if smooth is not None:
            for tab in self._outlet.tabs():
                self._outlet.smooth_for(tab, smooth)

    def _body_event(self, body: StudioBody) -> events.Body:
        event = body.event(self._report)
        event.smooth = self._smooth is not None
        return event

    def _forget(self) -> None:
        self._wants_play = False
        if self._moving:
            self._state = "paused"

    def _welcome(self, tab: Tab) -> None:
        if self._body is not None and self._canvas is not None:
            self._outlet.tell_one(tab, self._body_event(self._body))
            self._outlet.topology_for(tab, self._canvas.topology(tab.view.mode))
            if self._smooth is not None:
                self._outlet.smooth_for(tab, self._smooth)
            self._outlet.tell_one(tab, self._plots.whole())
            tab.painted = None
            self._paint(tab)
        self._outlet.tell_one(tab, self._stat_event())

    @singledispatchmethod
    def _obey(self, command: commands.Command, tab: Tab) -> None:
        raise SimulationError(type(command).__name__, "is not understood here")

    @_obey.register
    def _(self, command: commands.View, tab: Tab) -> None:
        changed = command.mode != tab.view.mode
        tab.view = command
        if changed and self._canvas is not None:
            self._outlet.topology_for(tab, self._canvas.topology(command.mode))
        tab.painted = None
        self._paint(tab)

    @_obey.register
    def _(self, command: commands.Play, tab: Tab) -> None:
        self._to_present()
        self._wants_play = True
        self._play()
        self._stat()

    @_obey.register
    def _(self, command: commands.Pause, tab: Tab) -> None:
        self._stop_search()
        self._wants_play = False
        if self._state in ("playing", "solving"):
            self._state, self._sentence, self._progress = "paused", "", None
        self._flush_plot()
        self._paint_all()
        self._stat()

    @_obey.register
    def _(self, command: commands.Step, tab: Tab) -> None:
        self._to_present()
        self._wants_play = False
        self._play()
        self._steps_left = command.n
        self._stat()

    @_obey.register
    def _(self, command: commands.Reset, tab: Tab) -> None:
        self._stop_search()
        self._wants_play = False
        self._shown, self._result = None, None
        self._past, self._frame = Past(), 0
        self._plots.clear()
        if self._mover is not None:
            self._mover.reset()
        self._state = "paused" if self._body is not None else "empty"
        self._sentence, self._progress = "", None
        self._outlet.tell(self._plots.whole())
        self._paint_all()
        self._stat()

    @_obey.register
    def _(self, command: commands.Solver, tab: Tab) -> None:
        self._method = command.method
        self._stat()

    @_obey.register
    def _(self, command: commands.Rest, tab: Tab) -> None:
        self._to_present()
        self._find_rest()

    @_obey.register
    def _(self, command: commands.Load, tab: Tab) -> None:
        mover = self._require_mover()
        mover.set_load(command.index, value=command.value, factor=command.factor)
        self._stirred()

    @_obey.register
    def _(self, command: commands.Grab, tab: Tab) -> None:
        self._to_present()
        mover, body = self._require_mover(), self._require_body()
        self._require_canvas(command.vertex)
        vertex = int(body.surface.vertices[command.vertex])
        mover.grab(command.id, vertex, command.target, command.stiffness, shown=command.vertex)
        self._stirred()

    @_obey.register
    def _(self, command: commands.Release, tab: Tab) -> None:
        if self._mover is not None:
            self._mover.release(command.id)
            self._stirred()

    @_obey.register
    def _(self, command: commands.Seek, tab: Tab) -> None:
        stored = self._past.at(command.frame)
        if stored is None:
            raise SimulationError("seek", "no frame is stored yet", "press play first")
        self._stop_search()
        self._wants_play = False
        self._shown, self._state, self._progress = stored, "past", None
        self._sentence = f"Frame {stored.number} of {self._past.last}"
        self._paint_all()
        self._stat()

    @_obey.register
    def _(self, command: commands.Live, tab: Tab) -> None:
        self._to_present()
        self._paint_all()
        self._stat()

    @_obey.register
    def _(self, command: commands.Pick, tab: Tab) -> None:
        canvas = self._require_canvas(command.vertex)
        self._outlet.tell_one(tab, canvas.picked(self._moment, command.vertex))

    @_obey.register
    def _(self, command: commands.Probe, tab: Tab) -> None:
        self._require_canvas(command.vertex)
        self._plots.add_probe(command.vertex)
        self._outlet.tell(self._plots.whole())

    def _shown_now(self, name: str, text: str) -> Shown:
        body = self._require_body()
        plot = self._plots.whole()
        return Shown(
            name=name,
            text=text,
            body=body,
            positions=self._require_canvas().positions(self._moment),
            result=self._result if self._shown is None else None,
            columns=plot.names,
            units=plot.units,
            rows=plot.rows,
            factors=self._factors(body),
        )

    # Time

    def _play(self) -> None:
        self._require_mover()
        self._stop_search()
        self._result = None
        self._state, self._sentence, self._progress = "playing", "", None
        self._steps_left = None

    def _stirred(self) -> None:
        """Go on after a change of load or a grab, if time was running before it came to rest."""
        self._result = None
        self._forget_pictures()
        if self._state in ("at-rest", "solving"):
            self._stop_search()
            self._state = "paused"
        if self._wants_play and self._state == "paused":
            self._play()
        if not self._moving:
            self._paint_all()
        self._stat()

    def _advance(self) -> None:
        started = time.perf_counter()
        mover = self._require_mover()
        self._take_frame(mover, budget=FRAME_TIME * SHARE_OF_FRAME)
        if self._steps_left is not None:
            self._steps_left -= 1
            if self._steps_left <= 0 and self._moving:
                self._state = "paused"
        self._paint_all()
        now = time.perf_counter()
        if not self._moving or now - self._last_plot > PLOT_TIME:
            self._flush_plot()
        if not self._moving or now - self._last_stat > STAT_TIME:
            self._stat()
        spare = FRAME_TIME - (time.perf_counter() - started)
        if self._moving and spare > 0:
            time.sleep(spare)

    def _take_frame(self, mover: Mover, budget: float) -> None:
        """Move for the time between two frames, or as far as the budget allows."""
        before, began = mover.time, time.perf_counter()
        steps = mover.advance(FRAME_TIME, budget)
        took = time.perf_counter() - began
        if steps:
            self._step_ms = 1e3 * took / steps
        self._speed += 0.2 * ((mover.time - before) / max(took, FRAME_TIME) - self._speed)
        self._frame += 1
        positions = mover.positions()
        self._past.keep(self._frame, mover.time, positions)
        self._plots.record(mover, positions)
        if mover.state == "at-rest":
            self._state, self._sentence = "at-rest", at_rest(mover.time, mover.tolerance)
        elif mover.state == "diverged":
            self._state, self._wants_play = "diverged", False
            self._sentence = diverged(mover.time, mover.breakdown)

    def _to_present(self) -> None:
        if self._shown is not None:
            self._shown, self._state, self._sentence = None, "paused", ""

    def _find_rest(self) -> None:
        """Let a thread look for the state at rest; the engine goes on listening."""
        body = self._require_body()
        if body.refusal is not None:
            raise body.refusal
        self._stop_search()
        self._state, self._sentence, self._progress = "solving", "Looking for rest", 0.0
        self._search = RestSearch(body, self._factors(body), self._method, self)
        self._search.start()
        self._stat()

    def _stop_search(self) -> None:
        if self._search is not None:
            self._search.stop()
            self._search = None

    def searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        """Hear how far a search is."""
        self._inbox.put(lambda: self._searching(search, sentence, progress))

    def found(self, search: RestSearch, result: Result) -> None:
        """Hear what a search found."""
        self._inbox.put(lambda: self._found(search, result))

    def not_found(self, search: RestSearch, sentence: str) -> None:
        """Hear why a search found nothing."""
        self._inbox.put(lambda: self._not_found(search, sentence))

    def _searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        if search is self._search:
            self._sentence, self._progress = sentence, progress
            self._stat()

    def _found(self, search: RestSearch, result: Result) -> None:
        if search is not self._search:
            return
        self._search = None
        self._result, self._progress = result, None
        self._state = _STATES.get(result.status, "paused")
        self._sentence = (
            f"{result.message[:1].upper()}{result.message[1:]}, in {result.seconds:.2f} s."
        )
        mover = self._mover_or_none()
        if mover is not None:
            mover.go_to_rest(result.positions, result.residual, result.elastic_energy)
        self._frame += 1
        self._past.keep(self._frame, self._time, result.positions)
        if mover is None:
            self._shown = self._past.at(self._frame)
        self._forget_pictures()
        self._paint_all()
        self._stat()

    def _not_found(self, search: RestSearch, sentence: str) -> None:
        if search is self._search:
            self._search, self._progress = None, None
            self._halt("paused", sentence)

    # Pictures

    def _paint_all(self) -> None:
        for tab in self._outlet.tabs():
            self._paint(tab)

    def _forget_pictures(self) -> None:
        """Paint anew for every tab, though the frame has the number of the one before."""
        for tab in self._outlet.tabs():
            tab.painted = None

    def _paint(self, tab: Tab) -> None:
        """Pack what a tab shows, if it can take it and has not got it."""
        body, canvas, view = self._body, self._canvas, tab.view
        if body is None or canvas is None or not tab.hungry:
            return
        number = self._frame if self._shown is None else -self._shown.number
        key = (body.topology, number, view.field, view.mode, self._state)
        if tab.painted != key:
            tab.painted = key
            self._outlet.frame(tab, canvas.frame(self._moment, view.field, view.mode, tab.seq))

    @property
    def _moment(self) -> Moment:
        shown = self._shown
        positions = None if shown is None else shown.positions.astype(np.float64)
        number = self._frame if shown is None else shown.number
        return Moment(number, self._flags(), self._time, self._mover, positions)

    def _flags(self) -> int:
        flags = 0 if self._moving else PAUSED
        if self._state == "diverged":
            flags |= DIVERGED
        return flags | AT_REST if self._state == "at-rest" else flags

    # Numbers

    @property
    def _time(self) -> float:
        if self._shown is not None:
            return self._shown.time
        return 0.0 if self._mover is None else self._mover.time

    def _flush_plot(self) -> None:
        if (news := self._plots.news()) is not None:
            self._outlet.tell(news)
        self._last_plot = time.perf_counter()

    def _stat(self) -> None:
        self._last_stat = time.perf_counter()
        self._outlet.tell(self._stat_event())

    def _stat_event(self) -> events.Stat:
        body, mover = self._body, self._mover
        return events.Stat(
            topology=0 if body is None else body.topology,
            state=self._state,
            sentence=self._sentence,
            time=self._time,
            step_ms=self._step_ms,
            substeps=0 if mover is None else mover.steps,
            real_time_factor=self._speed if self._moving else 0.0,
            residual=None if mover is None else mover.residual,
            elastic=None if mover is None else mover.elastic,
            kinetic=None if mover is None else mover.kinetic,
            frame=self._frame if self._shown is None else self._shown.number,
            first_frame=self._past.first,
            last_frame=self._past.last,
            frames_stored=len(self._past),
            bytes_stored=self._past.bytes,
            solver=self._method,
            progress=self._progress,
            loads=[] if body is None else body.load_values if mover is None else mover.loads,
            grabs=[] if mover is None else mover.grabs(),
        )

    def _factors(self, body: StudioBody) -> list[float]:
        """How many times as large as in the design each load is."""
        if self._mover is None:
            return [1.0] * len(body.setup.design.loads)
        return self._mover.factors

    def _require_canvas(self, vertex: int = 0) -> Canvas:
        """What draws the body, which must have a vertex on its surface."""
        body = self._require_body()
        if vertex >= len(body.surface.vertices):
            raise SimulationError("vertex", f"{vertex} is not on the surface")
        assert self._canvas is not None  # it comes with the body
        return self._canvas

    def _require_body(self) -> StudioBody:
        if self._body is None:
            raise SimulationError("view", "there is no body yet", "mend the design first")
        return self._body

    def _mover_or_none(self) -> Mover | None:
        body = self._body
        solvable = body is not None and body.refusal is None and Mover.can_move(body)
        if self._mover is None and body is not None and solvable:
            self._mover = Mover(body)
        return self._mover

    def _require_mover(self) -> Mover:
        body = self._require_body()
        if body.refusal is not None:
            raise body.refusal
        mover = self._mover_or_none()
        if mover is None:
            raise SimulationError(
                "play",
                "bodies with layers do not move over time yet",
                "look for rest, which works with layers",
            )
        return mover
