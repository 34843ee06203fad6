"""Pressure and mass of a supplied chamber, with the parts that the deformation of its walls makes.

A rigid wall leaves the gas the law of gases alone: a mass ``m`` at the temperature ``T`` in the
volume ``V`` has ``p V = m R T``, so that walls that give way by ``ΔV`` change the pressure from
``m R T/(V - ΔV)``.
"""

from __future__ import annotations

import math
from typing import Final

from voxsoft.comparison.number import Number
from voxsoft.design.fluid import ATMOSPHERE, Gas
from voxsoft.design.supply import MassSupply, VolumeSupply
from voxsoft.metrics.definition import NOT_NEGATIVE
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.fluids import ChamberState, Volume

#: Gauge pressure of a gas in any chamber.
_GAUGE: Final = (-ATMOSPHERE, math.inf)


def supplied_pressure(setup: Setup, state: ChamberState, number: int) -> Number:
    """Return the gauge pressure of a volume of gas or liquid, Pa.

    Parameters
    ----------
    setup
        The setup of the run.
    state, number
        The volume, and its number among those of the run.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import MassSupply
    >>> block = vs.Box(size=("12 mm",) * 3, corner=(0, 0, 0))
    >>> room = vs.Box(size=("4 mm",) * 3, corner=("4 mm",) * 3)
    >>> stiff = vs.NeoHookean(young="1 GPa", poisson=0.3)
    >>> vessel = vs.Design(
    ...     name="vessel",
    ...     voxel_size="4 mm",
    ...     parts=[vs.Part(shape=block - room, material=stiff)],
    ...     clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
    ...     supplies=[MassSupply(chamber=0, temperature="80 degC")],
    ... )
    >>> result = vs.simulate(vessel)
    >>> warm = supplied_pressure(vs.simulation.Setup.of(vessel), result.supplies[0], 0)
    >>> warm.deformed < 1e-3 * warm.value
    True
    """
    volume = _volume(setup, number)
    absolute = state.pressure + ATMOSPHERE
    rigid = 0.0
    if _is_closed(setup, volume) and isinstance(volume.medium, Gas):
        whole = _whole(setup, state, volume)
        before = whole - _growth(setup, state)
        rigid = absolute * whole / before - ATMOSPHERE if before > 0.0 else 0.0
    return Number.of(state.pressure, "pressure", rigid=rigid, bounds=_GAUGE)


def supplied_mass(setup: Setup, state: ChamberState, number: int) -> Number:
    """Return the mass of fluid in a volume, kg; parameters as those of :func:`supplied_pressure`.

    A closed one keeps its mass; into others more flows as the walls give way.
    """
    volume = _volume(setup, number)
    if _is_closed(setup, volume):
        return Number(state.mass, "mass", 0.0, NOT_NEGATIVE)
    density = state.mass / state.volume if state.volume > 0.0 else 0.0
    part = density * abs(_growth(setup, state))
    return Number(state.mass, "mass", min(part, abs(state.mass)), NOT_NEGATIVE)


def supplied_growth(setup: Setup, state: ChamberState, number: int) -> float:
    """Return the part of a volume that its walls decide, m³; parameters as above.

    In a closed one the law of the fluid limits it by the part of the pressure: walls around a
    liquid hold the volume of the stroke, however soft they are.
    """
    volume, growth = _volume(setup, number), abs(_growth(setup, state))
    if not _is_closed(setup, volume):
        return growth
    part = supplied_pressure(setup, state, number).deformed
    medium, absolute = volume.medium, state.pressure + ATMOSPHERE
    if not isinstance(medium, Gas):
        return min(growth, state.volume * part / medium.bulk_modulus)
    return min(growth, _whole(setup, state, volume) * part / absolute)


def _whole(setup: Setup, state: ChamberState, volume: Volume) -> float:
    """Compute the volume of a gas with that in lines and syringes by its law, m³.

    A temperature that is still on its way is taken as that of the end: the volume is off by their
    ratio then, and the part of the walls by as much of itself.
    """
    supply, medium = volume.supply, volume.medium
    assert supply is not None
    assert isinstance(medium, Gas)
    return state.mass * medium.gas_constant * supply.temperature / (state.pressure + ATMOSPHERE)


def _volume(setup: Setup, number: int) -> Volume:
    """Return a volume of a setup with supplies by its number."""
    assert setup.fluids is not None  # its result has supplies
    return setup.fluids.volumes[number]


def _is_closed(setup: Setup, volume: Volume) -> bool:
    """Return True if a volume keeps its fluid: nothing flows in by a line, a leak or a tube."""
    supply = volume.supply
    closed = isinstance(supply, (MassSupply, VolumeSupply)) and supply.leak is None
    return closed and not setup.design.connections


def _growth(setup: Setup, state: ChamberState) -> float:
    """Compute by how much the cavities of a volume have grown, m³."""
    return state.volume - sum(float(setup.mesh.cavities[i].volume) for i in state.cavities)
