"""Bodies on the grid, which cut voxels, the default of rubber, leave as they are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import voxsoft as vs
from voxsoft.design.discretization.discretize import mesh_of

ARRAYS = (
    *("vertices", "tets", "edges", "triangles", "tet_part", "tet_voxel"),
    *("fractions", "moments", "surfaces"),
)


def boxes(size, corner, chamber, two_parts):
    outer = vs.Box(size=tuple(7 * size for _ in range(3)), corner=corner)
    low = tuple(at + size for at in corner)
    room = vs.Box(size=tuple(n * size for n in chamber), corner=low)
    shapes = {"body": outer - room}
    parts = [{"shape": "body", "material": "ecoflex-00-30"}]
    if two_parts:
        shapes["end"] = vs.Box(size=(7 * size, 7 * size, 2 * size), corner=corner) - room
        parts.insert(0, {"shape": "end", "material": "dragon-skin-30"})
    return vs.Design(name="boxes", voxel_size=size, shapes=shapes, parts=parts)


def assert_same(cut, binary):
    for name in ARRAYS:
        first, second = getattr(cut, name), getattr(binary, name)
        assert (first is None) == (second is None), name
        assert first is None or np.array_equal(first, second), name
    assert [c.volume for c in cut.cavities] == [c.volume for c in binary.cavities]


@settings(max_examples=20, deadline=None)
@given(
    size=st.floats(1e-4, 2e-2),
    corner=st.tuples(*3 * [st.integers(-50, 50)]),
    chamber=st.tuples(*3 * [st.integers(1, 5)]),
    two_parts=st.booleans(),
    refine=st.integers(1, 2),
)
def test_boxes_on_the_grid_have_the_mesh_of_full_voxels(size, corner, chamber, two_parts, refine):
    at = tuple(n * size for n in corner)
    design = boxes(size, at, chamber, two_parts)
    assert design.has_cut_voxels
    assert_same(mesh_of(design, refine), mesh_of(design.replace(fill="binary"), refine))


@pytest.mark.parametrize("off", [0.01, 0.3])
def test_boxes_off_the_grid_are_cut(off):
    design = boxes(0.005, (0.0, 0.0, 0.0), (3, 3, 3), two_parts=False)
    room = vs.Box(size=(0.01, 0.01, (2 + off) * 0.005), corner=(0.005, 0.005, 0.005))
    outer = vs.Box(size=(0.035, 0.035, 0.035), corner=(0, 0, 0))
    assert mesh_of(design.replace(shapes={"body": outer - room})).fractions is not None


def test_default_follows_the_materials_and_decides_the_hash():
    rubber = boxes(0.005, (0.0, 0.0, 0.0), (3, 3, 3), two_parts=False)
    springs = rubber.with_values("parts.0.material=ecoflex-00-30-lattice")
    assert rubber.has_cut_voxels
    assert not springs.has_cut_voxels
    assert rubber.hash == rubber.replace(fill="fraction").hash != rubber.replace(fill="binary").hash
    assert springs.hash == springs.replace(fill="binary").hash
