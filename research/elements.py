"""Elements for voxels, compared by measurement.

``python research/elements.py [--fine] [--only NAME;NAME]``. Ten elements on the same
cubes: bending, clamped beams, pressurized cylinders, locking, stability, cost. `--fine` adds every
voxel split into 2 × 2 × 2 cubes. Needs ``pip install jax``. `docs/method/elements.md` reads the
table.

References: the six beams of converged Q2–Q1 elements (scikit-fem; beam (a) also by CalculiX
C3D20R), and the stair-step cylinders of CalculiX C3D20 and mixed Q2–P1 on the same voxels, refined;
the band of the latter is ±1 %. Strips are measured against Timoshenko's beam.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

import numpy as np

try:
    from element_energies import ELEMENTS, Element
    from element_newton import (
        CHUNK,
        Body,
        Floats,
        NotConverged,
        Solver,
        body_of,
        chunks,
        faces_toward,
        kernel,
    )
except ImportError as missing:
    raise SystemExit(f"this benchmark needs jax: pip install jax ({missing})") from missing

MM = 1e-3
YOUNG, DENSITY, GRAVITY = 60e3, 1070.0, 9.81
#: Beams: length, width, height, and the tip's converged displacement along x and z, all in mm.
BEAMS = {
    "a": (100, 10, 10, -44.0603, -72.9053),
    "b": (100, 20, 10, -42.4000, -71.9129),
    "c": (100, 10, 20, -9.2742, -38.7873),
    "d": (50, 10, 10, -0.5806, -6.6791),
    "e": (50, 20, 10, -0.5360, -6.4208),
    "f": (50, 10, 20, -0.0408, -2.0304),
}
#: Rise in mm of the middle of the top, by wall in mm: 5 mm voxels as they are, and round.
CYLINDERS = {5: (12.2, 10.888), 10: (6.13, 5.654), 15: (2.02, 2.318)}

Row = tuple[str, float, str]


def material(poisson: float = 0.49) -> Floats:
    """Neo-Hookean constants (μ, K, c20) in Pa."""
    return np.array([YOUNG / (2 * (1 + poisson)), YOUNG / (3 * (1 - 2 * poisson)), 0.0])


def at(body: Body, *point: float) -> int:
    """Index of the corner at a point in m."""
    gap = np.abs(body.vertices - point).max(axis=1)
    found = int(np.argmin(gap))
    assert gap[found] < 1e-9, f"no corner at {point}"
    return found


def modes(element: Element) -> Iterator[Row]:
    """Zero modes of one cube and the softest of the others in units of μh."""
    body = body_of(np.ones((1, 1, 1), dtype=bool), 1.0, material())
    values = np.linalg.eigvalsh(Solver(element, body).system(0.0)[2].toarray()) / body.material[0]
    zero = int(np.sum(np.abs(values) < 1e-8))
    if zero != 6:
        raise SystemExit(f"wrong answer: {element.name} has {zero} zero modes, expected 6")
    yield "zero modes", float(zero), ""
    yield "softest mode", float(values[6]), "μh"


def patch(element: Element) -> Iterator[Row]:
    """A block of 3³ cubes, its skin moved by one large gradient: how far the inside is off."""
    body = body_of(np.ones((3, 3, 3), dtype=bool), 1.0, material())
    gradient = np.array([[1.3, 0.2, 0.0], [-0.1, 0.9, 0.15], [0.05, 0.1, 0.95]])
    body.held[:] = (np.abs(body.vertices - 1.5).max(axis=1) > 1.4)[:, None]
    solver = Solver(element, body)
    exact = body.vertices @ gradient.T
    noise = np.random.default_rng(1).normal(scale=0.02, size=exact.shape)
    solver.x = np.where(body.held, exact, exact + noise)
    solver.newton(1.0)
    off = float(np.abs(solver.x - exact).max())
    if off > 1e-9:  # Newton stops at 1e-9 of the stresses
        raise SystemExit(f"wrong answer: {element.name} misses the patch test by {off:.1e} h")
    yield "patch test", off, "h"


def strip(element: Element, layers: int, poisson: float, wide: bool) -> float:
    """Tip of a strip 10 mm thick and 100 mm long against Timoshenko's beam, small load.

    Its root is a plane of symmetry and not a clamp, so that no corner is singular.
    """
    h = 10 * MM / layers
    body = body_of(np.ones((10 * layers, layers, layers), dtype=bool), h, material(poisson))
    body.held[body.vertices[:, 0] < 1e-9, 0] = True
    body.held[at(body, 0, 0, 0)] = True
    body.held[body.vertices[:, 1] < 1e-9, 1] = True
    if wide:
        body.held[:, 1] = True
    weight = 1.0
    np.add.at(body.force[:, 2], body.cells.ravel(), -weight * h**3 / 8)
    tip = Solver(element, body).solve()[at(body, 0.1, 0, 0), 2]
    young = YOUNG / (1 - poisson**2) if wide else YOUNG
    length, thick = 0.1, 0.01
    bend = weight * length**4 * 12 / (8 * young * thick**2)
    shear = weight * length**2 / (2 * 5 / 6 * material(poisson)[0])
    return float(tip / -(bend + shear))


def strips(element: Element) -> Iterator[Row]:
    """Bending with one and two voxels through the thickness."""
    for n in (1, 2):
        yield f"strip, {n} across", 100 * (strip(element, n, 0.49, False) - 1), "%"
    for n in (1, 2):
        yield f"strip held sideways, {n} across", 100 * (strip(element, n, 0.49, True) - 1), "%"
    yield "strip, ν = 0.4999, 2 across", 100 * (strip(element, 2, 0.4999, False) - 1), "%"


def plate(element: Element) -> Iterator[Row]:
    """A clamped square plate one voxel thick against Kirchhoff's (0.00126532 p a⁴/D)."""
    cells, h = 20, 5 * MM
    body = body_of(np.ones((cells, cells, 1), dtype=bool), h, material())
    side = 2 * cells * h
    body.held[body.vertices[:, 0] < 1e-9, 0] = True
    body.held[body.vertices[:, 1] < 1e-9, 1] = True
    body.held[body.vertices[:, :2].max(axis=1) > side / 2 - 1e-9] = True
    pressure = 1e-4
    np.add.at(body.force[:, 2], body.cells.ravel(), pressure * h**2 / 8)
    middle = Solver(element, body).solve()[at(body, 0, 0, 0), 2]
    rigidity = YOUNG * h**3 / (12 * (1 - 0.49**2))
    yield "plate, 1 across", 100 * (middle * rigidity / (0.00126532 * pressure * side**4) - 1), "%"


def beam(element: Element, name: str, h: float) -> Row:
    """Error of the tip of a hanging beam in % of its displacement; the sign is that of its size."""
    length, width, height, ux, uz = BEAMS[name]
    inside = np.ones(tuple(round(s * MM / h) for s in (length, width, height)), dtype=bool)
    body = body_of(inside, h, material())
    body.held[body.vertices[:, 0] < 10 * MM + 1e-9] = True
    np.add.at(body.force[:, 2], body.cells.ravel(), -DENSITY * GRAVITY * h**3 / 8)
    tip = Solver(element, body).solve(6)[at(body, length * MM, width * MM / 2, height * MM / 2)]
    reference = np.array([ux, uz]) * MM
    size = float(np.linalg.norm(reference))
    error = float(np.linalg.norm(tip[[0, 2]] - reference)) / size
    sign = np.sign(np.linalg.norm(tip) - size)
    return f"beam {name}, {h / MM:g} mm", 100 * sign * error, "%"


def cylinder(element: Element, wall: int, split: int) -> Row:
    """Rise of a closed cylinder of 5 mm voxels at 4 kPa, each voxel split, in % of converged."""
    h = 5.0
    across = (np.arange(10) + 0.5) * h - 25
    up = (np.arange(7) + 0.5) * h
    radius = np.hypot(across[:, None], across[None, :])[:, :, None]
    cavity = (radius < 25 - wall) & ((up > 5) & (up < 30))[None, None, :]
    inside = (radius < 25) & (up > 0)[None, None, :] & ~cavity

    def quarter(grid: np.ndarray) -> np.ndarray:
        for axis in range(3):
            grid = grid.repeat(split, axis)
        return grid[5 * split :, 5 * split :]

    inside, cavity = quarter(inside), quarter(cavity)
    body = body_of(inside, h * MM / split, material())
    body.faces, body.pressure = faces_toward(body, inside, cavity), 4e3
    body.held[body.vertices[:, 0] < 1e-9, 0] = True
    body.held[body.vertices[:, 1] < 1e-9, 1] = True
    body.held[body.vertices[:, 2] < 1e-9] = True
    rise = Solver(element, body).solve(2)[at(body, 0, 0, 35 * MM), 2] / MM
    name = f"cylinder, wall {wall} mm" + (f", split {split}" if split > 1 else "")
    return name, 100 * (float(rise) / CYLINDERS[wall][0] - 1), "%"


def stable(element: Element, targets: tuple[float, ...]) -> float:
    """The last stretch of a block, its ends sliding and its sides free, with a stable tangent."""
    body = body_of(np.ones((3, 3, 3), dtype=bool), 1.0, material())
    top = body.vertices[:, 2] > 3 - 1e-9
    for axis in range(3):
        body.held[body.vertices[:, axis] < 1e-9, axis] = True
    body.held[top, 2] = True
    solver = Solver(element, body)
    last = 1.0
    for target in targets:
        growth = target / last
        solver.x = solver.x * np.array([growth**-0.5, growth**-0.5, growth])
        try:
            solver.newton(1.0)
        except NotConverged:
            return last
        if np.linalg.eigvalsh(solver.tangent(1.0).toarray())[0] <= 0:
            return last
        last = target
    return last


def stability(element: Element) -> Iterator[Row]:
    """How far a uniform block can be squeezed and drawn (Biot's surface wrinkles at 0.44)."""
    yield "squeezed, stable to", stable(element, tuple(np.arange(0.95, 0.44, -0.05))), ""
    yield "drawn, stable to", stable(element, tuple(np.arange(1.25, 4.01, 0.25))), ""


def cost(element: Element) -> Iterator[Row]:
    """Evaluations of the material, and time of value, gradient and Hessian of one voxel."""
    yield "material points", float(element.points), ""
    u = np.zeros((CHUNK, 21 + element.inner))
    u[:, [0, 4, 8]] = 1.0
    parity = np.zeros(CHUNK, dtype=np.int64)
    times = []
    for _ in range(6):
        start = time.process_time()
        chunks(kernel(element), u, material(), parity)
        times.append(time.process_time() - start)
    yield "one evaluation", min(times) / CHUNK * 1e6, "µs"


def rows_of(element: Element, fine: bool) -> Iterator[Row]:
    """Every figure of one element."""
    yield from modes(element)
    yield from patch(element)
    yield from strips(element)
    yield from plate(element)
    for name in BEAMS:
        yield beam(element, name, 5 * MM)
    for wall in CYLINDERS:
        yield cylinder(element, wall, 1)
    if fine:
        for name in BEAMS:
            yield beam(element, name, 2.5 * MM)
        for wall in CYLINDERS:
            yield cylinder(element, wall, 2)
    yield from stability(element)
    yield from cost(element)


def main() -> None:
    """Run everything."""
    parser = argparse.ArgumentParser(description="Elements for voxels")
    parser.add_argument("--fine", action="store_true", help="also every voxel split in 2 × 2 × 2")
    parser.add_argument("--only", default=";".join(ELEMENTS), help="names of elements")
    chosen = parser.parse_args()
    for name in chosen.only.split(";"):
        for figure, value, unit in rows_of(ELEMENTS[name], chosen.fine):
            print(f"{name}: {figure}: {value:.4g} {unit}", flush=True)


if __name__ == "__main__":
    main()
