"""The grid: making, filling, combining and measuring it."""

import pickle

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design.discretization.discretize import voxels_of
from voxsoft.errors import MeshError, VoxelError
from voxsoft.voxels import Voxels

MM = 1e-3


def random_cells(shape=(4, 5, 6), seed=0):
    return np.random.default_rng(seed).integers(0, 4, shape, dtype=np.uint8)


def voxels(seed=0, origin=(0.0, 0.0, 0.0)):
    return Voxels.from_array(random_cells(seed=seed), voxel_size=5 * MM, origin=origin)


def hollow_block():
    block = Voxels.empty((5, 5, 7), voxel_size=5 * MM).fill_box((0, 0, 0), (1, 1, 1))
    return block.fill_box((5 * MM,) * 3, (20 * MM, 20 * MM, 30 * MM), part=0)


def test_an_array_comes_back_as_it_went_in():
    cells = random_cells()
    for given in (cells, np.asfortranarray(cells), cells.astype(np.int64), cells[::-1][::-1]):
        assert np.array_equal(Voxels.from_array(given, 0.1).array, cells)
    boolean = Voxels.from_array(cells > 1, 0.1)
    assert np.array_equal(boolean.array, (cells > 1).astype(np.uint8))


def test_a_grid_cannot_be_changed():
    grid = voxels()
    with pytest.raises(ValueError, match="read-only"):
        grid.array[0, 0, 0] = 1
    with pytest.raises(AttributeError):
        grid.voxel_size = 2.0
    before = grid.array.copy()
    assert grid.with_cell((0, 0, 0), part=9) != grid
    assert np.array_equal(grid.array, before)


def test_changing_the_source_array_does_not_change_the_grid():
    cells = random_cells()
    grid = Voxels.from_array(cells, 0.1)
    cells[:] = 0
    assert grid.count > 0


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (0.013, -7.77, 0.005)])
def test_a_grid_survives_pickling(origin):
    grid = voxels(origin=origin)
    assert pickle.loads(pickle.dumps(grid)) == grid
    assert pickle.loads(pickle.dumps(grid.pad(3))) == grid.pad(3)


def test_measures():
    grid = Voxels.empty((4, 5, 6), voxel_size=0.5, origin=(1.0, 0.0, -1.0))
    grid = grid.with_cell((1, 2, 3), 7).with_cell((2, 2, 5))
    assert (grid.count, grid.volume, grid.part_counts) == (2, 0.25, {1: 1, 7: 1})
    assert grid.center_of_mass == (2.0, 1.25, 1.25)
    assert grid.bounds.tolist() == [[1.5, 1.0, 0.5], [2.5, 1.5, 2.0]]
    assert repr(grid) == "Voxels(4 x 5 x 6 cells of 500 mm, 2000 x 2500 x 3000 mm, 2 filled)"


def test_set_operations_agree_with_numpy():
    a, b = voxels(seed=1), voxels(seed=2)
    filled = b.array > 0
    assert np.array_equal((a | b).array, np.where(a.array > 0, a.array, b.array))
    assert np.array_equal((a & b).array, np.where(filled, a.array, 0))
    assert np.array_equal((a - b).array, np.where(filled, 0, a.array))


def test_set_operations_use_positions_and_not_indices():
    a = Voxels.from_array(np.ones((2, 1, 1), int), voxel_size=0.1)
    moved = a.shift((1, 0, 0))
    assert (a | moved).array.ravel().tolist() == [1, 1, 1]
    assert (a & moved).array.ravel().tolist() == [0, 1]
    assert (a - moved).array.ravel().tolist() == [1, 0]
    assert (a | a.shift((-1, 0, 0))).origin == (-0.1, 0.0, 0.0)


@pytest.mark.parametrize(("axis", "number"), [("x", 0), ("y", 1), ("z", 2)])
def test_flips_agree_with_numpy(axis, number):
    assert np.array_equal(voxels().flip(axis).array, np.flip(voxels().array, number))


def test_padding_and_cropping_keep_the_content_in_place():
    grid = voxels().with_cell((0, 0, 0)).with_cell((3, 4, 5))
    padded = grid.pad((1, 0, 2), after=3)
    assert padded.shape == (8, 8, 11)
    assert padded.bounds == pytest.approx(grid.bounds)
    assert padded.center_of_mass == pytest.approx(grid.center_of_mass)
    assert padded.crop() == grid


def test_a_sphere_and_a_tube_have_their_volume():
    grid = Voxels.empty((60, 60, 60), voxel_size=1 * MM)
    center = (30 * MM, 30 * MM, 30 * MM)
    # A cell at the surface counts whole or not at all, which averages out.
    ball = grid.fill_sphere(center, radius=25 * MM)
    assert ball.volume == pytest.approx(4 / 3 * np.pi * (25 * MM) ** 3, rel=0.01)
    tube = grid.fill_tube(center, 20 * MM, 10 * MM, height=25 * MM, axis=(0, 1, 1))
    assert tube.volume == pytest.approx(np.pi * 300 * 25 * MM**3, rel=0.02)
    assert ball.center_of_mass == pytest.approx(center)


def test_components_tell_contacts_apart():
    cells = np.zeros((3, 3, 3), int)
    cells[0, 0, 0] = cells[0, 1, 1] = cells[1, 2, 2] = 1
    grid = Voxels.from_array(cells, 0.1)
    counts = [len(grid.components(contact)) for contact in ("face", "edge", "corner")]
    assert counts == [3, 2, 1]
    component = grid.components("corner")[0]
    assert component.cells.tolist() == [[0, 0, 0], [0, 1, 1], [1, 2, 2]]
    assert component.bounds == pytest.approx(np.array([[0, 0, 0], [0.2, 0.3, 0.3]]))


def test_a_cavity_has_volume_area_bounds_and_cells():
    (cavity,) = hollow_block().cavities
    assert cavity.count == len(cavity.cells) == 45
    assert cavity.volume == pytest.approx(45 * (5 * MM) ** 3)
    assert cavity.area == pytest.approx(78 * (5 * MM) ** 2)
    assert cavity.bounds == pytest.approx(np.array([[5, 5, 5], [20, 20, 30]]) * MM)
    assert hollow_block().with_cell((2, 2, 0), part=0).cavities == ()


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: Voxels.empty((0, 1, 1), 0.1), "shape: got 0; allowed are whole numbers 1 to"),
        (lambda: Voxels.empty((2.5, 1, 1), 0.1), "shape: got 2.5; allowed are whole numbers"),
        (lambda: Voxels.empty((1, 1), 0.1), "three numbers"),
        (lambda: Voxels.empty((1, 1, 1), 0.0), "voxel_size: .* positive"),
        (lambda: Voxels.empty((1, 1, 1), float("nan")), "voxel_size"),
        (lambda: Voxels.empty((1, 1, 1), 0.1, origin=(0, 0, np.inf)), "origin: .* finite"),
        (lambda: Voxels.empty((1, 1, 1), 1e-12, origin=(1, 0, 0)), "closer to the origin"),
        (lambda: Voxels.empty((65000, 65000, 65000), 0.1), "needs 274625000000000 bytes"),
        (lambda: Voxels.from_array([[1]], 0.1), "has 2 dimensions"),
        (lambda: Voxels.from_array([[[0.5]]], 0.1), "holds float64"),
        (lambda: Voxels.from_array([[[256]]], 0.1), "holds 256 to 256"),
        (lambda: Voxels.from_array([[[-1]]], 0.1), "0 .empty. to 255"),
        (lambda: Voxels.from_array(np.zeros((0, 1, 1), int), 0.1), "shape"),
        (lambda: voxels().with_cell((4, 0, 0)), "outside the grid"),
        (lambda: voxels().with_cell((0, 0, 0), part=256), "part: got 256"),
        (lambda: voxels().fill_sphere((0, 0, 0), radius=-1), "radius: got -1"),
        (lambda: voxels().fill_tube((0, 0, 0), 1.0, 2.0, 1.0), "inner_radius"),
        (lambda: voxels().fill_cylinder((0, 0, 0), 1, 1, axis=(0, 0, 0)), "no direction"),
        (lambda: voxels().fill_cylinder((0, 0, 0), 1, 1, axis="w"), "axis: got 'w'"),
        (lambda: voxels().fill_random(1.5, seed=0), "probability"),
        (lambda: voxels().fill_random(0.5, seed=-1), "seed"),
        (lambda: voxels().flip("w"), "axis: got 'w'"),
        (lambda: voxels().pad(-1), "before: got -1"),
        (lambda: voxels().pad(70000), "each axis may have 65000"),
        (lambda: voxels().shift((0.5, 0, 0)), "whole numbers"),
        (lambda: voxels().components("side"), "face, edge, corner"),
        (lambda: voxels() | Voxels.empty((1, 1, 1), 0.1), "must be equal"),
        (lambda: voxels() & voxels(origin=(1 * MM, 0, 0)), "only whole numbers align"),
        (lambda: Voxels.empty((1, 1, 1), 0.1).crop(), "nothing to crop"),
        (lambda: Voxels.empty((1, 1, 1), 0.1).center_of_mass, "no filled cell"),
        (lambda: Voxels.empty((1, 1, 1), 0.1).bounds, "no filled cell"),
    ],
)
def test_bad_input_is_named(make, match):
    with pytest.raises(VoxelError, match=match):
        make()


def test_an_empty_grid_has_no_mesh():
    with pytest.raises(MeshError, match="no filled cell"):
        Voxels.empty((2, 2, 2), 0.1).mesh()


def test_a_mesh_over_the_available_memory_is_refused(monkeypatch):
    monkeypatch.setattr("voxsoft.mesh.memory_limit", lambda: 1000)
    with pytest.raises(MeshError, match=r"27 voxels needs about \d+ bytes.*1000"):
        Voxels.from_array(np.ones((3, 3, 3), int), 0.1).mesh()


def test_leaks_name_the_cell_where_they_open():
    block = Voxels.empty((12, 12, 12), voxel_size=0.1).fill_box((0, 0, 0), (2, 2, 2))
    chamber = block.fill_box((0.3, 0.3, 0.3), (0.9, 0.9, 0.9), part=0)
    assert chamber.leaks == ()
    assert len(chamber.cavities) == 1
    bored = chamber.fill_box((0.5, 0.4, 0.9), (0.6, 0.5, 1.2), part=0)
    (leak,) = bored.leaks
    assert bored.cavities == ()
    assert (leak.count, leak.width, leak.openings) == (216, 1, ((5, 4, 9),))
    assert bored.with_cell(leak.openings[0]).leaks == ()
    wide = chamber.fill_box((0.5, 0.4, 0.9), (0.7, 0.6, 1.2), part=0)
    assert [leak.width for leak in wide.leaks] == [2]


def test_a_ring_of_one_cell_leaks_only_where_a_face_is_open():
    # The cells of a thin ring touch diagonally; no air gets through.
    grid = Voxels.empty((21, 21, 6), voxel_size=1 * MM)
    center = (10.5 * MM, 10.5 * MM)
    ring = grid.fill_tube((*center, 0), 10 * MM, 8.5 * MM, height=6 * MM)
    lids = grid.fill_cylinder((*center, 0), 10 * MM, 1 * MM)
    lids = lids.fill_cylinder((*center, 5 * MM), 10 * MM, 1 * MM)
    closed = ring | lids
    assert len(closed.cavities) == 1
    assert closed.leaks == ()
    side = closed.with_cell((1, 10, 2), part=0).with_cell((0, 10, 2), part=0)
    assert side.cavities == ()
    assert [leak.openings for leak in side.leaks] == [((1, 10, 2),)]


def test_hinges_are_edges_and_corners():
    cells = np.zeros((3, 3, 3), int)
    cells[0, 0, 0] = cells[0, 1, 1] = cells[1, 2, 2] = 1
    hinges = Voxels.from_array(cells, 0.1).hinges
    assert [hinge.contact for hinge in hinges] == ["edge", "corner"]
    assert hinges[1].cells == ((0, 1, 1), (1, 2, 2))
    assert hollow_block().hinges == ()


def test_walls_are_counted_in_voxels():
    grid = hollow_block()
    assert grid.wall_thickness.thinnest.thickness == 1
    assert grid.wall_thickness.cells[0, 2, 3] == 1
    assert grid.wall_thickness.cells[2, 2, 3] == 0
    assert sum(grid.wall_thickness.histogram) == grid.count
    assert [wall.thickness for wall in grid.cavity_walls] == [1]
    assert Voxels.empty((1, 1, 1), 0.1).wall_thickness.thinnest is None


def test_rims_of_round_bodies_are_no_walls():
    cone = vs.Cone(radius=15 * MM, top_radius=7 * MM, height=40 * MM)
    rubber = vs.NeoHookean(young=60e3)
    for shape in (vs.Sphere(radius=11 * MM), vs.Cylinder(radius=9 * MM, height=9 * MM), cone):
        for size in (1 * MM, 1.7 * MM, 2.5 * MM, 4 * MM):
            cells = voxels_of(
                vs.Design(
                    name="round", voxel_size=size, parts=[vs.Part(shape=shape, material=rubber)]
                )
            )
            assert cells.wall_thickness.thinnest.thickness > 1
