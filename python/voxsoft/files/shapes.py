"""The shape that was simulated as closed surfaces of its parts."""

from __future__ import annotations

import os
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import FileError
from voxsoft.files.surfaces import Triangles, surfaces_of, write_surfaces
from voxsoft.mesh import Mesh
from voxsoft.simulation import Result
from voxsoft.simulation.setup.smooth_surfaces import part_names, smooth_surfaces


def write_shape(
    path: str | os.PathLike[str],
    body: Design | Result,
    *,
    deformed: bool = False,
    unit: str | None = None,
    voxels: bool = False,
) -> None:
    """Write the shape that is simulated: STL, OBJ, 3MF or GLB by the name's suffix.

    Each part is a smooth closed surface of the volume that its voxels have, see
    :func:`shape_of`.

    Parameters
    ----------
    path
        File.
    body
        A design, or a result.
    deformed
        True for the shape under load, of a result.
    unit
        Unit of the numbers, see :func:`voxsoft.files.write_surfaces`.
    voxels
        True for the faces of the voxels.

    Raises
    ------
    FileError
        See :func:`voxsoft.files.write_surfaces`; or a design has no shape under load.
    ShapeError
        The design cannot be meshed.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from voxsoft.design import families
    >>> path = Path(tempfile.mkdtemp(), "ball.3mf")
    >>> write_shape(path, families.sphere())
    >>> path.stat().st_size > 1000
    True
    """
    if isinstance(body, Result):
        positions = body.positions if deformed else None
        surfaces = shape_of(body.design, body.mesh, positions, voxels=voxels)
    elif deformed:
        raise FileError(str(path), "a design has no shape under load", "give a result of its run")
    else:
        surfaces = shape_of(body, mesh_of(body), voxels=voxels)
    write_surfaces(path, surfaces, unit)


def shape_of(
    design: Design,
    mesh: Mesh,
    positions: NDArray[np.float64] | None = None,
    *,
    voxels: bool = False,
) -> dict[str, Triangles]:
    """Return vertices [m] and triangles around each part of a design by its name.

    Surfaces are those of the shapes, moved until each part has the volume of its voxels. Parts that
    touch share the points between them, so their volumes sum to that of the body. Cavities are
    surfaces within a part. A body of tetrahedra from a file has their faces.

    Parameters
    ----------
    design
        The design.
    mesh
        Its mesh.
    positions
        Positions of the vertices of the mesh under load [m], (n, 3); default: unloaded.
    voxels
        True for the faces of the voxels, cut ones as if they were full.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere()
    >>> [(name, points.shape[1]) for name, (points, _) in shape_of(ball, mesh_of(ball)).items()]
    [('body', 3)]
    """
    smooth = None if voxels else smooth_surfaces(design, mesh)
    if smooth is not None:
        return smooth.surfaces(positions)
    moved = mesh if positions is None else replace(mesh, vertices=positions)
    return surfaces_of(moved, part_names(design))
