"""Folder of a job: ``job.toml``, and the files that the job needs beside it."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterator, Mapping
from contextlib import suppress
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path, PurePosixPath
from typing import Any, ClassVar, Final

from pydantic import Field

from voxsoft.errors import FileError, VoxSoftError
from voxsoft.files.atomic import write_atomically
from voxsoft.files.designs import FilePath, read_document, read_text
from voxsoft.files.run_folder import make_folder
from voxsoft.files.toml_text import write_toml
from voxsoft.jobs.copies import design_file
from voxsoft.jobs.first_version import FIRST, read_first
from voxsoft.jobs.spec import Spec, TaggedSpec
from voxsoft.records import FrozenDict, Record
from voxsoft.records.table import Table
from voxsoft.units import EXACT

#: File name of a job's spec.
JOB: Final = "job.toml"
SCHEMA: Final = "voxsoft-job/1"
#: Name of the folder of the measured tables.
MEASURED: Final = "measured"

_HEAD: Final = """\
# A job of VoxSoft. `voxsoft again FOLDER` does it once more and says whether the results are the
# same. Paths are those of files in this folder, which can be moved; [files] holds the SHA-256 of
# each, so that a change is noticed.
"""


class Job(Record):
    """A job as its folder keeps it.

    Attributes
    ----------
    spec
        Spec of the job.
    version, machine, written
        VoxSoft version, machine and time of the last start; empty where that is not known.
    """

    error_type: ClassVar[type[VoxSoftError]] = FileError

    spec: TaggedSpec
    version: str = ""
    machine: str = ""
    written: str = ""


class _File(Record):
    """Content of ``job.toml``."""

    error_type: ClassVar[type[VoxSoftError]] = FileError

    schema_: str = Field(alias="schema")
    version: str = ""
    machine: str = ""
    written: str = ""
    job: Table[str, Any]
    files: Table[str, str] = Field(default_factory=FrozenDict)


def machine() -> str:
    """Describe the machine, as far as it may change the last bits of a number.

    Examples
    --------
    >>> machine() == machine()
    True
    """
    return " ".join(filter(None, (platform.system(), platform.machine(), platform.processor())))


def write_job(spec: Spec, folder: Path) -> None:
    """Write a job to its folder: its design, its measured tables and ``job.toml``.

    Parameters
    ----------
    spec
        Spec of the job, with the copies of :func:`voxsoft.jobs.copies.with_copies`.
    folder
        Folder to write; made if it does not exist.

    Raises
    ------
    FileError
        A file cannot be written.
    """
    folder = folder.absolute()
    texts = {design_file(spec.kind): spec.design.text}
    texts |= {_table_file(at): table.text for at, table in enumerate(spec.tables, start=1)}
    for name, text in texts.items():
        make_folder((folder / name).parent)
        write_atomically(folder / name, text)
    copies = [file for file in spec.design.files().values() if file.is_relative_to(folder)]
    digests = {name: _digest(text.encode()) for name, text in texts.items()}
    digests |= {
        file.relative_to(folder).as_posix(): _digest(file.read_bytes())
        for file in copies
        if file.is_file()
    }
    document = {
        "schema": SCHEMA,
        "version": version("voxsoft"),
        "machine": machine(),
        "written": datetime.now(UTC).isoformat(timespec="seconds"),
        "job": _plain(spec),
        "files": digests,
    }
    write_atomically(folder / JOB, _HEAD + write_toml(document))


def load(folder: FilePath, *, check: bool = True) -> Job:
    """Read the job of a folder.

    Parameters
    ----------
    folder
        Folder that a run, study, calibration or comparison left, or works in.
    check
        True to require that the files of the job are unchanged.

    Returns
    -------
    Job
        Job with everything it needs; the folder may have moved since it was written.

    Raises
    ------
    FileError
        No job, a damaged one, or a file that is missing or was changed.

    Examples
    --------
    >>> import tempfile
    >>> from voxsoft.design import families
    >>> from voxsoft.jobs import RunSpec, run_job
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = run_job(RunSpec(design=families.beam()), folder)
    ...     load(folder).spec.kind
    'run'
    """
    place = Path(folder).absolute()
    if not (place / JOB).is_file() and (place / FIRST).is_file():
        return Job(**read_first(place))
    if not (place / JOB).is_file():
        hint = "name the folder of a run, a study, a calibration or a comparison"
        raise FileError(str(folder), f"holds no {JOB}", hint)
    content = _read(place)
    if check:
        for name, digest in content.files.items():
            _check_file(place, name, digest)
    fields = {name: getattr(content, name) for name in ("version", "machine", "written")}
    return Job(spec=_spec(content.job, place), **fields)


def holds_job(folder: Path) -> bool:
    """Return True if a folder holds the spec of its results."""
    return (folder / JOB).is_file() or (folder / FIRST).is_file()


def kind_of_job(folder: Path) -> str | None:
    """Return the kind of a folder's job, or None."""
    with suppress(VoxSoftError):
        if (folder / JOB).is_file():
            return str(_read(folder).job.get("kind"))
        return load(folder, check=False).spec.kind
    return None


def _plain(spec: Spec) -> dict[str, Any]:
    content = spec.model_dump(
        mode="json", by_alias=True, exclude={"design", "data"}, exclude_none=True, context=EXACT
    )
    content = {"kind": content.pop("kind"), "design": design_file(spec.kind), **content}
    if spec.tables:
        content["data"] = [
            {"file": _table_file(at), **table.model_dump(exclude={"text"}, exclude_none=True)}
            for at, table in enumerate(spec.tables, start=1)
        ]
    return content


def _read(place: Path) -> _File:
    where = str(place / JOB)
    content = read_document(read_text(place / JOB), where)
    schema = content.get("schema")
    if schema != SCHEMA:
        what = f'is written as "{schema}"; expected "{SCHEMA}"'
        raise FileError(where, what, "use the VoxSoft that wrote it")
    try:
        return _File(**content)
    except FileError as error:
        raise FileError.listing(_inside(error, where)) from None


def _spec(content: Mapping[str, Any], place: Path) -> Spec:
    where = str(place / JOB)
    fields = dict(content)
    try:
        file = _within(place, fields.pop("design"))
        fields["design"] = {"text": read_text(file), "folder": str(file.parent)}
        if "data" in fields:
            fields["data"] = [
                {**{k: v for k, v in each.items() if k != "file"}, "text": read_text(found)}
                for each in fields["data"]
                for found in [_within(place, each["file"])]
            ]
        return Job(spec=fields).spec
    except (KeyError, TypeError, AttributeError) as error:
        raise FileError(where, f"is damaged: {error!r}") from None
    except VoxSoftError as error:
        raise FileError.listing(_inside(error, where)) from None


def _inside(error: VoxSoftError, where: str) -> Iterator[Any]:
    for problem in error.problems:
        inner = problem.where if problem.where.startswith(where) else f"{where}, {problem.where}"
        yield problem._replace(where=inner.removesuffix(", "))


def _check_file(place: Path, name: str, digest: str) -> None:
    file = _within(place, name)
    try:
        content = file.read_bytes()
    except OSError as error:
        what = f"is missing: {error.strerror}; the job needs it"
        raise FileError(str(file), what, "put it back") from None
    if _digest(content) != digest:
        what = "was changed since the job was begun"
        raise FileError(str(file), what, "undo the change, or run what it holds now as a new job")


def _within(place: Path, name: object) -> Path:
    """Return a file inside the folder; no other is ever read."""
    if not isinstance(name, str) or ".." in (path := PurePosixPath(name)).parts:
        raise FileError(str(place / JOB), f"names {name!r}, which is not in the folder")
    if path.is_absolute():
        raise FileError(str(place / JOB), f'names "{name}", which is not in the folder')
    return place / path


def _table_file(number: int) -> str:
    return f"{MEASURED}/{number}.csv"


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
