"""Body to be made: its components by material, its chambers, and the inlets that reach them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.design.region import Region
from voxsoft.errors import DesignError
from voxsoft.fabrication.fields import Field, Floats, Outside, Parts
from voxsoft.fabrication.printer import Printer
from voxsoft.fabrication.sampled import Grid, Surface, extents, surface_of

Bools = NDArray[np.bool_]

#: Distance of places at which inlets may be [m].
_ROUND: Final = 0.5e-3


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
        Its samples on the grid of the body, negative inside [m].
    """

    name: str
    cells: Bools = field(repr=False)
    extents: tuple[Floats, Floats]
    solid: Field = field(repr=False)
    values: Floats = field(repr=False)

    def surface(self, grid: Grid) -> Surface:
        """Return its triangles."""
        return surface_of(self.solid, grid, self.values)


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
    radius: float
    in_clamp: bool

    def hole(self) -> _core.Shape:
        """Return its space, which ends beyond both sides of the wall."""
        beyond = self.length + 4.0 * self.radius
        way = [0.0, 0.0, 0.0]
        way[self.axis] = float(self.sign)
        base = list(self.at)
        base[self.axis] -= self.sign * (self.length + 2.0 * self.radius)
        x, y, z = base
        a, b, c = way
        return _core.Shape.cylinder((x, y, z), (a, b, c), self.radius, beyond)


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
            Several bodies, or a body that is the mesh of a file.
        """
        if design.bodies:
            names = ", ".join(design.body_names)
            what = f"has several bodies: {names}"
            raise DesignError(
                "bodies", what, "make one of them: --body NAME, or design.alone(name)"
            )
        if design.mesh is not None:
            what = "is a mesh of tetrahedra, from which no mold is made"
            raise DesignError("mesh", what, "describe the body by shapes, or read its surface")
        shapes = built_parts(design)
        low, high = _bounds(shapes)
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
    found: list[Component] = []
    done: list[int] = []
    for index, material in enumerate(materials):
        if any(material == materials[other] for other in done):
            continue
        done.append(index)
        own = [k for k, each in enumerate(materials) if each == material]
        before = [k for k in range(max(own)) if k not in own]
        solid = Parts([shapes[k] for k in own], [shapes[k] for k in before])
        values = joined if len(own) == len(shapes) else grid.values(solid)
        labels, count = ndimage.label(values < 0.0)
        title = " and ".join(names[k] for k in own)
        text = design.parts[index].material
        for number in range(1, count + 1):
            part = labels == number
            if part.sum() < 8:
                continue  # dust of samples where surfaces touch
            alone = solid if count == 1 else _Near(solid, part, grid)
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
    """

    of: Field
    cells: Bools
    grid: Grid

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", _reached(self.cells))

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        full = self.cells[self.grid.nearest(points)]
        values = np.full(len(points), -self.grid.step)
        values[~full] = self.of.evaluate(points[~full])
        return values


def _reached(cells: Bools) -> Bools:
    """Return samples up to two steps from some."""
    from scipy import ndimage

    reached: Bools = ndimage.binary_dilation(cells, np.ones((3, 3, 3), dtype=bool), iterations=2)
    return reached


@dataclass(frozen=True, eq=False)
class _Near:
    """Part of a solid: the points nearest to some of its samples."""

    of: Field
    cells: Bools
    grid: Grid

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", _reached(self.cells))

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values = self.of.evaluate(points)
        found: Floats = np.where(self.cells[self.grid.nearest(points)], values, np.abs(values))
        return found


def _voids(design: Design, shapes: Sequence[_core.Shape], grid: Grid, values: Floats) -> list[Void]:
    from scipy import ndimage

    labels, count = ndimage.label(values >= 0.0)
    outside = labels[0, 0, 0]
    found: list[Void] = []
    for number in range(1, count + 1):
        cells = labels == number
        if number == outside or cells.sum() < 8:
            continue
        solid = _Near(Outside(Parts(shapes)), cells, grid)
        sampled = np.where(cells, -values, np.abs(values))
        name = _chamber(design, cells, grid, len(found))
        found.append(Void(name, cells, extents(sampled, grid), solid, sampled))
    return found


def _chamber(design: Design, cells: Bools, grid: Grid, number: int) -> str:
    for name, place in design.chambers.items():
        if place.point is not None and cells[grid.nearest(np.array([place.point]))].all():
            return name
    return f"chamber {number + 1}"


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
    from scipy import ndimage

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
                wall = (f & (index > last[..., None])).sum(axis=2)
                free = ~f & (index > last[..., None])
                # One run of the body beyond the chamber, then nothing.
                first = np.where(f & (index > last[..., None]), index, -1).max(axis=2)
                straight = c.any(axis=2) & (first - last == wall) & (wall > 0) & free.any(axis=2)
                if not straight.any():
                    continue
                room = ndimage.distance_transform_edt(np.pad(straight, 1))[1:-1, 1:-1]
                wide = room * body.grid.step >= printer.inlet + body.grid.step
                if not wide.any():
                    continue
                thin = np.where(wide, wall, count).min()
                spots = np.argwhere(wide & (wall <= thin))
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
                at = np.round(at / _ROUND) * _ROUND + 0.0
                clamped = any(
                    holds(body.design, clamp.region, at, body.grid.step)
                    for clamp in body.design.clamps
                )
                inlet = Inlet(
                    void.name,
                    (float(at[0]), float(at[1]), float(at[2])),
                    axis,
                    sign,
                    float(thin) * body.grid.step,
                    printer.inlet,
                    clamped,
                )
                choices.append((not clamped, along is not None and axis != along, thin, inlet))
        if choices:
            found.append(min(choices, key=lambda each: each[:3])[3])
    return found


def holds(design: Design, region: Region, at: Floats, near: float) -> bool:
    """Return True if a region holds a point [m], to within a distance."""
    for axis, name in enumerate("xyz"):
        bounds = getattr(region, name)
        if bounds is not None and not bounds[0] - near <= at[axis] <= bounds[1] + near:
            return False
    if region.center is not None and region.radius is not None:
        away = float(np.linalg.norm(at - np.array(region.center)))
        if away > region.radius + near:
            return False
    if region.shape is not None:
        shape = design.shapes[region.shape] if isinstance(region.shape, str) else region.shape
        return bool(shape.build(design.shapes).evaluate(at[None])[0] <= near)
    return True
