"""Many candidates at a time against one by one: relaxation, statics, and a search on top."""

import lattice_families as families
import numpy as np
import pytest

from voxsoft import Force, Gravity, Lattice, Region, calibrate, simulate, simulate_many
from voxsoft.calibration import Experiment, Measurement
from voxsoft.simulation import Setup

#: From a beam that hardly bends to one that hangs straight down.
EDGES = (1e6, 1e5, 3e4, 1e4, 2e3)


def beam(**parameters):
    return families.beam().with_parameters(**parameters)


def with_material(design, material):
    parts = tuple(part.replace(material=material) for part in design.parts)
    return design.replace(parts=parts)


@pytest.mark.parametrize("method", ["xpbd", "statics"])
def test_lanes_agree_with_single_solvers(method):
    """Relaxation leaves 1e-6 of the load, which a slender beam shows as some 1e-5 of its sag."""
    setup = Setup.of(beam())
    materials = [Lattice(edge=edge, bulk=3 * edge, density=1300.0) for edge in EDGES]
    found = simulate_many(setup, materials)
    assert {candidate.way for candidate in found} == {"lanes"}
    for material, candidate in zip(materials, found, strict=True):
        design = with_material(setup.design, material)
        alone = simulate(Setup(design, setup.mesh), method=method, tolerance=1e-6)
        assert (candidate.status, alone.status) == ("ok", "ok")
        assert candidate.residual <= 1e-8
        sag = np.linalg.norm(alone.probes["station-9"])
        off = np.abs(candidate.positions - alone.positions).max()
        assert off < 3e-5 * sag, f"{off / sag:.1e} at {material.edge:g} Pa"


def test_parts_of_the_loads_are_those_of_lighter_designs():
    """Weight and a force at the tip, both scaled, against designs with these values."""
    push = Force(region=Region(x=(0.1, 0.1)), value=(0.0, 0.004, -0.002))
    design = beam().replace(loads=(Gravity(), push))
    factors = (0.25, 1.0, -0.5)
    found = simulate_many(design, load_factors=factors)
    for factor, candidate in zip(factors, found, strict=True):
        loads = (
            Gravity(value=factor * 9.81),
            push.replace(value=tuple(factor * f for f in push.value)),
        )
        lighter = design.replace(loads=loads)
        alone = simulate(lighter, method="statics")
        assert candidate.way == "lanes"
        # Both are converged to 1e-8 of the load.
        tip = alone.probes["station-9"]
        assert candidate.probes["station-9"] == pytest.approx(tip, abs=1e-6 * np.linalg.norm(tip))


def test_a_search_comes_to_the_same_end_with_and_without_lanes():
    arcs = np.linspace(0.0, 0.04, 5)[1:]
    values = np.column_stack([arcs, -4.0 * arcs**2])
    measurement = Measurement(quantities=["x", "dz"], values=values, arcs=arcs)
    bent = Experiment(beam(length="50 mm"), measurement)
    budget = {"generations": 4, "population": 8, "identify": False}
    lanes, single = (calibrate(bent, lanes=lanes, **budget) for lanes in (True, False))
    assert lanes.settings["solver"] == "statics in lanes"
    assert single.settings["solver"] == "xpbd relaxation"
    # Relaxation leaves 1e-6 of the load, and the simplex stops at 1e-6 of the error.
    assert lanes.search.error == pytest.approx(single.search.error, rel=1e-4)
    assert lanes.mean_error == pytest.approx(single.mean_error, rel=1e-4)
