"""One tab of a browser: its queue, and the frames that it can take."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final, Protocol

from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.codec import encode
from voxsoft.studio.protocol.commands import View
from voxsoft.studio.protocol.wire import CREDITS, CloseCode

#: Messages that wait for a tab before it is cut off; it comes back and gets all anew.
LONGEST_QUEUE: Final = 5_000
#: Rows of a plot that wait in one message.
MOST_ROWS: Final = 20_000
#: Places in a binary message of its kind with its flags, and of the number of its body.
_KIND, _BODY = slice(4, 6), slice(8, 12)
#: Events that tell all of something: a newer one makes those that wait useless.
_STATES: Final = (events.Document, events.Ghosts, events.Body, events.Runs, events.Stat)


class Socket(Protocol):
    """Methods of a websocket that a tab needs."""

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
    waits. Everything else is sent in order. Waiting events give way to newer ones of their kind, or
    are joined with them, so that a tab that reads slowly costs little memory; one that reads
    nothing is cut off.

    Attributes
    ----------
    socket
        The websocket.
    view
        View of the tab.
    credits
        Frames that may still be sent.
    greeted
        True from its snapshot on. Frames before it would go to a page that cannot acknowledge them
        yet, and their credits would be lost.
    seq
        The last command of this tab.
    painted
        Content of the last frame, so that the same is not packed twice.
    """

    socket: Socket
    view: View = field(default_factory=lambda: View(seq=0))
    credits: int = CREDITS
    greeted: bool = False
    seq: int = 0
    closed: bool = False
    painted: object = None
    _queue: deque[events.Event | bytes] = field(default_factory=deque)
    _frame: bytes | None = None
    _wake: asyncio.Event = field(default_factory=asyncio.Event)
    _closing: asyncio.Future[None] | None = None

    @property
    def ready(self) -> bool:
        """True if a frame that is packed now would be sent at once."""
        takes_frames = self.greeted and self.view.visible and not self.closed
        return takes_frames and self.credits > 0 and self._frame is None

    def put(self, event: events.Event) -> None:
        """Queue an event."""
        if isinstance(event, events.Bare):
            self._frame = None
            self._forget(lambda waiting: isinstance(waiting, (bytes, events.Body)))
        if isinstance(event, _STATES):
            self._forget(lambda waiting: type(waiting) is type(event))
        if not (isinstance(event, events.Plot) and self._joined(event)):
            self._queue.append(event)
        self._woken()

    def put_topology(self, packed: bytes) -> None:
        """Queue a topology; frames and shapes of the one before are of no use any more."""
        self._frame = None
        self._forget(lambda waiting: isinstance(waiting, bytes) and not _beside(waiting, packed))
        self._queue.append(packed)
        self._woken()

    def put_smooth(self, packed: bytes) -> None:
        """Queue a smooth surface, which goes beside the frames."""
        self._queue.append(packed)
        self._woken()

    def put_frame(self, packed: bytes) -> None:
        """Offer a frame; it takes the place of one that waits."""
        self._frame = packed
        self._wake.set()

    def _forget(self, old: Callable[[events.Event | bytes], bool]) -> None:
        """Drop waiting messages that have been overtaken."""
        if any(map(old, self._queue)):
            self._queue = deque(waiting for waiting in self._queue if not old(waiting))

    def _joined(self, event: events.Plot) -> bool:
        """Add rows to those that wait already; whether that could be done."""
        for at in reversed(range(len(self._queue))):
            waiting = self._queue[at]
            if isinstance(waiting, events.Plot):
                same = not event.clear and waiting.topology == event.topology
                if not same or len(waiting.rows) >= MOST_ROWS:
                    return False
                self._queue[at] = events.Plot(
                    topology=event.topology,
                    names=event.names,
                    units=event.units,
                    rows=[*waiting.rows, *event.rows],
                    clear=waiting.clear,
                )
                return True
        return False

    def _woken(self) -> None:
        """Let the pump send, or cut the tab off if too much waits: the pump may be stuck."""
        self._wake.set()
        if self.closed:
            self._queue.clear()
        elif len(self._queue) > LONGEST_QUEUE:
            self.closed = True
            self._queue.clear()
            self._closing = asyncio.ensure_future(
                self.socket.close(CloseCode.TRY_AGAIN, "the tab does not keep up")
            )

    def ack(self) -> None:
        """Take a credit back; a tab never has more than it began with."""
        self.credits = min(self.credits + 1, CREDITS)
        self._wake.set()

    async def pump(self) -> None:
        """Send until the socket is closed."""
        while not self.closed:
            await self._wake.wait()
            self._wake.clear()
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


def _beside(waiting: bytes, topology: bytes) -> bool:
    """True if a message is of the body of a topology, and of another kind or display."""
    return waiting[_BODY] == topology[_BODY] and waiting[_KIND] != topology[_KIND]
