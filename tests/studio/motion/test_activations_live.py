"""Parts that grow by a history in the studio: time does not run for them, and they are solved."""

import pytest

import voxsoft as vs
from voxsoft.design import Dielectric, Profile, Swelling
from voxsoft.errors import DesignError, SimulationError
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.motion.playback import Playback
from voxsoft.studio.outputs.html import page_of
from voxsoft.studio.protocol import commands
from voxsoft.units import kPa, mm

RAMP = vs.History(time=("0 s", "1 s"), factor=(0, 1))


def block(activation):
    material = vs.NeoHookean(young=100 * kPa, poisson=0.3, density=1000.0)
    shape = vs.Box(size=(10 * mm, 10 * mm, 5 * mm))
    return vs.Design(
        name="block",
        voxel_size=5 * mm,
        parts=[vs.Part(name="gel", shape=shape, material=material)],
        activations=[activation],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
    )


def test_time_does_not_run_for_growth_by_a_history():
    growing = block(Swelling(part="gel", value=0.1, history=RAMP))
    playback = Playback()
    playback.begin(StudioBody.of(growing, 1, 1))
    assert "activations" in playback.body.event().not_live
    with pytest.raises(SimulationError, match="press Solve"):
        playback.do(commands.Play(seq=1))
    with pytest.raises(DesignError, match=r"activations\[0\].history: is not followed by exported"):
        page_of(growing)


def test_time_runs_for_grown_bodies_and_for_fields():
    assert StudioBody.of(block(Swelling(part="gel", value=0.1)), 1, 1).not_live == ""
    sheet = Dielectric(part="gel", value=1e6, permittivity=2.8, normal=(0, 0, 1), history=RAMP)
    assert StudioBody.of(block(sheet), 1, 1).not_live == ""


def test_time_runs_for_a_profile_but_not_beside_contact_and_no_page_has_it():
    bent = block(Swelling(part="gel", value=0.1, profile=Profile(expression="z / 0.005")))
    assert StudioBody.of(bent, 1, 1).not_live == ""
    on_floor = bent.replace(floor={"z": -0.001}, contact={})
    assert "profiles" in StudioBody.of(on_floor, 1, 1).not_live
    with pytest.raises(DesignError, match=r"activations\[0\].profile: is not known to exported"):
        page_of(bent)
