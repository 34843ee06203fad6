"""Studies as the page wants them, and read back from their folders."""

from __future__ import annotations

import json
from pathlib import Path

from voxsoft.design import Constraint, Design, Objective
from voxsoft.design.document.documents import with_absolute_paths
from voxsoft.errors import FileError, StudyError, VoxSoftError
from voxsoft.files.toml_text import write_toml
from voxsoft.metrics import METRICS
from voxsoft.studio.protocol import events
from voxsoft.study import Study, StudyResult
from voxsoft.study.space import Choices, Range
from voxsoft.study.trial import Trial


def design_text_of(folder: Path) -> str:
    """Write the design that a study varies as a design file, where its folder holds none.

    Raises
    ------
    FileError
        The folder holds no study of a design.
    """
    try:
        summary = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        family, targets = summary["family"], ("objectives", "constraints")
        if "function" in family:
            raise FileError(str(folder), "varies a Python function, which has no design file")
        asked = {name: summary[name] for name in targets if summary[name]}
        return write_toml(with_absolute_paths({**family, **asked}, folder))
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
        summary = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        family = summary["family"]
        if "function" in family:
            raise StudyError(str(folder), "varies a Python function", "open it from Python")
        design = Design.from_document(with_absolute_paths(family, folder))
        space: dict[str, object] = {
            name: Choices(**given) if "values" in given else Range(**given)
            for name, given in summary["space"].items()
        }
        return Study(
            design,
            space,
            {name: Objective(**given) for name, given in summary["objectives"].items()},
            {name: Constraint(**given) for name, given in summary["constraints"].items()},
            folder=folder,
            seed=summary["seed"],
            over=summary.get("over"),
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
    kinds |= {name: METRICS[each.metric].kind for name, each in result.constraints.items()}
    return events.Trials(
        job=job,
        parameters=list(result.parameters),
        objectives=list(result.objectives),
        directions=[each.direction for each in result.objectives.values()],
        kinds=kinds,
        trials=[trial_event(job, trial, front=trial.number in front) for trial in result.trials],
        constraints=[
            events.Bound(name=name, metric=each.metric, min=each.min, max=each.max)
            for name, each in result.constraints.items()
        ],
        space={
            name: events.TriedRange(
                low=domain.low, high=domain.high, step=domain.step, log=domain.log
            )
            for name, domain in result.space.items()
            if isinstance(domain, Range)
        },
    )
