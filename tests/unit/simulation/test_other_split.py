"""Both splits of the faces of voxels: effect of pressure, and volumes of cavities."""

import itertools

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Objective
from voxsoft.geometry import enclosed_volume
from voxsoft.materials import Lattice, NeoHookean
from voxsoft.metrics.chambers import CAVITY_VOLUME
from voxsoft.simulation import Setup
from voxsoft.simulation.derivatives.loaded_state import LoadedState
from voxsoft.simulation.setup.other_split import OtherSplit
from voxsoft.units import mm

SIZE = 2.5 * mm
RUBBER = NeoHookean(young=1e5, poisson=0.4, density=1000.0)
SPRINGS = Lattice(edge=6e4, bulk=4e5, density=1000.0)
PRESSURE = 100.0


def shell(material=RUBBER, fill="fraction", **changes):
    return vs.Design(
        name="shell",
        voxel_size=SIZE,
        fill=fill,
        parts=[
            {"shape": vs.Sphere(radius=20 * mm) - vs.Sphere(radius=11 * mm), "material": material}
        ],
        clamps=[{"region": {"z": (0, 0)}}],
        loads=[vs.Pressure(value=PRESSURE)],
        **changes,
    )


def moved(mesh):
    """Positions far from rest, but with no voxel inside out."""
    noise = np.random.default_rng(7).standard_normal(mesh.vertices.shape)
    return 1.2 * mesh.vertices + 0.1 * SIZE * noise


def pressure_forces(setup, positions):
    return setup.problem.net_forces(positions) - setup.problem.elastic(positions)[1]


def test_splits_enclose_one_volume_at_rest_and_bilinear_faces_on_the_mean():
    setup = Setup.of(shell(fill="binary"))
    (cavity,) = setup.mesh.cavities
    for triangles, _ in cavity.splits:
        assert enclosed_volume(triangles, setup.mesh.vertices) == pytest.approx(cavity.volume)
    # The empty cells themselves: the mean of det F over eight points of each is exact.
    positions = moved(setup.mesh)
    assert cavity.volume_at(positions) == pytest.approx(_air(setup.mesh, positions), rel=1e-12)


def _air(mesh, positions):
    """Divergence theorem over the bilinear faces of the cavity, at 2 x 2 points of each."""
    grid = {tuple(key): i for i, key in enumerate(np.rint(mesh.vertices / SIZE).astype(int))}
    total = 0.0
    weights = np.array([[1 - s, 1 + s] for s in (-1 / np.sqrt(3), 1 / np.sqrt(3))]) / 2
    slopes = np.array([-1.0, 1.0]) / 2
    for triangle in mesh.cavities[0].triangles:
        keys = np.rint(mesh.vertices[triangle] / SIZE).astype(int)
        normal = np.cross(keys[1] - keys[0], keys[2] - keys[0])
        axis = int(np.flatnonzero(normal)[0])
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        low = keys.min(axis=0)
        corners = [[positions[grid[tuple(low + i * u + j * v)]] for j in (0, 1)] for i in (0, 1)]
        for s, t in itertools.product(weights, weights):
            x = np.einsum("i,j,ijk->k", s, t, corners)
            along = np.einsum("i,j,ijk->k", slopes, t, corners)
            across = np.einsum("i,j,ijk->k", s, slopes, corners)
            # The normal points into the air; each face is met twice, by both of its triangles.
            total -= np.sign(normal[axis]) * float(x @ np.cross(along, across)) * 4 / 4 / 3 / 2
    return total


@pytest.mark.parametrize("fill", ["binary", "fraction"])
def test_pressure_is_the_slope_of_the_volume_and_moves_nothing_as_a_whole(fill):
    setup = Setup.of(shell(fill=fill))
    positions = moved(setup.mesh)
    forces = pressure_forces(setup, positions)
    slope = CAVITY_VOLUME.slope(LoadedState(setup, positions), Objective(maximize="cavity_volume"))
    scale = np.abs(forces).max()
    # Rounding of sums of some dozen terms.
    assert np.abs(forces - PRESSURE * slope).max() < 1e-12 * scale
    assert np.abs(forces.sum(axis=0)).max() < 1e-11 * scale
    assert np.abs(np.cross(positions, forces).sum(axis=0)).max() < 1e-11 * scale * 20 * mm
    (cavity,) = setup.mesh.cavities
    step = 1e-4 * SIZE * np.random.default_rng(8).standard_normal(positions.shape)
    change = cavity.volume_at(positions + step) - cavity.volume_at(positions - step)
    assert change == pytest.approx(2 * float(np.vdot(slope, step)), rel=1e-7)


def test_a_corner_gets_a_quarter_of_each_face():
    setup = Setup.of(shell(fill="binary"))
    rest = setup.mesh.vertices
    pulls = np.abs(pressure_forces(setup, rest)) / (PRESSURE * SIZE**2)
    assert np.abs(4 * pulls - np.rint(4 * pulls)).max() < 1e-9


def test_an_open_surface_shares_whole_faces_evenly_and_no_others():
    top_face = {"z": (5 * mm, 5 * mm)}
    plate = vs.Design(
        name="plate",
        voxel_size=SIZE,
        parts=[
            {
                "shape": vs.Box(
                    size=(20 * mm, 20 * mm, 5 * mm), center=(10 * mm, 10 * mm, 2.5 * mm)
                ),
                "material": RUBBER,
            }
        ],
        clamps=[{"region": {"x": (0, 0)}}],
        loads=[vs.Traction(value=PRESSURE, region=top_face)],
    )
    for value in (PRESSURE, (0.0, 0.0, -PRESSURE)):
        loaded = plate.replace(loads=[vs.Traction(value=value, region=top_face)])
        setup = Setup.of(loaded)
        forces = pressure_forces(setup, setup.mesh.vertices)
        rest = setup.mesh.vertices
        inner = (np.abs(rest[:, :2] - 10 * mm) < 9 * mm).all(axis=1)
        top = inner & (rest[:, 2] > 4.9 * mm)
        assert forces[top, 2] == pytest.approx(-PRESSURE * SIZE**2)
    lone = setup.mesh.triangles[:1]
    assert (setup.other_split.triangles(lone) == lone).all()


@pytest.mark.parametrize(("inside", "is_split"), [(SPRINGS, False), (RUBBER, True)])
def test_springs_keep_the_triangles_that_are_their_surface(inside, is_split):
    """The material beside the air decides in a shell of two materials."""
    outside = SPRINGS if is_split else RUBBER
    design = shell().replace(
        parts=[
            {"shape": vs.Sphere(radius=18 * mm) - vs.Sphere(radius=11 * mm), "material": inside},
            {
                "shape": vs.Sphere(radius=20 * mm) - vs.Sphere(radius=18 * mm),
                "material": outside,
            },
        ]
    )
    (cavity,) = Setup.of(design).mesh.cavities
    (triangles, _), (others, _) = cavity.splits
    assert (triangles == others).all() != is_split


def test_a_body_of_springs_has_one_split():
    assert len(Setup.of(shell(SPRINGS)).mesh.cavities[0].splits) == 1


def test_a_mesh_that_is_not_made_of_voxels_has_no_other_split():
    design = shell()
    whole = Setup.of(design).mesh
    # Three tetrahedra, where a voxel has five.
    used, tets = np.unique(whole.tets[:3], return_inverse=True)
    mesh = vs.Mesh.from_tets(whole.vertices[used], tets.reshape(-1, 4))
    kept = OtherSplit.of(design, mesh).triangles(mesh.triangles)
    assert np.array_equal(kept, mesh.triangles)
