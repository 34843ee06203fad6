"""Linear solutions of solid and thin-walled bodies, beside other solvers of the same matrix.

``python benchmarks/thin_walls.py [--json] [--rounds 3] [--small]``. The tangent at rest of a cube,
a row of chambers (`PneuNet`, 52,920 voxels), a round tube of cut voxels, and of the chambers with
nu = 0.499, under their weight across; on one core, in processor time. Each solver gets the same
matrix and stops at the same error, 1e-5 in energy against a solution of 1e-10, whatever its own
measure: its iterations are found first, then setup and iterations are timed, the solvers in turns,
medians. The pattern of the matrix and what depends on it alone (ours: levels and colors, found
once for all iterations of Newton's method) are reported on their own.

- VoxSoft: conjugate gradients with geometric multigrid.
- pyamg: conjugate gradients with smoothed aggregation, six rigid modes, block Gauss-Seidel.
- petsc4py: conjugate gradients with GAMG, six rigid modes.
- pypardiso: a Cholesky factor by MKL's Pardiso, exact; one round.

Codes that are not installed are named and left out (``pip install pyamg pypardiso``).
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when libraries start their threads.
os.environ["RAYON_NUM_THREADS"] = "1"
os.environ["OMP_NUM_THREADS"] = "1"
os.environ["MKL_NUM_THREADS"] = "1"
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
import scipy.sparse as sparse
from measure import Report

import voxsoft as vs
from voxsoft import _core
from voxsoft.design import families
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

#: Error in energy, relative to that of the solution, and of the solution that it is measured by.
ERROR = 1e-5
TIGHT = 1e-10
#: Weight in units of g, along no axis: thin walls bend.
WEIGHT = np.array([0.3, 1.0, -0.7])
GRAVITY = 9.81
#: Connections that count in aggregates: with 0.05 the chambers take 61 iterations, with 0 102.
STRENGTH = 0.05
PEERS = ("pyamg", "petsc4py", "pypardiso")


def rubber(poisson: float) -> vs.NeoHookean:
    """The one material."""
    return vs.NeoHookean(young=60 * kPa, poisson=poisson, density=1070.0)


def block(shape: vs.Shape, voxel: float) -> vs.Design:
    """A shape that stands on its foot."""
    part = vs.Part(shape=shape, material=rubber(0.49))
    foot = vs.Clamp(region=vs.Region(z=(0, 0)))
    return vs.Design(name="body", voxel_size=voxel, parts=[part], clamps=[foot])


def chambers(poisson: float, count: int) -> vs.Design:
    """The row of chambers of `examples/pneunet.toml`, its walls three voxels thick."""
    design = families.pneunet(chambers=count)
    parts = tuple(part.replace(material=rubber(poisson)) for part in design.parts)
    return design.replace(voxel_size=2.5 * mm / 3, parts=parts, loads=())


def bodies(small: bool) -> dict[str, vs.Design]:
    """The bodies, or small ones to try the script."""
    across, count, height = (10, 2, 10 * mm) if small else (22, 7, 100 * mm)
    cube = vs.Box(size=(40 * mm, 40 * mm, 40 * mm))
    tube = vs.Cylinder(radius=18 * mm, height=height) - vs.Cylinder(radius=16 * mm, height=height)
    return {
        "cube": block(cube, 40 * mm / across),
        "chambers": chambers(0.49, count),
        "tube of cut voxels": block(tube, 1 * mm),
        "chambers, nu = 0.499": chambers(0.499, count),
    }


@dataclass
class System:
    """A tangent, its pattern found in `seconds`, with a tight solution on free coordinates."""

    stiffness: _core.Stiffness
    seconds: float
    matrix: sparse.bsr_array
    free: np.ndarray
    points: np.ndarray
    forces: np.ndarray
    solution: np.ndarray

    @classmethod
    def of(cls, design: vs.Design) -> System:
        """Assemble at rest."""
        setup = Setup.of(design)
        points = np.asarray(setup.mesh.vertices)
        start = time.process_time()
        stiffness = _core.Stiffness(setup.problem, points)
        seconds = time.process_time() - start
        starts, vertices, blocks = stiffness.block_rows()
        whole = sparse.bsr_array((blocks, vertices.astype(np.int32), starts.astype(np.int32)))
        free = whole.diagonal().reshape(-1, 3).all(axis=1)
        rows = np.repeat(free, 3)
        matrix = sparse.bsr_array(whole.tocsr()[rows][:, rows].tobsr((3, 3)))
        forces = setup.problem.masses[:, None] * GRAVITY * WEIGHT * free[:, None]
        solution, _ = stiffness.solve(forces, TIGHT)
        return cls(
            stiffness, seconds, matrix, free, points[free], forces[free].ravel(), solution[free]
        )

    def error(self, found: np.ndarray) -> float:
        """Error in energy, relative."""
        off = found.ravel() - self.solution.ravel()
        energy = self.forces @ self.solution.ravel()
        return float(np.sqrt(max(off @ (self.matrix @ off), 0.0) / energy))

    def rigid(self) -> np.ndarray:
        """The six rigid motions, (3 n, 6)."""
        modes = np.zeros((len(self.points), 3, 6))
        modes[:, range(3), range(3)] = 1.0
        arms = self.points - self.points.mean(axis=0)
        for axis in range(3):
            modes[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arms)
        return modes.reshape(-1, 6)


#: A solver set up for a system: its solution after a number of iterations, timed as a whole.
Task = Callable[[], np.ndarray]


def iterations_needed(system: System, solver: Callable) -> int:
    """Iterations of conjugate gradients to the error, of a preconditioner that `solver` makes."""
    count = 0

    def look(now: np.ndarray) -> None:
        nonlocal count
        count += 1
        if system.error(now) <= ERROR:
            raise StopIteration

    preconditioner = solver()
    try:
        sparse.linalg.cg(
            system.matrix, system.forces, rtol=0.0, maxiter=1000, M=preconditioner, callback=look
        )
    except StopIteration:
        return count
    raise SystemExit("wrong answer: conjugate gradients do not arrive")


def gradients(system: System, solver: Callable) -> tuple[int, Task]:
    """Iterations needed, and the task of setup and that many iterations."""
    count = iterations_needed(system, solver)

    def task() -> np.ndarray:
        return sparse.linalg.cg(system.matrix, system.forces, rtol=0.0, maxiter=count, M=solver())[
            0
        ]

    return count, task


def voxsoft(system: System) -> tuple[int, Task]:
    """Our own: the loosest tolerance of its own measure that arrives."""
    forces = np.zeros((len(system.free), 3))
    forces[system.free] = system.forces.reshape(-1, 3)
    tolerance = ERROR
    while system.error(system.stiffness.solve(forces, tolerance)[0][system.free]) > ERROR:
        tolerance *= 0.8

    def task() -> np.ndarray:
        system.stiffness.precondition()
        return system.stiffness.solve(forces, tolerance)[0][system.free]

    return system.stiffness.solve(forces, tolerance)[1], task


def pyamg(system: System) -> tuple[int, Task]:
    """Smoothed aggregation."""
    from pyamg import smoothed_aggregation_solver

    matrix = sparse.bsr_matrix(system.matrix)
    modes = system.rigid()

    def solver() -> sparse.linalg.LinearOperator:
        levels = smoothed_aggregation_solver(
            matrix,
            B=modes,
            strength=("symmetric", {"theta": STRENGTH}),
            presmoother=("block_gauss_seidel", {"sweep": "forward"}),
            postsmoother=("block_gauss_seidel", {"sweep": "backward"}),
            improve_candidates=None,
        )
        return levels.aspreconditioner(cycle="V")

    return gradients(system, solver)


def petsc4py(system: System) -> tuple[int, Task]:
    """PETSc's smoothed aggregation."""
    from petsc4py import PETSc

    starts, columns, blocks = (
        system.matrix.indptr,
        system.matrix.indices,
        system.matrix.data.ravel(),
    )
    size = system.matrix.shape

    def solver() -> sparse.linalg.LinearOperator:
        matrix = PETSc.Mat().createBAIJ(size, 3, csr=(starts, columns, blocks))
        vectors = [PETSc.Vec().createWithArray(mode) for mode in np.linalg.qr(system.rigid())[0].T]
        matrix.setNearNullSpace(PETSc.NullSpace().create(vectors=vectors))
        own = PETSc.PC().create()
        own.setOperators(matrix)
        own.setType("gamg")
        own.setUp()
        right, left = matrix.createVecs()

        def apply(side: np.ndarray) -> np.ndarray:
            right.setArray(side)
            own.apply(right, left)
            return left.getArray().copy()

        return sparse.linalg.LinearOperator(size, matvec=apply, dtype=float)

    return gradients(system, solver)


def pypardiso(system: System) -> tuple[int, Task]:
    """A factor of the upper triangle."""
    from pypardiso import PyPardisoSolver

    upper = sparse.csr_matrix(sparse.triu(system.matrix, format="csr"))

    def task() -> np.ndarray:
        solver = PyPardisoSolver(mtype=2)
        found = solver.solve(solver.factorize(upper) or upper, system.forces)
        solver.free_memory(everything=True)
        return found

    return 0, task


def main() -> None:
    """Measure everything."""
    report = Report(
        "Linear solutions to 1e-5 in energy",
        values={"rounds": (3, "rounds of which the medians are reported")},
        small="small bodies, to try the script",
    )
    warnings.filterwarnings("ignore", category=sparse.SparseEfficiencyWarning)
    solvers: dict[str, Callable[[System], tuple[int, Task]]] = {"VoxSoft": voxsoft}
    own = {"pyamg": pyamg, "petsc4py": petsc4py, "pypardiso": pypardiso}
    for peer in PEERS:
        if find_spec(peer) is None:
            print(f"left out: {peer} is not installed", file=sys.stderr)
        else:
            solvers[peer] = own[peer]
    for body, design in bodies(report.options["small"]).items():
        system = System.of(design)
        report.add(f"{body}: unknowns", float(system.matrix.shape[0]), "")
        report.add(f"{body}: pattern and assembly, once", system.seconds, "s")
        tasks = {code: make(system) for code, make in solvers.items()}
        times: dict[str, list[float]] = {code: [] for code in tasks}
        for round_ in range(report.options["rounds"]):
            for code, (_, task) in tasks.items():
                if code == "pypardiso" and round_ > 0:
                    continue
                start = time.process_time()
                found = task()
                times[code].append(time.process_time() - start)
                if not system.error(found) <= 1.01 * ERROR:
                    raise SystemExit(f"wrong answer: {code}, {body}")
        first = statistics.median(times["VoxSoft"])
        for code, (count, _) in tasks.items():
            if count:
                report.add(f"{body}: {code}, iterations", float(count), "")
            seconds = statistics.median(times[code])
            report.add(f"{body}: {code}", seconds, "s", seconds / first)
    report.show()


if __name__ == "__main__":
    main()
