"""Frames that were shown, kept for the scrubber up to a number of bytes."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.studio.events import GrabState

#: What all frames of a body may take together [bytes].
ROOM: Final = 128 * 1024 * 1024


@dataclass(frozen=True, eq=False)
class StoredFrame:
    """One frame: its number, its time in s, and the positions of all vertices in m, (n, 3).

    `loads` and `pulls` are those of that moment.
    """

    number: int
    time: float
    positions: NDArray[np.float32] = field(repr=False)
    loads: tuple[float, ...] = ()
    pulls: tuple[GrabState, ...] = ()


class Past:
    """The newest frames of a body; the oldest give way.

    Parameters
    ----------
    room
        What all frames may take together [bytes].

    Examples
    --------
    >>> past = Past(room=100)
    >>> for number in range(5):
    ...     past.keep(number, 0.1 * number, np.zeros((4, 3)))
    >>> past.first, past.last, len(past), past.bytes
    (3, 4, 2, 96)
    """

    def __init__(self, room: int = ROOM) -> None:
        self._room = room
        self._frames: deque[StoredFrame] = deque()
        self.bytes = 0

    def keep(
        self,
        number: int,
        time: float,
        positions: NDArray[np.float64],
        loads: Sequence[float] = (),
        pulls: Sequence[GrabState] = (),
    ) -> None:
        """Store a frame; numbers must grow by one."""
        moved = positions.astype(np.float32)
        frame = StoredFrame(number, time, moved, tuple(loads), tuple(pulls))
        self._frames.append(frame)
        self.bytes += frame.positions.nbytes
        while self.bytes > self._room and len(self._frames) > 1:
            self.bytes -= self._frames.popleft().positions.nbytes

    def at(self, number: int) -> StoredFrame | None:
        """The frame of a number, or the nearest that is still there; None if there is none."""
        if not self._frames:
            return None
        return self._frames[min(max(number - self.first, 0), len(self._frames) - 1)]

    def at_time(self, time: float) -> StoredFrame | None:
        """The frame nearest to a time [s]; None if there is none."""
        return min(self._frames, key=lambda frame: abs(frame.time - time), default=None)

    def cut_after(self, number: int) -> None:
        """Forget the frames after one, as time begins anew from there."""
        while self._frames and self._frames[-1].number > number:
            self.bytes -= self._frames.pop().positions.nbytes

    @property
    def first(self) -> int:
        """Number of the oldest frame, 0 if there is none."""
        return self._frames[0].number if self._frames else 0

    @property
    def last(self) -> int:
        """Number of the newest frame, 0 if there is none."""
        return self._frames[-1].number if self._frames else 0

    def __len__(self) -> int:
        return len(self._frames)
