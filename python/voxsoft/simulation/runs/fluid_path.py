"""Supplies along a path of designs, as one network with a history of each amount."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

from voxsoft import _core_data
from voxsoft.design import Design
from voxsoft.errors import DesignError
from voxsoft.simulation.setup.fluids import Fluids
from voxsoft.simulation.setup.setup import Setup

#: Numbers that may differ between designs: fluid mass, its temperature, the volume outside.
_AMOUNTS: Final = ("mass", "temperature", "outside")


@dataclass(frozen=True)
class FluidPath(Fluids):
    """Supplies of designs that differ in the amounts that these give.

    Attributes
    ----------
    design, mesh
        The first design, and the mesh of all.
    designs
        All designs, in the order of the path.
    instants
        The time in s that stands for each design, rising.
    key
        The key that changes, for errors.

    Raises
    ------
    DesignError
        Designs whose supplies differ in more, or that have histories.
    """

    designs: tuple[Design, ...] = field(kw_only=True)
    instants: tuple[float, ...] = field(kw_only=True)
    key: str = field(kw_only=True)

    @cached_property
    def network(self) -> _core_data.Network:
        """Network whose histories are those of the path."""
        networks = [Fluids(design, self.mesh).network for design in self.designs]
        fixed = [_without_amounts(network) for network in networks]
        if any(each != fixed[0] for each in fixed):
            raise DesignError(
                self.key,
                "changes more of supplies than how much they give",
                "vary a pressure, volume, mass or temperature; lines, leaks, pumps and histories "
                "stay",
            )
        chambers = [
            self._chamber_along(alike)
            for alike in zip(*(network["chambers"] for network in networks), strict=True)
        ]
        sources = [
            self._source([each["pressure"] for each in alike])
            for alike in zip(*(network["sources"] for network in networks), strict=True)
        ]
        return {**networks[0], "chambers": chambers, "sources": sources}

    def _chamber_along(self, alike: Sequence[_core_data.Chamber]) -> _core_data.Chamber:
        amounts = (
            [each["mass"][1] for each in alike],
            [each["temperature"][1] for each in alike],
            [each["outside"][1] for each in alike],
        )
        return {**alike[0], "path": [self._course(values) for values in amounts]}

    def _course(self, values: Sequence[float]) -> _core_data.Course:
        return [list(self.instants), list(values)]

    def _source(self, pressures: Sequence[float]) -> _core_data.Source:
        largest = max(pressures, key=abs)
        factors = [pressure / largest if largest else 0.0 for pressure in pressures]
        return {"pressure": largest, "history": self._course(factors)}


def _without_amounts(network: _core_data.Network) -> dict[str, Any]:
    def rest(entry: Mapping[str, Any], left_out: Sequence[str]) -> dict[str, Any]:
        return {key: value for key, value in entry.items() if key not in left_out}

    return {
        **network,
        "chambers": [rest(each, _AMOUNTS) for each in network["chambers"]],
        "sources": [rest(each, ("pressure",)) for each in network["sources"]],
    }


@dataclass(frozen=True, repr=False)
class SetupAlong(Setup):
    """A setup whose supplies go along a path."""

    along: FluidPath = field(kw_only=True)

    def __post_init__(self) -> None:
        """Skip the preparation: design and mesh are those of a setup."""

    @cached_property
    def fluids(self) -> Fluids | None:
        """Supplies of the path."""
        return self.along
