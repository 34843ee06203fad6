"""Line of stations along a clamped body, where arc positions are counted from the clamp."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import MeasurementError

#: Name of the line along the body on which the stations lie.
LineName = Literal["lower-edge", "centerline", "upper-edge"]

_SHARES = {"lower-edge": 0.0, "centerline": 0.5, "upper-edge": 1.0}


@dataclass(frozen=True)
class StationLine:
    """A straight line along the undeformed body, from the clamp face to its free end.

    Attributes
    ----------
    axis, direction
        Axis along which the body leaves the clamp (0 to 2), and its sign, +1 or -1.
    face
        Coordinate of the clamp face on that axis, m.
    length
        Free length, m.
    """

    axis: int
    direction: int
    face: float
    length: float
    _vertices: NDArray[np.float64]
    _down: NDArray[np.float64]
    _share: float
    _layer: float

    @classmethod
    def along(
        cls,
        vertices: NDArray[np.float64],
        clamped: NDArray[np.integer],
        *,
        line: LineName,
        gravity: Sequence[float],
        voxel_size: float,
    ) -> StationLine:
        """Find the line of a body that is clamped at one end.

        Parameters
        ----------
        vertices
            Vertices of the undeformed body, (n, 3), m.
        clamped
            Indices of its clamped vertices.
        line
            ``lower-edge``, ``centerline`` or ``upper-edge``, at the middle of the width.
        gravity
            Direction of gravity; zero stands for -z.
        voxel_size
            Voxel size in m.

        Raises
        ------
        MeasurementError
            The body has no free end to measure along.
        """
        free = np.ones(len(vertices), dtype=bool)
        free[clamped] = False
        if not free.any() or free.all():
            raise MeasurementError(
                "stations",
                "arc positions need a body with a clamped and a free part",
                "clamp one end of the body, or name probes instead",
            )
        way = vertices[free].mean(axis=0) - vertices[clamped].mean(axis=0)
        axis = int(np.argmax(np.abs(way)))
        direction = 1 if way[axis] > 0 else -1
        along = direction * vertices[:, axis]
        face = float(along[clamped].max())
        down = np.asarray(gravity, dtype=float)
        down = down if np.any(down) else np.array([0.0, 0.0, -1.0])
        down = np.where(np.arange(3) == axis, 0.0, down)
        if not np.any(down):
            raise MeasurementError(
                "stations",
                "the body hangs along gravity, so it has no lower edge",
                "name probes in the measurement instead of arc positions",
            )
        return cls(
            axis=axis,
            direction=direction,
            face=direction * face,
            length=float(along.max() - face),
            _vertices=vertices,
            _down=down,
            _share=_SHARES[line],
            _layer=0.5 * voxel_size,
        )

    def points(self, arcs: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points at these distances from the clamp face, (n,) → (n, 3), all in m."""
        return np.array([self._point(float(arc)) for arc in arcs])

    @property
    def foot(self) -> NDArray[np.float64]:
        """Point of the line on the clamp face, (3,), m."""
        return self._point(0.0)

    def _point(self, arc: float) -> NDArray[np.float64]:
        place = self.face + self.direction * arc
        distance = np.abs(self._vertices[:, self.axis] - place)
        section = self._vertices[distance <= max(self._layer, distance.min()) * (1 + 1e-9)]
        point: NDArray[np.float64] = 0.5 * (section.min(axis=0) + section.max(axis=0))
        depth = int(np.argmax(np.abs(self._down)))
        ends = section[:, depth].min(), section[:, depth].max()
        low, high = ends if self._down[depth] < 0 else ends[::-1]
        point[depth] = low + self._share * (high - low)
        point[self.axis] = place
        return point
