"""Cost of a trial of a study: of the process that hands it out, and of the one that solves it.

``python benchmarks/trials.py [--json] [--rounds N]``. Processor time of one thread, the least of
some rounds: a busy machine makes it longer and never shorter.

The main process is timed with an executor that answers at once, over the paper's 105 designs: to
propose, build, hash, store and report a trial; and with one that has 3,200 trials under way, as for
1,600 workers, over rubber cylinders, once. A trial is timed over those designs of the cylinder
families that enclose a chamber: the paper's springs, and rubber on cut voxels of 248 to 288.
"""

from __future__ import annotations

import os

os.environ["RAYON_NUM_THREADS"] = "1"

import tempfile
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from contextlib import suppress
from functools import partial
from typing import TypeVar

from measure import Report

import voxsoft as vs
from voxsoft.design import families
from voxsoft.study import Outcome, Study, evaluate_design
from voxsoft.units import mm

T = TypeVar("T")

WORKERS, TIMED = 1600, 800
#: More designs than are timed or under way.
MANY = {
    "radius": ("20 mm", "40 mm", "1 mm"),
    "height": ("20 mm", "50 mm", "1 mm"),
    "wall": ("10 mm", "16 mm", "1 mm"),
}
RUBBER = {"radius": (20 * mm, 25 * mm), "height": (20 * mm, 25 * mm, 30 * mm), "wall": (10 * mm,)}


class AtOnce(Executor):
    """Executor that calls each task as it comes."""

    def submit(self, task: Callable[..., T], /, *values: object, **names: object) -> Future[T]:
        """Call a task."""
        future: Future[T] = Future()
        future.set_result(task(*values, **names))
        return future


class Late(Executor):
    """Executor that has `many` tasks under way, and calls the oldest as another one comes."""

    def __init__(self, many: int) -> None:
        self._many = many
        self._waiting: deque[tuple[Future[object], Callable[[], object]]] = deque()

    def submit(self, task: Callable[..., T], /, *values: object, **names: object) -> Future[T]:
        """Take a task, and end another one."""
        future: Future[T] = Future()
        self._waiting.append((future, partial(task, *values, **names)))
        if len(self._waiting) >= self._many:
            oldest, call = self._waiting.popleft()
            oldest.set_result(call())
        return future


class Enough(Exception):
    """The end of a study that was timed for long enough."""


def nothing(design: vs.Design) -> Outcome:
    """Evaluate nothing."""
    return Outcome("ok", metrics={"rise": design.voxel_size})


def coordinate() -> int:
    """Run the paper's study without its physics; return the number of trials."""
    with tempfile.TemporaryDirectory() as folder:
        study = Study(families.paper_cylinder(), folder=folder, evaluate=nothing)
        return len(study.grid(executor=AtOnce(), workers=1).trials)


def coordinate_many() -> float:
    """Processor time for a trial of a study with 1,600 workers [s]."""
    times: list[float] = []

    def tell(_: object) -> None:
        times.append(time.process_time())
        if len(times) == TIMED:
            raise Enough

    with tempfile.TemporaryDirectory() as folder:
        study = Study(families.cylinder(), MANY, folder=folder, evaluate=nothing)
        with suppress(Enough):
            study.grid(executor=Late(2 * WORKERS), workers=WORKERS, progress=tell)
    return (times[-1] - times[0]) / (len(times) - 1)


def chambered(designs: Sequence[vs.Design]) -> list[vs.Design]:
    """Leave out designs that no pressure can be put in."""
    return [design for design in designs if evaluate_design(design).status == "ok"]


def least(task: Callable[[], object], rounds: int) -> float:
    """Least processor time of some calls [s]."""
    times = []
    for _ in range(rounds):
        start = time.process_time()
        task()
        times.append(time.process_time() - start)
    return min(times)


def main() -> None:
    """Time all of them."""
    report = Report("Cost of a trial", {"rounds": (7, "calls of each, of which the least counts")})
    rounds = int(report.options["rounds"])
    trials = coordinate()
    report.add("main process", least(coordinate, rounds) / trials * 1e3, "ms")
    report.add(f"main process, {WORKERS:,} workers", coordinate_many() * 1e3, "ms")
    with tempfile.TemporaryDirectory() as folder:
        study = Study(families.paper_cylinder(), folder=folder, evaluate=nothing)
        points = [trial.parameters for trial in study.grid(executor=AtOnce(), workers=1).trials]
    lattice = chambered([families.paper_cylinder(**point) for point in points])
    rubber = chambered(
        [
            families.cylinder(radius=radius, height=height, wall=wall)
            for radius in RUBBER["radius"]
            for height in RUBBER["height"]
            for wall in RUBBER["wall"]
        ]
    )
    for name, designs in (("the paper's springs", lattice), ("rubber, cut voxels", rubber)):
        seconds = least(lambda each=designs: [evaluate_design(d) for d in each], rounds)
        report.add(f"trial of {name}", seconds / len(designs) * 1e3, "ms")
    report.show()


if __name__ == "__main__":
    main()
