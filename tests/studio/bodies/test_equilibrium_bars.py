"""Error bars of answers in the card of an equilibrium: load factors, pressures, reactions."""

import pytest

import voxsoft as vs
from voxsoft.comparison import error_bars
from voxsoft.design import MassSupply
from voxsoft.studio.bodies.equilibrium import equilibrium_of
from voxsoft.units import kPa, mm


def vessel(**entries):
    """A cube of 24 mm with a chamber of 16 mm, and walls of one voxel."""
    block = vs.Box(size=(24 * mm,) * 3, corner=(0, 0, 0))
    room = vs.Box(size=(16 * mm,) * 3, corner=(4 * mm,) * 3)
    return vs.Design(
        name="vessel",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=block - room, material=vs.NeoHookean(young=100 * kPa, poisson=0.45))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        **entries,
    )


def card_of(design):
    result = vs.simulate(design)
    bars = error_bars(result)
    return result, bars, equilibrium_of(result, 1, 2, bars)


@pytest.mark.long
def test_volume_control_shows_its_load_factor_and_pressure_with_bars():
    solver = vs.Solver(control="volume", volume_ratio=1.1)
    result, bars, card = card_of(vessel(loads=[vs.Pressure(value=5 * kPa)], solver=solver))
    (factor,) = (each for each in card.metrics if each.name == "load_factor")
    assert factor.value == result.load_factor
    assert factor.estimate == str(bars.load_factor)
    assert factor.share == pytest.approx(bars.load_factor.error / bars.load_factor.estimate)
    assert card.chambers[0].estimate == f"{bars.pressures[0]}, {bars.volumes[0]}"
    assert "±" in card.reactions[0].estimate or card.reactions[0].estimate.startswith("(0, 0, 0)")


def test_a_pressure_that_is_a_load_stands_without_a_bar():
    _, bars, card = card_of(vessel(loads=[vs.Pressure(value=1 * kPa)]))
    assert card.chambers[0].estimate == str(bars.volumes[0])
    assert all(each.name != "load_factor" for each in card.metrics)


def test_a_supply_shows_pressure_volume_and_mass_with_bars():
    _, bars, card = card_of(vessel(supplies=[MassSupply(chamber=0, temperature="60 degC")]))
    (supply,) = card.supplies
    found = bars.supplies[supply.name]
    assert supply.estimate == f"{found['pressure']}, {found['volume']}, {found['mass']}"
