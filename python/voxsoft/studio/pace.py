"""How fast time is shown: as fast as the clock, or so slow that a stiff body is seen to move."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Final

from voxsoft.studio.sentences import slowed
from voxsoft.studio.wire import PACES

#: A motion that lasts less than this on the screen is hardly seen [s].
SEEN: Final = 1.0
#: The span over which the real-time factor is measured [s].
SPAN: Final = 1.0


def pace_for(seconds: float) -> float:
    """The fastest pace at which a motion of some seconds lasts long enough to be seen.

    Examples
    --------
    >>> pace_for(3.0), pace_for(0.05), pace_for(1e-6)
    (1.0, 0.02, 0.005)
    """
    return next((pace for pace in PACES if seconds / pace >= SEEN), PACES[-1])


@dataclass
class Pace:
    """The pace in force: the user's, or what the motion asks for.

    Attributes
    ----------
    chosen
        What the user chose, or None for the automatic pace.
    rest_in
        The time in which the body comes to rest if nobody touches it, where that is known [s].
    """

    chosen: float | None = None
    rest_in: float | None = None

    @property
    def factor(self) -> float:
        """Simulated seconds for each second of the clock."""
        if self.chosen is not None:
            return self.chosen
        return 1.0 if self.rest_in is None else pace_for(self.rest_in)

    @property
    def words(self) -> str:
        """What to say of it; nothing in real time."""
        if self.factor == 1.0:
            return ""
        return slowed(self.factor, self.rest_in if self.chosen is None else None)


class RealTimeFactor:
    """Simulated over wall-clock time, measured over about the last second.

    Examples
    --------
    >>> factor = RealTimeFactor()
    >>> for tick in range(200):
    ...     factor.mark(simulated=0.02 * tick / 60, clock=tick / 60)
    >>> round(factor.value, 6)
    0.02
    """

    def __init__(self) -> None:
        self._marks: deque[tuple[float, float]] = deque()

    def restart(self) -> None:
        """Forget what was measured, as time begins to run or runs otherwise."""
        self._marks.clear()

    def mark(self, simulated: float, clock: float) -> None:
        """Note both times [s]."""
        self._marks.append((simulated, clock))
        while clock - self._marks[0][1] > SPAN:
            self._marks.popleft()

    @property
    def value(self) -> float:
        """The factor; 0 before anything was measured."""
        if len(self._marks) < 2:
            return 0.0
        (begun, start), (reached, now) = self._marks[0], self._marks[-1]
        return (reached - begun) / (now - start) if now > start else 0.0
