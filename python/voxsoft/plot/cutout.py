"""A small picture of a body without a background, for lists on pages of any color."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.mesh import Mesh
from voxsoft.plot import shading
from voxsoft.plot.boundary import boundary_of
from voxsoft.plot.camera import Camera
from voxsoft.plot.objects import Surroundings
from voxsoft.plot.raster import rasterize

Floats = NDArray[np.float64]

#: Pixels of the longer side.
PIXELS: Final = 240
_FINER: Final = 2
#: Color of clay.
_COLORS: Final = ("#e8b88a",)


@dataclass(frozen=True, eq=False)
class Cutout:
    """Picture with its scale.

    Attributes
    ----------
    pixels
        Red, green, blue and opacity, (h, w, 4).
    per_meter
        Number of pixels in a meter.
    """

    pixels: NDArray[np.uint8] = field(repr=False)
    per_meter: float


def cutout(
    mesh: Mesh,
    positions: Floats | None = None,
    *,
    pixels: int = PIXELS,
    colors: Sequence[str] = _COLORS,
    view: tuple[float, float] = (-60.0, 25.0),
    around: Surroundings | None = None,
) -> Cutout:
    """Draw a body in the colors of its parts, with the rigid objects it is to touch.

    Parameters
    ----------
    mesh
        Mesh of the body.
    positions
        Positions of its vertices in m, (n, 3); default: unloaded.
    pixels
        Size of the longer side in pixels.
    colors
        Colors of the parts in turn, as ``"#rrggbb"``.
    view
        Azimuth and elevation of the eye in degrees.
    around
        Rigid objects and the floor; default: none.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> picture = cutout(vs.mesh_of(families.sphere()), pixels=64).pixels
    >>> picture.shape[2], int(picture[0, 0, 3]), int(picture[32, 32, 3])
    (4, 0, 255)
    """
    positions = mesh.vertices if positions is None else positions
    around = around or Surroundings()
    camera = Camera.around(around.near(positions), view, pixels * _FINER)
    surface = boundary_of(mesh, np.ones(len(mesh.tets), dtype=bool))
    seen = rasterize(camera.project(positions), surface.triangles, camera.width, camera.height)
    light = shading.lit(shading.normals_of(positions[surface.triangles]), camera)[seen.triangle]
    light *= shading.depth_contrast(seen) * shading.outlines(seen)
    palette = np.array([[int(color[at : at + 2], 16) for at in (1, 3, 5)] for color in colors])
    of_part = palette[(surface.part.astype(np.int64) - 1) % len(palette)] / 255.0
    solid = np.concatenate([of_part[seen.triangle] * light[:, None], np.ones((len(light), 1))], 1)
    drawn = around.drawn_over(seen.spread(solid, 0.0), seen, camera, positions)
    # Colors are averaged over covered pixels alone, so that no seam of another color shows.
    sums = _averaged(drawn)
    sums, opacity = sums[..., :3], sums[..., 3:]
    color = np.divide(sums, opacity, out=np.zeros_like(sums), where=opacity > 0.0)
    picture = np.clip(np.concatenate([color, opacity], axis=2), 0.0, 1.0)
    return Cutout(np.rint(255.0 * picture).astype(np.uint8), 1.0 / (camera.pixel * _FINER))


def _averaged(picture: Floats) -> Floats:
    """Average the finer pixels of a picture; the remainder at the ends is empty."""
    height, width = (-(-side // _FINER) * _FINER for side in picture.shape[:2])
    full = np.zeros((height, width, picture.shape[2]))
    full[: picture.shape[0], : picture.shape[1]] = picture
    averaged: Floats = full.reshape(
        height // _FINER, _FINER, width // _FINER, _FINER, picture.shape[2]
    ).mean(axis=(1, 3))
    return averaged
