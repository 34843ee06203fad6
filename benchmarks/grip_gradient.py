"""A finger optimized for its grip along gradients and by CMA-ES: trials and seconds to one force.

``python benchmarks/grip_gradient.py [--json]``. A finger of three segments of rubber, clamped at
its root, is pulled aside along all of its length against a fixed post at its tip. The moduli of the
upper two segments are searched; what they leave of a given sum is the root's. The force on the post
is to be largest. Both searches know the same ranges and solve by statics, one trial at a time;
CMA-ES from three seeds, gradients once, for they start in the middle whatever the seed is. Ratios
are those to CMA-ES.
"""

from __future__ import annotations

import statistics
import tempfile
from concurrent.futures import ThreadPoolExecutor

from measure import Report

import voxsoft as vs
from voxsoft.study import StudyResult

SPACE = {"second": ("50 kPa", "350 kPa"), "third": ("20 kPa", "200 kPa")}
OBJECTIVES = {"grip": {"maximize": "contact_force", "object": "post"}}
BUDGETS = {"gradient": 10, "cma-es": 40}
SEEDS = {"gradient": (0,), "cma-es": (0, 1, 2)}
#: Within this part of the largest force that any search found a trial counts as there.
NEAR = 0.01


def design() -> vs.Design:
    """Three blocks on top of each other and a post beside the upper one."""
    young = ["= total - second - third", "= second", "= third"]
    segment = {"kind": "box", "size": ["8 mm", "8 mm", "12 mm"]}
    blocks = {
        f"segment{i}": {**segment, "corner": ["0 mm", "0 mm", f"{12 * i} mm"]} for i in range(3)
    }
    post = {
        "kind": "box",
        "size": ["8 mm", "16 mm", "8 mm"],
        "center": ["12.5 mm", "4.1 mm", "31 mm"],
    }
    return vs.Design.from_document(
        {
            "name": "finger",
            "voxel_size": "4 mm",
            "parameters": {"total": "600 kPa", "second": "200 kPa", "third": "200 kPa"},
            "shapes": {**blocks, "post": post},
            "parts": [
                {"shape": name, "material": {"model": "neo-hookean", "young": e, "poisson": 0.45}}
                for name, e in zip(blocks, young, strict=True)
            ],
            "clamps": [{"region": {"z": [0, 0]}}],
            "loads": [{"kind": "gravity", "value": "60 m/s^2", "direction": [1, 0, 0]}],
            "objects": [{"name": "post", "shape": "post"}],
            "solver": {"method": "statics"},
        }
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
        if trial.feasible and trial.objectives["grip"] >= good:
            return count, seconds
    return None


def main() -> None:
    """Search with both, and count."""
    report = Report("A finger optimized for its grip along gradients and by CMA-ES")
    results = {name: [search(name, seed) for seed in SEEDS[name]] for name in BUDGETS}
    best = max(run.best.objectives["grip"] for runs in results.values() for run in runs)
    report.add("largest force", 1e3 * best, "mN")
    medians: dict[str, tuple[float, float]] = {}
    for name, runs in results.items():
        least = min(run.best.objectives["grip"] for run in runs)
        report.add(f"{name}: least force of a search", 1e3 * least, "mN", least / best)
        found = [each for run in runs if (each := arrival(run, (1 - NEAR) * best))]
        report.add(f"{name}: searches that come within 1 %", len(found), f"of {len(runs)}")
        if len(found) < len(runs) and name == "gradient":
            raise SystemExit(f"wrong answer: gradients stopped at {least} N of {best} N")
        if found:
            medians[name] = (
                statistics.median(count for count, _ in found),
                statistics.median(seconds for _, seconds in found),
            )
    for name, (count, seconds) in medians.items():
        trials, time = medians.get("cma-es", (count, seconds))
        report.add(f"{name}: trials to within 1 %", count, "", count / trials)
        report.add(f"{name}: seconds to within 1 %", seconds, "s", seconds / time)
    report.show()


if __name__ == "__main__":
    main()
