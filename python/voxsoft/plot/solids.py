"""Pictures of solids beside each other, each in its color, such as the parts of a mold."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.plot import shading
from voxsoft.plot.camera import Camera
from voxsoft.plot.raster import rasterize
from voxsoft.plot.style import empty_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
#: Vertices (n, 3) [m], triangles (t, 3), and color as ``"#rrggbb"``.
Solid = tuple[Floats, NDArray[np.int64], str]

#: Pixels of the longer side; it is computed twice as fine and averaged.
_PIXELS: Final = 560
_FINER: Final = 2


def plot_solids(
    solids: Sequence[Solid], *, view: tuple[float, float] = (-60.0, 28.0), title: str = ""
) -> Figure:
    """Draw solids at their places, shaded.

    Parameters
    ----------
    solids
        Vertices (n, 3) [m], outward triangles (t, 3) and color, ``"#rrggbb"``, of each.
    view
        Azimuth and elevation of the eye in degrees.
    title
        Text above the picture.

    Examples
    --------
    >>> corners = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]])
    >>> faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> plot_solids([(corners, faces, "#e8b88a")]).axes[0].get_label()
    'solids'
    """
    vertices = np.concatenate([each[0] for each in solids])
    starts = np.cumsum([0, *(len(each[0]) for each in solids)])[:-1]
    triangles = np.concatenate([s[1] + k for s, k in zip(solids, starts, strict=True)])
    rgb = [[int(s[2][at : at + 2], 16) / 255.0 for at in (1, 3, 5)] for s in solids]
    colors = np.repeat(np.array(rgb), [len(each[1]) for each in solids], axis=0)
    camera = Camera.around(vertices, view, _PIXELS * _FINER)
    seen = rasterize(camera.project(vertices), triangles, camera.width, camera.height)
    light = shading.lit(shading.normals_of(vertices[triangles]), camera)[seen.triangle]
    light *= shading.depth_contrast(seen) * shading.outlines(seen)
    picture = seen.spread(colors[seen.triangle] * light[:, None], 1.0)
    height, width = (side // _FINER for side in picture.shape[:2])
    small = picture[: height * _FINER, : width * _FINER]
    small = small.reshape(height, _FINER, width, _FINER, 3).mean(axis=(1, 3))
    figure = empty_figure(width / 100.0, height / 100.0 + (0.3 if title else 0.0))
    axes = figure.add_subplot(label="solids")
    axes.imshow(np.clip(small, 0.0, 1.0), interpolation="none")
    axes.set_axis_off()
    if title:
        axes.set_title(title, fontsize=9)
    return figure
