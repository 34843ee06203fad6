"""Comparison of a design by several solvers and codes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final, get_args

from voxsoft.calibration import Experiment, Measurement
from voxsoft.calibration.experiment import changed
from voxsoft.comparison.brick_contact import passed_through
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.cautions import cautions_of, cautions_of_contact, cautions_of_layers
from voxsoft.comparison.comparison import Comparison, Judged, Run
from voxsoft.comparison.defaults import (
    DEFAULT_SOLVERS,
    DEFAULT_SPLITS,
    DEFAULT_TIME_LIMIT,
    Outside,
)
from voxsoft.comparison.full_voxels import with_full_voxels
from voxsoft.comparison.other_voxels import on_voxels
from voxsoft.comparison.outside import OutsideAnswer
from voxsoft.comparison.quantities import of_answer, of_result
from voxsoft.comparison.scikit_fem import run_scikit_fem, scikit_fem_version
from voxsoft.design import Design, Solver, require_design
from voxsoft.errors import MeasurementError, MissingPackageError, SimulationError, VoxSoftError
from voxsoft.mesh import Mesh
from voxsoft.simulation import Diagnostic, Result, Setup, simulate
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.solving.choice import given_settings
from voxsoft.units import format_quantity, si_value

OUTSIDE: Final[tuple[Outside, ...]] = get_args(Outside)

#: Solver settings of a design that count; a comparison names its methods itself.
_USED: Final = frozenset({"method", "refine"})

#: Called before each run with its label, how many runs are done, and how many there are.
ProgressCallback = Callable[[str, int, int], None]


def compare(
    design: Design,
    *,
    solvers: Sequence[str] = DEFAULT_SOLVERS,
    outside: Outside = "auto",
    voxel_sizes: Iterable[float | str] | None = None,
    splits: Sequence[int] = DEFAULT_SPLITS,
    measured: Sequence[Measurement] = (),
    time_limit: float | str = DEFAULT_TIME_LIMIT,
    progress: ProgressCallback | None = None,
) -> Comparison:
    """Solve a design in several ways, and estimate the error of each.

    All solvers and the outside code answer on the voxels of the design: full ones beside an outside
    code, unless the design itself says ``fill = "fraction"``. The last of the solvers
    also answers on the same voxels split finer, and on other sizes of voxels, which may change the
    shape; so does the outside code on split voxels. From each of these series the discretization
    error is estimated (:func:`voxsoft.comparison.discretization_error`). A run that fails, takes
    too long or does not come to rest is listed with its message, and the others go on.

    Parameters
    ----------
    design
        The design, solved at rest: of its own solver settings only `refine` counts; others are
        named in :attr:`Comparison.warnings`.
    solvers
        Own solvers, ``"xpbd"`` and ``"statics"``; the estimates are for the last.
    outside
        ``"calculix"``, ``"scikit-fem"``, ``"auto"`` (the first of the two that is installed;
        default), or ``"none"``.
    voxel_sizes
        Sizes of voxels, in m or with their unit, that the last solver uses in addition to the
        design's own; default: one half as large. An empty list for none.
    splits
        Bricks along the edge of a voxel, rising; default 1 and 2.
    measured
        Measurements of the real body; values of the design that they name
        (:attr:`~voxsoft.calibration.Measurement.changes`) are one for all of them.
    time_limit
        Time that each run may take, in s or with its unit.
    progress
        Called before each run with its label, how many are done and how many there are.

    Raises
    ------
    DesignError
        A solver that does not exist, or a design that cannot be solved: no clamp, a probe outside
        the body, ...
    MeasurementError
        A measurement that does not fit the design.
    MissingPackageError
        The requested outside code is not installed.
    SimulationError
        No solver at all, or splits that do not rise from 1.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam().replace(voxel_size=10e-3)
    >>> found = compare(beam, solvers=["xpbd"], outside="none", voxel_sizes=[5e-3], splits=[1])
    >>> [run.label for run in found.runs]
    ['xpbd, 10 mm', 'xpbd, 5 mm']
    >>> found.estimates[0].runs
    ('xpbd, 10 mm', 'xpbd, 5 mm')
    """
    refuse(require_design(design), "comparison")
    limit = si_value(time_limit, "time", "time_limit", positive=True)
    splits = [int(split) for split in splits]
    if not solvers:
        raise SimulationError("solvers", "names none", 'name "xpbd", "statics" or both')
    for method in solvers:
        Solver(method=method)  # Refuses an unknown solver before anything runs.
    if list(splits) != sorted(set(splits)) or not splits or splits[0] < 1:
        raise SimulationError("splits", "do not rise from 1", "write 1,2 or 1,2,3")
    code = _outside(outside)
    design = _as_measured(design, measured)
    design, unlike = with_full_voxels(design) if code else (design, ())
    plain = design.replace(solver=Solver())
    refine = design.solver.refine
    base = Setup.of(plain, allow_loose=False, refine=refine)
    experiments = [Experiment(plain, measurement) for measurement in measured]
    sizes = (
        [design.voxel_size / 2]
        if voxel_sizes is None
        else [si_value(size, "length", "voxel_sizes", positive=True) for size in voxel_sizes]
    )
    tasks = list(_tasks(plain, base, tuple(solvers), code, sizes, tuple(splits), limit, refine))
    runs: list[Run] = []
    for index, task in enumerate(tasks):
        if progress is not None:
            progress(task.label, index, len(tasks))
        runs.append(_run(task, design.voxel_size, experiments))
    note = "" if code or outside == "none" else _NO_OUTSIDE
    judged = tuple(Judged.of(experiment) for experiment in experiments)
    cautions = [*cautions_of(design, base.mesh), *cautions_of_contact(base)]
    if code:
        cautions += cautions_of_layers(design)
    warnings = (*_unused(design), *unlike, *cautions)
    return Comparison(design, tuple(runs), tuple(solvers)[-1], code or "", judged, note, warnings)


def _as_measured(design: Design, measured: Sequence[Measurement]) -> Design:
    """Return the design as it was loaded when it was measured."""
    changes = {measurement.changes for measurement in measured}
    if len(changes) > 1:
        raise MeasurementError(
            "measured",
            f"{' and '.join(measurement.name for measurement in measured)} were loaded differently",
            "compare each of them alone",
        )
    return changed(design, next(iter(changes), ()))


def _unused(design: Design) -> Iterator[Diagnostic]:
    for name in given_settings(design.solver):
        if name not in _USED:
            what = "is not used by comparisons, whose runs all go to rest"
            yield Diagnostic("warning", f"solver.{name}", what, "leave it out of the design")


_NO_OUTSIDE = (
    "no outside code is installed: apt install calculix-ccx (Debian, Ubuntu), or "
    "pip install scikit-fem for the one with scikit-fem"
)


#: Solver and mesh of a run, and its result.
_Solved = tuple[tuple[str, Mesh], Result]


@dataclass(frozen=True)
class _Task:
    """Run that is still to be made."""

    label: str
    code: str
    voxel_size: float
    split: int
    solve: Callable[[], Any]


def _outside(asked: Outside) -> str | None:
    """Return the name of the outside code to use."""
    # `files` lies above `comparison` in the layers, and only `files` may touch the disk; this
    # reaches up when called, so that no import runs in a circle.
    from voxsoft.files.calculix import calculix_path

    if asked not in OUTSIDE:
        known = ", ".join(OUTSIDE)
        raise SimulationError("outside", f'"{asked}" is not a code', f"known are {known}")
    probes: dict[str, Callable[[], object]] = {
        "calculix": calculix_path,
        "scikit-fem": scikit_fem_version,
    }
    if asked in probes:
        probes[asked]()
        return asked
    for name, look in probes.items() if asked == "auto" else ():
        try:
            look()
        except MissingPackageError:
            continue
        return name
    return None


def _tasks(
    design: Design,
    base: Setup,
    solvers: tuple[str, ...],
    code: str | None,
    sizes: list[float],
    splits: tuple[int, ...],
    time_limit: float,
    refine: int,
) -> Iterator[_Task]:
    own = _length(design.voxel_size)
    last = solvers[-1]
    before: list[_Solved] = []

    def solving(method: str, setup: Callable[[], Setup]) -> Callable[[], Any]:
        return lambda: _solve(setup(), method, time_limit, before)

    for method in solvers:
        label = f"{method}, {own}"
        yield _Task(label, method, design.voxel_size, 1, solving(method, lambda: base))
    for split in splits:
        if split > 1:
            finer = f"{last}, {own} split {split}"
            setup = partial(Setup.of, design, allow_loose=False, refine=split * refine)
            yield _Task(finer, last, design.voxel_size, split, solving(last, setup))
    for size in sizes:
        if size != design.voxel_size:
            other = on_voxels(design, size / design.voxel_size)
            setup = partial(Setup.of, other, allow_loose=False, refine=refine)
            yield _Task(f"{last}, {_length(size)}", last, size, 1, solving(last, setup))
    for split in splits if code else ():
        whole = "" if split == 1 else f" split {split}"
        label = f"{'CalculiX' if code == 'calculix' else code}, {own}{whole}"
        solve = partial(_solve_outside, base, str(code), split, time_limit)
        yield _Task(label, str(code), design.voxel_size, split, solve)


def _length(size: float) -> str:
    return format_quantity(float(f"{size:.6g}"), "length")


def _solve(
    setup: Setup, method: str, time_limit: float, before: list[_Solved]
) -> tuple[Setup, Result]:
    """Solve, unless the same voxels were solved before: places and loads follow from the mesh."""
    found = next((result for other, result in before if other == (method, setup.mesh)), None)
    if found is not None:
        return setup, found
    end = time.monotonic() + time_limit

    def watch(steps: int, _: float, residual: float) -> None:
        if time.monotonic() > end:
            raise SimulationError(
                method,
                f"did not come to rest within {time_limit:g} s ({steps} steps, residual "
                f"{residual:.1e})",
                "allow more time, or take larger voxels",
            )

    result = simulate(setup, method=method, progress=watch)
    before.append(((method, setup.mesh), result))
    return setup, result


def _solve_outside(setup: Setup, code: str, split: int, time_limit: float) -> Any:  # noqa: ANN401
    if code == "calculix":
        from voxsoft.files.calculix import run_calculix

        model = BrickModel.of(setup, split=split, nodes=20)
        return setup, model, _apart(setup, run_calculix(model, time_limit=time_limit))
    model = BrickModel.of(setup, split=split, nodes=27)
    return setup, model, run_scikit_fem(model, time_limit=time_limit)


def _apart(setup: Setup, answer: OutsideAnswer) -> OutsideAnswer:
    """Set the status of an answer to passed-through if surfaces passed through each other."""
    found = passed_through(setup, setup.mesh.vertices + answer.displacements)
    if not found:
        return answer
    hint = "walls that do not look at each other at rest are no pairs of its contact"
    return replace(answer, status="passed-through", message=f"{found}; {hint}")


def _run(task: _Task, voxel_size: float, experiments: Sequence[Experiment]) -> Run:
    """Make a run; an error becomes its message."""
    started = time.perf_counter()
    known: dict[str, Any] = {
        "label": task.label,
        "code": task.code,
        "voxel_size": task.voxel_size,
        "split": task.split,
    }
    try:
        solved = task.solve()
    except VoxSoftError as error:
        seconds = time.perf_counter() - started
        return Run(**known, status="failed", message=str(error), seconds=seconds)
    if len(solved) == 2:
        setup, result = solved
        positions, quantities = result.positions, of_result(setup, result)
        known |= {
            "status": result.status,
            "message": result.message,
            "seconds": result.seconds,
            "cells": len(setup.mesh.tets) // 5,
            "detail": f"residual {result.residual:.1e}",
            "result": result,
        }
    else:
        setup, model, answer = solved
        positions, quantities = (
            setup.mesh.vertices + answer.displacements,
            of_answer(setup, model, answer),
        )
        known |= {
            "status": answer.status,
            "message": answer.message,
            "seconds": answer.seconds,
            "cells": len(model.bricks),
            "detail": f"{answer.code} {answer.version} {answer.element}",
        }
    whole = task.voxel_size == voxel_size and len(positions) == len(
        experiments[0].setup.mesh.vertices if experiments else positions
    )
    stations = tuple(each.seen_at(positions) for each in experiments) if whole else ()
    return Run(**known, quantities=quantities, stations=stations)
