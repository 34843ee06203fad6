"""Differences between the results of two folders."""

from __future__ import annotations

import csv
import json
import tomllib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from voxsoft.files.calibrations import NOT_CARDS
from voxsoft.files.meshes import read_mesh_file
from voxsoft.records import place

#: Keys that vary from run to run and are no result: times, places and versions, and hints, which
#: state how long a remedy takes.
_NO_RESULT: Final = frozenset(
    {"seconds", "hint", "written", "versions", "version", "folder", "report"}
)
_ABSENT: Final = "absent"


class Difference(NamedTuple):
    """One result that differs.

    Attributes
    ----------
    file, where
        The file in both folders, and the place in it.
    before, after
        The values; ``"absent"`` where there is none.
    """

    file: str
    where: str
    before: object
    after: object

    def __str__(self) -> str:
        inside = f", {self.where}" if self.where else ""
        return f"{self.file}{inside}: was {_shown(self.before)} and is now {_shown(self.after)}"


def differences(before: Path, after: Path) -> Iterator[Difference]:
    """Compare the results in two folders to the last bit.

    Results of the second folder alone do not count: an older VoxSoft may have written less. A
    summary must be there: a folder without one did not end.

    Parameters
    ----------
    before, after
        Folders to compare.
    """
    cards = {file.name for file in before.glob("*.toml")} - NOT_CARDS
    readers: dict[str, Callable[[Path], Any]] = {"summary.json": _json}
    readers |= dict.fromkeys(("design.toml", *sorted(cards)), _toml)
    readers |= dict.fromkeys(("table.csv", "shapes.csv", "history.csv"), _csv)
    readers |= {"confirmed.json": _json, "result.vtu": _vtu, "specimen.npz": _npz}
    for name, read in readers.items():
        if not (before / name).is_file():
            if name == "summary.json":
                yield Difference(name, "", _ABSENT, "there")
            continue
        yield from _file_differences(name, read, before, after)


def _file_differences(
    name: str, read: Callable[[Path], Any], before: Path, after: Path
) -> Iterator[Difference]:
    contents = []
    for folder in (before, after):
        try:
            contents.append(read(folder / name))
        except FileNotFoundError:
            contents.append(_ABSENT)
        except Exception as error:  # any error of a reader on a damaged file
            contents.append(f"damaged ({type(error).__name__})")
    for steps, old, new in _different(contents[0], contents[1], ()):
        yield Difference(name, place(steps) if steps else "", old, new)


def _different(
    before: object, after: object, steps: tuple[str | int, ...]
) -> Iterator[tuple[tuple[str | int, ...], object, object]]:
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        for key in [*before, *(key for key in after if key not in before)]:
            if key in _NO_RESULT:
                continue
            if key not in after:
                yield (*steps, key), before[key], _ABSENT
            elif key in before:  # a key that an older summary lacks is no difference
                yield from _different(before[key], after[key], (*steps, key))
    elif isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        for index, pair in enumerate(zip(before, after, strict=True)):
            yield from _different(*pair, (*steps, index))
    elif isinstance(before, np.ndarray) and isinstance(after, np.ndarray):
        yield from _different_arrays(before, after, steps)
    elif type(before) is not type(after) or before != after:
        yield steps, before, after


def _different_arrays(
    before: np.ndarray, after: np.ndarray, steps: tuple[str | int, ...]
) -> Iterator[tuple[tuple[str | int, ...], object, object]]:
    if before.shape != after.shape or before.dtype != after.dtype:
        yield steps, f"{before.dtype} {before.shape}", f"{after.dtype} {after.shape}"
        return
    # Compared as bytes: NaN is the same as itself, and 0.0 is not -0.0.
    raw = [np.ascontiguousarray(each).view(np.uint8).reshape(-1) for each in (before, after)]
    other = np.flatnonzero(raw[0] != raw[1]) // before.dtype.itemsize
    if len(other):
        first = np.unravel_index(other[0], before.shape)
        where = (*steps, *(int(index) for index in first))
        yield where, before[first].item(), after[first].item()


def _json(file: Path) -> Any:  # noqa: ANN401 - a document holds anything
    return json.loads(file.read_text(encoding="utf-8"))


def _toml(file: Path) -> Any:  # noqa: ANN401 - a document holds anything
    return tomllib.loads(file.read_text(encoding="utf-8"))


def _csv(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def _vtu(file: Path) -> dict[str, Any]:
    content = read_mesh_file(file)
    mesh = content.mesh
    return {"points": mesh.vertices, "tets": mesh.tets, **content.point_data, **content.cell_data}


def _npz(file: Path) -> dict[str, Any]:
    with np.load(file, allow_pickle=False) as content:
        return dict(content)


def _shown(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= 60 else f"{text[:57]}..."
