"""Job of a comparison: a design by several solvers, an outside code and measurements."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from voxsoft import files
from voxsoft.comparison import Comparison, compare
from voxsoft.files.run_folder import provenance, write_json
from voxsoft.jobs.events import Listener, Progress
from voxsoft.jobs.folder import write_job
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import CompareSpec

#: File name of the report of a comparison.
REPORT: Final = "report.html"


def run_comparison(spec: CompareSpec, folder: Path, notify: Listener) -> JobOutcome[Comparison]:
    """Compare the answers to the design of a spec, and write the report."""
    found = compare(
        spec.design.read(),
        solvers=spec.solvers,
        outside=spec.outside,
        voxel_sizes=spec.voxel_sizes,
        splits=spec.splits,
        measured=[table.read() for table in spec.data],
        time_limit=spec.time_limit,
        progress=lambda label, done, total: notify(
            Progress(100 * done // total, 100, "percent", label)
        ),
    )
    write_job(spec, folder)
    write_json(folder / "summary.json", found.summary() | provenance())
    report = files.write_comparison(found, folder / REPORT)
    answered = sum(run.ok for run in found.runs)
    sentence = f"{answered} of {len(found.runs)} runs came to rest."
    return JobOutcome(folder, found, sentence, (folder / "summary.json", report))
