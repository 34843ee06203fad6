"""Options: facts about a file that it does not hold itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Options:
    """Facts about a file, as :func:`voxsoft.measured` takes them.

    Attributes
    ----------
    units
        Units by the name of a column.
    unit
        Unit of coordinates, where the file says none.
    rate
        Rows per second, where the file has no times.
    time
        Name of the column of the time.
    likelihood
        Least likelihood of a point that a network found.
    """

    units: Mapping[str, str] = field(default_factory=dict)
    unit: str = ""
    rate: float | None = None
    time: str | None = None
    likelihood: float = 0.6

    def unit_of(self, name: str, written: str) -> str:
        """Return the unit of a column: the given one, or that which the file has."""
        asked = {key.casefold(): unit for key, unit in self.units.items()}
        whole = name.casefold()
        given = asked.get(whole, asked.get(whole.rpartition("/")[2]))
        if given is not None:
            return given
        return written or (self.unit if whole.rpartition(" ")[2] in ("x", "y", "z") else "")
