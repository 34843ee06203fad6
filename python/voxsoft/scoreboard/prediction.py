"""Prediction of one measured number."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from voxsoft.units import KINDS


@dataclass(frozen=True)
class Prediction:
    """Predicted number with its interval, and the measured one.

    The parts of the interval are half-widths within which 90 % are expected, each for a separate
    reason, so that their squares add up.

    Attributes
    ----------
    case
        Name of the robot.
    name
        Name of the number.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    measured, predicted
        Measured and predicted number in SI units.
    material
        Half-width from constants: their fit, their batch, their scatter.
    geometry
        Half-width from sizes and places that are not known exactly.
    numerics
        Half-width from the voxels: the error bar.
    repeatability
        Half-width from one measurement to the next.
    scale
        Reference of the width; default: the size of the measured number. For a coordinate it is a
        length of the robot.

    Examples
    --------
    >>> sag = Prediction("beam", "sag", "length", 0.010, 0.0101, material=3e-4, numerics=4e-4)
    >>> round(sag.half_width, 7), sag.inside
    (0.0005, True)
    """

    case: str
    name: str
    kind: str
    measured: float
    predicted: float
    material: float = 0.0
    geometry: float = 0.0
    numerics: float = 0.0
    repeatability: float = 0.0
    scale: float | None = None

    def __post_init__(self) -> None:
        """Refuse an unknown kind: axes and tables take their units from it."""
        if self.kind not in KINDS:
            raise ValueError(f"{self.case}, {self.name}: {self.kind} is not a kind of quantity")

    @property
    def half_width(self) -> float:
        """Half of the width of the interval."""
        return math.hypot(self.material, self.geometry, self.numerics, self.repeatability)

    @property
    def low(self) -> float:
        """Lower end of the interval."""
        return self.predicted - self.half_width

    @property
    def high(self) -> float:
        """Upper end of the interval."""
        return self.predicted + self.half_width

    @property
    def inside(self) -> bool:
        """True if the measurement is in the interval."""
        return self.low <= self.measured <= self.high

    @property
    def width(self) -> float:
        """Width of the interval over the size of the number."""
        size = abs(self.measured) if self.scale is None else self.scale
        return 2.0 * self.half_width / size if size else math.inf

    def summary(self) -> dict[str, Any]:
        """Plain data in SI units."""
        return {
            "case": self.case,
            "name": f"{self.case}: {self.name}",
            "kind": self.kind,
            "measured": self.measured,
            "predicted": self.predicted,
            "low": self.low,
            "high": self.high,
            "inside": self.inside,
            "width": self.width,
            "parts": {
                part: getattr(self, part)
                for part in ("material", "geometry", "numerics", "repeatability")
            },
        }
