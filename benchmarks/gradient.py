"""A shape optimization by gradients beside CMA-ES: evaluations and seconds to the same optimum.

``python benchmarks/gradient.py [--json]``. The stiffest arm whose outline has a given area: 64 mm
of rubber, made of two cones whose cut voxels carry the part of them that is filled, stands on a
plate and is pulled aside at its top. Radii of the middle and the tip are searched, and what they
leave of the outline is the root's; the answer lies inside the ranges. Both searches know the same
ranges and solve by statics, one trial at a time; CMA-ES from three seeds, gradients once, for they
start in the middle whatever the seed is. Ratios are those to CMA-ES. Nothing else bounds the arm,
since CMA-ES knows no constraints.
"""

from __future__ import annotations

import statistics
import tempfile
from concurrent.futures import ThreadPoolExecutor

from measure import Report

import voxsoft as vs
from voxsoft.study import StudyResult
from voxsoft.units import mm

SPACE = {"middle": ("6 mm", "10 mm"), "tip": ("3 mm", "8 mm")}
OBJECTIVES = {"bend": {"minimize": "displacement", "probe": "tip", "axis": "x"}}
BUDGETS = {"gradient": 12, "cma-es": 60}
SEEDS = {"gradient": (0,), "cma-es": (0, 1, 2)}
#: Within this part of the least bend that any search found a trial counts as there. Where the
#: surface takes a voxel in or lets one go, the bend steps by 1 %, which no slope knows.
NEAR = 0.02
#: An optimum nearer to an end of a range than this part of it would lie in a corner.
MARGIN = 0.02


def design() -> vs.Design:
    """The arm of one neo-Hookean rubber, and a pull of 10 mN."""
    half, top = 32 * mm, 64 * mm
    lower = {
        "kind": "cone",
        "radius": "= outline - 2*middle - tip",
        "top_radius": "= middle",
        "height": half,
    }
    upper = {"kind": "cone", "radius": "= middle", "top_radius": "= tip", "height": half}
    return vs.Design(
        name="arm",
        voxel_size=4 * mm,
        fill="fraction",
        parameters={"outline": "31 mm", "middle": "8 mm", "tip": "6 mm"},
        shapes={
            "lower": lower,
            "upper": upper | {"base": (0, 0, half)},
            "body": {"kind": "union", "of": ["lower", "upper"]},
        },
        parts=[{"shape": "body", "material": vs.NeoHookean(young="60 kPa", poisson=0.49)}],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Force(region=vs.Region(z=(top, top)), value=("10 mN", 0, 0))],
        probes={"tip": vs.Probe(point=(0, 0, top))},
        solver={"method": "statics"},
    )


def search(sampler: str, seed: int) -> StudyResult:
    """Run one search from nothing."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as thread:
        study = vs.Study(design(), SPACE, OBJECTIVES, folder=folder, seed=seed)
        return study.optimize(sampler, BUDGETS[sampler], batch=1, executor=thread)


def arrival(result: StudyResult, good: float) -> tuple[int, float] | None:
    """Trials and seconds until a trial was as good, or None."""
    seconds = 0.0
    for count, trial in enumerate(result.trials, start=1):
        seconds += trial.seconds
        if trial.feasible and trial.objectives["bend"] <= good:
            return count, seconds
    return None


def main() -> None:
    """Search with both, and count."""
    report = Report("A shape optimized along gradients and by CMA-ES")
    results = {name: [search(name, seed) for seed in SEEDS[name]] for name in BUDGETS}
    winner = min(
        (result.best for runs in results.values() for result in runs),
        key=lambda trial: trial.objectives["bend"],
    )
    best = winner.objectives["bend"]
    for name, value in winner.parameters.items():
        low, high = (float(each.removesuffix(" mm")) * mm for each in SPACE[name])
        if not MARGIN < (value - low) / (high - low) < 1 - MARGIN:
            raise SystemExit(f"wrong answer: the {name} of {value / mm:.2f} mm ends its range")
        report.add(f"best {name}", value / mm, "mm")
    report.add("least bend", best / mm, "mm")
    medians: dict[str, tuple[float, float]] = {}
    for name, runs in results.items():
        bends = [result.best.objectives["bend"] for result in runs]
        report.add(f"{name}: largest bend of a search", max(bends) / mm, "mm", max(bends) / best)
        found = [each for run in runs if (each := arrival(run, (1 + NEAR) * best))]
        report.add(f"{name}: searches that come within 2 %", len(found), f"of {len(runs)}")
        if len(found) < len(runs) and name == "gradient":
            raise SystemExit(f"wrong answer: gradients stopped at {bends} m")
        if found:
            medians[name] = (
                statistics.median(count for count, _ in found),
                statistics.median(seconds for _, seconds in found),
            )
    for name, (count, seconds) in medians.items():
        trials, time = medians.get("cma-es", (count, seconds))
        report.add(f"{name}: trials to within 2 %", count, "", count / trials)
        report.add(f"{name}: seconds to within 2 %", seconds, "s", seconds / time)
    report.show()


if __name__ == "__main__":
    main()
