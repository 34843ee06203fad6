"""The body on show: its motion, the search for its rest, and what the tabs are told of both."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from voxsoft.simulation import Result
from voxsoft.simulation.check import CheckReport
from voxsoft.studio import events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.equilibrium import Measurement
from voxsoft.studio.event_bus import EventBus
from voxsoft.studio.overlap import OverlapWatch
from voxsoft.studio.pictures import Pictures
from voxsoft.studio.playback import Playback
from voxsoft.studio.rest import RestSearch
from voxsoft.studio.tab import Tab

#: Time between two frames [s].
FRAME_TIME: Final = 1.0 / 60.0
#: Part of it that stepping may take; the rest is for packing and for other threads.
SHARE_OF_FRAME: Final = 0.8
#: Time between two statistics, and between two batches of rows for the plots [s].
STAT_TIME: Final = 0.1
PLOT_TIME: Final = 1.0 / 15.0


class Stage:
    """Everything that is shown. All is done on one thread, except where a method says otherwise.

    Parameters
    ----------
    bus
        Where events and frames go.
    later
        Does a task on the thread of the stage; may be called by any thread.
    """

    def __init__(self, bus: EventBus, later: Callable[[Callable[[], None]], None]) -> None:
        self.bus = bus
        self.playback = Playback()
        self.pictures = Pictures(self.playback, bus)
        self.overlaps = OverlapWatch(self.playback, bus)
        self._later = later
        self._search: RestSearch | None = None
        self._equilibrium: events.Equilibrium | None = None
        self._last_stat = self._last_plot = 0.0

    # The body

    def show(self, body: StudioBody, *, loaded: bool = False) -> None:
        """Take another body, unloaded and at time zero, and look for its rest where asked."""
        self.stop_search()
        self._equilibrium = None
        self.playback.begin(body)
        self.pictures.begin(body)
        self.bus.publish(self.playback.plots.whole())
        if self.playback.wants_play:
            self.playback.play()
        self.painted()
        if loaded and body.refusal is None and not self.playback.moving:
            self.find_rest()

    def wait_for_body(self) -> None:
        """Say that a body is being meshed, unless one is moving meanwhile."""
        if not self.playback.moving and self._search is None:
            self.playback.state, self.playback.sentence = "meshing", "Meshing"
            self.publish_stat()

    def stay(self, sentence: str) -> None:
        """Say why the body that was being meshed does not come."""
        playback = self.playback
        if playback.state == "meshing":
            playback.state = "empty" if playback.body is None else "paused"
            playback.sentence = sentence
            self.publish_stat()

    def publish_report(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        """Pass on what the checks report of a body, if it is still the one that is shown."""
        if body is self.playback.body:
            self.pictures.examined(body, report, smooth)

    def forget(self) -> None:
        """Stop time, as another document is opened."""
        self.playback.wants_play = False
        self.playback.let_go()
        if self.playback.moving:
            self.playback.state = "paused"

    def send_snapshot(self, tab: Tab) -> None:
        """Show a new tab what there is."""
        self.pictures.send_snapshot(tab)
        self.bus.send_to(tab, self.playback.stat())
        self.overlaps.send_snapshot(tab)
        if self._equilibrium is not None:
            self.bus.send_to(tab, self._equilibrium)

    # Time

    def play(self) -> None:
        """Let time run; what is asked last wins over a search that goes on."""
        self.playback.play()
        self.stop_search()

    def invalidate(self) -> None:
        """Go on after a change of load or a grab, if time was running before it came to rest."""
        playback = self.playback
        playback.touched()
        self.pictures.forget()
        if playback.state in ("at-rest", "solving"):
            self.stop_search()
            playback.state = "paused"
        if playback.wants_play and playback.state == "paused":
            self.play()
        if not playback.moving:
            self.pictures.paint_all()
        self.publish_stat()

    def advance(self) -> None:
        """Take one frame, tell of it, and wait until the next is due."""
        started = time.perf_counter()
        self.playback.take_frame(FRAME_TIME, budget=FRAME_TIME * SHARE_OF_FRAME)
        self.pictures.paint_all()
        self.overlaps.look()
        now, moving = time.perf_counter(), self.playback.moving
        if self.playback.state == "at-rest":
            self.measure()
        if not moving or now - self._last_plot > PLOT_TIME:
            self.publish_plot()
        if not moving or now - self._last_stat > STAT_TIME:
            self.publish_stat()
        spare = FRAME_TIME - (time.perf_counter() - started)
        if moving and spare > 0:
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
        playback.state, playback.sentence, playback.progress = (
            "solving",
            "Solving for equilibrium",
            0.0,
        )
        self._search = RestSearch(body, playback.factors, playback.method, self)
        self._search.start()
        self.publish_stat()

    def stop_search(self) -> None:
        """Give up the search that goes on, if one does."""
        if self._search is not None:
            self._search.stop()
            self._search = None

    def searching(self, search: RestSearch, sentence: str, progress: float) -> None:
        """Hear how far a search is, from its thread."""
        self._later(lambda: self._searching(search, sentence, progress))

    def found(self, search: RestSearch, result: Result) -> None:
        """Hear what a search found, from its thread."""
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
            self.playback.go_to_rest(result)
            self.pictures.forget()
            self.painted()
            self.publish_plot()
            self.measure()

    def _not_found(self, search: RestSearch, sentence: str) -> None:
        if search is self._search:
            self._search, self.playback.progress = None, None
            self.halt(sentence)

    def cancel_search(self) -> None:
        """Give up the search at the user's request, and say so."""
        if self._search is not None:
            self.stop_search()
            self.playback.state, self.playback.progress = "paused", None
            self.playback.sentence = "Canceled: the body is where it was"

    def measure(self) -> None:
        """Tell the numbers of the equilibrium that is shown, once they are known."""
        playback = self.playback
        body, shown = playback.require_body(), playback.shown_as("", "")

        def told(equilibrium: events.Equilibrium) -> None:
            self._later(lambda: self._measured(equilibrium))

        Measurement(shown.measured, told, body.topology, playback.frame).start()

    def _measured(self, equilibrium: events.Equilibrium) -> None:
        body = self.playback.body
        if body is not None and equilibrium.topology == body.topology:
            self._equilibrium = equilibrium
            self.bus.publish(equilibrium)

    # Telling

    def halt(self, sentence: str) -> None:
        """Stop time, and say why."""
        self.playback.halt("paused", sentence)
        self.publish_stat()

    def painted(self) -> None:
        """Paint for every tab, and tell the numbers that go with it."""
        self.pictures.paint_all()
        self.publish_stat()
        self.overlaps.look()

    def publish_plot(self) -> None:
        """Tell the rows of the plots that no tab has got yet."""
        if (news := self.playback.plots.news()) is not None:
            self.bus.publish(news)
        self._last_plot = time.perf_counter()

    def publish_stat(self) -> None:
        """Tell all numbers of the moment."""
        self._last_stat = time.perf_counter()
        self.bus.publish(self.playback.stat())
