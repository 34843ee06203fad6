"""Learning of samplers in a space whose larger part cannot be solved.

Walls of 10 to 20 mm and radii of 21 to 40 mm, of which walls above 12 mm count as diverged: one
in five of the designs can be solved. The evaluation is a formula, so that the search alone is
measured. For each sampler the share of solved designs among the first and the last 50 of 200
trials, as the mean over seeds.

``python evidence/unsolvable.py [--json]``
"""

from __future__ import annotations

import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from voxsoft.design import Design, families
from voxsoft.study import Outcome, Study

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

SPACE: Final = {"wall": ("10 mm", "20 mm", "0.1 mm"), "radius": ("21 mm", "40 mm", "0.1 mm")}
TRIALS: Final = 200
WINDOW: Final = 50
SEEDS: Final = (0, 1, 2)
#: Samplers by name, with the number of objectives that each searches here.
OBJECTIVES: Final = {
    "random": 1,
    "tpe": 1,
    "cma-es": 1,
    "gp": 1,
    "nsga-ii": 1,
    "nsga-iii": 3,
    "genetic": 1,
}


def evaluate(design: Design) -> Outcome:
    """Give a design its numbers by a formula, or call it diverged."""
    wall, radius = (design.parameters[name].value for name in ("wall", "radius"))
    if wall > 0.012 + 1e-9:
        return Outcome("diverged", "the wall is above 12 mm")
    return Outcome("ok", metrics={"a": radius, "b": wall, "c": radius - wall})


def shares(sampler: str, seed: int, trials: int = TRIALS) -> tuple[float, float]:
    """Share of solved designs among the first and the last trials of a search."""
    names = ("a", "b", "c")[: OBJECTIVES[sampler]]
    objectives: dict[str, Any] = {name: {"minimize": "mass"} for name in names}
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(1) as thread:
        study = Study(
            families.cylinder(), SPACE, objectives, evaluate=evaluate, seed=seed, folder=folder
        )
        found = study.optimize(sampler, budget=trials, executor=thread).trials
    solved = [trial.status == "ok" for trial in found]
    return sum(solved[:WINDOW]) / WINDOW, sum(solved[-WINDOW:]) / WINDOW


def main() -> None:
    """Measure every sampler that is installed."""
    report = Report("share of solved designs where four fifths cannot be solved")
    for sampler in [name for name in OBJECTIVES if name != "gp" or find_spec("torch")]:
        found = [shares(sampler, seed) for seed in SEEDS]
        first, last = (sum(each) / len(SEEDS) for each in zip(*found, strict=True))
        report.add(f"{sampler}, first {WINDOW}", first, "")
        report.add(f"{sampler}, last {WINDOW}", last, "", last / first)
    report.show()


if __name__ == "__main__":
    main()
