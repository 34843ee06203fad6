"""Rubber under tension from all sides: a cube beside its limit, and a layer beside FElupe.

``python evidence/stability.py [--json] [--fine]``. A cube under equal dead tractions T is stable up
to T λ = 2 μ (Rivlin 1948, doi 10.1098/rsta.1948.0002; `tests/verification/test_tension.py` has
the derivation), for any Poisson's ratio. An eighth of it is solved, with planes of symmetry. A
layer of 32 x 32 x 4 mm is bonded to two plates that are drawn apart by parts of its height.

Each row has Newton's iterations, the elastic energy and θ, the least eigenvalue of K x = θ K₀ x
with the tangents K of the state and K₀ of the unloaded body: 1 without a load, zero where the state
loses its stability. It has no unit and does not depend on the number of voxels where the strain is
uniform: the cube has θ = 1/λ² - T/(2 μ λ) in closed form, as a change of shape has the stiffness
2 μ/λ² - T/λ and had 2 μ. Tangents are differences of forces, of all vertices two voxels apart at
once.

FElupe (``pip install felupe``; without it the layer is left alone) solves a quarter of the layer
with three-field hexahedra (Q1P0), one more refinement at a time until the energy changes by less
than 1 %. Its rows with as many elements as voxels are beside ours. `--fine` adds ν = 0.4999 and
four voxels over the height, some minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.optimize import brentq
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import LinearOperator, eigsh, splu

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

Floats = NDArray[np.float64]

SHEAR = 20 * kPa
#: Poisson's ratios of the cube, and parts of the limit of its traction.
RATIOS, PARTS = (0.3, 0.45, 0.499, 0.4999), (0.5, 0.8, 0.99, 1.01)
EDGE = 10 * mm
#: The layer, and parts of its height by which it is drawn.
SIDE, HEIGHT = 32 * mm, 4 * mm
PULLS = (0.025, 0.05, 0.1, 0.2)
#: Refinement ends where the energy of all pulls changes by less.
CHANGE = 0.01
#: Step of the differences, in voxels: their error is of the order of its square and of the rounding
#: of forces over it.
DIFFERENCE = 1e-5
#: Below all eigenvalues, from which they are sought.
SHIFT = -0.5


@dataclass(frozen=True)
class State:
    """An equilibrium: iterations, elastic energy in J, least eigenvalue, and the solver's word."""

    iterations: int
    energy: float
    least: float
    stable: bool


def rubber(poisson: float) -> vs.NeoHookean:
    """Rubber of one shear modulus."""
    return vs.NeoHookean(young=2 * SHEAR * (1 + poisson), poisson=poisson, density=1070)


def bulk(poisson: float) -> float:
    """Bulk modulus in Pa."""
    return 2 * SHEAR * (1 + poisson) / (3 * (1 - 2 * poisson))


def traction(stretch: float, poisson: float) -> float:
    """Dead traction in Pa of a cube with a stretch along all axes."""
    return bulk(poisson) * (stretch**3 - 1) * stretch**2


def stretch_under(value: float, poisson: float) -> float:
    """Stretch of a cube under a dead traction in Pa."""
    return float(brentq(lambda stretch: traction(stretch, poisson) - value, 1, 3))


def limit(poisson: float) -> float:
    """Traction in Pa at which a cube loses its stability."""
    stretch = brentq(lambda s: traction(s, poisson) * s - 2 * SHEAR, 1, 2)
    return traction(float(stretch), poisson)


def cube(poisson: float, value: float, voxels: int) -> vs.Design:
    """An eighth of a cube under a traction in Pa, with so many voxels along an edge."""
    pulled = [
        vs.Traction(
            region=vs.Region(**{axis: (EDGE, EDGE)}),
            value=tuple(value if own == axis else 0.0 for own in "xyz"),
        )
        for axis in "xyz"
    ]
    return vs.Design(
        name="cube",
        voxel_size=EDGE / voxels,
        parts=[vs.Part(shape=vs.Box(size=(EDGE,) * 3), material=rubber(poisson))],
        clamps=[vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in "xyz"],
        loads=pulled,
        solver={"error": "off"},
    )


def layer(poisson: float, pull: float, voxels: int) -> vs.Design:
    """The layer drawn by a part of its height, with so many voxels over it."""
    box = vs.Box(size=(SIDE, SIDE, HEIGHT))
    motion = vs.Motion(displacement=(0, 0, pull * HEIGHT))
    return vs.Design(
        name="layer",
        voxel_size=HEIGHT / voxels,
        parts=[vs.Part(shape=box, material=rubber(poisson))],
        clamps=[
            vs.Clamp(region=vs.Region(z=(0, 0))),
            vs.Clamp(region=vs.Region(z=(HEIGHT, HEIGHT)), motion=motion),
        ],
        solver={"error": "off"},
    )


def tangent(setup: Setup, positions: Floats, free: NDArray[np.bool_]) -> csc_matrix:
    """Stiffness in N/m of free coordinates, from differences of the elastic forces.

    Forces at a vertex depend on the vertices of its voxels alone, so that of any three vertices in
    a row one can move at a time.
    """
    rest, size = setup.mesh.vertices, setup.design.voxel_size
    place = np.rint((rest - rest.min(axis=0)) / size).astype(int)
    extent = place.max(axis=0) + 3
    number = np.full(tuple(extent), -1)
    number[tuple(place.T)] = np.arange(len(place))
    step = DIFFERENCE * size
    rows, columns, values = [], [], []
    for color in product(range(3), repeat=3):
        moved = np.flatnonzero((place % 3 == color).all(axis=1))
        # The moved vertex beside each vertex, -1 where there is none.
        beside = np.full(len(place), -1)
        for way in product((-1, 0, 1), repeat=3):
            near = place[moved] + way
            inside = (near >= 0).all(axis=1)
            found = number[tuple(near[inside].T)]
            beside[found[found >= 0]] = moved[inside][found >= 0]
        near = np.flatnonzero(beside >= 0)
        for axis in range(3):
            ends = []
            for sign in (1.0, -1.0):
                trial = positions.copy()
                trial[moved, axis] += sign * step
                ends.append(setup.problem.elastic(trial)[1])
            slope = (ends[1] - ends[0]) / (2 * step)
            for along in range(3):
                rows.append(3 * near + along)
                columns.append(3 * beside[near] + axis)
                values.append(slope[near, along])
    shape = (positions.size, positions.size)
    pairs = np.concatenate(rows), np.concatenate(columns)
    matrix = csc_matrix((np.concatenate(values), pairs), shape=shape)
    kept = np.flatnonzero(free.ravel())
    matrix = matrix[kept][:, kept]
    return csc_matrix((matrix + matrix.T) / 2)


def least_eigenvalue(loaded: csc_matrix, unloaded: csc_matrix) -> float:
    """Least θ of K x = θ K₀ x that is above twice the shift."""
    if loaded.shape[0] < 100:
        values = np.linalg.eigvals(np.linalg.solve(unloaded.toarray(), loaded.toarray()))
        return float(values.real.min())
    factors = splu(
        csc_matrix(loaded - SHIFT * unloaded),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    inverse = LinearOperator(loaded.shape, matvec=factors.solve, dtype=float)
    (value,) = eigsh(
        loaded, 1, unloaded, sigma=SHIFT, OPinv=inverse, tol=1e-5, return_eigenvectors=False
    )
    return float(value)


def ours(design: vs.Design) -> State:
    """The equilibrium of a design, whose clamps hold whole faces."""
    setup = Setup.of(design)
    result = vs.simulate(setup)
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {design.name}, {result.message}")
    free = np.ones(setup.mesh.vertices.shape, dtype=bool)
    for clamp, held in zip(design.clamps, setup.clamped, strict=True):
        for axis in clamp.axes:
            free[held, "xyz".index(axis)] = False
    rest = np.array(setup.mesh.vertices)
    least = least_eigenvalue(tangent(setup, result.positions, free), tangent(setup, rest, free))
    return State(result.steps, result.elastic_energy, least, bool(result.stable))


def felupe_layer(poisson: float, across: int, over: int) -> dict[float, State]:
    """A quarter of the layer by FElupe under all pulls, of three-field hexahedra."""
    import felupe as fe

    half = SIDE / 2
    mesh = fe.Cube(b=(half, half, HEIGHT), n=(across + 1, across + 1, over + 1))
    region = fe.RegionHexahedron(mesh)
    field = fe.FieldContainer([fe.Field(region, dim=3)])
    solid = fe.SolidBodyNearlyIncompressible(fe.NeoHooke(mu=SHEAR), field, bulk=bulk(poisson))
    ends = mesh.points
    at_z = [np.isclose(ends[:, 2], z) for z in (0.0, HEIGHT)]
    held = [
        fe.Boundary(field[0], fx=half, skip=(0, 1, 1)),
        fe.Boundary(field[0], fy=half, skip=(1, 0, 1)),
        fe.Boundary(field[0], mask=at_z[0]),
        fe.Boundary(field[0], mask=at_z[1], skip=(0, 0, 1)),
    ]
    boundaries: dict[str, Any] = {f"held {number}": each for number, each in enumerate(held)}
    boundaries["moved"] = fe.Boundary(field[0], mask=at_z[1], skip=(1, 1, 0))
    dof0, dof1 = fe.dof.partition(field, boundaries)
    unloaded = solid.assemble.matrix().tocsr()[dof1][:, dof1]
    found = {}
    for pull in PULLS:
        boundaries["moved"].value = pull * HEIGHT
        ext0 = fe.dof.apply(field, boundaries, dof0)
        result = fe.newtonraphson(
            items=[solid], dof0=dof0, dof1=dof1, ext0=ext0, tol=1e-8, maxiter=60, verbose=0
        )
        gradient = field.extract()[0]
        volume = np.linalg.det(gradient.transpose(2, 3, 0, 1))
        first = (gradient**2).sum(axis=(0, 1))
        shape = SHEAR / 2 * (volume ** (-2 / 3) * first - 3)
        swelling = (volume * region.dV).sum(0) / region.dV.sum(0)
        energy = (shape * region.dV).sum()
        energy += bulk(poisson) / 2 * ((swelling - 1) ** 2 * region.dV.sum(0)).sum()
        matrix = solid.assemble.matrix().tocsr()[dof1][:, dof1]
        least = least_eigenvalue(csc_matrix(matrix), csc_matrix(unloaded))
        found[pull] = State(result.iterations, 4 * float(energy), least, least > 0)
    return found


def refined(poisson: float) -> tuple[int, dict[float, State]]:
    """FElupe's layer, refined over its height until its energies change by less than 1 %."""
    before: dict[float, State] = {}
    over = 4
    while True:
        now = felupe_layer(poisson, 16, over)
        changes = [abs(now[p].energy / before[p].energy - 1) for p in before]
        if changes and max(changes) < CHANGE:
            return over, now
        before, over = now, over + 4


@dataclass(frozen=True)
class Row:
    """A row of a table: its name, its state, and what its energy and eigenvalue are held to."""

    name: str
    state: State
    energy: float | None = None
    least: float | None = None


def cubes() -> Iterator[Row]:
    """The cube at all ratios and tractions, beside the closed form."""
    for poisson, part in product(RATIOS, PARTS):
        value = part * limit(poisson)
        stretch = stretch_under(value, poisson)
        energy = bulk(poisson) / 2 * (stretch**3 - 1) ** 2 * EDGE**3
        least = 1 / stretch**2 - value / (2 * SHEAR * stretch)
        state = ours(cube(poisson, value, 2))
        yield Row(f"nu {poisson:g}, {part:g} of the limit", state, energy, least)


def layers(poisson: float, counts: tuple[int, ...]) -> Iterator[Row]:
    """The layer under all pulls, ours and FElupe's, beside the refined one."""
    truth: dict[float, State] = {}
    if find_spec("felupe"):
        over, truth = refined(poisson)
        for pull, state in truth.items():
            yield Row(f"nu {poisson:g}, {100 * pull:g} %: FElupe, 16 x 16 x {over}", state)
    for count in counts:
        theirs = felupe_layer(poisson, 4 * count, count) if truth else {}
        for pull in PULLS:
            named = f"nu {poisson:g}, {100 * pull:g} %: "
            energy = truth[pull].energy if truth else None
            least = truth[pull].least if truth else None
            state = ours(layer(poisson, pull, count))
            yield Row(f"{named}{count} voxels over the height", state, energy, least)
            if theirs:
                yield Row(f"{named}{count} hexahedra of FElupe", theirs[pull], energy, least)


def show(title: str, rows: Iterator[Row], report: Report, say: Callable[[str], None]) -> None:
    """Print a table as it is solved, and add its rows to the report."""
    table = Table(title=title, title_justify="left")
    for column in ("", "iterations", "energy J", "off", "least eigenvalue", "expected", "stable"):
        table.add_column(column, justify="left" if not column else "right")
    for row in rows:
        state, off = row.state, ""
        say(f"{row.name}: {state}")
        if row.energy is not None:
            off = f"{100 * (state.energy / row.energy - 1):+.2g} %"
        expected = "" if row.least is None else f"{row.least:.4f}"
        cells = (str(state.iterations), f"{state.energy:.5g}", off, f"{state.least:.4f}", expected)
        table.add_row(row.name, *cells, "yes" if state.stable else "no")
        report.rows += [
            {"name": f"{row.name}, {name}", "value": value, "unit": unit, "ratio": ratio}
            for name, value, unit, ratio in (
                ("iterations", state.iterations, "", None),
                ("energy", state.energy, "J", row.energy and state.energy / row.energy),
                ("least eigenvalue", state.least, "", row.least and state.least / row.least),
            )
        ]
    if not report.options["json"]:
        Console(width=120).print(table)


def main() -> None:
    """Solve, show and report."""
    report = Report(
        "Rubber under tension from all sides",
        fine="also nu = 0.4999 and four voxels over the height of the layer",
    )
    fine = report.options["fine"]

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    show("A cube under equal dead tractions", cubes(), report, say)
    if not find_spec("felupe"):
        say("FElupe is not installed: pip install felupe")
    for poisson in (0.499, 0.4999)[: 1 + fine]:
        rows = layers(poisson, (2, 4) if fine else (2,))
        show(f"A layer of 32 x 32 x 4 mm between plates, nu = {poisson:g}", rows, report, say)
    if report.options["json"]:
        report.show()


if __name__ == "__main__":
    main()
