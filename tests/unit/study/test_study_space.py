"""The space of a study: forms that a user may type, and refusals."""

import lattice_families as families
import pytest
from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution
from study_families import block

from voxsoft.errors import StudyError
from voxsoft.study import Choices, Range
from voxsoft.study.space import read_space, space_of


def test_the_default_family_spans_the_105_designs_of_the_paper():
    space = space_of(families.cylinder())
    assert {name: (d.low, d.high, d.step) for name, d in space.items()} == {
        "radius": (0.005, 0.025, 0.005),
        "height": (0.005, 0.035, 0.005),
        "wall": (0.005, 0.015, 0.005),
    }


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ((0.5, 2.0), FloatDistribution(0.5, 2.0)),
        ((1, 5), IntDistribution(1, 5)),
        ((2, 10, 4), IntDistribution(2, 10, step=4)),
        ((0.0, 1.0, 0.25), FloatDistribution(0.0, 1.0, step=0.25)),
        ((1e3, 1e6, "log"), FloatDistribution(1e3, 1e6, log=True)),
        (("5 mm", "15 mm", "5 mm"), FloatDistribution(0.005, 0.015, step=0.005)),
        (["ecoflex-00-30", "00-50"], CategoricalDistribution(["ecoflex-00-30", "00-50"])),
        ([1, 2, 4], CategoricalDistribution([1, 2, 4])),
        (Range(low=1, high=2), IntDistribution(1, 2)),
        (Choices(values=[True, False]), CategoricalDistribution([True, False])),
    ],
)
def test_every_way_to_write_a_domain(given, expected):
    assert read_space({"x": given}, None)["x"].distribution == expected


def test_a_range_that_is_no_multiple_of_its_step_ends_at_the_last_one():
    assert Range(low=0.0, high=1.0, step=0.3).distribution == FloatDistribution(0.0, 0.9, step=0.3)


@pytest.mark.parametrize(
    ("space", "message"),
    [
        ({}, "space: is empty"),
        ({"wal": (0.005, 0.01)}, 'space.wal: is not a parameter.*did you mean "wall"'),
        ({"wall": (0.01, 0.005)}, "space.wall: runs from 0.01 to 0.005"),
        ({"wall": (0.005, 0.015, 0.1)}, "space.wall.step: 0.1 does not fit"),
        ({"wall": (0.005, 0.015, -0.001)}, "space.wall.step: -0.001 does not fit"),
        ({"wall": ("5 kPa", "15 kPa")}, 'space.wall: "5 kPa" has another unit'),
        ({"wall": (0.005, 0.1)}, "space.wall: 100 mm is outside the bounds"),
        ({"wall": 0.005}, r"space.wall: 0.005 is no range.*write \(low, high\)"),
        ({"wall": []}, "space.wall.values: "),
        ({"wall": ["thin"]}, 'space.wall: "thin" does not start with a number'),
    ],
)
def test_a_wrong_space_is_named(space, message):
    with pytest.raises(StudyError, match=message):
        read_space(space, families.cylinder())


def test_a_logarithmic_range_is_positive_and_has_no_step():
    with pytest.raises(StudyError, match="low: is -1"):
        Range(low=-1, high=1, log=True)
    with pytest.raises(StudyError, match="step: cannot be kept"):
        Range(low=1.0, high=10.0, step=1.0, log=True)


def test_a_design_without_ranges_says_how_to_write_one():
    with pytest.raises(StudyError, match="no parameter of the design has both a min and a max"):
        space_of(block())
