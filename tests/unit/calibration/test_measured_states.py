"""Measurements from data over time, tables that say how a body was loaded, and their intervals."""

import lattice_families as families
import numpy as np
import pytest

from voxsoft.calibration import (
    Experiment,
    Measurement,
    measurements_at,
    read_measurement,
    table_of,
)
from voxsoft.calibration.identifiability import spread_of_experiments
from voxsoft.comparison import compare
from voxsoft.errors import DesignError, MeasurementError
from voxsoft.instruments import Column, Measured

TIMES = np.arange(10.0)
REST, HELD = (0, 3), (5, 9)


def data(*, hidden=(), **columns):
    """A tip that sinks by 5 mm at 4 s and comes nearer by 1 mm, with further columns."""
    x = np.where(TIMES > 4, 39.0, 40.0)
    z = np.where(TIMES > 4, -4.0, 1.0)
    for at in hidden:
        x[at] = z[at] = np.nan
    made = [Column("tip x", "mm", x, TIMES), Column("tip z", "mm", z, TIMES)]
    made += [Column(name, unit, values, TIMES) for name, (unit, values) in columns.items()]
    return Measured("cam", tuple(made))


def test_displacements_are_differences_of_means_without_hidden_frames():
    (seen,) = measurements_at(data(hidden=(1, 6, 7)), rest=REST, loaded=[HELD])
    assert seen.probes == ("tip",)
    assert seen.quantities == ("dx", "dz")
    np.testing.assert_allclose(seen.values, [[-0.001, -0.005]], atol=1e-15)
    assert seen.source == "cam: 5 s to 9 s less 0 s to 3 s; frames scatter by up to 0"


def test_each_interval_has_the_values_of_its_loads():
    press = np.where(TIMES > 6, 20.0, 10.0)
    found = measurements_at(
        data(p=("kPa", press)),
        rest=REST,
        loaded=[("5 s", "6 s"), ("7 s", "9 s")],
        axes="z",
        changes={"pressure": "p"},
    )
    assert [each.changes for each in found] == [("pressure=10 kPa",), ("pressure=20 kPa",)]
    assert found[0].quantities == ("dz",)


def test_points_may_be_at_distances_along_the_body():
    (seen,) = measurements_at(
        data(), rest=REST, loaded=[HELD], stations={"tip": "90 mm"}, line="centerline"
    )
    np.testing.assert_allclose(seen.arcs, [0.09])
    assert seen.line == "centerline"
    assert Experiment(families.beam(), seen).line == "centerline"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"hidden": range(5, 10)}, "tip was not seen in any of 5 frames from 5 s to 9 s"),
        ({"stations": {"toe": "tip"}}, 'has no point "toe"'),
        ({"stations": {}}, "holds no points"),
        ({"axes": "xy"}, "axes x, y are not those that all points have.*they have x, z"),
        ({"axes": "xw"}, "axes x, w are not those"),
        ({"loaded": []}, "names no interval"),
        ({"loaded": [(5,)]}, "is no interval"),
        ({"loaded": [(9, 5)]}, "ends before it begins"),
        ({"changes": {"pressure": "q"}}, 'has no column "q"'),
        ({"changes": {"pressure": "p"}, "p": ("", TIMES)}, "p has no unit"),
        ({"changes": {"pressure": "p"}, "p": ("px", TIMES)}, "p is no load: pixels"),
    ],
)
def test_data_that_give_no_measurement_say_why(arguments, words):
    given = {key: arguments.pop(key) for key in ("hidden", "p") if key in arguments}
    with pytest.raises(MeasurementError, match=words):
        measurements_at(data(**given), **{"rest": REST, "loaded": [HELD]} | arguments)


@pytest.mark.parametrize("arcs", [None, [1 / 3, 0.7]])
def test_a_measurement_is_read_back_from_its_table_to_the_bit(arcs):
    seen = Measurement(
        quantities=["dx", "z"],
        values=[[1 / 3, -1e-17], [2e5, 0.1]],
        arcs=arcs,
        probes=None if arcs else ["tip, left", 'the "knee"'],
        source="me, CC0",
        line="upper-edge" if arcs else None,
        changes=["loads[0].value=12 kPa", 'parts[0].material="soft"'],
    )
    again = read_measurement(table_of(seen))
    assert again.values.tobytes() == seen.values.tobytes()
    assert (again.probes, again.quantities) == (seen.probes, seen.quantities)
    assert (again.source, again.line, again.changes) == (seen.source, seen.line, seen.changes)
    if arcs:
        assert again.arcs.tobytes() == seen.arcs.tobytes()


def test_an_experiment_has_the_design_as_it_was_loaded():
    table = "# set: length=70 mm\nprobe,dz_mm\nstation-9,-12\n"
    experiment = Experiment(families.beam(), read_measurement(table))
    assert np.ptp(experiment.setup.mesh.vertices[:, 0]) == pytest.approx(0.07)
    with pytest.raises(DesignError, match="no_such"):
        Experiment(families.beam(), read_measurement(table.replace("length=70", "no_such=70")))


def test_measurements_under_several_loads_are_compared_one_by_one():
    first, second = (
        Measurement(quantities=["dz"], values=[[-0.01]], probes=["station-9"], changes=[change])
        for change in ("length=90 mm", "length=80 mm")
    )
    with pytest.raises(MeasurementError, match=r"were loaded differently.*compare each"):
        compare(families.beam(), measured=[first, second], outside="none")
    coarse = families.beam().replace(voxel_size=10e-3)
    found = compare(
        coarse, solvers=["xpbd"], outside="none", voxel_sizes=[], splits=[1], measured=[first]
    )
    assert found.measured[0].values.shape == (1, 1)
    assert found.runs[0].ok


def test_an_interval_holds_the_scatter_between_experiments():
    """Twelve numbers of three experiments, whose loads are wrong by 1 %: the interval of twelve
    independent numbers would miss the truth most of the time."""
    random = np.random.default_rng(4)
    inside = narrow = 0
    for _ in range(400):
        slopes = [random.uniform(0.5, 1.5, (4, 1)) for _ in range(3)]
        residuals = [j[:, 0] * 0.01 * random.standard_normal() for j in slopes]
        total = float(np.vstack(slopes).ravel() @ np.vstack(slopes).ravel())
        off = sum(float(j[:, 0] @ r) for j, r in zip(slopes, residuals, strict=True)) / total
        left = [r - j[:, 0] * off for j, r in zip(slopes, residuals, strict=True)]
        half = spread_of_experiments(left, slopes)[0]
        inside += abs(off) <= half
        noise = np.concatenate(left)
        narrow += abs(off) <= 2.2 * np.sqrt(noise @ noise / 11 / total)
    # 95 % of 400 with three of their standard deviations; clusters of unlike size take some more.
    assert inside / 400 > 0.95 - 3 * np.sqrt(0.95 * 0.05 / 400) - 0.02
    assert narrow / 400 < 0.85
