"""Whole computations for CalculiX and Abaqus: units, names, sums of loads, and their account."""

import re

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_deck import calculix_deck
from voxsoft.comparison.calculix_loads import Acting, Course
from voxsoft.comparison.cautions import cautions_of_layers
from voxsoft.comparison.deck import Deck
from voxsoft.design import Contact, History, Immersion, Object, Solver
from voxsoft.errors import DesignError, FileError, SimulationError
from voxsoft.files import export, write_computation
from voxsoft.files.computations import held_in
from voxsoft.files.meshes import read_mesh_file
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

SOFT = vs.NeoHookean(young=60 * kPa, poisson=0.45, density=1000.0)
STIFF = vs.Yeoh(c=(80 * kPa, 1 * kPa), poisson=0.48, density=1200.0)
END = vs.Region(x=(20 * mm, 20 * mm))


def bar(**changes):
    """A bar of two parts, 20 x 10 x 10 mm, on voxels of 5 mm."""
    left = vs.Box(size=(10 * mm, 10 * mm, 10 * mm))
    right = vs.Box(size=(10 * mm, 10 * mm, 10 * mm), corner=(10 * mm, 0, 0))
    entries = {
        "name": "bar",
        "voxel_size": 5 * mm,
        "materials": {"soft": SOFT, "stiff": STIFF},
        "parts": [
            vs.Part(name="Left half", shape=left, material="soft"),
            vs.Part(name="right", shape=right, material="stiff"),
        ],
        "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)), name="wall")],
        "loads": [vs.Gravity()],
        "probes": {"tip": vs.Probe(x=(20 * mm, 20 * mm)), "höhe": vs.Probe(point=(0.02, 0, 0))},
    }
    return vs.Design(**(entries | changes))


def block(loads, **changes):
    """A cube of 15 mm with a cubic hole."""
    hole = vs.Box(size=(5 * mm, 5 * mm, 5 * mm), corner=(5 * mm, 5 * mm, 5 * mm))
    shape = vs.Box(size=(15 * mm, 15 * mm, 15 * mm)) - hole
    entries = {
        "name": "block",
        "voxel_size": 5 * mm,
        "parts": [vs.Part(shape=shape, material=SOFT)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "loads": loads,
        "probes": {"top": vs.Probe(z=(15 * mm, 15 * mm))},
    }
    return vs.Design(**(entries | changes))


def numbers_after(text, head):
    """The numbers of the line below the first one that begins so."""
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith(head))
    return [float(each) for each in lines[at + 1].split(",") if re.fullmatch(r"[-+.\deE ]+", each)]


@pytest.mark.parametrize(
    ("unit", "length", "stress", "density"),
    [("m", 1.0, 1.0, 1.0), ("mm", 1e3, 1e-6, 1e-12), ("um", 1e6, 1e-6, 1e-18)],
)
def test_numbers_are_in_the_units_of_the_file(unit, length, stress, density):
    push = vs.Traction(region=END, value=3 * kPa)
    text = Deck.of(bar(loads=[vs.Gravity(), push]), unit=unit).text
    assert f"** UNIT = {unit}\n" in text
    # A length of 1 m, an acceleration in it over s², mu/2 and 2/K, a mass over its cube.
    assert numbers_after(text, "*DLOAD") == pytest.approx([9.81 * length, 0, 0, -1])
    assert numbers_after(text, "*DENSITY") == pytest.approx([1000 * density])
    shear, bulk = 60e3 / 2.9, 60e3 / 0.3
    expected = [shear / 2 * stress, 2 / bulk / stress]
    assert numbers_after(text, "*HYPERELASTIC, NEO HOOKE") == pytest.approx(expected)
    pressed = re.search(r"load_1-P4, P4, (\S+)", text)
    assert float(pressed[1]) == pytest.approx(3e3 * stress)
    last = [line for line in text.split("*ELEMENT")[0].splitlines() if line[0].isdigit()][-1]
    assert float(last.split(",")[1]) == pytest.approx(0.02 * length)


def test_sets_have_the_names_of_the_design():
    deck = Deck.of(bar())
    for line in (
        "*ELSET, ELSET=Left_half",
        "*ELSET, ELSET=right",
        "*MATERIAL, NAME=soft",
        "*SOLID SECTION, ELSET=right, MATERIAL=stiff",
        "*NSET, NSET=clamp_wall",
        "*NODE PRINT, NSET=probe_tip",
        "*NODE PRINT, NSET=probe_hohe",
        "*NODE PRINT, NSET=clamp_wall, TOTALS=ONLY",
        '** REGION probe_hohe = "probe_h\\u00f6he"',
    ):
        assert f"{line}\n" in deck.text, line
    assert deck.text.isascii()
    # The clamp holds middle nodes of edges too, and the probe has vertices alone.
    assert len(deck.names.places["clamp_wall"]) == 9 + 12
    assert len(deck.names.places["probe_tip"]) == 9
    # A point on the grid is one node; one between its nodes has their weights at the beginning.
    assert len(deck.names.places["probe_hohe"]) == 1
    between = {"mid": vs.Probe(point=(12 * mm, 5 * mm, 5 * mm))}
    text = Deck.of(bar(probes=between)).text
    found = re.search(r"Weights of the nodes of probe_mid in their mean:\n\*\* - (.*)\n", text)
    weights = [float(each.split(":")[1]) for each in found[1].split(",")]
    assert sorted(weights) == pytest.approx([0.4, 0.6])


def test_parts_of_one_name_and_material_stay_apart():
    shapes = [vs.Box(size=(5 * mm,) * 3, corner=(i * 5 * mm, 0, 0)) for i in range(2)]
    parts = [vs.Part(name="same", shape=shape, material="soft") for shape in shapes]
    text = Deck.of(bar(parts=parts, probes={})).text
    assert text.count("*MATERIAL, NAME=soft\n") == 1
    assert "*SOLID SECTION, ELSET=same, MATERIAL=soft\n" in text
    assert "*SOLID SECTION, ELSET=same_2, MATERIAL=soft\n" in text


def test_loads_that_meet_are_summed():
    """CalculiX lets the sum of two pressures on a face follow the last amplitude."""
    pressures = [vs.Pressure(value=1 * kPa), vs.Pressure(value=2 * kPa)]
    pull = vs.Force(region=vs.Region(z=(15 * mm, 15 * mm)), value=(0, 0, 0.3))
    text = Deck.of(block([*pressures, pull, pull])).text
    pressed = re.findall(r"load_0-load_1-P\d, P\d, (\S+)", text)
    assert [float(each) for each in pressed] == [3e3] * 6
    assert "load_0-P" not in text
    rows = text.split("*CLOAD\n")[1].split("*")[0].splitlines()
    assert sum(float(row.split(",")[2]) for row in rows) == pytest.approx(0.6)
    assert len({row.split(",")[0] for row in rows}) == len(rows)


def test_courses_are_summed_at_all_of_their_instants():
    up, late = Course((0.0, 1.0), (0.0, 1.0)), Course((0.5, 1.5), (0.0, 2.0))
    value, course = Acting.sum([Acting(3.0, up), Acting(-1.0, late)])
    times = np.linspace(-1, 3, 41)
    expected = 3 * up.at(times) - late.at(times)
    np.testing.assert_allclose(value * course.at(times), expected, atol=1e-12)


def test_a_motion_has_an_amplitude_for_each_history():
    breath = History(time=(0, 0.1, 0.2), factor=(0, 1, 0.25))
    loads = [
        vs.Pressure(value=1 * kPa, history=breath),
        vs.Pressure(value=2 * kPa),
        vs.Gravity(history=breath),
    ]
    design = block(loads, solver=Solver(method="dynamics", end_time=0.2, damping=5.0))
    deck = Deck.of(design)
    assert deck.lost == ()
    assert "*DYNAMIC, ALPHA=0\n0.01, 0.2, 1e-09, 0.01\n" in deck.text.replace("1e-9", "1e-09")
    assert "*DAMPING, ALPHA=5\n" in deck.text
    summed = re.search(r"\*DLOAD, AMPLITUDE=(\w+)\nload_0-load_1-P1, P1, 1\n", deck.text)
    own = re.search(r"\*DLOAD, AMPLITUDE=(\w+)\nALL-ELEMENTS, GRAV, 9.81", deck.text)
    amplitudes = dict(re.findall(r"\*AMPLITUDE, NAME=(\w+)\n(.*)\n", deck.text))
    assert amplitudes[own[1]] == "0, 0, 0.1, 1, 0.2, 0.25"
    assert amplitudes[summed[1]] == "0, 2000, 0.1, 3000, 0.2, 2250"
    at_rest = Deck.of(block(loads)).text
    assert "*AMPLITUDE" not in at_rest
    assert re.findall(r"load_0-load_1-P1, P1, (\S+)", at_rest) == ["2250"]


def test_a_motion_of_rubber_of_ogden_has_a_warning():
    ogden = vs.Ogden(mu=(24 * kPa,), alpha=(2.5,), poisson=0.48)
    entries = {"materials": {"soft": SOFT, "stiff": ogden}}
    timed = Solver(method="dynamics", end_time=0.1)
    assert Deck.of(bar(**entries)).lost == ()
    (found,) = Deck.of(bar(**entries, solver=timed)).lost
    assert found.where == "parts[1].material"
    assert "does not begin to move" in found.what


def test_a_motion_with_friction_has_a_warning():
    timed = Solver(method="dynamics", end_time=0.1)
    for friction, solver, places in (
        (0.3, timed, ["contact.friction"]),
        (0.0, timed, []),
        (0.3, Solver(), []),
    ):
        design = bar(objects=[PLATE], contact=Contact(friction=friction), solver=solver)
        assert [each.where for each in Deck.of(design).lost] == places


def test_lost_entries_stand_in_the_file():
    design = bar(
        tendons=[
            {
                "name": "rope",
                "through": [[0.005, 0.005, 0.005], [0.015, 0.005, 0.005]],
                "tension": 0.1,
            }
        ],
        loads=[Immersion(value=1000.0, level=0.02), vs.Traction(region=END, value=1 * kPa)],
        solver=Solver(method="statics", control="arc-length"),
        objectives={"x": {"minimize": "tendon_tension", "tendon": "rope"}},
    )
    deck = Deck.of(design)
    places = [each.where for each in deck.lost]
    assert {"tendons[0]", "loads[0]", "solver.control"} == set(places)
    for where in places:
        assert f"** - {where}: is not held" in deck.text
    # Loads keep the numbers of the design.
    assert "load_1-P4, P4, 1000" in deck.text
    assert not any("rope" in sentence for sentence in deck.held)


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"materials": {"soft": vs.Lattice(edge=2e4, bulk=1e5), "stiff": STIFF}}, "lattice"),
        ({"materials": {"soft": vs.Gent(shear=2e4, jm=30), "stiff": STIFF}}, "gent"),
    ],
)
def test_a_material_that_is_not_there_is_refused_with_remedies(changes, where):
    with pytest.raises(SimulationError, match=rf'parts\[0\].material: .*"{where}".*voxsoft mesh'):
        Deck.of(bar(**changes))


def test_the_remedy_for_the_lattice_is_rubber_of_its_stiffness():
    lattice = vs.Lattice(edge=24 * kPa, bulk=60 * kPa)
    with pytest.raises(SimulationError) as caught:
        Deck.of(bar(materials={"soft": SOFT, "stiff": lattice}))
    remedy = re.search(r"--set '(.*?)'", str(caught.value))[1]
    found = bar(materials={"soft": SOFT, "stiff": lattice}).with_values(remedy)
    rubber = found.material_of(found.parts[1])
    assert rubber.young() == pytest.approx(lattice.young(5 * mm), rel=1e-3)  # four digits
    assert rubber.poisson == pytest.approx(lattice.poisson(5 * mm), abs=1e-3)
    assert "NAME=material_of_right\n*HYPERELASTIC, NEO HOOKE" in Deck.of(found).text


def test_layers_that_bear_compression_are_a_warning_of_a_comparison():
    film = vs.Layer(region=vs.Region(z=(0, 0)), young=50e6, thickness=0.1 * mm)
    design = bar(layers=[film, film.replace(region=vs.Region(z=(10 * mm, 10 * mm)))])
    assert [each.where for each in cautions_of_layers(design)] == ["layers[0]", "layers[1]"]
    deck = Deck.of(design, element="C3D8")
    assert [each.where for each in deck.lost] == ["layers[0]", "layers[1]"]
    assert deck.text.count("*ELEMENT, TYPE=M3D4, ELSET=layer_") == 2
    assert deck.text.count("*MEMBRANE SECTION, ELSET=layer_1, MATERIAL=layer_1\n0.0001\n") == 1
    assert "layer_0, GRAV, 9.81, 0, 0, -1\n" in deck.text
    # Elements are numbered on: 16 bricks, then 8 faces of each layer.
    assert re.search(r"TYPE=M3D4, ELSET=layer_1\n(\d+),", deck.text)[1] == "25"


@pytest.mark.parametrize("options", [{"unit": "inch"}, {"element": "C3D4"}, {"split": 9}])
def test_options_that_are_not_there_are_refused(options):
    with pytest.raises(SimulationError, match=f"{next(iter(options))}: .*Try: use"):
        Deck.of(bar(), **options)


def test_a_loose_body_is_refused_at_rest():
    with pytest.raises(SimulationError, match="clamps: hold nothing"):
        Deck.of(bar(clamps=[], floor=vs.Floor()))
    timed = Solver(method="dynamics", end_time=0.1)
    assert "*DYNAMIC, ALPHA=-0.3" in Deck.of(bar(clamps=[], floor=vs.Floor(), solver=timed)).text
    nowhere = [vs.Clamp(region=vs.Region(x=(1, 1)))]
    with pytest.raises(DesignError, match=r"clamps\[0\].region"):
        Deck.of(bar(clamps=nowhere))


def test_a_file_whose_unit_of_force_is_too_large_says_so():
    small = vs.Box(size=(0.4 * mm, 0.1 * mm, 0.1 * mm))
    entries = {
        "voxel_size": 0.1 * mm,
        "parts": [vs.Part(shape=small, material=SOFT)],
        "probes": {},
    }
    for unit, warned in (("m", True), ("mm", True), ("um", False)):
        lost = Deck.of(bar(**entries), unit=unit).lost
        assert [each.where for each in lost] == (["unit"] if warned else [])


PLATE = Object(
    name="plate",
    shape=vs.Box(size=(30 * mm, 20 * mm, 4 * mm), center=(10 * mm, 5 * mm, 13 * mm)),
    motion=vs.Motion(displacement=(0, 0, -2 * mm)),
    voxel_size=4 * mm,
)


def test_a_computation_is_read_back_with_its_parts_and_regions(tmp_path):
    design = bar(objects=[PLATE], contact=Contact(), loads=[vs.Traction(region=END, value=1e3)])
    setup = Setup.of(design)
    for unit in ("m", "mm"):
        write_computation(tmp_path / "bar.inp", design, unit=unit)
        found = read_mesh_file(tmp_path / "bar.inp")
        assert found.report.taken["parts"] == {"Left_half": 48, "right": 48}
        np.testing.assert_allclose(found.mesh.vertices, setup.mesh.vertices, atol=1e-12)
        assert set(found.regions) == {"clamp_wall", "probe_tip", "probe_höhe"}
        ends = found.mesh.vertices[found.regions["probe_tip"]]
        np.testing.assert_allclose(ends[:, 0], 20 * mm)
    cut = (tmp_path / "bar.inp").read_text().splitlines()[:-1]
    (tmp_path / "cut.inp").write_text("\n".join(cut))
    with pytest.raises(FileError, match="cut short"):
        read_mesh_file(tmp_path / "cut.inp")


def test_the_account_is_read_from_the_file(tmp_path):
    path = tmp_path / "bar.inp"
    write_computation(path, bar(objects=[PLATE], contact=Contact(friction=0.3)))
    held = held_in(path)
    assert tuple(held) == Deck.of(bar(objects=[PLATE], contact=Contact(friction=0.3))).held
    assert any(sentence.startswith('contact with "plate": friction 0.3') for sentence in held)


def test_export_writes_a_computation_or_the_mesh_alone(tmp_path):
    bar().save(tmp_path / "bar.toml")
    export(tmp_path / "bar.toml", tmp_path / "a.inp", unit="mm", element="C3D8I", split=2)
    text = (tmp_path / "a.inp").read_text()
    assert "*ELEMENT, TYPE=C3D8I" in text
    assert "128 bricks" in text
    export(tmp_path / "bar.toml", tmp_path / "b.inp", mesh_alone=True)
    assert "*ELEMENT, TYPE=C3D4" in (tmp_path / "b.inp").read_text()
    for options, what in (
        ({"unit": "cm"}, "is written in m, mm, um, not in cm"),
        ({"mesh_alone": True, "unit": "mm"}, "is in m"),
        ({"mesh_alone": True, "split": 2}, "holds no computation"),
    ):
        with pytest.raises(FileError, match=what):
            export(tmp_path / "bar.toml", tmp_path / "c.inp", **options)
    with pytest.raises(FileError, match="holds no computation"):
        export(tmp_path / "bar.toml", tmp_path / "c.msh", element="C3D8")


def test_the_step_of_an_export_is_that_of_a_comparison():
    """One writer: all but units, names and printed numbers is alike."""
    deck = Deck.of(bar())
    own = calculix_deck(BrickModel.of(Setup.of(bar())))
    cards = [
        [line for line in text.splitlines() if re.match(r"\*[A-Z]", line)]
        for text in (deck.text, own)
    ]
    kept = [
        [
            re.split(r", (?:NSET|ELSET|NAME)=", line)[0]
            for line in lines
            if not re.match(r"\*(?:NODE PRINT|NSET|NODE FILE|EL FILE|HEADING)", line)
        ]
        for lines in cards
    ]
    assert kept[0] == kept[1]
