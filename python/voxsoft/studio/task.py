"""What a job is to do, as the folder of the job keeps it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import msgspec

from voxsoft.design import Design
from voxsoft.design.documents import with_whole_paths
from voxsoft.errors import FileError
from voxsoft.files.designs import read_document
from voxsoft.files.run_folder import make_folder
from voxsoft.files.whole import write_whole
from voxsoft.studio.commands import CalibrateSpec, RunSpec, StudySpec
from voxsoft.studio.events import JobKind

#: The file that holds a task.
TASK: Final = "job.json"
#: The folder of the measured tables, mapped already.
MEASURED: Final = "measured"
#: The text of the design, as it was when the job began.
DESIGN: Final = "design.toml"


class Table(msgspec.Struct):
    """A measured table, mapped already, and which material to take of it."""

    name: str
    text: str
    select: str | None = None


class Task(msgspec.Struct):
    """A job: its kind by `spec`, the design as text, and where relative paths begin.

    `version` is that of the VoxSoft which began it, empty where that was not noted.
    """

    id: str
    name: str
    design: str
    base: str
    spec: RunSpec | StudySpec | CalibrateSpec
    tables: list[Table] = msgspec.field(default_factory=list)
    version: str = ""

    @property
    def kind(self) -> JobKind:
        """What sort of job it is."""
        if isinstance(self.spec, RunSpec):
            return "run"
        return "study" if isinstance(self.spec, StudySpec) else "calibrate"

    def read_design(self) -> Design:
        """Read the design.

        Raises
        ------
        VoxSoftError
            It is none.
        """
        document = read_document(self.design, self.name)
        return Design.from_document(with_whole_paths(document, Path(self.base)))

    def write(self, folder: Path) -> None:
        """Write the task to its folder, its design and its tables beside it.

        Raises
        ------
        FileError
            It cannot be written.
        """
        write_whole(folder / TASK, msgspec.json.format(msgspec.json.encode(self), indent=1))
        if not (folder / DESIGN).exists():  # a run leaves its own there
            write_whole(folder / DESIGN, self.design)
        for (file, _), table in zip(self.measured_files(folder), self.tables, strict=True):
            make_folder(file.parent)
            write_whole(file, table.text)

    def measured_files(self, folder: Path) -> list[tuple[Path, str | None]]:
        """Where the measured tables lie in the folder, and which material to take of each."""
        return [
            (folder / MEASURED / f"{number}.csv", table.select)
            for number, table in enumerate(self.tables, start=1)
        ]

    @classmethod
    def read(cls, folder: Path) -> Task:
        """Read the task of a folder.

        Raises
        ------
        FileError
            There is none, or it is damaged.
        """
        try:
            return msgspec.json.decode((folder / TASK).read_bytes(), type=cls)
        except OSError as error:
            raise FileError(str(folder), f"holds no job: {error.strerror}") from None
        except (msgspec.DecodeError, UnicodeError) as error:
            raise FileError(str(folder / TASK), f"is damaged: {error}") from None
