"""Workspaces: positions of a place over a grid of its drives."""

import csv
import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tiny_design import TINY
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.errors import SimulationError
from voxsoft.simulation.runs.workspace import size_of_net


@given(
    st.lists(st.integers(2, 4), min_size=1, max_size=3),
    st.lists(st.floats(-2.0, 2.0), min_size=9, max_size=9),
)
def test_a_straight_net_has_the_size_of_its_parallelepiped(shape, entries):
    edges = np.array(entries).reshape(3, 3)[: len(shape)]
    grid = np.meshgrid(*(np.linspace(0.0, 1.0, n) ** 2 for n in shape), indexing="ij")
    points = np.stack(grid, axis=-1) @ edges
    exact = math.sqrt(max(np.linalg.det(edges @ edges.T), 0.0))
    # Determinants of nearly parallel edges cancel: half of the digits of a square root are left.
    assert size_of_net(points) == pytest.approx(exact, rel=1e-9, abs=1e-6)


def test_a_cell_without_a_corner_does_not_count():
    points = np.stack(np.meshgrid([0.0, 1.0, 2.0], [0.0, 1.0], [5.0]), axis=-1).reshape(2, 3, 3)
    assert size_of_net(points) == pytest.approx(2.0)
    points[0, 0] = np.nan
    assert size_of_net(points) == pytest.approx(1.0)


@pytest.fixture(scope="module")
def design(tmp_path_factory):
    file = tmp_path_factory.mktemp("tiny") / "tiny.toml"
    file.write_text(f'schema = "voxsoft/1"\nname = "tiny"\n{TINY}')
    return file


def gravity_key(design):
    return next(
        f"loads[{i}].value"
        for i, load in enumerate(vs.load(design).loads)
        if load.kind == "gravity"
    )


def test_places_are_those_of_single_runs(design):
    loaded = vs.load(design)
    probe = next(iter(loaded.probes))
    key = gravity_key(design)
    found = vs.workspace(loaded, probe, [f"{key}=0..4 m/s^2/3"])
    assert found.points.shape == (3, 3)
    assert found.missing == 0
    for value, point in zip((0.0, 2.0, 4.0), found.points, strict=True):
        single = vs.simulate(loaded.with_values(f"{key}={value} m/s^2"))
        place = single.places[probe]
        there = place.weights @ single.positions[place.vertices]
        # Both are solved to a part in 1e6 of the load, from other starts.
        moved = np.linalg.norm(there - found.unloaded)
        assert np.linalg.norm(point - there) <= 1e-5 * moved + 1e-12
    chord = np.linalg.norm(found.points[2] - found.points[0])
    assert found.size >= chord * (1.0 - 1e-12)
    assert found.hull_volume == 0.0
    assert [row[key] for row in found.table()] == [0.0, 2.0, 4.0]


def test_the_command_writes_its_table_and_its_picture(design, tmp_path):
    probe = next(iter(vs.load(design).probes))
    call = ["workspace", str(design), "--probe", probe, "--out", str(tmp_path / "out")]
    over = ["--over", f"{gravity_key(design)}=0..4 m/s^2/2", "--error", "off"]
    shown = CliRunner().invoke(app, [*call, *over])
    assert shown.exit_code == 0, shown.output
    assert "no error bars" in shown.output
    assert "length of the net" in shown.output
    with (tmp_path / "out" / "workspace.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 2
    assert (tmp_path / "out" / "workspace.png").stat().st_size > 5000
    summary = json.loads(CliRunner().invoke(app, [*call, *over, "--json"]).output)
    assert summary["missing"] == 0
    assert summary["error"] is None
    assert np.shape(summary["points"]) == (2, 3)


@pytest.mark.parametrize(
    ("probe", "drives", "words"),
    [
        ("tipp", ["loads[0].value=0..1 m/s^2/2"], 'no probe "tipp"'),
        (None, [], "one to three"),
        (None, ["loads[0].value=0..1 m/s^2/2"] * 2, "twice"),
        (None, ["loads[0].value"], "no key with a range"),
    ],
)
def test_invalid_workspaces_are_refused(design, probe, drives, words):
    loaded = vs.load(design)
    with pytest.raises(SimulationError, match=words):
        vs.workspace(loaded, probe or next(iter(loaded.probes)), drives)
