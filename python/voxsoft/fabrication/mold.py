"""Mold of a casting: the lower and the upper part, with pins, pour hole and vents."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.printer import Printer
from voxsoft.fabrication.air import Opening, openings_of, trapped_air
from voxsoft.fabrication.drafting import Drafted, drafted
from voxsoft.fabrication.draw import ABOVE, BELOW, BESIDE, WITHIN, Draw, draw_along
from voxsoft.fabrication.fields import Box, Common, Field, Floats, Frame, Frustum, Joined, Outside
from voxsoft.fabrication.sampled import Grid, Sampled, Surface, surface_of

#: Height of a pin, in its radii.
_PIN_HEIGHT: Final = 2.0
#: Value of samples beyond those of a casting, in steps: far outside.
_FAR_OUTSIDE: Final = 8.0


@dataclass(frozen=True, eq=False)
class MoldPart:
    """One printed part of a mold.

    Attributes
    ----------
    name
        Name of its file.
    solid
        Its function, in the frame of the mold.
    values
        Its samples on the grid of the mold, negative inside [m].
    surface
        Its triangles.
    direction
        1 if it is drawn upward, -1 downward.
    """

    name: str
    solid: Field = field(repr=False)
    values: Floats = field(repr=False)
    surface: Surface
    direction: int


@dataclass(frozen=True, eq=False)
class Mold:
    """Mold that is poured with its parting plane level, and drawn apart along z.

    Attributes
    ----------
    frame
        Its axes.
    parts
        Printed parts, the lower first.
    draw
        Division between both.
    openings
        Pour hole and vents.
    trapped
        Volume of air that no opening lets out [m³].
    casting
        The casting in the frame of the mold, with its samples; with its draft.
    thicker
        Largest distance [m] by which the draft makes a side thicker; zero without draft.
    surface
        Triangles of the casting, in the frame of the mold.
    poured
        Volume between the parts without their openings [m³].
    """

    frame: Frame
    parts: tuple[MoldPart, ...]
    draw: Draw
    openings: tuple[Opening, ...]
    trapped: float
    casting: Sampled = field(repr=False)
    thicker: float
    surface: Surface
    poured: float

    @property
    def is_open(self) -> bool:
        """True where it has no lid: it is filled to the brim and leveled."""
        return len(self.parts) == 1


@dataclass(frozen=True, eq=False)
class _Half:
    """Space of one part around the casting: above the parting, or below."""

    casting: Sampled
    block: Box
    draw: Draw
    upper: bool

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        values = np.maximum(self.block.evaluate(points), -self.casting.evaluate(points))
        sides = self.draw.sides[self.casting.grid.nearest(points)]
        return np.maximum(values, self._side(points[:, 2], sides))

    def sampled(self) -> Floats:
        """Return values at the samples of the casting."""
        grid = self.casting.grid
        x, y, z = (grid.along(axis) for axis in range(3))
        low, high = self.block.low, self.block.high
        beyond = [np.maximum(low[k] - c, c - high[k]) for k, c in enumerate((x, y, z))]
        values = np.maximum(beyond[0][:, None, None], beyond[1][:, None])
        values = np.maximum(values, beyond[2])
        values = np.maximum(values, -self.casting.values)
        found: Floats = np.maximum(values, self._side(z, self.draw.sides))
        return found

    def _side(self, height: Floats, sides: NDArray[np.int8]) -> Floats:
        """Return values that are negative on this part's side."""
        away = np.where(sides == WITHIN, self.draw.bottom, self.draw.parting) - height
        far = 4.0 * self.casting.grid.step
        away = np.where(sides == ABOVE, -far, np.where(sides == BELOW, far, away))
        values: Floats = away if self.upper else -away
        return values


def mold_of(
    casting: Sampled, low: Floats, high: Floats, frame: Frame, printer: Printer, name: str
) -> Mold:
    """Make the mold of a casting.

    Parameters
    ----------
    casting
        The casting, with its inlets, in the frame of the mold.
    low, high
        Its exact corners [m].
    frame
        Axes of the mold: drawn along z, poured with z up.
    printer
        The printer.
    name
        Name of the casting, with which those of the parts begin.
    """
    aside = printer.flange
    block = Box(
        (low[0] - aside, low[1] - aside, low[2] - printer.floor),
        (high[0] + aside, high[1] + aside, high[2] + printer.floor),
    )
    casting = _within(casting, block)
    grid, cavity = casting.grid, casting.values < 0.0
    draw = draw_along(casting.values, grid, float(high[2]), float(low[2]))
    if draw.is_open:
        # A hole that goes through an open mold stands on its floor, as a pillar.
        sides = np.where(draw.sides == WITHIN, BESIDE, draw.sides).astype(np.int8)
        draw = replace(draw, sides=sides)
    if printer.draft > 0.0:
        casting = drafted(casting, draw, float(np.tan(printer.draft)))
        cavity = casting.values < 0.0
    openings = () if draw.is_open else openings_of(cavity, grid, block.high[2], printer)
    pins = [] if draw.is_open else _pins(block, draw.parting, printer)
    lower, upper = (_Half(casting, block, draw, is_upper) for is_upper in (False, True))
    parts = [_part(f"{name}-lower", lower, [pin for pin, _ in pins], [], grid)]
    if not draw.is_open:
        removed = [*(socket for _, socket in pins), *(each.bore for each in openings)]
        parts.append(_part(f"{name}-upper", upper, [], removed, grid))
    return Mold(
        frame=frame,
        parts=tuple(parts),
        draw=draw,
        openings=openings,
        trapped=0.0 if draw.is_open else trapped_air(cavity, grid, openings),
        casting=casting,
        thicker=casting.of.largest if isinstance(casting.of, Drafted) else 0.0,
        surface=surface_of(casting, grid, casting.values),
        poured=_poured(block, draw, parts, pins, openings),
    )


def _within(casting: Sampled, block: Box) -> Sampled:
    """Return a casting with samples that reach beyond a block."""
    grid = casting.grid
    first, last = np.array(grid.first), np.array([grid.along(k)[-1] for k in range(3)])
    before = np.maximum(np.ceil((first - np.array(block.low)) / grid.step) + 2, 0).astype(int)
    after = np.maximum(np.ceil((np.array(block.high) - last) / grid.step) + 2, 0).astype(int)
    ways = list(zip(before, after, strict=True))
    values = np.pad(casting.values, ways, constant_values=_FAR_OUTSIDE * grid.step)
    return Sampled(casting.of, grid.padded(before, after), values)


def _part(
    name: str, half: _Half, added: list[Frustum], removed: list[Frustum], grid: Grid
) -> MoldPart:
    values = half.sampled()
    for detail in added:
        _set(values, grid, detail, added=True)
    for detail in removed:
        _set(values, grid, detail, added=False)
    solid: Field = Joined([half, *added]) if added else half
    if removed:
        solid = Common([solid, *(Outside(each) for each in removed)])
    surface = surface_of(solid, grid, values)
    return MoldPart(name, solid, values, surface, 1 if half.upper else -1)


def _poured(
    block: Box,
    draw: Draw,
    parts: list[MoldPart],
    pins: list[tuple[Frustum, Frustum]],
    openings: tuple[Opening, ...],
) -> float:
    """Return the volume [m³] between the parts: of the block without them and without openings."""
    size = np.array(block.high) - np.array(block.low)
    if draw.is_open:
        size[2] = draw.parting - block.low[2]
    volume = float(np.prod(size)) - sum(part.surface.volume for part in parts)
    for pin, socket in pins:
        volume += pin.volume(draw.parting, pin.high) - socket.volume(draw.parting, socket.high)
    return volume - sum(each.bore.volume(each.level, block.high[2]) for each in openings)


def _pins(block: Box, parting: float, printer: Printer) -> list[tuple[Frustum, Frustum]]:
    """Return pins and sockets at the corners; one pin is thinner, so that no turned part fits."""
    radius, aside = printer.pin, printer.flange / 2.0
    found = []
    for number, (x, y) in enumerate(
        (x, y)
        for x in (block.low[0] + aside, block.high[0] - aside)
        for y in (block.low[1] + aside, block.high[1] - aside)
    ):
        wide = radius * (0.7 if number == 0 else 1.0)
        # Into the floor or lid by at most three quarters of it.
        room = 0.75 * (block.high[2] - parting)
        height = min(_PIN_HEIGHT * wide, room - printer.clearance)
        pin = Frustum((x, y), parting - wide, parting + height, wide, 0.85 * wide)
        gap = printer.clearance
        socket = Frustum(
            (x, y), parting - wide, parting + height + gap, wide + gap, 0.85 * wide + gap
        )
        found.append((pin, socket))
    return found


def _set(values: Floats, grid: Grid, detail: Frustum, *, added: bool) -> None:
    """Add a detail to the samples of a part, or remove it from them."""
    low = np.array([*detail.center, detail.low]) - 2 * grid.step
    high = np.array([*detail.center, detail.high]) + 2 * grid.step
    wide = max(detail.radius, detail.top_radius)
    low[:2] -= wide
    high[:2] += wide
    first, last = (np.array(grid.nearest(at[None])).ravel() for at in (low, high))
    window = tuple(slice(a, b + 1) for a, b in zip(first, last, strict=True))
    here = values[window]
    where = np.argwhere(np.ones(here.shape, dtype=bool)) + first
    found = detail.evaluate(grid.points(where)).reshape(here.shape)
    values[window] = np.minimum(here, found) if added else np.maximum(here, -found)
