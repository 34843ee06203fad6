"""Report on a read: all contents of a file beside the parts that were taken."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from voxsoft.formats.contents import CORNERS, Contents


@dataclass(frozen=True)
class ReadReport:
    """Contents of a file beside those of the mesh made of it.

    Attributes
    ----------
    format
        Common name of the format.
    meter
        Meters in one unit of the file.
    held
        ``points``, ``cells`` by kind, ``sets`` and ``regions`` with their sizes, names of
        ``instances`` and ``arrays``.
    taken
        ``vertices``, ``tets``, ``parts`` with their tets, ``regions`` with their vertices, names of
        ``arrays``.
    parts
        Name of each part of the mesh by its number.
    differences
        Sentences on contents that the mesh has in another form, or not at all.
    cautions
        Sentences on contents that were read and are unusual.

    Examples
    --------
    >>> print(ReadReport("Gmsh 4.1", 1e-3, {"cells": {"tetra": 2}}, {"tets": 2}))
    Gmsh 4.1, numbers times 0.001 m
    held: cells (tetra 2)
    taken: tets 2
    """

    format: str
    meter: float
    held: Mapping[str, Any]
    taken: Mapping[str, Any]
    parts: Mapping[int, str] = field(default_factory=dict)
    differences: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield f"{self.format}, numbers times {self.meter:g} m"
        yield f"held: {_listed(self.held)}"
        yield f"taken: {_listed(self.taken)}"
        yield from (f"difference: {sentence}" for sentence in self.differences)
        yield from (f"caution: {sentence}" for sentence in self.cautions)

    def summary(self) -> dict[str, Any]:
        """Return the report as plain data (``file`` in the ``--json`` of ``check``)."""
        return {
            "format": self.format,
            "meter": self.meter,
            "held": dict(self.held),
            "taken": dict(self.taken),
            "parts": {str(number): name for number, name in self.parts.items()},
            "differences": list(self.differences),
            "cautions": list(self.cautions),
        }


def held_by(contents: Contents) -> dict[str, Any]:
    """Count all contents of a file.

    Examples
    --------
    >>> import numpy as np
    >>> held_by(Contents(np.zeros((2, 3)), (), point_sets={"tip": np.array([1])}))
    {'points': 2, 'cells': {}, 'sets': {}, 'regions': {'tip': 1}, 'instances': [], 'arrays': []}
    """
    cells: dict[str, int] = {}
    for block in contents.blocks:
        cells[block.kind] = cells.get(block.kind, 0) + len(block.nodes)
    return {
        "points": len(contents.points),
        "cells": cells,
        "sets": {name: len(members) for name, members in contents.cell_sets.items()},
        "regions": {name: len(members) for name, members in contents.point_sets.items()},
        "instances": list(contents.instances),
        "arrays": list(contents.arrays),
    }


def counted_cells(kind: str, count: int) -> str:
    """Describe cells in words: ``8 hexahedra``, ``1 tetrahedron of 10 nodes``.

    Examples
    --------
    >>> counted_cells("hexahedron", 8), counted_cells("tetra10", 1)
    ('8 hexahedra', '1 tetrahedron of 10 nodes')
    """
    base = kind.rstrip("0123456789")
    one, many = _WORDS.get(base, (f"cell of kind {base}", f"cells of kind {base}"))
    nodes = f" of {kind.removeprefix(base)} nodes" if kind != base and base in CORNERS else ""
    return f"{count:,} {one if count == 1 else many}{nodes}"


_WORDS = {
    "vertex": ("point", "points"),
    "line": ("line", "lines"),
    "triangle": ("triangle", "triangles"),
    "quad": ("quadrilateral", "quadrilaterals"),
    "polygon": ("polygon", "polygons"),
    "tetra": ("tetrahedron", "tetrahedra"),
    "pyramid": ("pyramid", "pyramids"),
    "wedge": ("wedge", "wedges"),
    "hexahedron": ("hexahedron", "hexahedra"),
}


def _listed(counts: Mapping[str, Any]) -> str:
    shown = []
    for name, value in counts.items():
        if isinstance(value, Mapping):
            inside = ", ".join(f"{key} {count:,}" for key, count in value.items())
        elif isinstance(value, list):
            inside = ", ".join(map(str, value))
        else:
            shown.append(f"{name} {value:,}")
            continue
        if inside:
            shown.append(f"{name} ({inside})")
    return ", ".join(shown) or "nothing"
