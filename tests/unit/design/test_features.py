"""Ready features: each is a robot by itself, and stands beside others of its kind."""

import math
import tomllib

import pytest

from voxsoft.design import Design
from voxsoft.design.features import FEATURES, feature_changes
from voxsoft.errors import DesignError
from voxsoft.files.features import with_feature
from voxsoft.simulation import Setup
from voxsoft.simulation.checks.check import check

NOTHING = 'schema = "voxsoft/1"\nname = "robot"\nvoxel_size = "5 mm"  # coarse\n'
NAMES = [feature.name for feature in FEATURES]


def read(text: str) -> Design:
    return Design.from_document(tomllib.loads(text))


def volume_of_bellows(radius: float, width: float, fold: float, folds: int) -> float:
    """Volume of the room: of two truncated cones for each fold."""
    return folds * math.pi * fold / 3 * (radius**2 + radius * width + width**2)


@pytest.mark.parametrize(
    ("name", "volume"),
    [
        ("bellows", volume_of_bellows(0.009, 0.019, 0.014, 3)),
        ("finger", (0.060 - 0.008 - 0.004) * 0.012 * 0.008),
        # Rooms of 8 x 16 x 14 mm, and three pieces of the duct of 5 x 2 mm between them.
        ("chamber-row", 4 * 0.008 * 0.016 * 0.014 + 3 * 0.008 * 0.005 * 0.002),
        ("fold", None),
    ],
)
def test_a_first_feature_is_a_robot_that_can_be_solved(name, volume):
    design = read(with_feature(NOTHING, name))
    assert design.voxel_size == 0.002
    assert design.clamps
    assert design.probes
    assert [str(each) for each in check(design).findings] == []
    cavities = Setup.of(design).mesh.cavities
    if volume is None:
        assert not cavities
    else:
        (cavity,) = cavities
        # The walls of the bellows are inclined: cut voxels follow them to their second order.
        assert cavity.volume == pytest.approx(volume, rel=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_a_second_one_has_names_and_numbers_of_its_own(name):
    once = with_feature(NOTHING, name)
    twice = with_feature(once, name, at=(0.1, 0.0, 0.0))
    before, after = read(once), read(twice)
    assert len(after.parameters) == 2 * len(before.parameters)
    assert len(after.shapes) == 2 * len(before.shapes) + 1
    # Only a first one brings a part, a clamp and a load.
    assert (len(after.parts), len(after.clamps), len(after.loads)) == (1, 1, 1)
    shape = after.shapes[f"{name.replace('-', '_')}2"]
    assert shape.kind == "translate"
    assert tuple(shape.by) == (0.1, 0.0, 0.0)
    # Its comments stay.
    assert "# coarse" in twice


def test_entries_that_the_design_has_already_stay():
    text = NOTHING + '[probes]\ntop = { z = ["1 mm", "1 mm"] }\n[[loads]]\nkind = "gravity"\n'
    design = read(with_feature(text, "bellows"))
    assert [load.kind for load in design.loads] == ["gravity", "pressure"]
    assert design.probes["top"].z == (0.001, 0.001)


def test_a_feature_that_is_not_known_is_named():
    with pytest.raises(DesignError, match='no feature "belows"') as caught:
        feature_changes(tomllib.loads(NOTHING), "belows")
    assert "bellows" in str(caught.value)


def test_parameters_keep_their_names_where_these_are_free():
    once = read(with_feature(NOTHING, "bellows"))
    assert "folds" in once.parameters
    both = read(with_feature(with_feature(NOTHING, "bellows"), "finger"))
    # Both have a wall.
    assert {"wall", "finger_wall", "finger_length"} <= set(both.parameters)
    assert both.parameters["finger_wall"].value == 0.002
    assert both.parameters["wall"].value == 0.003
