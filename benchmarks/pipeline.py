"""The pipeline from a shape to a study: voxels, mesh, steps, trials.

``python benchmarks/pipeline.py [--json] [--fine]``. `--fine` adds a grid of 512^3, which takes
some 15 GB. Each figure counts only after its answer was checked.
Steps are measured in processor time, the rest by the wall clock; a ratio is that to a plain native
loop of the original program (14 ns a constraint). `study.py` holds the study against such a loop.
"""

from __future__ import annotations

import tempfile
import time

import numpy as np
from measure import Report, median_seconds, peak_bytes

import voxsoft as vs
from voxsoft.design import families
from voxsoft.simulation import Setup

MM = 1e-3
#: CPU seconds of a plain single-core native loop of the original for one constraint, measured on
#: the machine the project started on.
ORIGINAL_CONSTRAINT = 14e-9


def gyroid(report: Report, cells: int = 256) -> None:
    """A solid cube of gyroid, half full by symmetry."""
    size = 64 * MM
    shape = vs.Box(size=(size, size, size)) & vs.Gyroid(period=16 * MM, form="solid")
    voxel = size / cells
    voxels = vs.voxelize(shape, voxel)
    if abs(voxels.count / cells**3 - 0.5) > 0.01:
        raise SystemExit(f"wrong answer: {voxels.count / cells**3:.3f} of the cube, expected 0.5")
    seconds = median_seconds(lambda: vs.voxelize(shape, voxel), 3)
    report.add(f"gyroid {cells}^3: shape to voxels", seconds, "s")
    report.add(f"gyroid {cells}^3: cells sampled", cells**3 / seconds, "1/s")
    start = time.perf_counter()
    cavities = voxels.cavities
    report.add(f"gyroid {cells}^3: cavities", time.perf_counter() - start, "s")
    if cavities:
        raise SystemExit(f"wrong answer: {len(cavities)} cavities in an open gyroid")
    start = time.perf_counter()
    mesh = voxels.mesh()
    seconds = time.perf_counter() - start
    if len(mesh.tets) != 5 * voxels.count:
        raise SystemExit("wrong answer: there are not five tetrahedra for each voxel")
    report.add(f"gyroid {cells}^3: voxels to mesh", seconds, "s")
    report.add(f"gyroid {cells}^3: voxels meshed", voxels.count / seconds, "1/s")
    report.add(f"gyroid {cells}^3: peak memory", peak_bytes() / 1e9, "GB")


def steps(report: Report, name: str, design: vs.Design) -> None:
    """Steps of relaxation and substeps of dynamics."""
    setup = Setup.of(design)
    rest = vs.simulate(setup, method="xpbd")
    if rest.status != "ok":
        raise SystemExit(f"wrong answer: {name} is {rest.status}")
    constraints = len(setup.mesh.edges) + len(setup.mesh.tets)
    seconds = median_seconds(lambda: vs.simulate(setup, method="xpbd"), clock=time.process_time)
    report.add(f"{name}: to rest", seconds * 1e3, "ms")
    each = seconds / rest.steps / constraints
    report.add(
        f"{name}: relaxation, a constraint and step", each * 1e9, "ns", each / ORIGINAL_CONSTRAINT
    )
    run = vs.simulate(setup, end_time=0.1)
    seconds = median_seconds(lambda: vs.simulate(setup, end_time=0.1), clock=time.process_time)
    each = seconds / run.steps / constraints
    report.add(f"{name}: dynamics, substeps", run.steps / seconds, "1/s")
    report.add(
        f"{name}: dynamics, a constraint and substep", each * 1e9, "ns", each / ORIGINAL_CONSTRAINT
    )


def study(report: Report) -> None:
    """The paper's 105 designs, cold, with a process for each core."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        result = vs.Study(families.paper_cylinder(), folder=folder).grid()
        seconds = time.perf_counter() - start
    if len(result.trials) != 105 or result.counts.get("ok", 0) < 30:
        raise SystemExit(f"wrong answer: {result.counts}")
    report.add("study of 105 designs: wall clock", seconds, "s")
    solving = sum(trial.seconds for trial in result.trials)
    report.add("study of 105 designs: time in trials", solving, "s")


def main() -> None:
    """Run everything."""
    np.seterr(all="raise", under="ignore")
    report = Report("From a shape to a study", fine="also a grid of 512^3")
    gyroid(report)
    if report.options["fine"]:
        gyroid(report, 512)
    steps(report, "beam", families.paper_beam())
    steps(report, "cylinder (5,7,1)", families.paper_cylinder())
    study(report)
    report.show()


if __name__ == "__main__":
    main()
