"""Numbers from positions of vertices: how far, how much turned, how large, how stretched.

Plain functions of arrays; :mod:`voxsoft.metrics` says which of them a design may ask for.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def mean_displacement(
    rest: NDArray[np.float64],
    positions: NDArray[np.float64],
    vertices: NDArray[np.uint32],
    weights: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Weighted mean displacement of some vertices.

    Parameters
    ----------
    rest, positions
        Vertices at rest and now, (n, 3), m.
    vertices, weights
        Indices (k,) and weights (k,) that sum to 1.

    Returns
    -------
    ndarray of shape (3,)
        In m.

    Examples
    --------
    >>> rest = np.zeros((2, 3))
    >>> mean_displacement(rest, rest + [0, 0, 1], np.array([0, 1]), np.array([0.5, 0.5]))
    array([0., 0., 1.])
    """
    moved: NDArray[np.float64] = weights @ (positions[vertices] - rest[vertices])
    return moved


def mean_rotation(
    rest: NDArray[np.float64], positions: NDArray[np.float64], vertices: NDArray[np.uint32]
) -> float:
    """Angle in rad by which some vertices have turned as a whole.

    For a tip section of a bending actuator this is its bending angle.

    Parameters
    ----------
    rest, positions, vertices
        See :func:`mean_rotation_vector`.

    Returns
    -------
    float
        Between 0 and π; NaN where the vertices do not define a rotation.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> turned = square @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    >>> angle = mean_rotation(square, turned, np.arange(4, dtype=np.uint32))
    >>> round(float(np.degrees(angle)), 6)
    90.0
    """
    return float(np.linalg.norm(mean_rotation_vector(rest, positions, vertices)))


def mean_rotation_vector(
    rest: NDArray[np.float64], positions: NDArray[np.float64], vertices: NDArray[np.uint32]
) -> NDArray[np.float64]:
    """The turn of some vertices as a whole: along its axis, and as long as its angle in rad.

    The best rotation in the sense of least squares (Kabsch 1976, doi 10.1107/S0567739476001873).

    Parameters
    ----------
    rest, positions
        Vertices at rest and now, (n, 3), m.
    vertices
        At least three vertices that are not on one line.

    Returns
    -------
    ndarray of shape (3,)
        Right-handed, at most π long; NaN where the vertices do not define a rotation.

    Examples
    --------
    >>> square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> turned = square @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    >>> vector = mean_rotation_vector(square, turned, np.arange(4, dtype=np.uint32))
    >>> np.degrees(vector).round(6) + 0.0
    array([ 0.,  0., 90.])
    """
    from scipy.spatial.transform import Rotation  # slow to load

    before = rest[vertices] - rest[vertices].mean(axis=0)
    after = positions[vertices] - positions[vertices].mean(axis=0)
    left, values, right = np.linalg.svd(before.T @ after)
    if values[1] <= 1e-12 * values[0] or len(vertices) < 3:
        return np.full(3, np.nan)
    handed = np.diag([1.0, 1.0, np.sign(np.linalg.det(left @ right))])
    # Rows turn by the transpose.
    vector: NDArray[np.float64] = Rotation.from_matrix((left @ handed @ right).T).as_rotvec()
    return vector


def enclosed_volume(triangles: NDArray[np.int32], positions: NDArray[np.float64]) -> float:
    """Volume in m³ of a cavity whose triangles point out of the solid, into the cavity.

    Parameters
    ----------
    triangles
        A closed surface, (t, 3).
    positions
        Vertices now, (n, 3), m.

    Examples
    --------
    >>> corners = np.eye(4, 3, k=-1)  # the origin and the three unit vectors
    >>> inward = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], dtype=np.int32)
    >>> round(enclosed_volume(inward, corners), 6)
    0.166667
    """
    corners = positions.T.take(triangles.T, axis=1)  # three axes, three corners, t
    (ax, bx, cx), (ay, by, cy), (az, bz, cz) = corners
    six_volumes = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return -float(six_volumes.sum()) / 6.0


def tet_volumes(positions: NDArray[np.float64], tets: NDArray[np.int32]) -> NDArray[np.float64]:
    """Volumes in m³ of tetrahedra, (m,), negative for those that are inside out.

    Parameters
    ----------
    positions
        Vertices, (n, 3), m.
    tets
        (m, 4).

    Examples
    --------
    >>> corners = np.eye(4, 3, k=-1)  # the origin and the three unit vectors
    >>> tet_volumes(corners, np.array([[0, 1, 2, 3]], dtype=np.int32)).round(6).tolist()
    [0.166667]
    """
    corners = positions.T.take(tets.T, axis=1)  # three axes, four corners, m
    (ux, vx, wx), (uy, vy, wy), (uz, vz, wz) = corners[:, 1:] - corners[:, :1]
    six_volumes: NDArray[np.float64] = (
        ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)
    )
    return six_volumes / 6.0


def rotation_matrix(axis: ArrayLike, angle: float) -> NDArray[np.float64]:
    """The matrix of a right-handed turn about an axis through the origin.

    Rodrigues' formula. Entries that are 0 or 1 up to rounding are made exact, so that quarter turns
    are.

    Parameters
    ----------
    axis
        Its direction, (3,), of any length but zero.
    angle
        In rad.

    Returns
    -------
    ndarray of shape (3, 3)

    Examples
    --------
    >>> rotation_matrix((0, 0, 2), np.pi / 2).tolist()
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    x, y, z = np.asarray(axis, dtype=np.float64) / np.linalg.norm(axis)
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.eye(3) + np.sin(angle) * across + (1.0 - np.cos(angle)) * across @ across
    whole = np.rint(matrix)
    exact: NDArray[np.float64] = np.where(np.abs(matrix - whole) < _ROUNDING, whole + 0.0, matrix)
    return exact


#: Rounding error of a zero after a turn by a right angle, with a margin.
_ROUNDING = 1e-15


def grid_phase(place: ArrayLike, voxel_size: float) -> tuple[float, float, float]:
    """Return where a grid lies along each axis [m], from 0 to below one voxel.

    Parameters
    ----------
    place
        A corner of a voxel [m].
    voxel_size
        Edge of a voxel [m].

    Examples
    --------
    >>> grid_phase((-0.003, 0.0, 0.004), 0.002)
    (0.001, 0.0, 0.0)
    """
    number = np.asarray(place, dtype=np.float64) / voxel_size
    # Places are sums of floats: a millionth of a voxel below a face is on it.
    part = number - np.floor(number + 1e-6)
    part[np.abs(part) < 1e-6] = 0.0
    x, y, z = (float(f"{each:.12g}") for each in part * voxel_size)
    return x, y, z
