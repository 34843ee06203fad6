"""Search space of a study: a range or a list of choices for each parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self

from pydantic import Field, model_validator

from voxsoft.design import Design, Parameter
from voxsoft.errors import StudyError, VoxSoftError
from voxsoft.records import Record, closest, plain_values
from voxsoft.units import format_quantity, is_pint, parse_any, quantity_of, round_significant

if TYPE_CHECKING:
    from optuna.distributions import BaseDistribution

Choice = bool | int | float | str


class Range(Record):
    """All numbers from `low` to `high`, or every `step` of them.

    Parameters
    ----------
    low, high
        The ends, both included, in SI units. Two whole numbers make a range of whole numbers.
    step
        The spacing of the values tried; default: any value, and 1 for whole numbers.
    log
        True to search uniformly in the logarithm; not together with a step.

    Examples
    --------
    >>> Range(low=0.005, high=0.025, step=0.005).distribution
    FloatDistribution(high=0.025, log=False, low=0.005, step=0.005)
    """

    error_type: ClassVar[type[VoxSoftError]] = StudyError

    low: int | float
    high: int | float
    step: int | float | None = None
    log: bool = False

    @model_validator(mode="after")
    def _check(self) -> Self:
        if not self.low < self.high:
            raise StudyError("", f"runs from {self.low:g} to {self.high:g}; expected low < high")
        # 15 mm - 10 mm is less than 5 mm in the last digit.
        room = round_significant(self.high - self.low)
        if self.step is not None and not 0 < self.step <= room:
            what = f"{self.step:g} does not fit between {self.low:g} and {self.high:g}"
            raise StudyError("step", what, "give a positive step smaller than the range")
        if self.log and self.low <= 0:
            raise StudyError("low", f"is {self.low:g}; a logarithmic range starts above zero")
        if self.log and self.step is not None:
            raise StudyError("step", "cannot be kept on a logarithmic range", "drop step or log")
        return self

    @property
    def distribution(self) -> BaseDistribution:
        """Optuna's distribution of the range."""
        from optuna.distributions import FloatDistribution, IntDistribution  # slow to load

        if isinstance(self.low, int) and isinstance(self.high, int) and _whole(self.step):
            return IntDistribution(self.low, self.high, log=self.log, step=int(self.step or 1))
        if self.step is None:
            return FloatDistribution(float(self.low), float(self.high), log=self.log)
        # Optuna shortens a range that is no multiple of its step, with a warning: done here
        # instead.
        count = int((self.high - self.low) / self.step * (1 + 1e-9))
        last = round_significant(self.low + count * self.step)
        return FloatDistribution(float(self.low), last, step=float(self.step))


class Choices(Record):
    """A list of values to choose from: numbers, texts, true and false.

    Examples
    --------
    >>> Choices(values=["ecoflex-00-30", "ecoflex-00-50"]).distribution
    CategoricalDistribution(choices=('ecoflex-00-30', 'ecoflex-00-50'))
    """

    error_type: ClassVar[type[VoxSoftError]] = StudyError

    values: tuple[Choice, ...] = Field(min_length=1)

    @property
    def distribution(self) -> BaseDistribution:
        """Optuna's distribution of the choices."""
        from optuna.distributions import CategoricalDistribution  # slow to load

        return CategoricalDistribution(self.values)


#: Domain of one parameter.
Domain = Range | Choices

#: Domain of each parameter, by name.
Space = Mapping[str, Domain]


def space_of(design: Design) -> dict[str, Domain]:
    """Read the search space of a parametric design: every parameter with a min and a max.

    Raises
    ------
    StudyError
        No parameter has both.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> sorted(space_of(families.cylinder()))
    ['height', 'radius', 'wall']
    """
    space: dict[str, Domain] = {
        name: Range(low=parameter.min, high=parameter.max, step=parameter.step)
        for name, parameter in design.parameters.items()
        if parameter.min is not None and parameter.max is not None and parameter.min < parameter.max
    }
    if not space:
        raise StudyError(
            "space",
            "is empty: no parameter of the design has both a min and a max",
            'write wall = { value = "5 mm", min = "5 mm", max = "15 mm" }, or pass a space',
        )
    return space


def read_space(given: Mapping[str, object], design: Design | None) -> dict[str, Domain]:
    """Read a search space in the form that users type.

    Parameters
    ----------
    given
        Domain by name: a :class:`Range` or :class:`Choices`; a tuple ``(low, high)``,
        ``(low, high, step)`` or ``(low, high, "log")``; or a list or array of choices. Numbers are
        SI; texts such as ``"5 mm"`` carry their unit.
    design
        The parametric design, whose parameters are then the only names allowed.

    Raises
    ------
    StudyError
        An empty space, an unknown name, or a range that cannot be read or leaves the bounds of
        its parameter.

    Examples
    --------
    >>> read_space({"wall": ("5 mm", "15 mm", "5 mm"), "cells": [2, 4]}, None)["wall"].high
    0.015
    """
    if not given:
        raise StudyError("space", "is empty", 'write {"wall": (0.005, 0.015, 0.005)}')
    return {name: _read_domain(name, value, design) for name, value in given.items()}


def _read_domain(name: str, given: object, design: Design | None) -> Domain:
    where = f"space.{name}"
    parameter = None
    if design is not None:
        if name not in design.parameters:
            raise StudyError(
                where, "is not a parameter of the design", closest(name, design.parameters)
            )
        parameter = design.parameters[name]
    try:
        domain = _read(given, parameter)
    except VoxSoftError as error:
        inner = ".".join(part for part in (where, error.where) if part)
        raise StudyError(inner, error.what, error.hint) from None
    if parameter is not None:
        _check_bounds(where, domain, parameter)
    return domain


def _read(given: object, parameter: Parameter | None) -> Domain:
    if isinstance(given, Range | Choices):
        return given
    given = plain_values(given)
    if isinstance(given, list):
        # Without a parameter a text may be anything, "00-50" a material: it stays as it is.
        values = given if parameter is None else [_number(value, parameter) for value in given]
        return Choices(values=tuple(values))
    if not isinstance(given, tuple) or len(given) not in (2, 3):
        raise StudyError(
            "",
            f"{given!r} is no range",
            'write (low, high), (low, high, step), (low, high, "log"), or a list of choices',
        )
    log = given[2:] == ("log",)
    ends = [_number(value, parameter) for value in (given[:2] if log else given)]
    return Range(low=ends[0], high=ends[1], step=None if len(ends) == 2 else ends[2], log=log)


def _number(value: Any, parameter: Parameter | None) -> Any:  # noqa: ANN401 - the models check it
    """Convert a text with a unit, or a quantity of pint, to SI; leave other values alone."""
    if not isinstance(value, str) and not is_pint(value):
        return value
    quantity = quantity_of(value, "") if is_pint(value) else parse_any(value, where="")
    if parameter is not None and quantity.dimension != parameter.dimension:
        raise StudyError("", f'"{value}" has another unit than the parameter, a {parameter.kind}')
    return quantity.value


def _check_bounds(where: str, domain: Domain, parameter: Parameter) -> None:
    values: Sequence[Any] = (
        domain.values if isinstance(domain, Choices) else (domain.low, domain.high)
    )
    for value in values:
        if not isinstance(value, int | float):
            raise StudyError(where, f"{value!r} is no value of a {parameter.kind}")
        slack = 1e-9 * abs(value)
        below = parameter.min is not None and value < parameter.min - slack
        if below or (parameter.max is not None and value > parameter.max + slack):
            raise StudyError(
                where,
                f"{format_quantity(value, parameter.kind)} is outside the bounds of the parameter",
                "narrow the range, or widen min and max in the design",
            )


def _whole(step: float | None) -> bool:
    return step is None or isinstance(step, int)
