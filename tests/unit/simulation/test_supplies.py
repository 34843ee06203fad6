"""Supplies of a design: reading, and refusals with their places."""

import json

import pytest
from typer.testing import CliRunner

import voxsoft as vs
from voxsoft.cli.app import app
from voxsoft.design import (
    Connection,
    FlowSupply,
    Gas,
    Liquid,
    MassSupply,
    PressureSupply,
    VolumeSupply,
)
from voxsoft.design.fluid import ROOM
from voxsoft.errors import DesignError, NoCavityError, SimulationError
from voxsoft.simulation import Setup, simulate
from voxsoft.studio.outputs.html import page_of
from voxsoft.units import kPa, mm

SIDE = 12 * mm
RUBBER = vs.NeoHookean(young=200 * kPa, poisson=0.45, density=1070)


def cube(*supplies, open_to_the_air=False, **changes):
    """A cube of rubber with a chamber, or a cup, on a plate."""
    inside = (4 * mm, 4 * mm, 8 * mm if open_to_the_air else 4 * mm)
    shape = vs.Box(size=(SIDE,) * 3) - vs.Box(size=inside, corner=(4 * mm,) * 3)
    entries = {
        "name": "cube",
        "voxel_size": 4 * mm,
        "parts": [vs.Part(shape=shape, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "chambers": {"inside": vs.Chamber(point=(6 * mm,) * 3)},
        "supplies": supplies,
    }
    return vs.Design(**(entries | changes))


SYRINGE = VolumeSupply(chamber="inside", value="20 uL")


@pytest.mark.parametrize(
    "supply",
    [
        PressureSupply(chamber="inside", value="-20 kPa", leak={"conductance": "1 L/s/bar"}),
        VolumeSupply(chambers=("inside",), value="-1 mL", fluid="water", name="syringe"),
        MassSupply(chamber=0, temperature="60 degC", fill_temperature="10 degC"),
        MassSupply(chamber="all", value="1 g", fluid=Liquid(density="900 kg/m^3")),
        FlowSupply(
            chamber="inside",
            source="50 kPa",
            valve={"conductance": "0.1 L/s/bar", "critical_ratio": 0.4},
            tube={"length": "1 m", "diameter": "2 mm"},
            line_volume="2 mL",
            fluid=Gas(gas_constant=188.9),
            history={"time": (0, "1 s"), "factor": (0, 1)},
        ),
        FlowSupply(chamber="inside", pump={"flow": ("2 L/min", 0), "pressure": (0, "40 kPa")}),
    ],
    ids=lambda supply: supply.kind,
)
def test_written_files_equal_those_read(supply):
    design = cube(supply)
    again = vs.Design.from_document(design.document)
    assert again == design
    assert again.supplies == (supply,)
    text = design.to_toml()
    assert f'kind = "{supply.kind}"' in text


def test_temperatures_have_units():
    assert MassSupply(chamber=0, temperature="60 degC").temperature == 333.15
    assert MassSupply(chamber=0, temperature="300 K").temperature == 300.0
    assert MassSupply(chamber=0).temperature == ROOM


def test_a_file_gives_temperatures_a_unit():
    document = cube(MassSupply(chamber=0)).document
    document["supplies"][0]["temperature"] = 300.0
    with pytest.raises(DesignError, match=r"supplies\[0\].temperature: 300.0 has no unit"):
        vs.Design.from_document(document)


def refusal(error, make):
    with pytest.raises(error) as caught:
        make()
    return str(caught.value)


@pytest.mark.parametrize(
    ("kind", "entries", "expected"),
    [
        ("pressure", {"value": "-150 kPa"}, "no absolute pressure is below zero"),
        ("flow", {"source": "-2 bar", "valve": {"conductance": 1e-9}}, "absolute pressure"),
        ("mass", {"temperature": "-300 degC"}, "nothing is colder than 0 K"),
        ("mass", {"temperature": "0 K"}, "nothing is colder than 0 K"),
        ("mass", {"temperature": "warm"}, "is not a temperature"),
        ("flow", {"source": "50 kPa"}, "neither a valve nor a tube"),
        ("flow", {"valve": {"conductance": 1e-9}}, 'neither "source" and "pump"'),
        ("flow", {"source": 1, "valve": {"area": 1e-6}}, "has an area"),
        (
            "flow",
            {"source": 1, "fluid": "water", "valve": {"conductance": 1e-9}},
            "has a sonic conductance",
        ),
        ("flow", {"source": 1, "valve": {}}, 'neither of "conductance" and "area"'),
        (
            "flow",
            {
                "source": 1,
                "valve": {"conductance": 1e-9, "history": {"time": (0,), "factor": (2,)}},
            },
            "valve.history: opens it to 2",
        ),
        ("flow", {"pump": {"flow": (1e-5, 1e-6), "pressure": (0, 1e4)}}, "does not fall to 0"),
        ("flow", {"pump": {"flow": (1e-5, 0), "pressure": (1e3, 1e4)}}, "does not rise from 0"),
        ("volume", {"value": "5 kPa"}, "expected a volume"),
        ("mass", {"value": "-1 g"}, "is not positive"),
        ("volume", {"value": "5 mL", "chambers": ("inside",)}, 'has both "chamber"'),
        ("volume", {"value": "5 mL", "chamber": None}, 'has neither "chamber"'),
        ("volume", {"value": "5 mL", "chamber": "outside"}, 'no chamber "outside"'),
    ],
)
def test_invalid_supplies_are_refused_with_their_place(kind, entries, expected):
    message = refusal(
        DesignError, lambda: cube({"chamber": "inside", "kind": kind, "line_volume": 0} | entries)
    )
    assert expected in message
    assert "supplies[0]" in message
    assert "Try: " in message


def test_a_syringe_needs_a_closed_chamber():
    message = refusal(
        NoCavityError,
        lambda: simulate(cube(SYRINGE.replace(chamber="all"), open_to_the_air=True, chambers={})),
    )
    assert "supplies[0]: there is no closed chamber to fill" in message


@pytest.mark.parametrize(
    "other", [{"supplies": (SYRINGE, SYRINGE)}, {"loads": [vs.Pressure(value=kPa)]}]
)
def test_two_that_drive_one_chamber_contradict(other):
    message = refusal(DesignError, lambda: simulate(cube(SYRINGE).replace(**other)))
    assert "contradict" in message
    assert "chamber inside" in message
    assert "supplies[0]" in message


def test_a_connection_joins_two_chambers():
    tube = {"length": "1 m", "diameter": "1 mm"}
    message = refusal(DesignError, lambda: Connection(chambers=(0, 0), tube=tube))
    assert "does not join two chambers" in message
    message = refusal(DesignError, lambda: Connection(chambers=(0, 1)))
    assert "neither a valve nor a tube" in message


def test_settings_that_supplies_do_not_know_are_refused():
    for solver in (
        {"method": "relaxation"},
        {"method": "xpbd"},
        {"method": "statics", "control": "arc-length"},
        {"method": "statics", "control": "volume"},
    ):
        assert "supplies" in refusal(
            SimulationError, lambda how=solver: simulate(cube(SYRINGE), **how)
        )
    late = {"method": "dynamics", "end_time": 0.1, "substeps": 3}
    assert "knows no supplies" in refusal(SimulationError, lambda: simulate(cube(SYRINGE), **late))


def test_who_does_not_know_supplies_says_so():
    design = cube(SYRINGE)
    assert "supplies: are not known to" in refusal(DesignError, lambda: page_of(design))
    halved = design.replace(symmetry=[{"plane": "y", "at": SIDE / 2}])
    assert "supplies: is not known together with planes of symmetry" in refusal(
        DesignError, lambda: simulate(halved)
    )


def test_results_and_metrics_report_supplies():
    found = simulate(cube(SYRINGE.replace(name="syringe")))
    (chamber,) = found.supplies
    assert chamber.name == "syringe"
    assert found.cavity_pressures == (chamber.pressure,)
    assert found.metric("chamber_pressure", cavity="inside") == chamber.pressure
    assert found.metric("supplied_work") == chamber.work > 0.0
    assert found.metric("supplied_energy") == chamber.energy > chamber.work
    assert found.metric("supply_efficiency") == chamber.work / chamber.energy
    assert found.metrics["supplied_work"] == chamber.work
    (summary,) = found.summary()["supplies"]
    assert summary["efficiency"] == chamber.work / chamber.energy
    assert found.summary()["cavities"][0]["pressure"] == chamber.pressure


def test_a_gas_spring_is_no_pressure_load():
    """Sealed gas pushes back when a body swings."""
    sealed = simulate(cube(SYRINGE))
    given = simulate(cube(loads=[vs.Pressure(value=sealed.supplies[0].pressure)]))
    assert given.positions == pytest.approx(sealed.positions, abs=1e-7)
    swings = [vs.modes(each, 12).frequencies for each in (sealed, given)]
    assert (swings[0] - swings[1]).max() > 1e-3 * swings[1][0]


def test_a_pressure_load_is_a_chamber_pressure_too():
    found = simulate(cube(loads=[vs.Pressure(value=3 * kPa)]))
    assert found.metric("chamber_pressure") == 3 * kPa
    assert found.metric("supplied_work") == found.metric("supply_efficiency") == 0.0
    # Nothing is supplied: a list that nobody asked for leaves it out.
    assert not {"chamber_pressure", "supplied_work", "supplied_energy"} & found.metrics.keys()
    assert found.supplies == ()


def test_a_body_of_another_design_brings_its_supplies():
    inner = cube(SYRINGE)
    pair = vs.Design(
        name="pair",
        voxel_size=4 * mm,
        bodies=[
            vs.design.Body(name="a", design=inner),
            vs.design.Body(name="b", design=inner, position=(30 * mm, 0, 0)),
        ],
    )
    setup = Setup.of(pair)
    assert setup.fluids is not None
    assert setup.fluids.names == ("a.inside", "b.inside")
    assert [volume.cavities for volume in setup.fluids.volumes] == [(0,), (1,)]


def test_the_command_line_tells_them_too(tmp_path, monkeypatch):
    file = tmp_path / "cube.toml"
    cube(SYRINGE).save(file)
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["run", str(file), "--json", "--error", "off"])
    (printed,) = json.loads(done.stdout)["supplies"]
    assert printed["name"] == "inside"
    assert printed["pressure"] > 0.0
    assert set(printed) >= {"volume", "mass", "flow", "work", "energy", "efficiency"}


def test_states_outside_the_laws_are_reported_with_their_place():
    """A syringe that draws water below its vapor pressure, and a thin tube with a strong source."""
    drawn = simulate(cube(VolumeSupply(chamber="inside", value="-60 uL", fluid="water")))
    assert drawn.supplies[0].pressure < -101 * kPa
    (found,) = (each for each in drawn.warnings if "boils" in each.what)
    assert found.where == "supplies[0]"
    short = {"length": "20 mm", "diameter": "0.5 mm"}
    jet = FlowSupply(chamber="inside", source="300 kPa", tube=short, line_volume="50 mL")
    blown = simulate(cube(jet), method="dynamics", end_time=0.01, time_step=0.002)
    (found,) = (each for each in blown.warnings if "Reynolds" in each.what)
    assert found.where == "supplies[0].tube"
