"""Gmsh .msh of version 2.2 and 4.1, as text and binary: cells with their physical groups.

A group's cells are a cell set of its name, or of its number where it has none; groups of lines and
surfaces are point sets too, groups of points are these alone. A cell of several groups belongs to
all of them. Version 2.2 lists such a cell once for each group: it becomes one.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats import by_meshio, gmsh_sections
from voxsoft.formats.contents import CellBlock, Contents
from voxsoft.formats.gmsh_sections import Cells, Section
from voxsoft.formats.region_names import names_in, unit_in

_DIMENSIONS: Final = {
    **{"vertex": 0, "line": 1, "triangle": 2, "quad": 2},
    **{"tetra": 3, "pyramid": 3, "wedge": 3, "hexahedron": 3},
}
#: Sections that hold no cells, points or groups, and are skipped without a note.
_SILENT: Final = {"MeshFormat", "Comments", "Entities", "Nodes", "Elements", "PhysicalNames"}


def read(path: Path) -> Contents:
    """Read a file; other versions, and files of ANSYS and others of this suffix, by meshio.

    Raises
    ------
    FileError
        If a section has no end, a count does not fit, or a cell names a node that is missing.
    """
    data = path.read_bytes()
    if b"$MeshFormat" not in data[:4096]:
        return by_meshio.read(path)
    head = re.match(rb"\s*\$MeshFormat\s+(\S+)\s+([01])\s+(\d+)[ \t]*\r?\n", data)
    if head is None:
        raise FileError(str(path), "does not begin with $MeshFormat and a version of Gmsh")
    version, is_binary, size = head[1].decode(), head[2] == b"1", int(head[3])
    if version not in ("2", "2.1", "2.2", "4.1"):
        return by_meshio.read(path)
    if size != 8:
        raise FileError(str(path), f"has numbers of {size} bytes; expected 8")
    swapped = is_binary and data[head.end() : head.end() + 4] == b"\x00\x00\x00\x01"
    order = ">" if swapped else "<"
    sections: dict[str, Section] = {}
    notes: list[str] = []
    for section in gmsh_sections.split(path, data, is_binary, order):
        if section.name in ("Nodes", "Elements") and section.name in sections:
            raise FileError(str(path), f"has two sections ${section.name}")
        sections[section.name] = section
        if section.name not in _SILENT:
            notes.append(f"Section ${section.name} is passed over")
    for name in ("Nodes", "Elements"):
        if name not in sections:
            raise FileError(str(path), f"is cut short: it has no section ${name}")
    if "PartitionedEntities" in sections:
        raise FileError(str(path), "is cut into partitions", "save it without partitions")
    is_old = version != "4.1"
    comments = sections["Comments"].text().splitlines() if "Comments" in sections else []
    try:
        nodes = sections["Nodes"]
        tags, points = gmsh_sections.nodes_2(nodes) if is_old else gmsh_sections.nodes_4(nodes)
        if is_old:
            cells = gmsh_sections.cells_2(sections["Elements"])
        else:
            groups = gmsh_sections.groups_4(sections["Entities"]) if "Entities" in sections else {}
            cells = gmsh_sections.cells_4(sections["Elements"], groups)
        names = _physical_names(sections["PhysicalNames"]) if "PhysicalNames" in sections else {}
        gathered = _Gathered(str(path), tags)
        for each in cells:
            gathered.take(each)
    except (ValueError, IndexError) as error:
        what = f"has counts in its sections that do not fit its numbers ({error})"
        raise FileError(str(path), what, "check that the file is complete") from None
    return gathered.contents(
        points,
        {key: names_in(comments).get(name, name) for key, name in names.items()},
        [*notes, *gathered.notes()],
        f"Gmsh {version}",
        unit_in(comments),
    )


def _physical_names(section: Section) -> dict[tuple[int, int], str]:
    """Read names by dimension and number."""
    found = re.findall(r'^\s*(\d+)\s+(-?\d+)\s+"(.*)"\s*$', section.text(), re.MULTILINE)
    return {(int(dimension), abs(int(number))): name for dimension, number, name in found}


@dataclass
class _Gathered:
    """Cells of each kind, each once, with the groups that they are in."""

    path: str
    tags: NDArray[np.int64]
    rows: dict[str, list[NDArray[np.int64]]] = field(default_factory=dict)
    groups: dict[tuple[str, int], list[NDArray[np.int64]]] = field(default_factory=dict)
    left: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self.order = np.argsort(self.tags, kind="stable")
        self.ascending = self.tags[self.order]

    def take(self, cells: Cells) -> None:
        """Add cells of one kind and the same groups."""
        base = cells.kind.rstrip("0123456789")
        if base not in _DIMENSIONS:
            self.left[cells.kind] += len(cells.nodes)
            return
        first = sum(map(len, self.rows.get(cells.kind, [])))
        self.rows.setdefault(cells.kind, []).append(self._found(cells.nodes))
        for group in cells.groups:
            numbers = np.arange(first, first + len(cells.nodes))
            self.groups.setdefault((cells.kind, group), []).append(numbers)

    def _found(self, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return points of the contents from tags of nodes."""
        places = np.searchsorted(self.ascending, nodes)
        found = self.order[np.minimum(places, len(self.order) - 1)]
        is_missing = self.tags[found] != nodes
        if is_missing.any():
            what = f"a cell has node {nodes[is_missing][0]}, which is missing"
            raise FileError(self.path, what)
        return found

    def notes(self) -> Iterator[str]:
        """Yield sentences on cells that are left out."""
        for kind, count in self.left.items():
            yield f"{count:,} cells of {kind} are left out"

    def contents(
        self,
        points: NDArray[np.float64],
        names: dict[tuple[int, int], str],
        notes: list[str],
        called: str,
        unit: float | None,
    ) -> Contents:
        """Return all as contents."""
        blocks, first = [], 0
        cell_sets: dict[str, list[NDArray[np.int64]]] = {}
        point_sets: dict[str, list[NDArray[np.int64]]] = {}
        for kind, parts in self.rows.items():
            rows = np.concatenate(parts)
            _, once, index = np.unique(
                np.sort(rows, axis=1), axis=0, return_index=True, return_inverse=True
            )
            # Cells in the order of the file, each at its first position.
            order = np.argsort(once, kind="stable")
            rank = np.empty_like(order)
            rank[order] = np.arange(len(order))
            number = rank[index.reshape(-1)] + first
            nodes = rows[once[order]]
            if doubles := len(rows) - len(nodes) - self._repeated(kind, index.reshape(-1)):
                notes.append(f"{doubles:,} cells of kind {kind} stand twice and count once")
            dimension = _DIMENSIONS[kind.rstrip("0123456789")]
            for (of, group), members in self.groups.items():
                if of != kind:
                    continue
                chosen = np.concatenate(members)
                name = names.get((dimension, group), str(group))
                if dimension > 0:
                    cell_sets.setdefault(name, []).append(number[chosen])
                if dimension < 3:
                    point_sets.setdefault(name, []).append(rows[chosen].ravel())
            blocks.append(CellBlock(kind, nodes))
            first += len(nodes)
        empty = set(names.values()) - {*cell_sets, *point_sets}
        notes += [f"Group {name} holds no cell of the file" for name in sorted(empty)]
        return Contents(
            points,
            tuple(blocks),
            {name: np.unique(np.concatenate(each)) for name, each in cell_sets.items()},
            {name: np.unique(np.concatenate(each)) for name, each in point_sets.items()},
            unit=unit,
            notes=tuple(notes),
            format=called,
        )

    def _repeated(self, kind: str, index: NDArray[np.int64]) -> int:
        """Count the rows that repeat a cell only to put it into one more group."""
        more = 0
        cells = [
            np.unique(index[np.concatenate(members)])
            for (of, _), members in self.groups.items()
            if of == kind
        ]
        if cells:
            counts = np.unique(np.concatenate(cells), return_counts=True)[1]
            more = int((counts - 1).sum())
        return min(more, len(index) - len(np.unique(index)))
