"""Mesh of a file's contents, with a report on all that was taken."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from voxsoft._shown import counted
from voxsoft.errors import FileError
from voxsoft.files.mesh_file import MeshFile, with_cavities
from voxsoft.formats.contents import CORNERS, Contents
from voxsoft.formats.parts import CAVITY, Parts, parts_of
from voxsoft.formats.report import ReadReport, counted_cells, held_by
from voxsoft.formats.split import FACES, Tets, tets_of
from voxsoft.formats.unit import doubt, meter_of
from voxsoft.mesh import Mesh

#: Corners of the faces S1 to S4 of a tetrahedron of Abaqus, outward.
ABAQUS_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))


def mesh_of_contents(path: Path, contents: Contents, unit: str | None) -> MeshFile:
    """Return the tetrahedra of a file with its parts and regions.

    Raises
    ------
    FileError
        If there is no volume cell, or one that cannot be cut into tetrahedra.
    MeshError
        If the tetrahedra are no mesh.
    UnitError
        If neither the file nor the caller gives the unit.
    """
    where = str(path)
    cut = tets_of(contents, where)
    if not len(cut.tets):
        what = f"holds no volume cells, but {_kinds(contents)}"
        raise FileError(where, what, "enter it as a shape and voxelize it")
    used, tets = np.unique(cut.tets, return_inverse=True)
    tets = tets.reshape(-1, 4)
    points = contents.points[used]
    meter = meter_of(where, contents.unit, unit, points, "unit=")
    cells = np.unique(cut.cell)
    parts = parts_of(contents, cells, where)
    number = parts.number[np.searchsorted(cells, cut.cell)]
    mesh = Mesh.from_tets(points if meter == 1.0 else points * meter, tets, number)
    new = np.full(len(contents.points), -1)
    new[used] = np.arange(len(used))
    surfaces = _cavities(contents, new)
    notes: list[str] = []
    if surfaces:
        mesh = with_cavities(mesh, surfaces, where)
    middles = _middle_nodes(contents)
    regions: dict[str, NDArray[np.int64]] = {}
    for name, members in _point_sets(contents).items():
        vertices = np.unique(new[members][new[members] >= 0])
        if len(vertices):
            regions[name] = vertices
        lost = len(np.setdiff1d(members[new[members] < 0], middles))
        if lost:
            notes.append(f"Region {name} loses {counted(lost, 'point')} that no volume cell uses")
    if lone := len(contents.points) - len(used) - len(middles):
        notes.append(f"{counted(lone, 'point')} that no volume cell uses: left out")
    data = {name: values[cut.cell] for name, values in contents.arrays.items() if name != "part"}
    report = _report(contents, cut, parts, mesh, regions, meter, notes)
    if unit is not None and contents.unit is not None and contents.unit != meter:
        text = f"The file says 1 = {contents.unit:g} m; the given unit counts: 1 = {meter:g} m"
        report = replace(report, cautions=(*report.cautions, text))
    return MeshFile(replace(mesh, report=report), regions, {}, data)


def _kinds(contents: Contents) -> str:
    kinds = held_by(contents)["cells"].items()
    return ", ".join(counted_cells(kind, count) for kind, count in kinds) or "no cells at all"


def _cavities(contents: Contents, new: NDArray[np.int64]) -> list[NDArray[np.integer]]:
    """Return the triangles of the cavities that our own files name, in their order."""
    cells = np.concatenate(
        [np.empty(0, np.int64), *(np.full(len(b.nodes), i) for i, b in enumerate(contents.blocks))]
    )
    firsts = np.cumsum([0, *(len(block.nodes) for block in contents.blocks)])
    faces: dict[int, list[NDArray[np.integer]]] = {}
    for name, members in contents.cell_sets.items():
        match = CAVITY.fullmatch(name)
        if match is None:
            continue
        for index in np.unique(cells[members]).tolist():
            block = contents.blocks[index]
            rows = new[block.nodes[members[cells[members] == index] - firsts[index]]]
            if match[2] and block.kind == "tetra":
                rows = rows[:, list(ABAQUS_FACES[int(match[2]) - 1])]
            if rows.shape[1] == 3 and (rows >= 0).all():
                faces.setdefault(int(match[1]), []).append(rows)
    return [np.concatenate(faces[number]) for number in sorted(faces)]


def _report(
    contents: Contents,
    cut: Tets,
    parts: Parts,
    mesh: Mesh,
    regions: dict[str, NDArray[np.int64]],
    meter: float,
    notes: list[str],
) -> ReadReport:
    differences = [*contents.notes, *cut.notes, *parts.notes, *notes]
    for kind, count in held_by(contents)["cells"].items():
        base = kind.rstrip("0123456789")
        if base not in FACES and (base not in CORNERS or CORNERS[base] > 1):
            differences.append(
                f"{counted_cells(kind, count)}: no volume, only their sets are regions"
            )
    extents = np.ptp(mesh.vertices, axis=0) / meter
    cautions = [text] if (text := doubt(extents, meter)) else []
    counts = np.bincount(mesh.tet_part)
    taken = {
        "vertices": len(mesh.vertices),
        "tets": len(mesh.tets),
        "parts": {name: int(counts[number]) for number, name in parts.names.items()},
        "regions": {name: len(found) for name, found in regions.items()},
        "arrays": list(contents.arrays),
    }
    return ReadReport(
        contents.format,
        meter,
        held_by(contents),
        taken,
        dict(parts.names),
        tuple(differences),
        tuple(cautions),
    )


def _point_sets(contents: Contents) -> dict[str, NDArray[np.int64]]:
    """Return the points of each region: of sets of points, and of sets of faces and lines."""
    found: dict[str, NDArray[np.int64]] = {}
    for name, cells in contents.cell_sets.items():
        first = 0
        points = [np.empty(0, np.int64)]
        for block in contents.blocks:
            inside = cells[(cells >= first) & (cells < first + len(block.nodes))] - first
            if block.kind.rstrip("0123456789") not in FACES:
                points.append(block.nodes[inside].ravel())
            first += len(block.nodes)
        if len(marked := np.unique(np.concatenate(points))):
            found[name] = marked
    found |= contents.point_sets
    is_cavity = {name for name in contents.cell_sets if CAVITY.fullmatch(name)}
    return {name: points for name, points in found.items() if name not in is_cavity}


def _middle_nodes(contents: Contents) -> NDArray[np.int64]:
    """Return the points that are only nodes of edges and middles of cells."""
    corners, others = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for block in contents.blocks:
        base = block.kind.rstrip("0123456789")
        if base in FACES:
            corners.append(block.nodes[:, : CORNERS[base]].ravel())
            others.append(block.nodes[:, CORNERS[base] :].ravel())
    return np.setdiff1d(np.concatenate(others), np.concatenate(corners))
