"""Inlets: straight holes for air tubes, from chambers through their walls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design.printer import Printer
from voxsoft.fabrication.body import Body
from voxsoft.fabrication.clamped import clamped
from voxsoft.fabrication.fields import Common, Field, Floats, Outside, Parts
from voxsoft.fabrication.sampled import Grid

Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

#: Distance of places at which inlets may be [m].
_ROUND: Final = 0.5e-3


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


def bored(
    solid: Field, values: Floats, holes: Sequence[_core.Shape], grid: Grid
) -> tuple[Field, Floats]:
    """Return a solid without some holes, and its samples."""
    if not holes:
        return solid, values
    pierced = Common([solid, *(Outside(Parts([hole])) for hole in holes)])
    return pierced, np.maximum(values, -grid.values(Parts(holes)))


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
