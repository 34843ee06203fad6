"""Base of activations: a part that is longer or shorter by itself, now and over time."""

from __future__ import annotations

from abc import abstractmethod
from typing import NamedTuple, Self

from voxsoft.design.history import History
from voxsoft.design.operands import Name
from voxsoft.design.profile import Profile
from voxsoft.records import Record


class Growth(NamedTuple):
    """Free stretch over time: a power of a base that is linear between instants.

    Attributes
    ----------
    times
        Instants in s, rising.
    bases
        Base of the power at each of them, above zero.
    power
        1 of a length, 1/3 of a volume.
    profile
        Profile over places; None: everywhere the same.
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
        """Constant growth with the final stretch."""
        return self._replace(times=(0.0,), bases=self.bases[-1:])


class Activation(Record):
    """A part that acts by itself; each kind gives its value a meaning."""

    part: Name
    history: History | None = None

    @property
    def of_fibers(self) -> bool:
        """True if only the fibers of the part are longer, and not the material around them."""
        return False

    @property
    @abstractmethod
    def growth(self) -> Growth | None:
        """Ratio by which it is longer over time when it is free of stress; None: that stays."""

    @abstractmethod
    def share(self, part: float) -> Activation:
        """Scale its final activation by a factor, without a history."""

    def at(self, time: float) -> Self:
        """Constant activation with the value of a time in s."""
        if self.history is None:
            return self
        return self.replace(history=History(time=(0.0,), factor=(self.history.at(time),)))

    @property
    def factor(self) -> float:
        """The last factor of its history."""
        return 1.0 if self.history is None else self.history.factors[-1]

    @property
    def stretch(self) -> float:
        """Ratio by which it is longer in the end when it is free of stress."""
        growth = self.growth
        return 1.0 if growth is None else growth.last
