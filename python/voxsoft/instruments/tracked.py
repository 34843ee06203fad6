"""Points that a camera tracked: exports of DeepLabCut and Kinovea."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Final

import numpy as np

from voxsoft.errors import FileError, MeasurementError
from voxsoft.instruments.column import Column, Floats
from voxsoft.instruments.options import Options
from voxsoft.instruments.table_text import NumberForm, TextRow, TextTable
from voxsoft.instruments.texts import Found

#: First words of the files.
DEEPLABCUT: Final = "scorer"
KINOVEA: Final = "#Kinovea Trajectory data export"

_DOWN: Final = "y points down, as in pictures"
_CLOCK: Final = re.compile(r"(\d+):(\d{2}):(\d{2}):(\d{2})")


def read_deeplabcut(text: str, name: str, options: Options) -> Found:
    r"""Read the points of DeepLabCut's CSV, in pixels; unlikely ones are gaps.

    Raises
    ------
    MeasurementError
        A header or a cell that is none of it, or several animals with one name.

    Examples
    --------
    >>> text = "scorer,a,a,a\nbodyparts,tip,tip,tip\ncoords,x,y,likelihood\n0,5,7,0.9\n1,6,8,0.1"
    >>> [c.values.tolist() for c in read_deeplabcut(text, "c.csv", Options()).columns]
    [[5.0, nan], [7.0, nan]]
    """
    table = TextTable.of(text, name)
    heads = {row.cells[0]: row for row in table.rows[:5] if row.cells[0].isalpha()}
    if not {"bodyparts", "coords"} <= set(heads):
        came = ", ".join(heads)
        what = f"begins with {came}; expected scorer, bodyparts and coords"
        raise MeasurementError(name, what, "give the CSV as DeepLabCut wrote it")
    rows = table.rows[len(heads) :]
    width = len(heads["coords"].cells)
    numbers = np.full((len(rows), width), np.nan)
    form = NumberForm()
    for index, row in enumerate(rows):
        for at in range(1, width):
            try:
                numbers[index, at] = form.read(row.cell(at) or "nan")
            except ValueError:
                where = f"{name}, line {row.line}"
                raise MeasurementError(where, f'"{row.cell(at)}" is not a number') from None
    times = None if options.rate is None else np.arange(len(rows)) / options.rate
    columns: list[Column] = []
    notes = [f"Points are in pixels; {_DOWN}"]
    for at in range(1, width):
        axis = heads["coords"].cell(at)
        if axis not in ("x", "y"):
            continue
        point = _point(heads, at)
        sure = _likelihood(heads, at, numbers)
        seen = numbers[:, at].copy()
        if sure is not None:
            unlikely = ~(sure >= options.likelihood)
            seen[unlikely] = np.nan
            if axis == "x" and unlikely.any():
                notes.append(
                    f"{point}: {np.count_nonzero(unlikely):,} of {len(rows):,} frames have a "
                    f"likelihood below {options.likelihood:g}, and are gaps"
                )
        label = f"{point} {axis}"
        columns.append(Column(label, options.units.get(label, "px"), seen, times))
    if times is None:
        notes.append("The file holds no times: rate= gives the frames per second")
    return Found(columns, notes)


def read_kinovea(text: str, name: str, options: Options) -> Found:
    r"""Read the trajectories of Kinovea's text for Gnuplot.

    Raises
    ------
    MeasurementError
        A line that is none of it; times without a unit.

    Examples
    --------
    >>> text = "#Kinovea Trajectory data export\n#T X Y\n\n# tip\n0 1,5 2\n40 1,6 2\n"
    >>> found = read_kinovea(text, "k.txt", Options(units={"time": "ms"}, unit="cm"))
    >>> found.columns[0].name, found.columns[0].values.tolist(), found.columns[0].rate
    ('tip x', [0.015, 0.016], 25.0)
    """
    tracks: list[tuple[str, list[tuple[int, list[str]]]]] = []
    title, fresh = "", True
    for number, line in enumerate(text.removeprefix("\ufeff").splitlines(), start=1):
        if line.startswith("#"):
            bare = line.lstrip("# ").strip()
            if not bare.startswith("Kinovea") and bare != "T X Y":
                title, fresh = bare, True
        elif not line.strip():
            fresh = True
        else:
            if fresh:
                tracks.append((title or f"point {len(tracks) + 1}", []))
                title, fresh = "", False
            tracks[-1][1].append((number, line.split()))
    columns: list[Column] = []
    for point, lines in tracks:
        cells = [cell for _, words in lines for cell in words if ":" not in cell]
        form = NumberForm.of(cells, name, columns_by_comma=False)
        times = _kinovea_times(lines, form, name, options)
        for at, axis in ((1, "x"), (2, "y")):
            numbers = [_word(words, at, number, form, name) for number, words in lines]
            label = f"{point} {axis}"
            columns.append(Column(label, options.unit_of(label, ""), np.array(numbers), times))
    return Found(columns, [f"The file says no unit of its coordinates; {_DOWN}, unless turned"])


def read_kva(path: Path, options: Options) -> Found:
    """Read the tracks of a file of Kinovea, whose points have the coordinates of its calibration.

    Raises
    ------
    FileError
        It is no XML of Kinovea, or its points have no such coordinates.
    MeasurementError
        Times without a unit.
    """
    try:
        # Entities are safe: expat bounds the text that they expand to.
        root = ET.fromstring(path.read_bytes())
    except (ET.ParseError, ValueError, LookupError) as error:
        raise FileError(str(path), f"is no XML: {error}", "save or copy it again") from None
    lines = [KINOVEA, "#T X Y", ""]
    for number, track in enumerate(root.iter("Track"), start=1):
        title = track.get("name") or (track.findtext("Label/Text") or "").strip()
        lines.append(f"# {title or f'point {number}'}")
        for point in track.iter("TrackPoint"):
            seen = [point.get(key, "") for key in ("UserTime", "UserX", "UserY")]
            if not all(seen):
                what = "holds tracks without coordinates: Kinovea writes UserX where it calculates"
                hint = "export them in Kinovea by File > Export to spreadsheet > Gnuplot"
                raise FileError(str(path), what, hint)
            lines.append(" ".join(seen))
        lines.append("")
    return read_kinovea("\n".join(lines), path.name, options)


def _kinovea_times(
    lines: list[tuple[int, list[str]]], form: NumberForm, name: str, options: Options
) -> Floats | None:
    if options.rate is not None:
        return np.arange(len(lines)) / options.rate
    clocks = [_CLOCK.fullmatch(words[0]) for _, words in lines]
    if all(clocks):
        parts = np.array([[float(p) for p in clock.groups()] for clock in clocks if clock])
        coarse: Floats = parts @ np.array([3600.0, 60.0, 1.0, 0.01])
        return coarse
    unit = {"s": 1.0, "ms": 1e-3, "us": 1e-6}.get(options.units.get("time", ""))
    if unit is None:
        hint = 'give units={"time": "ms"}, or rate= in frames per second'
        raise MeasurementError(name, "does not say the unit of its times", hint)
    return np.array([_word(words, 0, number, form, name) for number, words in lines]) * unit


def _word(words: list[str], at: int, number: int, form: NumberForm, name: str) -> float:
    try:
        return form.read(words[at])
    except (ValueError, IndexError):
        what = f'"{" ".join(words)[:60]}" is no time with x and y'
        raise MeasurementError(f"{name}, line {number}", what) from None


def _point(heads: dict[str, TextRow], at: int) -> str:
    parts = [heads.get(key) for key in ("individuals", "bodyparts")]
    cells = [row.cell(at) for row in parts if row is not None]
    return " ".join(cell for cell in cells if cell and cell != "single")


def _likelihood(heads: dict[str, TextRow], at: int, numbers: Floats) -> Floats | None:
    """Return the likelihood of the point of a column, (n,)."""
    coords = heads["coords"]
    for other in range(at + 1, min(at + 3, len(coords.cells))):
        if coords.cell(other) == "likelihood" and _point(heads, other) == _point(heads, at):
            found: Floats = numbers[:, other]
            return found
    return None
