"""The thread that moves the body in real time and packs what the tabs see."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from functools import singledispatchmethod
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.simulation import Result, simulate
from voxsoft.simulation.check import CheckReport
from voxsoft.studio import commands, events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.catalog import FIELDS
from voxsoft.studio.exports import Shown
from voxsoft.studio.frames import AT_REST, DIVERGED, PAUSED, pack_points, value_at
from voxsoft.studio.mover import Mover
from voxsoft.studio.outlet import Outlet
from voxsoft.studio.past import Past, StoredFrame
from voxsoft.studio.sentences import at_rest, diverged
from voxsoft.studio.surface import ShrunkTets, pack_tets
from voxsoft.studio.tab import Tab

#: Time between two frames [s].
FRAME_TIME: Final = 1.0 / 60.0
#: Part of it that stepping may take; the rest is for packing and for other threads.
SHARE_OF_FRAME: Final = 0.8
#: Time between two statistics, and between two batches of rows for the plots [s].
STAT_TIME: Final = 0.1
PLOT_TIME: Final = 1.0 / 15.0
#: Rows of the plots that are kept for a tab that comes later.
MOST_ROWS: Final = 5_000


_STATES: Final[dict[str, events.SimulationState]] = {"ok": "at-rest", "diverged": "diverged"}


class _StoppedError(Exception):
    """The search for rest was given up because something else was asked."""


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
        self._probes: list[tuple[str, NDArray[np.uint32], NDArray[np.float64]]] = []
        self._rows: list[list[float | None]] = []
        self._fresh: list[list[float | None]] = []
        self._tets: ShrunkTets | None = None
        self._displays: dict[bool, _core.Display] = {}
        self._search = 0
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
        except Exception as error:
            self._halt("paused", f"{type(error).__name__}: {error}")

    def _halt(self, state: events.SimulationState, sentence: str) -> None:
        self._state, self._sentence, self._wants_play = state, sentence, False
        self._stat()

    def _show(self, body: StudioBody) -> None:
        before = self._body
        self._search += 1
        self._body, self._report, self._result, self._smooth = body, None, None, None
        self._mover, self._tets = None, None
        self._displays.clear()
        self._shown = None
        self._past, self._frame = Past(), 0
        self._rows, self._fresh = [], []
        self._probes = self._named_probes(body) + (
            [] if before is None else self._kept_probes(body, before)
        )
        self._state = "paused"
        self._sentence = "" if body.refusal is None else f"Cannot be solved: {body.refusal}"
        self._outlet.tell(body.event())
        self._outlet.topology(body.packed(), "surface")
        self._tell_tets()
        self._forget_pictures()
        self._tell_plot(clear=True)
        if self._wants_play:
            self._play()
        self._paint_all()
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
        body = self._body
        if body is not None:
            self._outlet.tell_one(tab, self._body_event(body))
            packed = self._packed_tets() if tab.view.mode == "tets" else body.packed()
            self._outlet.topology_for(tab, packed)
            if self._smooth is not None:
                self._outlet.smooth_for(tab, self._smooth)
            self._outlet.tell_one(tab, self._plot(self._rows, clear=True))
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
        if changed and self._body is not None:
            packed = self._body.packed() if command.mode == "surface" else self._packed_tets()
            self._outlet.topology_for(tab, packed)
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
        self._search += 1
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
        self._search += 1
        self._wants_play = False
        self._shown, self._result = None, None
        self._past, self._frame = Past(), 0
        self._rows, self._fresh = [], []
        if self._mover is not None:
            self._mover.reset()
        self._state = "paused" if self._body is not None else "empty"
        self._sentence, self._progress = "", None
        self._tell_plot(clear=True)
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
        if command.vertex >= len(body.surface.vertices):
            raise SimulationError("grab", f"vertex {command.vertex} is not on the surface")
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
        self._search += 1
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
        self._outlet.tell_one(tab, self._picked(command.vertex))

    @_obey.register
    def _(self, command: commands.Probe, tab: Tab) -> None:
        body = self._require_body()
        if command.vertex >= len(body.surface.vertices):
            raise SimulationError("probe", f"vertex {command.vertex} is not on the surface")
        vertex = body.surface.vertices[command.vertex : command.vertex + 1]
        name = f"vertex {command.vertex}"
        self._probes = [each for each in self._probes if each[0] != name]
        self._probes.append((name, vertex, np.ones(1)))
        width = 4 + len(self._probes)
        # A curve that begins later has no values before.
        self._rows = [[*row, *[None] * (width - len(row))] for row in self._rows]
        self._fresh = []
        self._tell_plot(clear=True)

    def _shown_now(self, name: str, text: str) -> Shown:
        body = self._require_body()
        plot = self._plot(self._rows, clear=False)
        return Shown(
            name=name,
            text=text,
            body=body,
            positions=self._positions(body),
            result=self._result if self._shown is None else None,
            columns=plot.names,
            units=plot.units,
            rows=plot.rows,
            factors=[1.0] * len(body.setup.design.loads)
            if self._mover is None
            else self._mover.factors,
        )

    def _positions(self, body: StudioBody) -> NDArray[np.float64]:
        """Where the vertices are that are shown [m]."""
        if self._shown is not None:
            return self._shown.positions.astype(np.float64)
        return body.mesh.vertices if self._mover is None else self._mover.positions()

    # Time

    def _play(self) -> None:
        self._require_mover()
        self._search += 1
        self._result = None
        self._state, self._sentence, self._progress = "playing", "", None
        self._steps_left = None

    def _stirred(self) -> None:
        """Go on after a change of load or a grab, if time was running before it came to rest."""
        self._result = None
        self._forget_pictures()
        if self._state in ("at-rest", "solving"):
            self._search += 1
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
        self._past.keep(self._frame, mover.time, mover.positions())
        self._record(mover)
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
        self._search += 1
        search, method, outlet = self._search, self._method, self
        factors = [1.0] * len(body.setup.design.loads)
        if self._mover is not None:
            factors = self._mover.factors
        self._state, self._sentence, self._progress = "solving", "Looking for rest", None

        def tell(steps: int, _: float, residual: float) -> None:
            if outlet._search != search:
                raise _StoppedError
            outlet._inbox.put(lambda: outlet._searching(search, steps, residual))

        def look() -> None:
            try:
                setup = body.under(factors)
                found = simulate(setup, progress=tell, method=method, end_time=None)
                outlet._inbox.put(lambda: outlet._found(search, found))
            except _StoppedError:
                return
            except VoxSoftError as error:
                sentence = str(error)
                outlet._inbox.put(lambda: outlet._not_found(search, sentence))
            except Exception as error:
                sentence = f"{type(error).__name__}: {error}"
                outlet._inbox.put(lambda: outlet._not_found(search, sentence))

        threading.Thread(target=look, name="studio-rest", daemon=True).start()
        self._stat()

    def _searching(self, search: int, steps: int, residual: float) -> None:
        if search == self._search and self._state == "solving":
            self._sentence = (
                f"Looking for rest: step {steps:,}, residual {residual:.1e} of the load"
            )
            self._stat()

    def _found(self, search: int, result: Result) -> None:
        if search != self._search:
            return
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

    def _not_found(self, search: int, sentence: str) -> None:
        if search == self._search:
            self._progress = None
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
        body = self._body
        if body is None or not tab.hungry:
            return
        number = self._frame if self._shown is None else -self._shown.number
        key = (body.topology, number, tab.view.field, tab.view.mode, self._state)
        if tab.painted == key:
            return
        tab.painted = key
        tets = tab.view.mode == "tets"
        self._outlet.frame(tab, self._packed(body, tab.view.field, tets=tets, seq=tab.seq))

    def _packed(self, body: StudioBody, field: int, *, tets: bool, seq: int = 0) -> bytes:
        shown, mover = self._shown, self._mover
        number = self._frame if shown is None else shown.number
        flags, seq = self._flags(), seq & 0xFFFF_FFFF
        if body.refusal is not None:
            # Nothing moves what cannot be solved, and the core holds no such problem.
            rest = body.mesh.vertices
            points = self._shrunk(body).points(rest) if tets else rest[body.surface.vertices]
            return pack_points(
                points,
                np.zeros(len(points)),
                topology=body.topology,
                frame=number,
                time=0.0,
                seq=seq,
                field=field,
                flags=flags,
            )
        display = self._display_of(body, tets=tets)
        if shown is None and mover is not None:
            return mover.packed(number, field, seq, flags, display if tets else None)
        positions = self._positions(body)
        return display.pack_frame(
            positions,
            topology=body.topology,
            frame=number,
            field=field,
            seq=seq,
            flags=flags,
            time=self._time,
        )

    def _display_of(self, body: StudioBody, *, tets: bool) -> _core.Display:
        """What the core packs frames of, made once for each body."""
        if tets not in self._displays:
            size, problem = body.mesh.voxel_size or 0.0, body.setup.problem
            if tets:
                corners, tags = self._shrunk(body).corners, self._shrunk(body).tags
                self._displays[tets] = _core.Display.tets(problem, corners, tags[::4].copy(), size)
            else:
                triangles = body.mesh.triangles.astype(np.uint32)
                self._displays[tets] = _core.Display.surface(
                    problem, triangles, body.surface.tags, size
                )
        return self._displays[tets]

    def _flags(self) -> int:
        flags = 0 if self._moving else PAUSED
        if self._state == "diverged":
            flags |= DIVERGED
        return flags | AT_REST if self._state == "at-rest" else flags

    def _shrunk(self, body: StudioBody) -> ShrunkTets:
        if self._tets is None:
            self._tets = ShrunkTets.of(body.mesh, body.surface)
        return self._tets

    def _packed_tets(self) -> bytes:
        body = self._require_body()
        return pack_tets(self._shrunk(body), body.mesh, body.topology)

    def _tell_tets(self) -> None:
        if any(tab.view.mode == "tets" for tab in self._outlet.tabs()):
            self._outlet.topology(self._packed_tets(), "tets")

    # Numbers

    @property
    def _time(self) -> float:
        if self._shown is not None:
            return self._shown.time
        return 0.0 if self._mover is None else self._mover.time

    def _named_probes(
        self, body: StudioBody
    ) -> list[tuple[str, NDArray[np.uint32], NDArray[np.float64]]]:
        try:
            places = body.setup.places
        except VoxSoftError:
            return []
        return [(name, place.vertices, place.weights) for name, place in places.items()]

    def _kept_probes(
        self, body: StudioBody, before: StudioBody
    ) -> list[tuple[str, NDArray[np.uint32], NDArray[np.float64]]]:
        """Probes that were set by hand, where the new body has a vertex at the same place."""
        kept = []
        for name, vertices, weights in self._probes:
            if not name.startswith("vertex "):
                continue
            point = before.mesh.vertices[vertices[0]]
            drawn = body.mesh.vertices[body.surface.vertices]
            nearest = int(np.linalg.norm(drawn - point, axis=1).argmin())
            kept.append(
                (f"vertex {nearest}", body.surface.vertices[nearest : nearest + 1], weights)
            )
        return kept

    def _record(self, mover: Mover) -> None:
        body = self._require_body()
        positions, rest = mover.positions(), body.mesh.vertices
        moved = [
            float(np.linalg.norm(weights @ (positions[vertices] - rest[vertices])))
            for _, vertices, weights in self._probes
        ]
        row: list[float | None] = [mover.time, mover.residual, mover.elastic, mover.kinetic, *moved]
        self._rows.append(row)
        self._fresh.append(row)
        if len(self._rows) > MOST_ROWS:
            self._rows = self._rows[::2]

    def _flush_plot(self) -> None:
        if self._fresh:
            self._outlet.tell(self._plot(self._fresh, clear=False))
            self._fresh = []
        self._last_plot = time.perf_counter()

    def _tell_plot(self, *, clear: bool) -> None:
        self._outlet.tell(self._plot(self._rows, clear=clear))

    def _plot(self, rows: list[list[float | None]], *, clear: bool) -> events.Plot:
        names = ["time", "residual", "elastic energy", "kinetic energy"]
        return events.Plot(
            topology=0 if self._body is None else self._body.topology,
            names=[*names, *(name for name, _, _ in self._probes)],
            units=["s", "", "J", "J", *["m"] * len(self._probes)],
            rows=list(rows),
            clear=clear,
        )

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

    def _picked(self, shown: int) -> events.Picked:
        body = self._require_body()
        if shown >= len(body.surface.vertices):
            raise SimulationError("pick", f"vertex {shown} is not on the surface")
        vertex = int(body.surface.vertices[shown])
        positions = self._positions(body)
        rest, now = body.mesh.vertices[vertex], positions[vertex]
        values = []
        for field in FIELDS:
            value = None if body.refusal is not None else self._value(body, field.id, shown)
            values.append(
                events.Value(field=field.id, name=field.name, value=value, unit=field.unit)
            )
        return events.Picked(
            vertex=shown,
            rest=(float(rest[0]), float(rest[1]), float(rest[2])),
            position=(float(now[0]), float(now[1]), float(now[2])),
            values=values,
        )

    def _value(self, body: StudioBody, field: int, shown: int) -> float:
        """A field at a vertex of the surface, to the 16 bits of a frame."""
        return value_at(self._packed(body, field, tets=False), shown)

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
