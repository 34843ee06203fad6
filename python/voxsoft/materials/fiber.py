"""Fibers in a material: stiffness along one direction, or around an axis."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, field_validator, model_validator

from voxsoft import _core
from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.records import Record
from voxsoft.units import Angle, Point, UnitOf, Vector
from voxsoft.units.axis import Axis
from voxsoft.units.axis import direction as direction_of

Triple = tuple[float, float, float]

_EITHER = (
    'give direction = [1, 0, 0] for straight fibers, or axis = "x" and angle = "30 deg" for wound'
)


class Fiber(Record):
    """A family of fibers inside a part: straight along one direction, or wound about an axis.

    The energy is ``E_f/8 (λ² - 1)²`` on a unit of volume, with the stretch ``λ`` along the fibers:
    at small strain Young's modulus along them grows by ``modulus``. Two families at angles
    ``± θ`` make a braid.

    Parameters
    ----------
    direction
        Direction of straight fibers in the undeformed body; the length does not matter.
    angle
        Angle of wound fibers to their axis, at each place of the wall: 0 runs along the axis, 90°
        around it; between 0 and 90° the helix is right-handed, at a negative angle left-handed.
    axis
        Axis of wound fibers: ``"x"``, ``"y"``, ``"z"`` or three numbers.
    center
        A point of that axis [m]; default: the origin.
    modulus
        Young's modulus of a fiber times the part of the volume that is fiber.
    compression
        True if they carry compression too. Default: no, thin fibers buckle.

    Raises
    ------
    MaterialError
        Neither a direction nor an angle to an axis, or both; a direction without length.

    Examples
    --------
    >>> Fiber(direction=(1, 1, 0), modulus="2 MPa").unit
    (0.7071067811865475, 0.7071067811865475, 0.0)
    >>> Fiber(axis="z", angle="54.7 deg", modulus="2 MPa").is_wound
    True
    >>> Fiber(axis="z", modulus="2 MPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: angle: is missing: the angle of wound fibers to their axis. \
Try: give one, such as angle = "54.7 deg"
    """

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"direction": [1, 0, 0], "modulus": "1 MPa"}]}
    )
    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    direction: Vector | None = None
    angle: Angle | None = None
    axis: Axis | None = None
    center: Point | None = None
    modulus: Annotated[float, UnitOf("modulus", positive=True)]
    compression: bool = False

    @field_validator("direction", "axis")
    @classmethod
    def _has_direction(cls, direction: str | Vector | None) -> str | Vector | None:
        if direction is not None and not any(direction):
            raise MaterialError("", "has no direction", "give a vector that is not zero")
        return direction

    @model_validator(mode="after")
    def _is_of_one_kind(self) -> Fiber:
        wound = {key: getattr(self, key) for key in ("angle", "axis", "center")}
        given = [key for key, value in wound.items() if value is not None]
        if self.direction is not None and given:
            what = "is for wound fibers, and these have a direction"
            raise MaterialError(given[0], what, "keep one of the two")
        if self.direction is None and not given:
            raise MaterialError("direction", "is missing, and so is an angle to an axis", _EITHER)
        if self.direction is None and self.angle is None:
            what = "is missing: the angle of wound fibers to their axis"
            raise MaterialError("angle", what, 'give one, such as angle = "54.7 deg"')
        if self.direction is None and self.axis is None:
            what = "is missing: what the fibers are wound about"
            raise MaterialError("axis", what, 'give the axis of the tube, such as axis = "z"')
        return self

    @property
    def is_wound(self) -> bool:
        """True if the fibers are wound about an axis."""
        return self.direction is None

    @property
    def unit(self) -> Triple:
        """Unit vector of straight fibers, or of the axis of wound ones."""
        along = self.direction if self.axis is None else direction_of(self.axis)
        x, y, z = (np.asarray(along) / np.linalg.norm(np.asarray(along))).tolist()
        return x, y, z

    def core(self, free: float) -> _core.Fiber:
        """Make the Rust core's straight fibers, whose free length is `free` times as long."""
        return _core.Fiber(self.unit, modulus=self.modulus, compression=self.compression, free=free)

    def distances(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distance of points from the axis of wound fibers [m], (n,).

        Examples
        --------
        >>> fiber = Fiber(axis="z", angle="30 deg", modulus="1 MPa", center=("1 cm", 0, 0))
        >>> fiber.distances(np.array([[0.01, 0.02, 0.5]]))
        array([0.02])
        """
        from_center = points - np.asarray(self.center or (0.0, 0.0, 0.0))
        along = np.asarray(self.unit)
        away = from_center - np.outer(from_center @ along, along)
        found: NDArray[np.float64] = np.linalg.norm(away, axis=1)
        return found

    def winding(
        self, rotation: NDArray[np.float64], position: NDArray[np.float64], free: float
    ) -> _core.Winding:
        """Make the Rust core's wound fibers.

        Parameters
        ----------
        rotation, position
            Pose of the body of the part, (3, 3) and (3,) [m].
        free
            Ratio of the fibers' free length to their length.
        """
        assert self.angle is not None  # called for wound fibers only
        center = rotation @ (self.center or (0.0, 0.0, 0.0)) + position
        return _core.Winding(
            tuple(center.tolist()),
            tuple((rotation @ self.unit).tolist()),
            self.angle,
            modulus=self.modulus,
            compression=self.compression,
            free=free,
        )
