"""Error bars of runs: which voxels they come from, and that they hold where the answer is known."""

import json
import math

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison import ErrorBar, discretization_error
from voxsoft.comparison.error_bar import share_of
from voxsoft.design import Body, families
from voxsoft.errors import SimulationError
from voxsoft.jobs import RunSpec, run_job
from voxsoft.metrics import METRICS
from voxsoft.simulation.solving.choice import settings_at_rest
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.45)


def beam(**solver):
    """A beam of 2 x 2 voxels."""
    return vs.Design(
        name="beam",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=vs.Box(size=(30 * mm, 10 * mm, 10 * mm)), material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity()],
        probes={"tip": vs.Probe(x=(30 * mm, 30 * mm))},
        solver=vs.Solver(**solver),
    )


@pytest.fixture(scope="module")
def bars():
    return vs.error_bars(vs.simulate(beam()))


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
def test_regular_sizes_hold_every_order_from_a_half_on(order):
    values = [1.0 + 0.3 * size**order for size in (2.0, 1.0)]
    found = discretization_error([2.0, 1.0], values, regular=True)
    assert abs(found.limit - 1.0) <= found.error * (1.0 + 1e-12)
    assert found.basis == "regular sizes"


def test_regular_sizes_do_not_bound_slow_convergence():
    values = [1.0 + 0.3 * size**0.3 for size in (2.0, 1.0)]
    found = discretization_error([2.0, 1.0], values, regular=True)
    assert abs(found.limit - 1.0) > found.error


def test_a_small_body_gets_finer_voxels(bars):
    assert bars.voxel_sizes == (5 * mm, 2.5 * mm)
    assert bars.voxels == (24, 192)
    assert bars.regular
    assert bars.missing == ""


def test_the_bar_of_a_beam_holds_the_limit_of_three_sizes(bars):
    sizes = (5 * mm, 2.5 * mm, 1.25 * mm)
    runs = [vs.simulate(beam().replace(voxel_size=size)) for size in sizes]
    values = [float(run.probes["tip"][2]) for run in runs]
    truth = discretization_error(sizes, values).limit
    bar = bars.probes["tip"][2]
    assert bar.value == values[0]
    assert abs(bar.estimate - truth) <= bar.error
    assert bar.error < abs(bar.value - truth) * 2.0


def test_numbers_zero_by_symmetry_have_no_error(bars):
    sideways = bars.probes["tip"][1]
    assert (sideways.estimate, sideways.error) == (0.0, 0.0)


def test_peaks_have_no_bar_and_percentiles_have_one():
    design = beam().replace(
        objectives={"peak": vs.Objective(minimize="max_stretch")},
        constraints={"most": vs.Constraint(metric="max_stretch", percentile=90, max=2.0)},
    )
    found = vs.error_bars(vs.simulate(design))
    assert "peak" not in found.metrics
    assert "max_stress" not in found.metrics
    assert found.metrics["most"].error > 0.0


def test_coarser_voxels_are_taken_where_they_are_asked_for():
    found = vs.error_bars(vs.simulate(beam(error="coarser")))
    assert found.voxel_sizes == (10 * mm, 5 * mm)
    assert not found.regular  # one voxel through the body
    assert "wide" in found.sentence


def test_a_wall_of_one_voxel_may_hide_a_tenth():
    found = vs.error_bars(vs.simulate(beam(error="coarser")))
    tip = found.probes["tip"][2]
    assert tip.error >= 0.1 * abs(tip.value)
    assert found.metrics["mass"].error < 1e-9 * found.metrics["mass"].value


def test_an_accuracy_takes_as_many_sizes_as_it_takes():
    found = vs.error_bars(vs.simulate(beam(accuracy="0.8 %")))
    assert len(found.voxel_sizes) > 2
    moved = [found.probes["tip"][axis] for axis in (0, 2)]
    size = math.hypot(*(bar.estimate for bar in moved))
    assert math.hypot(*(bar.error for bar in moved)) <= 0.008 * size


def test_an_accuracy_that_is_out_of_reach_says_so(monkeypatch):
    monkeypatch.setattr("voxsoft.comparison.bars.ACCURATE_UP_TO", 200)
    found = vs.error_bars(vs.simulate(beam(accuracy="0.01 %")))
    assert found.voxel_sizes == (5 * mm, 2.5 * mm)
    assert "not reached" in found.missing
    assert "1,536 voxels" in found.missing


@pytest.mark.parametrize(
    ("design", "reason"),
    [
        (beam(error="off"), '"off"'),
        (beam(end_time="1 ms"), "motion over time"),
        (
            beam().replace(
                parts=[vs.Part(shape=beam().parts[0].shape, material="ecoflex-00-30-lattice")]
            ),
            "lattice",
        ),
    ],
    ids=["off", "over time", "lattice"],
)
def test_without_bars_the_reason_stands_there(design, reason):
    found = vs.error_bars(vs.simulate(design))
    assert not found.voxel_sizes
    assert reason in found.sentence
    assert "Try:" in found.sentence


@pytest.mark.slow
def test_motion_has_bars_of_its_end_where_they_are_asked_for():
    moving = {"end_time": "40 ms", "method": "dynamics", "time_step": "2 ms", "damping": "50 1/s"}
    found = vs.error_bars(vs.simulate(beam(error="finer", **moving)))
    assert found.voxel_sizes == (5 * mm, 2.5 * mm)
    finest = vs.simulate(beam(**moving).with_values("voxel_size=1.25 mm")).probes["tip"][2]
    tip = found.probes["tip"][2]
    assert abs(finest - tip.estimate) < tip.error < 0.2 * abs(finest)


def test_an_equilibrium_of_a_design_of_motion_has_bars():
    still = vs.simulate(beam(end_time="1 s"), **settings_at_rest())
    found = vs.error_bars(still)
    assert found.probes["tip"][2].estimate == pytest.approx(
        vs.error_bars(vs.simulate(beam())).probes["tip"][2].estimate
    )


@pytest.mark.parametrize("levels", [1, 2])
def test_several_bodies_have_bars_as_each_of_them(levels):
    alone = vs.error_bars(vs.simulate(beam()))
    two = [
        Body(name=name, design=beam(), position=(x, 0, 0))
        for name, x in [("left", -0.05), ("right", 0.05)]
    ]
    both = vs.Design(name="both", voxel_size="3 mm", bodies=two, loads=beam().loads)
    if levels == 2:
        both = both.replace(voxel_size=1 * mm, bodies=[Body(name="pair", design=both)])
    found = vs.error_bars(vs.simulate(both))
    names = [name for name in found.probes if name.endswith("left.tip")]
    for name in names:
        for bar, own in zip(found.probes[name], alone.probes["tip"], strict=True):
            assert bar.value == pytest.approx(own.value, abs=1e-9)
            assert bar.error == pytest.approx(own.error, abs=1e-8)
    assert len(names) == 1
    assert found.voxels == tuple(2 * count for count in alone.voxels)


@pytest.mark.parametrize(
    ("most", "sizes", "words"),
    [
        # A quarter of the finer run's voxels is within the limit if coarser ones do not help.
        (28 * 8 // 4, (5 * mm, 2.5 * mm), "error bars from voxels of 5 mm and 2.5 mm"),
        (0, (10 * mm, 5 * mm), "the voxels are not the same body"),
    ],
    ids=["finer", "coarser"],
)
def test_another_body_on_coarser_voxels_has_bars_all_the_same(monkeypatch, most, sizes, words):
    monkeypatch.setattr("voxsoft.comparison.bars.FINER_UP_TO", most)
    odd = beam().replace(
        fill="binary",
        parts=[vs.Part(shape=vs.Box(size=(35 * mm, 10 * mm, 10 * mm)), material=RUBBER)],
        probes={"tip": vs.Probe(z=(10 * mm, 10 * mm))},
    )
    result = vs.simulate(odd)
    found = vs.error_bars(result)
    assert found.voxel_sizes == sizes
    assert words in found.sentence
    finest = vs.simulate(odd.replace(voxel_size=1.25 * mm)).metrics["max_displacement"]
    moved = found.metrics["max_displacement"]
    assert moved.value == result.metrics["max_displacement"]
    assert abs(moved.estimate - finest) <= moved.error


@pytest.mark.parametrize(
    ("solvable", "sizes"),
    [
        ((10,), (10 * mm, 5 * mm)),
        ((3.3,), (5 * mm, 5 * mm / 1.5)),
        ((), ()),
    ],
    ids=["coarser", "a little finer", "none"],
)
def test_a_finer_run_without_an_answer_leaves_other_sizes(solvable, sizes):
    def solve(design, _):
        if round(design.voxel_size / mm, 1) not in solvable:
            raise SimulationError("equilibrium", "is not found", "")
        return vs.simulate(design)

    found = vs.error_bars(vs.simulate(beam()), solve=solve)
    assert found.voxel_sizes == pytest.approx(sizes)
    if solvable:
        assert not found.regular
        assert "voxels half as large have no answer" in found.doubt
        # A quarter of the number on the finest voxels, which is within 5 % of that of the run.
        tip = found.probes["tip"][2]
        assert tip.error >= 0.95 * 0.25 * abs(tip.value)
    else:
        assert "on voxels half as large equilibrium: is not found" in found.sentence


def thin(**solver):
    """The beam as a strip of one voxel."""
    strip = vs.Box(size=(30 * mm, 10 * mm, 5 * mm))
    return beam(**solver).replace(parts=[vs.Part(shape=strip, material=RUBBER)])


@pytest.mark.long
def test_a_wall_of_one_voxel_gets_a_third_size():
    found = vs.error_bars(vs.simulate(thin()))
    assert found.voxel_sizes == (5 * mm, 2.5 * mm, 1.25 * mm)
    assert found.regular
    two = vs.error_bars(vs.simulate(thin(error="finer")))
    assert two.voxel_sizes == (5 * mm, 2.5 * mm)
    assert "walls are single voxels: the bars are wide" in two.sentence
    finest = vs.simulate(thin().replace(voxel_size=0.625 * mm)).probes["tip"][2]
    for bars in (found, two):
        tip = bars.probes["tip"][2]
        assert abs(tip.estimate - finest) <= tip.error
    assert found.probes["tip"][2].error < 0.5 * two.probes["tip"][2].error


def test_a_third_size_is_left_out_where_it_is_long(monkeypatch):
    monkeypatch.setattr("voxsoft.comparison.bars.FINER_UP_TO", 64 * 12 - 1)
    assert len(vs.error_bars(vs.simulate(thin())).voxel_sizes) == 2


def test_sizes_that_agree_by_chance_keep_an_error_of_order_two():
    """With order 2 a change of 0.3 from the first size leaves 0.3/12, which counts twice."""
    found = discretization_error([4.0, 2.0, 1.0], [1.3, 1.0, 1.0], regular=True)
    assert found.error == pytest.approx(2.0 * 0.3 / 12.0)


def test_a_run_that_went_another_way_than_its_design_gets_no_bars():
    found = vs.error_bars(vs.simulate(beam(), refine=2))
    assert not found.voxel_sizes
    assert "other settings than the run had" in found.missing


def test_the_error_changes_no_result():
    off, on = (vs.simulate(beam(error=error)).positions for error in ("off", "finer"))
    assert np.array_equal(off, on)


def test_the_summary_of_a_run_holds_its_bars(tmp_path):
    outcome = run_job(RunSpec(design=beam()), tmp_path)
    kept = json.loads((tmp_path / "summary.json").read_text())["error_bars"]
    assert outcome.summary["error_bars"]["voxels"] == kept["voxels"] == [24, 192]
    tip = kept["probes"]["tip"]["z"]
    assert tip["value"] == outcome.found.probes["tip"][2]
    assert tip["error"] > 0.0


def test_stopping_before_the_bars_keeps_the_result(tmp_path):
    def stop(event):
        if getattr(event, "stage", "").startswith("error bars"):
            raise KeyboardInterrupt

    outcome = run_job(RunSpec(design=beam()), tmp_path, stop)
    assert outcome.found.status == "ok"
    assert "stopped" in json.loads((tmp_path / "summary.json").read_text())["error_bars"]["missing"]


@pytest.mark.parametrize(
    ("bar", "words"),
    [
        (ErrorBar(0.0, -0.01304, 0.00052, "length"), "-13.04 ± 0.52 mm"),
        (ErrorBar(0.0, 0.5, 0.02, "angle"), "28.6 ± 1.1 deg"),
        (ErrorBar(0.0, 0.010, 0.0, "mass"), "10.000 ± 0.000 g"),
        (ErrorBar(0.0, 4.44e-5, 3.5e-6, "energy"), "0.0444 ± 0.0035 mJ"),
        (ErrorBar(0.0, 1.5, 0.25, "number"), "1.50 ± 0.25"),
    ],
)
def test_a_bar_in_words(bar, words):
    assert str(bar) == words


def test_a_goal_may_ask_for_an_accuracy_of_its_own():
    """Another goal and the probes may be as far off as they are."""
    beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    goals = {
        "sag": vs.Objective(minimize="displacement", probe=next(iter(beam.probes)), accuracy=0.5),
        "far": vs.Objective(maximize="max_displacement"),
    }
    loose = vs.error_bars(vs.simulate(beam.replace(objectives=goals)))
    assert len(loose.voxel_sizes) == 2
    tight = {**goals, "sag": goals["sag"].replace(accuracy=0.05)}
    found = vs.error_bars(vs.simulate(beam.replace(objectives=tight)))
    assert len(found.voxel_sizes) > 2
    assert found.metrics["sag"].error <= 0.05 * abs(found.metrics["sag"].estimate)


def test_an_accuracy_of_a_peak_is_refused_in_words():
    beam = families.beam(length="40 mm").with_values("parts.0.material=ecoflex-00-30")
    peak = {"stress": vs.Objective(minimize="max_stress", accuracy=0.1)}
    bars = vs.error_bars(vs.simulate(beam.replace(objectives=peak)))
    assert "stress is the largest of all voxels" in bars.sentence
    assert "percentile" in bars.hint


def test_an_estimate_that_cannot_be_is_not_known():
    volume = METRICS["cavity_volume"].bounds
    bar = ErrorBar.within(1.2e-6, -2e-6, 3e-6, "volume", volume)
    assert str(bar) == "not known: smaller voxels point to -2 mL, beyond what it can be"
    assert bar.summary() == {
        "value": 1.2e-6,
        "estimate": None,
        "error": None,
        "reason": "smaller voxels point to -2 mL, beyond what it can be",
    }
    assert share_of([bar]) is None
    assert ErrorBar.within(1.2e-6, 1.5e-6, 3e-6, "volume", volume).summary()["estimate"] == 1.5e-6
    pressure = METRICS["chamber_pressure"].bounds
    assert ErrorBar.within(-9e4, -1.2e5, 3e4, "pressure", pressure).unknown
    assert not ErrorBar.within(-9e4, -1.0e5, 3e4, "pressure", pressure).unknown


def test_a_chamber_extrapolated_below_zero_is_not_known():
    # One voxel of 2 mm, and one of 1 mm: extrapolated that is -6 mm³.
    block = vs.Box(size=(10 * mm,) * 3, corner=(0, 0, 0))
    room = vs.Box(size=(1.2 * mm,) * 3, corner=(4.9 * mm,) * 3)
    part = vs.Part(shape=block - room, material=RUBBER)
    design = beam(error="finer").replace(
        voxel_size=2 * mm,
        fill="binary",
        parts=[part],
        loads=[vs.Pressure(value=1 * kPa)],
        probes={},
    )
    bars = vs.error_bars(vs.simulate(design))
    (volume,) = bars.volumes
    assert volume.unknown.startswith("smaller voxels point to -")
    assert bars.summary()["cavities"][0]["estimate"] is None
    assert bars.metrics["cavity_volume"].unknown
