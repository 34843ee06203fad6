"""Laws of grids and meshes on random cells, against NumPy and against counting."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from voxsoft.mesh import Mesh
from voxsoft.voxels import Voxels

MU = 0.005

shapes = st.tuples(*[st.integers(1, 6)] * 3)
cells = shapes.flatmap(lambda shape: arrays(np.uint8, shape, elements=st.integers(0, 2)))
filled_cells = cells.filter(lambda array: array.any())
steps = st.tuples(*[st.integers(-4, 4)] * 3)


def euler_number_of_cubes(array):
    """V - E + F - N of the filled cubes, in doubled coordinates around each cell's corner."""
    nx, ny, nz = array.shape
    present = np.zeros((2 * nx + 1, 2 * ny + 1, 2 * nz + 1), bool)
    filled = array > 0
    for i in range(3):
        for j in range(3):
            for k in range(3):
                target = (slice(i, i + 2 * nx, 2), slice(j, j + 2 * ny, 2), slice(k, None, 2))
                block = present[target][:, :, :nz]
                block |= filled
    # The number of odd coordinates is the dimension of the corner, edge, face or cube.
    dimension = (np.indices(present.shape) % 2).sum(axis=0)
    return int(np.where(dimension % 2 == 0, 1, -1)[present].sum())


def labeled(mask):
    """Face-connected regions by repeated flooding: a list of masks."""
    left, regions = mask.copy(), []
    while left.any():
        region = np.zeros_like(mask)
        region[tuple(np.argwhere(left)[0])] = True
        while True:
            grown = region.copy()
            for axis in range(3):
                for shift in (1, -1):
                    moved = np.roll(region, shift, axis)
                    edge = [slice(None)] * 3
                    edge[axis] = 0 if shift == 1 else -1
                    moved[tuple(edge)] = False
                    grown |= moved
            grown &= mask
            if (grown == region).all():
                break
            region = grown
        regions.append(region)
        left &= ~region
    return regions


@given(filled_cells, steps)
def test_meshes_conform_and_fill_their_voxels(array, step):
    voxels = Voxels.from_array(array, MU).shift(step)
    mesh = voxels.mesh()
    quality = mesh.quality
    assert quality.conforming
    assert quality.watertight
    assert quality.smallest_tet > 0
    assert np.isclose(quality.volume, voxels.volume, rtol=1e-12)
    assert np.isclose(mesh.surface_volume, voxels.volume, rtol=1e-9)
    assert quality.euler_number == euler_number_of_cubes(array)
    assert (len(quality.nonmanifold_edges) > 0) == any(
        hinge.contact == "edge" for hinge in voxels.hinges
    )


@given(filled_cells)
def test_cavities_and_pieces_are_those_of_a_flood(array):
    voxels = Voxels.from_array(array, MU)
    padded = np.pad(array == 0, 1, constant_values=True)
    enclosed = sorted((int(r.sum()) for r in labeled(padded) if not r[0, 0, 0]), reverse=True)
    assert [cavity.count for cavity in voxels.cavities] == enclosed
    components = sorted((int(r.sum()) for r in labeled(array > 0)), reverse=True)
    assert [piece.count for piece in voxels.components()] == components
    for cavity, surface in zip(voxels.cavities, voxels.mesh().cavities, strict=True):
        assert (array[tuple(cavity.cells.T)] == 0).all()
        assert np.isclose(len(surface.triangles) * MU**2 / 2, cavity.area)


@given(cells, cells, steps)
def test_set_operations_keep_their_laws(a, b, step):
    first, second = Voxels.from_array(a, MU), Voxels.from_array(b, MU).shift(step)
    both, either, only = first & second, first | second, first - second
    assert either.count == first.count + second.count - both.count
    assert only.count == first.count - both.count
    assert (second & first).count == both.count
    assert np.isclose((only | both).volume, first.volume)


@given(filled_cells, steps)
def test_the_mesh_moves_with_its_voxels(array, step):
    even = tuple(2 * n for n in step)
    mesh = Voxels.from_array(array, MU).mesh()
    moved = Voxels.from_array(array, MU).shift(even).mesh()
    assert np.array_equal(moved.tets, mesh.tets)
    assert np.allclose(moved.vertices - mesh.vertices, np.multiply(even, MU), atol=1e-15)


@given(filled_cells)
@settings(max_examples=50)
def test_given_tets_find_the_same_mesh(array):
    mesh = Voxels.from_array(array, MU).mesh()
    again = Mesh.from_tets(mesh.vertices, mesh.tets[:, [1, 0, 2, 3]], mesh.tet_part)
    assert np.array_equal(again.edges, mesh.edges)
    assert again.quality.conforming
    assert len(again.triangles) == len(mesh.triangles)
    assert np.isclose(again.surface_volume, mesh.surface_volume, rtol=1e-9)


@given(cells)
def test_thickness_is_bounded_by_the_box(array):
    walls = Voxels.from_array(array, MU).wall_thickness
    assert ((walls.cells > 0) == (array > 0)).all()
    assert walls.cells.max(initial=0) <= min(array.shape)
