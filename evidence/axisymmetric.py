"""Bodies of revolution under pressure, as truths for cut voxels: quadratic elements of scikit-fem.

``python evidence/axisymmetric.py [--json]`` checks the elements against the closed form of a thick
sphere, the round cylinders of `tests/data/cylinders_4kPa_smooth.csv`, and themselves with sides
half as long. Quadrilaterals have nine nodes for the displacement and four for the pressure (Taylor
and Hood), sides are curved as the body is, and the energy is that of `NeoHookean`,
``μ/2 (Ī₁ - 3) + K/2 (J - 1)²``. Nothing is shared with the voxels, their elements or their solver.
"""

from __future__ import annotations

import csv
import runpy
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bmat, csr_matrix
from scipy.sparse.linalg import splu
from skfem import (
    Basis,
    BilinearForm,
    ElementQuad1,
    ElementQuad2,
    ElementVector,
    FacetBasis,
    Functional,
    LinearForm,
    MeshQuad,
    MeshQuad2,
)

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

Floats = NDArray[np.float64]

TESTS: Final = Path(__file__).parents[1] / "tests"
#: Largest residual over the largest force of the pressure.
TOLERANCE: Final = 1e-9
_ITERATIONS: Final = 12
_SMALLEST_STEP: Final = 1e-3
_ORDER: Final = 5
#: What is on the axis, or in a plane, in mm.
_CLOSE: Final = 1e-6


@dataclass(frozen=True)
class Answer:
    """Equilibrium: pressure in kPa, volumes in ml, and displacement of a node by its place."""

    pressure: float
    volume: float
    grown: float
    moved: Callable[[Sequence[float]], Floats]


class Revolved:
    """A body of revolution about z with one closed chamber.

    Parameters
    ----------
    mesh
        Its half section, x the radius; in mm.
    walls
        Numbers of the sides of elements at which the chamber ends.
    held
        Tells of nodes, (2, n), which do not move. Nodes on the axis stay on it.
    young, poisson
        Of the rubber; in kPa.
    """

    def __init__(
        self,
        mesh: MeshQuad2,
        walls: NDArray[np.int64],
        held: Callable[[Floats], NDArray[np.bool_]],
        young: float,
        poisson: float,
    ) -> None:
        self.shear = young / (2 * (1 + poisson))
        self.bulk = young / (3 * (1 - 2 * poisson))
        self._moves = Basis(mesh, ElementVector(ElementQuad2()), intorder=_ORDER)
        self._presses = self._moves.with_element(ElementQuad1())
        self._walls = FacetBasis(mesh, self._moves.elem, facets=walls, intorder=_ORDER)
        places = self._moves.doflocs
        fixed = held(places)
        across = self._moves.split_indices()[0]
        fixed[across] |= np.abs(places[0, across]) < _CLOSE
        self._fixed = np.flatnonzero(fixed)
        self._size = self._moves.N + self._presses.N + 1
        rest = self._state(np.zeros(self._size))
        self.volume = float(_volume.assemble(self._walls, u=rest[0])) * 1e-3

    def _state(self, x: Floats) -> tuple[Any, Any, Any, float]:
        u, p = x[: self._moves.N], x[self._moves.N : -1]
        return (
            self._walls.interpolate(u),
            self._moves.interpolate(u),
            self._presses.interpolate(p),
            float(x[-1]),
        )

    def _system(self, x: Floats) -> tuple[csr_matrix, Floats, Floats, float]:
        """Tangent and residual without the last row, slopes of the volume, and the volume."""
        wall, u, p, pressure = self._state(x)
        data = {"u": u, "p": p, "shear": self.shear, "bulk": self.bulk}
        stiff = _stiffness.assemble(self._moves, **data)
        couple = _coupling.assemble(self._moves, self._presses, **data)
        soft = _compliance.assemble(self._presses, **data)
        forces = _forces.assemble(self._moves, **data)
        misfit = _misfit.assemble(self._presses, **data)
        slope = _swelling.assemble(self._walls, u=wall)
        turn = _follower.assemble(self._walls, u=wall)
        column = csr_matrix(-slope[:, None])
        tangent = bmat([[stiff - pressure * turn, couple.T, column], [couple, soft, None]], "csr")
        residual = np.concatenate([forces - pressure * slope, misfit])
        return tangent, residual, slope, float(_volume.assemble(self._walls, u=wall))

    def at_pressure(self, pressure: float) -> Answer:
        """The equilibrium at a pressure in kPa."""
        return self._follow(lambda part: (False, part * pressure))

    def at_volume(self, ratio: float) -> Answer:
        """The equilibrium with the chamber `ratio` times as large as at rest."""
        return self._follow(lambda part: (True, self.volume * (1 + part * (ratio - 1))))

    def _follow(self, goal: Callable[[float], tuple[bool, float]]) -> Answer:
        x, reached, step = np.zeros(self._size), 0.0, 0.25
        before: tuple[float, Floats] | None = None
        while reached < 1.0:
            part = min(1.0, reached + step)
            guess = x.copy()
            if before is not None:
                guess += (x - before[1]) * (part - reached) / (reached - before[0])
            found = self._equilibrium(guess, *goal(part))
            if found is None:
                step, before = step / 2.0, None
                if step < _SMALLEST_STEP:
                    raise SystemExit(f"no equilibrium past {reached:.1%}")
                continue
            before, x, reached = (reached, x), found, part
        wall, *_, pressure = self._state(x)
        volume = float(_volume.assemble(self._walls, u=wall)) * 1e-3

        def moved(point: Sequence[float]) -> Floats:
            away = np.hypot(*(self._moves.doflocs - np.array(point)[:, None]))
            here = np.flatnonzero(away < _CLOSE)
            if len(here) != 2:
                raise SystemExit(f"no node at {point}")
            return np.asarray(x[here])

        return Answer(pressure, volume, volume - self.volume, moved)

    def _equilibrium(self, x: Floats, by_volume: bool, aim: float) -> Floats | None:
        free = np.setdiff1d(np.arange(self._size), self._fixed)
        for _ in range(_ITERATIONS):
            # Elements that are inside out have powers that are no numbers.
            with np.errstate(invalid="ignore"):
                tangent, residual, slope, volume = self._system(x)
            last = np.zeros(self._size)
            if by_volume:
                last[: self._moves.N] = slope
                missing = (volume - aim * 1e3) / (2 * np.pi)
            else:
                last[-1] = 1.0
                missing = x[-1] - aim
            whole = bmat([[tangent], [csr_matrix(last)]], "csc")[free][:, free]
            off = np.append(residual, missing)[free]
            scale = max(abs(x[-1]), 1e-3 * self.shear) * np.abs(slope).max()
            if not np.isfinite(whole.data).all() or not np.isfinite(off).all():
                return None
            move = splu(whole).solve(-off)
            x = x.copy()
            x[free] += move
            if np.abs(off[: len(off) - 1 - self._presses.N]).max() < TOLERANCE * scale:
                return x
        return None


# --- Forms ----------------------------------------------------------------------------------------


def _deformed(u: Any, r: Floats) -> tuple[Floats, Floats]:
    """F in the half section, (2, 2, ...), and the stretch around the axis."""
    return np.eye(2)[:, :, None, None] + np.asarray(u.grad), 1.0 + np.asarray(u)[0] / r


def _cofactor(f: Any) -> Floats:
    return np.array([[f[1][1], -f[1][0]], [-f[0][1], f[0][0]]])


def _inner(a: Any, b: Any) -> Floats:
    found: Floats = np.einsum("ij...,ij...->...", np.asarray(a), np.asarray(b))
    return found


def _measures(w: Any) -> tuple[Floats, ...]:
    """F, its stretch around, its cofactor, those of the whole, J and I₁."""
    f, around = _deformed(w["u"], w.x[0])
    flat = _cofactor(f)
    area = f[0, 0] * f[1, 1] - f[0, 1] * f[1, 0]
    return f, around, around * flat, area, around * area, _inner(f, f) + around**2


def _varied(v: Any, r: Floats) -> tuple[Floats, Floats]:
    return np.asarray(v.grad), np.asarray(v)[0] / r


@LinearForm
def _forces(v: Any, w: Any) -> Floats:
    f, around, cofactor, area, change, first = _measures(w)
    g, about = _varied(v, w.x[0])
    by_change = w["p"] - w["shear"] / 3 * change ** (-5 / 3) * first
    isochoric = w["shear"] * change ** (-2 / 3) * (_inner(f, g) + around * about)
    volumetric = by_change * (_inner(cofactor, g) + area * about)
    return (isochoric + volumetric) * w.x[0]


@BilinearForm
def _stiffness(u: Any, v: Any, w: Any) -> Floats:
    f, around, cofactor, area, change, first = _measures(w)
    g, about = _varied(v, w.x[0])
    d, turned = _varied(u, w.x[0])
    scale, power = w["shear"] * change ** (-2 / 3), w["shear"] / 3 * change ** (-5 / 3)
    by_change = w["p"] - power * first
    change_d = _inner(cofactor, d) + area * turned
    change_g = _inner(cofactor, g) + area * about
    first_d = 2 * (_inner(f, d) + around * turned)
    first_g = 2 * (_inner(f, g) + around * about)
    flat = cofactor / around
    second = around * _inner(_cofactor(d), g) + turned * _inner(flat, g) + about * _inner(flat, d)
    found = scale * (_inner(d, g) + turned * about) + by_change * second
    found = found - power * (change_d * first_g + first_d * change_g)
    return (found + 5 / 3 * power / change * first * change_d * change_g) * w.x[0]


@BilinearForm
def _coupling(u: Any, q: Any, w: Any) -> Floats:
    _, _, cofactor, area, _, _ = _measures(w)
    d, turned = _varied(u, w.x[0])
    return (_inner(cofactor, d) + area * turned) * q * w.x[0]


@BilinearForm
def _compliance(p: Any, q: Any, w: Any) -> Floats:
    return -p * q / w["bulk"] * w.x[0]


@LinearForm
def _misfit(q: Any, w: Any) -> Floats:
    *_, change, _ = _measures(w)
    return (change - 1.0 - w["p"] / w["bulk"]) * q * w.x[0]


def _normal(f: Any, n: Any) -> Floats:
    found: Floats = np.einsum("ij...,j...->i...", np.asarray(_cofactor(f)), np.asarray(n))
    return found


@Functional
def _volume(w: Any) -> Floats:
    """Volume of the chamber in mm³ by Gauss; its walls look into it."""
    f, around = _deformed(w["u"], w.x[0])
    place = np.asarray(w.x) + np.asarray(w["u"])
    flux = np.einsum("i...,i...->...", place, _normal(f, w.n))
    return -2 * np.pi / 3 * around * flux * w.x[0]


@LinearForm
def _swelling(v: Any, w: Any) -> Floats:
    """Slope of the volume over 2π."""
    f, around = _deformed(w["u"], w.x[0])
    return -around * np.einsum("i...,i...->...", _normal(f, w.n), np.asarray(v)) * w.x[0]


@BilinearForm
def _follower(u: Any, v: Any, w: Any) -> Floats:
    f, around = _deformed(w["u"], w.x[0])
    d, turned = _varied(u, w.x[0])
    normal = turned * _normal(f, w.n) + around * _normal(d, w.n)
    return -np.einsum("i...,i...->...", normal, np.asarray(v)) * w.x[0]


# --- Bodies ---------------------------------------------------------------------------------------


def _quadratic(mesh: MeshQuad, place: Callable[[Floats], Floats]) -> MeshQuad2:
    """A mesh with curved sides: `place` takes its points, (2, n), to those of the body."""
    flat = MeshQuad2.from_mesh(mesh)
    return MeshQuad2(place(flat.doflocs), flat.t)


def between(
    inner: Callable[[Floats], Floats],
    outer: Callable[[Floats], Floats],
    young: float,
    poisson: float,
    sides: tuple[int, int],
    knots: Sequence[float] = (0.0, 1.0),
) -> Revolved:
    """A shell between two curves, free to move but for the lowest point.

    Parameters
    ----------
    inner, outer
        Points (2, n) of numbers from 0, at the bottom, to 1, at the top.
    young, poisson
        Of the rubber; in kPa.
    sides
        Numbers of elements through the wall, and along it between two knots.
    knots
        Numbers at which a curve has another curvature.
    """
    through, along = sides
    marks = np.unique([np.linspace(a, b, along + 1) for a, b in pairwise(knots)])

    def place(x: Floats) -> Floats:
        found: Floats = (1 - x[0]) * inner(x[1]) + x[0] * outer(x[1])
        found[0] = np.where((x[1] < _CLOSE) | (x[1] > 1 - _CLOSE), 0.0, found[0])
        return found

    mesh = _quadratic(MeshQuad.init_tensor(np.linspace(0, 1, through + 1), marks), place)
    grid = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.linspace(0, 1, through + 1), marks))
    lowest = outer(np.zeros(1))[:, 0]
    boundary = mesh.boundary_facets()
    within = grid.p[0, grid.facets[:, boundary]].max(axis=0) < _CLOSE
    return Revolved(
        mesh,
        boundary[within],
        lambda x: np.hypot(*(x - lowest[:, None])) < _CLOSE,
        young,
        poisson,
    )


def arc(radius: float, height: float = 0.0) -> Callable[[Floats], Floats]:
    """Half a circle from its lowest to its highest point, with its center on the axis."""

    def place(t: Floats) -> Floats:
        return np.array([radius * np.sin(np.pi * t), height - radius * np.cos(np.pi * t)])

    return place


def stadium(radius: float, half: float) -> Callable[[Floats], Floats]:
    """Outline of a capsule: quarter circles up to 1/3 and from 2/3 on, `half` off the middle."""

    def place(t: Floats) -> Floats:
        angle = np.pi / 2 * np.where(t < 0.5, np.minimum(3 * t, 1), np.maximum(3 * t - 1, 1))
        middle = half * np.clip(6 * t - 3, -1, 1)
        return np.array([radius * np.sin(angle), middle - radius * np.cos(angle)])

    return place


def can(
    radii: tuple[float, float],
    heights: tuple[float, float, float, float],
    young: float,
    poisson: float,
    edge: float,
) -> Revolved:
    """An upright cylinder with a cylindrical chamber, held at its lower face.

    Parameters
    ----------
    radii
        Of the chamber and of the body in mm.
    heights
        Of the lower face, the bottom and the top of the chamber, and the upper face in mm.
    young, poisson
        Of the rubber; in kPa.
    edge
        Sides of elements in mm; beside edges they are a sixteenth.
    """
    across = _graded((0.0, *radii), edge, corners=(1, 2))
    along = _graded(heights, edge, corners=(0, 1, 2))
    mesh = MeshQuad.init_tensor(across, along)
    middles = mesh.p[:, mesh.t].mean(axis=1)
    low, high = heights[1:3]
    room = (middles[0] < radii[0]) & (middles[1] > low) & (middles[1] < high)
    body = MeshQuad2.from_mesh(mesh.remove_elements(np.flatnonzero(room)))
    sides = body.boundary_facets()
    r, z = body.p[:, body.facets[:, sides]].mean(axis=1)
    walls = (r < radii[0] + _CLOSE) & (z > low - _CLOSE) & (z < high + _CLOSE) & (r > _CLOSE)
    return Revolved(body, sides[walls], lambda x: x[1] < heights[0] + _CLOSE, young, poisson)


def _graded(marks: Sequence[float], edge: float, corners: Sequence[int]) -> Floats:
    """Divide the ranges between marks evenly, and halve four times beside the corners."""
    found = set()
    for low, high in pairwise(marks):
        found.update(np.linspace(low, high, max(2, round((high - low) / edge)) + 1).tolist())
    points = np.unique(np.round(sorted(found), 9))
    for corner in corners:
        for _ in range(4):
            index = int(np.abs(points - marks[corner]).argmin())
            beside = [n for n in (index - 1, index + 1) if 0 <= n < len(points)]
            points = np.sort([*points, *((points[index] + points[n]) / 2 for n in beside)])
    return points


def main() -> None:
    """Hold the elements against closed forms and other codes."""
    report = Report("Bodies of revolution on quadratic elements")
    inner_pressure = runpy.run_path(str(TESTS / "round_walls.py"))["inner_pressure"]
    for poisson, stretch in ((0.3, 1.4), (0.49, 1.4)):
        pressure = inner_pressure(100.0, poisson, stretch, 10.0, 20.0, sphere=True)
        for sides in ((2, 8), (4, 16)):
            ball = between(arc(10), arc(20), 100.0, poisson, sides)
            exact = 4 / 3 * np.pi * (stretch**3 - 1)
            found = ball.at_pressure(pressure).grown
            name = f"sphere, ν {poisson:g}, {sides[0]} elements through the wall, growth"
            report.add(name, found, "ml", found / exact)
            held = ball.at_volume(stretch**3)
            report.add(
                f"{name} controlled, pressure", held.pressure, "kPa", held.pressure / pressure
            )
    table = TESTS / "data" / "cylinders_4kPa_smooth.csv"
    lines = table.read_text(encoding="utf-8").splitlines()
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        wall, rise = float(row["wall_mm"]), float(row["top_centre_uz_mm"])
        body = can((25 - wall, 25), (0, 5, 30, 35), 60.0, 0.49, 1.25)
        found = body.at_pressure(4.0).moved((0, 35))[1]
        report.add(f"cylinder, wall {wall:g} mm, rise", found, "mm", found / rise)
    for edge in (2.5, 1.25):
        tube = can((10, 20), (0, 10, 50, 60), 100.0, 0.49, edge).at_pressure(11.5)
        report.add(f"tube, elements of {edge:g} mm, growth", tube.grown, "ml", tube.grown / 8.015)
        for name, point, axis, other in (
            ("bore", (10, 30), 0, 3.046),
            ("outside", (20, 30), 0, 1.547),
            ("top", (0, 60), 1, 1.790),
        ):
            found = tube.moved(point)[axis]
            report.add(f"tube, elements of {edge:g} mm, {name}", found, "mm", found / other)
    report.show()


if __name__ == "__main__":
    main()
