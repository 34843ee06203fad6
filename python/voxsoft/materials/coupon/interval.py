"""Confidence interval of a constant, and the noise of residuals that it follows from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voxsoft.materials.hyperelastic import Floats


@dataclass(frozen=True)
class Interval:
    """Constant with its 95 % confidence interval, all in SI units."""

    value: float
    low: float
    high: float

    @property
    def half_width(self) -> float:
        """Half the length of the interval."""
        return 0.5 * (self.high - self.low)


def noise_of(residuals: Sequence[Floats], size: int, floor: float) -> tuple[float, float]:
    """Estimate the scale of residuals in Pa, and the share of independent points.

    Parameters
    ----------
    residuals
        Residuals of each curve, in Pa.
    size
        Number of fitted constants.
    floor
        Least possible scale, in Pa.
    """
    total = sum(float(r @ r) for r in residuals)
    points = sum(len(r) for r in residuals)
    scale = max(np.sqrt(total / max(points - size, 1)), floor)
    lagged = sum(float(r[1:] @ r[:-1]) for r in residuals)
    correlation = min(max(lagged / total if total > 0.0 else 0.0, 0.0), 0.99)
    return float(scale), (1.0 - correlation) / (1.0 + correlation)
