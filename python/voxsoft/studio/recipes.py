"""How a job can be done again without the studio: as Python, and as a command line."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.studio import events
from voxsoft.studio.commands import CalibrateSpec, RunSpec, SpaceRange, StudySpec
from voxsoft.studio.runs import read_summary
from voxsoft.studio.task import DESIGN, Task
from voxsoft.units import format_quantity

_INDENT = "    "


def recipe_of(folder: Path) -> events.Recipe:
    """Tell how the job of a folder can be done again.

    Raises
    ------
    FileError
        The studio did not start it.
    """
    task = Task.read(folder)
    design = folder / DESIGN
    match task.spec:
        case RunSpec() as run:
            python, command = _run(run, design), _run_command(run, design)
        case StudySpec() as study:
            python = _study(study, design, folder.name)
            command = _study_command(study, design, task.read_design())
        case CalibrateSpec() as calibration:
            tables = task.measured_files(folder)
            python = _calibration(calibration, design, tables)
            command = _calibration_command(calibration, design, tables)
    told: Mapping[str, Any] = {}
    with suppress(OSError, VoxSoftError):  # not ended yet, or not well
        told = read_summary(folder)
    return events.Recipe(
        job=folder.name,
        python=python,
        command="" if command is None else shlex.join(["voxsoft", *command]),
        seed=getattr(task.spec, "seed", None),
        version=str(told.get("versions", {}).get("voxsoft", task.version)),
    )


def _run(spec: RunSpec, design: Path) -> str:
    settings = "".join(f", {name}={value!r}" for name, value in spec.solver.items())
    return (
        "import voxsoft as vs\n\n"
        f"result = vs.simulate(vs.load({str(design)!r}){settings})\n"
        "print(result.status, result.metrics)\n"
    )


def _run_command(spec: RunSpec, design: Path) -> list[str] | None:
    if set(spec.solver) - {"method"}:
        return None
    solver = ["--solver", str(spec.solver["method"])] if spec.solver else []
    return ["run", str(design), *solver]


def _study(spec: StudySpec, design: Path, name: str) -> str:
    arguments = [f"vs.load({str(design)!r})"]
    if spec.space is not None:
        space = {each: _domain(given) for each, given in spec.space.items()}
        arguments.append(f"space={space!r}")
    for role, given in (("objectives", spec.objectives), ("constraints", spec.constraints)):
        if given is not None:
            arguments.append(f"{role}={given!r}")
    # A folder of its own: the one of the studio holds these trials already.
    arguments += [f"folder={f'{name}-again'!r}", f"seed={spec.seed}"]
    if spec.sampler == "grid":
        search = f"study.grid({_given(workers=spec.workers)})"
    else:
        more = _given(batch=spec.batch, workers=spec.workers)
        search = f"study.optimize({spec.sampler!r}, {spec.budget}{', ' if more else ''}{more})"
    inner = [f"study = vs.Study(\n{_lines(arguments, 2)}{_INDENT})", f"result = {search}"]
    body = "".join(f"{_INDENT}{line}\n" for line in [*inner, "print(result.best)"])
    # The worker processes import the script: they must not start the study again.
    return f'import voxsoft as vs\n\nif __name__ == "__main__":\n{body}'


def _study_command(spec: StudySpec, design: Path, family: Design) -> list[str] | None:
    """The command, or None where the command line has no option for what was chosen."""
    if spec.objectives is not None or spec.constraints is not None or spec.batch is not None:
        return None
    changes = _changes(spec.space, family)
    if changes is None:
        return None
    sets = [word for change in changes for word in ("--set", change)]
    workers = [] if spec.workers is None else ["--workers", str(spec.workers)]
    if spec.sampler == "grid":
        return ["sweep", str(design), *sets, *workers]
    search = ["--sampler", spec.sampler, "--budget", str(spec.budget), "--seed", str(spec.seed)]
    return ["optimize", str(design), *search, *sets, *workers]


def _changes(
    space: Mapping[str, SpaceRange | list[Any]] | None, family: Design
) -> list[str] | None:
    """What must be set for the design's own ranges to be those of a study; None: impossible."""
    if space is None:
        return []
    ranged = {
        name
        for name, parameter in family.parameters.items()
        if parameter.min is not None and parameter.max is not None
    }
    if set(space) != ranged:
        return None
    changes = []
    for name, given in space.items():
        if isinstance(given, list) or given.log:
            return None
        parameter = family.parameters[name]
        if given.step is None and parameter.step is not None:
            return None
        for key, wanted in (("min", given.low), ("max", given.high), ("step", given.step)):
            if wanted is not None and wanted != getattr(parameter, key):
                text = format_quantity(wanted, parameter.kind)
                changes.append(f"parameters.{name}.{key}={text}")
        value = parameter.value
        if not (isinstance(value, (int, float)) and given.low <= value <= given.high):
            # A design must be a member of its own family; all members are tried anyway.
            changes.append(f"{name}={format_quantity(given.low, parameter.kind)}")
    return changes


def _calibration(
    spec: CalibrateSpec, design: Path, tables: Sequence[tuple[Path, str | None]]
) -> str:
    read = [
        f"vs.Measurement.read({str(file)!r}{'' if select is None else f', select={select!r}'})"
        for file, select in tables
    ]
    arguments = ["[vs.Experiment(design, each) for each in measured]", repr(spec.method)]
    if spec.bounds is not None:
        arguments.append(f"parameters={spec.bounds!r}")
    for name in ("free_scale", "seed", "generations", "population", "refine", "identify"):
        arguments.append(f"{name}={getattr(spec, name)!r}")
    return (
        "import voxsoft as vs\n\n"
        f"design = vs.load({str(design)!r})\n"
        f"measured = [\n{_lines(read, 1)}]\n"
        f"found = vs.calibrate(\n{_lines(arguments, 1)})\n"
        "print(found.parameters, found.mean_error)\n"
    )


def _calibration_command(
    spec: CalibrateSpec, design: Path, tables: Sequence[tuple[Path, str | None]]
) -> list[str] | None:
    chosen = {select for _, select in tables}
    if spec.bounds is not None or not spec.refine or not spec.identify or len(chosen) > 1:
        return None
    material = [word for select in chosen if select is not None for word in ("--material", select)]
    return [
        "calibrate",
        str(design),
        *(str(file) for file, _ in tables),
        *("--method", spec.method),
        *("--generations", str(spec.generations), "--population", str(spec.population)),
        *("--seed", str(spec.seed)),
        *material,
        *(["--free-scale"] if spec.free_scale else []),
    ]


def _domain(given: SpaceRange | list[Any]) -> object:
    if isinstance(given, list):
        return given
    if given.log:
        return (given.low, given.high, "log")
    ends = (given.low, given.high)
    return ends if given.step is None else (*ends, given.step)


def _given(**settings: object) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in settings.items() if value is not None)


def _lines(items: Sequence[str], depth: int) -> str:
    return "".join(f"{_INDENT * depth}{item},\n" for item in items)
