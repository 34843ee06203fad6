"""Fibers spread over a material: stiffness along one direction."""

from __future__ import annotations

from typing import Annotated, ClassVar

import numpy as np
from pydantic import field_validator

from voxsoft import _core
from voxsoft.errors import MaterialError, VoxSoftError
from voxsoft.records import Record
from voxsoft.units import UnitOf, Vector


class Fiber(Record):
    """A family of fibers inside a part, all along one direction of the undeformed body.

    The energy is ``E_f/8 (λ² - 1)²`` on a unit of volume, with the stretch ``λ`` along the fibers:
    at small strain Young's modulus along them grows by ``modulus``. Two families at angles
    ``± θ`` make a braid.

    Parameters
    ----------
    direction
        Where they run; the length does not matter.
    modulus
        Young's modulus of a fiber times the part of the volume that is fiber.
    compression
        Whether they carry compression too. Default: no, thin fibers buckle.

    Examples
    --------
    >>> Fiber(direction=(1, 1, 0), modulus="2 MPa").unit
    (0.7071067811865475, 0.7071067811865475, 0.0)
    >>> Fiber(direction=(0, 0, 0), modulus="2 MPa")
    Traceback (most recent call last):
    ...
    voxsoft.errors.MaterialError: direction: has no direction. Try: give a vector that is not zero
    """

    error_type: ClassVar[type[VoxSoftError]] = MaterialError

    direction: Vector
    modulus: Annotated[float, UnitOf("modulus", positive=True)]
    compression: bool = False

    @field_validator("direction")
    @classmethod
    def _has_direction(cls, direction: Vector) -> Vector:
        if not any(direction):
            raise MaterialError("", "has no direction", "give a vector that is not zero")
        return direction

    @property
    def unit(self) -> tuple[float, float, float]:
        """The direction with length one."""
        x, y, z = (np.asarray(self.direction) / np.linalg.norm(self.direction)).tolist()
        return x, y, z

    @property
    def core(self) -> _core.Fiber:
        """What the Rust core takes."""
        return _core.Fiber(self.unit, modulus=self.modulus, compression=self.compression)
