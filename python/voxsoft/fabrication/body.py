"""Body to be made: its components by material, and its chambers."""

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
from voxsoft.errors import DesignError
from voxsoft.fabrication.fields import Field, Floats, Joined, Outside, Parts
from voxsoft.fabrication.sampled import Grid, Surface, extents, surface_of
from voxsoft.units import format_quantity

Bools = NDArray[np.bool_]

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
    parts
        Indices of its parts in the design, with others of this material.
    solid
        Its function, in the frame of the design.
    values
        Its samples on the grid of the body, negative inside [m].
    others
        Function of all parts of other materials; None without any.
    """

    name: str
    material: str
    rigid: bool
    density: float
    parts: tuple[int, ...]
    solid: Field = field(repr=False)
    values: Floats = field(repr=False)
    others: Field | None = field(default=None, repr=False)


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
        rest = [shape for k, shape in enumerate(shapes) if k not in own]
        others = Parts(rest) if rest else None
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
                    parts=tuple(own),
                    solid=alone,
                    values=values if count == 1 else np.where(part, values, np.abs(values)),
                    others=others,
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
    others
        Other solids, which close these spaces together with it: the fill ends at their sides.
    """

    of: Field
    cells: Bools
    grid: Grid
    values: Floats
    others: Field | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "cells", _reached(self.cells, self.values >= 0.0))

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        where = self.grid.nearest(points)
        full = self.cells[where]
        values = np.full(len(points), -self.grid.step)
        values[~full] = self.of.evaluate(points[~full])
        if self.others is None:
            return values
        near = self._beside[where]
        aside = -self.others.evaluate(points[near])
        # In another solid that is the distance to the fill; in the fill, less that to its side.
        is_full = full[near]
        values[near] = np.where(
            is_full,
            np.maximum(values[near], aside),
            np.where(aside > 0.0, np.minimum(values[near], aside), values[near]),
        )
        return values

    @cached_property
    def _beside(self) -> Bools:
        """Samples of the fill, and those up to two steps away from it."""
        from scipy import ndimage

        found: Bools = ndimage.binary_dilation(self.cells, np.ones((3, 3, 3), dtype=bool), 2)
        return found

    def sampled(self) -> Floats:
        """Return its values at all samples, (nx, ny, nz) [m]."""
        values = np.where(self.cells, -self.grid.step, self.values)
        if self.others is not None:
            values[self._beside] = self.evaluate(self.grid.points(np.argwhere(self._beside)))
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


def _chamber(design: Design, cells: Bools, grid: Grid, used: set[str]) -> str:
    for name, place in design.chambers.items():
        if place.point is not None and cells[grid.nearest(np.array([place.point]))].all():
            return name
    free = (f"chamber {number}" for number in numbers(1))
    return next(name for name in free if name not in used and name not in design.chambers)
