"""What statics costs: processor time and memory, directly and by multigrid.

``python benchmarks/statics.py [--json] [--fine]``. A cube of 40 mm and a beam of 200 x 20 x
20 mm of one rubber under their weight, in finer and finer voxels; each in a process of its own,
whose peak of memory is reported. Both ways must find the same displacement, or no time is
printed. `--fine` adds sizes that take the direct way minutes and gigabytes, and for multigrid
alone a cube of 10⁵ voxels.
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
from measure import Report, peak_bytes

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)
#: Sizes in mm, and voxels across.
Size = tuple[float, float, float]
CUBE: Size = (40.0, 40.0, 40.0)
BEAM: Size = (200.0, 20.0, 20.0)
CASES = [(CUBE, 8), (CUBE, 16), (CUBE, 24), (BEAM, 4), (BEAM, 8)]
FINE = [(BEAM, 16), (CUBE, 32)]
ITERATIVE_ONLY = [(CUBE, 46)]
#: Both ways end where Newton's method stands still, at 1e-9 of the displacement.
AGREEMENT = 1e-8


def solve(size: Size, across: int, way: str) -> tuple[int, float, int, float, float]:
    """Vertices, largest displacement (m), iterations, processor seconds, peak bytes."""
    design = vs.Design(
        name="body",
        voxel_size=size[2] * mm / across,
        parts=[vs.Part(shape=vs.Box(size=tuple(side * mm for side in size)), material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity(value=1.0)],
    )
    setup = Setup.of(design)
    problem = setup.problem
    start = time.process_time()
    report = _core.equilibrium(problem, tolerance=1e-8, linear=way)
    seconds = time.process_time() - start
    if report.status != _core.Status.AT_REST:
        raise SystemExit(f"wrong answer: {report.status}")
    moved = np.linalg.norm(report.positions - setup.mesh.vertices, axis=1).max()
    return len(setup.mesh.vertices), float(moved), report.steps, seconds, peak_bytes()


def main() -> None:
    """Measure everything."""
    report = Report("Cost of statics", fine="also sizes that take minutes and gigabytes")
    fine = report.options["fine"]
    cases = [(*case, ("direct", "iterative")) for case in CASES + (FINE if fine else [])]
    cases += [(*case, ("iterative",)) for case in ITERATIVE_ONLY if fine]
    spawn = get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawn, max_tasks_per_child=1) as pool:
        for size, across, ways in cases:
            answers = {way: pool.submit(solve, size, across, way).result() for way in ways}
            moves = [answer[1] for answer in answers.values()]
            if max(moves) - min(moves) > AGREEMENT * max(moves):
                raise SystemExit(f"wrong answer: the largest displacements are {moves}")
            shape = " × ".join(f"{side:g}" for side in size)
            for way, (vertices, _, steps, seconds, peak) in answers.items():
                name = f"{shape} mm, {across} across, {vertices} vertices, {way}"
                report.add(f"{name}: iterations", float(steps), "")
                report.add(f"{name}: one iteration", seconds / steps, "s")
                report.add(f"{name}: peak of the process", peak / 1e9, "GB")
            if len(ways) == 2:
                ratio = answers["direct"][3] / answers["iterative"][3]
                report.add(f"{shape} mm, {across} across: direct over iterative", ratio, "")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
