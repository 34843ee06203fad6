"""Other parameters of a design: the same as if all of it were read anew."""

import tomllib

import pytest

from voxsoft.design import Design, families
from voxsoft.design.families import FAMILIES, family_text
from voxsoft.design.robots import ROBOTS, robot_text
from voxsoft.errors import DesignError, VoxSoftError

DESIGNS = {name: family_text(name) for name in FAMILIES} | {
    each.name: robot_text(each.name) for each in ROBOTS
}
HOLLOW = {
    "name": "hollow",
    "voxel_size": "2 mm",
    "parameters": {"a": "20 mm", "b": {"value": "5 mm", "min": "0 mm", "max": "30 mm"}},
    "shapes": {
        "outer": {"kind": "box", "size": ["= a", "= a", "= a"]},
        "inner": {"kind": "sphere", "radius": "= b", "center": ["10 mm", "10 mm", "10 mm"]},
        "body": {"kind": "difference", "of": ["outer", "inner"]},
    },
    "parts": [{"shape": "body", "material": "ecoflex-00-30"}],
    "clamps": [{"region": {"z": [0, 0]}}],
    "loads": [{"kind": "gravity", "history": "up"}],
    "probes": {"top": {"point": ["= a", 0, 0]}},
    "objectives": {"sag": {"minimize": "displacement", "probe": "top"}},
}


def read_anew(design, **values):
    """The design with other parameters from its whole document."""
    return Design._read(design._source, values, design._typed or None)


def outcome(make, *arguments, **values):
    """All that a design says, or the error in its place."""
    try:
        made = make(*arguments, **values)
    except VoxSoftError as error:
        return str(error)
    return made, made.hash, made.document, made.empty_shapes, made._typed, made.to_toml()


@pytest.mark.parametrize("factor", [0.0, 0.5, 0.9, 1.0, 1.3, 40.0])
@pytest.mark.parametrize("name", sorted(DESIGNS))
def test_a_family_follows_each_parameter(name, factor):
    design = Design.from_document(tomllib.loads(DESIGNS[name]))
    for key, parameter in design.parameters.items():
        value = {key: type(parameter.value)(factor * parameter.value)}
        assert outcome(design.with_parameters, **value) == outcome(read_anew, design, **value)


@pytest.mark.parametrize("b", ["5 mm", "7 mm", "0 mm", "31 mm", "2 kPa"])
@pytest.mark.parametrize("before", ["5 mm", "0 mm"])
@pytest.mark.parametrize("end", ["= a / (1 mm/s)", "= (a + b) / (1 mm/s)", "3 s"])
def test_vanished_shapes_and_histories_follow(end, before, b):
    # From a design with the inner shape, and from one without it, to both.
    histories = {"up": {"time": ["0 s", end], "factor": [0, 1]}}
    design = Design.from_document({**HOLLOW, "histories": histories}, {"b": before})
    assert outcome(design.with_parameters, b=b) == outcome(read_anew, design, b=b)


def test_entries_that_no_parameter_changes_are_not_read_again():
    beam = families.beam()
    longer = beam.with_parameters(length="110 mm")
    assert longer.loads is beam.loads or longer.loads[0] is beam.loads[0]
    assert longer.shapes != beam.shapes


def test_a_name_that_a_vanished_shape_leaves_behind_is_reported():
    region = {"region": {"shape": "inner"}}
    document = {**HOLLOW, "loads": [], "clamps": [{"region": {"z": [0, 0]}}, region]}
    design = Design.from_document(document)
    with pytest.raises(DesignError, match='the shape "inner" is empty at these parameters'):
        design.with_parameters(b="0 mm")
