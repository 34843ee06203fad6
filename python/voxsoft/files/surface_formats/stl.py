"""Writer of STL: binary for one surface, text with a solid for each of several."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.surface_formats.numbers import rows
from voxsoft.formats.stl import FACET

_HEAD: Final = b"Written by VoxSoft".ljust(80)
_FACET: Final = (
    "facet normal %.6g %.6g %.6g\nouter loop\n"
    + 3 * "vertex %.9g %.9g %.9g\n"
    + "endloop\nendfacet\n"
)


def write(
    path: Path, surfaces: Mapping[str, tuple[NDArray[np.float64], NDArray[np.int64]]]
) -> None:
    """Write surfaces; each line of a text that names a solid has the name of its surface."""
    if len(surfaces) == 1:
        ((vertices, triangles),) = surfaces.values()
        facets = np.zeros(len(triangles), FACET)
        facets["numbers"] = _facets(vertices, triangles)
        count = np.uint32(len(triangles)).tobytes()
        path.write_bytes(_HEAD + count + facets.tobytes())
        return
    with path.open("w", encoding="utf-8", newline="\n") as file:
        for name, (vertices, triangles) in surfaces.items():
            title = " ".join(name.split())
            file.write(f"solid {title}\n")
            file.writelines(rows(_FACET, _facets(vertices, triangles)))
            file.write(f"endsolid {title}\n")


def _facets(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return normal and corners of each triangle, (t, 12)."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals /= np.where(lengths > 0.0, lengths, 1.0)
    return np.hstack([normals, corners.reshape(-1, 9)])
