"""Random bodies squeezed to half their height: how many end there, and how the others fail.

``python evidence/squeeze.py [--bodies 50] [--first 0] [--jobs 1] [--limit 120] [--json]``.
`squeeze_bodies.py` says what is squeezed, and who judges. One body again, with all that is known of
it: ``--seed 17``. A process beside this one squeezes it, and is stopped after so many seconds of
processor time (`--limit`), or ten times as long by the clock: that is what "time limit" means.
Exits with 1 where any body fails.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path

import numpy as np
import psutil
from rich.console import Console
from rich.table import Table
from squeeze_bodies import GOOD, KINDS, VOXELS, Verdict, judged

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

#: How many times the limit of processor time may pass by the clock, and how often that is looked
#: at [s].
CLOCK, LOOK = 10.0, 0.2

_CONTEXT = multiprocessing.get_context("spawn")


class Worker:
    """A process that squeezes one body after the other, and can be stopped."""

    def __init__(self, voxels: tuple[int, int]) -> None:
        self._voxels = voxels
        self._start()

    def _start(self) -> None:
        self.pipe, theirs = _CONTEXT.Pipe()
        self._process: BaseProcess = _CONTEXT.Process(
            target=_work, args=(theirs, self._voxels), daemon=True
        )
        self._process.start()
        self._usage = psutil.Process(self._process.pid)
        theirs.close()
        assert self.pipe.recv() == "ready"  # what it imports does not count

    def take(self, seed: int) -> None:
        """Squeeze the body of a seed."""
        self.seed, self._since, self._used = seed, time.monotonic(), self._seconds()
        self.pipe.send(seed)

    def answer(self) -> Verdict:
        """What it found; the process has died where it has none."""
        try:
            verdict: Verdict = self.pipe.recv()
        except EOFError:
            self._process.join()
            died = f"the process died, exit code {self._process.exitcode}"
            self._start()
            return Verdict(self.seed, message=died)
        return verdict

    def _seconds(self) -> float:
        """Processor time that it has used; none where it has died."""
        try:
            used = self._usage.cpu_times()
        except psutil.Error:
            return 0.0
        return float(used.user + used.system)

    def is_late(self, limit: float) -> bool:
        """Whether it has worked for so many seconds on its body."""
        clock = time.monotonic() - self._since
        return self._seconds() - self._used > limit or clock > CLOCK * limit

    def stop(self, limit: float) -> Verdict:
        """Stop it in the middle of a body, and make it ready for another one."""
        self.close()
        self._start()
        return Verdict(self.seed, kind="time limit", seconds=limit)

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.join()


def _work(pipe: Connection, voxels: tuple[int, int]) -> None:
    pipe.send("ready")
    while True:
        seed = pipe.recv()
        try:
            verdict = judged(seed, voxels)
        except Exception as error:  # whatever it is, it is what came out
            verdict = Verdict(seed, message=f"{type(error).__name__}: {error}")
        pipe.send(verdict)


def squeeze(
    seeds: Iterable[int], voxels: tuple[int, int] = VOXELS, jobs: int = 1, limit: float = 120.0
) -> Iterator[Verdict]:
    """Squeeze the bodies of some seeds, `jobs` at a time, in the order in which they end.

    `limit` is the processor time in s after which a body is given up.
    """
    left = iter(seeds)
    busy: list[Worker] = []
    try:
        for _ in range(jobs):
            seed = next(left, None)
            if seed is None:
                break
            busy.append(Worker(voxels))
            busy[-1].take(seed)
        while busy:
            ready = wait([worker.pipe for worker in busy], LOOK)
            for worker in list(busy):
                if worker.pipe in ready:
                    yield worker.answer()
                elif worker.is_late(limit):
                    yield worker.stop(limit)
                else:
                    continue
                seed = next(left, None)
                if seed is None:
                    worker.close()
                    busy.remove(worker)
                else:
                    worker.take(seed)
    finally:
        for worker in busy:
            worker.close()


def show(verdicts: list[Verdict]) -> None:
    """Print failures by kind, and each of them."""
    console = Console(width=150)
    table = Table(title="Squeezed to half their height", title_justify="left")
    for name in ("how it ended", "bodies", "seeds"):
        table.add_column(name, justify="right" if name == "bodies" else "left")
    for kind in KINDS:
        seeds = sorted(verdict.seed for verdict in verdicts if verdict.kind == kind)
        named = " ".join(map(str, seeds)) if kind not in GOOD else ""
        table.add_row(kind, str(len(seeds)), named)
    console.print(table)
    failed = [verdict for verdict in verdicts if verdict.kind not in GOOD]
    if not failed:
        return
    table = Table(title="Failures, the worst first", title_justify="left")
    for name in (
        "seed",
        "voxels",
        "how",
        "reached",
        "faces",
        "folds",
        "depth",
        "seconds",
        "message",
    ):
        table.add_column(name)
    for each in sorted(failed, key=lambda v: (KINDS.index(v.kind), v.seed)):
        table.add_row(
            str(each.seed),
            str(each.voxels),
            each.kind,
            f"{100 * each.reached:.1f} %",
            str(each.pairs),
            str(each.folds),
            f"{each.depth:.2g}",
            f"{each.seconds:.1f}",
            each.message.split(";")[0],
        )
    console.print(table)


def main() -> None:
    """Squeeze, show and report."""
    report = Report(
        "Random bodies squeezed to half their height",
        values={
            "bodies": (50, "how many bodies"),
            "first": (0, "the seed of the first one"),
            "seed": (None, "this body alone"),
            "jobs": (1, "bodies at a time"),
            "limit": (120, "seconds of processor time after which a body is given up"),
        },
    )
    asked = report.options
    one = asked["seed"]
    seeds = (
        range(asked["first"], asked["first"] + asked["bodies"])
        if one is None
        else range(one, one + 1)
    )
    verdicts = []
    for verdict in squeeze(seeds, jobs=asked["jobs"], limit=asked["limit"]):
        verdicts.append(verdict)
        if not asked["json"]:
            text = f"{verdict.seed}: {verdict.kind}, {100 * verdict.reached:.4g} %"
            text += f", {verdict.voxels} voxels, {verdict.iterations} iterations"
            print(f"{text}, {verdict.seconds:.1f} s", file=sys.stderr, flush=True)
    if not asked["json"]:
        show(verdicts)
    if one is not None and not asked["json"]:
        Console().print(asdict(verdicts[0]))
    for kind in KINDS:
        report.add(kind, sum(v.kind == kind for v in verdicts), "bodies")
    solved = [verdict for verdict in verdicts if verdict.points]
    if solved:
        report.add("median time", float(np.median([v.seconds for v in solved])), "s")
        report.add("longest time", max(v.seconds for v in solved), "s")
        report.add("median iterations", float(np.median([v.iterations for v in solved])), "")
    report.show()
    sys.exit(any(verdict.kind not in GOOD for verdict in verdicts))


if __name__ == "__main__":
    main()
