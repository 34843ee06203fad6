"""The paper's study of 105 designs: cold, again, and what Python adds to a trial.

``python benchmarks/study.py [--json]``. Two worker processes, wall clock from the call to the table
of results. Cold is the first study of a fresh process: imports and the start of the workers'
server count. A time counts once the rise of each design that encloses a chamber is within
0.1 % of a tightly converged equilibrium. The ratio is that to a plain native loop of the
original program on one core (see `pipeline.py`), larger being slower.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time

from measure import Report

import voxsoft as vs
from voxsoft.design import families
from voxsoft.study import Outcome, StudyResult
from voxsoft.study.workers import LocalProcesses

#: CPU seconds of a plain single-core native loop of the original for its 105 designs, to a steady
#: state (measured on the machine the project started on).
ORIGINAL_STUDY = 4.0
DESIGNS, WORKERS = 105, 2
#: Largest error of the rise, and the tolerance of the state that is taken for true.
WITHIN, TIGHT = 1e-3, 1e-9
REPEATS = 7


def nothing(design: vs.Design) -> Outcome:
    """Evaluate nothing, so that what a trial costs without its physics remains."""
    return Outcome("ok", metrics={"rise": design.voxel_size})


def run(evaluate: object = None) -> tuple[float, StudyResult]:
    """Wall-clock seconds of the study in a new folder, and its result."""
    settings = {} if evaluate is None else {"evaluate": evaluate}
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        result = vs.Study(families.cylinder(), folder=folder, **settings).grid(workers=WORKERS)
        return time.perf_counter() - start, result


def require_right(result: StudyResult) -> None:
    """Refuse a study that misses a design, or whose physics is off."""
    solved = [trial for trial in result.trials if trial.status == "ok"]
    closed = len(solved) + result.counts["no-cavity"]
    if len(result.trials) != DESIGNS or closed != DESIGNS or not solved:
        raise SystemExit(f"wrong answer: {result.counts}")
    for trial in solved:
        design = families.cylinder(**trial.parameters)
        true = vs.simulate(design, method="statics", tolerance=TIGHT).metrics["rise"]
        error = abs(trial.objectives["rise"] - true) / abs(true)
        if not error < WITHIN:
            raise SystemExit(f"wrong answer: the rise of {trial.parameters} is off by {error:.2%}")


def worker_start() -> float:
    """Seconds until two more workers answer, a server for them being there."""
    start = time.perf_counter()
    workers = LocalProcesses(WORKERS)
    workers.submit(time.time).result()
    seconds = time.perf_counter() - start
    workers.close(now=True)
    return seconds


def import_seconds() -> float:
    """Seconds of `import voxsoft` in a fresh interpreter, that of the interpreter left out."""
    line = "import time; t = time.perf_counter(); import voxsoft; print(time.perf_counter() - t)"
    run = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    return float(run.stdout)


def main() -> None:
    """Run everything."""
    report = Report("The paper's study of 105 designs")
    cold, result = run()
    require_right(result)
    report.add("cold, two workers", cold, "s", cold / ORIGINAL_STUDY)
    warm, bare, starts = [], [], []
    for _ in range(REPEATS):
        seconds, again = run()
        warm.append(seconds)
        if [trial.objectives for trial in again.trials] != [t.objectives for t in result.trials]:
            raise SystemExit("wrong answer: the second study differs from the first")
        bare.append(run(nothing)[0])
        starts.append(worker_start())
    again_seconds = statistics.median(warm)
    report.add("again, two workers", again_seconds, "s", again_seconds / ORIGINAL_STUDY)
    solving = sum(trial.seconds for trial in result.trials)
    report.add("time in trials, one core", solving, "s", solving / ORIGINAL_STUDY)
    start = statistics.median(starts)
    report.add("start of two more workers", start, "s")
    each = (statistics.median(bare) - start) / DESIGNS
    report.add("Python's part of a trial", each * 1e3, "ms")
    report.add("import voxsoft", statistics.median(import_seconds() for _ in range(REPEATS)), "s")
    report.show()


if __name__ == "__main__":
    main()
