"""Job of a run: one design to its state at rest, or over time."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from voxsoft import files, simulation
from voxsoft.comparison.bars import error_bars
from voxsoft.comparison.error_bar import ErrorBars
from voxsoft.comparison.path_bars import path_error_bars
from voxsoft.design import Design, require_design
from voxsoft.errors import SimulationError
from voxsoft.files.figures import save_figure, save_thumbnail
from voxsoft.files.motion_frames import FRAMES, write_frames
from voxsoft.files.path_states import STATES, write_states
from voxsoft.files.run_folder import Unwritten, make_folder, write_summary
from voxsoft.jobs.events import Listener, Progress
from voxsoft.jobs.folder import write_job
from voxsoft.jobs.kept_path import KeptPath
from voxsoft.jobs.nearness import Nearness
from voxsoft.jobs.outcome import JobOutcome, modes_summary, path_summary
from voxsoft.jobs.spec import RunSpec
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.results.vibration import Modes, modes
from voxsoft.simulation.solving.choice import check_solver, method_of
from voxsoft.simulation.solving.cost import cost_of
from voxsoft.simulation.solving.equilibrium import Statics
from voxsoft.units import format_percent, format_quantity

#: Unit of progress while a further run for error bars is made.
FURTHER: Final = "percent of a further run"
#: Seconds between two reports of the progress of a run.
_REPORT_EVERY: Final = 0.25
#: Least seconds of an overdue run, and least multiple of its expected seconds.
_LONG: Final = 10.0
_OVERDUE: Final = 10.0
#: No further entries of a summary.
_NOTHING: Final[Mapping[str, Any]] = MappingProxyType({})


def run_simulation(spec: RunSpec, folder: Path, notify: Listener) -> JobOutcome[Result]:
    """Simulate the design of a spec and write its run folder."""
    design = spec.design.read()
    settings: dict[str, Any] = dict(spec.solver)
    if settings:
        design = design.replace(solver=design.solver.replace(**settings))
    notify(Progress(0, 100, "percent", "meshing"))
    if spec.over is not None:
        return _follow(spec, design, folder, notify)
    design = require_design(design).assembled
    check_solver(design)
    method = method_of(design, design.solver)
    setup = Setup.of(design, allow_loose=not method.to_rest, refine=design.solver.refine)
    result = simulation.simulate(
        setup,
        record_interval=spec.frames,
        frames=spec.frames is not None,
        progress=_reporting(setup, notify),
    )
    unwritten = Unwritten(folder)
    _write(spec, result, folder, unwritten)
    found, no_modes = _modes(spec, result)
    bars = _error_bars(result, notify, spec.frequencies)
    more = modes_summary(found, no_modes)
    write_summary(result, folder, more=more | {"error_bars": bars.summary()})
    notify(Progress(100, 100, "percent"))
    return JobOutcome(
        folder,
        result,
        _sentence(result.message, unwritten),
        error_bars=bars,
        modes=found,
        modes_missing=no_modes,
        unwritten=unwritten.problems,
    )


def _modes(spec: RunSpec, result: Result) -> tuple[Modes | None, str]:
    """Find the natural vibrations that a spec asks for, or the reason why there are none."""
    if not spec.frequencies:
        return None, ""
    try:
        return modes(result, spec.frequencies), ""
    except SimulationError as error:
        return None, str(error)


def _sentence(message: str, unwritten: Unwritten) -> str:
    missing = "".join(f"; {problem}" for problem in unwritten.problems)
    return f"{message[:1].upper()}{message[1:]}{missing}."


def _write(
    spec: RunSpec,
    result: Result,
    folder: Path,
    unwritten: Unwritten,
    more: Mapping[str, Any] = _NOTHING,
) -> None:
    """Write a run folder with its pictures, the numbers first."""
    write_summary(result, folder, more=more)
    with unwritten.attempt("job.toml"):
        write_job(spec.replace(kept=False), folder)  # from now on the folder holds a solved state
    with unwritten.attempt("result.vtu"):
        files.write_run(result, folder, more=more)
    if spec.frames is not None:
        with unwritten.attempt(FRAMES):
            write_frames(result, folder)
    with unwritten.attempt("thumbnail"):
        save_thumbnail(result, folder)
    if not spec.figure:
        return
    from voxsoft.plot import plot_body

    with unwritten.attempt("body.png"):
        save_figure(plot_body(result), folder / "body.png")
    if result.contacts:
        with unwritten.attempt("contact.png"):
            save_figure(plot_body(result, "contact_pressure"), folder / "contact.png")


def _follow(spec: RunSpec, design: Design, folder: Path, notify: Listener) -> JobOutcome[Result]:
    """Follow a path, and write the folder of its last equilibrium with a table of all of them."""
    assert spec.over is not None  # checked by the caller
    over = simulation.Over.read(spec.over)
    kept = KeptPath(folder, design, over)
    earlier = kept.read()
    if not earlier:
        kept.clear()  # equilibria of another path
    creep = kept.read_creep(len(earlier) - 1)
    followed: simulation.LoadPath | None = None

    def step(path: simulation.LoadPath) -> None:
        nonlocal followed
        done = len(path.results)
        if followed is None:
            make_folder(folder)
            write_job(spec.replace(kept=False), folder)
        followed = path
        if done > len(earlier):
            kept.keep(done - 1, path.results[-1], path.creep)
        files.write_path(path, (), folder)
        notify(path)
        reached = f"{over.in_words(over.values[done - 1])} reached"
        notify(Progress(done, len(over.values), "equilibria", reached))

    unwritten = Unwritten(folder)
    try:
        path = simulation.follow(design, over, step=step, earlier=earlier, creep=creep)
    except BaseException:
        # Every exception, Ctrl-C too, leaves the equilibria that were found.
        if followed is not None:
            _write(spec, followed.results[-1], folder, unwritten, path_summary(followed))
            with unwritten.attempt(STATES):
                write_states(followed, folder)
        raise
    result = path.results[-1]
    _write(spec, result, folder, unwritten, path_summary(path))
    with unwritten.attempt(STATES):
        write_states(path, folder)

    def announce(size: float, voxels: int, seconds: float) -> None:
        length = format_quantity(float(f"{size:.4g}"), "length")
        words = f"error bars: {voxels:,} voxels of {length}, about {float(f'{seconds:.2g}'):g} s"
        notify(Progress(0, 100, FURTHER, words))

    try:
        bars = path_error_bars(path, announce=announce, frequencies=spec.frequencies)
    except KeyboardInterrupt:
        bars = ()
    kept.clear()
    found, no_modes = _modes(spec, result)
    more = modes_summary(found, no_modes)
    write_summary(result, folder, more=more | path_summary(path, bars))
    files.write_path(path, bars, folder)
    if spec.figure:
        from voxsoft.plot import plot_path

        with unwritten.attempt("path.png"):
            save_figure(plot_path(path, bars), folder / "path.png")
    notify(path)
    notify(Progress(100, 100, "percent"))
    last = bars[-1] if bars else ErrorBars.none("they were stopped", "run it again")
    return JobOutcome(
        folder,
        result,
        _sentence(path.message, unwritten),
        error_bars=last,
        path=path,
        path_bars=bars,
        modes=found,
        modes_missing=no_modes,
        unwritten=unwritten.problems,
    )


def _error_bars(result: Result, notify: Listener, frequencies: int) -> ErrorBars:
    """Compute the error bars of a run that is stored already; Ctrl-C leaves them out."""
    nearness, stage = Nearness(result.design.solver), ""

    def announce(size: float, voxels: int, seconds: float) -> None:
        nonlocal nearness, stage
        length = format_quantity(float(f"{size:.4g}"), "length")
        nearness = Nearness(result.design.solver)
        stage = f"error bars: {voxels:,} voxels of {length}, about {float(f'{seconds:.2g}'):g} s"
        notify(Progress(0, 100, FURTHER, stage))

    def report(_: int, when: float, residual: float) -> None:
        notify(Progress(min(99, int(100 * nearness.at(when, residual))), 100, FURTHER, stage))

    try:
        return error_bars(result, progress=report, announce=announce, frequencies=frequencies)
    except KeyboardInterrupt:
        return ErrorBars.none("they were stopped before they were found", "run it again")


def _reporting(setup: Setup, notify: Listener) -> Callable[[int, float, float], None]:
    design = setup.design
    of_loads = isinstance(method_of(design, design.solver), Statics)
    nearness = Nearness(design.solver, of_loads=of_loads)
    started = last = time.monotonic()
    slow = ""

    def report(_: int, when: float, residual: float) -> None:
        nonlocal last, slow
        share = nearness.at(when, residual)
        now = time.monotonic()
        if now - last < _REPORT_EVERY:
            return
        last = now
        slow = slow or overdue(setup, now - started)
        left = "searching for equilibrium"
        if residual <= 1.0:
            left = f"residual {format_percent(residual)} of the load"
        if of_loads:
            left = f"{format_percent(share)} of the load reached, {left}"
        notify(Progress(min(99, int(100 * share)), 100, "percent", left + slow))

    return report


def overdue(setup: Setup, seconds: float) -> str:
    """Return a message if a run takes ten times as long as expected, and that is long."""
    if seconds < _LONG:
        return ""
    expected = cost_of(setup.design, setup.mesh, None, setup.problem.mass).seconds
    if seconds < _OVERDUE * expected:
        return ""
    return (
        f"; about {expected:.2g} s were expected: the loads may be more than the body carries, "
        "try smaller ones"
    )
