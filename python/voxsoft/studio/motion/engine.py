"""The thread that moves the body in real time: it executes commands, and frames meanwhile."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from voxsoft.errors import SimulationError, VoxSoftError
from voxsoft.simulation import Result
from voxsoft.simulation.checks.check import CheckReport
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.execute import execute
from voxsoft.studio.motion.stage import Stage
from voxsoft.studio.outputs.exports import Shown
from voxsoft.studio.protocol import commands, events
from voxsoft.studio.protocol.event_bus import EventBus
from voxsoft.studio.protocol.tab import Tab

#: Commands beside which a natural vibration goes on.
_BESIDE = (
    commands.View,
    commands.Pick,
    commands.Probe,
    commands.Vibrate,
    commands.Estimate,
)


class Engine(threading.Thread):
    """Owns the stage; requests of other threads run on its own thread, one at a time.

    Parameters
    ----------
    bus
        Bus of events and frames.
    solved
        Called with each equilibrium that is found under the loads of the design.
    """

    def __init__(self, bus: EventBus, solved: Callable[[StudioBody, Result], None]) -> None:
        super().__init__(name="studio-engine", daemon=True)
        self._bus = bus
        self._inbox: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._stage = Stage(bus, self._inbox.put, solved)

    def run(self) -> None:
        """Execute requests, and move the body meanwhile, until the end."""
        while True:
            try:
                playback = self._stage.playback
                task = self._inbox.get(block=not (playback.moving or playback.swinging))
            except queue.Empty:
                task = self._stage.advance
            if task is None:
                return
            self._guarded(task)

    def end(self) -> None:
        """Stop the thread."""
        self._inbox.put(None)

    def show(self, body: StudioBody, *, loaded: bool = False, known: Result | None = None) -> None:
        """Take another body, unloaded or in a known equilibrium; look for it where asked."""
        self._inbox.put(lambda: self._stage.show(body, loaded=loaded, known=known))

    def leave(self) -> None:
        """Show no body any more, as the document has none."""
        self._inbox.put(self._stage.leave)

    def wait_for_body(self) -> None:
        """Say that a body is being meshed, unless one is moving meanwhile."""
        self._inbox.put(self._stage.wait_for_body)

    def stay(self, sentence: str) -> None:
        """Say why the body that was being meshed does not come."""
        self._inbox.put(lambda: self._stage.stay(sentence))

    def publish_report(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        """Pass on the report of the checks of a body, if it is still the one that is shown."""
        self._inbox.put(lambda: self._stage.publish_report(body, report, smooth))

    def forget(self) -> None:
        """Stop time, as another document is opened."""
        self._inbox.put(self._stage.forget)

    def send_snapshot(self, tab: Tab) -> None:
        """Show the present state to a new tab."""
        self._inbox.put(lambda: self._stage.send_snapshot(tab))

    def repaint(self, tab: Tab) -> None:
        """Give a tab that took a frame the picture as it is now, if it has changed since."""
        self._inbox.put(lambda: self._stage.pictures.paint(tab))

    def execute(self, command: commands.Command, tab: Tab) -> None:
        """Execute a command; a failure is reported to its tab."""

        def task() -> None:
            try:
                if not isinstance(command, _BESIDE):
                    self._stage.stand_still()
                execute(command, self._stage, tab)
            except VoxSoftError as error:
                reported = events.Error(
                    seq=command.seq, where=error.where, what=error.what, hint=error.hint
                )
                self._bus.send_to(tab, reported)

        self._inbox.put(task)

    def shown(self, name: str, text: str, seconds: float = 30.0) -> Shown:
        """Return the shown state, for an export; it is taken between two frames.

        Raises
        ------
        SimulationError
            There is no body, or the engine is too busy to answer.
        """
        answers: queue.SimpleQueue[Shown | VoxSoftError] = queue.SimpleQueue()

        def task() -> None:
            try:
                answers.put(self._stage.shown_as(name, text))
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

    def _guarded(self, task: Callable[[], None]) -> None:
        """Do a task; whatever goes wrong is said, and the thread lives on."""
        try:
            task()
        except VoxSoftError as error:
            self._stage.halt(str(error))
        except BaseException as error:  # a panic of the core too: the thread must live on
            self._stage.halt(f"{type(error).__name__}: {error}")
