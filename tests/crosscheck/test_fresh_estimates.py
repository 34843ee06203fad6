"""Estimates of the discretization error on bodies that their rule was not made on."""

import csv
import sys
from pathlib import Path

import pytest

from voxsoft.comparison import discretization_error
from voxsoft.simulation import Setup, simulate
from voxsoft.units import mm

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def made():
    sys.path.insert(0, str(ROOT / "evidence"))
    try:
        import make_estimate_truths
    finally:
        sys.path.remove(str(ROOT / "evidence"))
    return make_estimate_truths


@pytest.fixture(scope="module")
def table():
    """Displacements in mm by split, of each code and body of each set."""
    found = {}
    with (ROOT / "tests" / "data" / "estimate_truths.csv").open() as file:
        for row in csv.DictReader(file):
            key = row["set"], row["body"], row["code"]
            found.setdefault(key, {})[int(row["split"])] = float(row["value_mm"])
    return found


def limit(values, finest=3):
    """The limit of a body's finest splits."""
    splits = sorted(values)[-finest:]
    return discretization_error([1 / split for split in splits], [values[s] for s in splits]).limit


@pytest.mark.long
@pytest.mark.parametrize("group", ["first", "second"])
def test_estimates_from_two_sizes_hold_for_nine_of_ten_bodies(made, table, group):
    """The truth is from splits of 2 and up; the estimate knows 1 and 2."""
    held = {}
    for name, body in made.SETS[group]().items():
        truth = limit({s: v for s, v in table[group, name, "voxsoft"].items() if s > 1})
        values = []
        for split in (1, 2):
            result = simulate(Setup.of(body.design, refine=split), method="statics")
            assert result.status == "ok"
            values.append(result.probes["probe"]["xyz".index(body.axis)] / mm)
        known = discretization_error([1.0, 0.5], values)
        held[name] = all(
            abs(value - truth) <= known.error_at(index) for index, value in enumerate(values)
        )
    assert sum(held.values()) >= 0.9 * len(held), held
