"""Text inputs of a job: the design, and the measured tables."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

from voxsoft.design import Design, set_values
from voxsoft.design.document.documents import Steps, file_references
from voxsoft.design.document.included import placed_document, refuse_outside
from voxsoft.errors import DesignError, VoxSoftError
from voxsoft.files.designs import FilePath, read_document, read_text
from voxsoft.files.toml_edits import with_document, with_value
from voxsoft.records import Record

if TYPE_CHECKING:
    from voxsoft.calibration import Measurement


class DesignSource(Record):
    """The text of a design, and where relative paths in it begin.

    Parameters
    ----------
    text
        Text of a design file, with its formulas and comments.
    folder
        An absolute path; empty where no path in the text is relative.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> DesignSource.of_design(families.beam()).read() == families.beam()
    True
    """

    error_type: ClassVar[type[VoxSoftError]] = DesignError

    text: str
    folder: str = ""

    @classmethod
    def of_file(cls, path: FilePath, assignments: Iterable[str] = ()) -> Self:
        """Read a design file, with changes ``key=value`` as the command line takes them.

        Raises
        ------
        FileError
            The file cannot be read, or is not TOML.
        DesignError
            An assignment that leads nowhere.
        """
        text = read_text(path)
        changed = set_values(read_document(text, Path(path).name), assignments)
        return cls(text=with_document(text, changed), folder=str(Path(path).parent.absolute()))

    @classmethod
    def of_design(cls, design: Design) -> Self:
        """Take the text of a design that was made in Python."""
        return cls(text=design.to_toml())

    def read(self) -> Design:
        """Make the design.

        Raises
        ------
        FileError
            The text is not TOML.
        DesignError
            It is no valid design.
        """
        document = self._document()
        return Design.from_document(
            placed_document(document, Path(self.folder)) if self.folder else document
        )

    def files(self) -> dict[Steps, Path]:
        """Find the meshes and cards that the design names, by the keys of their paths."""
        document = self._document()
        if self.folder:
            refuse_outside(document, Path(self.folder))
        return {steps: Path(self.folder, path) for steps, path in file_references(document)}

    def with_files(self, files: dict[Steps, Path], folder: Path) -> Self:
        """Return the source for a folder, with other files in place of those it names.

        Parameters
        ----------
        files
            Files by the keys of their paths; the others stay where they are.
        folder
            Future folder of the text; files below it get relative paths.
        """
        text = self.text
        for steps, file in (self.files() | files).items():
            text = with_value(text, steps, _as_seen_from(folder, file))
        return type(self)(text=text, folder=str(folder.absolute()))

    def _document(self) -> dict[str, Any]:
        return read_document(self.text, "design.toml")


class MeasuredTable(Record):
    """A measured table as text, and which material to take of it.

    Parameters
    ----------
    name
        Name in errors and reports: the name of its file.
    text
        Comma-separated, as :func:`voxsoft.calibration.read_measurement` reads it.
    select
        The material, where the table holds several.
    """

    name: str
    text: str
    select: str | None = None

    @classmethod
    def of_file(cls, path: FilePath, select: str | None = None) -> tuple[Self, ...]:
        """Read the file of a table, or the tables of a test (TOML): one for each load.

        Raises
        ------
        FileError
            A missing, unreadable or too large file.
        MeasurementError
            A file that is no text, or a test that cannot be used.
        """
        name = Path(path).name
        if Path(path).suffix.lower() != ".toml":
            from voxsoft.instruments.read import table_text

            return (cls(name=name, text=table_text(path), select=select),)
        from voxsoft.files.measured_tests import load_measurements

        return cls.of_measurements(load_measurements(path), name)

    @classmethod
    def of_measurements(cls, found: Sequence[Measurement], name: str) -> tuple[Self, ...]:
        """Write the measurements of a test as tables."""
        from voxsoft.calibration import table_of

        return tuple(
            cls(name=f"{name}, {at} of {len(found)}", text=table_of(measurement))
            for at, measurement in enumerate(found, start=1)
        )

    def on_line(self, line: str) -> Self:
        r"""Return the table with a comment that names the line of its arc positions.

        Examples
        --------
        >>> table = MeasuredTable(name="t", text="arc_mm,dz_mm\n30,-5").on_line("centerline")
        >>> table.read().line
        'centerline'
        """
        # Below: lines keep their numbers in errors.
        return self.replace(text=f"{self.text.rstrip()}\n# line: {line}\n")

    def read(self) -> Measurement:
        """Make the measurement.

        Raises
        ------
        MeasurementError
            The table cannot be used, with the line.
        """
        from voxsoft.calibration import read_measurement

        return read_measurement(self.text, name=self.name, select=self.select)


def _as_seen_from(folder: Path, file: Path) -> str:
    inside = file.absolute().is_relative_to(folder.absolute())
    below = "" if not inside else os.path.relpath(file.absolute(), folder.absolute())
    return Path(below).as_posix() if inside else str(file.absolute())
