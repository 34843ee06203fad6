"""A benchmark whose answer is wrong prints no time."""

import dataclasses
import sys
from pathlib import Path

import lattice_families as families
import pytest

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

ROOT = Path(__file__).parents[3]


@pytest.fixture(autouse=True)
def beside_the_benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    monkeypatch.syspath_prepend(str(ROOT / "evidence"))
    monkeypatch.setattr(sys, "argv", ["benchmark"])


def test_a_state_out_of_balance_is_refused():
    from bodies import MATERIALS, beam, require_rest

    setup = Setup.of(beam(MATERIALS["lattice"]))
    result = vs.simulate(setup, tolerance=1e-4)
    require_rest(setup, result, 1e-4)
    positions = result.positions.copy()
    positions[-1, 2] += 0.01 * mm
    with pytest.raises(SystemExit, match=r"wrong answer: .* out of balance"):
        require_rest(setup, dataclasses.replace(result, positions=positions), 1e-4)


def test_a_body_that_does_not_rest_leaves_no_figures():
    from measure import Report
    from pipeline import steps

    report = Report("Steps")
    burst = families.cylinder(height="25 mm", radius="15 mm")
    burst = burst.replace(loads=(vs.Pressure(value=500 * kPa),))
    with pytest.raises(SystemExit, match="wrong answer: cylinder is diverged"):
        steps(report, "cylinder", burst)
    assert report.rows == []


def test_a_contact_that_is_not_found_leaves_a_row_and_no_figure(monkeypatch):
    import contact
    from measure import Report

    simulate = vs.simulate

    def early(design):
        return dataclasses.replace(simulate(design), status="not-at-rest", load_factor=0.4)

    monkeypatch.setattr(vs, "simulate", early)
    report = Report("Contact")
    cases = contact.Cases(report)
    cases.blocks([(2.0, 0.0, (1,))])
    name = "two blocks, voxels of 2 mm, μ 0, pressed by 1 mm"
    reached, time = report.rows
    assert reached["name"] == f"{name}: not-at-rest, load reached"
    assert reached["value"] == pytest.approx(40.0)
    assert time["name"] == f"{name}: time"
    assert cases.failed == 1


def test_figures_of_contact_stand_beside_their_references():
    import contact
    from measure import Report

    report = Report("Contact")
    cases = contact.Cases(report)
    cases.spheres([(5.0, False, 0.45, (2,))])
    force, radius, _ = report.rows
    # The force of the reference, 2.459 N, is that of all four quarters.
    assert force["value"] / force["ratio"] == pytest.approx(2.4593)
    assert radius["value"] / radius["ratio"] == pytest.approx(6.54953)
    assert cases.failed == 0
