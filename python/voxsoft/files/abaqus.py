"""Abaqus and CalculiX input files: C3D4 elements with sets and surfaces.

Element sets ``PART-N``, a node set for each region, and for each cavity an element-based surface
``CAVITY-N`` made of the element sets ``CAVITY-N-S1`` to ``-S4``, one per face of the element, as
``*DLOAD`` or ``*DSLOAD`` wants it. The file holds the mesh only: add materials and steps, or
include it by ``*INCLUDE``. It is written here, because meshio knows no surfaces.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from itertools import takewhile
from pathlib import Path
from typing import TextIO

import meshio
import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.files.mesh_file import MeshFile, vertex_set, with_cavities
from voxsoft.formats.region_names import comments_of, labels_of, names_in
from voxsoft.mesh import Mesh

#: Corners of the faces S1 to S4 of a C3D4 element, outward.
_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_PER_LINE = 12
#: First and last line: a file cut short between two lines could not be told from a whole one.
_BEGIN, _END = "** VoxSoft mesh", "** end of VoxSoft mesh"


def write(path: Path, content: MeshFile) -> None:
    """Write nodes, elements, sets and surfaces."""
    mesh = content.mesh
    with path.open("w", encoding="ascii", newline="\n") as file:
        labels = labels_of(content.regions)
        comments = "".join(f"** {line}\n" for line in comments_of(labels))
        file.write(f"{_BEGIN}\n{comments}*NODE, NSET=ALL-NODES\n")
        for number, (x, y, z) in enumerate(mesh.vertices.tolist(), start=1):
            file.write(f"{number}, {x:.17g}, {y:.17g}, {z:.17g}\n")
        file.write("*ELEMENT, TYPE=C3D4, ELSET=ALL-ELEMENTS\n")
        numbered = np.column_stack((np.arange(1, len(mesh.tets) + 1), mesh.tets + 1))
        np.savetxt(file, numbered, "%d", delimiter=", ")
        for part in np.unique(mesh.tet_part).tolist():
            _write_set(file, "ELSET", f"PART-{part}", np.flatnonzero(mesh.tet_part == part))
        for name, vertices in content.regions.items():
            _write_set(file, "NSET", labels[name], vertices)
        for number, cavity in enumerate(mesh.cavities, start=1):
            _write_surface(file, f"CAVITY-{number}", mesh, cavity.triangles)
        file.write(f"{_END}\n")


def _write_set(file: TextIO, kind: str, name: str, indices: Iterable[int]) -> None:
    numbers = [str(index + 1) for index in indices]
    file.write(f"*{kind}, {kind}={name}\n")
    for start in range(0, len(numbers), _PER_LINE):
        file.write(",".join(numbers[start : start + _PER_LINE]) + "\n")


def _write_surface(file: TextIO, name: str, mesh: Mesh, triangles: NDArray[np.integer]) -> None:
    wanted = {tuple(sorted(triangle)) for triangle in triangles.tolist()}
    lines = []
    for number, corners in enumerate(_FACES, start=1):
        faces = np.sort(mesh.tets[:, corners], axis=1).tolist()
        elements = [tet for tet, face in enumerate(faces) if tuple(face) in wanted]
        if elements:
            _write_set(file, "ELSET", f"{name}-S{number}", elements)
            lines.append(f"{name}-S{number}, S{number}\n")
    file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n" + "".join(lines))


def read(path: Path) -> MeshFile:
    """Read nodes, C3D4 elements, sets ``PART-N`` and ``CAVITY-N-Sn``, and node sets as regions."""
    with path.open("rb") as file:
        if file.readline().strip() == _BEGIN.encode():
            file.seek(-min(len(_END) + 2, path.stat().st_size), os.SEEK_END)
            if not file.read().strip().endswith(_END.encode()):
                raise FileError(str(path), "is cut short", "write or copy it again")
    data = meshio.abaqus.read(str(path))
    blocks = [block for block, cells in enumerate(data.cells) if cells.type == "tetra"]
    if not blocks:
        raise FileError(str(path), "holds no linear tetrahedra (C3D4)")
    sizes = [len(data.cells[block].data) for block in blocks]
    starts = np.cumsum([0, *sizes])
    tets = np.concatenate([data.cells[block].data for block in blocks])

    parts = np.ones(len(tets), np.int64)
    faces: dict[int, list[NDArray[np.integer]]] = {}
    for name, members in data.cell_sets.items():
        chosen = [members[block] + start for block, start in zip(blocks, starts, strict=False)]
        elements = np.concatenate(chosen).astype(np.int64)
        part = re.fullmatch(r"PART-(\d+)", name, re.IGNORECASE)
        cavity = re.fullmatch(r"CAVITY-(\d+)-S([1-4])", name, re.IGNORECASE)
        if part:
            parts[elements] = int(part[1])
        elif cavity:
            corners = _FACES[int(cavity[2]) - 1]
            faces.setdefault(int(cavity[1]), []).append(tets[elements][:, corners])
    mesh = Mesh.from_tets(data.points, tets, parts)
    if faces:
        surfaces = [np.concatenate(faces[number]) for number in sorted(faces)]
        mesh = with_cavities(mesh, surfaces, str(path))
    names = names_in(_comments(path))
    regions = {
        names.get(label, label): vertex_set(str(path), label, vertices, len(data.points))
        for label, vertices in data.point_sets.items()
        if label.upper() != "ALL-NODES"
    }
    return MeshFile(mesh, regions)


def _comments(path: Path) -> Iterator[str]:
    """The comments that a file begins with."""
    with path.open(encoding="utf-8", errors="replace") as file:
        yield from takewhile(lambda line: line.startswith("**"), file)
