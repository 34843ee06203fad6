"""Smooth surfaces of parts: closed, with the volumes that are simulated, unloaded and moved."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from voxsoft import Design, Part, mesh_of
from voxsoft.design.body import Body
from voxsoft.shapes import Box, Sphere, voxelize
from voxsoft.simulation.setup.smooth_surfaces import part_volumes, smooth_surfaces
from voxsoft.simulation.setup.volumes import volumes_of

#: Relative difference of volumes that is allowed; the surface is moved to 1e-5.
VOLUME = 1e-4
MM = 1e-3


def design(parts, voxel_size, **changes):
    made = [Part(name=name, shape=shape, material="ecoflex-00-30") for name, shape in parts.items()]
    return Design(name="smooth", parts=made, voxel_size=voxel_size, **changes)


def ball_with_core(**changes):
    ball = Sphere(radius=10 * MM)
    return design({"skin": ball.shell(3 * MM), "core": ball}, 2 * MM, **changes)


def bodies(surfaces):
    return {
        name: trimesh.Trimesh(points, triangles, process=False)
        for name, (points, triangles) in surfaces.items()
    }


def moved(mesh):
    """Positions of vertices after a turn, a stretch and a bend."""
    x, y, z = mesh.vertices.T
    return np.stack([1.2 * x + 8.0 * z**2, y - 0.3 * x, z + 5.0 * x * y], axis=1)


def assert_sound(body, volume):
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume == pytest.approx(volume, rel=VOLUME)


@pytest.mark.parametrize("fill", ["fraction", "binary"])
def test_parts_have_the_simulated_volumes_and_share_a_surface(fill):
    body = ball_with_core(fill=fill)
    mesh = mesh_of(body)
    simulated = volumes_of(body, mesh).parts
    assert abs(simulated["skin"].difference) > 0.03  # other than those of the shapes
    found = smooth_surfaces(body, mesh)
    parts = bodies(found.surfaces())
    for name, volume in simulated.items():
        assert_sound(parts[name], volume.simulated)
    one, other = (set(map(bytes, parts[name].vertices)) for name in ("skin", "core"))
    # All of the core lies in the skin: their surfaces have those points in common, to the bit.
    assert other < one
    assert sum(part.volume for part in parts.values()) == pytest.approx(mesh.volume, rel=VOLUME)


@pytest.mark.parametrize("fill", ["fraction", "binary"])
def test_a_moved_surface_has_the_volumes_of_the_moved_mesh(fill):
    body = ball_with_core(fill=fill)
    mesh = mesh_of(body)
    positions = moved(mesh)
    volumes = part_volumes(replace(mesh, vertices=positions), 2)
    found = bodies(smooth_surfaces(body, mesh).surfaces(positions))
    for name, volume in zip(("skin", "core"), volumes, strict=True):
        assert_sound(found[name], volume)


def test_a_surface_follows_a_linear_motion_exactly():
    body = design({"ball": Sphere(radius=7 * MM)}, 2 * MM)
    mesh = mesh_of(body)
    motion = np.array([[1.1, 0.3, 0.0], [0.0, 0.9, -0.2], [0.1, 0.0, 1.0]])
    found = smooth_surfaces(body, mesh)
    expected = found.at().points @ motion.T
    # Volumes are reached to 1e-5, by a move that is as small.
    assert found.at(mesh.vertices @ motion.T).points == pytest.approx(expected, abs=1e-4 * 7 * MM)


def test_faces_and_corners_of_a_box_off_the_grid_are_flat_and_sharp():
    size = np.array([21.3, 11.7, 9.1]) * MM
    body = design({"box": Box(size=tuple(size), center=(0, 0, 0))}, 2 * MM)
    points = smooth_surfaces(body, mesh_of(body)).at().points
    off = np.abs(np.abs(points) - size / 2).min(axis=1)
    # The filled parts of cut voxels are good to some thousandths, and the surface has their volume.
    assert off.max() < 5e-3 * 2 * MM
    assert np.abs(points).max(axis=0) == pytest.approx(size / 2, abs=5e-3 * 2 * MM)


@pytest.mark.long
@pytest.mark.parametrize("thickness", [0.7, 0.9, 1.2, 1.6])
def test_a_wall_thinner_than_a_voxel_stays_closed(thickness):
    ball = Sphere(radius=12 * MM, center=(0.3 * MM, 0.7 * MM, 0.1 * MM))
    body = design({"wall": ball.shell(thickness * MM)}, 2 * MM)
    mesh = mesh_of(body)
    assert len(mesh.cavities) == 1
    (found,) = bodies(smooth_surfaces(body, mesh).surfaces()).values()
    assert_sound(found, mesh.volume)
    assert found.body_count == 2  # the outer surface, and that of the cavity


def test_material_without_a_voxel_is_left_out():
    crumb = Sphere(radius=0.6 * MM, center=(9.5 * MM, 0.5 * MM, 0.5 * MM))
    body = design({"box": Box(size=(16 * MM, 8 * MM, 8 * MM), center=(0, 0, 0)) | crumb}, 2 * MM)
    (found,) = bodies(smooth_surfaces(body, mesh_of(body)).surfaces()).values()
    assert found.body_count == 1


def test_bodies_are_at_their_places():
    own = {"left": (0.0, 0.0, 0.0), "right": (30 * MM, 0.0, 0.0)}
    finger = design({"finger": Box(size=(7 * MM, 7 * MM, 15 * MM), center=(0, 0, 0))}, 2 * MM)
    both = Design(
        name="both",
        voxel_size=2 * MM,
        bodies=[
            Body(name=name, design=finger, position=place, rotation={"axis": [0, 1, 0], "angle": 1})
            for name, place in own.items()
        ],
    )
    mesh = mesh_of(both)
    found = bodies(smooth_surfaces(both, mesh).surfaces())
    assert set(found) == set(volumes_of(both.assembled, mesh).parts)
    for part, place in zip(found.values(), own.values(), strict=True):
        assert_sound(part, 7 * 7 * 15 * MM**3)
        assert part.center_mass == pytest.approx(place, abs=1e-6)
        assert np.ptp(part.vertices[:, 0]) == pytest.approx(
            (7 * np.cos(1) + 15 * np.sin(1)) * MM, abs=0.02 * 2 * MM
        )


def test_voxels_of_other_shapes_have_no_smooth_surface():
    body = design({"box": Box(size=(40 * MM, 40 * MM, 40 * MM), center=(0, 0, 0))}, 2 * MM)
    ball = voxelize(Sphere(radius=10 * MM), 2 * MM).mesh()
    assert smooth_surfaces(body, ball) is None
