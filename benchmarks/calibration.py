"""The paper's calibrations, with and without candidates in the lanes of the processor.

``python benchmarks/calibration.py [--json]``. The genetic algorithm of the paper, 50 generations of
30, on its three beams, from a meshed design to the best candidate: wall clock on all cores, medians
of alternating runs. A time counts once each way gives the best candidate of the other the same
misfit, and both bests lie in the few percent within which this search stops at random. A ratio is
that to one candidate after the other, which is relaxation.
"""

from __future__ import annotations

import statistics
import time
from pathlib import Path

import numpy as np
from measure import Report

import voxsoft as vs
from voxsoft.calibration import Calibration, Experiment, Measurement
from voxsoft.calibration.misfit import Misfit
from voxsoft.calibration.space import Space
from voxsoft.design import families
from voxsoft.simulation import Setup

DATA = Path(__file__).parents[1] / "examples" / "data" / "paper_beams"
BEAMS = ("00-20", "00-30", "00-50")
SEED, REPEATS = 1, 3
#: Relaxation leaves 1e-6 of the load, which a slender beam shows as some 1e-5 of its shape.
WITHIN = 1e-4
#: A candidate that is judged 1e-5 better or worse may turn the wheel of the search once in a
#: thousand draws, after which the candidates are others.
WHEEL = 0.03
#: Candidates of one beam that are timed alone, log-uniform over the ranges that a search has.
SPREAD = 200


def experiment(name: str) -> Experiment:
    """One of the paper's beams beside its photograph."""
    beam = families.paper_beam().with_values(f"parts.0.material=ecoflex-{name}-lattice")
    return Experiment(beam, Measurement.read(DATA / f"ecoflex-{name}.csv"))


def search(tested: Experiment, lanes: bool) -> tuple[float, float, Calibration]:
    """Wall-clock and processor seconds of one search, and what it found."""
    start, busy = time.perf_counter(), time.process_time()
    found = vs.calibrate(tested, seed=SEED, refine=False, identify=False, lanes=lanes)
    return time.perf_counter() - start, time.process_time() - busy, found


def require_same(tested: Experiment, lanes: Calibration, single: Calibration) -> None:
    """Refuse searches that did not come to the same end."""
    ways = (lanes.settings["solver"], single.settings["solver"])
    if ways != ("statics in lanes", "xpbd relaxation"):
        raise SystemExit(f"{tested.name}: solved by {ways[0]} and {ways[1]}")
    space = Space.of(None, tested.material)
    for found, other in ((lanes, single), (single, lanes)):
        logs = np.log([found.parameters[name] for name in space.names]) - np.log(space.low)
        again = Misfit([tested], space, lanes=found is single).at(logs / space.spans()).error
        off = abs(again / found.mean_error - 1.0)
        apart = abs(other.mean_error / found.mean_error - 1.0)
        if not (off < WITHIN and apart < WHEEL):
            raise SystemExit(f"wrong answer: misfits of {tested.name} {off:.1e}, {apart:.1e} apart")


def measure_searches(report: Report) -> None:
    """Alternate both ways on each beam."""
    totals = {True: 0.0, False: 0.0}
    for name in BEAMS:
        tested = experiment(name)
        _ = tested.setup, tested.places
        wall: dict[bool, list[float]] = {True: [], False: []}
        work: dict[bool, list[float]] = {True: [], False: []}
        found = {}
        for _ in range(REPEATS):
            for lanes in (True, False):
                seconds, busy, found[lanes] = search(tested, lanes)
                wall[lanes].append(seconds)
                work[lanes].append(busy)
            require_same(tested, found[True], found[False])
        medians = {lanes: statistics.median(times) for lanes, times in wall.items()}
        for lanes, label in ((True, "in lanes"), (False, "one by one")):
            totals[lanes] += medians[lanes]
            ratio = medians[lanes] / medians[False]
            report.add(f"{name}: search {label}", medians[lanes], "s", ratio)
            each = 1e3 * statistics.median(work[lanes]) / found[lanes].evaluations
            report.add(f"{name}: an evaluation {label}, one core", each, "ms")
        report.add(f"{name}: best mean error", 1e3 * found[True].mean_error, "mm")
        report.add(f"{name}: candidates", found[True].evaluations, "")
        start = time.perf_counter()
        vs.calibrate(tested, seed=SEED)
        whole = time.perf_counter() - start
        report.add(f"{name}: with refinement and profiles", whole, "s")
    report.add("three searches in lanes", totals[True], "s", totals[True] / totals[False])
    report.add("three searches one by one", totals[False], "s", 1.0)


def measure_spread(report: Report) -> None:
    """A Monte Carlo of one beam: each candidate's own cost, and that lanes balance their forces."""
    setup = Setup.of(families.paper_beam())
    random = np.random.default_rng(SEED)
    edges, bulks = 10 ** random.uniform(3, 6, (2, SPREAD))
    materials = [vs.Lattice(edge=e, bulk=max(b, 2e3)) for e, b in zip(edges, bulks, strict=True)]
    start = time.process_time()
    found = vs.simulate_many(setup, materials, tolerance=1e-6)
    busy = time.process_time() - start
    held = np.zeros(len(setup.mesh.vertices), dtype=bool)
    held[np.concatenate(setup.clamped)] = True
    for material, candidate in zip(materials, found, strict=True):
        problem = setup.problem_with([material])
        left = problem.net_forces(candidate.positions)[~held]
        load = problem.net_forces(setup.mesh.vertices)
        part = float(np.linalg.norm(left) / np.linalg.norm(load))
        # The same forces, added up in another order.
        if candidate.status != "ok" or candidate.way != "lanes" or not part < 1.01e-6:
            raise SystemExit(f"wrong answer: {part:.1e} of the load is out of balance")
    report.add(f"a candidate of {SPREAD} over the whole range, one core", 1e3 * busy / SPREAD, "ms")


def main() -> None:
    """Measure both."""
    report = Report("The paper's calibrations")
    measure_spread(report)
    measure_searches(report)
    report.show()


if __name__ == "__main__":
    main()
