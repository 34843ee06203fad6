"""The job of a study, and studies read back from their folders."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

from voxsoft import files
from voxsoft.design import Constraint, Design, Objective
from voxsoft.errors import FileError, StudyError, VoxSoftError
from voxsoft.files.toml_text import write_toml
from voxsoft.metrics import METRICS
from voxsoft.simulation import check_solver, check_targets, simulate
from voxsoft.studio import events
from voxsoft.studio.commands import SpaceRange, StudySpec
from voxsoft.studio.progress import Progress
from voxsoft.studio.running import draw
from voxsoft.studio.task import Task
from voxsoft.study import Study, StudyResult, TrialEvent
from voxsoft.study.space import Choices, Range
from voxsoft.study.trial import Trial
from voxsoft.units import format_quantity


def run_study(task: Task, progress: Progress) -> str:
    """Run the study of a task in its folder, or go on with it; returns what came out."""
    spec = task.spec
    assert isinstance(spec, StudySpec)
    study = study_of(task, progress.folder)
    progress.parameters = list(study.space)
    progress.objectives = list(study.objectives)
    progress.directions = [each.direction for each in study.objectives.values()]
    total = study.grid_size if spec.sampler == "grid" else spec.budget
    before = study.result()
    progress.tell(trials_event(task.id, before))
    progress.at(len(before.trials), total)

    def tell(event: TrialEvent) -> None:
        progress.tell(trial_event(task.id, event.trial))
        best = "" if event.best is None else _said(study, event.best)
        progress.at(event.done, event.total, best=best)

    gate = progress.gate()
    try:
        if spec.sampler == "grid":
            study.grid(workers=spec.workers, progress=tell, gate=gate)
        else:
            study.optimize(
                spec.sampler,
                spec.budget,
                batch=spec.batch,
                workers=spec.workers,
                progress=tell,
                gate=gate,
            )
    finally:
        with suppress(VoxSoftError):
            result = study.result()
            progress.tell(trials_event(task.id, result))
            progress.doing("writing tables and figures")
            files.write_study(result, progress.folder)
            progress.doing("drawing the best design")
            _draw_best(study, result, progress.folder)
    found = study.result()
    good = sum(trial.feasible for trial in found.trials)
    best = "" if found.best is None else f"; best {_best_of(study, found.best)}"
    doubts = "".join(f" Warning: {warning}." for warning in found.warnings)
    return f"{len(found.trials)} designs, {good} of them good{best}.{doubts}"


def study_of(task: Task, folder: Path) -> Study:
    """Make the study of a task.

    Raises
    ------
    VoxSoftError
        It cannot be set up, or the folder holds another study.
    """
    spec = task.spec
    assert isinstance(spec, StudySpec)
    design = task.read_design()
    space: dict[str, object] | None = None
    if spec.space is not None:
        space = {name: _domain(given) for name, given in spec.space.items()}
    objectives = _targets(Objective, spec.objectives)
    constraints = _targets(Constraint, spec.constraints)
    study = Study(design, space, objectives, constraints, folder=folder, seed=spec.seed)
    targets = {"objectives": study.objectives, "constraints": study.constraints}
    check_targets(design.replace(**targets))
    check_solver(design)
    return study


def design_text_of(folder: Path) -> str:
    """Write the design that a study varies as a design file, where its folder holds none.

    Raises
    ------
    FileError
        The folder holds no study of a design.
    """
    try:
        told = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        family, targets = told["family"], ("objectives", "constraints")
        if "function" in family:
            raise FileError(str(folder), "varies a Python function, which has no design file")
        return write_toml({**family, **{name: told[name] for name in targets if told[name]}})
    except (OSError, ValueError, KeyError, TypeError) as error:
        if isinstance(error, VoxSoftError):
            raise
        raise FileError(str(folder), f"holds a damaged study: {error}") from None


def stored_study(folder: Path) -> StudyResult:
    """Read the trials of any study folder, also while another process writes it.

    Raises
    ------
    FileError
        The folder holds no study, or one that is damaged.
    StudyError
        The study is one of a Python function, whose designs only Python can make.
    """
    try:
        told = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        family = told["family"]
        if "function" in family:
            raise StudyError(str(folder), "varies a Python function", "open it from Python")
        design = Design.from_document(family)
        space: dict[str, object] = {
            name: Choices(**given) if "values" in given else Range(**given)
            for name, given in told["space"].items()
        }
        return Study(
            design,
            space,
            {name: Objective(**given) for name, given in told["objectives"].items()},
            {name: Constraint(**given) for name, given in told["constraints"].items()},
            folder=folder,
            seed=told["seed"],
        ).result()
    except OSError as error:
        raise FileError(str(folder), f"holds no study: {error.strerror}") from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        if isinstance(error, VoxSoftError):
            raise
        raise FileError(str(folder), f"holds a damaged study: {error}") from None


def stored_trial(folder: Path, number: str) -> Trial:
    """Read one trial of a study folder by its number.

    Raises
    ------
    FileError
        There is none.
    """
    found = next((each for each in stored_study(folder).trials if str(each.number) == number), None)
    if found is None:
        raise FileError(f"{folder.name}/{number}", "is no trial of that study")
    return found


def trial_event(job: str, trial: Trial, *, front: bool = False) -> events.Trial:
    """A trial as the page wants it."""
    return events.Trial(
        job=job,
        index=trial.number,
        parameters=dict(trial.parameters),
        objectives=dict(trial.objectives) or None,
        metrics=dict(trial.metrics),
        status=trial.status,
        seconds=trial.seconds,
        feasible=trial.feasible,
        front=front,
        message=". ".join(filter(None, (trial.message, *trial.warnings))),
    )


def trials_event(job: str, result: StudyResult) -> events.Trials:
    """All trials of a study as the page wants them."""
    front = {trial.number for trial in result.pareto_front} if result.ranking else set()
    kinds = dict(result.kinds)
    kinds |= {name: METRICS[each.metric].kind for name, each in result.objectives.items()}
    return events.Trials(
        job=job,
        parameters=list(result.parameters),
        objectives=list(result.objectives),
        directions=[each.direction for each in result.objectives.values()],
        kinds=kinds,
        trials=[trial_event(job, trial, front=trial.number in front) for trial in result.trials],
    )


def _domain(given: SpaceRange | list[Any]) -> object:
    if isinstance(given, list):
        return Choices(values=tuple(given))
    return Range(low=given.low, high=given.high, step=given.step, log=given.log)


def _targets(model: type[Any], given: dict[str, dict[str, Any]] | None) -> dict[str, Any] | None:
    return None if given is None else {name: model(**table) for name, table in given.items()}


def _said(study: Study, value: float) -> str:
    name, objective = next(iter(study.objectives.items()))
    return f"{name} {format_quantity(float(f'{value:.4g}'), METRICS[objective.metric].kind)}"


def _best_of(study: Study, trial: Trial) -> str:
    first = next(iter(study.objectives))
    return _said(study, trial.objectives[first])


def _draw_best(study: Study, result: StudyResult, folder: Path) -> None:
    """Solve the best design once more, for its picture."""
    if result.best is not None and isinstance(study.family, Design):
        draw(simulate(study.family.with_parameters(**result.best.parameters)), folder)
