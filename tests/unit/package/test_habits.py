"""Habits of people: print, ask for help, press Tab, pass arrays and quantities."""

import inspect
import pydoc
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest
from forms import all_models

import voxsoft as vs
from voxsoft.design import families
from voxsoft.errors import DesignError, SimulationError, UnitError, VoxSoftError
from voxsoft.simulation import Setup
from voxsoft.study.space import read_space
from voxsoft.units import mm

UREG = pint.UnitRegistry()
BEAM = families.beam(length="40 mm")


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """Objects that a user prints."""
    study = vs.Study(
        families.cylinder(),
        {"wall": ["10 mm", "15 mm"]},
        folder=tmp_path_factory.mktemp("study"),
    )
    with ThreadPoolExecutor(2) as threads:
        studied = study.grid(executor=threads)
    measured = vs.Measurement.read(
        Path(__file__).parents[3] / "examples/data/paper_beams/ecoflex-00-30.csv"
    )
    return {
        "design": BEAM,
        "setup": Setup.of(BEAM),
        "result": vs.simulate(BEAM),
        "check": vs.check(BEAM),
        "settled": vs.simulate_many(BEAM, load_factors=[0.5])[0],
        "study": study,
        "study result": studied,
        "measurement": measured,
        "experiment": vs.Experiment(families.beam(), measured),
    }


def test_printed_objects_are_short(shown):
    for name, each in shown.items():
        assert len(repr(each)) < 200, name
        assert "\n" not in repr(each), name
        if name != "design":  # which prints as its file
            assert len(str(each)) < 1000, name
    text = str(shown["result"])
    assert text.startswith("beam: ok, equilibrium after")
    assert "station-9: moved (" in text
    assert "sag: " in text
    assert str(shown["check"]).startswith("valid\n  32 voxels, mass 4.28 g")
    assert "cylinder: 2 trials: 2 ok\n  1. rise " in str(shown["study result"])
    assert "wall 10 mm" in str(shown["study result"])


def test_notebooks_show_the_same(shown):
    assert "<table" in shown["study result"]._repr_html_()
    for name in ("result", "check", "settled"):
        assert shown[name]._repr_html_().startswith("<pre>")


def test_records_print_entries_that_are_no_defaults():
    assert repr(vs.Sphere(0.01)) == "Sphere(radius=0.01)" == str(vs.Sphere(0.01))
    assert repr(vs.Pressure(value=1e3)) == "Pressure(value=1000.0)"
    assert repr(vs.NeoHookean(young=6e4)) == "NeoHookean(young=60000.0)"


@pytest.mark.parametrize("model", all_models(), ids=lambda model: model.__name__)
def test_a_signature_is_readable(model):
    text = str(inspect.signature(model))
    assert len(text) < 1500
    for word in ("Annotated", "UnitOf", "Constraints", "pydantic", "NoneType", "Undefined"):
        assert word not in text
    names = {info.alias or name for name, info in model.model_fields.items()}
    assert set(inspect.signature(model).parameters) <= names
    inspect.signature(model).bind(
        **{name: None for name, info in model.model_fields.items() if info.is_required()}
        if not any(info.alias for info in model.model_fields.values())
        else {(i.alias or n): None for n, i in model.model_fields.items() if i.is_required()}
    )


def test_signatures_in_words():
    assert str(inspect.signature(vs.Sphere)) == (
        "(radius: Length, *, center: (Length, Length, Length) = (0.0, 0.0, 0.0))"
    )
    assert "shape: str | Shape | None = None" in str(inspect.signature(vs.Probe))
    kinds = "Gravity | Pressure | Force | Traction | MagneticField | Immersion | Drag | ForceField"
    assert f"loads: [{kinds}, ...] = ()" in str(inspect.signature(vs.Design))


def test_help_does_not_spell_pydantic_out():
    for model in (vs.Design, vs.Probe, vs.Sphere):
        text = pydoc.render_doc(model, renderer=pydoc.plaintext)
        for word in ("Annotated", "FieldInfo", "__pydantic", "parse_raw", "model_construct"):
            assert word not in text


def test_tab_offers_useful_names():
    offered = {name for name in dir(vs.Sphere(1)) if not name.startswith("_")}
    assert {"radius", "center", "kind", "translate", "replace", "bounds"} <= offered
    assert not {name for name in offered if name.startswith(("model_", "parse_"))}
    assert not offered & {"dict", "json", "copy", "construct", "from_orm", "schema", "validate"}
    assert {"loads", "replace", "save"} <= set(dir(BEAM))


def test_shapes_take_required_fields_by_position():
    assert vs.Sphere(10 * mm) == vs.Sphere(radius=0.01)
    assert vs.Cylinder(5 * mm, "20 mm") == vs.Cylinder(radius=0.005, height=0.02)
    assert vs.Gyroid(0.01, 0.001) == vs.Gyroid(period=0.01, thickness=0.001)
    both = vs.Union(vs.Sphere(1), vs.Box((1, 1, 1)))
    assert both == vs.Union(of=(vs.Sphere(1), vs.Box(size=(1, 1, 1)))) == vs.Union(both.of)
    for wrong in (
        lambda: vs.Sphere(1, 2),
        lambda: vs.Sphere(1, radius=2),
        lambda: vs.Part("body", "ecoflex-00-30"),
    ):
        with pytest.raises(TypeError, match=r"by (position|name)"):
            wrong()


def test_numbers_come_as_arrays_series_and_generators():
    expected = [0.25, 0.5, 1.0]
    found = vs.simulate_many(BEAM, load_factors=expected)
    for factors in (
        np.array(expected),
        pd.Series(expected, index=[7, 8, 9]),
        tuple(expected),
        (f for f in expected),
        np.array(expected, dtype=np.float32),
    ):
        again = vs.simulate_many(BEAM, load_factors=factors)
        assert all(
            np.array_equal(a.positions, b.positions) for a, b in zip(again, found, strict=True)
        )
    soft = (vs.Lattice(edge=e, bulk=6e4) for e in np.linspace(2e4, 4e4, 2))
    assert len(vs.simulate_many(BEAM, soft, load_factors=np.ones(2))) == 2
    assert len(vs.simulate_many(BEAM, ["ecoflex-00-30", "ecoflex-00-50"])) == 2
    for wrong in (np.ones((2, 2)), 3.0, "abc", [None]):
        with pytest.raises(SimulationError, match="load_factors"):
            vs.simulate_many(BEAM, load_factors=wrong)
    with pytest.raises(SimulationError, match="have 1 and 2 entries"):
        vs.simulate_many(BEAM, [vs.Lattice(edge=1e4, bulk=1e4)], load_factors=np.ones(2))


def test_points_and_tables_come_as_arrays():
    point = np.array([1e-3, 2e-3, 3e-3])
    assert vs.Sphere(1, center=point).center == tuple(point)
    assert vs.Probe(point=pd.Series(point)).point == tuple(point)
    ramp = vs.History(time=np.linspace(0, 1, 3), factor=(f for f in range(3)))
    assert (ramp.time, ramp.factor) == ((0.0, 0.5, 1.0), (0.0, 1.0, 2.0))
    assert vs.Sphere(np.float32(0.5)).radius == 0.5
    walls = np.linspace(0.01, 0.015, 3)
    space = read_space({"wall": walls}, families.cylinder())
    assert space["wall"].values == pytest.approx(walls)
    ring = vs.Prism(np.array([[0, 0], [1, 0], [0, 1]]) * mm, 1 * mm)
    assert ring.points[1] == (0.001, 0.0)


def test_quantities_of_pint_are_taken_as_numbers_with_units():
    length = 10 * UREG.mm
    assert vs.Sphere(length).radius == 0.01
    assert vs.Sphere(1, center=np.array([1, 2, 3]) * UREG.cm).center == (0.01, 0.02, 0.03)
    assert vs.Pressure(value=UREG.Quantity(2, "psi")).value == pytest.approx(13789.5, rel=1e-5)
    assert vs.Parameter(value=length, max=UREG.Quantity(2, "cm")).kind == "length"
    assert families.beam(length=80 * UREG.mm).parameters["length"].value == 0.08
    assert BEAM.with_values(voxel_size=2.5 * UREG.mm).voxel_size == 0.0025
    assert vs.Rotation(axis=(0, 0, 1), angle=90 * UREG.degree).angle == pytest.approx(np.pi / 2)
    space = read_space({"wall": (10 * UREG.mm, 1.5 * UREG.cm)}, families.cylinder())
    assert (space["wall"].low, space["wall"].high) == (0.01, 0.015)
    for wrong in (2 * UREG.kPa, 3 * UREG.kelvin, np.array([1, 2]) * UREG.mm, UREG.Quantity(3, "")):
        with pytest.raises(
            VoxSoftError, match=r"expected a length|not a mechanical|not one number"
        ):
            vs.Sphere(radius=wrong)


def test_plain_arguments_take_units_too():
    design = BEAM.replace(
        parts=[
            {"shape": "body", "material": {"model": "lattice", "edge": "30 kPa", "bulk": "20 kPa"}}
        ]
    )
    for interval in ("50 ms", 0.05, 50 * UREG.ms):
        result = vs.simulate(design, end_time="0.2 s", record_interval=interval)
        assert result.recording.times == pytest.approx([0, 0.05, 0.1, 0.15, 0.2], abs=0.012)
    for wrong, words in (
        (-1, "record_interval: -1 s is not positive"),
        (0, "record_interval: 0 is not positive"),
        ("5 mm", "expected a time"),
        ("abc", "does not start with a number"),
        (np.nan, "not a finite number"),
    ):
        with pytest.raises(UnitError, match=words):
            vs.simulate(design, end_time="0.2 s", record_interval=wrong)
    ball = vs.voxelize(vs.Sphere("5 mm"), 0.001)
    assert vs.voxelize(vs.Sphere("5 mm"), "1 mm") == ball
    assert vs.voxelize(vs.Sphere("5 mm"), "1 mm", ((0, 0, 0), ("1 cm",) * 3)).shape == (10, 10, 10)
    cells = np.ones((3, 3, 3), int)
    grid = vs.Voxels.from_array(cells, "5 mm", ("1 cm", 0, 1 * UREG.inch))
    assert grid == vs.Voxels.from_array(cells, 0.005, (0.01, 0, 0.0254))
    empty = vs.Voxels.empty((9, 9, 9), "1 mm")
    assert empty.fill_sphere(("4 mm",) * 3, "3 mm") == empty.fill_sphere((0.004,) * 3, 0.003)
    with pytest.raises(VoxSoftError, match="expected a length"):
        vs.Voxels.from_array(cells, "5 kPa")
    raw = vs.materials.CompliantLattice(edge_compliance="0.2 m/N", volume_compliance="0.05 m^3/Pa")
    assert raw.to_moduli("5 mm", "20 kPa") == raw.to_moduli(0.005, 20e3)
    assert vs.Ogden.from_classic(["10 kPa"], [2.0]) == vs.Ogden.from_classic([10e3], [2.0])
    assert vs.History(time=("0 s", "1 s"), factor=(0, 1)).at("250 ms") == 0.25
    found = vs.compare(
        design,
        solvers=["statics"],
        outside="none",
        voxel_sizes=["10 mm"],
        splits=np.array([1]),
        time_limit="1 min",
    )
    assert [run.label for run in found.runs] == ["statics, 5 mm", "statics, 10 mm"]
    assert vs.voxelize(vs.Sphere("5 mm"), voxel_size=1 * UREG.mm).voxel_size == 0.001


@pytest.mark.parametrize(
    "use",
    [vs.simulate, vs.check, vs.simulate_many, vs.Study, vs.mesh_of, vs.voxels_of, vs.compare],
    ids=lambda use: use.__name__,
)
def test_a_path_in_place_of_a_design_learns_how_to_load_it(use):
    arguments = ([vs.Lattice(edge=1e4, bulk=1e4)],) if use is vs.simulate_many else ()
    for path in ("pad.toml", Path("pad.toml")):
        with pytest.raises(
            DesignError, match=r'"pad.toml" came; expected a Design.*vs\.load\("pad'
        ):
            use(path, *arguments)
    with pytest.raises(DesignError, match="int came; expected a Design"):
        use(3, *arguments)


def test_a_design_can_be_a_key():
    kept = {BEAM: 1}
    assert kept[families.beam(length="40 mm")] == 1
    assert families.beam(length="50 mm") not in kept


def test_showing_a_design_loads_no_optimizer():
    """Its import warns of missing progress bars in a notebook."""
    import subprocess
    import sys

    code = (
        "import sys; from voxsoft.design import families; families.beam(length='40 mm').show()"
        "._repr_html_(); print(*({'optuna', 'scipy.stats', 'tqdm'} & sys.modules.keys()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (done.stdout.strip(), done.stderr) == ("", "")
