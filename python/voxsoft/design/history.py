"""How a load or a motion changes over time."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise

from pydantic import Field, model_validator

from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Dimensionless, Time, to_si


class History(Record):
    """A factor over time, linear between the given instants and constant outside them.

    Parameters
    ----------
    time
        Instants, rising; at least one.
    factor
        What the load is multiplied by at each instant.

    Examples
    --------
    >>> ramp = History(time=("0 s", "1 s"), factor=(0, 1))
    >>> ramp.at(0.25), ramp.at(5.0)
    (0.25, 1.0)
    """

    time: tuple[Time, ...] = Field(min_length=1)
    factor: tuple[Dimensionless, ...] = Field(min_length=1)

    @model_validator(mode="after")
    def _check(self) -> History:
        if len(self.time) != len(self.factor):
            raise DesignError(
                "",
                f"has {len(self.time)} times and {len(self.factor)} factors",
                "give one factor for each time",
            )
        if any(later <= earlier for earlier, later in pairwise(self.time)):
            raise DesignError("time", "does not rise", "sort the instants and drop repeats")
        return self

    def at(self, time: float | str) -> float:
        """Return the factor at a time.

        Parameters
        ----------
        time
            The instant, in seconds or with its unit.
        """
        time = to_si(time, "time", "time")
        after = bisect_right(self.time, time)
        if after == 0:
            return self.factor[0]
        if after == len(self.time):
            return self.factor[-1]
        t0, t1 = self.time[after - 1 : after + 1]
        f0, f1 = self.factor[after - 1 : after + 1]
        return f0 + (f1 - f0) * (time - t0) / (t1 - t0)
