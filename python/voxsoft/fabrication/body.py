"""Body to be made: its components by material, its chambers, and the inlets that reach them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import count as numbers
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.fabrication.fields import Common, Field, Floats, Joined, Outside, Parts
from voxsoft.fabrication.printer import Printer
from voxsoft.fabrication.sampled import Grid, Surface, extents, surface_of
from voxsoft.units import format_quantity

Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

#: Distance of places at which inlets may be [m].
_ROUND: Final = 0.5e-3
#: Most samples of a body: ten arrays of them are 8 GB.
_SAMPLES: Final = 1e8
#: Number of samples below which a connected set counts as dust.
_DUST: Final = 8


@dataclass(frozen=True, eq=False)
class Component:
    """Connected solid of one material.

    Attributes
    ----------
    name
        Names of its parts, joined.
    material
        Text of the material in the design, or its model.
    rigid
        True for a rigid material, which is printed.
    density
        In kg/m³.
    solid
        Its function, in the frame of the design.
    values
        Its samples on the grid of the body, negative inside [m].
    """

    name: str
    material: str
    rigid: bool
    density: float
    solid: Field = field(repr=False)
    values: Floats = field(repr=False)


@dataclass(frozen=True, eq=False)
class Void:
    """Enclosed space of a body.

    Attributes
    ----------
    name
        Name of the chamber of the design, or a number.
    cells : ndarray of bool, shape (nx, ny, nz)
        Samples in it.
    extents
        Its lowest and highest corner [m].
    solid
        Its function.
    values
        Its samples, negative inside [m].
    grid
        Positions of samples.
    """

    name: str
    cells: Bools = field(repr=False)
    extents: tuple[Floats, Floats]
    solid: Field = field(repr=False)
    values: Floats = field(repr=False)
    grid: Grid

    @cached_property
    def surface(self) -> Surface:
        """Its triangles."""
        return surface_of(self.solid, self.grid, self.values)


@dataclass(frozen=True)
class Inlet:
    """Straight hole from a chamber to the outside, for an air tube.

    Attributes
    ----------
    chamber
        Name of the chamber.
    at
        Point where it leaves the body [m].
    axis, sign
        Direction outward: an axis and 1 or -1.
    length
        Thickness of the wall there [m].
    reach
        Depth of the hole beyond the wall, into the chamber [m].
    radius
        In m.
    in_clamp
        True where it leaves through a clamped face.
    """

    chamber: str
    at: tuple[float, float, float]
    axis: int
    sign: int
    length: float
    reach: float
    radius: float
    in_clamp: bool

    def hole(self, radius: float | None = None) -> _core.Shape:
        """Return its space, which ends beyond both sides of the wall; its radius [m] or another."""
        radius = self.radius if radius is None else radius
        inward = self.length + self.reach
        way = [0.0, 0.0, 0.0]
        way[self.axis] = float(self.sign)
        base = list(self.at)
        base[self.axis] -= self.sign * inward
        x, y, z = base
        a, b, c = way
        return _core.Shape.cylinder((x, y, z), (a, b, c), radius, inward + 2.0 * self.radius)


@dataclass(frozen=True, eq=False)
class Body:
    """Body on a grid of samples.

    Attributes
    ----------
    design
        The design.
    grid
        Samples around the body.
    values
        Samples of all parts together [m].
    low, high
        Corners of the box around them [m].
    components
        Connected solids of one material each.
    voids
        Enclosed spaces.
    """

    design: Design
    grid: Grid
    values: Floats = field(repr=False)
    low: Floats
    high: Floats
    components: tuple[Component, ...]
    voids: tuple[Void, ...]

    @classmethod
    def of(cls, design: Design, resolution: float) -> Body:
        """Sample a design with one body.

        Raises
        ------
        DesignError
            Several bodies, a body that is the mesh of a file, a part that samples miss, or too many
            samples.
        """
        if design.bodies:
            names = ", ".join(design.body_names)
            what = f"has several bodies: {names}"
            raise DesignError(
                "bodies", what, "make one of them: --body NAME, or fabrication.one_body"
            )
        if design.mesh is not None:
            what = "is a mesh of tetrahedra, from which no mold is made"
            raise DesignError("mesh", what, "describe the body by shapes, or read its surface")
        shapes = built_parts(design)
        low, high = _bounds(shapes)
        count = float(np.prod((high - low) / resolution + 6.0))
        if count > _SAMPLES:
            shown = format_quantity(resolution, "length")
            what = f"of {shown} takes {count:.1e} samples; at most {_SAMPLES:.0e} fit"
            raise DesignError("resolution", what, "a coarser one: --printer resolution='1 mm'")
        grid = Grid.around(low, high, resolution, 2 * resolution)
        values = grid.values(Parts(shapes))
        components = tuple(_components(design, shapes, grid, values))
        voids = tuple(_voids(design, shapes, grid, values))
        return cls(design, grid, values, *extents(values, grid), components, voids)


def _bounds(shapes: Sequence[_core.Shape]) -> tuple[Floats, Floats]:
    corners = np.array([shape.bounds() for shape in shapes])
    low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
    if not np.isfinite([low, high]).all():
        raise DesignError("parts", "a shape has no end", "cut it by a box: intersection")
    return low, high


def _components(
    design: Design, shapes: Sequence[_core.Shape], grid: Grid, joined: Floats
) -> list[Component]:
    """Group parts by material, and divide each group in its connected solids."""
    from scipy import ndimage

    materials = [design.material_of(part) for part in design.parts]
    names = [
        part.name or (part.shape if isinstance(part.shape, str) else f"part {k}")
        for k, part in enumerate(design.parts, 1)
    ]
    for k, shape in enumerate(shapes):
        values = joined if len(shapes) == 1 else grid.values(Parts([shape]))
        if (values < 0.0).sum() < _DUST:
            what = f"has no {_DUST} samples in it, at every {format_quantity(grid.step, 'length')}"
            raise DesignError(f"parts[{k}]", what, "a finer resolution of the printer")
    found: list[Component] = []
    done: list[int] = []
    for index, material in enumerate(materials):
        if any(material == materials[other] for other in done):
            continue
        done.append(index)
        own = [k for k, each in enumerate(materials) if each == material]
        solid = _joined(shapes, own)
        values = joined if len(own) == len(shapes) else grid.values(solid)
        labels, count = ndimage.label(values < 0.0)
        title = " and ".join(names[k] for k in own)
        text = design.parts[index].material
        for number in range(1, count + 1):
            part = labels == number
            if part.sum() < _DUST:
                continue  # where surfaces touch
            alone = solid if count == 1 else _Near(solid, part, grid, values)
            found.append(
                Component(
                    name=title if count == 1 else f"{title} {number}",
                    material=text if isinstance(text, str) else material.model,
                    rigid=material.model == "rigid",
                    density=float(getattr(material, "density", None) or 0.0),
                    solid=alone,
                    values=values if count == 1 else np.where(part, values, np.abs(values)),
                )
            )
    return found


def _joined(shapes: Sequence[_core.Shape], own: Sequence[int]) -> Field:
    """Join the shapes of one material, each without those of others that come before it."""
    solids: dict[tuple[int, ...], list[int]] = {}
    for k in own:
        solids.setdefault(tuple(j for j in range(k) if j not in own), []).append(k)
    found = [
        Parts([shapes[k] for k in equal], [shapes[j] for j in before])
        for before, equal in solids.items()
    ]
    return found[0] if len(found) == 1 else Joined(found)


@dataclass(frozen=True, eq=False)
class Filled:
    """Solid whose enclosed spaces are full.

    Attributes
    ----------
    of
        The solid.
    cells : ndarray of bool, shape (nx, ny, nz)
        Samples in these spaces.
    grid
        Positions of samples.
    values
        Values of the solid at all samples, (nx, ny, nz) [m].
    """

    of: Field
    cells: Bools
    grid: Grid
    values: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", _reached(self.cells, self.values >= 0.0))

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        full = self.cells[self.grid.nearest(points)]
        values = np.full(len(points), -self.grid.step)
        values[~full] = self.of.evaluate(points[~full])
        return values


def _reached(cells: Bools, alike: Bools) -> Bools:
    """Return samples up to two steps from some, and nearer to these than to others alike.

    So a thin wall between an enclosed space and the outside is divided along its middle.
    """
    from scipy import ndimage

    cube = np.ones((3, 3, 3), dtype=bool)
    own, others = cells, alike & ~cells
    for _ in range(2):
        grown, rest = (ndimage.binary_dilation(each, cube) for each in (own, others))
        own, others = own | (grown & ~rest & ~others), others | (rest & ~own)
    return own


@dataclass(frozen=True, eq=False)
class _Near:
    """Part of a solid: the points nearest to some of its samples."""

    of: Field
    cells: Bools
    grid: Grid
    values: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", _reached(self.cells, self.values < 0.0))

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values = self.of.evaluate(points)
        found: Floats = np.where(self.cells[self.grid.nearest(points)], values, np.abs(values))
        return found


def _voids(design: Design, shapes: Sequence[_core.Shape], grid: Grid, values: Floats) -> list[Void]:
    from scipy import ndimage

    labels, last = ndimage.label(values >= 0.0)
    outside = labels[0, 0, 0]
    found: list[Void] = []
    for number in range(1, last + 1):
        cells = labels == number
        if number == outside or cells.sum() < _DUST:
            continue
        solid = _Near(Outside(Parts(shapes)), cells, grid, -values)
        sampled = np.where(cells, -values, np.abs(values))
        name = _chamber(design, cells, grid, {each.name for each in found})
        found.append(Void(name, cells, extents(sampled, grid), solid, sampled, grid))
    return found


def bored(
    solid: Field, values: Floats, holes: Sequence[_core.Shape], grid: Grid
) -> tuple[Field, Floats]:
    """Return a solid without some holes, and its samples."""
    if not holes:
        return solid, values
    pierced = Common([solid, *(Outside(Parts([hole])) for hole in holes)])
    return pierced, np.maximum(values, -grid.values(Parts(holes)))


def _chamber(design: Design, cells: Bools, grid: Grid, used: set[str]) -> str:
    for name, place in design.chambers.items():
        if place.point is not None and cells[grid.nearest(np.array([place.point]))].all():
            return name
    free = (f"chamber {number}" for number in numbers(1))
    return next(name for name in free if name not in used and name not in design.chambers)


def inlets_of(body: Body, printer: Printer, along: int | None) -> list[Inlet]:
    """Return an inlet for each chamber: through a clamp, along an axis, where the wall is thinnest.

    Parameters
    ----------
    body
        The body.
    printer
        Its tube gives the radius.
    along
        Axis along which the molds are drawn: a pin of a core can make such an inlet; None for no
        preference.
    """
    solid = body.values < 0.0
    found = []
    for void in body.voids:
        choices = []
        for axis in range(3):
            cells, filled = (np.moveaxis(each, axis, 2) for each in (void.cells, solid))
            for sign in (1, -1):
                c, f = (cells, filled) if sign > 0 else (cells[..., ::-1], filled[..., ::-1])
                count = c.shape[2]
                last = count - 1 - c[..., ::-1].argmax(axis=2)
                index = np.arange(count)
                # Cells of the chamber from its last one back to the next of the body.
                back = np.where(~c & (index < last[..., None]), index, -1).max(axis=2)
                deep = last - back
                wall = (f & (index > last[..., None])).sum(axis=2)
                free = ~f & (index > last[..., None])
                # One run of the body beyond the chamber, then nothing.
                first = np.where(f & (index > last[..., None]), index, -1).max(axis=2)
                straight = c.any(axis=2) & (first - last == wall) & (wall > 0) & free.any(axis=2)
                if not straight.any():
                    continue
                found_spots = _thinnest(straight, wall, printer.inlet / body.grid.step)
                if found_spots is None:
                    continue
                thin, spots = found_spots
                middle = spots.mean(axis=0)
                best = spots[np.linalg.norm(spots - middle, axis=1).argmin()]
                end = int(first[tuple(best)])
                end = end if sign > 0 else count - 1 - end
                # The middle itself, unless it lies beside all spots, as in a ring.
                centered = np.linalg.norm(best - middle) < 1.0
                where = np.insert(middle if centered else best, axis, end)
                at = body.grid.points(where[None])[0]
                at[axis] += sign * body.grid.step / 2
                # A drill goes to round numbers; the nearest ones are within the room that is left.
                face = float((body.high if sign > 0 else body.low)[axis])
                is_end = abs(face - at[axis]) < body.grid.step
                at = np.round(at / _ROUND) * _ROUND + 0.0
                at[axis] = round(face, 4) + 0.0 if is_end else at[axis]
                in_clamp = bool(clamped(body.design, at[None], body.grid.step)[0])
                inlet = Inlet(
                    void.name,
                    (float(at[0]), float(at[1]), float(at[2])),
                    axis,
                    sign,
                    float(thin) * body.grid.step,
                    min(2.0 * printer.inlet, 0.5 * int(deep[tuple(best)]) * body.grid.step),
                    printer.inlet,
                    in_clamp,
                )
                choices.append((not in_clamp, along is not None and axis != along, thin, inlet))
        if choices:
            found.append(min(choices, key=lambda each: each[:3])[3])
    return found


def _thinnest(straight: Bools, wall: Ints, radius: float) -> tuple[int, Ints] | None:
    """Return the thinnest wall with room for a hole, in samples, and its columns (n, 2).

    All columns of the hole and a sample around it are straight, and none has a wall thicker by
    more than its radius, in samples: that one leads to another place of the chamber.
    """
    from scipy import ndimage

    for thin in np.unique(wall[straight]):
        alike = straight & (wall <= thin + np.ceil(radius))
        room = ndimage.distance_transform_edt(np.pad(alike, 1))[1:-1, 1:-1]
        spots = np.argwhere((room >= radius + 1.0) & alike & (wall <= thin))
        if len(spots):
            return int(thin), spots
    return None


def holds(design: Design, region: Region, points: Floats, near: float) -> Bools:
    """Return True for points (n, 3) [m] that a region holds, to within a distance [m]."""
    held = np.ones(len(points), dtype=bool)
    for axis, name in enumerate("xyz"):
        bounds = getattr(region, name)
        if bounds is not None:
            held &= (points[:, axis] >= bounds[0] - near) & (points[:, axis] <= bounds[1] + near)
    if region.center is not None and region.radius is not None:
        away = np.linalg.norm(points - np.array(region.center), axis=1)
        held &= away <= region.radius + near
    if region.shape is not None:
        shape = design.shapes[region.shape] if isinstance(region.shape, str) else region.shape
        values = shape.build(design.shapes).evaluate(np.ascontiguousarray(points))
        held &= values <= near
    return held


def clamped(design: Design, points: Floats, near: float) -> Bools:
    """Return True for points (n, 3) [m] that a clamp holds on all axes, to within a distance [m].

    A clamp that leaves an axis free stands for a plane of symmetry or a guide: nothing is fixed.
    """
    held = np.zeros(len(points), dtype=bool)
    for clamp in design.clamps:
        if clamp.axes == "xyz":
            held |= holds(design, clamp.region, points, near)
    return held
