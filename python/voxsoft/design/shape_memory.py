"""A part that recovers a strain when it is warm, and remembers how warm it was."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal, NamedTuple, Self

from pydantic import Field, model_validator

from voxsoft.design.growth import Activation, Growth
from voxsoft.design.history import History
from voxsoft.errors import DesignError
from voxsoft.units import Dimensionless, PositiveTemperature

#: A part of a whole.
Part = Annotated[float, Field(ge=0, le=1)]


class ShapeMemory(Activation):
    """A part that recovers a strain when it is heated, and loses it again when it is cooled.

    A share ``s`` of it is transformed: none of it cold, all of it warm. At a temperature ``T`` it
    becomes ``min(max(s, h(T)), c(T))``, where ``h`` rises from 0 to 1 over `heating` and ``c``
    falls from 1 to 0 over `cooling`, both linear. That is a play operator between the two branches:
    minor loops run level from one to the other.

    Parameters
    ----------
    part
        The name of the part.
    value
        Its temperature in kelvin.
    strain
        Strain when all of it is transformed, above −1: ``"-4 %"`` shortens.
    heating
        The temperatures in kelvin between which it transforms when it is heated.
    cooling
        Those between which it goes back when it is cooled: the higher one first, neither above
        those of `heating`.
    fibers
        True if the fibers of the part are longer, and not all of it. Default: all of it,
        along every axis.
    transformed
        Part of it that is transformed before it takes the temperature `value`, or that of the
        beginning of its history; default 0, cold.
    reference
        The temperature in kelvin that the factor 0 of a history stands for, as 1 does for `value`;
        default 293.15 K.
    history
        The temperature over time. Default: it is `value`.

    Examples
    --------
    >>> wire = ShapeMemory(
    ...     part="wire",
    ...     value="345 K",
    ...     strain="-4 %",
    ...     heating=("340 K", "350 K"),
    ...     cooling=("330 K", "320 K"),
    ... )
    >>> wire.stretch, wire.replace(value="335 K", transformed=0.5).stretch
    (0.98, 0.98)
    >>> round(wire.replace(value="322 K", transformed=0.5).stretch, 6)
    0.992
    """

    kind: Literal["shape-memory"] = "shape-memory"
    value: PositiveTemperature
    strain: Dimensionless
    heating: tuple[PositiveTemperature, PositiveTemperature]
    cooling: tuple[PositiveTemperature, PositiveTemperature]
    fibers: bool = False
    transformed: Part = 0.0
    reference: PositiveTemperature = 293.15

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.strain <= -1.0:
            what = f"is {self.strain:g}: nothing would be left"
            raise DesignError("strain", what, "give more than -1")
        (start, finish), (down, cold) = self.heating, self.cooling
        if start >= finish:
            what = f"does not rise: from {start:g} K to {finish:g} K"
            raise DesignError("heating", what, "give the lower temperature first")
        if down <= cold:
            what = f"does not fall: from {down:g} K to {cold:g} K"
            raise DesignError("cooling", what, "give the higher temperature first")
        if cold > start or down > finish:
            what = (
                f"from {down:g} K to {cold:g} K crosses the branch of heating, from {start:g} K "
                f"to {finish:g} K"
            )
            hint = "it starts at most where heating finishes, and finishes where that starts"
            raise DesignError("cooling", what, hint)
        for factor in self.history.factors if self.history else ():
            if self.temperature(factor) <= 0.0:
                what = f"has the factor {factor:g}: that is {self.temperature(factor):g} K"
                hint = "0 is the reference temperature, and 1 that of the value"
                raise DesignError("history", what, hint)
        return self

    @property
    def of_fibers(self) -> bool:
        """True if only the fibers of the part are longer, and not the material around them."""
        return self.fibers

    @property
    def growth(self) -> Growth:
        """Ratio by which it is longer over time, exact between the instants."""
        states = self._states()
        bases = tuple(1.0 + self.strain * state.share for state in states)
        return Growth(tuple(state.time for state in states), bases, 1.0)

    def share(self, part: float) -> Activation:
        """A part of the strain that it comes to in the end, without a history."""
        return self.replace(
            strain=part * self.strain,
            value=self.temperature(self.factor),
            transformed=self._states()[-1].share,
            history=None,
        )

    def at(self, time: float) -> Self:
        """Constant activation with the value of a time in s, and the part transformed by then."""
        if self.history is None:
            return self
        states = self._states()
        after = next((i for i, state in enumerate(states) if state.time > time), len(states))
        share = states[max(after - 1, 0)].share
        if 0 < after < len(states):
            low, high = states[after - 1 : after + 1]
            share += (high.share - low.share) * (time - low.time) / (high.time - low.time)
        held = History(time=(0.0,), factor=(self.history.at(time),))
        return self.replace(transformed=_part(share), history=held)

    def after(self, before: ShapeMemory) -> Self:
        """Go on from the final state of another."""
        return self.replace(transformed=_part(before._states()[-1].share))

    def temperature(self, factor: float) -> float:
        """Temperature in kelvin at a factor of its history."""
        return self.reference + factor * (self.value - self.reference)

    def transformed_at(self, share: float, temperature: float) -> float:
        """Part that is transformed at a temperature in kelvin, by that before: a play operator."""
        (start, finish), (down, cold) = self.heating, self.cooling
        heated = (temperature - start) / (finish - start)
        cooled = (temperature - cold) / (down - cold)
        return min(max(share, min(heated, 1.0)), max(cooled, 0.0))

    def _states(self) -> list[_State]:
        """Transformed parts at all instants between which they are linear in time."""
        if self.history is None:
            return [_State(0.0, self.transformed_at(self.transformed, self.value))]
        temperatures = [self.temperature(factor) for factor in self.history.factors]
        times = self.history.times
        found = [_State(times[0], self.transformed_at(self.transformed, temperatures[0]))]
        for (begun, ended), (low, high) in zip(
            pairwise(times), pairwise(temperatures), strict=True
        ):
            share = found[-1].share
            for corner in self._corners(share, rising=high > low):
                if min(low, high) < corner < max(low, high):
                    instant = begun + (ended - begun) * (corner - low) / (high - low)
                    if found[-1].time < instant < ended:
                        found.append(_State(instant, self.transformed_at(share, corner)))
            found.append(_State(ended, self.transformed_at(share, high)))
        return found

    def _corners(self, share: float, *, rising: bool) -> tuple[float, float]:
        """Temperatures where the path meets its branch, and where it leaves it."""
        (start, finish), (down, cold) = self.heating, self.cooling
        if rising:
            return start + share * (finish - start), finish
        return cold + share * (down - cold), cold


class _State(NamedTuple):
    """Transformed part at an instant in s."""

    time: float
    share: float


def _part(share: float) -> float:
    """Without the rounding that leads out of 0 to 1."""
    return min(max(share, 0.0), 1.0)
