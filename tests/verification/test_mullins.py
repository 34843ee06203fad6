"""Rubber that softens where it was stretched more before: cycles against the closed form."""

from itertools import pairwise

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import VoxSoftError
from voxsoft.materials import Mullins, cycled_stress
from voxsoft.materials.homogeneous import principal_stretches
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.outputs.html import page_of
from voxsoft.units import kPa, mm

SIDE = 4 * mm
SOFT = Mullins(r=1.6, m=1 * kPa, beta=0.1)
#: Poisson's ratio of the blocks: K/μ is 5000, as in test_statics.
RUBBERS = {
    "yeoh": vs.Yeoh(c=(10 * kPa, 1 * kPa, 0.2 * kPa), poisson=0.4999, mullins=SOFT),
    "ogden": vs.Ogden(mu=(20 * kPa, 3 * kPa), alpha=(1.5, 4.0), poisson=0.4999, mullins=SOFT),
}


def block(material):
    """A block of eight voxels that is pulled along x by its far face."""
    slides = [vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"]
    pull = vs.Clamp(
        region=vs.Region(x=(SIDE, SIDE)), axes="x", motion=vs.Motion(displacement=(SIDE, 0.0, 0.0))
    )
    return vs.Design(
        name="block",
        voxel_size=SIDE / 2,
        parts=[vs.Part(shape=vs.Box(size=(SIDE,) * 3), material=material)],
        clamps=[*slides, pull],
    )


def pulled(material, strains):
    """Follow strains one after the other; the path, and the stress at each."""
    path = vs.follow(
        block(material),
        "clamps[3].motion.displacement[0]",
        [float(SIDE * strain) for strain in strains],
    )
    assert path.status == "ok", path.message
    far = path.results[0].mesh.vertices[:, 0] > SIDE - 1e-9
    return path, np.array([each.reactions[far, 0].sum() / SIDE**2 for each in path.results])


def way(*turns, steps=6):
    """Strains from turn to turn, all of them among these."""
    parts = [np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(turns)]
    return np.concatenate([[turns[0]], *parts])


def tolerance(material, stress):
    """Volume, and with it areas and energies, change by about stress/K.

    The stress changes by twice that at most (see test_statics), and by as much again for each part
    that ``η`` does for the same part of the energy, which is 1/(r s) W/η < 3 here.
    """
    return 8.0 * np.abs(stress).max() ** 2 / material.bulk


@pytest.mark.parametrize("model", RUBBERS)
def test_two_cycles_have_the_stress_of_the_closed_form(model):
    material = RUBBERS[model]
    strains = way(0.0, 0.5, 0.0, 0.5, 0.8, 0.2)
    _, stress = pulled(material, strains)
    expected = cycled_stress(material, 1.0 + strains)
    assert stress == pytest.approx(expected, abs=tolerance(material, expected))
    # The second way up is the first way down, to the last state that was taken at each.
    up, down = stress[12:19], stress[6:13][::-1]
    assert up == pytest.approx(down, abs=1e-6 * stress.max())
    virgin = cycled_stress(material.model_copy(update={"mullins": None}), 1.0 + strains)
    assert stress[:7] == pytest.approx(virgin[:7], abs=tolerance(material, virgin))
    assert np.all(stress[7:12] < 0.8 * virgin[7:12])


def test_the_work_of_a_cycle_equals_the_loss_by_softening():
    material = RUBBERS["yeoh"]
    strains = way(0.0, 0.6, 0.0, steps=24)
    path, stress = pulled(material, strains)
    work = float(np.trapezoid(stress, strains))
    peak = float(material.energy(principal_stretches("uniaxial", 1.6)))
    # The trapezoidal rule on 24 steps is good to h² f''/12, a part in a thousand here.
    assert work == pytest.approx(SOFT.lost(peak), rel=5e-3)
    assert work > 0.0
    assert path.results[-1].elastic_energy == pytest.approx(0.0, abs=1e-6 * peak * SIDE**3)
    # The way back returns the energy stored at the peak.
    stored = path.results[24].elastic_energy / SIDE**3
    assert stored == pytest.approx(peak - SOFT.lost(peak), rel=2e-3)
    assert path.results[24].peaks == pytest.approx(np.full(8, peak), rel=2e-3)


def test_preconditioned_rubber_begins_on_the_way_back():
    material = RUBBERS["yeoh"]
    used = Mullins(r=1.6, m=1 * kPa, beta=0.1, preconditioned="60 %")
    conditioned = material.model_copy(update={"mullins": used})
    strains = way(0.0, 0.6, 0.8)
    _, stress = pulled(conditioned, strains)
    expected = cycled_stress(conditioned, 1.0 + strains)
    assert stress == pytest.approx(expected, abs=tolerance(conditioned, expected))
    back = cycled_stress(material, 1.0 + np.append(0.6, strains))[1:]
    assert expected == pytest.approx(back, rel=1e-12)


@pytest.mark.slow
def test_a_chamber_softens_on_its_first_inflation():
    finger = families.pneunet(chambers=2).with_values(
        'parts.0.material={model="yeoh", c=["12 kPa", "1 kPa", "0 kPa"]}'
    )
    soft = finger.with_values("parts.0.material.mullins={r=1.4, m='10 Pa', beta=0.05}")
    way = "loads[0].value=0..4..0..4 kPa/13"
    lifts = {}
    for name, design in (("plain", finger), ("soft", soft)):
        path = vs.follow(design, way)
        assert path.status == "ok", path.message
        lifts[name] = np.array(path.columns["tip.z"][1])
    size = np.abs(lifts["plain"]).max()
    plain, found = lifts["plain"], lifts["soft"]
    # Without softening the way back is the way there, to the tolerance of the equilibria.
    assert plain[:5] == pytest.approx(plain[4:9][::-1], abs=1e-4 * size)
    # Up to 4 kPa no voxel has had more: the first way is that of the virgin rubber.
    assert found[:5] == pytest.approx(plain[:5], abs=5e-3 * size)
    assert np.all(np.abs(found[5:8]) > 1.02 * np.abs(found[1:4][::-1]))
    assert found[8:] == pytest.approx(found[4:9][::-1], abs=5e-3 * size)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"solver": vs.Solver(method="relaxation")}, "mullins: is known to statics"),
        ({"solver": vs.Solver(method="xpbd", end_time="1 s")}, "mullins: is known to statics"),
    ],
)
def test_solvers_without_memory_refuse(change, message):
    with pytest.raises(VoxSoftError, match=message):
        vs.simulate(block(RUBBERS["yeoh"]).replace(**change))


def test_uses_without_softening_refuse_it():
    soft = block(RUBBERS["yeoh"])
    with pytest.raises(VoxSoftError, match="is not known to gradients"):
        vs.gradient(vs.simulate(soft), "elastic_energy", "clamps.3.motion.displacement.0")


def test_the_studio_solves_it_and_does_not_play_it():
    body = StudioBody.of(block(RUBBERS["yeoh"]), rev=0, topology=0)
    assert body.refusal is None
    assert "softening" in body.not_live
    with pytest.raises(VoxSoftError, match="is not known to exported pages"):
        page_of(block(RUBBERS["yeoh"]))
