"""Range of values over which colors run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Percent of the area whose values the colors distinguish, where a few others lie far away.
CLIP: Final = 99.0
#: Distance of far values, as a part of the range of the others.
FAR: Final = 0.1


@dataclass(frozen=True)
class ColorRange:
    """Values at the ends of the colors, and the extremes of all.

    Attributes
    ----------
    low, high
        Values at the ends of the colors.
    least, most
        Vertices with the smallest and the largest of all values.
    clips_low, clips_high
        True if those lie beyond the ends.
    """

    low: float
    high: float
    least: int
    most: int
    clips_low: bool
    clips_high: bool

    @property
    def extend(self) -> str:
        """Argument `extend` of a color bar of matplotlib."""
        names = {(True, True): "both", (True, False): "min", (False, True): "max"}
        return names.get((self.clips_low, self.clips_high), "neither")


def color_range(
    values: Floats, triangles: NDArray[np.integer], points: Floats, *, clip: bool = True
) -> ColorRange:
    """Choose the ends of the colors: all values, or 99 % of the area where few lie far beyond.

    At sharp corners a stress has no bound; its one vertex would leave all others one color.

    Parameters
    ----------
    values
        One number for each vertex, (n,); those that are not finite do not count.
    triangles
        The surface that is shown, (t, 3).
    points
        Vertices in m, (n, 3), for the areas.
    clip
        True to allow a few values beyond the ends. Displacements are not clipped: they have no
        singularities at sharp corners, and the tip that moves most is the subject of the picture.

    Examples
    --------
    >>> strip = np.array([[x, y, 0.0] for x in range(300) for y in range(2)])
    >>> pairs = np.array([[[i, i + 2, i + 1], [i + 1, i + 2, i + 3]] for i in range(0, 598, 2)])
    >>> values = strip[:, 0].copy()
    >>> color_range(values, pairs.reshape(-1, 3), strip).clips_high
    False
    >>> values[300] = 1e6
    >>> found = color_range(values, pairs.reshape(-1, 3), strip)
    >>> found.clips_high, found.most, found.high < 300
    (True, 300, True)
    """
    a, b, c = points[triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0
    weights = np.bincount(triangles.ravel(), np.repeat(areas, 3), minlength=len(values))
    weights = np.where(np.isfinite(values), weights, 0.0)
    order = np.argsort(np.where(np.isfinite(values), values, np.inf), kind="stable")
    order = order[weights[order] > 0.0]
    below = np.cumsum(weights[order])
    ends = np.array([100.0 - CLIP, CLIP]) / 100.0 * below[-1]
    inner_low, inner_high = values[order[np.searchsorted(below, ends)]]
    least, most = int(order[0]), int(order[-1])
    reach = FAR * (inner_high - inner_low) if clip else np.inf
    clips_low = bool(values[least] < inner_low - reach)
    clips_high = bool(values[most] > inner_high + reach)
    return ColorRange(
        low=float(inner_low if clips_low else values[least]),
        high=float(inner_high if clips_high else values[most]),
        least=least,
        most=most,
        clips_low=clips_low,
        clips_high=clips_high,
    )
