"""A dielectric sheet that its electrodes squeeze."""

from __future__ import annotations

from typing import Final, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator

from voxsoft.design.growth import Activation
from voxsoft.errors import DesignError
from voxsoft.units import ElectricField, PositiveElectricField, Proportion, Vector

#: ε₀ in F/m (CODATA 2022).
VACUUM_PERMITTIVITY: Final = 8.8541878188e-12


class Dielectric(Activation):
    """A sheet between compliant electrodes on both of its sides, at a voltage that is held.

    Parameters
    ----------
    part
        The name of the part, which is the sheet.
    value
        The electric field in V/m as drawn: the voltage over the undeformed thickness. It is
        squeezed the more, the thinner it becomes.
    permittivity
        Relative to that of the vacuum, at least 1: 2.8 of silicone, 4.7 of acrylic tape.
    normal
        Across the sheet, in the axes of its body, undeformed; of any length.
    breakdown
        The field in V/m that the sheet stands as it is then. A state with more of it is warned of.
        Default: not looked at.
    history
        A factor on the value of the field over time. Default: constant.

    Examples
    --------
    >>> sheet = Dielectric(part="film", value="60 MV/m", permittivity=2.8, normal=(0, 0, 1))
    >>> sheet.value
    60000000.0
    >>> round(sheet.pressure)
    44625
    """

    kind: Literal["dielectric"] = "dielectric"
    value: ElectricField
    permittivity: Proportion
    normal: Vector
    breakdown: PositiveElectricField | None = None

    @field_validator("normal")
    @classmethod
    def _has_direction(cls, normal: Vector) -> Vector:
        if not any(normal):
            raise DesignError("", "has no direction", "give a vector that is not zero")
        return normal

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.permittivity < 1.0:
            what = f"is {self.permittivity:g}, less than that of the vacuum"
            raise DesignError("permittivity", what, "give the relative one: 2.8 of silicone")
        return self

    @property
    def growth(self) -> None:
        """It is squeezed, and does not grow by itself."""
        return

    @property
    def pressure(self) -> float:
        """Half of the permittivity times the square of the field as drawn, Pa."""
        return 0.5 * VACUUM_PERMITTIVITY * self.permittivity * self.value**2

    @property
    def axes(self) -> NDArray[np.float64]:
        """Two directions in the sheet and its normal, in rows, orthonormal, (3, 3)."""
        normal = np.asarray(self.normal) / np.linalg.norm(self.normal)
        along = np.eye(3)[int(np.argmin(np.abs(normal)))]
        first = np.cross(normal, along)
        first /= np.linalg.norm(first)
        return np.array([first, np.cross(normal, first), normal])

    def share(self, part: float) -> Self:
        """A part of the field that it comes to in the end, without a history."""
        return self.replace(value=part * self.factor * self.value, history=None)
