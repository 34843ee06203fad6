"""Writer of Wavefront OBJ: an object for each surface."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.surface_formats.numbers import rows


def write(
    path: Path, surfaces: Mapping[str, tuple[NDArray[np.float64], NDArray[np.int64]]]
) -> None:
    """Write surfaces one after the other, each an object and a group of its name."""
    first = 1
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.write("# Written by VoxSoft\n")
        for name, (vertices, triangles) in surfaces.items():
            title = "_".join(name.split())
            file.write(f"o {title}\ng {title}\n")
            file.writelines(rows("v %.9g %.9g %.9g\n", vertices))
            file.writelines(rows("f %d %d %d\n", triangles + first))
            first += len(vertices)
