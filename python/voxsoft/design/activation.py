"""What makes a part longer or shorter by itself: swelling, heat, shape memory."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, field_validator

from voxsoft.design.operands import Name
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Dimensionless


class Strain(Record):
    """A part that is so much longer along every axis when it is free of stress.

    Parameters
    ----------
    part
        The name of the part.
    value
        The strain, above −1: ``"2 %"`` is 1.02 times as long, a negative one shrinks. Of heat it is
        the coefficient of expansion times the change of temperature.

    Examples
    --------
    >>> Strain(part="upper", value="2 %").stretch
    1.02
    """

    kind: Literal["strain"] = "strain"
    part: Name
    value: Dimensionless

    @field_validator("value")
    @classmethod
    def _leaves_something(cls, value: float) -> float:
        return _check_change(value)

    @property
    def stretch(self) -> float:
        """How many times as long it is."""
        return 1.0 + self.value

    def share(self, part: float) -> Strain:
        """A part of it."""
        return self.replace(value=part * self.value)


class Swelling(Record):
    """A part whose volume is so much larger when it is free of stress.

    Parameters
    ----------
    part
        The name of the part.
    value
        The change of its volume, above −1: ``"20 %"`` of a gel that takes up a fifth of its volume
        of water. The mass stays that of the dry part.

    Examples
    --------
    >>> round(Swelling(part="gel", value="20 %").stretch, 4)
    1.0627
    """

    kind: Literal["swelling"] = "swelling"
    part: Name
    value: Dimensionless

    @field_validator("value")
    @classmethod
    def _leaves_something(cls, value: float) -> float:
        return _check_change(value)

    @property
    def stretch(self) -> float:
        """How many times as long it is."""
        return float((1.0 + self.value) ** (1.0 / 3.0))

    def share(self, part: float) -> Swelling:
        """A part of it."""
        return self.replace(value=part * self.value)


def _check_change(value: float) -> float:
    if value <= -1.0:
        raise DesignError("", f"is {value:g}: nothing would be left", "give more than -1")
    return value


AnyActivation = Annotated[Strain | Swelling, Discriminator("kind")]
