"""The list of runs: contents of all folders of runs, studies and calibrations."""

from __future__ import annotations

import json
import re
import shutil
import tomllib
from collections.abc import Callable
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final, Literal

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.calibrations import NOT_CARDS
from voxsoft.files.figures import THUMBNAIL
from voxsoft.files.run_folder import make_folder
from voxsoft.jobs.comparing import REPORT
from voxsoft.jobs.folder import holds_job, kind_of_job
from voxsoft.metrics import METRICS
from voxsoft.studio.protocol import events
from voxsoft.units import format_quantity

#: Folder of deleted folders, from which they can come back.
TRASH: Final = "trash"
#: Pictures that stand for a folder, the best first.
PICTURES: Final = (THUMBNAIL, "body.png", "shape.png", "scatter.png", "history.png")
#: Largest summary that is read [bytes].
_LARGEST: Final = 20_000_000

Kind = Literal["run", "study", "calibrate", "unknown"]

#: Kinds that the studio can repeat itself.
_DONE_HERE: Final[tuple[Literal["run", "study", "calibrate"], ...]] = ("run", "study", "calibrate")


class RunList:
    """The folders below one.

    Parameters
    ----------
    folder
        The folder of the runs.
    own
        The studio's own folder, which holds the trash.
    busy
        Tells whether a job works in a folder.
    """

    def __init__(self, folder: Path, own: Path, busy: Callable[[Path], bool]) -> None:
        self._folder, self._trash, self._busy = folder, own / TRASH, busy

    def event(self) -> events.Runs:
        """All folders, newest first; one that cannot be read is listed as such."""
        return events.Runs(
            rows=self._rows(self._folder), trash=self._rows(self._trash), folder=str(self._folder)
        )

    def folder_of(self, name: str) -> Path:
        """The folder of a run.

        Raises
        ------
        FileError
            There is none of that name.
        """
        return self._existing(self._folder, name)

    def rename(self, name: str, new: str) -> Path:
        """Give a folder another name.

        Raises
        ------
        FileError
            No such folder, a name that no folder can have or that is taken, or a job in it.
        """
        before = self._idle(self.folder_of(name))
        after = self._folder / _plain(new)
        if after.exists():
            raise FileError(new, "is the name of another run", "choose another name")
        _move(before, after)
        return after

    def delete(self, name: str) -> None:
        """Move a folder to the trash.

        Raises
        ------
        FileError
            No such folder, or a job works in it.
        """
        folder = self._idle(self.folder_of(name))
        make_folder(self._trash)
        _move(folder, _free(self._trash, folder.name))

    def restore(self, name: str) -> None:
        """Take a folder out of the trash.

        Raises
        ------
        FileError
            It is not there.
        """
        folder = self._existing(self._trash, name)
        _move(folder, _free(self._folder, folder.name))

    def picture(self, name: str) -> Path | None:
        """The picture of a folder, or None."""
        with suppress(FileError):
            return _picture(self.folder_of(name))
        return None

    def _rows(self, folder: Path) -> list[events.RunRow]:
        rows = []
        with suppress(OSError):
            for entry in sorted(folder.iterdir()):
                if entry.is_dir() and not entry.name.startswith("."):
                    rows.append(self._row(entry))
        return sorted(rows, key=lambda row: row.when, reverse=True)

    def _row(self, folder: Path) -> events.RunRow:
        kind, summary, message = _content(folder)
        status, best, seconds, trials = "broken", "", None, None
        if not message:
            try:
                status, best, seconds, trials = _summed_up(kind, summary, folder)
            except (KeyError, TypeError, ValueError, AttributeError) as error:
                message = f"the summary is damaged: {error}"
        if self._busy(folder):
            status, message = "running", ""
        return events.RunRow(
            id=folder.name,
            kind=kind,
            name=folder.name,
            status=status,
            best=best,
            when=_when(folder, summary),
            seconds=seconds,
            folder=str(folder),
            thumbnail=f"/thumbnail/{folder.name}" if _picture(folder) else None,
            message=message,
            trials=trials,
            again=kind in _DONE_HERE and holds_job(folder),
        )

    def _existing(self, parent: Path, name: str) -> Path:
        folder = parent / _plain(name)
        if not folder.is_dir():
            raise FileError(name, "is not in the list of runs any more", "reload the list")
        return folder

    def _idle(self, folder: Path) -> Path:
        if self._busy(folder):
            raise FileError(folder.name, "is being worked in", "stop its job first")
        return folder


def kind_of(folder: Path) -> Kind:
    """Kind of a folder, judged by the files in it."""
    kind = kind_of_job(folder)
    if kind == "compare":
        return "unknown"
    if kind in _DONE_HERE:
        return kind
    if (folder / "study.json").is_file() or (folder / "study.journal").is_file():
        return "study"
    if (folder / "shapes.csv").is_file():
        return "calibrate"
    return "run" if (folder / "design.toml").is_file() else "unknown"


def card_of(folder: Path) -> Path | None:
    """The material card that a calibration left in its folder, or None."""
    return next(
        (file for file in sorted(folder.glob("*.toml")) if file.name not in NOT_CARDS), None
    )


def read_summary(folder: Path) -> dict[str, Any]:
    """Read the summary of a folder.

    Raises
    ------
    FileError
        It is damaged, or none of VoxSoft's.
    FileNotFoundError
        There is none.
    """
    file = folder / "summary.json"
    if file.stat().st_size > _LARGEST:
        raise FileError(str(file), "is too large for a summary")
    try:
        summary = json.loads(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise FileError(str(file), f"is damaged: {error}") from None
    if not isinstance(summary, dict):
        raise FileError(str(file), "is damaged: expected an object")
    return summary


def _content(folder: Path) -> tuple[Kind, dict[str, Any], str]:
    """Kind and summary of a folder, and its problem if it has one."""
    kind = kind_of(folder)
    if kind == "unknown" and (folder / REPORT).is_file():
        return kind, {}, f"a comparison: open {REPORT} in its folder"
    if kind == "unknown":
        return kind, {}, "holds neither a run nor a study"
    try:
        return kind, read_summary(folder), ""
    except FileNotFoundError:
        return kind, {}, ""
    except (OSError, VoxSoftError) as error:
        return kind, {}, str(error)


def _summed_up(
    kind: Kind, summary: dict[str, Any], folder: Path
) -> tuple[str, str, float | None, int | None]:
    """Status, best value, seconds and number of trials."""
    if not summary:
        return "interrupted", "", None, None
    if kind == "run":
        return (
            str(summary["status"]),
            _best_of_run(summary, folder),
            float(summary["seconds"]),
            None,
        )
    if kind == "study":
        best = summary["best"]
        shown = "" if best is None else _with_units(best["objectives"], folder)
        return "ok" if best else "no design", shown, None, int(summary["trials"])
    return "ok", f"mean error {_length(summary['mean_error'])}", None, int(summary["evaluations"])


def _best_of_run(summary: dict[str, Any], folder: Path) -> str:
    own = {name: value for name, value in summary["metrics"].items() if name not in METRICS}
    if own:
        return _with_units(own, folder)
    return f"largest displacement {_length(summary['metrics']['max_displacement'])}"


def _with_units(values: dict[str, float], folder: Path) -> str:
    """Objectives with the units of their metrics, as far as the folder names the metrics."""
    kinds: dict[str, str] = {}
    with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
        if (folder / "study.json").is_file():
            summary = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        else:
            summary = tomllib.loads((folder / "design.toml").read_text(encoding="utf-8"))
        for name, target in summary["objectives"].items():
            kinds[name] = METRICS[target.get("maximize") or target["minimize"]].kind
    return ", ".join(
        f"{name} {format_quantity(float(f'{value:.4g}'), kinds.get(name, 'number'))}"
        for name, value in values.items()
    )


def _length(value: float) -> str:
    return format_quantity(float(f"{value:.3g}"), "length")


def _when(folder: Path, summary: dict[str, Any]) -> str:
    written = summary.get("written")
    if isinstance(written, str):
        return written
    with suppress(OSError):
        return datetime.fromtimestamp(folder.stat().st_mtime, UTC).isoformat(timespec="seconds")
    return ""


def _picture(folder: Path) -> Path | None:
    return next((folder / name for name in PICTURES if (folder / name).is_file()), None)


def _plain(name: str) -> str:
    """A name that stays in its folder.

    Raises
    ------
    FileError
        Any other.
    """
    if (
        not re.fullmatch(r"[^/\\\0-\x1f\x7f:*?\"<>|]{1,120}", name)
        or name.startswith(".")
        or not name.strip()
    ):
        raise FileError(name[:80] or "name", "is no name for a folder", "use letters and digits")
    return name


def _free(parent: Path, name: str) -> Path:
    """A folder of a name, numbered if it is taken."""
    for number in range(1, 10_000):
        folder = parent / (name if number == 1 else f"{name}-{number}")
        if not folder.exists():
            return folder
    raise FileError(str(parent), f'has too many folders called "{name}"')


def _move(before: Path, after: Path) -> None:
    try:
        shutil.move(before, after)
    except OSError as error:
        raise FileError(before.name, f"cannot be moved: {error.strerror or error}") from None
