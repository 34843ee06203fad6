"""What an activation is: a part that is longer or shorter by itself, now and over time."""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple, Self

from voxsoft.design.history import History
from voxsoft.design.operands import Name
from voxsoft.design.profile import Profile
from voxsoft.records import Record


class Growth(NamedTuple):
    """How a free stretch changes over time: a power of what is linear between instants.

    Attributes
    ----------
    times
        Instants in s, rising.
    bases
        What the power is taken of at each of them, above zero.
    power
        1 of a length, 1/3 of a volume.
    profile
        How much of it each place has; None: all of it.
    """

    times: tuple[float, ...]
    bases: tuple[float, ...]
    power: float
    profile: Profile | None = None

    @property
    def last(self) -> float:
        """The stretch at the end, where the profile is one."""
        return float(self.bases[-1] ** self.power)

    @property
    def at_the_end(self) -> Growth:
        """What stays as it is at the end."""
        return self._replace(times=(0.0,), bases=self.bases[-1:])


class Activation(Record):
    """A part that acts by itself; a kind says what its value means."""

    part: Name
    history: History | None = None

    @property
    def of_fibers(self) -> bool:
        """Whether the fibers of the part alone are longer, and not what is around them."""
        return False

    @property
    @abstractmethod
    def growth(self) -> Growth | None:
        """How many times as long it is over time when it is free of stress; None: that stays."""

    @abstractmethod
    def share(self, part: float) -> Activation:
        """A part of what it comes to in the end, without a history."""

    def at(self, time: float) -> Self:
        """What stays as it is at a time in s."""
        if self.history is None:
            return self
        return self.replace(history=History(time=(0.0,), factor=(self.history.at(time),)))

    @property
    def factor(self) -> float:
        """The last factor of its history."""
        return 1.0 if self.history is None else self.history.factors[-1]

    @property
    def stretch(self) -> float:
        """How many times as long it is in the end when it is free of stress."""
        growth = self.growth
        return 1.0 if growth is None else growth.last
