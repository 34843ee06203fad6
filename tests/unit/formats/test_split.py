"""Cells of all kinds cut into tetrahedra: exact volumes, and faces that neighbors cut alike."""

import numpy as np
import pytest

from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.split import tets_of
from voxsoft.mesh import Mesh


def grid(counts, rng):
    """Corners of a sheared grid of cells in any numbering, and its hexahedra in VTK's order."""
    axes = [np.arange(n + 1) for n in counts]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3).astype(float)
    number = np.arange(len(points)).reshape([n + 1 for n in counts])
    i, j, k = (each.ravel() for each in np.meshgrid(*map(np.arange, counts), indexing="ij"))
    offsets = ((0, 0), (1, 0), (1, 1), (0, 1))
    corners = [number[i + x, j + y, k + z] for z in (0, 1) for x, y in offsets]
    order = rng.permutation(len(points))
    placed = np.empty_like(points)
    placed[order] = points + 0.3 * points[:, [2]] * [1, 0.5, 0]
    return placed, order[np.column_stack(corners)]


def whole(points, *blocks):
    """The mesh of cells; a face that two neighbors cut otherwise would be left on its boundary."""
    cut = tets_of(Contents(points, tuple(CellBlock(*block) for block in blocks)), "cells")
    used, tets = np.unique(cut.tets, return_inverse=True)
    return Mesh.from_tets(points[used], tets.reshape(-1, 4))


@pytest.mark.parametrize("seed", range(10))
def test_bricks_and_pyramids_of_any_numbering_fit_each_other(seed):
    rng = np.random.default_rng(seed)
    points, bricks = grid((3, 2, 2), rng)
    chosen = rng.permutation(len(bricks)) < 6
    # Six pyramids about the center of a brick.
    around = bricks[chosen]
    center = len(points) + np.arange(len(around))
    points = np.concatenate([points, points[around].mean(axis=1)])
    sides = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
    pyramids = np.concatenate([np.column_stack((around[:, side], center)) for side in sides])
    mesh = whole(points, ("hexahedron", bricks[~chosen]), ("pyramid", pyramids))
    assert mesh.volume == pytest.approx(12, rel=1e-13)
    assert len(mesh.tets) == 6 * 6 + 6 * 6 * 2
    # 32 outer quadrilaterals, of two triangles each.
    assert len(mesh.triangles) == 64


@pytest.mark.parametrize("seed", range(10))
def test_wedges_of_any_numbering_fit_each_other(seed):
    points, bricks = grid((3, 2, 2), np.random.default_rng(seed))
    wedges = np.concatenate([bricks[:, [0, 1, 2, 4, 5, 6]], bricks[:, [0, 2, 3, 4, 6, 7]]])
    mesh = whole(points, ("wedge", wedges))
    assert mesh.volume == pytest.approx(12, rel=1e-13)
    assert len(mesh.tets) == 2 * 12 * 3
    assert len(mesh.triangles) == 64
