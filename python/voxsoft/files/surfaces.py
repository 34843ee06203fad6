"""Closed surfaces with names to files for printers, slicers, CAD and viewers."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from voxsoft.errors import FileError
from voxsoft.files.atomic import replace_whole
from voxsoft.formats.registry import WRITTEN, Format, function
from voxsoft.mesh import Mesh
from voxsoft.units import parse

#: Vertices (n, 3) and triangles (t, 3), outward.
Triangles = tuple[NDArray[np.float64], NDArray[np.int64]]
#: Bits of the mantissa of a 32-bit number, and the largest coordinate that is written.
_BITS, _LARGEST = 24, 1e30
#: Corners of the faces of a tetrahedron of positive volume, outward.
_FACES: Final = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))


def write_surfaces(
    path: str | os.PathLike[str],
    surfaces: Mapping[str, tuple[ArrayLike, ArrayLike]],
    unit: str | None = None,
) -> None:
    """Write closed surfaces, each by its name: STL, OBJ, 3MF or GLB by the name's suffix.

    Coordinates are rounded to multiples of some 1e-7 of the largest, which 32-bit numbers hold, as
    STL and GLB have them. Vertices that become one by that are joined, and triangles of
    fewer than three are left out: surfaces stay closed.

    Parameters
    ----------
    path
        File; an existing one is replaced once the new one is complete. STL of one surface is
        binary, of several a text with a solid for each. 3MF joins several as the components of one
        object, so that a slicer keeps them at their places.
    surfaces
        Vertices (n, 3) [m] and triangles (t, 3), outward, of each surface by its name.
    unit
        Unit of the numbers of STL and OBJ, which do not say it; default: mm, as slicers read them.
        3MF is in mm and GLB in m, and both say so.

    Raises
    ------
    FileError
        Another suffix, no surface, vertices that are missing or not finite, a surface without
        area, a unit that the format does not take, or a file that cannot be written.
    UnitError
        `unit` is no length.

    Examples
    --------
    >>> import tempfile
    >>> corners = [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]
    >>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    >>> path = Path(tempfile.mkdtemp(), "tip.3mf")
    >>> write_surfaces(path, {"tip": (corners, faces)})
    >>> path.read_bytes()[:2]
    b'PK'
    """
    target = Path(path)
    form = WRITTEN.get(target.suffix.lower())
    if form is None or form.writer is None or form.kind != "surface":
        known = " ".join(suffix for suffix, each in WRITTEN.items() if each.kind == "surface")
        what = f"{target.suffix!r} is no format of surfaces; allowed are {known}"
        raise FileError(str(target), what)
    if not surfaces:
        raise FileError(str(target), "there is no surface to write", "give one by its name")
    meter = parse(f"1 {unit_of_surfaces(target, form, unit)}", "length", where="unit")
    found = {name: _checked(target, name, *each, meter) for name, each in surfaces.items()}
    largest = max(float(np.abs(points).max()) for points, _ in found.values())
    # A power of two, of which 32-bit numbers up to the largest are multiples.
    step = 2.0 ** (np.frexp(largest)[1] - _BITS)
    ready = {name: _joined(target, name, *each, step) for name, each in found.items()}
    writer = function(form.writer)
    replace_whole(target, lambda temporary: writer(temporary, ready))


def unit_of_surfaces(target: Path, form: Format, unit: str | None) -> str:
    """Return the unit of the numbers in a file of surfaces.

    Raises
    ------
    FileError
        The format does not take this unit.
    """
    fixed = form.fixed_unit
    if unit is not None and fixed is not None and unit != fixed:
        free = [suffix for suffix, other in WRITTEN.items() if other.fixed_unit is None]
        hint = f"leave the unit out; it is for {' and '.join(free)}"
        raise FileError(str(target), f"{form.suffix} {form.unit}", hint)
    return unit or fixed or "mm"


def surfaces_of(mesh: Mesh, names: Mapping[int, str]) -> dict[str, Triangles]:
    """Return the faces of the tetrahedra of each part that are not between two of its own.

    Parameters
    ----------
    mesh
        Mesh.
    names
        Name of each part by its number; a part without one is called ``part-N``.

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 2]]], voxel_size=0.005).mesh()
    >>> {name: len(faces) for name, (_, faces) in surfaces_of(mesh, {2: "tip"}).items()}
    {'part-1': 12, 'tip': 12}
    """
    found: dict[str, Triangles] = {}
    for part in np.unique(mesh.tet_part).tolist():
        tets = mesh.tets[mesh.tet_part == part].astype(np.int64)
        faces = tets[:, _FACES].reshape(-1, 3)
        _, first, count = np.unique(
            np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True
        )
        outer = faces[np.sort(first[count == 1])]
        used, triangles = np.unique(outer, return_inverse=True)
        name = unlike(names.get(part, f"part-{part}"), found)
        found[name] = (mesh.vertices[used], triangles.reshape(-1, 3))
    return found


def unlike(name: str, others: Mapping[str, object]) -> str:
    """Return a name that is not among others: itself, or with a number.

    Examples
    --------
    >>> unlike("skin", {"core": 0}), unlike("skin", {"skin": 0})
    ('skin', 'skin 2')
    """
    number, found = 2, name
    while found in others:
        found, number = f"{name} {number}", number + 1
    return found


def _checked(
    target: Path, name: str, vertices: ArrayLike, triangles: ArrayLike, meter: float
) -> Triangles:
    """Return a surface in the file's unit."""
    where = str(target)
    points = np.asarray(vertices, dtype=np.float64)
    faces = np.asarray(triangles)
    if points.ndim != 2 or points.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
        what = f"surface {name!r} has vertices {points.shape} and triangles {faces.shape}"
        raise FileError(where, what, "give arrays of shapes (n, 3) and (t, 3)")
    if faces.dtype.kind not in "iu" or not len(faces):
        raise FileError(where, f"surface {name!r} has no triangles of whole numbers")
    if faces.min() < 0 or faces.max() >= len(points):
        what = f"surface {name!r} names vertex {faces.max()}; there are {len(points):,} from 0"
        raise FileError(where, what)
    used, own = np.unique(faces, return_inverse=True)
    points = points[used] / meter
    if not np.isfinite(points).all() or np.abs(points).max() > _LARGEST:
        raise FileError(where, f"surface {name!r} has a vertex that is not finite")
    return points, own.reshape(-1, 3).astype(np.int64)


def _joined(
    target: Path, name: str, points: NDArray[np.float64], triangles: NDArray[np.int64], step: float
) -> Triangles:
    """Round vertices to multiples of a step, and join those at one place."""
    # Adding zero makes one of -0 and 0.
    rounded = np.rint(points / step) * step + 0.0
    merged, index = np.unique(rounded, axis=0, return_inverse=True)
    joined = index.reshape(-1)[triangles]
    a, b, c = joined.T
    kept = joined[(a != b) & (b != c) & (c != a)]
    if not len(kept):
        raise FileError(str(target), f"surface {name!r} has no area", "check its unit")
    used, own = np.unique(kept, return_inverse=True)
    return merged[used], own.reshape(-1, 3).astype(np.int64)
