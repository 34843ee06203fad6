"""Patterns in true size: outlines of layers to cut fabric, film or paper by."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from voxsoft.design import Design, Layer
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.fabrication.clamped import holds
from voxsoft.fabrication.fields import Floats, Parts

#: Distance of the samples of an outline [m].
_STEP: Final = 0.25e-3
#: Distance of the sections on both sides of a layer [m]: more than a sample, so that values near
#: the outline are those of its sides, and less than walls are thick.
_BESIDE: Final = 0.26e-3
#: Samples around a body.
_MARGIN: Final = 2


@dataclass(frozen=True, eq=False)
class Pattern:
    """Outline of a layer that lies in a plane, or of a sheet that is wrapped.

    Attributes
    ----------
    name
        Name of the layer, or of the winding.
    axes
        Axes of the design along the width and the height of the pattern: ``"xy"``; for a winding
        in words.
    outlines
        Closed polygons (n, 2) [m], from the lowest corner of the pattern; holes among them.
    size
        Width and height [m].
    area
        Area without holes [m²].
    lines
        Lines on it that are not cut, (n, 2) each [m].
    """

    name: str
    axes: str
    outlines: tuple[Floats, ...] = field(repr=False)
    size: tuple[float, float]
    area: float
    lines: tuple[Floats, ...] = field(default=(), repr=False)


def patterns_of(design: Design) -> list[Pattern]:
    """Return the patterns of all layers that lie in a plane across an axis.

    A pattern is the section of the body just beside the plane, on either side, within the region
    of its layer; one that seals is whole where it spans openings.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.units import mm
    >>> bar = vs.Part(shape=vs.Box(size=(20 * mm, 8 * mm, 6 * mm)), material="ecoflex-00-30")
    >>> fabric = vs.Layer(region=vs.Region(z=(0, 0)), young=30e6, thickness=0.3 * mm, name="felt")
    >>> design = vs.Design(name="bar", voxel_size=2 * mm, parts=[bar], layers=[fabric])
    >>> (pattern,) = patterns_of(design)
    >>> pattern.name, pattern.axes, round(pattern.area * 1e6, 1)
    ('felt', 'xy', 160.0)
    """
    shapes = built_parts(design)
    body = Parts(shapes)
    corners = np.array([shape.bounds() for shape in shapes])
    low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
    found = []
    for number, layer in enumerate(design.layers, 1):
        if layer.axis is not None:
            name = layer.name or f"layer {number}"
            pattern = _pattern(design, layer, name, body, low, high)
            if pattern is not None:
                found.append(pattern)
    return found


def _pattern(
    design: Design, layer: Layer, name: str, body: Parts, low: Floats, high: Floats
) -> Pattern | None:
    from contourpy import contour_generator
    from scipy import ndimage

    axis = layer.axis
    bounds = (layer.region.x, layer.region.y, layer.region.z)[0 if axis is None else axis]
    if axis is None or bounds is None:
        return None
    wide, tall = (each for each in range(3) if each != axis)
    u, v = (_samples(low[each], high[each]) for each in (wide, tall))
    points = np.empty((len(u) * len(v), 3))
    points[:, wide], points[:, tall] = (each.ravel() for each in np.meshgrid(u, v))
    sections = []
    for side in (-1.0, 1.0):
        points[:, axis] = bounds[0] + side * _BESIDE
        sections.append(body.evaluate(points))
    points[:, axis] = bounds[0]
    values = np.where(holds(design, layer.region, points, _BESIDE), np.minimum(*sections), _STEP)
    for each in (wide, tall):
        ends = (layer.region.x, layer.region.y, layer.region.z)[each]
        if ends is not None:
            beyond = np.maximum(ends[0] - points[:, each], points[:, each] - ends[1])
            values = np.maximum(values, beyond)
    values = values.reshape(len(v), len(u))
    if layer.seal:
        values = np.where(ndimage.binary_fill_holes(values < 0.0), -np.abs(values), values)
    lines = [np.asarray(line, np.float64) for line in contour_generator(u, v, values).lines(0.0)]
    if not lines:
        return None
    corner = np.min([line.min(axis=0) for line in lines], axis=0)
    outlines = tuple(line - corner for line in lines)
    size = np.max([line.max(axis=0) for line in outlines], axis=0)
    return Pattern(
        name=name,
        axes="xyz".replace("xyz"[axis], ""),
        outlines=outlines,
        size=(float(size[0]), float(size[1])),
        area=abs(sum(_area(line) for line in outlines)),
    )


def _samples(low: float, high: float) -> Floats:
    """Return positions whose sides never lie on a sample, so that all signs are sure."""
    first = low - (_MARGIN - 0.4863) * _STEP
    count = int(np.ceil((high - first) / _STEP)) + _MARGIN
    return first + _STEP * np.arange(count, dtype=np.float64)


def _area(line: Floats) -> float:
    x, y = line.T
    return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) / 2.0)
