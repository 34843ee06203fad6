"""Rigid plates for the clamped faces of a body: printed, bonded on, with bores for air tubes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.design.printer import Printer
from voxsoft.fabrication.body import Body, Filled
from voxsoft.fabrication.clamped import clamped
from voxsoft.fabrication.fields import (
    Box,
    Common,
    Field,
    Floats,
    Frame,
    Frustum,
    Outside,
    Parts,
    Turned,
)
from voxsoft.fabrication.inlets import Inlet
from voxsoft.fabrication.sampled import Grid, Surface, surface_of

Face = tuple[int, int, float]

#: Part of the area of a face that is flat, and held, where the face gets a plate.
_MOST: Final = 0.5
#: Depth behind a face at which it is as wide as one step inside if it is flat, in steps.
_FLAT: Final = 0.02


@dataclass(frozen=True, eq=False)
class Plate:
    """Rigid plate on a clamped face.

    Attributes
    ----------
    name
        Name of its file.
    surface
        Its triangles, lying on its outer side.
    face
        Axis, direction outward and position [m] of the face in the design.
    """

    name: str
    surface: Surface = field(repr=False)
    face: Face


@dataclass(frozen=True, eq=False)
class _Outline:
    """Section of a body right behind a face, extended along the normal, and widened."""

    body: Field
    behind: float
    rim: float

    def evaluate(self, points: Floats) -> Floats:
        """Return values [m] at points (n, 3) [m]."""
        flat = points.copy()
        flat[:, 2] = self.behind
        values: Floats = self.body.evaluate(flat) - self.rim
        return values


@dataclass(frozen=True)
class _Slab:
    low: float
    high: float

    def evaluate(self, points: Floats) -> Floats:
        values: Floats = np.maximum(self.low - points[:, 2], points[:, 2] - self.high)
        return values


def clamped_faces(body: Body) -> list[Face]:
    """Return flat faces at an end of the body that clamps hold for the most part.

    Each is an axis, the direction outward, and the position [m].
    """
    solid = Parts(built_parts(body.design))
    found: list[Face] = []
    for axis in range(3):
        for sign, end in ((-1, body.low[axis]), (1, body.high[axis])):
            layers = np.flatnonzero((np.moveaxis(body.values, axis, 0) < 0.0).any(axis=(1, 2)))
            layer = layers[0] if sign < 0 else layers[-1]
            cells = np.argwhere(np.take(body.values, layer, axis) < 0.0)
            points = body.grid.points(np.insert(cells, axis, layer, axis=1))
            points[:, axis] = end - sign * _FLAT * body.grid.step
            is_flat = (solid.evaluate(points) < 0.0).mean() > _MOST
            points[:, axis] = end
            if is_flat and clamped(body.design, points, 0.5 * body.grid.step).mean() > _MOST:
                found.append((axis, sign, float(end)))
    return found


def plates_of(body: Body, inlets: list[Inlet], printer: Printer) -> list[Plate]:
    """Return a plate for each flat clamped face, as wide as the body and a rim for screws."""
    cells = np.any([void.cells for void in body.voids], axis=0) if body.voids else None
    solid: Field = Parts(built_parts(body.design))
    if cells is not None:
        solid = Filled(solid, cells, body.grid, body.values)
    found = []
    for number, (axis, sign, at) in enumerate(clamped_faces(body), 1):
        frame = Frame.along(axis, sign)
        level = sign * at
        local = Turned(solid, frame)
        outline = _Outline(local, level - 1.5 * body.grid.step, 0.5 * printer.flange)
        corners = frame.local(np.stack([body.low, body.high]))
        low, high = corners.min(axis=0), corners.max(axis=0)
        low[2], high[2] = level, level + printer.floor
        grid = Grid.around(low, high, printer.resolution, printer.flange)
        bores = [
            Frustum(
                (float(center[0]), float(center[1])),
                level - 1e-3,
                level + printer.floor + 1e-3,
                printer.tube / 2.0 + printer.clearance,
                printer.tube / 2.0 + printer.clearance,
            )
            for each in inlets
            if (each.axis, each.sign) == (axis, sign) and abs(each.at[axis] - at) < body.grid.step
            for center in frame.local(np.array([each.at]))
        ]
        rim = 0.5 * printer.flange
        block = Box((low[0] - rim, low[1] - rim, low[2]), (high[0] + rim, high[1] + rim, high[2]))
        # One plate for all that stands on the face: round it, or else a block below all of it.
        for shape in (Common([_Slab(level, level + printer.floor), outline]), block):
            pierced = Common([shape, *(Outside(bore) for bore in bores)])
            surface = surface_of(pierced, grid)
            if surface.components == 1:
                break
        found.append(Plate(f"plate-{number}", surface, (axis, sign, at)))
    return found
