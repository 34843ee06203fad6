"""Walls and offsets that are thicker or thinner than written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.mesh import Mesh
from voxsoft.shapes import Grade, Offset, Shell
from voxsoft.shapes.base import Shape
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.units import format_quantity

#: Relative deviation of walls up to which there is no warning: less than the voxels change them.
_TOLERANCE: Final = 0.1
# Points of a regular grid that search the surface, and the fewest on it that allow a judgment.
_POINTS: Final = 500
_FEWEST: Final = 30
# Position of the first point in its cell: off the planes of symmetry, where functions have kinks.
_FIRST: Final = (0.31, 0.52, 0.73)
# Newton's steps from there to the surface, each of at most this part of the box.
_STEPS: Final = 4
_LONGEST_STEP: Final = 0.1
# Differences over this part of the box lose half the digits of float64 at most.
_DIFFERENCE: Final = 1e-6
# At an edge the slopes of both sides differ by their own size; the mean of the two is that of no
# surface. Along smooth ones they differ by the curvature times the difference, a part in a million.
_KINK: Final = 1e-3
# Part of the surface on which the smallest and the largest thickness are disregarded: kinks that
# lie beside the points.
_KINKS: Final = 0.03


def doubtful_thickness(
    design: Design, mesh: Mesh, positions: NDArray[np.float64] | None = None
) -> Iterator[Diagnostic]:
    """Find shells and offsets of shapes whose function is not a distance.

    A wall of thickness t is where the function of a shape is below t/2, and its true thickness
    t/|∇s|. The slope is far from 1 for unequal scales, strong twists, ends of tapers and free
    expressions.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> egg = vs.Sphere(0.01).scale((1, 1, 3)).shell("2 mm")
    >>> design = families.beam().replace(shapes={"body": egg})
    >>> print(*doubtful_thickness(design, vs.mesh_of(design)))  # doctest: +ELLIPSIS
    shapes.body: the wall is 1 to ... times as thick as written (2 mm), most so near ...
    """
    if mesh.bodies:
        for body in mesh.bodies:
            yield from doubtful_thickness(design.alone(body.name), body.mesh)
        return
    box = np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])
    seen: set[str] = set()
    named = [(f"shapes.{name}", shape) for name, shape in design.shapes.items()]
    parts = [(f"parts[{index}].shape", part.shape) for index, part in enumerate(design.parts)]
    for where, top in [*named, *parts]:
        for shape in top.every() if isinstance(top, Shape) else ():
            if isinstance(shape, Shell | Offset | Grade) and (key := repr(shape)) not in seen:
                seen.add(key)
                yield from _findings_of(shape, design, box, where)


def _findings_of(
    shape: Shell | Offset | Grade, design: Design, box: NDArray[np.float64], where: str
) -> Iterator[Diagnostic]:
    try:
        built = shape.build(design.shapes)
        measured = _thickness(built, box)
    except VoxSoftError:
        return  # a shape without a value somewhere is reported where it is sampled
    if measured is None:
        return
    points, ratio = measured
    low, high = np.quantile(ratio, [_KINKS, 1 - _KINKS])
    if low >= 1 - _TOLERANCE and high <= 1 + _TOLERANCE:
        return
    worst = int(np.abs(np.log(np.clip(ratio, low, high))).argmax())
    place: tuple[float, float, float] = tuple(points[worst].tolist())
    times = f"{low:.2g} to {high:.2g}" if high > 1.02 * low else f"{high:.2g}"
    if isinstance(shape, Offset):
        what = f"the offset is {times} times as far as written"
    else:
        what = f"the wall is {times} times as thick as written"
    if isinstance(shape, Shell):
        what += f" ({format_quantity(shape.thickness, 'length')})"
    yield Diagnostic(
        "warning",
        where,
        f"{what}, most so {near(place)}: the function of what it is made from is not a distance",
        "take the shell or offset first, then scale, bend or blend; or write another thickness",
        place,
    )


def _thickness(
    shape: _core.Shape, box: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return points on the surface, and 1/|∇s| there."""
    low, high = (np.where(np.isfinite(b), b, a) for a, b in zip(box, shape.bounds(), strict=True))
    size = float((high - low).max())
    if not (high > low).all():
        return None
    spacing = float(np.cbrt(np.prod(high - low) / _POINTS))
    sides = [
        np.arange(a + first * spacing, b, spacing)
        for a, b, first in zip(low, high, _FIRST, strict=True)
    ]
    points = np.stack([c.ravel() for c in np.meshgrid(*sides, indexing="ij")], axis=1)
    for _ in range(_STEPS):
        value, slope, _ = _slopes(shape, points, _DIFFERENCE * size)
        square = (slope**2).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = slope * (value / square)[:, None]
            length = np.linalg.norm(step, axis=1)
            step *= np.minimum(1, _LONGEST_STEP * size / length)[:, None]
        kept = np.isfinite(step).all(axis=1)
        points = points[kept] - step[kept]
    value, slope, kink = _slopes(shape, points, _DIFFERENCE * size)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = 1 / np.linalg.norm(slope, axis=1)
        found = np.abs(value) * ratio < _DIFFERENCE * size
    found &= np.isfinite(ratio) & (kink < _KINK)
    return (points[found], ratio[found]) if found.sum() >= _FEWEST else None


def _slopes(
    shape: _core.Shape, points: NDArray[np.float64], step: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the function, its gradient by central differences, and how far both sides differ."""
    slope, value = np.empty_like(points), shape.evaluate(points)
    kink = np.zeros(len(points))
    for axis in range(3):
        aside = np.zeros(3)
        aside[axis] = step
        after, before = shape.evaluate(points + aside), shape.evaluate(points - aside)
        slope[:, axis] = (after - before) / (2 * step)
        kink = np.maximum(kink, np.abs(after + before - 2 * value) / step)
    return value, slope, kink
