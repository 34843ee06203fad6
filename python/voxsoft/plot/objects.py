"""Rigid objects in pictures of bodies: gray, and so that what is behind them shows through."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.plot import shading
from voxsoft.plot.boundary import Axis
from voxsoft.plot.camera import Camera
from voxsoft.plot.raster import Raster, rasterize
from voxsoft.simulation import Result
from voxsoft.simulation.apart import Surface
from voxsoft.simulation.posed import posed_surface

Floats = NDArray[np.float64]

_GRAY: Final = 0.6
#: How much of a picture an object takes, and how much its outline.
_OPACITY: Final = 0.5
_OUTLINE: Final = 0.9
#: How far around a body its objects are shown, in lengths of its longest side.
_AROUND: Final = 1.0


def objects_of(result: Result) -> Surface | None:
    """The surfaces of all rigid objects where they are in a result; None where there is none."""
    names = [each.name for each in result.design.objects]
    found = [posed_surface(result.design, name, result.objects.get(name)) for name in names]
    if not found:
        return None
    counts = np.cumsum([0, *(len(each.vertices) for each in found)])
    triangles = [each.triangles + first for each, first in zip(found, counts, strict=False)]
    vertices = np.concatenate([each.vertices for each in found])
    return Surface(vertices, np.concatenate(triangles).astype(np.uint32))


def near(objects: Surface, body: Floats) -> Floats:
    """What a picture has to hold of objects beside a body, (n, 3), which they do not dwarf."""
    low, high = body.min(axis=0), body.max(axis=0)
    around = _AROUND * float((high - low).max())
    shown: Floats = np.clip(objects.vertices, low - around, high + around)
    return shown


def cut(objects: Surface, axis: Axis, position: float, side: int) -> Surface:
    """What a section leaves of objects: they are hollow, so that their insides show."""
    beyond = side * (objects.vertices[:, "xyz".index(axis)] - position)
    kept = (beyond > 0.0)[objects.triangles]
    count = kept.sum(axis=1)
    pieces = [objects.vertices[objects.triangles[count == 3]]]
    for left in (1, 2):
        crossed = count == left
        # The corner that is alone on its side comes first.
        alone = (kept[crossed] == (left == 1)).argmax(axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(objects.triangles[crossed], turned, axis=1)
        (a, b, c), (at_a, at_b, at_c) = objects.vertices[corners].swapaxes(0, 1), beyond[corners].T
        ab = a + (at_a / (at_a - at_b))[:, None] * (b - a)
        ac = a + (at_a / (at_a - at_c))[:, None] * (c - a)
        parts = [(a, ab, ac)] if left == 1 else [(ab, b, c), (ab, c, ac)]
        pieces += [np.stack(part, axis=1) for part in parts]
    corners = np.concatenate(pieces).reshape(-1, 3)
    triangles = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    return Surface(corners, np.concatenate([triangles, triangles[:, ::-1]]))


def with_objects(picture: Floats, seen: Raster, objects: Surface, camera: Camera) -> Floats:
    """Draw objects over a picture, (h, w, 3), where they are in front of its body."""
    if len(objects.triangles) == 0:
        return picture
    points, triangles = camera.project(objects.vertices), objects.triangles.astype(np.int64)
    before = rasterize(points, triangles, camera.width, camera.height)
    if len(before.pixels) == 0:
        return picture
    normals = shading.normals_of(objects.vertices[triangles])
    light = shading.lit(normals, camera)[before.triangle]
    outlines = shading.outlines(before)
    opacity = np.where(outlines < 1.0, _OUTLINE, _OPACITY)
    in_front = before.depth < seen.spread(seen.depth, np.inf).ravel()[before.pixels]
    opacity = before.spread(np.where(in_front, opacity, 0.0), 0.0)[..., None]
    gray = before.spread(_GRAY * light * outlines, 0.0)[..., None]
    drawn: Floats = (1.0 - opacity) * picture + opacity * gray
    return drawn
