"""Thinnest wall of a casting: the shortest way from one side of it straight to the opposite side.

A ray starts at each point of the surface, against the normal there. Where it leaves the solid
through a side that faces away from the first by no more than 30 degrees, its length is the
thickness of a wall. Rays from edges, which have no normal, and those that leave through a side
askew, as beside a corner, do not count. Both ends lie on the solid's function, so that a wall is
as exact as its shapes, however coarse the samples; a wall whose thickness varies has samples a
step apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.fabrication.body import Body, Component
from voxsoft.fabrication.fields import Field, Floats
from voxsoft.fabrication.sampled import Grid, Sampled, Surface, traced

Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

#: Cosine of the largest angle between both sides of a wall: 30 degrees. Sharper edges are thin.
_OPPOSITE: Final = 0.866
#: Cosine below which the normals on two sides of a point are those of an edge.
_SMOOTH: Final = 0.97
#: Steps of a ray, and distances between which normals are taken, in steps of the grid.
_STRIDE: Final = 0.25
_NORMAL: Final = 0.02
#: Rounds in which the end of a ray is found within a stride, its distance from the surface [m]
#: that counts as none, and halvings where it is farther.
_ROUNDS: Final = 6
_SETTLED: Final = 1e-10
_HALVINGS: Final = 30
#: Most rays, and how many are followed exactly at once.
_MOST: Final = 20_000
_BATCH: Final = 1_000


@dataclass(frozen=True)
class Wall:
    """Thinnest wall of a component.

    Attributes
    ----------
    component
        Name of the component.
    thickness
        Its thickness [m].
    place
        Middle of it [m].
    """

    component: str
    thickness: float
    place: tuple[float, float, float]


def thinnest_wall(component: Component, grid: Grid) -> Wall | None:
    """Return the thinnest wall of a component; None without two sides that are opposite.

    Parameters
    ----------
    component
        The component.
    grid
        Positions of its samples: a wall thinner than one of their steps may be missed.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.units import mm
    >>> outer, inner = (vs.Cylinder(radius=each * mm, height=20 * mm) for each in (9, 6.7))
    >>> part = vs.Part(shape=outer - inner, material="ecoflex-00-30")
    >>> body = Body.of(vs.Design(name="tube", voxel_size=2 * mm, parts=[part]), 0.7 * mm)
    >>> round(thinnest_wall(body.components[0], body.grid).thickness * 1e3, 4)
    2.3
    """
    # Edges need not be restored: no ray begins there.
    surface = traced(grid, component.values)
    solid = Sampled(component.solid, grid, component.values)
    rays = _rays(surface, grid, component.values)
    best: Wall | None = None
    for start in range(0, len(rays.lengths), _BATCH):
        batch = rays.some(slice(start, start + _BATCH))
        if best is not None and best.thickness < batch.lengths[0] - grid.step:
            break
        for thickness, place in _walls(solid, batch, grid.step):
            if best is None or thickness < best.thickness:
                x, y, z = (float(each) for each in place)
                best = Wall(component.name, thickness, (x, y, z))
    return best


def thinnest_walls(body: Body) -> Iterator[Wall]:
    """Find the thinnest wall of each component that is not rigid."""
    for component in body.components:
        if not component.rigid:
            wall = thinnest_wall(component, body.grid)
            if wall is not None:
                yield wall


def min_wall_thickness(design: Design) -> float:
    """Return the thickness [m] of the thinnest wall of all parts that are not rigid.

    Samples are a third of a voxel apart. Not a number where no two sides are opposite.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> round(min_wall_thickness(families.cylinder()) * 1e3, 4)
    10.0
    """
    body = Body.of(design, design.voxel_size / 3.0)
    return min((each.thickness for each in thinnest_walls(body)), default=float("nan"))


@dataclass(frozen=True, eq=False)
class _Rays:
    """Rays against the normals of a surface, the shortest first, to within a step of samples."""

    starts: Floats
    normals: Floats
    lengths: Floats

    def some(self, which: slice | Ints) -> _Rays:
        return _Rays(self.starts[which], self.normals[which], self.lengths[which])


def _rays(surface: Surface, grid: Grid, values: Floats) -> _Rays:
    """Return rays from the middles of triangles, ended between samples."""
    from scipy import ndimage

    corners = surface.vertices[surface.triangles]
    corners = corners[:: len(corners) // _MOST + 1]
    crossed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(crossed, axis=1)
    whole = sizes > 0.0
    starts, normals = corners[whole].mean(axis=1), crossed[whole] / sizes[whole, None]
    lengths = np.full(len(starts), np.inf)
    low, high = surface.bounds
    length, on = 0.0, np.arange(len(starts))
    while len(on) and length <= float(np.linalg.norm(high - low)):
        length += _STRIDE * grid.step
        where = (starts[on] - length * normals[on] - np.array(grid.first)) / grid.step
        left = ndimage.map_coordinates(values, where.T, order=1, mode="nearest") >= 0.0
        lengths[on[left]] = length
        on = on[~left]
    order = np.argsort(lengths, kind="stable")
    return _Rays(starts, normals, lengths).some(order[np.isfinite(lengths[order])])


def _walls(solid: Field, rays: _Rays, step: float) -> Iterator[tuple[float, Floats]]:
    """Find the thickness [m] and the middle of each wall that rays cross, by the function alone."""
    reach = _STRIDE * step
    normals, smooth = _normals(solid, rays.starts, step)
    starts = rays.starts
    near = smooth & (solid.evaluate(starts + reach * normals) >= 0.0)
    near &= solid.evaluate(starts - reach * normals) < 0.0
    starts, normals, lengths = starts[near], normals[near], rays.lengths[near]
    ends = np.full(len(starts), reach)
    starts = starts - _crossed(solid, starts, normals, ends, -ends)[:, None] * normals
    first, last = ends, np.maximum(lengths - step, 2.0 * reach)
    left = np.zeros(len(starts), dtype=bool)
    for _ in range(round(3.0 / _STRIDE)):
        left |= solid.evaluate(starts - last[:, None] * normals) >= 0.0
        first, last = np.where(left, first, last), np.where(left, last, last + reach)
    starts, normals = starts[left], normals[left]
    thick = _crossed(solid, starts, normals, first[left], last[left])
    ends = starts - thick[:, None] * normals
    facing, smooth = _normals(solid, ends, step)
    wall = smooth & ((facing * normals).sum(axis=1) <= -_OPPOSITE)
    yield from zip(thick[wall].tolist(), (starts[wall] + ends[wall]) / 2.0, strict=True)


def _crossed(
    solid: Field, points: Floats, normals: Floats, inside: Floats, outside: Floats
) -> Floats:
    """Return the depths [m] below points, along rays, where they leave the solid.

    False position with the rule of Illinois: distances along a ray are nearly straight. Halvings
    do the rest where they are not.
    """
    low = solid.evaluate(points - inside[:, None] * normals)
    high = solid.evaluate(points - outside[:, None] * normals)
    kept = np.zeros(len(points), dtype=np.int8)
    for _ in range(_ROUNDS):
        middle = inside + (outside - inside) * low / np.minimum(low - high, -1e-300)
        values = solid.evaluate(points - middle[:, None] * normals)
        within = values < 0.0
        high = np.where(within, np.where(kept == 1, high / 2.0, high), values)
        low = np.where(within, values, np.where(kept == -1, low / 2.0, low))
        kept = np.where(within, 1, -1).astype(np.int8)
        inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
    found: Floats = np.where(np.abs(low) < np.abs(high), inside, outside)
    off = np.abs(solid.evaluate(points - found[:, None] * normals)) > _SETTLED
    if off.any():
        points, normals, inside, outside = points[off], normals[off], inside[off], outside[off]
        for _ in range(_HALVINGS):
            middle = (inside + outside) / 2.0
            within = solid.evaluate(points - middle[:, None] * normals) < 0.0
            inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
        found[off] = (inside + outside) / 2.0
    return found


def _normals(solid: Field, points: Floats, step: float) -> tuple[Floats, Bools]:
    """Return unit normals (n, 3), and where those on both sides of a point are alike."""
    apart = _NORMAL * step
    here = solid.evaluate(points)
    ahead, behind = np.empty_like(points), np.empty_like(points)
    for axis in range(3):
        aside = np.zeros(3)
        aside[axis] = apart
        ahead[:, axis] = solid.evaluate(points + aside) - here
        behind[:, axis] = here - solid.evaluate(points - aside)
    sizes = [np.linalg.norm(each, axis=1) for each in (ahead, behind)]
    product = np.maximum(sizes[0] * sizes[1], 1e-300)
    smooth = (ahead * behind).sum(axis=1) >= _SMOOTH * product
    total = ahead + behind
    size = np.maximum(np.linalg.norm(total, axis=1), 1e-300)
    return total / size[:, None], smooth & (sizes[0] > 0.0) & (sizes[1] > 0.0)
