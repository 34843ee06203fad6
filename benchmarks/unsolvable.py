"""Whether samplers learn to stay out of the larger part of a space that cannot be solved.

Walls of 10 to 20 mm and radii of 21 to 40 mm, of which walls above 12 mm count as diverged: one
in five of the designs can be solved. The evaluation is a formula, so that the search alone is
measured. For each sampler the share of solved designs among the first and the last 50 of 200
trials, as the mean over seeds.

    python benchmarks/unsolvable.py            # a table
    python benchmarks/unsolvable.py --json     # the rows as data
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import tempfile
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from typing import Any, Final

from voxsoft.design import Design, families
from voxsoft.study import Outcome, Study

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
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="print rows as data")
    parser.add_argument("samplers", nargs="*", help="default: all")
    given = parser.parse_args()
    there = [name for name in OBJECTIVES if name != "gp" or find_spec("torch")]
    rows = []
    for sampler in given.samplers or there:
        found = [shares(sampler, seed) for seed in SEEDS]
        first, last = (sum(each) / len(SEEDS) for each in zip(*found, strict=True))
        rows.append(
            {
                "name": sampler,
                "value": last,
                "unit": "1",
                "ratio": last / first,
                "first": [each[0] for each in found],
                "last": [each[1] for each in found],
            }
        )
        if not given.json:
            print(f"| `{sampler}` | {first:.2f} | {last:.2f} |", flush=True)
    if given.json:
        machine = {"cpu": platform.processor() or platform.machine(), "cores": os.cpu_count()}
        print(json.dumps({"machine": machine, "rows": rows}))


if __name__ == "__main__":
    main()
