"""Families: each a valid design whose file is also an example."""

from pathlib import Path

import pytest

from voxsoft.design import families
from voxsoft.errors import DesignError
from voxsoft.materials import Hyperelastic
from voxsoft.shapes import voxelize
from voxsoft.simulation import check

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.parametrize("name", families.FAMILIES)
def test_a_family_is_valid_all_over_its_ranges(name):
    design = getattr(families, name)()
    assert design.name == name
    for parameter, declared in design.parameters.items():
        for bound in (declared.min, declared.max):
            if bound is not None:
                changed = design.with_parameters(**{parameter: bound})
                assert changed.parameters[parameter].value == pytest.approx(bound, rel=1e-11)


@pytest.mark.parametrize(
    ("example", "family"),
    [
        ("beam", "paper-beam"),
        ("cylinder", "paper-cylinder"),
        ("finger", "finger"),
        ("pneunet", "pneunet"),
        ("sphere", "sphere"),
    ],
)
def test_the_example_is_the_family(example, family):
    assert (EXAMPLES / f"{example}.toml").read_text() == families.family_text(family)


@pytest.mark.parametrize("name", ["beam", "cylinder"])
def test_the_paper_has_its_lattice_in_the_shape_of_the_family(name):
    paper, family = families.family(f"paper-{name}"), families.family(name)
    assert paper.document["shapes"] == family.document["shapes"]
    assert [part.material for part in paper.parts] == ["ecoflex-00-30-lattice"]
    assert [part.material for part in family.parts] == ["ecoflex-00-30"]


@pytest.mark.long
@pytest.mark.parametrize("name", families.FAMILIES)
def test_a_family_is_rubber_and_opens_without_a_warning(name):
    design = families.family(name)
    assert all(isinstance(design.material_of(part), Hyperelastic) for part in design.parts)
    # Round ones on whole voxels have another volume, and say so.
    doubts = [
        f for f in check(design).findings if "in voxels" not in f.what and "sealed" not in f.what
    ]
    assert doubts == []


def test_beam_stations_divide_the_free_length():
    beam = families.beam(length="50 mm", height="20 mm")
    assert [beam.probes[f"station-{i}"].point[0] for i in range(1, 10)] == pytest.approx(
        [0.01 + 0.04 * i / 9 for i in range(1, 10)]
    )
    assert beam.probes["station-5"].point[1:] == pytest.approx((0.005, 0.01))


def test_an_unknown_family_suggests_one():
    with pytest.raises(DesignError, match='did you mean "pneunet"'):
        families.family("pneunets")


@pytest.mark.parametrize(
    ("name", "part", "cavities"),
    [
        ("beam", 0, 0),
        ("cylinder", 0, 1),
        ("sphere", 0, 1),
        ("pneunet", 0, 0),
        ("pneunet", 1, 1),  # the duct joins all chambers to one
    ],
)
def test_a_family_has_the_cavities_that_its_loads_need(name, part, cavities):
    design = families.family(name)
    shape = design.shapes[design.parts[part].shape]
    voxels = voxelize(shape, design.voxel_size, names=design.shapes)
    assert len(voxels.cavities) == cavities


def test_the_gyroid_fills_the_finger_in_part():
    design = families.finger()
    filled, whole = (
        voxelize(design.shapes[name], design.voxel_size, names=design.shapes).count
        for name in ("body", "outside")
    )
    # The skin alone is 1 - (10/12)^2 (36/40) = 37 % of the outside.
    assert 0.4 < filled / whole < 0.8
