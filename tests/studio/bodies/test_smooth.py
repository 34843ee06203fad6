"""The smooth shape is that of the body which is simulated."""

import itertools

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import families
from voxsoft.design.discretization.discretize import voxels_of
from voxsoft.shapes.tracing import trace
from voxsoft.studio.bodies.body import StudioBody
from voxsoft.studio.bodies.smooth import pack_smooth


def traced(design):
    shapes = [part.shape for part in design.parts]
    named = [design.shapes[each] if isinstance(each, str) else each for each in shapes]
    voxels = voxels_of(design)
    return voxels, *trace([shape.build(design.shapes) for shape in named], voxels)


def cross(a, b):
    """The cross product of vectors in a plane."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def crossings(vertices, triangles, axis, at):
    """Crossings of a line along an axis with a surface, in order; `at` has the others."""
    others = [other for other in range(3) if other != axis]
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    flat_a, flat_b, flat_c, point = a[:, others], b[:, others], c[:, others], np.asarray(at)
    area = cross(flat_b - flat_a, flat_c - flat_a)
    area = np.where(area == 0.0, np.inf, area)  # those along the line are met by their neighbors
    u = cross(point - flat_a, flat_c - flat_a) / area
    v = cross(flat_b - flat_a, point - flat_a) / area
    where = a[:, axis] + u * (b - a)[:, axis] + v * (c - a)[:, axis]
    met = np.isfinite(area) & (u >= 0) & (v >= 0) & (u + v <= 1)
    return np.sort(where[met])


def test_the_page_knows_where_shapes_cut_voxels():
    bodies = [StudioBody.of(each(), 0, 1) for each in (families.sphere, families.pneunet)]
    assert [body.event().cut for body in bodies] == [True, False]


def test_equal_slots_are_equal_and_as_wide_as_in_the_voxels():
    design = families.pneunet()
    voxels, vertices, triangles, _ = traced(design)
    size, origin = voxels.voxel_size, np.asarray(voxels.origin)
    # Along the finger through its chambers' outer walls, near the top: off any sample and face.
    filled = voxels.array > 0
    height = filled.any(axis=(0, 1)).nonzero()[0].max()
    row = filled[:, :, height].any(axis=0).nonzero()[0].min()
    at = origin[1:] + size * (np.array([row, height]) + 0.43)
    line = filled[:, row, height].astype(int)
    changes = np.flatnonzero(np.diff(np.concatenate([[0], line, [0]])))
    due = origin[0] + size * changes
    found = crossings(vertices, triangles, 0, at)
    assert len(found) == len(due)
    assert len(found) >= 8  # four slots or more between chambers, and both ends
    # Sides are planes on faces of voxels, where distances are exact: only 32-bit numbers round.
    assert found == pytest.approx(due, abs=1e-3 * size)
    slots = [b - a for a, b in itertools.pairwise(found)][1::2]
    assert np.ptp(slots) < 1e-3 * size


def test_a_ball_has_its_volume_and_the_colors_of_its_parts():
    mm = 1e-3
    design = vs.Design(
        name="ball",
        voxel_size=2 * mm,
        parts=[
            vs.Part(shape=vs.Sphere(10 * mm), material="ecoflex-00-30"),
            vs.Part(shape=vs.Sphere(10 * mm, center=(14 * mm, 0, 0)), material="ecoflex-00-50"),
        ],
        clamps=[vs.Clamp(region=vs.Region(z=(-10 * mm, -9 * mm)))],
    )
    _, vertices, triangles, owners = traced(design)
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    # Two balls less their lens: cap height h = 3 mm each.
    lens = 2 * np.pi * (3 * mm) ** 2 * (3 * 10 * mm - 3 * mm) / 3
    due = 2 * 4 / 3 * np.pi * (10 * mm) ** 3 - lens
    # Chords of a sphere fall short by about (step / radius)^2 / 4 of the volume; the seam as much.
    assert volume == pytest.approx(due, rel=(2 / 3 / 10) ** 2)
    middles = (a + b + c) / 3
    assert set(owners[middles[:, 0] < 5 * mm]) == {0}
    assert set(owners[middles[:, 0] > 9 * mm]) == {1}


def test_designs_without_voxels_are_not_shown():
    mm = 1e-3
    body = vs.Box((20 * mm, 20 * mm, 20 * mm))
    # A wall far thinner than a voxel, which finds none.
    fin = vs.Box((20 * mm, 0.2 * mm, 20 * mm), corner=(0, 9.5 * mm, 30 * mm))
    design = vs.Design(
        name="fin",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=body | fin, material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
    )
    _, vertices, _, _ = traced(design)
    assert vertices[:, 2].max() == pytest.approx(20 * mm, rel=1e-5)


def test_a_body_that_is_too_large_has_none_rather_than_a_coarse_one(monkeypatch):
    design = families.sphere()
    assert pack_smooth(design, {"": voxels_of(design)}, 1) is not None
    monkeypatch.setattr("voxsoft.shapes.tracing.MOST_SAMPLES", 1000)
    assert pack_smooth(design, {"": voxels_of(design)}, 1) is None
