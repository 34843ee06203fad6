"""Abaqus and CalculiX input files: C3D4 elements with sets and surfaces.

Element sets ``PART-N``, a node set for each region, and for each cavity an element-based surface
``CAVITY-N`` made of the element sets ``CAVITY-N-S1`` to ``-S4``, one per face of the element, as
``*DLOAD`` or ``*DSLOAD`` requires. The file holds the mesh only: add materials and steps, or
include it by ``*INCLUDE``. It is written here, because meshio knows no surfaces.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.from_contents import ABAQUS_FACES
from voxsoft.files.mesh_file import MeshFile
from voxsoft.formats.abaqus import BEGIN, END
from voxsoft.formats.region_names import UNIT_COMMENT, comments_of, labels_of
from voxsoft.mesh import Mesh

_PER_LINE = 12


def write(path: Path, content: MeshFile) -> None:
    """Write nodes, elements, sets and surfaces."""
    mesh = content.mesh
    with path.open("w", encoding="ascii", newline="\n") as file:
        labels = labels_of(content.regions)
        comments = "".join(f"** {line}\n" for line in (UNIT_COMMENT, *comments_of(labels)))
        file.write(f"{BEGIN}\n{comments}*NODE, NSET=ALL-NODES\n")
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
        file.write(f"{END}\n")


def _write_set(file: TextIO, kind: str, name: str, indices: Iterable[int]) -> None:
    numbers = [str(index + 1) for index in indices]
    file.write(f"*{kind}, {kind}={name}\n")
    for start in range(0, len(numbers), _PER_LINE):
        file.write(",".join(numbers[start : start + _PER_LINE]) + "\n")


def _write_surface(file: TextIO, name: str, mesh: Mesh, triangles: NDArray[np.integer]) -> None:
    wanted = {tuple(sorted(triangle)) for triangle in triangles.tolist()}
    lines = []
    for number, corners in enumerate(ABAQUS_FACES, start=1):
        faces = np.sort(mesh.tets[:, corners], axis=1).tolist()
        elements = [tet for tet, face in enumerate(faces) if tuple(face) in wanted]
        if elements:
            _write_set(file, "ELSET", f"{name}-S{number}", elements)
            lines.append(f"{name}-S{number}, S{number}\n")
    file.write(f"*SURFACE, NAME={name}, TYPE=ELEMENT\n" + "".join(lines))
