"""Metrics of supplies: pressure, work, energy and efficiency."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from voxsoft.design.chamber import chosen_cavities
from voxsoft.design.fluid import ATMOSPHERE
from voxsoft.metrics.definition import Metric, State, Supplied, Target


def _pressure(state: State, target: Target) -> float:
    """Gauge pressure in the chamber, Pa; the highest of several, 0 (atmospheric) without any."""
    chosen = chosen_cavities(target.cavity, state.mesh, "cavity")
    return max((state.cavity_pressures[index] for index in chosen), default=0.0)


def _chosen(state: State, target: Target) -> Iterator[Supplied]:
    chosen = set(chosen_cavities(target.cavity, state.mesh, "cavity"))
    return (each for each in state.supplies if chosen & set(each.cavities))


def _work(state: State, target: Target) -> float:
    return sum(each.work for each in _chosen(state, target))


def _energy(state: State, target: Target) -> float:
    return sum(each.energy for each in _chosen(state, target))


def _efficiency(state: State, target: Target) -> float:
    energy = _energy(state, target)
    return _work(state, target) / energy if energy > 0.0 else 0.0


def _are_supplied(state: State) -> bool:
    return bool(state.supplies)


# Without slopes: pressures follow from volumes that depend on the varied parameters themselves.
CHAMBER_PRESSURE: Final = Metric(
    "chamber_pressure",
    "pressure",
    _pressure,
    None,
    # No gas is below vacuum.
    bounds=(-ATMOSPHERE, math.inf),
    takes=frozenset({"cavity"}),
    is_of=_are_supplied,
)
SUPPLIED_WORK: Final = Metric(
    "supplied_work", "energy", _work, None, takes=frozenset({"cavity"}), is_of=_are_supplied
)
SUPPLIED_ENERGY: Final = Metric(
    "supplied_energy", "energy", _energy, None, takes=frozenset({"cavity"}), is_of=_are_supplied
)
SUPPLY_EFFICIENCY: Final = Metric(
    "supply_efficiency",
    "number",
    _efficiency,
    None,
    takes=frozenset({"cavity"}),
    is_of=_are_supplied,
)
