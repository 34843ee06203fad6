"""Young's modulus from other tests: beams that bend or vibrate, or a number with an uncertainty.

Each kind gives one modulus at small strain with a standard uncertainty, which joins the
curves in a fit. The beam formulas are those of a slender Timoshenko beam of incompressible material
(``G = E/3``, shear coefficient ``κ = 5/6``), clamped at one end.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Final, Literal, NamedTuple, Self

from pydantic import Field, ValidationError, model_validator

from voxsoft.errors import MeasurementError, VoxSoftError
from voxsoft.materials.lattice import SILICONE_DENSITY
from voxsoft.records import Record, plain_error
from voxsoft.units import FILE_CONTEXT, Modulus, PositiveDensity, PositiveLength, UnitOf

STANDARD_GRAVITY: Final = 9.80665

_SHEAR_COEFFICIENT: Final = 5.0 / 6.0
# First root of cos β cosh β = -1: the first mode of a clamped-free beam.
_FIRST_MODE: Final = 1.875104068711961
# Limits beyond which the formulas of small deflection and slender beams are off by more than 2 %.
_LARGEST_DEFLECTION: Final = 0.1
_STOUTEST: Final = 4.0

_Share = Annotated[float, UnitOf("number", positive=True)]
_NonNegativeForce = Annotated[float, UnitOf("force", non_negative=True)]
_PositiveRate = Annotated[float, UnitOf("rate", positive=True)]


class MeasuredModulus(NamedTuple):
    """Young's modulus at small strain from another test, with its uncertainty, both in Pa."""

    name: str
    young: float
    uncertainty: float


class _ModulusTest(Record):
    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    name: str = ""


class KnownModulus(_ModulusTest):
    """A Young's modulus that was found elsewhere.

    Parameters
    ----------
    young
        Young's modulus at small strain.
    uncertainty
        Its standard uncertainty, a modulus too.

    Examples
    --------
    >>> KnownModulus(young="60 kPa", uncertainty="3 kPa").modulus().uncertainty
    3000.0
    """

    kind: Literal["modulus"] = "modulus"
    young: Modulus
    uncertainty: Modulus

    def modulus(self) -> MeasuredModulus:
        """Return the modulus and its uncertainty."""
        return MeasuredModulus(self.name or self.kind, self.young, self.uncertainty)


class _Beam(_ModulusTest):
    length: PositiveLength
    height: PositiveLength
    density: PositiveDensity = SILICONE_DENSITY
    uncertainty: _Share

    @model_validator(mode="after")
    def _slender(self) -> Self:
        if self.length < _STOUTEST * self.height:
            raise MeasurementError(
                "length",
                f"is {self.length / self.height:.1f} times the height; "
                f"the beam formula needs at least {_STOUTEST:g}",
                "use voxsoft calibrate with a design of the specimen",
            )
        return self


class BendingTest(_Beam):
    """The tip deflection of a level cantilever under its weight and a force at the tip.

    With the weight per length ``w = ρ g b h`` and ``I = b h³/12``,
    ``E δ = F L³/(3 I) + w L⁴/(8 I) + 3 (F L + w L²/2)/(κ b h)``.

    Parameters
    ----------
    length, width, height
        Free length, width, and thickness in the direction of bending.
    deflection
        Downward, of the tip's center line, at most a tenth of the length.
    force
        Downward at the tip, in addition to the beam's own weight. Default 0.
    density
        Default 1070 kg/m³.
    uncertainty
        Standard uncertainty of the modulus as a share of it, ``"5 %"``. The thickness counts
        three times: 2 % of it are 6 %.

    Examples
    --------
    >>> seen = BendingTest(
    ...     length="50 mm",
    ...     width="10 mm",
    ...     height="10 mm",
    ...     deflection="4 mm",
    ...     uncertainty="5 %",
    ... )
    >>> round(seen.modulus().young / 1e3, 1)
    257.7
    """

    kind: Literal["bending"] = "bending"
    width: PositiveLength
    deflection: PositiveLength
    force: _NonNegativeForce = 0.0

    @model_validator(mode="after")
    def _small(self) -> Self:
        if self.deflection > _LARGEST_DEFLECTION * self.length:
            raise MeasurementError(
                "deflection",
                f"is {self.deflection / self.length:.0%} of the length; "
                f"the beam formula holds to {_LARGEST_DEFLECTION:.0%}",
                "use voxsoft calibrate, which solves the whole shape",
            )
        return self

    def modulus(self) -> MeasuredModulus:
        """Return the modulus and its uncertainty."""
        area, inertia = self.width * self.height, self.width * self.height**3 / 12.0
        weight = self.density * STANDARD_GRAVITY * area
        force, length = self.force, self.length
        bent = force * length**3 / (3.0 * inertia) + weight * length**4 / (8.0 * inertia)
        moment = force * length + weight * length**2 / 2.0
        sheared = 3.0 * moment / (_SHEAR_COEFFICIENT * area)
        young = (bent + sheared) / self.deflection
        return MeasuredModulus(self.name or self.kind, young, self.uncertainty * young)


class FrequencyTest(_Beam):
    """The first natural frequency of a cantilever that swings freely.

    ``E = (2π f)² ρ (12 L⁴/(β⁴ h²) + 12 L²/(π² κ))`` with ``β = 1.8751``: bending and shear joined
    by Dunkerley's rule. Gravity along the beam, damping and markers that add mass are not in it.

    Parameters
    ----------
    length, height
        Free length, and thickness in the direction of swinging.
    frequency
        In Hz. A silicone is stiffer at this rate than at rest.
    density
        Default 1070 kg/m³.
    uncertainty
        Standard uncertainty of the modulus as a share of it, ``"5 %"``.

    Examples
    --------
    >>> seen = FrequencyTest(
    ...     length="100 mm", height="10 mm", frequency="1.2 Hz", uncertainty="5 %"
    ... )
    >>> round(seen.modulus().young / 1e3, 1)
    59.9
    """

    kind: Literal["frequency"] = "frequency"
    frequency: _PositiveRate

    def modulus(self) -> MeasuredModulus:
        """Return the modulus and its uncertainty."""
        rate = 2.0 * math.pi * self.frequency
        bent = 12.0 * self.length**4 / (_FIRST_MODE**4 * self.height**2)
        sheared = 12.0 * self.length**2 / (math.pi**2 * _SHEAR_COEFFICIENT)
        young = rate**2 * self.density * (bent + sheared)
        return MeasuredModulus(self.name or self.kind, young, self.uncertainty * young)


#: Any of the tests, discriminated by ``kind``.
ModulusTest = Annotated[KnownModulus | BendingTest | FrequencyTest, Field(discriminator="kind")]


class ModulusTests(Record):
    """A file of such tests: ``[[observation]]`` tables, each with its ``kind``."""

    error_type: ClassVar[type[VoxSoftError]] = MeasurementError

    observation: tuple[ModulusTest, ...] = Field(min_length=1)


def read_modulus_tests(document: Mapping[str, Any]) -> list[MeasuredModulus]:
    """Read measured moduli from parsed TOML, where numbers carry their units as text.

    Raises
    ------
    MeasurementError
        Every problem is listed with its place.

    Examples
    --------
    >>> table = {"kind": "modulus", "young": "60 kPa", "uncertainty": "3 kPa"}
    >>> read_modulus_tests({"observation": [table]})[0].young
    60000.0
    """
    try:
        read = ModulusTests.model_validate(document, context=dict(FILE_CONTEXT))
    except ValidationError as error:
        raise plain_error(error, ModulusTests, document) from None
    return [test.modulus() for test in read.observation]
