"""Position and rotation of instances and local systems of Abaqus input."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import FileError
from voxsoft.formats.abaqus_cards import Card


@dataclass(frozen=True)
class Placing:
    """Rotation and shift: ``x = rotation @ own + position``."""

    rotation: NDArray[np.float64] = field(default_factory=lambda: np.eye(3))
    position: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    def placed(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return transformed points (n, 3); unchanged to the bit without rotation and shift."""
        if (self.rotation == np.eye(3)).all():
            return points + self.position if self.position.any() else points
        moved: NDArray[np.float64] = points @ self.rotation.T + self.position
        return moved

    @classmethod
    def of_instance(cls, card: Card) -> Self:
        """Return the placing of an instance: a line with its shift, then one with its rotation.

        The rotation is about the axis from one point to another, by an angle in degrees, and comes
        after the shift.

        Raises
        ------
        FileError
            If the lines are not 3 and 7 numbers, or the axis has no length.
        """
        rows = [card.numbers(row) for row in card.data]
        if not rows:
            return cls()
        shift = np.array((*rows[0], 0.0, 0.0, 0.0)[:3])
        if len(rows) == 1:
            return cls(position=shift)
        if len(rows) > 2 or len(rows[1]) < 7 or rows[1][:3] == rows[1][3:6]:
            what = f"*INSTANCE {card.get('NAME')} has a turn that is not two points and an angle"
            raise FileError(card.where, what, "write x, y, z of both points, then degrees")
        start, stop = np.array(rows[1][:3]), np.array(rows[1][3:6])
        rotation = _turn(stop - start, np.radians(rows[1][6]))
        return cls(rotation, rotation @ (shift - start) + start)


def _turn(axis: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Return a rotation matrix by Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix: NDArray[np.float64] = (
        np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    )
    return matrix


def local_system(card: Card) -> Placing:
    """Return the local system of ``*SYSTEM``: its origin, a point on x, a point in the xy plane.

    Raises
    ------
    FileError
        If it has a point on x without a plane, or points in one line.
    """
    values = [number for row in card.data for number in card.numbers(row)]
    if not any(values):
        return Placing()
    points = np.array([*values, *[0.0] * 9][:9]).reshape(3, 3)
    origin = points[0]
    if len(values) <= 3:
        return Placing(position=origin)
    x = points[1] - origin
    # Without a third point the local z is the global one.
    second = points[2] - origin if len(values) > 6 else np.cross((0.0, 0.0, 1.0), x)
    z = np.cross(x, second)
    if not (np.linalg.norm(x) > 0 and np.linalg.norm(z) > 0) or (len(values) <= 6 and x[2]):
        raise FileError(card.where, "*SYSTEM has points that span no plane", "give three points")
    x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
    return Placing(np.column_stack((x, np.cross(z, x), z)), origin)
