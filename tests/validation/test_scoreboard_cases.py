"""The cases of the scoreboard: that data are read, and that parts of intervals are as stated."""

import csv
import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

from voxsoft.materials import load_card
from voxsoft.units import kPa, mm

CASES = Path(__file__).parents[2] / "examples" / "validation"


def case(name):
    sys.path.insert(0, str(CASES))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.pop(0)


@pytest.fixture(scope="module")
def lift():
    return case("membrane_lift")


@pytest.fixture(scope="module")
def beams():
    return case("paper_beams")


@pytest.fixture(scope="module")
def eth():
    return case("eth_beam")


def test_seven_membranes_were_measured_at_all_heights(lift):
    real = lift.measured()
    assert len(lift.MEMBRANES) == 7
    for membrane in lift.MEMBRANES:
        for height in lift.HEIGHTS:
            assert 1 * kPa < real[membrane.name, lift.WEIGHT, height] < 10 * kPa
    assert {name for name, _, _ in real} == {membrane.name for membrane in lift.MEMBRANES}


def test_rings_keep_apart_as_the_data_say(lift):
    """3 mm at least between disc, rings and clamp, with 5 mm to either side of a ring's middle."""
    for membrane in lift.MEMBRANES[1:]:
        values = {"half1": 5 * mm, "half2": 5 * mm, **membrane.rings}
        edges = [membrane.disc]
        for number in ("1", "2"):
            middle, half = values[f"ring{number}"], values[f"half{number}"]
            edges += [middle - half, middle + half]
        edges.append(lift.RIM)
        gaps = np.diff(edges)[::2]
        assert gaps.min() > 3 * mm - 0.01 * mm  # radii are given to 0.01 mm


def test_pressures_scatter_as_those_next_to_a_height(lift, monkeypatch):
    """One sample at 10 mm, and a kilopascal lower once at 12 mm; 13 mm is too far."""
    names = "membrane,force_N,height_mm,pressure_Pa,lowest_Pa,highest_Pa"
    texts = ("a,14.72,10,3000,3000,3000", "a,14.72,12,3100,2100,3200", "a,14.72,13,3000,0,3000")
    monkeypatch.setattr(lift, "rows", lambda: list(csv.DictReader([names, *texts])))
    assert lift.scatter()["a", 14.72, 10 * mm] == 1000.0


def test_a_pressure_is_found_on_a_path(lift):
    lifted = lift.Lifted(lift.MEMBRANES[0], lift.DESCRIBED, 10 * mm)

    def forces(pressures, enough):
        found = [4.0e-3 * p + 1.0e-6 * p**2 for p in pressures]
        return np.array(found[: int(np.searchsorted(found, enough)) + 1])

    lifted.forces = forces
    at, slope = lifted.lifting(14.72, 1500.0, 1.1)
    # The force is a polynomial of the second degree, which a cubic spline meets but for rounding.
    assert 4.0e-3 * at + 1.0e-6 * at**2 == pytest.approx(14.72, rel=1e-9)
    assert slope == pytest.approx(4.0e-3 + 2.0e-6 * at, rel=1e-9)
    # Where the first lifts more already two points are left, and a line between them is off by
    # an eighth of the step's square times the curvature, here less than 0.1 %.
    lower, _ = lifted.lifting(14.72, 5000.0, 1.1)
    assert lower == pytest.approx(at, rel=1e-3)
    lifted.forces = lambda pressures, enough: np.array([3.0, 4.0])  # and then no equilibrium
    with pytest.raises(lift.Lost, match="no path of pressures lifts") as lost:
        lifted.lifting(14.72, 1000.0, 1.1)
    assert lost.value.last == pytest.approx(1100.0)
    # 1 N for 100 Pa, and 10.72 N are missing.
    assert lost.value.further == pytest.approx(1100.0 + 10.72 * 100.0)


@pytest.mark.slow
def test_a_force_is_of_first_degree_in_pressure_and_stiffness(lift):
    """Euler's theorem, which the part of the thickness rests on: all of it, and half of both."""
    import voxsoft as vs

    def force(shear, fabric, pressure):
        rubber = vs.NeoHookean(young=3.0 * shear, poisson=0.49)
        thick = lift.Membrane("thick", 25.4 * mm, 4 * mm, {"ring1": 47 * mm, "ring2": 60 * mm})
        lifted = lift.Lifted(thick, lift.Model(rubber, fabric), 10 * mm)
        design = lifted._design(pressure)
        loads = [load for load in design.loads if load.kind != "gravity"]
        result = vs.simulate(design.replace(loads=loads))
        assert result.status == "ok", result.message
        return lifted._force(result)

    whole = force(20 * kPa, 3e6, 1.6 * kPa)
    # Statics stops at 1e-6 of the load.
    assert 2.0 * force(10 * kPa, 1.5e6, 0.8 * kPa) == pytest.approx(whole, rel=1e-4)


def test_the_tip_alone_gives_modulus_and_scale(beams):
    """The last mark is where it was seen: two numbers for two. The search stops at 0.1 %."""
    seen = beams._experiment("00-50", 1)[0].measurement.values
    found = beams._coarse("00-50", seen, True, slice(-1, None))
    assert found.scale * found.simulated[-1] == pytest.approx(seen[-1], rel=2e-3)
    # With all marks 118.4 kPa and 1.048 were seen.
    assert found.young == pytest.approx(118.4 * kPa, rel=0.05)
    assert found.scale == pytest.approx(1.048, rel=0.03)


def test_the_coupon_of_a_neo_hookean_rubber_does_not_soften(eth, tmp_path, monkeypatch):
    strain = np.linspace(0.04, 0.6, 30)
    pull = (1.0 + strain) - (1.0 + strain) ** -2
    for falling in (0.0, 0.8):
        stress = 50e3 * pull * (1.0 - falling * strain) - 3e3
        rows = [f"{a},{b}" for a, b in zip(strain, stress, strict=True)]
        file = tmp_path / "coupon.csv"
        file.write_text("\n".join(("eng_strain,eng_stress_Pa", *rows)))
        monkeypatch.setattr(eth, "COUPON", file)
        assert eth.softening() == pytest.approx(falling, abs=1e-9)


def test_the_strain_that_stands_for_a_beam(eth):
    """Under its weight alone 0.75 · 5/7 of the root's, which is half the height times 4 f / l²."""
    found = eth.strains({"gravity": 6 * mm, "load52": 16 * mm})
    root = 15 * mm * 4.0 * 6 * mm / (100 * mm) ** 2
    assert found["gravity"] == pytest.approx(0.75 * 5.0 / 7.0 * root, rel=1e-4)
    heavy = root + 15 * mm * 3.0 * 10 * mm / (100 * mm) ** 2
    assert 0.75 * 5.0 / 7.0 * heavy < found["load52"] < 0.75 * heavy


def test_the_stiffness_that_is_open_is_that_of_four_published_sets():
    bender = case("epfl_bender")
    assert bender.SHEAR[0] == pytest.approx(sum(load_card("ecoflex-00-30-epfl").material.mu))
    yeoh = load_card("ecoflex-00-30-epfl-yeoh").material
    assert bender.SHEAR[1] == pytest.approx(2.0 * yeoh.c[0])
    assert bender.stiffness_open() == pytest.approx(0.104, abs=5e-4)


def test_the_tip_is_held_as_described():
    blocked = case("epfl_blocked_force")
    assert set(blocked.PRESSURES) <= set(blocked.measured())
    design = blocked.Model(root=6 * mm).design(20 * kPa)
    root, edge, cup = design.clamps
    assert edge.axes == "yz"
    assert (root.region.x[0], cup.region.x[0]) == pytest.approx((-6 * mm, -6 * mm))
    # Chosen before any force was computed, and ten times of it toward silk.
    assert (blocked.DESCRIBED.film, blocked.STIFFER.film) == pytest.approx((41e6, 410e6))


@pytest.mark.slow
def test_the_path_of_the_tip_that_is_held_is_that_of_single_runs():
    """At pressures that a few iterations reach; statics stops at 1e-6 of the load."""
    blocked = case("epfl_blocked_force")
    model = blocked.Model()
    low, high = blocked.along((2 * kPa, 5 * kPa), model)
    assert 0.0 < low < high
    assert blocked.predicted(5 * kPa, model) == pytest.approx(high, rel=1e-3)
