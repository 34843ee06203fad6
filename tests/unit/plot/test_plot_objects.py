"""Rigid objects in pictures: where they are, in front of a body or behind it, and cut with it."""

from dataclasses import replace

import numpy as np
import pytest
from pressed import PLATE, POST, SIDE, pressed

import voxsoft as vs
from voxsoft.plot import plot_body
from voxsoft.plot.body import body_image
from voxsoft.plot.camera import Camera
from voxsoft.plot.cutout import cutout
from voxsoft.plot.frames import at_frame
from voxsoft.plot.objects import Surroundings, cut
from voxsoft.plot.raster import rasterize
from voxsoft.simulation import simulate
from voxsoft.units import mm

FRONT, BEHIND = (180.0, 0.0), (0.0, 0.0)


@pytest.fixture(scope="module")
def result():
    return simulate(pressed(objects=[PLATE, POST]))


@pytest.fixture(scope="module")
def beside():
    return simulate(pressed(objects=[POST], loads=[vs.Gravity()]))


def around(result):
    return Surroundings.of(result.design, result.objects)


def gray(image):
    """Number of gray pixels of a picture: neither of the body's colors nor white."""
    image = image.astype(int)
    colorless = np.ptp(image, axis=-1) <= 2
    return int((colorless & (image[..., 0] > 120) & (image[..., 0] < 240)).sum())


def test_an_object_is_gray_beside_the_body_and_hidden_behind_it(beside):
    image = body_image(beside, view=(90.0, 0.0))
    # 4 mm of the 21 mm from the post to the far side of the block, and a margin of 2 % beside each.
    meter = max(image.shape[:2]) / (1.04 * 21 * mm)
    assert gray(image) == pytest.approx((4 * mm * meter) ** 2, rel=0.15)
    free = replace(beside, design=beside.design.replace(objects=[]), objects={})
    hidden, without = (body_image(each, view=BEHIND) for each in (beside, free))
    assert np.array_equal(hidden, without)


def test_a_body_shows_through_objects_in_front_of_it(beside):
    free = replace(beside, design=beside.design.replace(objects=[]), objects={})
    with_post, without = (body_image(each, view=FRONT).astype(int) for each in (beside, free))
    assert with_post.shape == without.shape  # both hold the body alone
    covered = np.abs(with_post - without).max(axis=2) > 5
    side = with_post.shape[1] / 12.5
    assert covered.sum() == pytest.approx((4 * side) ** 2, rel=0.2)
    assert np.ptp(with_post[covered], axis=1).mean() > 20  # not gray: colors of the body in it


def test_a_frame_has_objects_where_they_were(beside):
    away = ((0.0, 0.0, 0.0), (1.0, 2.0, 3.0))
    recording = replace(
        beside.recording,
        frames=np.stack([beside.mesh.vertices, beside.positions]),
        objects={"post": (np.array(away), np.stack([np.eye(3)] * 2))},
    )
    there = at_frame(replace(beside, recording=recording), -1)
    assert there.objects["post"].position == away[1]
    assert at_frame(replace(beside, recording=recording), 0).objects["post"].position == away[0]


def test_objects_are_where_the_result_has_them(result):
    bottom = around(result).objects.vertices[:, 2]
    plate = bottom[bottom > SIDE - 3 * mm]
    assert plate.min() == pytest.approx(SIDE - 1.5 * mm, abs=5e-3 * mm)


@pytest.mark.slow
def test_pressure_pictures_leave_objects_out_by_default(result):
    def gray_of(*args, **options):
        return gray(np.asarray(255 * plot_body(result, *args, **options).axes[0].images[0]._A))

    drawn = gray_of()
    assert drawn > 10_000
    assert gray_of(objects=False) < 0.3 * drawn  # the undeformed body remains
    assert gray_of("contact_pressure") < 0.3 * drawn
    assert gray_of("contact_pressure", objects=True) > 10_000


@pytest.mark.long
def test_a_large_object_does_not_dwarf_the_body():
    floor = vs.design.Object(
        name="ground",
        shape=vs.Box(size=(300 * mm, 300 * mm, 8 * mm), center=(0, 0, -9 * mm)),
        voxel_size=8 * mm,
    )
    found = simulate(pressed(objects=[floor], loads=[vs.Gravity()]))
    shown = around(found).near(found.positions)
    assert np.ptp(shown, axis=0).max() < 3.1 * SIDE
    assert max(body_image(found, pixels=64).shape) <= 80


@pytest.mark.long
def test_a_section_cuts_objects_where_it_cuts_the_body(result):
    whole, at = around(result).objects, 6.1 * mm
    left, right = (cut(whole, "y", at, side) for side in (-1, 1))
    assert left.vertices[:, 1].max() == pytest.approx(at, abs=1e-12)
    assert right.vertices[:, 1].min() == pytest.approx(at, abs=1e-12)

    def area(surface):
        a, b, c = surface.vertices[surface.triangles].swapaxes(0, 1)
        return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()

    # Both halves have both sides of their triangles.
    assert area(left) + area(right) == pytest.approx(2 * area(whole), rel=1e-9)
    assert plot_body(result, section="y").axes


def test_a_floor_is_drawn_below_bodies_and_within_the_range_of_objects(beside):
    def under(z):
        design = beside.design.replace(floor=vs.design.Floor(z=z))
        return Surroundings.of(design, beside.objects)

    near = under(-1 * mm).near(beside.positions)
    standing = under(-1 * mm).objects.vertices
    assert near[:, 2].min() == pytest.approx(-1 * mm)
    assert near[:, 0].min() < standing[:, 0].min()  # a margin around the post
    far = under(-3 * SIDE).near(beside.positions)
    assert far[:, 2].min() == pytest.approx(0.0)
    on_floor = replace(beside, design=beside.design.replace(floor=vs.design.Floor(z=-1 * mm)))
    assert gray(body_image(on_floor)) > 1.5 * gray(body_image(beside))
    # From below the body shows through its floor.
    below = body_image(on_floor, view=(-60.0, -60.0)).astype(int)
    assert (np.ptp(below, axis=-1) > 30).sum() > 5_000


@pytest.mark.slow
def test_a_mesh_is_drawn_with_the_surroundings_that_are_given(beside):
    def drawn(**options):
        return np.asarray(255 * plot_body(beside.mesh, **options).axes[0].images[0]._A)

    surroundings = Surroundings.of(beside.design, {})
    assert gray(drawn(objects=surroundings)) > gray(drawn()) + 5_000


def test_a_transparent_picture_holds_see_through_objects(beside):
    alone = cutout(beside.mesh, view=FRONT, pixels=100).pixels
    both = cutout(beside.mesh, view=FRONT, pixels=100, around=around(beside)).pixels
    assert alone.shape == both.shape  # the post stands before the block, seen from there
    assert np.array_equal(alone[..., 3], both[..., 3])
    changed = np.abs(alone[..., :3].astype(int) - both[..., :3]).max(axis=2) > 10
    assert changed.sum() == pytest.approx((100 * 4 / 12.5) ** 2, rel=0.2)
    aside = cutout(beside.mesh, view=(90.0, 0.0), pixels=100, around=around(beside)).pixels
    post = aside[..., 3][(aside[..., 3] > 0) & (aside[..., 3] < 255)]
    assert len(post) > 200  # translucent, and so on any color of a page
    assert 100 < np.median(post) < 160


def test_a_floor_lies_behind_the_undeformed_body(result):
    under, mesh = Surroundings(floor=-0.1 * mm), result.mesh
    aside = mesh.vertices + np.array([2 * SIDE, 0.0, 0.0])
    camera = Camera.around(under.near(np.concatenate([aside, mesh.vertices])), (0.0, 90.0), 200)
    triangles = mesh.triangles.astype(np.int64)
    seen, ghost = (
        rasterize(camera.project(points), triangles, camera.width, camera.height)
        for points in (aside, mesh.vertices)
    )
    white = np.ones((camera.height, camera.width, 3))
    both = under.drawn_over(
        white, seen, camera, np.concatenate([aside, mesh.vertices]), None, ghost
    )
    drawn = (both < 1.0).any(axis=2)
    assert not drawn[ghost.covered | seen.covered].any()
    assert drawn.sum() > 1_000
