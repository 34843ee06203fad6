"""Surroundings of a body in its pictures: rigid objects, drawn translucent, and the floor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.plot import shading
from voxsoft.plot.boundary import Axis
from voxsoft.plot.camera import Camera
from voxsoft.plot.raster import Raster, rasterize
from voxsoft.simulation.results.posed import posed_surface
from voxsoft.simulation.setup.contact import Pose
from voxsoft.simulation.setup.distance import Surface

Floats = NDArray[np.float64]


class _Look(NamedTuple):
    """Gray of a surface, and opacity of its faces and its outline."""

    gray: float
    opacity: float
    outline: float


_OBJECT: Final = _Look(0.6, 0.5, 0.9)
_FLOOR: Final = _Look(0.85, 0.4, 0.4)
#: Distance around a body in which its surroundings are shown, in lengths of its longest side.
_AROUND: Final = 1.0
#: Margin of a floor around the body and objects on it, in lengths of their extent.
_MARGIN: Final = 0.08


@dataclass(frozen=True)
class Surroundings:
    """Rigid objects and floor beside a body.

    Attributes
    ----------
    objects
        Surfaces of all rigid objects; None where there is none.
    floor
        Height of the floor [m]; None where there is none.
    """

    objects: Surface | None = field(default=None, repr=False)
    floor: float | None = None

    @classmethod
    def of(cls, design: Design, poses: Mapping[str, Pose]) -> Self:
        """Make those of a design, with its objects in some poses; default: their initial poses.

        Raises
        ------
        DesignError
            An object without a surface.
        """
        names = [each.name for each in design.objects]
        found = [posed_surface(design, name, poses.get(name)) for name in names]
        floor = None if design.floor is None else design.floor.z
        return cls(_joined(found) if found else None, floor)

    def near(self, body: Floats) -> Floats:
        """Return the points that a picture must hold beside a body, (n, 3), near to it."""
        shown, floor = self._standing(body), self._floor_under(body)
        return shown if floor is None else np.concatenate([shown, floor.vertices])

    def drawn_over(
        self,
        picture: Floats,
        seen: Raster,
        camera: Camera,
        body: Floats,
        plane: tuple[Axis, float, int] | None = None,
        ghost: Raster | None = None,
    ) -> Floats:
        """Draw objects and floor over a picture where they are in front of its body.

        Parameters
        ----------
        picture
            Red, green and blue, (h, w, 3); or with opacity, (h, w, 4), and colors times that.
        seen
            Raster of the body.
        camera
            Camera of the picture.
        body
            Vertices of the body, (n, 3), m.
        plane
            Plane of a section: the axis, the position on it, and the side that stays.
        ghost
            Raster of the undeformed body, which hides the floor too.
        """
        depth = seen.spread(seen.depth, np.inf).ravel()
        floor = self._floor_under(body)
        if floor is not None:  # first: objects stand on it
            own = depth
            if ghost is not None:
                own = np.minimum(depth, ghost.spread(ghost.depth, np.inf).ravel())
            floor = floor if plane is None else cut(floor, *plane)
            picture = _drawn(picture, own, floor, _FLOOR, camera)
        if self.objects is not None:
            objects = self.objects if plane is None else cut(self.objects, *plane)
            picture = _drawn(picture, depth, objects, _OBJECT, camera)
        return picture

    def _standing(self, body: Floats) -> Floats:
        """Return the vertices of body and objects that a picture shows."""
        if self.objects is None:
            return body
        return np.concatenate([body, np.clip(self.objects.vertices, *_limits(body))])

    def _floor_under(self, body: Floats) -> Surface | None:
        """Make a rectangle of the floor, seen from both sides; None where it is too far away."""
        low, _ = _limits(body)
        if self.floor is None or self.floor < low[2]:
            return None
        shown = self._standing(body)
        (left, front), (right, back) = shown[:, :2].min(axis=0), shown[:, :2].max(axis=0)
        margin = _MARGIN * max(right - left, back - front)
        x, y = (left - margin, right + margin), (front - margin, back + margin)
        corners = [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
        vertices = np.array([(*corner, self.floor) for corner in corners])
        triangles = np.array([[0, 1, 2], [0, 2, 3], [2, 1, 0], [3, 2, 0]], dtype=np.uint32)
        return Surface(vertices, triangles)


def _joined(surfaces: list[Surface]) -> Surface:
    counts = np.cumsum([0, *(len(each.vertices) for each in surfaces)])
    triangles = [each.triangles + first for each, first in zip(surfaces, counts, strict=False)]
    vertices = np.concatenate([each.vertices for each in surfaces])
    return Surface(vertices, np.concatenate(triangles).astype(np.uint32))


def _limits(body: Floats) -> tuple[Floats, Floats]:
    """Return the box around a body in which objects are shown, m."""
    low, high = body.min(axis=0), body.max(axis=0)
    around = _AROUND * float((high - low).max())
    return low - around, high + around


def cut(surface: Surface, axis: Axis, position: float, side: int) -> Surface:
    """Cut surfaces by a section: they are hollow, so that their insides show."""
    beyond = side * (surface.vertices[:, "xyz".index(axis)] - position)
    kept = (beyond > 0.0)[surface.triangles]
    count = kept.sum(axis=1)
    pieces = [surface.vertices[surface.triangles[count == 3]]]
    for left in (1, 2):
        crossed = count == left
        # The corner that is alone on its side comes first.
        alone = (kept[crossed] == (left == 1)).argmax(axis=1)
        turned = (alone[:, None] + np.arange(3)) % 3
        corners = np.take_along_axis(surface.triangles[crossed], turned, axis=1)
        (a, b, c), (at_a, at_b, at_c) = surface.vertices[corners].swapaxes(0, 1), beyond[corners].T
        ab = a + (at_a / (at_a - at_b))[:, None] * (b - a)
        ac = a + (at_a / (at_a - at_c))[:, None] * (c - a)
        parts = [(a, ab, ac)] if left == 1 else [(ab, b, c), (ab, c, ac)]
        pieces += [np.stack(part, axis=1) for part in parts]
    corners = np.concatenate(pieces).reshape(-1, 3)
    triangles = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
    return Surface(corners, np.concatenate([triangles, triangles[:, ::-1]]))


def _drawn(picture: Floats, depth: Floats, surface: Surface, look: _Look, camera: Camera) -> Floats:
    """Draw a surface over a picture where it is in front of a depth, (h * w,)."""
    if len(surface.triangles) == 0:
        return picture
    points, triangles = camera.project(surface.vertices), surface.triangles.astype(np.int64)
    before = rasterize(points, triangles, camera.width, camera.height)
    if len(before.pixels) == 0:
        return picture
    normals = shading.normals_of(surface.vertices[triangles])
    light = shading.lit(normals, camera)[before.triangle]
    outlines = shading.outlines(before)
    opacity = np.where(outlines < 1.0, look.outline, look.opacity)
    in_front = before.depth < depth[before.pixels]
    opacity = before.spread(np.where(in_front, opacity, 0.0), 0.0)[..., None]
    color = np.ones_like(picture)
    color[..., :3] = before.spread(look.gray * light * outlines, 0.0)[..., None]
    drawn: Floats = (1.0 - opacity) * picture + opacity * color
    return drawn
