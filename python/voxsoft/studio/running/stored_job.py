"""Jobs of the past, told from their folders as they were told when they ran."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import msgspec

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.cards import load_card_file
from voxsoft.jobs import load
from voxsoft.jobs.folder import holds_job
from voxsoft.materials import constants_of
from voxsoft.studio.protocol import events
from voxsoft.studio.running.job_journal import FINISHED, read_journal
from voxsoft.studio.running.runs import card_of, kind_of, read_summary
from voxsoft.studio.running.studying import stored_study, trials_event
from voxsoft.studio.running.subject import subject_of
from voxsoft.units import format_quantity


def stored_job(folder: Path) -> list[events.Event]:
    """All that a tab must be summary to show the study or calibration of a folder.

    Raises
    ------
    VoxSoftError
        The folder is damaged.
    """
    kind = kind_of(folder)
    if kind == "study":
        trials = trials_event(folder.name, stored_study(folder))
        return [*_subject(folder), *_last_state(folder, len(trials.trials)), trials]
    if kind != "calibrate":
        return []
    reported: list[events.Event] = [
        event for event in read_journal(folder) if not isinstance(event, events.Job)
    ]
    if not any(isinstance(event, events.Calibrated) for event in reported):
        with suppress(FileNotFoundError):
            reported = _from_summary(folder)
    return [*_subject(folder), *_last_state(folder), *reported]


def _subject(folder: Path) -> Iterator[events.Subject]:
    """The design of a job; nothing for a folder that tells no job, or one that cannot be read."""
    with suppress(VoxSoftError):
        subject = subject_of(load(folder, check=False).spec, folder.name)
        if subject is not None:
            yield subject


def _last_state(folder: Path, done: int | None = None) -> Iterator[events.Job]:
    """Last known state of a folder's job; nobody works on it now."""
    states = [event for event in read_journal(folder) if isinstance(event, events.Job)]
    if not states or not holds_job(folder):
        return
    last = states[-1]
    if last.state not in FINISHED:
        last = msgspec.structs.replace(
            last, state="interrupted", left=None, stage="", message="finished work is kept"
        )
    yield last if done is None else msgspec.structs.replace(last, done=done)


def _from_summary(folder: Path) -> list[events.Event]:
    """A calibration that was not run by the studio, from the files that every one leaves.

    They do not tell where its stations are in space, so that its shape is not overlaid.

    Raises
    ------
    FileNotFoundError
        It left none.
    FileError
        They are damaged.
    """
    summary = read_summary(folder)
    try:
        return [*_generations(folder.name, summary), *_result(folder, summary)]
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, VoxSoftError):
            raise
        raise FileError(str(folder), f"holds a damaged calibration: {error!r}") from None


def _generations(job: str, summary: dict[str, Any]) -> Iterator[events.Event]:
    for index, each in enumerate(summary["history"], start=1):
        yield events.Generation(
            job=job,
            index=index,
            best=each["best_fitness"],
            mean=each["mean_fitness"],
            error=each["best_error"],
            parameters=each["parameters"],
        )


def _result(folder: Path, summary: dict[str, Any]) -> Iterator[events.Event]:
    experiments = summary["experiments"]
    file = card_of(folder)
    if file is None:
        raise FileError(str(folder), "holds no material card")
    material = load_card_file(file).material
    kinds = constants_of(material)
    yield events.Calibrated(
        job=folder.name,
        parameters=[
            events.FittedParameter(
                name=name,
                value=value,
                kind=kinds[name],
                text=format_quantity(float(f"{value:.4g}"), kinds[name]),
                low=summary["bounds"][name][0],
                high=summary["bounds"][name][1],
                identifiable=summary["identifiable"].get(name),
                sentence=summary["intervals"].get(name, {}).get("sentence", "not asked"),
            )
            for name, value in summary["parameters"].items()
        ],
        table=[
            events.StationError(
                experiment=each["name"],
                station=station,
                measured=each["measured"][at],
                simulated=each["simulated"][at],
                error=each["errors"][at],
                percent=each["percent"][at],
            )
            for each in experiments
            for at, station in enumerate(each["stations"])
        ],
        quantities=experiments[0]["quantities"],
        identifiable=summary["identifiable"],
        fitness=summary["fitness"],
        mean_error=summary["mean_error"],
        max_error=summary["max_error"],
        material=material.model_dump(mode="json", exclude_none=True),
        card=file.read_text(encoding="utf-8"),
    )
