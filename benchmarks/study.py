"""The paper's study of 105 designs beside a textbook loop of the 45 that enclose a chamber.

``python benchmarks/study.py [--json]``. Compiles and runs the example `textbook_study` of the crate
`voxsoft-xpbd` (Algorithm 3 with one sweep, a scalar at a time, on one core), in turn with ours: the
whole study with two workers by the wall clock, from the call to the table of results; the whole
study in one process and the 45 designs in a loop by the processor time of all threads. Ours
includes formulas, voxels, meshes, metrics and the journal, the loop its steps alone.

A time of ours counts once the rise of each of the 45 is within 0.1 % of a tightly converged
equilibrium; so does one of the loop, with the substep that this takes. Its second time is that with
a longer substep, to within 0.1 % of where that one ends, which is up to 1.4 % off. Ratios say how
many times ours is quicker than the loop, for the first of its times and, in the rows that say so,
the second. Cold is the first study of a fresh process: imports and the start of the workers' server
count.
"""

from __future__ import annotations

import os

# One thread a process: two workers take two cores, and one core stays one.
os.environ["RAYON_NUM_THREADS"] = "1"

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path

from measure import Report

import voxsoft as vs
from voxsoft.design import families
from voxsoft.study import Outcome, StudyResult
from voxsoft.study.workers import LocalProcesses

DESIGNS, WORKERS = 105, 2
COMMAND = "cargo run --quiet --release -p voxsoft-xpbd --example textbook_study"
#: Largest error of the rise, and the tolerance of the state that is taken for true.
WITHIN, TIGHT = 1e-3, 1e-9
REPEATS = 5
#: Largest error of the loop's rise with the longer of its substeps, as its documentation says.
OWN_WITHIN = 1.4e-2
#: Radius, height and wall of a design in voxels.
Size = tuple[int, int, int]


def nothing(design: vs.Design) -> Outcome:
    """Evaluate nothing, so that what a trial costs without its physics remains."""
    return Outcome("ok", metrics={"rise": design.voxel_size})


class Textbook:
    """The compiled loop, which waits to be timed."""

    def __init__(self, rises: dict[Size, float]) -> None:
        root = Path(__file__).parents[1]
        pipe = subprocess.PIPE
        self._run = subprocess.Popen(COMMAND.split(), cwd=root, stdin=pipe, stdout=pipe, text=True)
        self.residuals: list[float] = []
        for aim, within in (("equilibrium", WITHIN), ("own", OWN_WITHIN)):
            for _ in rises:
                name, *numbers, rise, residual = self._line().split()
                radius, height, wall, _ = (int(number) for number in numbers)
                true = rises[radius, height, wall]
                if name != aim or not abs(float(rise) / true - 1) < within:
                    raise SystemExit(f"wrong answer of the loop: {name} {numbers}: {rise}, {true}")
                self.residuals.append(float(residual))

    def seconds(self) -> list[float]:
        """Seconds of all designs on one core: to the equilibrium, and to the loop's own rest.

        Each by the wall clock and of the processor.
        """
        assert self._run.stdin is not None
        self._run.stdin.write("again\n")
        self._run.stdin.flush()
        return [float(number) for number in self._line().split()]

    def close(self) -> None:
        """End the process."""
        self._run.communicate()

    def _line(self) -> str:
        assert self._run.stdout is not None
        line = self._run.stdout.readline()
        if not line:
            raise SystemExit("wrong answer of the loop, or no compiler")
        return line


def run(evaluate: object = None, executor: Executor | None = None) -> tuple[float, StudyResult]:
    """Wall-clock seconds of the study in a new folder, and its result."""
    workers = WORKERS if executor is None else 1
    settings = {} if evaluate is None else {"evaluate": evaluate}
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        study = vs.Study(families.paper_cylinder(), folder=folder, **settings)
        result = study.grid(workers=workers, executor=executor)
        return time.perf_counter() - start, result


def processor(task: Callable[[], object]) -> float:
    """Processor seconds of a task in this process, all threads together."""
    start = time.process_time()
    task()
    return time.process_time() - start


def true_rises(result: StudyResult) -> dict[Size, float]:
    """The rise of each chambered design at equilibrium, in m; refuses a study that is off."""
    solved = [trial for trial in result.trials if trial.status == "ok"]
    closed = len(solved) + result.counts["no-cavity"]
    if len(result.trials) != DESIGNS or closed != DESIGNS or not solved:
        raise SystemExit(f"wrong answer: {result.counts}")
    rises = {}
    for trial in solved:
        design = families.paper_cylinder(**trial.parameters)
        true = vs.simulate(design, method="statics", tolerance=TIGHT).metrics["rise"]
        error = abs(trial.objectives["rise"] - true) / abs(true)
        if not error < WITHIN:
            raise SystemExit(f"wrong answer: the rise of {trial.parameters} is off by {error:.2%}")
        radius, height, wall = (
            round(trial.parameters[name] / design.voxel_size)
            for name in ("radius", "height", "wall")
        )
        rises[radius, height, wall] = true
    return rises


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
    rises = true_rises(result)
    textbook = Textbook(rises)
    chambered = [families.paper_cylinder(**t.parameters) for t in result.trials if t.status == "ok"]

    def loop() -> None:
        for design in chambered:
            vs.simulate(design)

    textbooks: list[list[float]] = []
    times: dict[str, list[float]] = {name: [] for name in ("two", "one", "loop")}
    bare, starts = [], []
    for _ in range(REPEATS):
        textbooks.append(textbook.seconds())
        seconds, again = run()
        times["two"].append(seconds)
        if [trial.objectives for trial in again.trials] != [t.objectives for t in result.trials]:
            raise SystemExit("wrong answer: the second study differs from the first")
        with ThreadPoolExecutor(1) as thread:
            times["one"].append(processor(lambda: run(executor=thread)))
        times["loop"].append(processor(loop))
        bare.append(run(nothing)[0])
        starts.append(worker_start())
    textbook.close()
    median = {name: statistics.median(values) for name, values in times.items()}
    columns = zip(*textbooks, strict=True)
    wall, busy, own_wall, own_busy = (statistics.median(column) for column in columns)
    report.add("textbook loop to the equilibrium, wall clock", wall, "s")
    report.add("textbook loop to the equilibrium, processor time", busy, "s")
    report.add("textbook loop to its own rest, wall clock", own_wall, "s")
    report.add("textbook loop to its own rest, processor time", own_busy, "s")
    report.add("forces it leaves out of balance, at most", max(textbook.residuals), "of the load")
    report.add("cold, two workers", cold, "s", wall / cold)
    for name, row, right, own in (
        ("two", "again, two workers", wall, own_wall),
        ("one", "again, one thread, processor time", busy, own_busy),
        ("loop", "45 designs in a loop, processor time", busy, own_busy),
    ):
        report.add(row, median[name], "s", right / median[name])
        report.add(f"{row}: the loop's own rest", median[name], "s", own / median[name])
    start = statistics.median(starts)
    report.add("start of two more workers", start, "s")
    each = (statistics.median(bare) - start) / DESIGNS
    report.add("Python's part of a trial", each * 1e3, "ms")
    report.add("import voxsoft", statistics.median(import_seconds() for _ in range(REPEATS)), "s")
    report.show()


if __name__ == "__main__":
    main()
