"""The pictures of a body that tabs are given: topologies once, frames as they can take them."""

from __future__ import annotations

from voxsoft.simulation.checks.check import CheckReport
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.event_bus import EventBus
from voxsoft.studio.protocol.tab import Tab


class Pictures:
    """Paints the shown body for every tab, each in its own view.

    Parameters
    ----------
    playback
        The shown body.
    bus
        Bus of events and frames.
    """

    def __init__(self, playback: Playback, bus: EventBus) -> None:
        self._playback = playback
        self._bus = bus
        self._report: CheckReport | None = None
        self._smooth: bytes | None = None

    def begin(self, body: StudioBody) -> None:
        """Give every tab another body, of which the checks have reported nothing yet."""
        self._report = self._smooth = None
        # The shape first: its report takes as long again.
        canvas = self._playback.require_canvas()
        for mode in {tab.view.mode for tab in self._bus.tabs()}:
            if mode == "tets":  # hands and tapes hold on to the surface, also where it is not drawn
                self._bus.topology(canvas.topology("surface"), mode)
            self._bus.topology(canvas.topology(mode), mode)
        self._bus.publish(body.event())
        self.forget()

    def leave(self) -> None:
        """Show every tab that there is no body."""
        self._report = self._smooth = None
        self._bus.publish(events.Bare())
        self.forget()

    def examined(self, body: StudioBody, report: CheckReport, smooth: bytes | None) -> None:
        """Pass on the report of the checks of the body, and its smooth surface if it has one."""
        self._report, self._smooth = report, smooth
        self._bus.publish(self._event(body))
        if smooth is not None:
            for tab in self._bus.tabs():
                self._bus.smooth_for(tab, smooth)

    def send_snapshot(self, tab: Tab) -> None:
        """Give a new tab all there is of the body; from now on it gets frames."""
        tab.greeted = True
        body, canvas = self._playback.body, self._playback.canvas
        if body is None or canvas is None:
            self._bus.send_to(tab, events.Bare())
            return
        self._bus.send_to(tab, self._event(body))
        if tab.view.mode == "tets":
            self._bus.topology_for(tab, canvas.topology("surface"))
        self._bus.topology_for(tab, canvas.topology(tab.view.mode))
        if self._smooth is not None:
            self._bus.smooth_for(tab, self._smooth)
        self._bus.send_to(tab, self._playback.plot())
        self.repaint(tab)

    def change_mode(self, tab: Tab) -> None:
        """Give a tab the topology of the mode that it has turned to."""
        if self._playback.canvas is not None:
            self._bus.topology_for(tab, self._playback.canvas.topology(tab.view.mode))

    def forget(self) -> None:
        """Paint anew for every tab, though the frame has the number of the one before."""
        for tab in self._bus.tabs():
            tab.painted = None

    def repaint(self, tab: Tab) -> None:
        """Paint for a tab, whatever it has already."""
        tab.painted = None
        self.paint(tab)

    def paint_all(self) -> None:
        """Paint for every tab."""
        for tab in self._bus.tabs():
            self.paint(tab)

    def paint(self, tab: Tab) -> None:
        """Pack the view of a tab, if it can take it and does not have it."""
        playback, view = self._playback, tab.view
        body, canvas = playback.body, playback.canvas
        if body is None or canvas is None or not tab.ready:
            return
        vibration = playback.vibration
        if vibration is not None and vibration.mode is not None:
            tab.painted = None
            frame = playback.frame
            self._bus.frame(
                tab, canvas.swung(vibration.now(), view.field, view.mode, tab.seq, frame)
            )
            return
        key = (body.topology, playback.frame, view.field, view.mode, playback.state)
        if tab.painted != key:
            tab.painted = key
            contact = playback.contact_fields.get(playback.frame)
            packed = canvas.frame(playback.player, view.field, view.mode, tab.seq, contact)
            self._bus.frame(tab, packed)

    def _event(self, body: StudioBody) -> events.Body:
        event = body.event(self._report)
        event.smooth = self._smooth is not None
        return event
