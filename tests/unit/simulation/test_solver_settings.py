"""Whatever is said of a solver is used, or refused: every pair of settings is tried."""

import itertools
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import voxsoft as vs
from voxsoft._core import Status
from voxsoft.calibration import Experiment, Measurement
from voxsoft.design import Solver, families
from voxsoft.design.solver import OF_THE_ERROR
from voxsoft.errors import SimulationError
from voxsoft.simulation import Setup
from voxsoft.simulation.solving.choice import METHODS, USERS, kind_of, method_of, unused_settings
from voxsoft.simulation.solving.dynamics import DynamicsToRest
from voxsoft.simulation.solving.equilibrium import sentence
from voxsoft.units import kPa, mm

LATTICE = "parts.0.material=ecoflex-00-30-lattice"
REFERENCE = Path(__file__).parents[3] / "docs/reference/design-file.md"
#: A value of each setting that is not its default; of the words every one.
VALUES = [
    ("method", "statics"),
    ("method", "xpbd"),
    ("method", "relaxation"),
    ("method", "dynamics"),
    ("refine", 2),
    ("tolerance", 1e-3),
    ("control", "load"),
    ("control", "arc-length"),
    ("control", "volume"),
    ("first_step", 0.5),
    ("steps", 3),
    ("volume_ratio", 1.01),
    ("time_step", 2e-3),
    ("substeps", 40),
    ("iterations", 2),
    ("damping", 500.0),
    ("damping", "critical"),
    ("damping", "auto"),
    ("retardation", 1e-4),
    ("max_time", 0.01),
    ("end_time", 0.01),
    ("record_interval", 4e-3),
    ("frames", True),
]
MATERIALS = {
    "rubber": vs.NeoHookean(young=60 * kPa, poisson=0.4),
    "lattice": vs.Lattice(edge=60 * kPa, bulk=60 * kPa),
}


def box(material):
    outer = vs.Box(size=(15 * mm, 15 * mm, 15 * mm))
    hole = vs.Box(size=(5 * mm, 5 * mm, 5 * mm), corner=(5 * mm, 5 * mm, 5 * mm))
    return vs.Design(
        name="box",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=outer - hole, material=MATERIALS[material])],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=0.1 * kPa)],
        probes={"top": vs.Probe(z=(15 * mm, 15 * mm))},
    )


def used(result, name, value):
    """Check if a result says that it used a setting."""
    times = result.recording.times
    match name:
        case "frames":
            return len(result.recording.frames) == len(times) >= 1
        case "record_interval":
            # After the first whole step from there on, so at most one later.
            gaps = np.diff(times)[:-1]
            return bool(np.all((gaps > 0.99 * value) & (gaps < 2 * value))) and len(times) >= 1
        case "control":
            return result.solver["way"] == value
        case "method" if value in ("relaxation", "dynamics"):
            return result.solver["way"] == value
        case "damping" if value == "auto":
            return "damping" in result.solver
        case _:
            return result.solver[name] == value


def test_every_setting_has_its_users():
    assert set(Solver.model_fields) <= set(USERS)
    # Error bars come from further runs: tests/unit/comparison/test_error_bars.py.
    assert {name for name, _ in VALUES} == set(USERS) - OF_THE_ERROR


@pytest.mark.long
@pytest.mark.parametrize(
    ("material", "every"),
    [("lattice", 1), ("rubber", 4), pytest.param("rubber", 1, marks=pytest.mark.slow)],
)
def test_each_of_two_settings_is_used_or_refused(material, every):
    design = box(material)
    refused = 0
    for (one, first), (other, second) in [*itertools.combinations(VALUES, 2)][::every]:
        if one == other:
            continue
        settings = {one: first, other: second}
        try:
            result = vs.simulate(design, **settings)
        except SimulationError as error:
            refused += 1
            problems = error.problems
        else:
            problems = ()
        for problem in problems:
            name = problem.where.removeprefix("solver.")
            assert name in settings, settings
            assert f"leave {name} out" in problem.hint
        if problems:
            continue
        for name, value in settings.items():
            assert used(result, name, value), (settings, name, dict(result.solver))
    assert refused > 50 / every  # the walk met refusals at all


REFUSALS = [
    (
        {"volume_ratio": 2},
        'volume_ratio: is a setting of volume control, and the control is "load"',
    ),
    ({"volume_ratio": 2}, 'Try: write control = "volume", or leave volume_ratio out'),
    ({"steps": 7}, "steps: is a setting of arc-length control and volume control"),
    ({"steps": 7, "time_step": 0.01}, "of dynamics, and steps asks for statics"),
    ({"max_time": 1.0, "end_time": 2.0}, "of dynamics run to rest, and an end_time"),
    ({"tolerance": 1e-3, "end_time": 2.0}, "of runs to rest, and an end_time"),
    ({"method": "xpbd", "control": "load"}, 'of statics, and the method is "xpbd"'),
    ({"method": "relaxation", "damping": 5.0}, 'of dynamics, and the method is "relaxation"'),
    ({"method": "dynamics", "steps": 3}, 'volume control, and the method is "dynamics"'),
    ({"method": "statics", "damping": "auto"}, 'dynamics, and the method is "statics"'),
    ({"record_interval": 0.1}, "of dynamics, and this design is solved by the quickest"),
]


@pytest.mark.parametrize(("settings", "words"), REFUSALS)
def test_a_refusal_names_the_user_of_the_setting_and_a_remedy(settings, words):
    with pytest.raises(SimulationError, match=words):
        vs.simulate(box("lattice"), **settings)


def test_check_finds_all_refusals_of_a_run():
    design = box("rubber").with_values("solver.volume_ratio=2")
    report = vs.check(design)
    assert not report.valid
    assert [each.where for each in report.findings if each.severity == "error"] == [
        "solver.volume_ratio"
    ]
    assert vs.simulate(design, control="volume", volume_ratio=1.01).status == "ok"


@pytest.mark.parametrize("settings", [{"damping": "critical"}, {"max_time": 1.0}])
def test_settings_of_dynamics_mean_dynamics(settings):
    for material in MATERIALS:
        assert kind_of(box(material), Solver(**settings)) is DynamicsToRest


def flat(kind):
    """Flat settings that mean a kind of method, each of its fields with a value."""
    values = {name: value for name, value in VALUES if name in kind.model_fields}
    values["control"] = getattr(kind.model_fields.get("control"), "default", None)
    if kind.title == "the quickest way to rest":
        return {"tolerance": values["tolerance"]}
    return {name: value for name, value in values.items() if value is not None}


@pytest.mark.parametrize("kind", METHODS, ids=lambda kind: kind.__name__)
def test_every_method_is_meant_by_flat_settings_and_takes_them(kind):
    settings = flat(kind)
    found = method_of(box("lattice"), Solver(**settings))
    assert type(found) is kind
    assert found == kind(**settings)
    assert not list(unused_settings(box("lattice"), Solver(**settings)))


def test_a_method_refuses_settings_of_others():
    with pytest.raises(SimulationError, match="volume_ratio: is not known here"):
        METHODS[0](volume_ratio=2.0)
    assert len({kind.title for kind in METHODS}) == len(METHODS)


def test_a_record_between_two_steps_is_refused():
    settings = {"end_time": 0.01, "time_step": 0.01}
    with pytest.raises(SimulationError, match="record_interval: is shorter than the time_step"):
        vs.simulate(box("rubber"), record_interval=0.004, **settings)
    longer = vs.simulate(box("rubber"), end_time=0.1, time_step=0.05)
    assert longer.recording.times.tolist() == pytest.approx([0.0, 0.05, 0.1])


def test_a_setup_is_not_refined_afterwards():
    setup = Setup.of(box("rubber"))
    with pytest.raises(SimulationError, match=r"refine: is 2.*Setup.of\(design, refine=2\)"):
        vs.simulate(setup, refine=2)
    assert vs.simulate(Setup.of(box("rubber"), refine=2), refine=2).solver["refine"] == 2


def test_a_calibration_refuses_unused_settings():
    beam = families.beam().with_values("solver.end_time=1 s", LATTICE)
    seen = Measurement(quantities=["dz"], values=[[-0.03]], arcs=[0.04])
    with pytest.raises(SimulationError, match="end_time: is not used by calibrations"):
        vs.calibrate(Experiment(beam, seen), parameters={"edge": ("5 kPa", "50 kPa")})


def test_a_comparison_reports_unused_settings():
    design = box("rubber").with_values("solver.control=arc-length", "solver.method=statics")
    found = vs.compare(design, solvers=["statics"], outside="none", voxel_sizes=[], splits=[1])
    assert [warning.where for warning in found.warnings] == ["solver.control"]


def test_the_reference_names_the_users_of_each_key():
    text = REFERENCE.read_text(encoding="utf-8").split("| key | used by |")[1].split("\n\n")[0]
    rows = re.findall(r"^\| (`.*?) \| (.*?) \|$", text, re.MULTILINE)
    keys = {key for names, _ in rows for key in re.findall(r"`(\w+)`", names)}
    assert keys == set(Solver.model_fields)


def test_defaults_are_used_by_every_way():
    assert not list(unused_settings(box("rubber"), Solver()))


@pytest.mark.parametrize("way", ["load", "arc-length", "volume"])
@pytest.mark.parametrize("status", [Status.NOT_CONVERGED, Status.LIMIT_REACHED])
def test_no_control_is_advised_that_was_used(way, status):
    path = SimpleNamespace(factor=0.2, reached=0.0, limit=0.3, stable=True)
    words = sentence(way, status, 5, 1e-3, path)
    assert f'"{way}"' not in words
    assert "Try" in words or "follow the path with" in words
