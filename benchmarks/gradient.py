"""A shape optimization by gradients beside CMA-ES: evaluations and seconds to the same optimum.

``python benchmarks/gradient.py [--json]``. A closed cylinder of rubber under 4 kPa, whose cut
voxels carry the part of them that is filled. Walls and caps share 13 mm: which share, and which
radius, lets the top rise least? The answer lies in a corner of the ranges. Both searches know the
same ranges and solve by statics, one trial at a time; ratios are those to CMA-ES.
"""

from __future__ import annotations

import tempfile
from concurrent.futures import ThreadPoolExecutor

from measure import Report

import voxsoft as vs
from voxsoft.design import families
from voxsoft.study import StudyResult

SPACE = {"radius": ("14 mm", "17 mm"), "wall": ("5 mm", "8.5 mm")}
OBJECTIVES = {"rise": {"minimize": "displacement", "probe": "top", "axis": "z"}}
BUDGETS = {"gradient": 15, "cma-es": 120}
#: Within this part of the better of the two optima a trial counts as there.
NEAR = 0.1


def design() -> vs.Design:
    """The family, of one neo-Hookean rubber."""
    return families.cylinder(radius="15 mm", height="20 mm").with_values(
        'parts.0.material={model="neo-hookean", young="60 kPa", poisson=0.49}',
        'parameters.total="13 mm"',
        "cap== total - wall",
        "fill=fraction",
        "solver.method=statics",
    )


def search(sampler: str) -> StudyResult:
    """Run one search from nothing."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as thread:
        study = vs.Study(design(), SPACE, OBJECTIVES, folder=folder)
        return study.optimize(sampler, BUDGETS[sampler], batch=1, executor=thread)


def main() -> None:
    """Search with both, and count."""
    report = Report("A shape optimized along gradients and by CMA-ES")
    results = {sampler: search(sampler) for sampler in BUDGETS}
    best = min(result.best.objectives["rise"] for result in results.values())
    counts: dict[str, tuple[int, float]] = {}
    for sampler, result in results.items():
        if result.best.objectives["rise"] > (1.0 + NEAR) * best:
            raise SystemExit(f"wrong answer: {sampler} stopped at {result.best.objectives}")
        seconds = 0.0
        report.add(f"{sampler}: least rise", 1e3 * result.best.objectives["rise"], "mm")
        for count, trial in enumerate(result.trials, start=1):
            seconds += trial.seconds
            if trial.feasible and trial.objectives["rise"] <= (1.0 + NEAR) * best:
                counts[sampler] = count, seconds
                break
    for sampler, (count, seconds) in counts.items():
        trials, time = counts.get("cma-es", (count, seconds))
        report.add(f"{sampler}: trials to within 10 %", count, "", count / trials)
        report.add(f"{sampler}: seconds to within 10 %", seconds, "s", seconds / time)
    report.show()


if __name__ == "__main__":
    main()
