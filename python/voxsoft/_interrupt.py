"""Ctrl-C that no library swallows."""

from __future__ import annotations

import signal
import threading
from contextlib import AbstractContextManager
from types import FrameType, TracebackType


class Interrupts(AbstractContextManager["Interrupts"]):
    """Remembers a Ctrl-C, so that a loop can stop even where its exception was lost.

    Python raises :class:`KeyboardInterrupt` wherever the main thread happens to be. Inside the
    serializers of pydantic-core it disappears, as a union that fails to write one member tries the
    next, or becomes an error of another kind. Long loops therefore ask
    :meth:`stop_if_interrupted` in each turn.

    Only the main thread can receive signals, and a handler of the caller's own is left in place;
    in both cases this object does nothing.
    """

    def __init__(self) -> None:
        self._seen = False
        self._installed = False

    def __enter__(self) -> Interrupts:
        """Start to remember."""
        own_thread = threading.current_thread() is threading.main_thread()
        if own_thread and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._remember)
            self._installed = True
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Put the handler of before back; an interrupt that was lost or disguised is raised."""
        if self._installed:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if not isinstance(error, KeyboardInterrupt):
            self.stop_if_interrupted()

    def stop_if_interrupted(self) -> None:
        """Raise :class:`KeyboardInterrupt` if Ctrl-C came since the start."""
        if self._seen:
            raise KeyboardInterrupt

    def _remember(self, number: int, frame: FrameType | None) -> None:
        self._seen = True
        signal.default_int_handler(number, frame)
