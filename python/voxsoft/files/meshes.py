"""Meshes to and from files in the format of the name's suffix.

Formats and the contents that each keeps: :mod:`voxsoft.formats.registry`. Only ``.vtu`` keeps which
voxel a tet belongs to. Surface formats can be written, not read: a surface enters as a shape.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.errors import DesignError, FileError, MeshError
from voxsoft.files import vtu
from voxsoft.files.atomic import replace_whole
from voxsoft.files.from_contents import mesh_of_contents
from voxsoft.files.mesh_file import MeshFile, vertex_set
from voxsoft.files.surfaces import surfaces_of, write_surfaces
from voxsoft.formats.read import read_contents
from voxsoft.formats.registry import READ, WRITTEN, function, suffixes_that_hold
from voxsoft.mesh import Mesh
from voxsoft.records import check_name
from voxsoft.shapes.cad_files import HINT, WHAT, is_cad_file


def write_mesh(
    path: str | os.PathLike[str],
    mesh: Mesh,
    *,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
    regions: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write a mesh to a file; an existing one is replaced once the new one is complete.

    Parameters
    ----------
    path
        Name of the file; its suffix chooses the format (:mod:`voxsoft.formats.registry`). Of the
        surface formats STL and OBJ are written in m: :func:`voxsoft.files.write_surfaces` takes
        another unit.
    mesh
        Mesh to write. A surface file has the faces of each part, which are stairs of voxels.
    point_data, cell_data : mappings of str to array_like, shape (n, ...) or (m, ...), optional
        Values at vertices and in tets, such as displacements and stretches; ``.vtu`` only.
    regions : mapping of str to array_like of int, optional
        Vertices of each named region. In ``.msh`` and ``.inp`` a name of more than letters, digits,
        ``_`` and ``-`` becomes a label of these; reading restores the name.

    Raises
    ------
    FileError
        If the format cannot hold the arguments, or the file cannot be written.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 2]]], voxel_size=0.005).mesh()
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "two.vtu"
    >>> write_mesh(path, mesh, regions={"base": [0, 1, 2]})
    >>> read_mesh(path).tet_part.tolist()
    [1, 1, 1, 1, 1, 2, 2, 2, 2, 2]
    """
    target = Path(path)
    suffix = target.suffix.lower()
    form = WRITTEN.get(suffix)
    if form is None or form.writer is None or not form.has_shape:
        raise _unknown_format(target, [s for s, form in WRITTEN.items() if form.has_shape])
    content = MeshFile(
        mesh,
        _checked_regions(target, regions or {}, len(mesh.vertices)),
        _checked_data(target, "point_data", point_data or {}, len(mesh.vertices)),
        _checked_data(target, "cell_data", cell_data or {}, len(mesh.tets)),
    )
    if "values" not in form.holds and (content.point_data or content.cell_data):
        what = f"{suffix} cannot hold data"
        raise FileError(str(target), what, f"write a {suffixes_that_hold('values')} file")
    if "regions" not in form.holds and content.regions:
        what = f"{suffix} cannot hold regions"
        raise FileError(str(target), what, f"write {suffixes_that_hold('regions')}")
    if form.kind == "surface":
        write_surfaces(target, surfaces_of(mesh, {}), form.fixed_unit or "m")
        return
    writer = function(form.writer)
    replace_whole(target, lambda temporary: writer(temporary, content))


def read_mesh(path: str | os.PathLike[str], *, unit: str | None = None) -> Mesh:
    """Return the mesh of a file; see :func:`read_mesh_file`."""
    return read_mesh_file(path, unit=unit).mesh


def read_mesh_file(path: str | os.PathLike[str], *, unit: str | None = None) -> MeshFile:
    """Return the mesh of a file with its parts, regions, data, and a report on the read.

    Volume cells of all kinds are taken, cut into tetrahedra where they are others; cells of lower
    dimension only where they name a region. Sets of cells, physical volumes and arrays such as
    ``material`` are parts. Cavities that the file does not name are found.

    Parameters
    ----------
    path
        Path of the file.
    unit
        Unit of its numbers: ``"mm"``, ``"cm"``, ``"m"``, ``"inch"``, or of an array of voxels the
        side of one, ``"0.5 mm"``. Files that were written here, and formats that state their unit,
        need none.

    Returns
    -------
    MeshFile
        Mesh file; its `report` lists all contents, and each difference from the mesh.

    Raises
    ------
    FileError
        If the file is missing, cut short, of another format, or holds no valid volume cells.
    UnitError
        If neither the file nor `unit` gives the unit; the message has the size in each.

    Examples
    --------
    >>> read_mesh_file("no-such-file.vtu")
    Traceback (most recent call last):
        ...
    voxsoft.errors.FileError: no-such-file.vtu: no such file
    """
    source = Path(path)
    suffix = source.suffix.lower()
    if suffix in READ and READ[suffix].kind == "surface":
        hint = "enter it as a shape and voxelize it"
        raise FileError(str(source), f"{suffix} holds a surface, not tetrahedra", hint)
    if is_cad_file(source.name):
        raise FileError(str(source), WHAT, HINT)
    try:
        if suffix == ".vtu" and source.is_file() and vtu.is_ours(source):
            if unit not in (None, "m"):
                what = f"was written by VoxSoft, in m; the unit {unit} was given"
                raise FileError(str(source), what, "leave the unit out")
            return vtu.read(source)
        return mesh_of_contents(source, read_contents(source), unit)
    except MeshError as error:
        raise FileError(str(source), f"{error.where}: {error.what}", error.hint) from error


def _unknown_format(path: Path, known: list[str]) -> FileError:
    what = f"unknown format {path.suffix!r}; allowed are {', '.join(known)}"
    return FileError(str(path), what)


def _checked_regions(
    path: Path, regions: Mapping[str, ArrayLike], count: int
) -> dict[str, NDArray[np.int64]]:
    for name in regions:
        try:
            check_name(name)
        except DesignError as error:
            raise FileError(str(path), f"a region: {error.what}", error.hint) from None
    return {name: vertex_set(str(path), name, v, count) for name, v in regions.items()}


def _checked_data(
    path: Path, kind: str, data: Mapping[str, ArrayLike], count: int
) -> dict[str, NDArray[np.generic]]:
    arrays: dict[str, NDArray[np.generic]] = {name: np.asarray(v) for name, v in data.items()}
    for name, array in arrays.items():
        if array.shape[:1] != (count,) or array.dtype.kind not in "iuf":
            what = f"{kind}[{name!r}] has shape {array.shape} of {array.dtype}"
            raise FileError(str(path), f"{what}; expected ({count}, ...) numbers")
    return arrays
