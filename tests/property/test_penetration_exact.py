"""The test of overlap against one in fractions that shares no line with it."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest

from voxsoft.mesh import Mesh
from voxsoft.simulation import find_penetration
from voxsoft.voxels import Voxels

FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


def planes(corners: list[list[Fraction]]) -> list[tuple[list[Fraction], Fraction]]:
    """Outward planes of a tetrahedron: the points with normal . x <= height."""
    found = []
    for face in FACES:
        a, b, c = (corners[i] for i in face)
        u, v = ([q - p for p, q in zip(a, end, strict=True)] for end in (b, c))
        normal = [u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2] for i in range(3)]
        found.append((normal, dot(normal, a)))
    return found


def dot(a: list[Fraction], b: list[Fraction]) -> Fraction:
    return sum((p * q for p, q in zip(a, b, strict=True)), Fraction(0))


def determinant(rows: list[list[Fraction]]) -> Fraction:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def common_interior(one: list[list[Fraction]], other: list[list[Fraction]]) -> bool:
    """Check if two tetrahedra have inner points in common: their intersection spans space."""
    sides = planes(one) + planes(other)
    corners: list[list[Fraction]] = []
    for three in combinations(sides, 3):
        normals = [normal for normal, _ in three]
        whole = determinant(normals)
        if whole == 0:
            continue
        heights = [height for _, height in three]
        corner = [
            determinant([[*n[:k], h, *n[k + 1 :]] for n, h in zip(normals, heights, strict=True)])
            / whole
            for k in range(3)
        ]
        if all(dot(normal, corner) <= height for normal, height in sides) and corner not in corners:
            corners.append(corner)
    if len(corners) < 4:
        return False
    spans = [[q - p for p, q in zip(corners[0], corner, strict=True)] for corner in corners[1:]]
    return any(determinant(list(three)) != 0 for three in combinations(spans, 3))


def overlaps(mesh: Mesh, positions: np.ndarray) -> bool:
    """Check if any two tetrahedra of a body have inner points in common."""
    corners = positions[mesh.tets]
    low, high = corners.min(axis=1), corners.max(axis=1)
    exact = [[[Fraction(x) for x in corner] for corner in tet] for tet in corners.tolist()]
    for i in range(len(exact)):
        near = (low[i] < high[i + 1 :]).all(axis=1) & (low[i + 1 :] < high[i]).all(axis=1)
        if any(common_interior(exact[i], exact[i + 1 + int(j)]) for j in np.flatnonzero(near)):
            return True
    return False


def some(count: int, quick: int) -> list[object]:
    """Seeds, of which only the first are tried by default."""
    slow = [pytest.param(seed, marks=pytest.mark.slow) for seed in range(quick, count)]
    return [*range(quick), *slow]


def two_voxels() -> Mesh:
    return Voxels.from_array([[[1]], [[0]], [[1]]], voxel_size=1.0).mesh()


@pytest.mark.long
@pytest.mark.parametrize("seed", some(60, 20))
def test_two_cells_on_whole_numbers(seed):
    """Faces in one plane, edges on edges, vertices on faces: cases that rounding gets wrong."""
    random = np.random.default_rng(seed)
    mesh = two_voxels()
    second = mesh.vertices[:, 0] > 1.5
    positions = mesh.vertices.copy()
    turn = np.eye(3)
    while True:
        turn = random.integers(-1, 2, (3, 3)).astype(float)
        if np.linalg.det(turn) > 0.5:
            break
    shift = random.integers(-1, 2, 3) * random.choice([0.5, 1.0])
    positions[second] = (positions[second] - [2.0, 0.0, 0.0]) @ turn + shift
    found = find_penetration(mesh, positions)
    assert bool(found.overlaps) == overlaps(mesh, positions)


@pytest.mark.parametrize("seed", some(12, 2))
def test_a_bent_strip_in_any_floats(seed):
    """A strip of 9 cells, rolled up and twisted by chance, meets itself or does not."""
    random = np.random.default_rng(100 + seed)
    mesh = Voxels.from_array(np.ones((9, 1, 1), dtype=np.uint8), voxel_size=1.0).mesh()
    x, y, z = mesh.vertices.T
    turns, pitch = random.uniform(0.85, 1.3), random.uniform(-0.12, 0.12)
    radius = 9.0 / (2.0 * np.pi * turns)
    angle = x / radius
    tilt = random.uniform(-0.2, 0.2) * x
    out = radius + (z - 0.5) * np.cos(tilt) - (y - 0.5) * np.sin(tilt)
    side = pitch * x + (y - 0.5) * np.cos(tilt) + (z - 0.5) * np.sin(tilt)
    positions = np.column_stack([out * np.sin(angle), side, out * np.cos(angle)])
    assert (np.linalg.det(np.diff(positions[mesh.tets], axis=1)) > 0).all()
    assert bool(find_penetration(mesh, positions).overlaps) == overlaps(mesh, positions)


def test_both_answers_occur():
    """The tests above would be idle if all bodies were in themselves, or none."""
    mesh = two_voxels()
    assert not overlaps(mesh, mesh.vertices)
    second = (mesh.vertices[:, 0] > 1.5)[:, None]
    assert not overlaps(mesh, mesh.vertices - second * [1.0, 0.0, 0.0])
    assert overlaps(mesh, mesh.vertices - second * [1.0 + 2.0**-52, 0.0, 0.0])


def shuffled(
    mesh: Mesh, positions: np.ndarray, random: np.random.Generator
) -> tuple[Mesh, np.ndarray]:
    """Put a body's vertices, tetrahedra and triangles in another order."""
    order = random.permutation(len(mesh.vertices))
    place = np.argsort(order).astype(np.int32)
    tets = random.permutation(len(mesh.tets))
    other = Mesh(
        vertices=mesh.vertices[order],
        tets=place[mesh.tets[tets]],
        edges=np.sort(place[mesh.edges], axis=1),
        triangles=place[random.permutation(mesh.triangles)],
        tet_part=mesh.tet_part[tets],
        tet_voxel=None,
        voxel_size=None,
        cavities=(),
    )
    return other, positions[order]


def test_order_and_rigid_motion_change_nothing():
    mesh = Voxels.from_array(np.ones((12, 2, 1), dtype=np.uint8), voxel_size=1.0).mesh()
    x, y, z = mesh.vertices.T
    angle = x / 1.7
    positions = np.column_stack(
        [(2.0 + z) * np.sin(angle), y + 0.02 * x, (2.0 + z) * np.cos(angle)]
    )
    found = find_penetration(mesh, positions)
    assert found.depth > 0.1
    random = np.random.default_rng(3)
    for _ in range(5):
        other, moved = shuffled(mesh, positions, random)
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        again = find_penetration(other, moved @ turn + random.normal(size=3))
        assert len(again.overlaps) == len(found.overlaps)
        assert len(again.covered) == len(found.covered)
        # Rounding of positions of about 5 m.
        assert again.depth == pytest.approx(found.depth, abs=1e-14)
