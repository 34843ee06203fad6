"""Figures: they show the given data, with units, and report impossible ones."""

import io

import lattice_families as families
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

import voxsoft as vs
from voxsoft.calibration import Experiment, Measurement, calibrate
from voxsoft.design import Objective
from voxsoft.errors import MeshError, StudyError
from voxsoft.plot import (
    plot_body,
    plot_fitness,
    plot_history,
    plot_pareto,
    plot_profiles,
    plot_scatter,
    plot_shape,
)
from voxsoft.plot.body import body_image
from voxsoft.plot.quantities import scale_for
from voxsoft.study import StudyResult, Trial


def pixels(figure):
    """The drawn figure, (h, w, 3), 0 to 255."""
    assert isinstance(figure, Figure)
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=60)
    drawn.seek(0)
    return np.rint(imread(drawn)[..., :3] * 255).astype(int)


def labels(figure):
    axes = figure.axes[0]
    names = [axes.get_xlabel(), axes.get_ylabel()]
    return [*names, axes.get_zlabel()] if hasattr(axes, "get_zlabel") else names


def trial(number, parameters, objectives, *, status="ok", feasible=None):
    ok = status == "ok"
    return Trial(
        number=number,
        parameters=parameters,
        status=status,
        message="" if ok else "for a reason",
        objectives=objectives if ok else {},
        metrics={},
        feasible=ok if feasible is None else feasible,
        hash=str(number),
        same_as=None,
        seconds=0.1,
    )


def study(count=3, kinds=None, objectives=None):
    names = ("radius", "height", "wall")[:count]
    objectives = objectives or {"rise": Objective(maximize="displacement", axis="z", probe="top")}
    statuses = ["ok", "ok", "no-cavity", "ok", "diverged", "failed"]
    trials = tuple(
        trial(
            number,
            dict.fromkeys(names, 0.005 * (number + 1)),
            {name: 0.001 * (number + at) for at, name in enumerate(objectives)},
            status=status,
            feasible=number not in (2, 3, 4, 5),
        )
        for number, status in enumerate(statuses)
    )
    kinds = dict.fromkeys(names, "length") if kinds is None else kinds
    return StudyResult("test", None, trials, objectives, names, kinds)


@pytest.fixture(autouse=True)
def small_pictures(monkeypatch):
    """A ninth of the pixels, for speed."""
    monkeypatch.setattr("voxsoft.plot.body.PIXELS", 300)


@pytest.fixture(scope="module")
def result():
    return vs.simulate(families.cylinder())


@pytest.fixture(scope="module")
def calibration():
    seen = Measurement(
        quantities=["x", "dz"], values=[[0.03, -0.02], [0.05, -0.06]], arcs=[0.04, 0.08]
    )
    experiment = Experiment(families.beam(), seen)
    return calibrate(experiment, "cma-es", generations=4, population=6)


def test_a_result_is_drawn_with_its_displacement(result):
    figure = plot_body(result)
    assert figure.axes[1].get_ylabel() == "displacement (mm)"
    assert figure.axes[0].get_title(loc="left") == "cylinder"
    colors = pixels(figure).reshape(-1, 3)
    assert np.ptp(colors, axis=0).min() > 150, "dark, bright and white are all there"


def test_the_undeformed_body_is_behind_unless_refused():
    result = vs.simulate(families.beam())
    with_ghost, without = (pixels(plot_body(result, ghost=ghost)) for ghost in (True, False))
    pale = [np.count_nonzero((p.min(2) > 170) & (p.max(2) < 250)) for p in (with_ghost, without)]
    assert pale[0] > 2 * pale[1]


def test_a_section_opens_the_cavity(result):
    orange = [
        np.count_nonzero((p[..., 0] > 120) & (p[..., 2] < 40) & (p[..., 1] < 110))
        for p in (pixels(plot_body(result, section=s)) for s in (None, "y"))
    ]
    assert orange[0] == 0
    assert orange[1] > 500


def test_a_frame_is_drawn_as_a_run_that_ends_there():
    beam = families.beam().with_values("parts.0.material=ecoflex-00-30")
    moving = {"record_interval": "10 ms", "time_step": "10 ms", "method": "dynamics"}
    long = vs.simulate(beam, frames=True, end_time="60 ms", **moving)
    short = vs.simulate(beam, end_time="30 ms", **moving)
    frame = int(np.flatnonzero(np.isclose(long.recording.times, 0.03))[0])
    at_end, within, last = (
        pixels(each) for each in (plot_body(short), plot_body(long, frame=frame), plot_body(long))
    )
    assert np.abs(within - at_end).max() <= 1
    assert np.abs(within - last).max() > 80
    with pytest.raises(MeshError, match="the run recorded 7"):
        plot_body(long, frame=7)
    with pytest.raises(MeshError, match="frames=True"):
        plot_body(short, frame=0)


def test_cut_voxels_are_drawn_as_the_shape_that_cuts_them():
    column = vs.Cylinder(radius=0.0095, height=0.006)
    design = vs.Design(
        name="column",
        voxel_size=0.003,
        parts=[vs.Part(shape=column, material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
    )
    for body in (vs.simulate(design), design):
        picture = body_image(body, pixels=200, view=(-90.0, 90.0))
        covered = (picture < 250).any(axis=2)
        rows, columns = covered.any(axis=1), covered.any(axis=0)
        share = covered.sum() / (rows.sum() * columns.sum())
        # Polygons with a corner for each vertex around: 24 of them miss 1 % of a disc, voxels 20 %.
        assert share == pytest.approx(np.pi / 4, rel=0.03)


def test_parts_have_colors_of_their_own():
    one, two = (vs.Voxels.from_array([[[1, last]]], voxel_size=0.005).mesh() for last in (1, 2))
    same, other = (pixels(plot_body(mesh, "part", lines=False)) for mesh in (one, two))
    assert np.abs(same - other).max() > 80


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"field": "displacment"}, "known are part, plain"),
        ({"field": [1.0, 2.0]}, "one number for each of 660 vertices"),
        ({"field": np.full(660, np.nan)}, "no finite number"),
        ({"section": ("x", -1.0)}, "leaves nothing"),
        ({"frame": 0}, "is for a result"),
    ],
)
def test_designs_that_cannot_be_drawn_are_reported(result, options, words):
    with pytest.raises(MeshError, match=words):
        plot_body(result.mesh, **options)


def test_the_space_has_units_and_lost_trials_are_distinguished():
    figure = plot_scatter(study())
    assert labels(figure) == ["radius (mm)", "height (mm)", "wall (mm)"]
    assert figure.axes[1].get_ylabel() == "rise (mm)"
    legend = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert legend == ["no-cavity (1)", "diverged (1)", "failed (1)", "best: 1 mm"]


@pytest.mark.parametrize("count", [1, 2])
def test_fewer_parameters_make_a_flat_picture(count):
    figure = plot_scatter(study(count))
    assert labels(figure) == ["radius (mm)", "rise (mm)" if count == 1 else "height (mm)"]
    pixels(figure)


def test_choices_are_ticks():
    trials = tuple(
        trial(number, {"material": name}, {"rise": 0.001})
        for number, name in enumerate(["soft", "firm", "soft"])
    )
    objectives = {"rise": Objective(maximize="displacement")}
    figure = plot_scatter(StudyResult("m", None, trials, objectives, ("material",)))
    assert [text.get_text() for text in figure.axes[0].get_xticklabels()] == ["soft", "firm"]


def test_a_study_without_any_result_can_still_be_drawn():
    lost = tuple(trial(n, {"wall": 0.005 * n}, {}, status="no-cavity") for n in (1, 2))
    objectives = {"rise": Objective(maximize="displacement")}
    empty = StudyResult("lost", None, lost, objectives, ("wall",), {"wall": "length"})
    pixels(plot_scatter(empty))
    pixels(plot_history(empty))


def test_the_history_climbs_and_marks_broken_constraints():
    figure = plot_history(study())
    axes = figure.axes[0]
    assert labels(figure) == ["trial", "rise (mm)"]
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend == ["trial", "breaks a constraint", "best", "no result"]
    best = next(line for line in axes.lines if line.get_label() == "best")
    assert best.get_ydata().tolist() == [0.0, 1.0]


def test_a_front_needs_two_objectives():
    with pytest.raises(StudyError, match="a front needs two"):
        plot_pareto(study())
    two = {"rise": Objective(maximize="displacement"), "mass": Objective(minimize="mass")}
    figure = plot_pareto(study(objectives=two))
    assert labels(figure) == ["rise (mm), to maximize", "mass (g), to minimize"]


def test_an_unknown_objective_is_refused():
    for draw in (plot_scatter, plot_history):
        with pytest.raises(StudyError, match='did you mean "rise"'):
            draw(study(), "rize")


@pytest.mark.long
def test_a_calibration_shows_search_shape_and_profiles(calibration):
    fitness = plot_fitness(calibration)
    assert fitness.axes[1].get_ylabel() == "modulus of the best (kPa)"
    assert len(fitness.axes[0].lines[0].get_xdata()) == 4
    shape = plot_shape(calibration)
    assert [axes.get_ylabel() for axes in shape.axes] == ["dz (mm)", "error (mm)"]
    drawn = [bar.get_height() for bar in shape.axes[1].patches]
    np.testing.assert_allclose(drawn, calibration.fits[0].errors * 1e3)
    profiles = plot_profiles(calibration)
    assert [axes.get_xlabel() for axes in profiles.axes] == ["edge (kPa)", "bulk (kPa)"]
    for figure in (fitness, shape, profiles):
        assert np.ptp(pixels(figure)) == 255


@pytest.mark.parametrize(
    ("values", "kind", "unit"),
    [
        ([0.001, 0.02], "length", "mm"),
        ([2.0], "length", "m"),
        ([5e-6], "length", "um"),
        ([0.0, float("nan")], "length", "mm"),
        ([4e3], "pressure", "kPa"),
        ([1.0], "number", ""),
        ([1.0], "", "SI"),
    ],
)
def test_the_unit_suits_the_largest_value(values, kind, unit):
    assert scale_for(values, kind).unit == unit
