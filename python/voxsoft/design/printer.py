"""Limits of a printer, and sizes of details of molds that follow from them."""

from __future__ import annotations

import math
from typing import Final

from pydantic import Field, model_validator

from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Angle, PositiveLength, format_quantity

#: Heights of floors and lids, and widths of flanges, in walls: stiff beside soft castings.
_FLOOR: Final = 5.0
_FLANGE: Final = 10.0
#: Largest clearance of a pin, in walls: the thin socket stays narrower than all other pins.
_LOOSEST: Final = 0.5
#: Angle that no draft reaches [rad].
_STEEPEST: Final = math.radians(20.0)


class Printer(Record):
    """A printer and the details that its molds have.

    Parameters
    ----------
    wall
        Thinnest wall that it prints; default: 0.8 mm, two lines of a nozzle of 0.4 mm.
    clearance
        Gap between a pin and its socket, on each side, at most half a wall; default: 0.15 mm.
    volume
        Largest part along x, y, z; default: 220 x 220 x 220 mm.
    tube
        Outer diameter of the air tubes; default: 3 mm. Inlets are a tenth narrower, so that the
        tube seals.
    vent
        Diameter of the vents; default: 1.5 mm.
    pour
        Largest diameter of the pour hole at the casting; default: 5 mm.
    dowel
        Diameter of the dowels that join segments of a part for which the printer has no room;
        default: 1.75 mm, cut from filament.
    draft
        Angle by which upright walls of molds lean, so that they leave with less friction; below
        20 degrees, default: none. The casting becomes thicker by it.

    Examples
    --------
    >>> Printer(wall="0.4 mm").floor
    0.002
    """

    wall: PositiveLength = 0.8e-3
    clearance: PositiveLength = 0.15e-3
    volume: tuple[PositiveLength, PositiveLength, PositiveLength] = (0.22, 0.22, 0.22)
    tube: PositiveLength = 3e-3
    vent: PositiveLength = 1.5e-3
    pour: PositiveLength = 5e-3
    dowel: PositiveLength = 1.75e-3
    draft: Angle = 0.0
    resolution: PositiveLength = Field(
        0.5e-3, description="Distance of the samples from which molds are made."
    )

    @model_validator(mode="after")
    def _pins_fit(self) -> Printer:
        most = _LOOSEST * self.wall
        if self.clearance > most:
            came, shown = (format_quantity(each, "length") for each in (self.clearance, most))
            what = f"is {came}, more than half a wall: pins would fit sockets of other pins"
            raise DesignError("clearance", what, f"at most {shown}, or a thicker wall")
        return self

    @model_validator(mode="after")
    def _draft_is_small(self) -> Printer:
        if not 0.0 <= self.draft < _STEEPEST:
            came, most = (format_quantity(each, "angle") for each in (self.draft, _STEEPEST))
            raise DesignError("draft", f"is {came}; expected 0 to {most}", "1 deg is usual")
        return self

    @property
    def floor(self) -> float:
        """Thickness of floors and lids [m]."""
        return _FLOOR * self.wall

    @property
    def flange(self) -> float:
        """Width of the flange around a casting [m]."""
        return _FLANGE * self.wall

    @property
    def inlet(self) -> float:
        """Radius of an inlet [m]."""
        return 0.45 * self.tube

    @property
    def pin(self) -> float:
        """Radius of a locating pin [m]."""
        return 0.25 * self.flange
