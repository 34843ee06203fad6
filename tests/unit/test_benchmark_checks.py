"""A benchmark whose answer is wrong prints no time."""

import dataclasses
import sys
from pathlib import Path

import lattice_families as families
import pytest

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(autouse=True)
def beside_the_benchmarks(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
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
