"""Relief of voxels around a re-entrant edge, from the mode of the edge alone.

``python research/reentrant_edges.py``. Around the edge of three quarters of rubber in plane strain
the body moves as ``r^0.5445`` times a function of the angle (Williams 1952, doi 10.1115/1.4010553).
Squares with the outer nodes moved like that have more energy than the mode. The first table gives
the part `c` of the mean shear of the three squares at the edge that has to go for equal energies,
by Poisson's ratio and the number of squares to a side, and extrapolated. The second has the edge
within a square, of which a part is filled: there the four whole squares around it are relieved. The
third holds it against square tubes under pressure from inside, which had no part in it: growth of
their room for walls of one, two, four and eight squares, without and with it. Squares are bilinear
with the incompatible modes of Wilson and the relief of free faces, voxels in plane strain.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product
from typing import Final

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Half of the angle of the material at the edge.
HALF: Final = 0.75 * np.pi
#: Direction of the middle of the material; the room has x > 0 and y > 0.
MIDDLE: Final = 1.25 * np.pi
#: Part of the shear that one free face relieves, and the largest part of a cut square.
FACE, MOST = 5.0 / 26.0, 10.0 / 17.0
YOUNG: Final = 100.0
#: Gauss points of the unit.
GAUSS: Final = (0.5 - 12**-0.5, 0.5 + 12**-0.5)
#: Springs to the ground that keep a tube in place, over Young's modulus.
HELD: Final = 1e-7
ORDER: Final = float(
    brentq(lambda x: np.sin(2 * x * HALF) + x * np.sin(2 * HALF), 0.5, 0.6, xtol=1e-12)
)


def elastic(poisson: float) -> tuple[Floats, float]:
    """Stress xx, yy, xy by strain in plane strain, the shear doubled, and the shear modulus."""
    first = YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson))
    shear = YOUNG / (2 * (1 + poisson))
    matrix = [[first + 2 * shear, first, 0], [first, first + 2 * shear, 0], [0, 0, shear]]
    return np.array(matrix), shear


def square(poisson: float, filled: float = 1.0) -> tuple[Floats, Floats]:
    """Stiffness (8, 8) of a square filled for `filled` of its x, and its mean shear (8,)."""
    stress, _ = elastic(poisson)
    strains = []
    for s, t in product(GAUSS, GAUSS):
        x = s * filled
        slopes = np.array([[t - 1, x - 1], [1 - t, -x], [t, x], [-t, 1 - x]])
        slopes = np.vstack([slopes, [[1 - 2 * x, 0.0], [0.0, 1 - 2 * t]]])
        strain = np.zeros((3, 12))
        strain[0, 0::2] = strain[2, 1::2] = slopes[:, 0]
        strain[1, 1::2] = strain[2, 0::2] = slopes[:, 1]
        strains.append(strain)
    mean = np.mean(strains, axis=0)
    inner = mean.copy()
    inner[:, :8] = 0.0
    parts = [(strain - inner).T @ stress @ (strain - inner) for strain in strains]
    whole = filled * np.mean(parts, axis=0)
    modes = whole[8:, 8:]
    return whole[:8, :8] - whole[:8, 8:] @ np.linalg.solve(modes, whole[8:, :8]), mean[2, :8]


def together(*parts: float) -> float:
    """The part of a shear that several reliefs take, in series."""
    return 1.0 - 1.0 / (1.0 + sum(part / (1.0 - part) for part in parts))


def matrix_of(corners: Ints, each: Floats, nodes: int) -> sp.csr_matrix:
    """The stiffness of all squares; `corners` (n, 4), `each` (n, 8, 8)."""
    places = np.stack([2 * corners, 2 * corners + 1], 2).reshape(len(corners), 8)
    rows, columns = np.repeat(places, 8, 1).ravel(), np.tile(places, (1, 8)).ravel()
    return sp.csr_matrix((each.ravel(), (rows, columns)), shape=(2 * nodes, 2 * nodes))


# --- The mode of the edge -------------------------------------------------------------------------


def mode(x: Floats, y: Floats, poisson: float) -> Floats:
    """Displacements (n, 2) of the mode around the origin."""
    r = np.hypot(x, y)
    angle = np.mod(np.arctan2(y, x) - MIDDLE + np.pi, 2 * np.pi) - np.pi
    up, down, kappa = ORDER + 1, ORDER - 1, 3 - 4 * poisson
    share = -np.cos(up * HALF) / np.cos(down * HALF)
    out = -up * np.cos(up * angle) + share * (kappa - ORDER) * np.cos(down * angle)
    around = up * np.sin(up * angle) + share * (kappa + ORDER) * np.sin(down * angle)
    size, turn = r**ORDER / (2 * elastic(poisson)[1]), angle + MIDDLE
    return np.stack(
        [
            size * (out * np.cos(turn) - around * np.sin(turn)),
            size * (out * np.sin(turn) + around * np.cos(turn)),
        ],
        axis=1,
    )


def energy_of_mode(poisson: float, half: int, filled: float) -> float:
    """Half the work of the mode on the outside of a square of `2 half` squares to a side."""
    stress, _ = elastic(poisson)
    points, weights = np.polynomial.legendre.leggauss(60)
    edge, far, step, total = filled - 1.0, float(half), 1e-4, 0.0
    sides = (
        ((-far, -far), (far, -far), (0, -1)),
        ((far, -far), (far, 0.0), (1, 0)),
        ((edge, far), (-far, far), (0, 1)),
        ((-far, far), (-far, -far), (-1, 0)),
    )
    for start, end, (n, m) in sides:
        first, last = np.array(start), np.array(end)
        x, y = (first + np.outer((points + 1) / 2, last - first) - [edge, 0.0]).T
        by_x = (mode(x + step, y, poisson) - mode(x - step, y, poisson)) / (2 * step)
        by_y = (mode(x, y + step, poisson) - mode(x, y - step, poisson)) / (2 * step)
        xx, yy, xy = stress @ np.stack([by_x[:, 0], by_y[:, 1], by_x[:, 1] + by_y[:, 0]])
        traction = np.stack([xx * n + xy * m, xy * n + yy * m], axis=1)
        work = (traction * mode(x, y, poisson)).sum(axis=1)
        total += 0.5 * float(weights @ work) / 2 * float(np.hypot(*(last - first)))
    return total


def energy_of_squares(poisson: float, half: int, filled: float, relief: float) -> float:
    """Energy of the squares with their outer nodes moved by the mode."""
    i, j = np.divmod(np.arange(4 * half * half), 2 * half)
    kept = (i < half) | (j < half)
    i, j = i[kept], j[kept]
    side = 2 * half + 1
    corners = np.stack([i, i + 1, i + 1, i]) * side + np.stack([j, j, j + 1, j + 1])
    wall, cap = (i == half - 1) & (j >= half), (j == half - 1) & (i >= half)
    near = np.isin(i, (half - 1, half)) & np.isin(j, (half - 1, half))
    (whole, shear), (part, own) = square(poisson), square(poisson, filled)
    each = np.repeat(whole[None], len(i), axis=0)
    shears = np.repeat(shear[None], len(i), axis=0)
    parts = np.where(wall | cap, FACE, 0.0)
    weights = np.ones(len(i))
    if filled < 1.0:
        each[wall], shears[wall], weights[wall] = part, own, filled
        gain = 3.0 * (1.0 - filled) ** 2 / filled**2
        parts[wall] = min(together(FACE, gain / (1 + gain)), MOST)
        near = (near & ~wall) | ((i == half - 2) & np.isin(j, (half - 1, half)))
    parts[near] = [together(own, relief) for own in parts[near]]
    scale = elastic(poisson)[1] * parts * weights
    each = each - scale[:, None, None] * shears[:, :, None] * shears[:, None, :]
    matrix = matrix_of(corners.T, each, side * side)
    x, y = np.divmod(np.arange(side * side), side)
    used = (x <= half) | (y <= half)
    outer = used & (np.isin(x, (0, 2 * half)) | np.isin(y, (0, 2 * half)))
    moved = np.zeros((side * side, 2))
    at_x, at_y = x[outer] - half + 1.0 - filled, (y[outer] - half).astype(float)
    # Nodes of a cut square beyond its wall go on along the slope there.
    beyond = np.where((at_y > 0) & (at_x > 0), at_x, 0.0)
    on = mode(at_x - beyond, at_y, poisson)
    moved[outer] = on + (on - mode(at_x - beyond - 1e-4, at_y, poisson)) * beyond[:, None] / 1e-4
    flat, fixed = moved.ravel(), np.repeat(outer, 2)
    free = np.repeat(used & ~outer, 2)
    inside = matrix[free]
    flat[free] = spsolve(inside[:, free].tocsc(), -inside[:, fixed] @ flat[fixed])
    return 0.5 * float(flat @ (matrix @ flat))


def relief_of(poisson: float, half: int, filled: float = 1.0) -> float:
    """The part of the shear that makes the energies equal."""
    exact = energy_of_mode(poisson, half, filled)

    def excess(relief: float) -> float:
        return energy_of_squares(poisson, half, filled, relief) - exact

    return float(brentq(excess, -0.2, 0.9, xtol=1e-5))


# --- Tubes ----------------------------------------------------------------------------------------

#: Width and height, and low and high x and y of the room, in mm.
TUBES: Final[Mapping[str, tuple[tuple[int, int], tuple[int, int, int, int]]]] = {
    "walls of 4 mm": ((20, 20), (4, 16, 4, 16)),
    "walls of 4 and 8 mm": ((20, 20), (8, 16, 4, 16)),
    "flat room": ((24, 12), (4, 20, 4, 8)),
    "thick walls": ((24, 24), (8, 16, 8, 16)),
}


def growth(name: str, size: float, poisson: float, relief: float, *, faces: bool = True) -> float:
    """Growth of a tube's room under a unit of pressure from inside, per mm of length."""
    extent, room = TUBES[name]
    across, up = (round(length / size) for length in extent)
    full = np.zeros((across + 2, up + 2), bool)
    full[1:-1, 1:-1] = True
    a, b, c, d = (round(place / size) + 1 for place in room)
    full[a:b, c:d] = False
    near = np.zeros_like(full)
    for x, y in product((a, b), (c, d)):
        near[x - 1 : x + 1, y - 1 : y + 1] = True
    i, j = np.nonzero(full)
    corners = np.stack([i, i + 1, i + 1, i]) * (up + 3) + np.stack([j, j, j + 1, j + 1])
    pairs = [full[i - 1, j] * 1 + full[i + 1, j], full[i, j - 1] * 1 + full[i, j + 1]]
    of_faces: Callable[[int], float] = (0.0, FACE, 1 / 6).__getitem__
    parts = [
        together(
            *(of_faces(2 - both) * faces for both in (by_x, by_y)),
            relief * bool(near[x, y]),
        )
        for x, y, by_x, by_y in zip(i, j, *pairs, strict=True)
    ]
    whole, shear = square(poisson)
    scale = elastic(poisson)[1] * np.array(parts)
    each = whole[None] - scale[:, None, None] * np.outer(shear, shear)[None]
    nodes = (across + 3) * (up + 3)
    load = np.zeros((nodes, 2))
    for x, y in product(range(a, b), range(c, d)):
        for dx, dy in product((0, 1), (0, 1)):
            load[(x + dx) * (up + 3) + y + dy] += size * (np.array([dx, dy]) - 0.5)
    used = np.repeat(np.isin(np.arange(nodes), corners), 2)
    matrix = matrix_of(corners.T, each, nodes)[used][:, used]
    matrix = matrix + HELD * YOUNG * sp.eye(int(used.sum()))
    right = load.ravel()[used]
    return float(right @ spsolve(matrix.tocsc(), right))


def main() -> None:
    """Print the tables."""
    sides = (16, 32, 64)
    print("relief at an edge between whole squares, to a side", *(2 * half for half in sides), "∞")
    limits = {}
    for poisson in (0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.4999):
        found = [relief_of(poisson, half) for half in sides]
        # Nodes beside the outside move linearly between those of the mode.
        rate = 2.0 ** (2 - 2 * ORDER)
        limits[poisson] = found[2] + (found[2] - found[1]) / (rate - 1)
        print(f"  {poisson:<8g}", *(f"{each:7.4f}" for each in (*found, limits[poisson])))
    print("relief around an edge in a square, by its filled part, 64 to a side")
    for poisson in (0.3, 0.49):
        parts = (0.9, 0.75, 0.6, 0.5, 0.4, 0.3, 0.22)
        row = (f"{part:g}: {relief_of(poisson, 32, part):.3f}" for part in parts)
        print(f"  {poisson:<8g}", *row)
    print("growth of rooms, error in % for squares of 4, 2, 1 and 0.5 mm")
    for poisson, name in product((0.3, 0.49), TUBES):
        # The order of what is left, from sizes without any relief.
        coarse, fine = (growth(name, size, poisson, 0, faces=False) for size in (0.25, 0.125))
        exact = fine + (fine - coarse) / (2 ** (2 * ORDER) - 1)
        for label, relief in (("without", 0.0), ("with", limits[poisson])):
            errors = [
                100 * (growth(name, size, poisson, relief) / exact - 1) for size in (4, 2, 1, 0.5)
            ]
            print(f"  {poisson:<5g}{name:20} {label:8}", *(f"{each:+7.2f}" for each in errors))


if __name__ == "__main__":
    main()
