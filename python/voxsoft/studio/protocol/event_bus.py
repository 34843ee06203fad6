"""Bus on which the studio's threads put events and frames for the tabs."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.tab import Tab


class EventBus(Protocol):
    """Methods by which the engine and the jobs reach the tabs; any thread may call them."""

    def publish(self, event: events.Event) -> None:
        """Send an event to all tabs."""
        ...

    def send_to(self, tab: Tab, event: events.Event) -> None:
        """Send an event to one tab."""
        ...

    def topology(self, packed: bytes, mode: str) -> None:
        """Send a topology to the tabs that show the surface, or the tetrahedra."""
        ...

    def topology_for(self, tab: Tab, packed: bytes) -> None:
        """Send a topology to one tab."""
        ...

    def smooth_for(self, tab: Tab, packed: bytes) -> None:
        """Send a smooth surface to one tab."""
        ...

    def tabs(self) -> list[Tab]:
        """All tabs that are open."""
        ...

    def frame(self, tab: Tab, packed: bytes) -> None:
        """Offer a frame to a tab."""
        ...


class Tabs:
    """The tabs that are open, on the loop that serves them."""

    def __init__(self) -> None:
        self._open: list[Tab] = []
        self._loop: asyncio.AbstractEventLoop | None = None

    def join(self, tab: Tab) -> None:
        """Take in a tab; called on the loop."""
        self._loop = asyncio.get_running_loop()
        self._open = [*self._open, tab]

    def leave(self, tab: Tab) -> None:
        """Let a tab go; called on the loop."""
        self._open = [other for other in self._open if other is not tab]

    def tabs(self) -> list[Tab]:
        """All tabs that are open."""
        return self._open

    def publish(self, event: events.Event) -> None:
        """Send an event to all tabs."""
        for tab in self._open:
            self._soon(tab.put, event)

    def send_to(self, tab: Tab, event: events.Event) -> None:
        """Send an event to one tab."""
        self._soon(tab.put, event)

    def topology(self, packed: bytes, mode: str) -> None:
        """Send a topology to the tabs that show the surface, or the tetrahedra."""
        for tab in self._open:
            if tab.view.mode == mode:
                self._soon(tab.put_topology, packed)

    def topology_for(self, tab: Tab, packed: bytes) -> None:
        """Send a topology to one tab."""
        self._soon(tab.put_topology, packed)

    def smooth_for(self, tab: Tab, packed: bytes) -> None:
        """Send a smooth surface to one tab."""
        self._soon(tab.put_smooth, packed)

    def frame(self, tab: Tab, packed: bytes) -> None:
        """Offer a frame to a tab."""
        self._soon(tab.put_frame, packed)

    def _soon(self, call: Callable[..., Any], *arguments: Any) -> None:  # noqa: ANN401
        loop = self._loop
        if loop is None or loop.is_closed():
            return
        try:
            loop.call_soon_threadsafe(call, *arguments)
        except RuntimeError:  # the loop was closed between the question and the call
            return
