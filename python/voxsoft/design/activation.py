"""What makes a part longer or shorter by itself: swelling, heat, shape memory."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Discriminator, field_validator, model_validator

from voxsoft.design.operands import Name
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Dimensionless, PositiveTemperature, ThermalExpansion


class Activation(Record):
    """A part that is longer or shorter by itself; a kind says what its value means."""

    part: Name

    #: Whether the fibers of the part alone are longer, and not what is around them.
    of_fibers: ClassVar[bool] = False

    @property
    @abstractmethod
    def stretch(self) -> float:
        """How many times as long the part is when it is free of stress."""

    @abstractmethod
    def share(self, part: float) -> Self:
        """A part of it."""


class _Growth(Activation):
    """An activation whose value is a change of size."""

    value: Dimensionless

    @field_validator("value")
    @classmethod
    def _leaves_something(cls, value: float) -> float:
        if value <= -1.0:
            raise DesignError("", f"is {value:g}: nothing would be left", "give more than -1")
        return value

    def share(self, part: float) -> Self:
        """A part of it."""
        return self.replace(value=part * self.value)


class Strain(_Growth):
    """A part that is so much longer along every axis when it is free of stress.

    Parameters
    ----------
    part
        The name of the part.
    value
        The strain, above −1: ``"2 %"`` is 1.02 times as long, a negative one shrinks.

    Examples
    --------
    >>> Strain(part="upper", value="2 %").stretch
    1.02
    """

    kind: Literal["strain"] = "strain"

    @property
    def stretch(self) -> float:
        """How many times as long the part is when it is free of stress."""
        return 1.0 + self.value


class Swelling(_Growth):
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

    @property
    def stretch(self) -> float:
        """How many times as long the part is when it is free of stress."""
        return float((1.0 + self.value) ** (1.0 / 3.0))


class Thermal(Activation):
    """A part that is so warm, and grows with its temperature.

    Parameters
    ----------
    part
        The name of the part.
    value
        Its temperature in kelvin.
    expansion
        The coefficient of linear expansion; 3e-4 1/K of silicone rubber.
    reference
        The temperature at which it has the size of the design; default 293.15 K, which is 20 °C.

    Examples
    --------
    >>> round(Thermal(part="upper", value="353.15 K", expansion="3e-4 1/K").stretch, 12)
    1.018
    """

    kind: Literal["thermal"] = "thermal"
    value: PositiveTemperature
    expansion: ThermalExpansion
    reference: PositiveTemperature = 293.15

    @model_validator(mode="after")
    def _leaves_something(self) -> Self:
        if self.stretch <= 0.0:
            what = f"{self.expansion:g} 1/K over {self.value - self.reference:g} K leaves nothing"
            raise DesignError("expansion", what, "give the coefficient of linear expansion in 1/K")
        return self

    @property
    def stretch(self) -> float:
        """How many times as long the part is when it is free of stress."""
        return 1.0 + self.expansion * (self.value - self.reference)

    def share(self, part: float) -> Self:
        """A part of the way from the reference."""
        return self.replace(value=self.reference + part * (self.value - self.reference))


class FiberStrain(_Growth):
    """A part whose fibers are so much longer along themselves when they are free of stress.

    What is around them is not, and holds against it: a negative strain is a muscle, a shape-memory
    wire or a drawn polymer thread in rubber. Without ``compression`` fibers that are longer by
    themselves are slack.

    Parameters
    ----------
    part
        The name of the part, which must have fibers.
    value
        The strain, above −1: ``"-20 %"`` is a fifth shorter.

    Examples
    --------
    >>> FiberStrain(part="wall", value="-20 %").stretch
    0.8
    """

    kind: Literal["fiber-strain"] = "fiber-strain"
    of_fibers: ClassVar[bool] = True

    @property
    def stretch(self) -> float:
        """How many times as long the fibers are when they are free of stress."""
        return 1.0 + self.value


AnyActivation = Annotated[Strain | Swelling | Thermal | FiberStrain, Discriminator("kind")]
