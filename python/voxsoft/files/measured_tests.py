"""Tests described in TOML: files of instruments, and the moments at which they count."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, Final, Literal

from pydantic import Field, ValidationError

from voxsoft.calibration import LineName, Measurement, measurements_at
from voxsoft.errors import MeasurementError, VoxSoftError
from voxsoft.files.designs import FilePath, read_document, read_text
from voxsoft.files.marks import Picture, measurement_of_marks
from voxsoft.instruments import Measured, measured
from voxsoft.records import Record, plain_error
from voxsoft.records.table import Table
from voxsoft.units import FILE_CONTEXT, Time

SCHEMA: Final = "voxsoft-test/1"


class Instrument(Record):
    """File of an instrument, with facts that it does not hold itself.

    Parameters
    ----------
    file
        Path, from the folder of the test.
    units, unit, pixel, axes, rate, time, likelihood
        See :func:`voxsoft.measured`.
    """

    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    file: str
    units: Table[str, str] = Field(default_factory=dict)
    unit: str = ""
    pixel: str | None = None
    axes: Table[str, str] | None = None
    rate: float | str | None = None
    time: str | None = None
    likelihood: float = Field(0.6, ge=0.0, le=1.0)

    def read(self, folder: Path) -> Measured:
        """Read the file.

        Raises
        ------
        FileError, MeasurementError, MissingPackageError
            See :func:`voxsoft.measured`.
        """
        return measured(
            folder / self.file,
            units=self.units,
            unit=self.unit,
            pixel=self.pixel,
            axes=self.axes,
            rate=self.rate,
            time=self.time,
            likelihood=self.likelihood,
        )


class Points(Instrument):
    """File of the points of a body over time.

    Parameters
    ----------
    stations
        Probes, or distances along the body, by the names of points; default: probes of their names.
    counted
        Axes of the design that count, such as ``["x", "z"]``; default: all that were seen.
    """

    stations: Table[str, str] | None = None
    counted: tuple[Literal["x", "y", "z"], ...] = ()


class Clock(Record):
    """Moment that two files share.

    Parameters
    ----------
    step
        Column of the points and column of the channels that make their step at one moment; or
    by
        name of a quantity that both recorded.
    """

    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    step: tuple[str, str] | None = None
    by: str | None = None


class MeasuredTest(Record):
    """Test of a body with its instruments, as a TOML file describes it.

    Parameters
    ----------
    points
        Points over time; or
    picture
        marks on a photograph.
    channels
        File of the loads, if it is another one.
    synchronize
        Moment that the two files share; default: they have one clock.
    rest, loaded
        Interval without the load, and intervals with it.
    changes
        Columns by keys of the design, whose means in an interval are its values there; for a
        picture values themselves. Its key in the file is ``set``.
    line
        Line of the body that distances are along.
    source
        Source of the data and its license.
    """

    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    schema_: Literal["voxsoft-test/1"] = Field(alias="schema")
    points: Points | None = None
    picture: Picture | None = None
    channels: Instrument | None = None
    synchronize: Clock | None = None
    rest: tuple[Time, Time] | None = None
    loaded: tuple[tuple[Time, Time], ...] = ()
    changes: Table[str, str] = Field(default_factory=dict, alias="set")
    line: LineName | None = None
    source: str = ""

    def measurements(self, folder: Path) -> list[Measurement]:
        """Read the files, and return a measurement for each interval with a load.

        Raises
        ------
        VoxSoftError
            A file, column, point or interval that cannot be used.
        """
        if self.picture is not None and self.points is None:
            return [
                measurement_of_marks(self.picture, folder, self.changes, self.line, self.source)
            ]
        if self.points is None or self.picture is not None:
            hint = "give [points], points over time, or [picture], marks on a photograph"
            raise MeasurementError("test", "needs one of points and picture", hint)
        if self.rest is None or not self.loaded:
            missing = "rest" if self.rest is None else "loaded"
            hint = 'rest = ["0 s", "0.5 s"], loaded = [["2 s", "3 s"]]'
            raise MeasurementError(missing, "is missing", hint)
        return measurements_at(
            self.data(folder),
            rest=self.rest,
            loaded=self.loaded,
            stations=self.points.stations,
            axes=self.points.counted,
            changes=self.changes,
            line=self.line,
            source=self.source,
        )

    @property
    def files(self) -> tuple[str, ...]:
        """Paths of all files, as the test names them."""
        named = [each.file for each in (self.points, self.channels, self.picture) if each]
        rest = None if self.picture is None else self.picture.rest
        return (*named, rest) if rest else tuple(named)

    def data(self, folder: Path) -> Measured:
        """Read the points and the channels over one clock.

        Raises
        ------
        VoxSoftError
            A file or column that cannot be used.
        """
        if self.points is None:
            raise MeasurementError("points", "are missing", 'write [points] with a "file"')
        points = self.points.read(folder)
        if self.channels is None:
            if self.synchronize is not None:
                raise MeasurementError("synchronize", "needs [channels], a second file")
            return points
        channels = self.channels.read(folder)
        if self.synchronize is None:
            return Measured(
                f"{points.name} + {channels.name}",
                (*points.columns, *channels.columns),
                (*points.notes, *channels.notes, "Both files are taken to have one clock"),
            )
        return points.synchronized(channels, by=self.synchronize.by, step=self.synchronize.step)


def load_measured_test(path: FilePath) -> MeasuredTest:
    """Read the description of a test from a TOML file.

    Raises
    ------
    FileError
        The file cannot be read, or is not TOML.
    MeasurementError
        Entries that are missing, unknown or of another kind; every problem is listed.
    """
    return read_measured_test(read_text(path), Path(path).name)


def read_measured_test(text: str, name: str) -> MeasuredTest:
    """Read the description of a test from text; `name` is that of its file, for errors.

    Raises
    ------
    FileError
        The text is not TOML.
    MeasurementError
        Entries that are missing, unknown or of another kind; every problem is listed.
    """
    document = read_document(text, name)
    if document.get("schema") != SCHEMA:
        came = document.get("schema", "no schema")
        hint = f'write schema = "{SCHEMA}" above [points] or [picture]'
        raise MeasurementError(name, f"is no test: it has {came}", hint)
    try:
        return MeasuredTest.model_validate(document, context=dict(FILE_CONTEXT))
    except ValidationError as error:
        raise plain_error(error, MeasuredTest, document) from None


def load_measurements(path: FilePath, *, select: str | None = None) -> list[Measurement]:
    r"""Read measurements: one from a table of stations, or those of a test in TOML.

    Parameters
    ----------
    path
        A table (:func:`voxsoft.calibration.read_measurement`), or a test (``.toml``).
    select
        Name of the material to take from a table of several.

    Raises
    ------
    VoxSoftError
        A file that is missing, damaged, or does not fit the test.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = (folder / "c.csv").write_text("t_s,tip_z_mm,p_kPa\n0,1,0\n1,1,0\n2,-4,9\n3,-4,9\n")
    >>> _ = (folder / "test.toml").write_text('''schema = "voxsoft-test/1"
    ... rest = [0, "1 s"]
    ... loaded = [["2 s", "3 s"]]
    ... points = { file = "c.csv" }
    ... set = { pressure = "p" }
    ... ''')
    >>> [(m.values.tolist(), m.changes) for m in load_measurements(folder / "test.toml")]
    [([[-0.005]], ('pressure=9 kPa',))]
    """
    if Path(path).suffix.lower() != ".toml":
        from voxsoft.files.measurements import load_measurement

        return [load_measurement(path, select=select)]
    return load_measured_test(path).measurements(Path(path).parent)
