"""Many candidates at a time: designs that go through lanes, others, and refusals."""

import lattice_families as families
import numpy as np
import pytest

from voxsoft import (
    Box,
    Clamp,
    Floor,
    Gravity,
    Lattice,
    NeoHookean,
    Region,
    simulate,
    simulate_many,
)
from voxsoft.errors import DesignError, SimulationError
from voxsoft.simulation import Ensemble, Setup

SOFT, STIFF = Lattice(edge="20 kPa", bulk="60 kPa"), Lattice(edge="60 kPa", bulk="90 kPa")


def short_beam(**changes):
    return families.beam().with_parameters(length="40 mm").replace(**changes)


def test_a_candidate_does_not_depend_on_its_company():
    design = short_beam()
    alone = simulate_many(design, [SOFT])[0]
    crowd = [Lattice(edge=edge, bulk="60 kPa") for edge in np.geomspace(2e3, 1e6, 20)]
    among = simulate_many(design, [*crowd[:7], SOFT, *crowd[7:]])
    assert np.array_equal(among[7].positions, alone.positions)


def test_two_lists_are_taken_in_pairs():
    design = short_beam()
    pairs = simulate_many(design, [SOFT, STIFF], load_factors=[0.5, 2.0])
    apart = [simulate_many(design, [SOFT], load_factors=[0.5])[0]]
    apart.append(simulate_many(design, [STIFF], load_factors=[2.0])[0])
    for one, other in zip(pairs, apart, strict=True):
        assert np.array_equal(one.positions, other.positions)


@pytest.mark.parametrize(
    "changes",
    [
        {"floor": Floor(z=-1.0)},
        {"solver": families.beam().solver.replace(method="xpbd")},
        {"solver": families.beam().solver.replace(damping="critical")},
    ],
)
def test_designs_unknown_to_lanes_are_solved_alone(changes):
    design = short_beam(**changes)
    found = simulate_many(design, [SOFT, STIFF])
    assert [candidate.way for candidate in found] == ["alone", "alone"]
    parts = tuple(part.replace(material=STIFF) for part in design.parts)
    expected = simulate(design.replace(parts=parts))
    assert np.array_equal(found[1].positions, expected.positions)


def test_loads_are_scaled_for_those_solved_alone_too():
    """Relaxation to 1e-5 of the load, beside lanes: some 1e-4 of the sag of a slender beam."""
    relaxed = short_beam(solver=families.beam().solver.replace(method="xpbd"))
    alone = simulate_many(relaxed, [SOFT, STIFF], load_factors=[0.5, 2.0])
    lanes = simulate_many(short_beam(), [SOFT, STIFF], load_factors=[0.5, 2.0])
    for one, other in zip(alone, lanes, strict=True):
        tip = other.probes["station-9"]
        assert (one.way, other.way) == ("alone", "lanes")
        assert one.probes["station-9"] == pytest.approx(tip, abs=1e-3 * np.linalg.norm(tip))


def test_other_models_are_solved_alone_beside_lanes():
    rubber = NeoHookean(young="60 kPa", poisson=0.49)
    found = simulate_many(short_beam(), [SOFT, rubber, STIFF])
    assert [candidate.way for candidate in found] == ["lanes", "alone", "lanes"]
    assert all(candidate.status == "ok" for candidate in found)


def test_squat_bodies_are_left_to_relaxation():
    setup = Setup.of(short_beam())
    assert Ensemble.of(setup) is not None
    side = 0.05
    part = setup.design.parts[0].replace(shape=Box(size=(side, side, side)))
    cube = short_beam(
        parts=(part,), probes={}, objectives={}, clamps=(Clamp(region=Region(z=(0, 0))),)
    )
    assert Ensemble.of(Setup.of(cube)) is None


def test_bad_input_is_named():
    design = short_beam()
    with pytest.raises(SimulationError, match="are both missing"):
        simulate_many(design)
    with pytest.raises(SimulationError, match="have 2 and 1 entries"):
        simulate_many(design, [SOFT, STIFF], load_factors=[1.0])
    with pytest.raises(SimulationError, match=r"load_factors\[1\]: is nan"):
        simulate_many(design, load_factors=[1.0, np.nan])
    first = design.parts[0]
    second = first.replace(shape=Box(size=(0.01, 0.01, 0.02)), material=STIFF)
    two = short_beam(parts=(second, first), loads=(Gravity(),))
    with pytest.raises(DesignError, match="are of several materials"):
        simulate_many(two, [SOFT])
    assert simulate_many(two, load_factors=[0.5, 1.0])[1].way == "lanes"
    assert simulate_many(design, []) == ()
