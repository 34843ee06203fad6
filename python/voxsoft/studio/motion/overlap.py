"""Events of a shown body that is in itself: depth and present place."""

from __future__ import annotations

import time
from typing import Final

from voxsoft.studio.bodies.overlap_event import overlap_of
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.event_bus import EventBus
from voxsoft.studio.protocol.tab import Tab

#: While time runs the body is looked over at most so often [s], and for at most this part of it.
EVERY: Final = 0.3
SHARE: Final = 0.05


class OverlapWatch:
    """Checks the shown body for overlap with itself, and reports it to the tabs.

    Parameters
    ----------
    playback
        The shown body.
    bus
        Bus of events.
    """

    def __init__(self, playback: Playback, bus: EventBus) -> None:
        self._playback, self._bus = playback, bus
        self._seen: tuple[int, int, bool] | None = None
        self._next = 0.0
        self._reported: events.Overlap | None = None

    def look(self) -> None:
        """Check the shown state, unless that was done, or time runs and it was just done."""
        playback, started = self._playback, time.perf_counter()
        body = playback.body
        if body is None or body.refusal is not None:
            return
        # The frames of a film come as fast as those of a body that moves.
        film = len(playback.moments) > 0 and playback.state == "past"
        if (playback.moving or film) and started < self._next:
            return
        key = (body.topology, playback.frame, playback.state == "past")
        if key == self._seen:
            return
        self._seen = key
        positions = playback.require_canvas().positions(playback.player)
        found = overlap_of(body.setup.design, body.setup.mesh, positions, body.topology)
        ended = time.perf_counter()
        self._next = ended + max(EVERY, (ended - started) / SHARE)
        # A body that is not in itself is told of once.
        before = self._reported
        if before is None or before.topology != found.topology or before.places or found.places:
            self._reported = found
            self._bus.publish(found)

    def leave(self) -> None:
        """Forget the body that was shown."""
        self._seen = self._reported = None

    def send_snapshot(self, tab: Tab) -> None:
        """Send a new tab the events that the others have."""
        if self._reported is not None:
            self._bus.send_to(tab, self._reported)
