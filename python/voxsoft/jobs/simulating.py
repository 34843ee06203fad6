"""The job of a run: one design to its state at rest, or over time."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from voxsoft import files, simulation
from voxsoft.files.figures import save_figure, save_thumbnail
from voxsoft.jobs.events import Listener, Progress
from voxsoft.jobs.folder import write_job
from voxsoft.jobs.nearness import Nearness
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import RunSpec
from voxsoft.simulation import Result
from voxsoft.units import format_percent

#: Seconds between two words on how far a run is.
_REPORT_EVERY: Final = 0.25


def run_simulation(spec: RunSpec, folder: Path, notify: Listener) -> JobOutcome[Result]:
    """Simulate the design of a spec and write its run folder."""
    design = spec.design.read()
    notify(Progress(0, 100, "percent", "meshing"))
    nearness = Nearness(design.solver)
    settings: dict[str, Any] = dict(spec.solver)
    result = simulation.simulate(design, progress=_reporting(nearness, notify), **settings)
    write_job(spec.replace(kept=False), folder)  # what the folder holds from now on was solved
    files.write_run(result, folder)
    save_thumbnail(result, folder)
    if spec.figure:
        from voxsoft.plot import plot_body

        save_figure(plot_body(result), folder / "body.png")
        if result.contacts:
            save_figure(plot_body(result, "contact_pressure"), folder / "contact.png")
    notify(Progress(100, 100, "percent"))
    sentence = f"{result.message[:1].upper()}{result.message[1:]}."
    return JobOutcome(folder, result, sentence)


def _reporting(nearness: Nearness, notify: Listener) -> Callable[[int, float, float], None]:
    last = time.monotonic()

    def report(_: int, when: float, residual: float) -> None:
        nonlocal last
        share = nearness.at(when, residual)
        now = time.monotonic()
        if now - last < _REPORT_EVERY:
            return
        last = now
        left = "searching for equilibrium"
        if residual <= 1.0:
            left = f"residual {format_percent(residual)} of the load"
        notify(Progress(min(99, int(100 * share)), 100, "percent", left))

    return report
