"""`check` says where a number is likely in another unit than was meant."""

import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.design.families import FAMILIES
from voxsoft.units import kPa, mm


def reported(design):
    report = vs.check(design)
    return {finding.where: finding for finding in report.findings if finding.hint}


def block(**entries):
    given = {
        "name": "block",
        "voxel_size": 2 * mm,
        "parts": [{"shape": vs.Box((40 * mm, 40 * mm, 20 * mm)), "material": "ecoflex-00-30"}],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "loads": [vs.Gravity()],
    }
    return vs.Design(**{**given, **entries})


def test_meters_for_millimeters():
    box = {"shape": vs.Box((40, 40, 20)), "material": "ecoflex-00-30"}
    found = reported(block(voxel_size=2, parts=[box]))
    assert found.keys() >= {"voxel_size", "parts"}
    assert "2 m" in found["voxel_size"].what
    assert 'write 2*mm or "2 mm"' in found["parts"].hint
    texts = [str(each) for each in vs.check(block(voxel_size=2, parts=[box])).findings]
    assert any("40 m long" in text for text in texts)
    assert any("mass of 3" in text and text.count(",") > 1 for text in texts)
    assert vs.check(block(voxel_size=2, parts=[box])).valid  # a warning, and no error


@pytest.mark.parametrize(
    ("loads", "words"),
    [
        (vs.Pressure(value=3), "3 Pa is less than 5 mm of water"),
        (vs.Pressure(value=-3), "3 Pa is less"),
        (vs.Traction(region=vs.Region(z=(0, 0)), value=4), "4 Pa is less"),
        (vs.Traction(region=vs.Region(z=(0, 0)), value=(0, 0, -4)), "4 Pa is less"),
        (vs.Gravity(value=9810), "is 1,000 g"),
    ],
)
def test_loads_in_other_units(loads, words):
    assert words in reported(block(loads=[loads]))["loads[0].value"].what
    assert reported(block(loads=[{"kind": "pressure", "value": 2 * kPa}])).keys() <= {"loads[0]"}


def test_a_file_states_its_units(tmp_path):
    block(loads=[vs.Traction(region=vs.Region(z=("20 mm", "20 mm")), value=4)]).save(
        tmp_path / "a.toml"
    )
    assert "loads[0].value" not in reported(vs.load(tmp_path / "a.toml"))


@pytest.mark.parametrize(
    ("material", "words"),
    [
        (vs.NeoHookean(young=60), "Young's modulus of 60 Pa, softer than"),
        (vs.Lattice(edge=20, bulk=30), "softer than"),
        (vs.NeoHookean(young="60 kPa", density=1.07), "density of 1.07 kg/m^3"),
        (vs.NeoHookean(young="60 kPa", density=1.07e6), "density of 1070000 kg/m^3"),
    ],
)
def test_materials_in_other_units(material, words):
    part = {"shape": vs.Box((40 * mm, 40 * mm, 20 * mm)), "material": material}
    assert words in reported(block(parts=[part]))["parts[0].material"].what


@pytest.mark.long
@pytest.mark.parametrize("name", FAMILIES)
def test_ready_families_are_plausible(name):
    units = ("written", "*mm", "in m:", "in Pa", "kg/m^3")
    for finding in vs.check(families.family(name)).findings:
        assert not any(word in finding.hint for word in units), finding
