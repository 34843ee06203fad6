"""Time to rest: each solver on the same bodies, and how far the choice left open is from the best.

``python benchmarks/time_to_rest.py [--json]``. Processor time on one core, from a meshed design to
the state at rest, medians of alternating runs. A time counts once the tip is within 0.1 % of a
tightly converged equilibrium. A ratio is that to the quickest single solver on the same body.
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when the core starts its threads.
os.environ["RAYON_NUM_THREADS"] = "1"

import statistics
import time
from typing import Any

import numpy as np
from bodies import MATERIALS, beam, block, cylinder, require_rest, tip
from measure import Report

import voxsoft as vs
from voxsoft.simulation import Setup

#: Largest error of the tip, of its displacement.
WITHIN = 1e-3
#: Tolerance asked of the state that is taken for true, and what its forces must meet: rounding ends
#: Newton's method near 1e-8 of the load, and a thousandth of what is checked is due.
TIGHT, BALANCED = 1e-9, 1e-6
#: Repeat each solver as often, unless all its runs together take longer than this, in s.
REPEATS, LONGEST = 7, 10.0
SOLVERS: dict[str, dict[str, Any]] = {
    "left open": {},
    "relaxation": {"method": "xpbd"},
    "dynamics": {"method": "xpbd", "time_step": 0.01},
    "statics": {"method": "statics"},
}


def run(setup: Setup, settings: dict[str, Any], expected: np.ndarray) -> float:
    """Processor seconds of one run, if its tip is right."""
    start = time.process_time()
    result = vs.simulate(setup, **settings)
    seconds = time.process_time() - start
    error = float(np.linalg.norm(tip(result) - expected) / np.linalg.norm(expected))
    if result.status != "ok" or not error < WITHIN:
        raise SystemExit(f"wrong answer of {settings}: {result.message}, tip off by {error:.2%}")
    return seconds


def measure(report: Report, name: str, design: vs.Design) -> float:
    """All solvers on one body; the ratio of the open choice to the best one."""
    setup = Setup.of(design)
    true = vs.simulate(setup, method="statics", tolerance=TIGHT)
    require_rest(setup, true, BALANCED)
    expected = tip(true)
    solvers = dict(SOLVERS)
    if any(not isinstance(material, vs.Lattice) for material in setup.materials):
        del solvers["relaxation"]  # The same steps as on a lattice, far more of them.
    times: dict[str, list[float]] = {solver: [] for solver in solvers}
    for _ in range(REPEATS):
        for solver, settings in solvers.items():
            if sum(times[solver]) < LONGEST:
                times[solver].append(run(setup, settings, expected))
    medians = {solver: statistics.median(seconds) for solver, seconds in times.items()}
    best = min(seconds for solver, seconds in medians.items() if solver != "left open")
    for solver, seconds in medians.items():
        report.add(f"{name}: {solver}", seconds * 1e3, "ms", seconds / best)
    return medians["left open"] / best


def main() -> None:
    """Measure all bodies."""
    report = Report("Time to rest on one core")
    worst = 0.0
    for family, material in MATERIALS.items():
        bodies = {
            "beam": beam(material),
            "cylinder (5,7,1)": cylinder(material),
            "block 20^3": block(material, 20),
        }
        for name, design in bodies.items():
            worst = max(worst, measure(report, f"{family} {name}", design))
    report.add("left open, over the best single solver: worst", worst, "")
    report.show()


if __name__ == "__main__":
    main()
