"""Reader of surfaces, by trimesh: glTF binary, and dialects of OFF that meshio does not take."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats import by_meshio
from voxsoft.formats.contents import CellBlock, Contents

if TYPE_CHECKING:
    import trimesh


def read_after_meshio(path: Path) -> Contents:
    """Read a file by meshio, else by trimesh.

    Raises
    ------
    FileError
        If neither can read it, with meshio's message.
    """
    try:
        return by_meshio.read(path)
    except FileError as error:
        try:
            return read(path)
        except FileError:
            raise error from None


def read(path: Path) -> Contents:
    """Read all bodies of a file, at their positions in its scene.

    Raises
    ------
    FileError
        If trimesh cannot read it.
    """
    import trimesh

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = trimesh.load_scene(path, process=False)
            bodies = scene.dump(concatenate=False)
    # trimesh raises all errors of its parsers.
    except Exception as error:
        kind = path.suffix.lstrip(".").upper()
        what = f"cannot be read as {kind}: trimesh does not understand its content"
        raise FileError(str(path), what, "save it again, or as STL or OBJ") from error
    return _contents(path, [body for body in bodies if isinstance(body, trimesh.Trimesh)])


def _contents(path: Path, bodies: list[trimesh.Trimesh]) -> Contents:
    if not bodies:
        raise FileError(str(path), "holds no triangles", "save the surface, or as STL or OBJ")
    firsts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
    counts = np.cumsum([0, *(len(body.faces) for body in bodies)])
    sets: dict[str, NDArray[np.int64]] = {}
    if len(bodies) > 1:
        for number, body in enumerate(bodies):
            name = str(body.metadata.get("node") or body.metadata.get("name") or number + 1)
            cells = np.arange(counts[number], counts[number + 1])
            sets[name] = np.concatenate([sets[name], cells]) if name in sets else cells
    triangles = [
        body.faces.reshape(-1, 3) + first for body, first in zip(bodies, firsts, strict=False)
    ]
    is_gltf = path.suffix.lower() == ".glb"
    points = np.concatenate([body.vertices for body in bodies]).astype(np.float64)
    if is_gltf:
        points = points[:, [0, 2, 1]] * (1.0, -1.0, 1.0)
    return Contents(
        points,
        (CellBlock("triangle", np.concatenate(triangles).astype(np.int64)),),
        sets,
        # glTF is in meters by its own specification.
        unit=1.0 if is_gltf else None,
        notes=("The y axis, which points up in glTF, is turned into z",) * is_gltf,
        format="glTF binary" if is_gltf else path.suffix.lower().lstrip("."),
    )
