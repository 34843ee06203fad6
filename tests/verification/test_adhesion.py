"""Adhesion beside its closed form: a plate that is pulled from a block."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Contact, Object
from voxsoft.design.contact import Adhesion, ContactPair
from voxsoft.errors import DesignError
from voxsoft.simulation import gradient, simulate
from voxsoft.studio.bodies.objects import not_live
from voxsoft.units import MPa, kPa, mm

SIDE = 8 * mm
STRENGTH, RANGE = 2 * kPa, 0.5 * mm
#: Gap from which contact counts, of voxels of 4 mm.
CLEARANCE = 2e-4 * 4 * mm
ADHESION = Adhesion(strength=STRENGTH, range=RANGE)


def pulled(lift, contact=None, **changes):
    """A stiff block without lateral contraction, and a plate that is lifted from its top."""
    plate = vs.Box(size=(16 * mm, 16 * mm, 4 * mm), center=(4 * mm, 4 * mm, SIDE + 2 * mm))
    whole = {
        "name": "pulled",
        "voxel_size": 4 * mm,
        "parts": [
            vs.Part(
                shape=vs.Box(size=(SIDE, SIDE, SIDE)),
                material=vs.NeoHookean(young=1 * MPa, poisson=0.0),
            )
        ],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "objects": [Object(name="plate", shape=plate, motion=vs.Motion(displacement=(0, 0, lift)))],
        "contact": contact or Contact(adhesion=ADHESION),
        "probes": {"top": vs.Probe(z=(SIDE, SIDE))},
    }
    return vs.Design(**(whole | changes))


def force_of(lift):
    result = simulate(pulled(lift))
    assert result.status == "ok"
    force = sum(contact.force[2] for contact in result.contacts)
    return force, lift - result.probes["top"][2]


def traction(gap):
    s = gap / RANGE
    return 27 / 4 * STRENGTH * s * (1 - s) ** 2 if 0 < s < 1 else 0.0


@pytest.mark.parametrize("part", [0.1, 1 / 3, 0.7, 1.1])
def test_the_force_is_the_traction_times_the_area(part):
    force, gap = force_of(part * RANGE)
    expected = traction(gap - CLEARANCE)
    assert force == pytest.approx(expected * SIDE**2, abs=0.005 * STRENGTH * SIDE**2)


def test_the_pull_off_force_is_strength_times_area():
    # The block yields by σ L/E at the strength.
    force, _ = force_of(RANGE / 3 + STRENGTH * SIDE / (1 * MPa))
    assert force == pytest.approx(STRENGTH * SIDE**2, rel=0.005)


def test_the_work_of_separation_is_the_integral_of_the_law():
    # Beyond this lift the block is free again, so that its own energy is none.
    points, weights = np.polynomial.legendre.leggauss(8)
    lifts = RANGE * (1 + points) / 2
    work = RANGE / 2 * sum(w * force_of(lift)[0] for w, lift in zip(weights, lifts, strict=True))
    assert work == pytest.approx(9 / 16 * STRENGTH * RANGE * SIDE**2, rel=0.01)


def test_adhesion_over_time_ends_in_equilibrium():
    design = pulled(0.1 * mm)
    still = simulate(design)
    moved = simulate(design, method="dynamics", damping="critical", time_step="2 ms")
    assert moved.status == "ok"
    assert moved.probes["top"][2] == pytest.approx(still.probes["top"][2], rel=1e-3)


def test_adhesion_out_of_reach_moves_no_bit():
    far = vs.Box(size=(4 * mm, 4 * mm, 4 * mm), center=(4 * mm, 4 * mm, 60 * mm))
    objects = [*pulled(-0.5 * mm).objects, Object(name="far", shape=far, voxel_size=2 * mm)]
    pair = ContactPair(of=("body", "far"), adhesion=ADHESION)
    without, beside = (
        simulate(pulled(-0.5 * mm, contact, objects=objects))
        for contact in (Contact(friction=0.5), Contact(friction=0.5, pairs=(pair,)))
    )
    assert (without.positions == beside.positions).all()
    assert without.contacts == beside.contacts


@pytest.mark.parametrize(
    ("pair", "message"),
    [
        ({"of": ("body", "plate"), "kind": "bonded"}, "adhesion: is that of a pair that touches"),
        ({"of": ("body", "body")}, "adhesion: acts between two things"),
    ],
)
def test_pairs_that_cannot_adhere_are_refused(pair, message):
    with pytest.raises(DesignError, match=message):
        ContactPair(**pair, adhesion=ADHESION)


@pytest.mark.parametrize(("strength", "range_"), [(0.0, RANGE), (STRENGTH, -1 * mm)])
def test_numbers_that_are_not_positive_are_refused(strength, range_):
    with pytest.raises(DesignError, match=r"positive|greater"):
        Adhesion(strength=strength, range=range_)


def test_uses_that_do_not_know_adhesion_refuse_it():
    result = simulate(pulled(0.1 * mm))
    with pytest.raises(DesignError, match=r"contact\.adhesion: is not known to gradients"):
        gradient(result, "contact_force", "parts[0].material.young")
    with pytest.raises(DesignError, match=r"contact\.adhesion: is not known to planes of symmetry"):
        simulate(pulled(0.1 * mm, symmetry=[{"plane": "x", "at": SIDE / 2}]))
    assert "adhesion" in not_live(vs.simulation.Setup(result.design, result.mesh))
