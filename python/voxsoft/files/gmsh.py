"""Gmsh MSH 4.1: parts, cavities and regions as physical groups.

Physical volumes ``part-N``, physical surfaces ``cavity-N``, and one physical point group for
each region. Tets are grouped by part. The file is written here, because meshio keeps physical
groups in this version of the format only where every entity owns a vertex.
"""

from __future__ import annotations

from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.mesh_file import MeshFile
from voxsoft.formats.region_names import UNIT_COMMENT, comments_of, labels_of
from voxsoft.mesh import Mesh

_TYPES = {0: 15, 2: 2, 3: 4}

#: Physical group, which is one entity too: dimension, number, name and rows of vertices.
Group = tuple[int, int, str, NDArray[np.integer]]


def write(path: Path, content: MeshFile) -> None:
    """Write an ASCII file of version 4.1."""
    mesh = content.mesh
    groups: list[Group] = []
    labels = labels_of(content.regions)
    for number, (name, vertices) in enumerate(content.regions.items(), start=1):
        groups.append((0, number, labels[name], vertices[:, None]))
    for number, cavity in enumerate(mesh.cavities, start=1):
        groups.append((2, number, f"cavity-{number}", cavity.triangles))
    for part in np.unique(mesh.tet_part).tolist():
        groups.append((3, part, f"part-{part}", mesh.tets[mesh.tet_part == part]))

    with path.open("w", encoding="ascii", newline="\n") as file:
        file.write("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")
        comments = [UNIT_COMMENT, *comments_of(labels)]
        file.write("\n".join(["$Comments", *comments, "$EndComments\n"]))
        names = [f'{dimension} {number} "{name}"' for dimension, number, name, _ in groups]
        file.write("\n".join(["$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames\n"]))
        _write_entities(file, mesh, groups)
        _write_nodes(file, mesh)
        _write_elements(file, groups)


def _write_entities(file: TextIO, mesh: Mesh, groups: list[Group]) -> None:
    """Write an entity for each group: number, bounds (a point has one corner), its group."""
    counts = [sum(group[0] == dimension for group in groups) for dimension in range(4)]
    file.write("$Entities\n" + " ".join(map(str, counts)) + "\n")
    for dimension, number, _, rows in groups:
        points = mesh.vertices[np.unique(rows)]
        corners = [points[0]] if dimension == 0 else [points.min(axis=0), points.max(axis=0)]
        bounds = " ".join(f"{x:.17g}" for corner in corners for x in corner)
        boundary = "" if dimension == 0 else " 0"
        file.write(f"{number} {bounds} 1 {number}{boundary}\n")
    file.write("$EndEntities\n")


def _write_nodes(file: TextIO, mesh: Mesh) -> None:
    """Write all vertices as nodes of the first part."""
    count = len(mesh.vertices)
    file.write(f"$Nodes\n1 {count} 1 {count}\n3 {mesh.tet_part.min()} 0 {count}\n")
    np.savetxt(file, np.arange(1, count + 1), "%d")
    np.savetxt(file, mesh.vertices, "%.17g")
    file.write("$EndNodes\n")


def _write_elements(file: TextIO, groups: list[Group]) -> None:
    total = sum(len(rows) for *_, rows in groups)
    file.write(f"$Elements\n{len(groups)} {total} 1 {total}\n")
    first = 1
    for dimension, number, _, rows in groups:
        file.write(f"{dimension} {number} {_TYPES[dimension]} {len(rows)}\n")
        tags = np.arange(first, first + len(rows))
        np.savetxt(file, np.column_stack((tags, rows + 1)), "%d")
        first += len(rows)
    file.write("$EndElements\n")
