"""The job of a run: one design to its state at rest, or over time."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from voxsoft import files, simulation
from voxsoft.comparison.bars import ErrorBars, error_bars
from voxsoft.files.figures import save_figure, save_thumbnail
from voxsoft.jobs.events import Listener, Progress
from voxsoft.jobs.folder import write_job
from voxsoft.jobs.nearness import Nearness
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import RunSpec
from voxsoft.simulation import Result
from voxsoft.units import format_percent, format_quantity

#: What is counted while a further run for error bars is made.
FURTHER: Final = "percent of a further run"
#: Seconds between two words on how far a run is.
_REPORT_EVERY: Final = 0.25


def run_simulation(spec: RunSpec, folder: Path, notify: Listener) -> JobOutcome[Result]:
    """Simulate the design of a spec and write its run folder."""
    design = spec.design.read()
    settings: dict[str, Any] = dict(spec.solver)
    if settings:
        design = design.replace(solver=design.solver.replace(**settings))
    notify(Progress(0, 100, "percent", "meshing"))
    nearness = Nearness(design.solver)
    result = simulation.simulate(design, progress=_reporting(nearness, notify))
    write_job(spec.replace(kept=False), folder)  # what the folder holds from now on was solved
    files.write_run(result, folder)
    save_thumbnail(result, folder)
    if spec.figure:
        from voxsoft.plot import plot_body

        save_figure(plot_body(result), folder / "body.png")
        if result.contacts:
            save_figure(plot_body(result, "contact_pressure"), folder / "contact.png")
    bars = _error_bars(result, notify)
    files.write_run(result, folder, more={"error_bars": bars.summary()})
    notify(Progress(100, 100, "percent"))
    sentence = f"{result.message[:1].upper()}{result.message[1:]}."
    return JobOutcome(folder, result, sentence, error_bars=bars)


def _error_bars(result: Result, notify: Listener) -> ErrorBars:
    """The error bars of a run that is kept already; Ctrl-C leaves them out."""
    nearness, stage = Nearness(result.design.solver), ""

    def announce(size: float, voxels: int, seconds: float) -> None:
        nonlocal nearness, stage
        length = format_quantity(float(f"{size:.4g}"), "length")
        nearness = Nearness(result.design.solver)
        stage = f"error bars: {voxels:,} voxels of {length}, about {seconds:.2g} s"
        notify(Progress(0, 100, FURTHER, stage))

    def report(_: int, when: float, residual: float) -> None:
        notify(Progress(min(99, int(100 * nearness.at(when, residual))), 100, FURTHER, stage))

    try:
        return error_bars(result, progress=report, announce=announce)
    except KeyboardInterrupt:
        return ErrorBars.none("they were stopped before they were found", "run it again")


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
