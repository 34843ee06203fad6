"""Job of a study: many designs, stage after stage."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from voxsoft import files
from voxsoft.comparison import Confirmation, confirm
from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.files.figures import save_thumbnail
from voxsoft.jobs.events import Listener, Progress, StudyStanding
from voxsoft.jobs.folder import kind_of_job, load, write_job
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.spec import Stage, StudySpec
from voxsoft.metrics import METRICS
from voxsoft.simulation import Result, Setup, check_solver, check_targets, simulate
from voxsoft.study import Study, StudyResult, TrialEvent
from voxsoft.study.equilibria import FOLDER, Equilibria
from voxsoft.study.event import ProgressCallback
from voxsoft.study.gate import Gate
from voxsoft.study.trial import Trial
from voxsoft.units import format_quantity

_DESIGNS = "designs"


def run_study(
    spec: StudySpec,
    folder: Path,
    notify: Listener,
    *,
    gate: Gate | None = None,
    scheduler: str | None = None,
    storage: str | None = None,
) -> JobOutcome[StudyResult]:
    """Run the study of a spec in its folder, or go on with it."""
    study = study_of(spec, folder, storage)
    spec = spec.replace(earlier=_earlier(spec, folder, study.begun))
    write_job(spec, folder)
    before = study.result()
    notify(StudyStanding(study, before))
    total = study.grid_size if spec.sampler == "grid" else spec.budget or 0
    notify(Progress(len(before.trials), total, _DESIGNS))

    def report(event: TrialEvent) -> None:
        notify(event)
        best = "" if event.best is None else _in_words(study, event.best)
        doubtful = ", doubtful" if best and event.doubts else ""
        notify(Progress(event.done, max(event.total, total), _DESIGNS, best=best + doubtful))

    finished = False
    try:
        stages: tuple[Stage | StudySpec, ...] = (*spec.earlier, spec)
        for stage in stages:
            _search(study, stage, spec.workers, report, gate, scheduler)
        finished = True
    finally:
        # Finished trials are also written if the study was stopped or failed.
        if not finished:
            with suppress(VoxSoftError):
                _write(study, folder, notify)
    result, written = _write(study, folder, notify)
    _draw_best(study, result, folder, notify)
    confirmed = _confirmed(spec, study, result, notify)
    if confirmed is not None:
        written = [*written, files.write_confirmation(confirmed, folder)]
    return JobOutcome(
        folder, result, _sentence(study, result), tuple(written), len(before.trials), confirmed
    )


def study_of(spec: StudySpec, folder: Path, storage: str | None = None) -> Study:
    """Make the study of a spec.

    Raises
    ------
    VoxSoftError
        It cannot be set up, or the folder holds another study.
    """
    design = spec.design.read()
    space: dict[str, object] | None = None if spec.space is None else dict(spec.space)
    study = Study(
        design,
        space,
        spec.objectives,
        spec.constraints,
        folder=folder,
        storage=storage,
        seed=spec.seed,
        over=spec.over,
    )
    # A target that cannot be measured, or a setting that is not used, would fail every trial.
    check_targets(design.replace(objectives=study.objectives, constraints=study.constraints))
    check_solver(design)
    return study


def _earlier(spec: StudySpec, folder: Path, held: int) -> tuple[Stage, ...]:
    """Return the earlier stages of a study that holds some trials."""
    before = None
    if kind_of_job(folder) == "study":
        with suppress(VoxSoftError):
            before = load(folder, check=False).spec
    if not isinstance(before, StudySpec) or held == 0:
        return spec.earlier
    same_search = (before.sampler, before.batch) == (spec.sampler, spec.batch)
    # The last batch of a stage is cut at its budget; a stage that did not come so far counts as
    # continued.
    cut = before.budget is not None and held >= before.budget
    goes_on = same_search and (not cut or before.budget == spec.budget)
    if goes_on and (spec.budget is None or spec.budget >= held):
        return before.earlier
    return (*before.earlier, Stage(sampler=before.sampler, budget=held, batch=before.batch))


def _search(
    study: Study,
    stage: StudySpec | Stage,
    workers: int | None,
    report: ProgressCallback,
    gate: Gate | None,
    scheduler: str | None,
) -> None:
    if isinstance(stage, Stage) and study.begun >= stage.budget:
        return
    if stage.sampler == "grid":
        study.grid(workers=workers, scheduler=scheduler, progress=report, gate=gate)
        return
    study.optimize(
        stage.sampler,
        stage.budget or 0,
        batch=stage.batch,
        workers=workers,
        scheduler=scheduler,
        progress=report,
        gate=gate,
    )


def _write(study: Study, folder: Path, notify: Listener) -> tuple[StudyResult, list[Path]]:
    result = study.result()
    notify(StudyStanding(study, result))
    notify(_ended(study, result, "writing tables and figures"))
    return result, files.write_study(result, folder)


def _draw_best(study: Study, result: StudyResult, folder: Path, notify: Listener) -> None:
    """Draw the best design at rest; ignore errors, so that the study does not fail."""
    if result.best is None or not isinstance(study.family, Design):
        return
    notify(_ended(study, result, "drawing the best design"))
    design = study.family.with_parameters(**result.best.parameters)
    with suppress(VoxSoftError):
        save_thumbnail(_at_rest(design, folder), folder)


def _at_rest(design: Design, folder: Path) -> Result:
    """Return the equilibrium of a design of a study, from the study's storage if it is there."""
    setup = Setup.of(design)
    found = Equilibria(folder / FOLDER).find(design.hash, setup.mesh)
    return (None if found is None else found.result(setup)) or simulate(setup)


def _confirmed(
    spec: StudySpec, study: Study, result: StudyResult, notify: Listener
) -> Confirmation | None:
    if not spec.confirm or not result.ranking or not isinstance(study.family, Design):
        return None
    return confirm(
        study.family,
        result,
        count=spec.confirm,
        progress=lambda done, total: notify(Progress(done, total, "confirmations")),
    )


def _ended(study: Study, result: StudyResult, stage: str) -> Progress:
    done = len(result.trials)
    best = "" if result.best is None else _objective_of(study, result.best)
    return Progress(done, done, _DESIGNS, stage, best)


def _sentence(study: Study, found: StudyResult) -> str:
    good = sum(trial.feasible for trial in found.trials)
    best = "" if found.best is None else f"; best {_objective_of(study, found.best)}"
    doubts = "".join(f" Warning: {warning}." for warning in found.warnings)
    return f"{len(found.trials)} designs, {good} of them good{best}.{doubts}"


def _objective_of(study: Study, trial: Trial) -> str:
    return _in_words(study, trial.objectives[next(iter(study.objectives))])


def _in_words(study: Study, value: float) -> str:
    name, objective = next(iter(study.objectives.items()))
    return f"{name} {format_quantity(float(f'{value:.4g}'), METRICS[objective.metric].kind)}"
