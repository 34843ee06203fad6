"""MAT files of MATLAB up to version 7, read by SciPy: vectors, columns of matrices, structs."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import MeasurementError
from voxsoft.formats.mat import variables_of
from voxsoft.instruments.column import Column
from voxsoft.instruments.heads import is_time, split_name
from voxsoft.instruments.options import Options
from voxsoft.instruments.texts import Found


def read(path: Path, options: Options) -> Found:
    """Read all vectors of numbers, rows or columns alike, and the columns of matrices.

    MATLAB stores whole numbers in as few bits as they need: they are floats here, as there. Units
    stand behind the names (``force_N``) or are given.

    Raises
    ------
    FileError
        It is damaged, or of version 7.3.
    MeasurementError
        Times of another length, or a unit that is not known.
    """
    notes: list[str] = []
    vectors: list[tuple[str, NDArray[Any]]] = []
    for name, value in _leaves(variables_of(path), "", notes):
        array = np.asarray(value)
        if array.size == 0:
            notes.append(f"{name} is empty, and is left out")
        elif array.dtype.kind not in "fiub":
            notes.append(f"{name} holds no numbers, and is left out")
        elif array.size == 1:
            notes.append(f"{name} = {float(array.ravel()[0]):g} is one number, and no column")
        elif array.ndim == 1:
            vectors.append((name, array))
        elif array.ndim == 2:
            table = array
            if table.shape[0] < table.shape[1]:
                table = table.T
                notes.append(f"{name}: its rows are taken for columns, {array.shape}")
            vectors += [(f"{name} {n + 1}", column) for n, column in enumerate(table.T)]
        else:
            notes.append(f"{name} has {array.ndim} axes, and is left out")
    return Found(list(_columns(path.name, vectors, options, notes)), notes)


def _columns(
    where: str,
    vectors: list[tuple[str, NDArray[Any]]],
    options: Options,
    notes: list[str],
) -> Iterator[Column]:
    named = [(*split_name(name), numbers) for name, numbers in vectors]
    asked = None if options.time is None else options.time.casefold()
    labels = [label.rpartition("/")[2] for label, _, _ in named]
    clocks = [
        n
        for n, label in enumerate(labels)
        if (is_time(label) if asked is None else label.casefold() == asked)
    ]
    if asked is not None and not clocks:
        came = ", ".join(label for label, _, _ in named)
        raise MeasurementError(where, f'has no "{options.time}"', f"it has {came}")
    clock = clocks[0] if clocks and options.rate is None else None
    times = None
    if clock is not None:
        label, unit, numbers = named[clock]
        seen = Column(label, options.unit_of(label, unit), numbers)
        if seen.kind != "time":
            hint = f'give units={{"{label}": "s"}}, or rate='
            raise MeasurementError(f"{where}, {label}", "is a time without a unit of time", hint)
        times = seen.values
    for n, (label, unit, numbers) in enumerate(named):
        if n == clock:
            continue
        own = times
        if options.rate is not None:
            own = np.arange(len(numbers)) / options.rate
        elif times is not None and len(times) != len(numbers):
            notes.append(f"{label} has {len(numbers)} rows, its times {len(times)}: no times")
            own = None
        yield Column(label, options.unit_of(label, unit), numbers, own)


def _leaves(values: dict[str, Any], before: str, notes: list[str]) -> Iterator[tuple[str, Any]]:
    """Yield arrays by name; fields of structs as ``"struct/field"``."""
    for name, value in values.items():
        whole = f"{before}{name}"
        fields = getattr(value, "_fieldnames", None)
        if fields is not None:
            inner = {field: getattr(value, field) for field in fields}
            yield from _leaves(inner, f"{whole}/", notes)
        elif type(value).__name__ == "MatlabOpaque":
            notes.append(f"{whole} is a table or an object, which MAT hides: save its columns")
        else:
            yield whole, value
