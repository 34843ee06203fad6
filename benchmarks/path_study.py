"""A study along a path of pressure: 24 wound tubes with a line in their wall, and Dask beside.

``python benchmarks/path_study.py [--json]``. `examples/wound_bender.toml` with four angles of the
thread, three walls and two offsets of the line, each design followed from 0 to 20 kPa in four
steps: its largest bend counts, where the line holds. The same study runs on a pool of two
processes and on a local Dask cluster of two workers; both must find the same numbers.
"""

from __future__ import annotations

import os

# One thread a process: two workers take two cores.
os.environ["RAYON_NUM_THREADS"] = "1"

import sys
import tempfile
import time
from pathlib import Path

from measure import Report

import voxsoft as vs
from voxsoft.errors import MissingPackageError
from voxsoft.study import Study, StudyResult

DESIGN = Path(__file__).parents[1] / "examples" / "wound_bender.toml"
SPACE = {
    "wind": ["60 deg", "67 deg", "75 deg", "82 deg"],
    "wall": ["3 mm", "3.5 mm", "4 mm"],
    "offset": ["9.5 mm", "10.5 mm"],
}
OVER = "loads[0].value=0..20 kPa/5"
WORKERS = 2


def run(folder: str, scheduler: str | None = None) -> tuple[StudyResult, float]:
    """The study in a new folder, and its seconds."""
    study = Study(vs.load(DESIGN), SPACE, over=OVER, folder=folder)
    start = time.perf_counter()
    found = study.grid(scheduler=scheduler, workers=None if scheduler else WORKERS)
    return found, time.perf_counter() - start


def on_dask(folder: str) -> tuple[StudyResult, float]:
    """The study on a cluster of this machine."""
    try:
        from distributed import LocalCluster
    except ImportError:
        what = "needs the package distributed"
        raise MissingPackageError("dask", what, "pip install 'voxsoft[dask]'") from None
    with LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None) as cluster:
        return run(folder, cluster.scheduler_address)


def main() -> None:
    """Measure both."""
    report = Report("A study along a path")
    with tempfile.TemporaryDirectory() as pool, tempfile.TemporaryDirectory() as cluster:
        here, seconds = run(pool)
        there, on_cluster = on_dask(cluster)
    assert [t.path for t in here.trials] == [t.path for t in there.trials]
    count = len(here.trials)
    report.add("designs", count, "")
    report.add("equilibria", len(here.paths()), "")
    report.add("of them ok", here.counts["ok"], "")
    report.add("two processes", seconds, "s")
    report.add("two processes, designs per second", count / seconds, "1/s")
    report.add("Dask, two workers", on_cluster, "s")
    report.add("Dask, designs per second", count / on_cluster, "1/s")
    best = here.best
    if best is not None:
        report.add(f"best bend, number {best.number}", best.objectives["bend"], "rad")
        for name, value in best.parameters.items():
            report.add(f"its {name}", value, "SI")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
