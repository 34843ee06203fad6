"""The surface in each cut voxel: directions across it, and its area on the two sides of each.

Small cubes give facets of the surface: one in each that the surface cuts, with the normal of its
plane, and one between each full and empty pair, with that of their common face. Sums of third and
fourth powers of the normals, weighted with the areas, add up over cells, and the frame of a voxel
follows from them: three orthogonal axes q with the largest sum of A (n · q)⁴. These are the normals
of a plane and of a right-angled edge or corner, and in a curved surface their mean.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import permutations, product
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core

Floats = NDArray[np.float64]

#: Powers of x, y, z in the sums of a cell: of degree 3, then of degree 4.
POWERS: Final = np.array(_core.FACET_POWERS)
_CUBIC = 10

#: Frames turned by less [rad] are those of the cell, whose full voxels then warp by their faces.
_STRAIGHT = 1e-4

_ITERATIONS = 10
_SWEEPS = 3
_CHUNK = 16384


def surfaces(sums: Floats) -> Floats:
    """Return the frame and the areas of each voxel, (v, 9).

    The first three numbers are the rotation vector of the frame, the others the areas below and
    above its axes, in faces of a voxel.
    """
    found = np.zeros((len(sums), 9))
    for start in range(0, len(sums), _CHUNK):
        rows = np.flatnonzero(np.abs(sums[start : start + _CHUNK]).max(axis=1) > 1e-12) + start
        if not len(rows):
            continue
        cubic, quartic = _tensor(sums[rows, :_CUBIC], 3), _tensor(sums[rows, _CUBIC:], 4)
        frame = _frame(quartic)
        fourth = _summed("vabcd,vai,vbi,vci,vdi->vi", quartic, *4 * [frame])
        third = _summed("vabc,vai,vbi,vci->vi", cubic, *3 * [frame])
        third = np.clip(third, -fourth, fourth)
        areas = np.stack([(fourth - third) / 2.0, (fourth + third) / 2.0], axis=-1)
        turns = rotation_vectors(frame)
        turned = np.linalg.norm(turns, axis=1, keepdims=True) > _STRAIGHT
        found[rows, :3] = np.where(turned, turns, 0.0)
        found[rows, 3:] = areas.reshape(len(rows), 6)
    return found


def rotation_vectors(matrices: Floats) -> Floats:
    """Return the axes of rotations (k, 3, 3) times their angles in radians, (k, 3).

    They are found by unit quaternions (Shepperd 1978), from the largest component, which is no
    difference of like numbers.

    Examples
    --------
    >>> quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    >>> rotation_vectors(quarter).round(6).tolist()
    [[0.0, 0.0, 1.570796]]
    """
    diagonal = np.diagonal(matrices, axis1=1, axis2=2)
    trace = diagonal.sum(axis=1)
    largest = np.argmax(np.column_stack([diagonal, trace]), axis=1)
    quaternions = np.empty((len(matrices), 4))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        rows = largest == i
        m = matrices[rows]
        quaternions[rows, i] = 1.0 - trace[rows] + 2.0 * m[:, i, i]
        quaternions[rows, j] = m[:, j, i] + m[:, i, j]
        quaternions[rows, k] = m[:, k, i] + m[:, i, k]
        quaternions[rows, 3] = m[:, k, j] - m[:, j, k]
        small = largest == 3
        quaternions[small, i] = matrices[small, k, j] - matrices[small, j, k]
    quaternions[largest == 3, 3] = 1.0 + trace[largest == 3]
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    quaternions[quaternions[:, 3] < 0.0] *= -1.0
    sines = np.linalg.norm(quaternions[:, :3], axis=1)
    angles = 2.0 * np.arctan2(sines, quaternions[:, 3])
    # Twice 1 is the limit of angle / sine for small angles.
    scales = np.divide(angles, sines, out=np.full(len(angles), 2.0), where=sines > 0.0)
    found: Floats = scales[:, None] * quaternions[:, :3]
    return found


def obliquity(sums: Floats) -> Floats:
    """Return ``4 nₐ² (1 - nₐ²)`` of the normals for each axis, their mean over the surface, (k, 3).

    Parameters
    ----------
    sums
        Sums of cells, (k, 25).
    """
    quartic = _tensor(sums[:, _CUBIC:], 4)
    fourth = np.stack([quartic[:, axis, axis, axis, axis] for axis in range(3)], axis=1)
    second = np.einsum("vaabb->va", quartic)
    area = np.maximum(second.sum(axis=1, keepdims=True), 1e-300)
    found: Floats = np.clip(4.0 * (second - fourth) / area, 0.0, 1.0)
    return found


def _tensor(sums: Floats, degree: int) -> Floats:
    """Expand sums of monomials to a symmetric tensor, (v, 3, ...)."""
    rows = POWERS[POWERS.sum(axis=1) == degree].tolist()
    index = np.indices(degree * (3,)).reshape(degree, -1).T
    number = [rows.index([(i == axis).sum() for axis in range(3)]) for i in index]
    return sums[:, number].reshape(-1, *degree * (3,))


def _frame(quartic: Floats) -> Floats:
    """Return the axes of the largest sums of A (n · q)⁴ as columns, (v, 3, 3).

    The first comes from the best of the directions between cells by a power iteration, which
    raises its sum in each step, as fourth powers are convex. Then pairs are turned in their planes
    in turn. Where nothing else tells, axes lie near those of the cell.
    """
    values = _summed("vabcd,ia,ib,ic,id->vi", quartic, *4 * [_STARTS])
    first = _STARTS[values.argmax(axis=1)]
    for _ in range(_ITERATIONS):
        first = _unit(_summed("vabcd,vb,vc,vd->va", quartic, *3 * [first]))
    far = np.eye(3)[np.abs(first).round(9).argmin(axis=1)]
    second = _unit(far - first * (first * far).sum(axis=1, keepdims=True))
    frame = np.stack([first, second, np.cross(first, second)], axis=-1)
    total = np.einsum("vaabb->v", quartic)[:, None, None, None, None]
    biased = quartic + total * _BIAS
    for pair in _SWEEPS * [(1, 2), (2, 0), (0, 1)]:
        _turn(frame, pair, biased)
    # Take the one of the equal frames that is nearest to the axes of the cell.
    nearest = np.einsum("vai,kia->vk", frame, _TURNS).argmax(axis=1)
    found: Floats = frame @ _TURNS[nearest]
    return found


def _turn(frame: Floats, pair: tuple[int, int], quartic: Floats) -> None:
    """Turn a pair of axes in place to the largest sum of both in their plane (Jacobi).

    With n = ρ (cos φ, sin φ) there, n₁⁴ + n₂⁴ is ρ⁴ (3 + cos 4φ)/4.
    """
    plane = frame[:, :, pair]
    t = _summed("vabcd,vai,vbj,vck,vdl->vijkl", quartic, *4 * [plane])
    cosine = t[:, 0, 0, 0, 0] - 6.0 * t[:, 0, 0, 1, 1] + t[:, 1, 1, 1, 1]
    sine = 4.0 * (t[:, 0, 0, 0, 1] - t[:, 0, 1, 1, 1])
    total = np.einsum("vaabb->v", quartic)
    clear = np.hypot(sine, cosine) > 1e-9 * total
    angle = np.where(clear, np.arctan2(sine, cosine) / 4.0, 0.0)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    frame[:, :, pair] = np.einsum("vai,ijv->vaj", plane, turn)


def _summed(indices: str, *operands: Floats) -> Floats:
    """Sum products by Einstein's convention, two operands at a time."""
    found: Floats = np.einsum(
        indices, *operands, optimize=_order(indices, *(each.shape for each in operands))
    )
    return found


@lru_cache(maxsize=64)
def _order(indices: str, *shapes: tuple[int, ...]) -> list[Any]:
    """Find the order of the sums, which takes longer than those of a small body."""
    return np.einsum_path(indices, *map(np.empty, shapes), optimize=True)[0]


def _unit(vectors: Floats) -> Floats:
    found: Floats = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return found


def _starts() -> Floats:
    """List the directions from a cell to its neighbors, one of each opposite pair, (13, 3)."""
    steps = np.stack(np.meshgrid(*3 * [[-1.0, 0.0, 1.0]], indexing="ij"), axis=-1).reshape(-1, 3)
    return _unit(steps[:13:-1])


def _turns() -> Floats:
    """List the rotations of a cube to itself, (24, 3, 3)."""
    signs = [np.diag(s) for s in product((1.0, -1.0), repeat=3)]
    found = np.array([np.eye(3)[list(p)] @ s for p in permutations(range(3)) for s in signs])
    proper: Floats = found[np.linalg.det(found) > 0.0]
    return proper


_STARTS = _starts()
_TURNS = _turns()
#: Weak facets of a surface along the faces of the cell, as a part of the whole.
_BIAS = np.zeros((3, 3, 3, 3))
for _axis in range(3):
    _BIAS[_axis, _axis, _axis, _axis] = 0.01
