"""Activations that make a part longer or shorter by itself: swelling, heat, muscles."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Discriminator, model_validator

from voxsoft.design.dielectric import Dielectric
from voxsoft.design.growth import Activation, Growth
from voxsoft.design.profile import Profile
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.errors import DesignError
from voxsoft.units import Dimensionless, PositiveTemperature, ThermalExpansion


class _OfItsValue(Activation):
    """An activation whose size follows the factor of its history at once."""

    #: 1 where the value is a change of length, 1/3 where it is one of volume.
    power: ClassVar[float] = 1.0

    profile: Profile | None = None

    @abstractmethod
    def base(self, factor: float) -> float:
        """Ratio by which the part is longer, or larger, at a factor of its history."""

    @abstractmethod
    def base_at(self, value: float) -> float:
        """Ratio by which the part is longer, or larger, at another value."""

    @property
    def growth(self) -> Growth:
        """Ratio by which the part is longer over time when it is free of stress."""
        if self.history is None:
            return Growth((0.0,), (self.base(1.0),), self.power, self.profile)
        bases = tuple(self.base(factor) for factor in self.history.factors)
        return Growth(self.history.times, bases, self.power, self.profile)


class _Growing(_OfItsValue):
    """An activation whose value is a change of size."""

    value: Dimensionless

    @model_validator(mode="after")
    def _leaves_something(self) -> Self:
        if self.value <= -1.0:
            what = f"is {self.value:g}: nothing would be left"
            raise DesignError("value", what, "give more than -1")
        for factor in self.history.factors if self.history else ():
            if self.base(factor) <= 0.0:
                what = f"has the factor {factor:g}: nothing would be left of {self.value:g} of it"
                raise DesignError("history", what, "give factors that leave more than -1")
        return self

    def base(self, factor: float) -> float:
        """Ratio by which the part is longer, or larger, at a factor of its history."""
        return 1.0 + factor * self.value

    def base_at(self, value: float) -> float:
        """Ratio by which the part is longer, or larger, at another value."""
        return 1.0 + value

    def share(self, part: float) -> Self:
        """Scale its final strain by a factor, without a history."""
        return self.replace(value=part * self.factor * self.value, history=None)


class Strain(_Growing):
    """A part that is so much longer along every axis when it is free of stress.

    Parameters
    ----------
    part
        The name of the part.
    value
        The strain, above −1: ``"2 %"`` is 1.02 times as long, a negative one shrinks.
    history
        A factor on the value over time. Default: the value is there from the beginning.
    profile
        A factor on the value from place to place. Default: it is the same
        everywhere.

    Examples
    --------
    >>> Strain(part="upper", value="2 %").stretch
    1.02
    """

    kind: Literal["strain"] = "strain"


class Swelling(_Growing):
    """A part whose volume is so much larger when it is free of stress.

    Parameters
    ----------
    part
        The name of the part.
    value
        The change of its volume, above −1: ``"20 %"`` of a gel that takes up a fifth of its volume
        of water. The mass stays that of the dry part.
    history
        A factor on the value over time. Default: the value is there from the beginning.
    profile
        A factor on the value from place to place. Default: it is the same
        everywhere.

    Examples
    --------
    >>> round(Swelling(part="gel", value="20 %").stretch, 4)
    1.0627
    """

    kind: Literal["swelling"] = "swelling"
    power: ClassVar[float] = 1.0 / 3.0


class Thermal(_OfItsValue):
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
    history
        The temperature over time: 0 is the reference, 1 the value. Default: it is the
        value from the beginning.
    profile
        The temperature from place to place: 0 is the reference, 1 the value. Default: the same
        everywhere.

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
        for factor in (1.0, *(self.history.factors if self.history else ())):
            if self.temperature(factor) <= 0.0:
                what = f"has the factor {factor:g}: that is {self.temperature(factor):g} K"
                hint = "0 is the reference temperature, and 1 that of the value"
                raise DesignError("history", what, hint)
            if self.base(factor) <= 0.0:
                way = factor * (self.value - self.reference)
                what = f"{self.expansion:g} 1/K over {way:g} K leaves nothing"
                hint = "give the coefficient of linear expansion in 1/K"
                raise DesignError("expansion", what, hint)
        return self

    def temperature(self, factor: float) -> float:
        """Temperature in kelvin at a factor of its history."""
        return self.reference + factor * (self.value - self.reference)

    def base(self, factor: float) -> float:
        """Ratio by which the part is longer at a factor of its history."""
        return self.base_at(self.temperature(factor))

    def base_at(self, value: float) -> float:
        """Ratio by which the part is longer at another temperature in kelvin."""
        return 1.0 + self.expansion * (value - self.reference)

    def share(self, part: float) -> Self:
        """A part of the way from the reference to its last temperature, without a history."""
        return self.replace(value=self.temperature(part * self.factor), history=None)


class FiberStrain(_Growing):
    """A part whose fibers are so much longer along themselves when they are free of stress.

    The material around them is not, and holds against it: a negative strain is a muscle, a
    shape-memory wire or a drawn polymer thread in rubber. Without ``compression``
    fibers that are longer by themselves are slack.

    Parameters
    ----------
    part
        The name of the part, which must have fibers.
    value
        The strain, above −1: ``"-20 %"`` is a fifth shorter.
    history
        A factor on the value over time. Default: the value is there from the beginning.
    profile
        A factor on the value from place to place. Default: it is the same
        everywhere.

    Examples
    --------
    >>> FiberStrain(part="wall", value="-20 %").stretch
    0.8
    """

    kind: Literal["fiber-strain"] = "fiber-strain"

    @property
    def of_fibers(self) -> bool:
        """It is the fibers alone that are longer."""
        return True


AnyActivation = Annotated[
    Strain | Swelling | Thermal | FiberStrain | ShapeMemory | Dielectric, Discriminator("kind")
]
