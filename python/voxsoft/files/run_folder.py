"""Run folders: output files of a simulation."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.document.documents import with_paths_from
from voxsoft.errors import ErrorDetail, FileError, OutputError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import read_text
from voxsoft.files.meshes import write_mesh
from voxsoft.files.toml_text import write_toml
from voxsoft.simulation import Result, named_regions

Floats = NDArray[np.float64]


def write_run(
    result: Result, folder: str | os.PathLike[str], *, more: Mapping[str, Any] | None = None
) -> Path:
    """Write a run folder: ``design.toml`` (resolved), ``summary.json`` and ``result.vtu``.

    The numbers are written first, so that a later failure does not lose them.

    Parameters
    ----------
    result
        Result to write.
    folder
        Folder to write; made if it does not exist, files in it are replaced.
    more
        Further entries of the summary.

    Raises
    ------
    OutputError
        The folder or some of its files cannot be written; the others are there.
    """
    folder = write_summary(result, folder, more=more)
    unwritten = Unwritten(folder)
    with unwritten.attempt("design.toml"):
        resolved = with_paths_from(result.design.resolved, folder)
        write_atomically(folder / "design.toml", write_toml(resolved))
    if len(result.recording.times) > 1:
        with unwritten.attempt("history.csv"):
            write_atomically(folder / "history.csv", _history_csv(result))
    with unwritten.attempt("result.vtu"):
        _write_fields(result, folder / "result.vtu")
    unwritten.raise_any()
    return folder


def write_summary(
    result: Result, folder: str | os.PathLike[str], *, more: Mapping[str, Any] | None = None
) -> Path:
    """Write the numbers of a run, ``summary.json``; see :func:`write_run` for the arguments."""
    folder = make_folder(folder)
    summary = result.summary() | {
        "design": result.design.name,
        "hash": result.design.hash,
        "voxel_size": result.design.voxel_size if result.design.mesh is None else None,
        **provenance(),
        **(more or {}),
    }
    write_json(folder / "summary.json", summary)
    return folder


def fields_in(result: Result) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Return the arrays of a result on vertices, (n, ...), and in tets, (m, ...), in SI units."""
    contact = result.contact_field
    points = {
        "displacement": result.displacements,
        "velocity": result.velocities,
        "reaction": result.reactions,
        **result.fields.point_data(),
        **({} if contact is None else contact.point_data()),
    }
    return points, result.fields.cell_data(result.mesh)


def _write_fields(result: Result, target: Path) -> None:
    points, cells = fields_in(result)
    regions = named_regions(result.design, result.mesh)
    write_mesh(target, result.mesh, point_data=points, cell_data=cells, regions=regions)


def read_summary(folder: Path) -> dict[str, Any]:
    """Read the numbers of a run, ``summary.json``.

    Raises
    ------
    FileError
        The file is missing or damaged.
    """
    file = folder / "summary.json"
    try:
        found = json.loads(read_text(file))
    except ValueError as error:
        raise FileError(str(file), f"is damaged: {error}", "run the design again") from None
    if not isinstance(found, dict):
        raise FileError(str(file), "is damaged: expected an object", "run the design again")
    return found


class Unwritten:
    """Collector of the errors of single files, so that the others of a folder are still written.

    Examples
    --------
    >>> unwritten = Unwritten(Path("runs/beam"))
    >>> with unwritten.attempt("body.png"):
    ...     raise ValueError("nothing to draw")
    >>> str(unwritten.problems[0])
    'runs/beam/body.png: was not written: nothing to draw. Try: the numbers are in summary.json \
beside it'
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._problems: list[ErrorDetail] = []

    @property
    def problems(self) -> tuple[ErrorDetail, ...]:
        """Path and error of each file that was not written."""
        return tuple(self._problems)

    @contextmanager
    def attempt(self, name: str) -> Iterator[None]:
        """Catch and collect any error while a file is written."""
        try:
            yield
        except OutputError as error:
            self._problems += error.problems
        except Exception as error:  # A finished run is not given up for one of its files.
            what = f"was not written: {error or type(error).__name__}"
            hint = "the numbers are in summary.json beside it"
            self._problems.append(ErrorDetail(str(self._folder / name), what, hint))

    def raise_any(self) -> None:
        """Raise one error for all of them, if there are any."""
        if self._problems:
            raise OutputError.listing(self._problems)


def provenance() -> dict[str, Any]:
    """Return versions and time of writing, for every record."""
    packages = ("voxsoft", "numpy", "optuna")
    return {
        "versions": {name: version(name) for name in packages},
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def make_folder(folder: str | os.PathLike[str]) -> Path:
    """Make a folder and its parents; raise :class:`OutputError` if that fails."""
    path = Path(folder)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(path), f"cannot be made a folder: {error.strerror}") from error
    return path


def write_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write an object as JSON; numbers that are not finite become null."""

    def plain(item: object) -> object:
        if isinstance(item, float):
            return item if np.isfinite(item) else None
        if isinstance(item, Mapping):
            return {str(key): plain(value) for key, value in item.items()}
        if isinstance(item, (list, tuple)):
            return [plain(value) for value in item]
        return item

    write_atomically(path, json.dumps(plain(value), indent=2, ensure_ascii=False) + "\n")


def _history_csv(result: Result) -> str:
    names = list(result.recording.probes)
    header = ["time_s", *(f"{name}_d{axis}_m" for name in names for axis in "xyz")]
    columns = [result.recording.times[:, None], *(result.recording.probes[name] for name in names)]
    for name, (positions, _) in result.recording.objects.items():
        header += [f"{name}_{axis}_m" for axis in "xyz"]
        columns.append(positions)
    for name, chamber in result.recording.chambers.items():
        header += [f"{name}_pressure_Pa", f"{name}_volume_m3", f"{name}_mass_kg"]
        columns.append(np.column_stack((chamber.pressure, chamber.volume, chamber.mass)))
    return csv_text(header, np.hstack(columns).tolist())


def csv_text(header: Iterable[str], rows: Iterable[Iterable[str | float]]) -> str:
    r"""Write a table as comma-separated text, numbers to nine digits, names quoted where needed.

    Examples
    --------
    >>> csv_text(["probe", "dx_m"], [["tip, left", 1 / 3]])
    'probe,dx_m\n"tip, left",0.333333333\n'
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([c if isinstance(c, str) else f"{c:.9g}" for c in row] for row in rows)
    return text.getvalue()
