"""The stress of a pull with free sides, beside closed forms and beside solved bodies."""

from __future__ import annotations

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.materials import (
    Gent,
    Hyperelastic,
    Lattice,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    Yeoh,
    card_names,
    load_card,
    nominal_stress,
    uniaxial_stress,
)
from voxsoft.shapes import Box
from voxsoft.units import mm

STRETCHES = np.array([0.7, 0.9, 1.1, 1.5, 2.0])
#: Nearly incompressible: the rest of the volume's change is a part μ/K of the stress.
RUBBERS = [
    NeoHookean(young="60 kPa", poisson=0.4999),
    MooneyRivlin(c10="8 kPa", c01="2 kPa", poisson=0.4999),
    Yeoh(c=("10 kPa", "1 kPa"), poisson=0.4999),
    Ogden(mu=("20 kPa",), alpha=(2.5,), poisson=0.4999),
    Gent(shear="20 kPa", jm=30, poisson=0.4999),
]


@pytest.mark.parametrize("rubber", RUBBERS, ids=lambda rubber: rubber.model)
def test_rubber_that_keeps_its_volume_has_the_closed_form(rubber: Hyperelastic) -> None:
    found = uniaxial_stress(rubber, STRETCHES)
    assert found == pytest.approx(nominal_stress(rubber, STRETCHES), rel=2e-3)


def test_the_slope_at_rest_is_youngs_modulus() -> None:
    strain = 1e-5
    for name in card_names():
        material = load_card(name).material
        assert isinstance(material, Hyperelastic | Lattice)
        slope = float(uniaxial_stress(material, 1.0 + strain)) / strain
        assert slope == pytest.approx(material.young(), rel=1e-3), name


@pytest.mark.parametrize(
    "material",
    [Lattice(edge="20 kPa", bulk="100 kPa"), NeoHookean(young="60 kPa", poisson=0.3)],
    ids=lambda material: material.model,
)
def test_a_solved_bar_has_that_stress(material: Lattice | NeoHookean) -> None:
    """Ends that are held let no strain be even near them: the middle of a long bar counts.

    The bar is pulled by a force, and its stretch is that between two cross sections.
    """
    area, length = (8 * mm) ** 2, 40 * mm
    stress = float(uniaxial_stress(material, 1.4))
    design = vs.Design(
        name="bar",
        voxel_size=2 * mm,
        parts=[vs.Part(shape=Box(size=(length, 8 * mm, 8 * mm)), material=material)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Force(region=vs.Region(x=(length, length)), value=(stress * area, 0, 0))],
        probes={
            "low": vs.Probe(x=(16 * mm, 16 * mm)),
            "high": vs.Probe(x=(24 * mm, 24 * mm)),
        },
        solver=vs.Solver(method="statics"),
    )
    result = vs.simulate(design)
    moved = result.probes["high"][0] - result.probes["low"][0]
    assert 1.0 + moved / (8 * mm) == pytest.approx(1.4, rel=0.02)
