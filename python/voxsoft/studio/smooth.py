"""The smooth surface of a design's shapes, as it would be without voxels."""

from __future__ import annotations

import struct
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.studio.surface import MAGIC

#: Kind of the binary message.
SMOOTH: Final = 3
#: Points at which the shapes are asked, in all.
MOST_POINTS: Final = 400_000
#: Cells across a voxel, where there are points enough.
_FINEST: Final = 2


def pack_smooth(design: Design, topology: int) -> bytes | None:
    """Trace the surface of all parts of a design together, and write it as the page reads it.

    Marching cubes on samples of the shapes, on a grid of half a voxel or coarser.

    Returns
    -------
    bytes or None
        None where the shapes have no surface that could be traced.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> packed = pack_smooth(families.sphere(), 1)
    >>> packed is not None and packed[4]
    3
    """
    import igl

    parts = [
        design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        for part in design.parts
    ]
    try:
        built = [part.build(design.shapes) for part in parts]
        bounds = np.array([shape.bounds() for shape in built])
    except VoxSoftError:
        return None
    low, high = bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)
    if not (np.isfinite(low).all() and np.isfinite(high).all() and (high > low).all()):
        return None
    step = max(design.voxel_size / _FINEST, float((np.prod(high - low) / MOST_POINTS) ** (1 / 3)))
    counts = np.ceil((high - low) / step).astype(int) + 3
    axes = [low[a] + step * (np.arange(counts[a]) - 1) for a in range(3)]
    # The first axis runs quickest, as igl wants it.
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    values = np.min([shape.evaluate(points) for shape in built], axis=0)
    values = np.nan_to_num(values, nan=step, posinf=step, neginf=-step)
    vertices, triangles, _ = igl.marching_cubes(values, points, *counts.tolist(), 0.0)
    if len(triangles) == 0:
        return None
    head = struct.pack(
        "<IBBHIIdIII28x", MAGIC, SMOOTH, 0, 0, topology, 0, step, len(vertices), len(triangles), 0
    )
    packed: bytes = head + vertices.astype("<f4").tobytes() + triangles.astype("<u4").tobytes()
    return packed
