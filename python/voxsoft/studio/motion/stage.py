"""The body on show: its motion, the search for its rest, and the events of both for the tabs."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.simulation import Modes, Result
from voxsoft.simulation.checks.check import CheckReport
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.equilibrium import Measurement
from voxsoft.studio.motion.overlap import OverlapWatch
from voxsoft.studio.motion.pictures import Pictures
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.motion.rest import RestSearch
from voxsoft.studio.motion.vibration import ModesSearch, Vibration
from voxsoft.studio.outputs.exports import Shown
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.event_bus import EventBus
from voxsoft.studio.protocol.tab import Tab

#: Part of the time of a frame that stepping may take; the rest is for packing and other threads.
SHARE_OF_FRAME: Final = 0.8


class Stage:
    """Everything that is shown. All is done on one thread, except where a method says otherwise.

    Parameters
    ----------
    bus
        Bus of events and frames.
    later
        Does a task on the thread of the stage; may be called by any thread.
    solved
        Called with each equilibrium that is found under the loads of the design.
    """

    def __init__(
        self,
        bus: EventBus,
        later: Callable[[Callable[[], None]], None],
        solved: Callable[[StudioBody, Result], None],
    ) -> None:
        self.bus = bus
        self.playback = Playback()
        self.pictures = Pictures(self.playback, bus)
        self.overlaps = OverlapWatch(self.playback, bus)
        self._later, self._solved = later, solved
        self._search: RestSearch | None = None
        self._equilibrium: events.Equilibrium | None = None
        self._past = False

    # The body

    def show(self, body: StudioBody, *, loaded: bool = False, known: Result | None = None) -> None:
        """Take another body, unloaded and at time zero, or in an equilibrium that is known.

        If it is to be shown `loaded` and its equilibrium is not known, a search for it begins.
        """
        self.stop_search()
        self._equilibrium, self._past = None, False
        again = self.playback.begin(body)
        self.pictures.begin(body)
        self.bus.publish(self.playback.plot())
        if again:
            self.playback.require_player().resume()
        self.painted()
        if not loaded or body.refusal is not None or self.playback.moving:
            return
        if known is None or self.playback.method != "auto":
            self.find_rest()
        else:
            self._come_to_rest(known)

    def leave(self) -> None:
        """Show no body any more."""
        self.stop_search()
        self._equilibrium, self._past = None, False
        self.playback.leave()
        self.pictures.leave()
        self.overlaps.leave()
        self.publish_stat()

    def wait_for_body(self) -> None:
        """Say that a body is being meshed, unless one is moving meanwhile."""
        self._leave_past()
        if not self.playback.moving and self._search is None:
            self.playback.doing, self.playback.sentence = "meshing", "Meshing"
            self.publish_stat()

    def stay(self, sentence: str) -> None:
        """Say why the body that was being meshed does not come."""
        if self._leave_past() or self.playback.doing == "meshing":
            self.playback.say(sentence)
            self.publish_stat()

    def publish_report(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        """Pass on the report of the checks of a body, if it is still the one that is shown."""
        if body is self.playback.body:
            self.pictures.examined(body, report, smooth)

    def forget(self) -> None:
        """Stop time, as another document is opened: the shown body is soon that of the past."""
        self.playback.let_go()
        self._past = self.playback.body is not None

    def _leave_past(self) -> bool:
        """Take away the body of another document, of which the next does not come at once."""
        past = self._past
        if past:
            self.leave()
        return past

    def send_snapshot(self, tab: Tab) -> None:
        """Show the present state to a new tab."""
        self.pictures.send_snapshot(tab)
        self.bus.send_to(tab, self.playback.complete(self.playback.stat()))
        self.overlaps.send_snapshot(tab)
        for event in (*self.playback.moments_event(), *self.playback.chambers_event()):
            self.bus.send_to(tab, event)
        newest = self.playback.newest_moment()
        if newest is not None:
            self.bus.send_to(tab, newest)
        if self._equilibrium is not None:
            self.bus.send_to(tab, self._equilibrium)
        if self.playback.vibration is not None:
            self.bus.send_to(tab, self.playback.vibration.event())

    # Time

    def play(self, command: commands.Play | commands.Step) -> None:
        """Let time run; the last command wins over a search that goes on."""
        reported = self.playback.do(command)
        self.stop_search()
        self.playback.result = None
        self.publish(reported)

    def touch(self, command: commands.Load | commands.Grab | commands.Release) -> None:
        """Change a load or a pull; a body at rest is so no more, and is shown at once."""
        playback = self.playback
        reported = playback.do(command)
        self.stop_search()
        playback.result = None
        self.pictures.forget()
        if not playback.moving:
            self.pictures.paint_all()
        self.publish(reported)

    def advance(self) -> None:
        """Take one frame, tell of it, and wait until the next is due."""
        started = time.perf_counter()
        frame = _core.FRAME_TIME
        if self.playback.swinging:
            self.pictures.paint_all()
            time.sleep(max(0.0, frame - (time.perf_counter() - started)))
            return
        reported = self.playback.advance(frame, budget=frame * SHARE_OF_FRAME)
        self.pictures.paint_all()
        self.overlaps.look()
        if self.playback.state == "at-rest":
            self.measure()
        self.publish(reported)
        spare = frame - (time.perf_counter() - started)
        if self.playback.moving and spare > 0:
            time.sleep(spare)

    # Rest

    def find_rest(self) -> None:
        """Let a thread look for the state at rest, and go on listening.

        Raises
        ------
        VoxSoftError
            There is no body, or it cannot be solved.
        """
        playback = self.playback
        body = playback.require_body()
        if body.refusal is not None:
            raise body.refusal
        self.stop_search()
        playback.begin_search("Solving for equilibrium")
        self._search = RestSearch(body, playback.factors, playback.method, self)
        self._search.start()
        self.publish_stat()

    def stop_search(self) -> None:
        """Give up the search that goes on, if one does."""
        if self._search is not None:
            self._search.stop()
            self._search = None
            self.playback.stop_doing()

    def searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        """Hear how far a search is, from its thread."""
        self._later(lambda: self._searching(search, sentence, progress))

    def found(self, search: RestSearch, result: Result) -> None:
        """Receive the result of a search, from its thread."""
        self._later(lambda: self._found(search, result))

    def not_found(self, search: RestSearch, sentence: str) -> None:
        """Hear why a search found nothing, from its thread."""
        self._later(lambda: self._not_found(search, sentence))

    def _searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        if search is self._search:
            self.playback.sentence, self.playback.progress = sentence, progress
            self.publish_stat()

    def _found(self, search: RestSearch, result: Result) -> None:
        if search is self._search:
            self._search = None
            self._come_to_rest(result)
            if search.as_designed and result.status == "ok":
                self._solved(self.playback.require_body(), result)

    def _come_to_rest(self, result: Result) -> None:
        reported = self.playback.go_to_rest(result)
        self.pictures.forget()
        self.painted()
        self.publish(reported)
        self.measure()

    def _not_found(self, search: RestSearch, sentence: str) -> None:
        if search is self._search:
            self._search = None
            self.halt(sentence)

    def cancel_search(self) -> bool:
        """Give up the search at the user's request, and say so; whether one went on."""
        if self._search is None:
            return False
        self.stop_search()
        self.halt("Canceled: the body is where it was")
        return True

    def estimate(self) -> None:
        """Look for the error bars of the equilibrium that is shown on voxels half as large.

        Raises
        ------
        SimulationError
            There is no equilibrium.
        """
        if self.playback.state != "at-rest":
            raise SimulationError("error bars", "are those of an equilibrium", "press Solve first")
        self.measure(finer=True)

    def shown_as(self, name: str, text: str) -> Shown:
        """Return the shown state with its numbers, for an export.

        Raises
        ------
        SimulationError
            There is no body.
        """
        shown, known = self.playback.shown_as(name, text), self._equilibrium
        if known is None or known.frame != self.playback.frame or shown.status != "ok":
            return shown
        return replace(shown, equilibrium=known)

    def measure(self, *, finer: bool = False) -> None:
        """Tell the numbers of the equilibrium that is shown, once they are known."""
        playback = self.playback
        body, shown = playback.require_body(), playback.shown_as("", "")

        def report(equilibrium: events.Equilibrium) -> None:
            self._later(lambda: self._measured(equilibrium))

        topology, frame = body.topology, playback.frame

        def is_shown() -> bool:
            now = playback.body
            return now is not None and (now.topology, playback.frame) == (topology, frame)

        Measurement(shown.measured, report, topology, frame, is_shown, finer=finer).start()

    def _measured(self, equilibrium: events.Equilibrium) -> None:
        body = self.playback.body
        if body is not None and equilibrium.topology == body.topology:
            self._equilibrium = equilibrium
            self.bus.publish(equilibrium)

    # Vibrations

    def vibrate(self, mode: int) -> None:
        """Draw the equilibrium in one of its natural vibrations, once they are known.

        Raises
        ------
        SimulationError
            There is no equilibrium, or no such mode.
        """
        playback = self.playback
        body, topology, frame = playback.body, playback.require_body().topology, playback.frame
        if playback.state != "at-rest":
            raise SimulationError("modes", "are those of an equilibrium", "press Solve first")
        known = playback.vibration
        if known is not None and (known.topology, known.frame) == (topology, frame):
            playback.vibration = known.with_mode(mode)
            self.bus.publish(playback.vibration.event())
            return
        self.bus.publish(events.Vibration(topology=topology, frame=frame, frequencies=[]))

        def is_shown() -> bool:
            now = playback.body is body and playback.state == "at-rest"
            return now and playback.frame == frame

        def begin(positions: NDArray[np.float64], found: Modes) -> None:
            if is_shown():
                vibration = Vibration(topology, frame, positions, found)
                playback.vibration = vibration.with_mode(min(mode, len(found.frequencies) - 1))
                self.bus.publish(playback.vibration.event())

        def fail(error: VoxSoftError) -> None:
            if is_shown():
                none = events.Vibration(topology=topology, frame=frame, frequencies=[])
                none.trouble, none.hint = f"{error.where}: {error.what}", error.hint
                self.bus.publish(none)

        ModesSearch(
            playback.shown_as("", "").measured,
            lambda positions, found: self._later(lambda: begin(positions, found)),
            lambda error: self._later(lambda: fail(error)),
        ).start()

    def stand_still(self) -> None:
        """Draw the equilibrium where it is."""
        playback = self.playback
        if playback.vibration is not None and playback.swinging:
            playback.vibration = playback.vibration.with_mode(None)
            self.bus.publish(playback.vibration.event())
            self.pictures.forget()
            self.pictures.paint_all()

    # Telling

    def halt(self, sentence: str) -> None:
        """Stop time, and say why."""
        self.playback.say(sentence, for_good=True)
        self.publish_stat()

    def painted(self) -> None:
        """Paint for every tab, and tell the numbers that go with it."""
        self.pictures.paint_all()
        self.publish_stat()
        self.overlaps.look()

    def publish(self, reported: Sequence[events.Event]) -> None:
        """Tell every tab."""
        for event in reported:
            self.bus.publish(self.playback.complete(event))

    def publish_stat(self) -> None:
        """Tell all numbers of the moment."""
        self.publish([self.playback.stat()])
