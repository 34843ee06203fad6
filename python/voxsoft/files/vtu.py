"""VTU (ParaView, PyVista): keeps all contents, also voxels and data.

Tets come first, in their order, with cell arrays ``part`` and, for voxel meshes, ``voxel`` and
``voxel_size``, and ``fraction``, ``moments`` and ``surfaces`` where voxels are partly filled. The
triangles of cavities follow, with their number from 1 in the cell array ``cavity``; the share of
cut voxels in a cavity is not kept. A region is the point array ``region:NAME``, 1 at its vertices.
"""

from __future__ import annotations

import mmap
import os
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.files.mesh_file import MeshFile, vertex_set, with_cavities
from voxsoft.formats.region_names import UNIT_COMMENT
from voxsoft.formats.report import ReadReport
from voxsoft.mesh import Mesh

if TYPE_CHECKING:
    import meshio

_REGION = "region:"
_CLOSE = b"</VTKFile>"
#: End of a file: a comment of XML, skipped by readers, gives the unit.
_END = f"<!-- VoxSoft mesh, {UNIT_COMMENT} -->\n".encode() + _CLOSE
_OLDER = (b'Name="voxel_size"', b'Name="displacement"')
_OWN_ARRAYS = {"part", "cavity", "voxel", "voxel_size", "fraction", "moments", "surfaces"}


def write(path: Path, content: MeshFile) -> None:
    """Write a compressed binary VTU file."""
    import meshio  # slow to load

    mesh = content.mesh
    counts = [len(cavity.triangles) for cavity in mesh.cavities]
    cells = [("tetra", mesh.tets)]
    if counts:
        cells.append(("triangle", np.concatenate([c.triangles for c in mesh.cavities])))
    cavity = np.repeat(np.arange(1, len(counts) + 1, dtype=np.int32), counts)

    def per_cell(values: NDArray[np.generic]) -> list[NDArray[np.generic]]:
        """Append empty values for the triangles."""
        empty = np.nan if values.dtype.kind == "f" else 0
        shape = (sum(counts), *values.shape[1:])
        return [values, np.full(shape, empty, values.dtype)] if counts else [values]

    arrays = {name: per_cell(values) for name, values in content.cell_data.items()}
    arrays["part"] = per_cell(mesh.tet_part)
    if counts:
        arrays["cavity"] = [np.zeros(len(mesh.tets), np.int32), cavity]
    if mesh.tet_voxel is not None and mesh.voxel_size is not None:
        arrays["voxel"] = per_cell(mesh.tet_voxel)
        sizes = [np.full(len(b.mesh.tets), b.mesh.voxel_size) for b in mesh.each_body]
        arrays["voxel_size"] = per_cell(np.concatenate(sizes))
        if mesh.fractions is not None:
            arrays["fraction"] = per_cell(mesh.fractions[mesh.tet_voxel])
        if mesh.moments is not None:
            arrays["moments"] = per_cell(mesh.moments[mesh.tet_voxel])
        if mesh.surfaces is not None:
            arrays["surfaces"] = per_cell(mesh.surfaces[mesh.tet_voxel])

    points = dict(content.point_data)
    for name, vertices in content.regions.items():
        points[_REGION + name] = np.isin(np.arange(len(mesh.vertices)), vertices).astype(np.uint8)
    points = {_attribute(name): values for name, values in points.items()}
    arrays = {_attribute(name): values for name, values in arrays.items()}
    meshio.vtu.write(str(path), meshio.Mesh(mesh.vertices, cells, points, arrays))
    with path.open("r+b") as file:
        file.seek(-2 * len(_CLOSE), os.SEEK_END)
        place = file.tell() + file.read().rindex(_CLOSE)
        file.seek(place)
        file.truncate()
        file.write(_END + b"\n")


def _attribute(name: str) -> str:
    """Escape a name for XML, in ASCII: meshio writes names unchanged."""
    escaped = escape(name, quote=False).replace('"', "&quot;")
    return escaped.encode("ascii", "xmlcharrefreplace").decode("ascii")


def is_ours(path: Path) -> bool:
    """Return True if the file was written here, in m; older files are known by their arrays."""
    size = path.stat().st_size
    if not size:
        return False
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        if content[-len(_END) - 2 :].strip().endswith(_END):
            return True
        is_older = b"created by meshio" in content[:1000] and content.find(b'Name="part"') > 0
        return is_older and any(content.find(name) > 0 for name in _OLDER)


def read(path: Path) -> MeshFile:
    """Read a VTU file that was written here.

    Raises
    ------
    FileError
        If it has no end, or its arrays cannot be unpacked.
    """
    import meshio  # slow to load

    try:
        data = meshio.vtu.read(str(path))
    except (Exception, SystemExit) as error:
        with path.open("rb") as file:
            file.seek(-2 * len(_CLOSE), os.SEEK_END)
            is_cut = _CLOSE not in file.read()
        what = f"is cut short: it has no {_CLOSE.decode()}" if is_cut else f"is damaged: {error}"
        raise FileError(str(path), what, "write or copy it again") from error
    blocks = [block for block, cells in enumerate(data.cells) if cells.type == "tetra"]
    if not blocks:
        raise FileError(str(path), "holds no linear tetrahedra")
    per_tet = {
        name: np.concatenate([arrays[block] for block in blocks])
        for name, arrays in data.cell_data.items()
    }
    tets = np.concatenate([data.cells[block].data for block in blocks])
    mesh = Mesh.from_tets(data.points, tets, per_tet.get("part"))
    if "voxel" in per_tet and "voxel_size" in per_tet:
        voxel_size = float(per_tet["voxel_size"].min())
        mesh = replace(mesh, tet_voxel=per_tet["voxel"], voxel_size=voxel_size)
        if "fraction" in per_tet:
            moments, surfaces = (
                per_tet[name][::5] if name in per_tet else None for name in ("moments", "surfaces")
            )
            mesh = mesh.with_fractions(per_tet["fraction"][::5], moments, surfaces)
    if "cavity" in data.cell_data:
        mesh = with_cavities(mesh, _cavity_triangles(data), str(path))

    regions, points = {}, {}
    for name, values in data.point_data.items():
        if name.startswith(_REGION):
            region = name.removeprefix(_REGION)
            vertices = np.flatnonzero(values)
            regions[region] = vertex_set(str(path), region, vertices, len(data.points))
        else:
            points[name] = values
    others = {name: values for name, values in per_tet.items() if name not in _OWN_ARRAYS}
    counts = np.bincount(mesh.tet_part)
    names = {int(part): f"part {part}" for part in np.flatnonzero(counts)}
    taken = {
        "vertices": len(mesh.vertices),
        "tets": len(mesh.tets),
        "parts": {names[part]: int(counts[part]) for part in names},
        "regions": {name: len(vertices) for name, vertices in regions.items()},
        "arrays": [*points, *per_tet],
    }
    cells = {"tetra": len(tets)}
    if triangles := sum(len(b.data) for b in data.cells if b.type == "triangle"):
        cells["triangle"] = triangles
    held = {"points": len(data.points), "cells": cells, "arrays": [*data.point_data, *per_tet]}
    report = ReadReport("VTU of VoxSoft", 1.0, held, taken, names)
    return MeshFile(replace(mesh, report=report), regions, points, others)


def _cavity_triangles(data: meshio.Mesh) -> list[NDArray[np.integer]]:
    numbered = [
        (cells.data, numbers)
        for cells, numbers in zip(data.cells, data.cell_data["cavity"], strict=True)
        if cells.type == "triangle"
    ]
    if not numbered:
        return []
    triangles = np.concatenate([triangles for triangles, _ in numbered])
    numbers = np.concatenate([numbers for _, numbers in numbered])
    return [triangles[numbers == number] for number in np.unique(numbers[numbers > 0])]
