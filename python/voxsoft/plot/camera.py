"""Orthographic view: no perspective, so that a scale bar holds everywhere in the picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Camera:
    """View of a body, with the size of a pixel.

    Attributes
    ----------
    right, up, toward : ndarray, shape (3,)
        Unit vectors: along rows, against columns, and toward the eye.
    left, top
        Coordinates of the upper left corner of the picture along `right` and `up`, m.
    pixel
        Side of a pixel, m.
    width, height
        Size of the picture in pixels.
    """

    right: Floats
    up: Floats
    toward: Floats
    left: float
    top: float
    pixel: float
    width: int
    height: int

    @classmethod
    def around(cls, points: Floats, view: tuple[float, float], pixels: int) -> Camera:
        """Fit a picture around points.

        Parameters
        ----------
        points
            Points that must be visible, (n, 3), m.
        view
            Azimuth and elevation of the eye in degrees, from x toward y and from there up.
        pixels
            Size of the longer side of the picture in pixels.
        """
        azimuth, elevation = np.radians(view)
        toward = np.array(
            [
                np.cos(elevation) * np.cos(azimuth),
                np.cos(elevation) * np.sin(azimuth),
                np.sin(elevation),
            ]
        )
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        up = np.cross(toward, right)
        flat = points @ np.column_stack([right, up])
        low, high = flat.min(axis=0), flat.max(axis=0)
        margin = 0.02 * float((high - low).max()) + 1e-9
        size = high - low + 2 * margin
        pixel = float(size.max()) / pixels
        width, height = np.ceil(size / pixel).astype(int)
        left, top = low[0] - margin, high[1] + margin
        return cls(right, up, toward, float(left), float(top), pixel, int(width), int(height))

    def project(self, points: Floats) -> Floats:
        """Return column, row and depth of points, (n, 3); depth is in pixels too."""
        columns = (points @ self.right - self.left) / self.pixel
        rows = (self.top - points @ self.up) / self.pixel
        return np.column_stack([columns, rows, -(points @ self.toward) / self.pixel])
