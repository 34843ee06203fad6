"""What a row of voxels at a clamp lacks, tried at small strain.

``python research/clamp_modes.py``. A beam of 40 × 10 × 10 mm under its weight, held in full at one
end (a quarter of it, by symmetry), with several elements in the row at the clamp and the voxel
with free faces in the rest. Errors of the tip against quadratic bricks with linear pressure that
are graded to the edges of the clamp. `docs/method/elements.md` reads the table.

Strains are in the order xx, yy, zz, xy, yz, zx, shears doubled; E = 1.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import spsolve

Floats = NDArray[np.float64]
#: A polynomial in ξ, η, ζ: exponents and coefficients.
Polynomial = dict[tuple[int, int, int], float]
#: The axis along which a mode moves, and its shape.
Mode = tuple[int, Polynomial]

LENGTH, HALF = 40.0, 5.0
SHEARS = {(0, 1): 3, (1, 2): 4, (0, 2): 5}
TRACE = np.array([1.0, 1, 1, 0, 0, 0])
CORNERS = np.array(list(itertools.product((-1, 1), repeat=3)), dtype=float)
NODES = np.array(list(itertools.product((-1, 0, 1), repeat=3)), dtype=float)
ONE: Polynomial = {(0, 0, 0): 1.0}


def gauss(count: int) -> tuple[Floats, Floats]:
    """Points (n, 3) and weights of sum 1 in the cube from −1 to 1."""
    place, weight = np.polynomial.legendre.leggauss(count)
    points = np.array(list(itertools.product(place, repeat=3)))
    weights = np.array([np.prod(w) for w in itertools.product(weight, repeat=3)])
    return points, weights / 8


def power(axis: int, exponent: int) -> tuple[int, int, int]:
    """The exponents of one coordinate."""
    first, second, third = (exponent if k == axis else 0 for k in range(3))
    return first, second, third


def toward(axis: int, side: int) -> Polynomial:
    """One at a side of an axis, zero at the other."""
    return {(0, 0, 0): 0.5, power(axis, 1): 0.5 * side}


def bubble(axis: int) -> Polynomial:
    """Zero at both sides."""
    return {(0, 0, 0): 1.0, power(axis, 2): -1.0}


def coordinate(axis: int) -> Polynomial:
    """The coordinate itself."""
    return {power(axis, 1): 1.0}


def product(*factors: Polynomial) -> Polynomial:
    """The product of polynomials."""
    result = ONE
    for factor in factors:
        found: Polynomial = {}
        for (a, x), (b, y) in itertools.product(result.items(), factor.items()):
            key = (a[0] + b[0], a[1] + b[1], a[2] + b[2])
            found[key] = found.get(key, 0.0) + x * y
        result = found
    return result


def gradient(shape: Polynomial, points: Floats) -> Floats:
    """Slopes in a cube of edge 1, (n, 3)."""
    slopes = np.zeros((len(points), 3))
    for exponents, factor in shape.items():
        for axis in range(3):
            if exponents[axis]:
                lower = np.array(exponents) - np.eye(3, dtype=int)[axis]
                slopes[:, axis] += 2 * factor * exponents[axis] * np.prod(points**lower, axis=1)
    return slopes


def strain(axis: int, slopes: Floats) -> Floats:
    """The strain of a motion along an axis, (n, 6)."""
    found = np.zeros((len(slopes), 6))
    found[:, axis] = slopes[:, axis]
    for (i, j), place in SHEARS.items():
        if axis in (i, j):
            found[:, place] = slopes[:, i + j - axis]
    return found


def operator(slopes: Floats) -> Floats:
    """Strains of nodes with these slopes (points, nodes, 3): (points, 6, 3 nodes)."""
    columns = [
        strain(axis, slopes[:, node]) for node in range(slopes.shape[1]) for axis in range(3)
    ]
    return np.stack(columns, axis=2)


def shear_part(poisson: float) -> Floats:
    """The elasticity of the deviator."""
    modulus = 1 / (2 * (1 + poisson))
    return np.diag([2 * modulus] * 3 + [modulus] * 3) - 2 * modulus / 3 * np.outer(TRACE, TRACE)


def voxel_strain(poisson: float, points: Floats) -> tuple[Floats, Floats]:
    """The assumed strain of a voxel of edge 1 (points, 6, 24), and its mode ξηζ (3, 24)."""
    thinning = poisson / (1 - poisson)
    signs = [CORNERS[:, [j, k]].prod(axis=1) / 4 for j, k in ((1, 2), (2, 0), (0, 1))]

    def row(mode: int, axis: int) -> Floats:
        found = np.zeros(24)
        found[axis::3] = signs[mode]
        return found

    found = np.repeat(operator((CORNERS / 4)[None]), len(points), axis=0)
    for n in range(3):
        i, j = (n + 1) % 3, (n + 2) % 3
        part = np.zeros((6, 24))
        part[i], part[j] = row(j, i), row(i, j)
        part[n] = -thinning * (part[i] + part[j])
        part[SHEARS[min(i, j), max(i, j)]] = row(i, i) + row(j, j)
        found += points[:, n, None, None] * part
    last = np.zeros((3, 24))
    for axis in range(3):
        last[axis, axis::3] = CORNERS.prod(axis=1) / 4
    return found, last


def voxel(poisson: float, modes: list[Mode], count: int = 2) -> Floats:
    """The stiffness of a voxel of edge 1 with condensed modes and one pressure for them."""
    points, weights = gauss(count)
    own, last = voxel_strain(poisson, points)
    theirs = [strain(axis, gradient(shape, points)) for axis, shape in modes]
    all_strains = np.concatenate([own, *(s[:, :, None] for s in theirs)], axis=2)
    stiffness = np.einsum(
        "g,gai,ab,gbj->ij",
        *(weights, all_strains, shear_part(poisson), all_strains),
        optimize=True,
    )
    bulk = 1 / (3 * (1 - 2 * poisson))
    volume = np.einsum("a,gai->gi", TRACE, all_strains)
    mean = weights @ volume
    stiffness += bulk * np.outer(mean, mean)
    for n in range(3):
        linear = (weights * points[:, n]) @ volume * np.sqrt(3)
        linear[24:] = 0
        stiffness += bulk * np.outer(linear, linear)
    stiffness[:24, :24] += last.T @ last / 9
    nodes, hidden = stiffness[:24, :24], stiffness[24:, :24]
    return nodes - hidden.T @ np.linalg.pinv(stiffness[24:, 24:], rcond=1e-9) @ hidden


@cache
def quadratic(size: tuple[float, float, float], poisson: float) -> Floats:
    """The stiffness of a brick of 27 nodes with linear pressure."""
    points, weights = gauss(3)
    slopes = np.empty((27, 27, 3))
    for index, node in enumerate(NODES):
        shape = product(
            *(
                bubble(k) if s == 0 else product(coordinate(k), toward(k, int(s)), {(0, 0, 0): s})
                for k, s in enumerate(node)
            )
        )
        slopes[:, index] = gradient(shape, points) / np.array(size)
    strains = operator(slopes)
    stiffness = np.einsum(
        "g,gai,ab,gbj->ij", weights, strains, shear_part(poisson), strains, optimize=True
    )
    volume = np.einsum("a,gai->gi", TRACE, strains)
    for function in (np.ones(27), *(points.T * np.sqrt(3))):
        row = (weights * function) @ volume
        stiffness += np.outer(row, row) / (3 * (1 - 2 * poisson))
    return float(np.prod(size)) * stiffness


class Beam:
    """A quarter of the beam, element by element; nodes are told apart by their place."""

    def __init__(self) -> None:
        self.numbers: dict[tuple[float, ...], int] = {}
        self.entries: list[tuple[Floats, Floats, Floats]] = []
        self.weight: dict[int, float] = {}
        self.tied: dict[int, list[int]] = {}

    def node(self, place: Floats) -> int:
        """The number of a node."""
        return self.numbers.setdefault(tuple(np.round(place, 7)), len(self.numbers))

    def add(self, places: Floats, stiffness: Floats, weights: Floats) -> None:
        """An element, and the part of its weight on each node."""
        nodes = np.array([self.node(place) for place in places])
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        one = np.ones(len(rows))
        self.entries.append(
            (np.outer(rows, one).ravel(), np.outer(one, rows).ravel(), stiffness.ravel())
        )
        for node, weight in zip(nodes, weights, strict=True):
            self.weight[node] = self.weight.get(node, 0.0) + weight

    def tip(self) -> float:
        """How far the middle of the free end goes down under its weight."""
        count = len(self.numbers)
        places = np.array(list(self.numbers))
        rows, columns, values = (np.concatenate(part) for part in zip(*self.entries, strict=True))
        stiffness = sp.csr_matrix((values, (rows, columns)), shape=(3 * count, 3 * count))
        load = np.zeros((count, 3))
        load[list(self.weight), 2] = list(self.weight.values())
        follow = sp.identity(count, format="lil")
        for node, others in self.tied.items():
            follow[node, node] = 0.0
            for other in others:
                follow[node, other] = 1 / len(others)
        ties = sp.kron(follow.tocsr(), sp.identity(3)).tocsr()
        held = np.zeros((count, 3), dtype=bool)
        held[list(self.tied)] = True
        held |= places[:, :1] < 1e-9
        held[:, 1] |= (places[:, 1] < 1e-9) | (places[:, 2] < 1e-9)
        held[:, 0] |= places[:, 2] < 1e-9
        free = np.flatnonzero(~held.ravel())
        system = (ties.T @ stiffness @ ties).tocsr()[free][:, free]
        moved = np.zeros(3 * count)
        moved[free] = spsolve(system.tocsc(), (ties.T @ load.ravel())[free])
        return float(moved[3 * self.node(np.array([LENGTH, 0, 0])) + 2])


def cells(edge: float) -> Iterator[tuple[Floats, tuple[int, ...]]]:
    """The lowest corners of the voxels, and which of the sides y and z are free."""
    across = round(HALF / edge)
    for i, j, k in itertools.product(range(round(LENGTH / edge)), range(across), range(across)):
        free = tuple(axis for axis, at in ((1, j), (2, k)) if at == across - 1)
        yield edge * np.array([i, j, k], dtype=float), free


def warping(free: tuple[int, ...], axes: tuple[int, ...]) -> list[Mode]:
    """The tangential modes of free faces along some axes."""
    return [(t, product(toward(n, 1), bubble(3 - n - t))) for n in free for t in axes if t != n]


def reference(poisson: float, levels: int = 5) -> float:
    """Quadratic bricks, graded by powers of two to the clamp and its edges."""
    graded = 5 * 0.5 ** np.arange(levels + 1)
    along = np.r_[0, graded[::-1], np.arange(10, LENGTH + 1, 5)]
    across = np.r_[0, HALF - graded[1:], HALF]
    beam = Beam()
    for ends in itertools.product(*(itertools.pairwise(x) for x in (along, across, across))):
        low, high = np.array(ends).T
        add_quadratic(beam, low, np.round(high - low, 10), poisson)
    return beam.tip()


def add_quadratic(beam: Beam, low: Floats, size: Floats, poisson: float) -> None:
    """A brick of 27 nodes."""
    parts = np.prod(np.where(NODES == 0, 2 / 3, 1 / 6), axis=1)
    x, y, z = (float(s) for s in size)
    beam.add(low + size * (NODES + 1) / 2, quadratic((x, y, z), poisson), np.prod(size) * parts)


def of_row(poisson: float, edge: float, modes: Callable[[tuple[int, ...]], list[Mode]]) -> float:
    """The tip with voxels, those at the clamp with these modes."""
    beam = Beam()
    known: dict[tuple[bool, tuple[int, ...]], Floats] = {}
    for low, free in cells(edge):
        key = (low[0] == 0, free)
        if key not in known:
            own = modes(free) if low[0] == 0 else warping(free, (0, 1, 2))
            known[key] = voxel(poisson, own, 2 if low[0] == 0 else 3)
        beam.add(low + edge * (CORNERS + 1) / 2, edge * known[key], np.full(8, edge**3 / 8))
    return beam.tip()


def of_quadratic_row(poisson: float, edge: float, inner: bool) -> float:
    """The tip with bricks of 27 nodes at the clamp; those between voxels tied unless `inner`."""
    beam = Beam()
    for low, free in cells(edge):
        if low[0] == 0:
            add_quadratic(beam, low, np.full(3, edge), poisson)
        else:
            stiffness = edge * voxel(poisson, warping(free, (0, 1, 2)), 3)
            beam.add(low + edge * (CORNERS + 1) / 2, stiffness, np.full(8, edge**3 / 8))
    for place, node in list(beam.numbers.items()):
        at = np.array(place) / edge
        odd = np.abs(at - np.round(at)) > 0.1
        across = round(at[0]) == 1 and not odd[0]
        shared = any(not odd[k] and at[k] < HALF / edge - 1e-6 for k in (1, 2))
        if odd.any() and at[0] < 1 + 1e-9 and (across or (odd[0] and shared and not inner)):
            sides = itertools.product(*((-0.5, 0.5) if o else (0.0,) for o in odd))
            beam.tied[node] = [beam.node(edge * (at + np.array(side))) for side in sides]
    return beam.tip()


def drawing_in(free: tuple[int, ...]) -> list[Mode]:
    """The motions along the normals of free faces beside the clamp."""
    return [
        (n, product(bubble(0), toward(n, 1), along))
        for n in free
        for along in (ONE, coordinate(3 - n))
    ]


def middle_layer(_: tuple[int, ...]) -> list[Mode]:
    """All nine nodes of the middle layer, voxel by voxel."""
    functions = [[ONE, coordinate(axis), bubble(axis)] for axis in (1, 2)]
    return [
        (axis, product(bubble(0), f, g))
        for axis in range(3)
        for f, g in itertools.product(*functions)
    ]


def main() -> None:
    """Print the table: errors in % with voxels of 5 and 2.5 mm."""
    rows: dict[str, Callable[[float, float], float]] = {
        "voxels with free faces": lambda nu, h: of_row(nu, h, lambda f: warping(f, (1, 2))),
        "conforming, one layer": lambda nu, h: of_quadratic_row(nu, h, inner=False),
        "all of the middle layer": lambda nu, h: of_row(nu, h, middle_layer),
        "b eₙ, b ξₜ eₙ": lambda nu, h: of_row(nu, h, drawing_in),
        "b eₙ, b ξₜ eₙ, b eₜ": lambda nu, h: of_row(
            nu, h, lambda f: drawing_in(f) + warping(f, (1, 2))
        ),
        "row of 27 nodes": lambda nu, h: of_quadratic_row(nu, h, inner=True),
    }
    ratios = (0.3, 0.49, 0.4999)
    exact = {poisson: reference(poisson) for poisson in ratios}
    for name, tip in rows.items():
        errors = [
            [100 * (tip(poisson, edge) / exact[poisson] - 1) for edge in (5.0, 2.5)]
            for poisson in ratios
        ]
        print(
            f"{name:<26}", *(f"{coarse:+.1f} / {fine:+.1f}" for coarse, fine in errors), sep=" | "
        )


if __name__ == "__main__":
    main()
