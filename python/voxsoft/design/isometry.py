"""Moves, turns and mirror images of space, and of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.clamp import Motion, Rotation
from voxsoft.design.mirrored import Axis, Triple
from voxsoft.geometry import rotation_matrix

if TYPE_CHECKING:
    from voxsoft.design.body import Body

Floats = NDArray[np.float64]

#: Largest angle between directions that count as the same.
SAME: Final = 1e-9


@dataclass(frozen=True, eq=False)
class Isometry:
    """A map of space that keeps all lengths: ``x → matrix @ x + shift``.

    Attributes
    ----------
    matrix
        Orthogonal, (3, 3).
    shift
        In m, (3,).
    """

    matrix: Floats
    shift: Floats

    @classmethod
    def move(cls, by: Triple) -> Self:
        """Move by a vector [m]."""
        return cls(np.eye(3), np.asarray(by, dtype=float))

    @classmethod
    def turn(cls, axis: Triple, angle: float, center: Triple = (0.0, 0.0, 0.0)) -> Self:
        """Turn about an axis through a center [m] by an angle [rad], right-handed.

        Examples
        --------
        >>> quarter = Isometry.turn((0, 0, 1), np.pi / 2, center=(1, 0, 0))
        >>> quarter.point((2, 0, 0))
        (1.0, 1.0, 0.0)
        """
        matrix = rotation_matrix(axis, angle)
        return cls(matrix, np.asarray(center) - matrix @ center)

    @classmethod
    def mirror(cls, axis: Axis, at: float = 0.0) -> Self:
        """Mirror in the plane across an axis at a place [m] along it.

        Examples
        --------
        >>> Isometry.mirror("x", at=1.0).point((3, 4, 5))
        (-1.0, 4.0, 5.0)
        """
        across = np.array([float(axis == each) for each in "xyz"])
        return cls(np.diag(1.0 - 2.0 * across), 2.0 * at * across)

    @property
    def mirrors(self) -> bool:
        """True if it makes a left hand of a right one."""
        return float(np.linalg.det(self.matrix)) < 0.0

    def point(self, at: Triple) -> Triple:
        """Image of a point [m]."""
        return _triple(self.matrix @ at + self.shift)

    def vector(self, along: Triple) -> Triple:
        """Image of a vector, such as a displacement."""
        return _triple(self.matrix @ along)

    def motion(self, motion: Motion) -> Motion:
        """Image of a motion: it does to the image of the body the same as `motion` to the body.

        A turn ``R`` becomes ``A R Aᵀ``: by the same angle about ``A a``, or about ``-A a`` in a
        mirror, as an axis ``a`` is a cross product and ``A u × A v = det(A) A (u × v)``.

        Examples
        --------
        >>> turn = Rotation(axis=(0, 0, 1), angle="30 deg", center=("1 mm", 0, 0))
        >>> image = Isometry.mirror("x").motion(Motion(rotation=turn)).rotation
        >>> image.axis, image.center
        ((0.0, 0.0, -1.0), (-0.001, 0.0, 0.0))
        """
        turn = motion.rotation
        if turn is not None:
            sign = -1.0 if self.mirrors else 1.0
            axis = _triple(sign * (self.matrix @ turn.axis))
            turn = turn.replace(axis=axis, center=self.point(turn.center))
        return motion.replace(displacement=self.vector(motion.displacement), rotation=turn)

    def changes(self, body: Body) -> dict[str, Any]:
        """Position, rotation, mirror and motion of a body that this map has taken along.

        With the pose ``x = R M y + p``, where ``M`` is the mirror of the body or nothing, the map
        ``A x + b`` gives ``(A R M) y + A p + b``. Where that turns left to right, a mirror of the
        body is taken out or in: across the axis that points most nearly out of the plane, so that
        a body along the axes stays so.
        """
        rotation, position = body.pose
        own = np.eye(3) if body.mirror is None else Isometry.mirror(body.mirror).matrix
        whole = self.matrix @ rotation @ own
        mirror: Axis | None = None
        if np.linalg.det(whole) < 0.0:
            mirror = body.mirror or self._across(rotation)
            whole = whole @ Isometry.mirror(mirror).matrix
        return {
            "position": self.point(_triple(position)),
            "rotation": rotation_of(whole),
            "mirror": mirror,
            "motion": None if body.motion is None else self.motion(body.motion),
        }

    def _across(self, rotation: Floats) -> Axis:
        """The axis of a body that points most nearly along the normal of this mirror."""
        values, vectors = np.linalg.eigh(self.matrix + self.matrix.T)
        normal = rotation.T @ vectors[:, np.argmin(values)]
        axes: tuple[Axis, ...] = ("x", "y", "z")
        return axes[int(np.argmax(np.abs(normal)))]


def rotation_of(matrix: Floats) -> Rotation | None:
    """Return the turn about the origin that a matrix is; None where there is none.

    Examples
    --------
    >>> rotation_of(np.diag([-1.0, -1.0, 1.0])).axis
    (0.0, 0.0, 1.0)
    """
    from scipy.spatial.transform import Rotation as Turn

    vector = Turn.from_matrix(matrix).as_rotvec()
    angle = float(np.linalg.norm(vector))
    if angle < SAME:
        return None
    axis = vector / angle
    axis[np.abs(axis) < SAME] = 0.0
    return Rotation(axis=_triple(axis), angle=angle)


def _triple(values: Floats) -> Triple:
    x, y, z = (float(value) + 0.0 for value in values)  # no -0.0
    return x, y, z
