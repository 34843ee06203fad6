"""Limits of the fluid laws in chambers and tubes: boiling liquids and turbulent flow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from voxsoft.design.fluid import ATMOSPHERE, Liquid
from voxsoft.design.supply import FlowSupply
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.setup.fluids import ChamberHistory, ChamberState, Fluids
from voxsoft.units import format_quantity

#: Vapor pressure of water at 20 °C [Pa]; other liquids of soft robots, oils and silicones, boil
#: below it.
VAPOR_PRESSURE: Final = 2339.0
#: Reynolds number up to which flow in tubes is laminar.
LAMINAR: Final = 2300.0


def doubtful_fluids(
    fluids: Fluids, states: Sequence[ChamberState], histories: Mapping[str, ChamberHistory]
) -> Iterator[Diagnostic]:
    """Warn of liquids that boil and of tubes whose flow is not laminar.

    Parameters
    ----------
    fluids
        The supplies of a design on its mesh.
    states, histories
        Final states of the volumes, and their histories by name.
    """
    for volume, state in zip(fluids.volumes, states, strict=True):
        history = histories.get(state.name)
        pressures = [state.pressure] if history is None else [*history.pressure, state.pressure]
        lowest = float(np.min(pressures)) + ATMOSPHERE
        if isinstance(volume.medium, Liquid) and lowest < VAPOR_PRESSURE:
            shown = format_quantity(float(f"{lowest:.3g}"), "pressure")
            what = f"draws the liquid down to {shown} absolute, where it boils or lets air out"
            yield Diagnostic("warning", volume.where, what, "draw out less, or wait longer")
        supply = volume.supply
        if not isinstance(supply, FlowSupply) or supply.tube is None:
            continue
        flows = [state.flow] if history is None else [*history.flow, state.flow]
        largest = float(np.abs(flows).max())
        reynolds = 4.0 * largest / (np.pi * supply.tube.diameter * volume.medium.viscosity)
        if reynolds > LAMINAR:
            what = (
                f"flows through its tube at a Reynolds number of up to {reynolds:,.0f}: above "
                f"{LAMINAR:,.0f} it is turbulent and slower than the law of Hagen and Poiseuille"
            )
            hint = "describe the tube by a valve with its measured conductance, or widen it"
            yield Diagnostic("warning", f"{volume.where}.tube", what, hint)
