"""Repetition of a job, and comparison of its results."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from voxsoft._shown import Shown
from voxsoft.errors import FileError, OutputError
from voxsoft.files.designs import FilePath
from voxsoft.jobs.differences import Difference, differences
from voxsoft.jobs.events import Listener, nobody
from voxsoft.jobs.folder import Job, load, machine
from voxsoft.jobs.outcome import JobOutcome
from voxsoft.jobs.runner import run_job
from voxsoft.jobs.spec import RunSpec

#: Number of differences that a printed repetition lists.
_SHOWN = 5


@dataclass(frozen=True, repr=False)
class Repetition(Shown):
    """Repetition of a job.

    Attributes
    ----------
    job
        Job that was repeated.
    folder
        Folder of the job.
    outcome
        Outcome of the repetition.
    differences
        Results that are not the same to the bit; empty where all are.
    """

    job: Job
    folder: Path
    outcome: JobOutcome[Any]
    differences: tuple[Difference, ...]

    def _lines(self) -> Iterator[str]:
        if self.same:
            yield f"{self.folder}: the same to the bit"
            return
        count = len(self.differences)
        yield f"{self.folder}: {count} result{'s' if count > 1 else ''} not the same"
        yield from (str(each) for each in self.differences[:_SHOWN])
        yield from self.reasons

    @property
    def same(self) -> bool:
        """True if all results are the same to the bit."""
        return not self.differences

    @property
    def reasons(self) -> tuple[str, ...]:
        """Changes since then that may be why results differ."""
        now = {"VoxSoft": version("voxsoft"), "machine": machine()}
        then = {"VoxSoft": self.job.version, "machine": self.job.machine}
        return tuple(
            f"the {name} was another: {then[name]} then, {now[name]} now"
            for name in now
            if then[name] and then[name] != now[name]
        )

    def summary(self) -> dict[str, Any]:
        """Plain data in SI units: summary of the job, ``same``, ``differences``, ``reasons``."""
        return self.outcome.summary | {
            "again": str(self.folder),
            "same": self.same,
            "differences": [each._asdict() for each in self.differences],
            "reasons": list(self.reasons),
        }


def again(folder: FilePath, out: FilePath | None = None, notify: Listener = nobody) -> Repetition:
    """Do the job of a folder again, in a new folder, and compare the results.

    Parameters
    ----------
    folder
        Folder that a run, study, calibration or comparison left. Nothing in it is changed.
    out
        The new folder, which must be empty; default: the same name with ``-again``.
    notify
        See :func:`voxsoft.jobs.run_job`.

    Returns
    -------
    Repetition
        Repetition whose :attr:`~Repetition.same` is True if every result is the same to the bit.

    Raises
    ------
    FileError
        No job in the folder, a file of the job that is missing or was changed, a state that was
        kept from the screen and which no job can repeat, or a new folder that is not empty.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from voxsoft.design import families
    >>> from voxsoft.jobs import RunSpec, run_job
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     first = run_job(RunSpec(design=families.beam()), Path(folder, "beam"))
    ...     again(first.folder).same
    True
    """
    place = Path(folder)
    job = load(place)
    if isinstance(job.spec, RunSpec) and job.spec.kept:
        raise FileError(
            str(place),
            "was kept from the studio's screen, with what hands did to it: no job made it",
            f"solve its design, `voxsoft run {place / 'inputs' / 'design.toml'}`",
        )
    target = _free(place) if out is None else _empty(Path(out))
    outcome = run_job(job.spec, target, notify)
    return Repetition(job, place, outcome, tuple(differences(place, target)))


def _free(place: Path) -> Path:
    """Name a new folder beside one, with its name and ``-again``."""
    whole = place.absolute()
    names = (f"{whole.name}-again{'' if at == 1 else f'-{at}'}" for at in range(1, 10_000))
    beside = place.parent if place.name else whole.parent
    return next(beside / name for name in names if not (beside / name).exists())


def _empty(target: Path) -> Path:
    if target.is_dir() and any(target.iterdir()):
        raise OutputError(str(target), "is not empty", "name a new folder")
    return target
