"""Why a voxel that holds an inner edge stiffens a chamber, tried in plane strain.

``python research/inner_edges.py``. A square tube (20 × 20 mm, room of 8 × 12 mm, walls of 4 and 8)
under pressure from inside: growth of the room over that with squares of 0.125 mm, for squares of
2 mm and 1 mm and up to a tenth larger, whose sides then cut squares. All are bilinear with the two
incompatible modes of Wilson, 1 - s² and 1 - t², integrated over the material alone and condensed.
The means of these modes over the material are left out, as in a voxel of VoxSoft, or kept for shear
or for all strains, in squares cut by one side (plane) or by two (edge).
`docs/method/cut-voxels.md` reads the table.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import spsolve

Floats = NDArray[np.float64]
#: Weighted points: x, z and area.
Points = list[tuple[float, float, float]]

YOUNG, POISSON = 100.0, 0.49
LAMBDA = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
MU = YOUNG / (2 * (1 + POISSON))
#: Stress xx, zz and xz by strain, the shear doubled.
ELASTIC = np.array([[LAMBDA + 2 * MU, LAMBDA, 0], [LAMBDA, LAMBDA + 2 * MU, 0], [0, 0, MU]])
#: Low and high x and z of the body and of its room, in mm.
OUTER, ROOM = (-10.0, 10.0, -10.0, 10.0), (-2.0, 6.0, -6.0, 6.0)
#: Springs to the ground at each node that keep the body in place, over Young's modulus.
HELD = 1e-7
#: Columns of the modes: along x and z by 1 - s², then by 1 - t². The second and third are shears.
SHEAR, ALL = (9, 10), (8, 9, 10, 11)
KEPT: dict[str, dict[str, tuple[int, ...]]] = {
    "no mean": {},
    "shear, plane": {"plane": SHEAR},
    "shear, edge": {"edge": SHEAR},
    "shear, both": {"plane": SHEAR, "edge": SHEAR},
    "all, both": {"plane": ALL, "edge": ALL},
}


def _within(x: float, z: float, box: tuple[float, float, float, float]) -> bool:
    return box[0] < x < box[1] and box[2] < z < box[3]


def _points(rectangle: tuple[float, float, float, float]) -> Iterator[tuple[float, float, float]]:
    """Gauss points of a rectangle."""
    a, b, c, d = rectangle
    for s, t in product((-1, 1), repeat=2):
        x = (a + b) / 2 + s * (b - a) / np.sqrt(12)
        z = (c + d) / 2 + t * (d - c) / np.sqrt(12)
        yield x, z, (b - a) * (d - c) / 4


def square(x: float, z: float, size: float) -> tuple[Points, Points, str]:
    """Points in the material and in the room of a square, and its kind."""
    cuts = []
    for low, sides in ((x, (*OUTER[:2], *ROOM[:2])), (z, (*OUTER[2:], *ROOM[2:]))):
        inner = {side for side in sides if low + 1e-9 < side < low + size - 1e-9}
        cuts.append(sorted({low, low + size, *inner}))
    material: Points = []
    room: Points = []
    parts = 0
    for (a, b), (c, d) in product(pairwise(cuts[0]), pairwise(cuts[1])):
        middle = (a + b) / 2, (c + d) / 2
        if _within(*middle, ROOM):
            room += _points((a, b, c, d))
        elif _within(*middle, OUTER):
            material += _points((a, b, c, d))
            parts += 1
    whole = len(material) == 4 and not room and len(cuts[0]) == len(cuts[1]) == 2
    kind = "full" if whole else "edge" if parts == 3 else "plane"
    return material, room, kind


def _strains(slopes: Floats) -> Floats:
    """The strains of motions along x and z with shapes of these slopes, (3, 2n)."""
    matrix = np.zeros((3, 2 * len(slopes)))
    matrix[0, 0::2] = matrix[2, 1::2] = slopes[:, 0]
    matrix[1, 1::2] = matrix[2, 0::2] = slopes[:, 1]
    return matrix


def _corner_slopes(s: float, t: float, size: float) -> Floats:
    return np.array([[t - 1, s - 1], [1 - t, -s], [t, s], [-t, 1 - s]]) / size


def stiffness(x: float, z: float, size: float, material: Points, kept: tuple[int, ...]) -> Floats:
    """The stiffness of a square by its corners, with the means of the modes `kept`, (8, 8)."""
    strains, weights = [], []
    for px, pz, weight in material:
        s, t = (px - x) / size, (pz - z) / size
        modes = np.array([[1 - 2 * s, 0.0], [0.0, 1 - 2 * t]]) / size
        strains.append(_strains(np.vstack([_corner_slopes(s, t, size), modes])))
        weights.append(weight)
    means = np.average(strains, axis=0, weights=weights)
    means[:, [column for column in range(12) if column < 8 or column in kept]] = 0.0
    whole = np.zeros((12, 12))
    for strain, weight in zip(strains, weights, strict=True):
        whole += weight * (strain - means).T @ ELASTIC @ (strain - means)
    modes = whole[8:, 8:] + 1e-9 * np.trace(whole) * np.eye(4)
    return whole[:8, :8] - whole[:8, 8:] @ np.linalg.solve(modes, whole[8:, :8])


def growth(size: float, kept: dict[str, tuple[int, ...]]) -> float:
    """Growth of the room under a unit of pressure at small strain, per mm of length."""
    first = [np.floor(low / size - 1) * size for low in (OUTER[0], OUTER[2])]
    count = [
        int(np.ceil((high - low) / size)) + 1
        for low, high in zip(first, (OUTER[1], OUTER[3]), strict=True)
    ]
    load = np.zeros(2 * (count[0] + 1) * (count[1] + 1))
    rows, columns, values = [], [], []
    for i, j in product(range(count[0]), range(count[1])):
        x, z = first[0] + i * size, first[1] + j * size
        material, room, kind = square(x, z, size)
        nodes = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        numbers = np.array([a * (count[1] + 1) + b for a, b in nodes])
        places = np.ravel([2 * numbers, 2 * numbers + 1], order="F")
        for px, pz, weight in room:
            slopes = _corner_slopes((px - x) / size, (pz - z) / size, size)
            load[places] += weight * slopes.ravel()
        if material:
            rows.append(np.repeat(places, 8))
            columns.append(np.tile(places, 8))
            own = stiffness(x, z, size, material, kept.get(kind, ()))
            values.append(own.ravel())
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    used = np.unique(np.concatenate(rows))
    matrix = sp.csr_matrix(entries, shape=(len(load), len(load)))[used][:, used]
    matrix = matrix + HELD * YOUNG * sp.eye(len(used))
    return float(load[used] @ spsolve(matrix.tocsc(), load[used]))


def main() -> None:
    """Print the table."""
    exact = growth(0.125, {})
    parts = [1.0 + 0.1 * step / 12 for step in range(0, 12, 2)]
    for size in (2.0, 1.0):
        print(f"squares of {size:g} mm times", *(f"{part:6.3f}" for part in parts))
        for name, kept in KEPT.items():
            errors = [100.0 * (growth(size * part, kept) / exact - 1.0) for part in parts]
            print(f"  {name:20}", *(f"{error:+6.1f}" for error in errors))


if __name__ == "__main__":
    main()
