"""Nets between labeled samples: closed regions, edges that are kept, volumes that are reached."""

import numpy as np
import pytest
import trimesh

from voxsoft.shapes.nets import closed, measures, net_of, with_volumes


def middles(start, end, behind, before):
    return (start + end) / 2, end - start


def net(labels):
    return net_of(closed(np.pad(labels, 2)), np.zeros(3), 1.0, middles)


@pytest.mark.parametrize("seed", range(20))
def test_regions_of_random_labels_have_closed_surfaces(seed):
    rng = np.random.default_rng(seed)
    labels = rng.integers(0, 4, (6, 5, 7)).astype(np.uint8)
    found = net(labels)
    for region in np.unique(found.sides):
        body = trimesh.Trimesh(found.points, found.around(region), process=False)
        assert body.is_watertight
        assert body.is_winding_consistent


@pytest.mark.parametrize("labels", [[[[1, 0], [0, 1]]], [[[1, 0], [0, 0]], [[0, 0], [0, 1]]]])
def test_samples_that_touch_at_an_edge_or_a_corner_are_joined(labels):
    labels = np.array(labels, dtype=np.uint8)
    assert closed(labels).sum() > labels.sum()
    found = net(labels)
    # Bodies that touched would be one with an edge of four triangles, or two with a common point.
    assert trimesh.Trimesh(found.points, found.around(1), process=False).body_count == 1


def test_labels_that_touch_by_faces_are_unchanged():
    labels = np.zeros((4, 4, 4), dtype=np.uint8)
    labels[1:3, 1:3, 1:3], labels[1:3, 1:3, 3] = 1, 2
    assert (closed(labels) == labels).all()


def test_regions_share_the_surface_between_them():
    labels = np.zeros((5, 3, 3), dtype=np.uint8)
    labels[:2], labels[2:] = 1, 2
    found = net(labels)
    volumes, areas = measures(found, 2)
    assert volumes == pytest.approx([18.0, 27.0])
    assert areas[1, 2] == pytest.approx(9.0)
    one, other = ({tuple(sorted(each)) for each in found.around(n).tolist()} for n in (1, 2))
    assert len(one & other) == 18


def test_an_oblique_edge_is_kept():
    """A wedge between two planes at 45 degrees ends in a line that lies between the samples."""

    def crossings(start, end, behind, before):
        planes = np.array(
            [[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [0, 0, 1.0], [0, 0, -1.0], [-1, 0, 0]]
        )
        offsets = np.array([6.2, 0.3, 5.1, -0.9, -1.1])
        low, high = ((planes @ points.T - offsets[:, None]) for points in (start, end))
        crosses = low * high < 0
        way = np.where(crosses, low / np.where(crosses, low - high, 1.0), 0.5)
        # The plane that is crossed between the samples with the surface on it.
        middle = start[None] + way[..., None] * (end - start)[None]
        inside = (np.einsum("pj,qkj->pqk", planes, middle) - offsets[:, None, None]).max(axis=0)
        plane = np.where(crosses, inside, np.inf).argmin(axis=0)
        rows = np.arange(len(start))
        normals = planes[plane] / np.linalg.norm(planes[plane], axis=1, keepdims=True)
        return middle[plane, rows], normals

    grid = np.stack(np.meshgrid(*3 * [np.arange(8.0)], indexing="ij"), axis=-1)
    inside = (
        (grid @ [1, 1, 0] < 6.2)
        & (grid @ [1, -1, 0] < 0.3)
        & (grid[..., 2] < 5.1)
        & (grid[..., 2] > 0.9)
        & (grid[..., 0] > 1.1)
    )
    found = net_of(closed(inside.astype(np.uint8)), np.zeros(3), 1.0, crossings)
    edge = np.array([3.25, 2.95])
    near = np.linalg.norm(found.points[:, :2] - edge, axis=1) < 1e-6
    assert near.sum() == 6


@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_volumes_are_reached_by_both_of_two_that_touch(factor):
    labels = np.zeros((6, 4, 4), dtype=np.uint8)
    labels[:3], labels[3:] = 1, 2
    found = net(labels)
    target = np.array([48.0 * factor, 48.0])
    volumes, _ = measures(with_volumes(found, target), 2)
    assert volumes == pytest.approx(target, rel=1e-4)
