"""Part of each cell: by sections, sets of cells, or an array of whole numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.formats.contents import Contents

#: Arrays that name materials, the likeliest first; the name after a colon counts too, in any case.
_ARRAYS: Final = (
    *("part", "material", "materialids", "region", "regionid", "physical", "ref", "cell_tags"),
    *("label", "labels", "materials", "parts", "cellentityids", "objectid", "attribute"),
)
#: Sets that our own writers make: of parts by their number, and of faces of cavities.
_PART: Final = re.compile(r"part-(\d+)", re.IGNORECASE)
CAVITY: Final = re.compile(r"cavity-(\d+)(?:-s([1-4]))?", re.IGNORECASE)
_MOST: Final = 255


@dataclass(frozen=True, eq=False)
class Parts:
    """Part of each cell.

    Attributes
    ----------
    number
        Number of the part, from 1, (n,).
    names
        Name of each part by its number; empty where the file has no parts.
    used
        Arrays that parts were made of.
    notes
        Sentences on sets and arrays that were not used, and on cells in several sets.
    """

    number: NDArray[np.int64]
    names: Mapping[int, str]
    used: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def parts_of(contents: Contents, cells: NDArray[np.int64], where: str) -> Parts:
    """Return the parts of volume cells.

    Sets that carry sections are the parts; without them, all sets of volume cells; without those,
    an array of whole numbers with a name such as ``material``. A cell of two sets belongs to the
    smaller one. Cells of no set are a part of their own, the last.

    Parameters
    ----------
    contents
        Contents of the file.
    cells
        Volume cells of the file, ascending.
    where
        Name of the file, for messages.

    Examples
    --------
    >>> sets = {"all": np.arange(4), "stiff": np.array([2])}
    >>> found = parts_of(Contents(np.zeros((1, 3)), (), sets), np.arange(4), "two.msh")
    >>> found.number.tolist(), found.names
    ([1, 1, 2, 1], {1: 'all', 2: 'stiff'})
    >>> found.notes
    ('1 cell in several sets: the smallest counts',)
    """
    sets = {name: np.flatnonzero(np.isin(cells, v)) for name, v in contents.cell_sets.items()}
    sets = {name: v for name, v in sets.items() if len(v) and not CAVITY.fullmatch(name)}
    found = _by_sets(contents, sets, len(cells)) if sets else _by_array(contents, cells)
    if len(found.names) > _MOST or (len(found.number) and found.number.max() > _MOST):
        what = f"has {len(found.names)} parts; at most {_MOST} are possible"
        raise FileError(where, what, "join sets of cells that are of one material")
    return found


def _by_sets(contents: Contents, sets: Mapping[str, NDArray[np.int64]], count: int) -> Parts:
    notes = []
    names = list(sets)
    if contents.sections:
        names = [name for name in names if name in contents.sections]
        notes += [
            f"Set {name} of {counted(len(found), 'cell')} has no section and makes no part"
            for name, found in sets.items()
            if name not in contents.sections
        ]
    owner = np.full(count, -1)
    # The smallest set comes last, so that it gets the cells it shares with larger ones.
    for rank in sorted(range(len(names)), key=lambda rank: (-len(sets[names[rank]]), rank)):
        owner[sets[names[rank]]] = rank
    uses = np.bincount(np.concatenate([sets[name] for name in names]), minlength=count)
    if several := int((uses > 1).sum()):
        notes.append(f"{counted(several, 'cell')} in several sets: the smallest counts")
    kept = [rank for rank in range(len(names)) if (owner == rank).any()]
    notes += [
        f"Set {name} is covered by smaller ones and makes no part"
        for rank, name in enumerate(names)
        if rank not in kept
    ]
    own = [_PART.fullmatch(names[rank]) for rank in kept]
    numbers = [int(match[1]) if match else 0 for match in own]
    if not all(1 <= number <= _MOST for number in numbers) or len({*numbers}) < len(numbers):
        numbers = list(range(1, len(kept) + 1))
    number = np.zeros(count, np.int64)
    for part, rank in zip(numbers, kept, strict=True):
        number[owner == rank] = part
    titles = {part: names[rank] for part, rank in zip(numbers, kept, strict=True)}
    if rest := int((owner < 0).sum()):
        last = max(numbers, default=0) + 1
        number[owner < 0] = last
        titles[last] = "rest"
        notes.append(f"{counted(rest, 'cell')} in no set: part {last}, called rest")
    notes += [f'Array "{name}" makes no part: sets do' for name in _candidates(contents, None)]
    return Parts(number, titles, (), tuple(notes))


def _by_array(contents: Contents, cells: NDArray[np.int64]) -> Parts:
    names = _candidates(contents, cells)
    if not names:
        return Parts(np.ones(len(cells), np.int64), {})
    chosen, *others = names
    values = contents.arrays[chosen][cells].astype(np.int64)
    distinct, rank = np.unique(values, return_inverse=True)
    keeps = chosen.lower() == "part" and distinct[0] >= 1 and distinct[-1] <= _MOST
    numbers = distinct if keeps else np.arange(1, len(distinct) + 1)
    titles = {int(n): f"{chosen} {value}" for n, value in zip(numbers, distinct, strict=True)}
    notes = tuple(f'Array "{name}" makes no part: "{chosen}" does' for name in others)
    return Parts(numbers[rank.reshape(-1)], titles, (chosen,), notes)


def _candidates(contents: Contents, cells: NDArray[np.int64] | None) -> list[str]:
    """List arrays that may number parts, the likeliest first."""
    found = []
    for name, values in contents.arrays.items():
        key = name.lower().rsplit(":", 1)[-1]
        if key not in _ARRAYS:
            continue
        seen = values if cells is None else values[cells]
        whole = bool(np.isfinite(seen).all() and (seen == np.rint(seen)).all())
        if cells is None or (whole and 0 < len(np.unique(seen)) <= _MOST):
            found.append((_ARRAYS.index(key), name))
    return [name for _, name in sorted(found)]
