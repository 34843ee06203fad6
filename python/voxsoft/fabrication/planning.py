"""Choice of the way in which a body is made, from its shape alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.molds import Way
from voxsoft.design.printer import Printer
from voxsoft.fabrication.body import Body, Component, Filled
from voxsoft.fabrication.clamped import clamped
from voxsoft.fabrication.cutting import Cut, best_cut, least_caught
from voxsoft.fabrication.draw import WITHIN, Draw, draw_along
from voxsoft.fabrication.fields import (
    Common,
    Field,
    Floats,
    Frame,
    HalfSpace,
    Turned,
)
from voxsoft.fabrication.inlets import Inlet, bored, inlets_of
from voxsoft.fabrication.sampled import Grid, Sampled, extents, surface_of
from voxsoft.fabrication.winding import Winding, winding_of

#: Mean upright step along the outline, in samples, up to which a parting plane follows it.
_LEVEL: Final = 1.0
#: Reasons why a component is printed, by the way that was wanted.
_UNFIT: Final[dict[Way | None, str]] = {
    None: "it has undercuts for every pair of mold parts, every cut by a plane and a core that is "
    "lost",
    "cast": "it has undercuts for every pair of mold parts",
    "core": "it has undercuts for every pair of mold parts",
    "halves": "it has undercuts for every cut by a plane",
    "lost-core": "its outside has undercuts for every pair of mold parts",
    "printed": "asked for",
}


@dataclass(frozen=True, eq=False)
class Casting:
    """Solid to be cast in one mold.

    Attributes
    ----------
    name
        Name of its files.
    component
        Component that it is, or is a half of.
    solid
        The casting in the frame of its mold, with the inlets that its mold makes.
    frame
        Axes of its mold.
    low, high
        Its exact corners in that frame [m].
    inserts
        Volume of solids that lie in its mold before it is poured [m³]: cores that are lost, or a
        first layer.
    first
        Name of the casting that is its first layer; empty without one.
    """

    name: str
    component: Component
    solid: Sampled
    frame: Frame
    low: Floats
    high: Floats
    inserts: float = 0.0
    first: str = ""


@dataclass(frozen=True, eq=False)
class Plan:
    """Way in which one component is made.

    Attributes
    ----------
    component
        The component.
    way
        The way.
    why
        Reason, in words.
    castings
        Solids to be cast; none where it is printed.
    cut
        Plane between two halves; None without one.
    undercut
        Volume that kept simpler ways from being taken [m³], and its middle; zero and None where
        the simplest was possible.
    place
        See `undercut`.
    winding
        Thread between its first and its second layer; None without.
    """

    component: Component
    way: Way
    why: str
    castings: tuple[Casting, ...]
    cut: Cut | None = None
    undercut: float = 0.0
    place: Floats | None = None
    winding: Winding | None = None


@dataclass(frozen=True, eq=False)
class _Direction:
    frame: Frame
    draw: Draw
    depth: float

    @property
    def fits(self) -> bool:
        return self.draw.undercut <= 0.0

    def rank(self, step: float) -> tuple[bool, bool, float]:
        """Simplest first: outline in the plane, no lid, shallow."""
        return self.draw.steps > _LEVEL * step, not self.draw.is_open, self.depth


def plan(
    body: Body,
    component: Component,
    printer: Printer,
    wanted: Way | None = None,
    inlets: list[Inlet] | None = None,
) -> tuple[Plan, list[Inlet] | None]:
    """Choose the simplest way, or the wanted one.

    Parameters
    ----------
    body, component
        The body, and its component to be planned.
    printer
        The printer.
    wanted
        Way to take; None for the simplest.
    inlets
        Inlets of all chambers, where another component that is cut has them; else None.

    Returns
    -------
    tuple
        The plan, and the inlets: for a cut as pins of a core where they can be.
    """
    grid = body.grid
    directions = [_direction(component.values, grid, axis, s) for axis in range(3) for s in (1, -1)]
    caught = min(directions, key=lambda each: each.draw.undercut)
    if wanted in (None, "cast", "core"):
        fit = [each for each in directions if each.fits]
        if fit:
            best = min(fit, key=lambda each: each.rank(grid.step))
            return _whole(body, component, best), inlets
    if wanted in (None, "halves"):
        ends = np.array([void.extents for void in body.voids]).reshape(-1, 2, 3)
        cut = best_cut(component.values, grid, ends, _held(body), (body.low + body.high) / 2.0)
        if cut is not None:
            inlets = inlets_of(body, printer, cut.axis) if inlets is None else inlets
            return _halves(body, component, cut, inlets, caught.draw), inlets
    if wanted in (None, "lost-core") and body.voids:
        cells = np.any([void.cells for void in body.voids], axis=0)
        filled = np.where(cells, -np.abs(component.values), component.values)
        closed = [_direction(filled, grid, axis, s) for axis in range(3) for s in (1, -1)]
        fit = [each for each in closed if each.fits]
        if fit:
            best = min(fit, key=lambda each: each.rank(grid.step))
            asked = wanted is not None
            return _lost(body, component, best, caught.draw, is_asked=asked), inlets
    why = _UNFIT[wanted] if body.voids or wanted != "lost-core" else "it encloses no chamber"
    place = None if caught.draw.place is None else caught.frame.world(caught.draw.place)
    return Plan(component, "printed", why, (), None, caught.draw.undercut, place), inlets


def undercut_of(design: Design, axis: int | None = None) -> float:
    """Return the volume [m³] that keeps a design from being cast, in one mold or in two halves.

    Zero says that printed molds of two parts release all of its components; of the chambers of
    any other, cores must be lost. Samples are a third of a voxel apart.

    Parameters
    ----------
    design
        The design, of one body.
    axis
        Axis along which all molds are drawn, 0 to 2; default: for each component the best.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> undercut_of(families.cylinder()), undercut_of(families.finger()) > 0.0
    (0.0, True)
    """
    body = Body.of(design, design.voxel_size / 3.0)
    axes = range(3) if axis is None else (axis,)
    total = 0.0
    for component in body.components:
        if not component.rigid:
            values, grid = component.values, body.grid
            whole = [_direction(values, grid, each, 1).draw.undercut for each in axes]
            total += min(*whole, *(least_caught(values, grid, each) for each in axes))
    return total


def _direction(values: Floats, grid: Grid, axis: int, sign: int) -> _Direction:
    frame = Frame.along(axis, sign)
    turned, local = turned_grid(values, grid, frame)
    rows = np.flatnonzero((turned < 0.0).any(axis=(0, 1)))
    bottom = local.along(2)[rows[0]] - grid.step / 2
    top = local.along(2)[rows[-1]] + grid.step / 2
    draw = draw_along(turned, local, float(top), float(bottom))
    return _Direction(frame, draw, float(top - bottom))


def turned_grid(values: Floats, grid: Grid, frame: Frame) -> tuple[Floats, Grid]:
    """Return samples and their grid in another frame."""
    order = [int(np.flatnonzero(row)[0]) for row in frame.rows]
    signs = [int(np.sign(row[axis])) for row, axis in zip(frame.rows, order, strict=True)]
    turned = values.transpose(order)[tuple(slice(None, None, sign) for sign in signs)]
    first = []
    for axis, sign in zip(order, signs, strict=True):
        ends = grid.along(axis)
        first.append(float(ends[0] if sign > 0 else -ends[-1]))
    nx, ny, nz = turned.shape
    return np.ascontiguousarray(turned), Grid(
        (first[0], first[1], first[2]), grid.step, (nx, ny, nz)
    )


def _held(body: Body) -> Floats:
    """Return the middle of the clamped samples [m]; NaN without clamps."""
    cells = np.argwhere(np.abs(body.values) < body.grid.step)
    points = body.grid.points(cells)
    held = points[clamped(body.design, points, body.grid.step)]
    middle: Floats = held.mean(axis=0) if len(held) else np.full(3, np.nan)
    return middle


def _casting(
    name: str,
    component: Component,
    solid: Field,
    body: Body,
    frame: Frame,
    values: Floats,
    holes: Sequence[_core.Shape] = (),
) -> Casting:
    low, high = (np.array(each) for each in extents(values, body.grid))
    corners = frame.local(np.stack([low, high]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    solid, values = bored(solid, values, holes, body.grid)
    turned, grid = turned_grid(values, body.grid, frame)
    return Casting(name, component, Sampled(Turned(solid, frame), grid, turned), frame, low, high)


def _whole(body: Body, component: Component, best: _Direction) -> Plan:
    casting = _casting(
        component.name, component, component.solid, body, best.frame, component.values
    )
    winding = winding_of(body, component)
    castings = (casting,) if winding is None else _layered(body, component, casting, winding)
    draw = best.draw
    if draw.has_recess or (draw.sides == WITHIN).any():
        way: Way = "core"
        why = "its openings let a core be drawn out"
    else:
        way = "cast"
        why = "one flat side lets it be poured openly" if draw.is_open else "two parts release it"
    return Plan(component, way, why, castings, winding=winding)


def _layered(
    body: Body, component: Component, casting: Casting, winding: Winding
) -> tuple[Casting, ...]:
    """Return a casting after its first layer, on which thread is wound."""
    solid = Common([component.solid, winding])
    grid = body.grid
    values = np.maximum(component.values, grid.values(winding))
    name = f"{component.name}-first"
    first = _casting(name, component, solid, body, casting.frame, values)
    volume = surface_of(solid, grid, values).volume
    return first, replace(casting, inserts=volume, first=name)


def _halves(body: Body, component: Component, cut: Cut, inlets: list[Inlet], whole: Draw) -> Plan:
    holes = [each.hole() for each in inlets if each.axis == cut.axis]
    at = body.grid.along(cut.axis)
    shape = [1, 1, 1]
    shape[cut.axis] = len(at)
    castings = []
    for side, label in ((-1, "low"), (1, "high")):
        half = HalfSpace(cut.axis, cut.at, side)
        solid = Common([component.solid, half])
        values = np.maximum(component.values, (side * (cut.at - at)).reshape(shape))
        frame = Frame.along(cut.axis, -side)
        name = f"{component.name}-{label}"
        castings.append(_casting(name, component, solid, body, frame, values, holes))
    axis = "xyz"[cut.axis]
    plane = f"the plane {axis} = {1e3 * cut.at:.4g} mm"
    seam = f"with the smallest seam, {1e6 * cut.seam:.4g} mm²"
    why = f"{plane} leaves two castings without undercuts, {seam}"
    if body.voids:
        one = len(body.voids) == 1
        closed, them = ("its chamber is", "it") if one else ("its chambers are", "them")
        why = f"{closed} closed, and {plane} opens {them} for a core {seam}"
    return Plan(component, "halves", why, tuple(castings), cut, whole.undercut, None)


def _lost(
    body: Body, component: Component, best: _Direction, whole: Draw, *, is_asked: bool
) -> Plan:
    cells = np.any([void.cells for void in body.voids], axis=0)
    solid = Filled(component.solid, cells, body.grid, component.values, component.others)
    casting = _casting(component.name, component, solid, body, best.frame, solid.sampled())
    cores = sum(void.surface.volume for void in body.voids)
    casting = replace(casting, inserts=cores)
    reason = "asked for" if is_asked else "no plane opens its chambers without undercuts"
    why = f"{reason}: a core of wax or soluble print is lost"
    return Plan(component, "lost-core", why, (casting,), None, whole.undercut, None)
