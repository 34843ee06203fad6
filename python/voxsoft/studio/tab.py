"""One tab of a browser: what waits to be sent to it, and how much it can take."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass, field
from typing import Final, Protocol

from voxsoft.studio import events
from voxsoft.studio.commands import View
from voxsoft.studio.protocol import CREDITS, encode

#: Messages that wait for a tab before it is cut off; it comes back and gets all anew.
LONGEST_QUEUE: Final = 5_000
#: Rows of a plot that wait in one message.
MOST_ROWS: Final = 20_000
#: Code by which a websocket says "try again later".
TRY_AGAIN: Final = 1013


class Socket(Protocol):
    """What a tab needs of a websocket."""

    async def send_text(self, data: str) -> None:
        """Send text."""
        ...

    async def send_bytes(self, data: bytes) -> None:
        """Send bytes."""
        ...

    async def close(self, code: int = 1000, reason: str | None = None) -> None:
        """Close it."""
        ...


@dataclass(eq=False)
class Tab:
    """A websocket with its queue.

    Frames need credits, of which an `ack` returns one; the newest frame takes the place of one that
    waits. Everything else is sent in order, and what only repeats itself is merged while it waits.

    Attributes
    ----------
    socket
        The websocket.
    view
        What the tab shows.
    credits
        Frames that may still be sent.
    seq
        The last command of this tab.
    painted
        What the last frame showed, so that the same is not packed twice.
    """

    socket: Socket
    view: View = field(default_factory=lambda: View(seq=0))
    credits: int = CREDITS
    seq: int = 0
    closed: bool = False
    painted: object = None
    _queue: deque[events.Event | bytes] = field(default_factory=deque)
    _frame: bytes | None = None
    _wake: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def hungry(self) -> bool:
        """Whether a frame that is packed now would be sent at once."""
        return self.credits > 0 and self._frame is None and self.view.visible and not self.closed

    def put(self, event: events.Event) -> None:
        """Queue an event."""
        last = self._queue[-1] if self._queue else None
        if isinstance(event, events.Stat) and isinstance(last, events.Stat):
            self._queue[-1] = event
        elif (
            isinstance(event, events.Plot)
            and isinstance(last, events.Plot)
            and not event.clear
            and last.topology == event.topology
            and len(last.rows) < MOST_ROWS
        ):
            self._queue[-1] = events.Plot(
                topology=last.topology,
                names=event.names,
                units=event.units,
                rows=[*last.rows, *event.rows],
                clear=last.clear,
            )
        else:
            self._queue.append(event)
        self._wake.set()

    def put_topology(self, packed: bytes) -> None:
        """Queue a topology; frames of the one before are of no use any more."""
        self._frame = None
        self._queue.append(packed)
        self._wake.set()

    def put_smooth(self, packed: bytes) -> None:
        """Queue a smooth surface, which goes beside the frames."""
        self._queue.append(packed)
        self._wake.set()

    def put_frame(self, packed: bytes) -> None:
        """Offer a frame; it takes the place of one that waits."""
        self._frame = packed
        self._wake.set()

    def ack(self) -> None:
        """Take a credit back; a tab never has more than it began with."""
        self.credits = min(self.credits + 1, CREDITS)
        self._wake.set()

    async def pump(self) -> None:
        """Send until the socket is closed."""
        while not self.closed:
            await self._wake.wait()
            self._wake.clear()
            if len(self._queue) > LONGEST_QUEUE:
                self.closed = True
                await self.socket.close(TRY_AGAIN, "the tab does not keep up")
                return
            while self._queue:
                waiting = self._queue.popleft()
                if isinstance(waiting, bytes):
                    await self.socket.send_bytes(waiting)
                else:
                    await self.socket.send_text(encode(waiting))
            if self._frame is not None and self.credits > 0:
                frame, self._frame = self._frame, None
                self.credits -= 1
                await self.socket.send_bytes(frame)
