"""Metrics that a user adds by a decorator; worker processes know them by their module."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterable
from contextlib import suppress
from functools import wraps
from importlib import import_module
from inspect import Parameter, signature
from numbers import Real
from typing import Any, Final, NamedTuple, get_args

import numpy as np

from voxsoft.errors import DesignError, SimulationError, VoxSoftError
from voxsoft.metrics.definition import Floats, Metric, Option, SlopeState, State, Target
from voxsoft.metrics.registry import BUILT_IN, METRICS, register
from voxsoft.records import closest
from voxsoft.records.names import check_name
from voxsoft.units import KINDS

#: Function from a state, and the target where the metric has options, to a number.
Value = Callable[..., float]
Slope = Callable[..., Floats]

_OPTIONS: Final[tuple[Option, ...]] = get_args(Option)


class OwnMetric(NamedTuple):
    """A metric of a user's by name, and the module whose import registers it."""

    name: str
    module: str


def metric(
    *,
    name: str | None = None,
    kind: str = "number",
    needs: Collection[Option] = (),
    takes: Collection[Option] = (),
    slope: Slope | None = None,
) -> Callable[[Value], Metric]:
    """Make a metric of a function, for objectives, constraints and results.

    Parameters
    ----------
    name
        Name in designs; default: the name of the function.
    kind
        The kind of quantity, a key of :data:`voxsoft.units.KINDS`: ``"length"``, ``"force"``,
        ``"angle"``, ...; default: a number without a unit.
    needs, takes
        Keys of a target that are required or optional: ``"probe"``, ``"base"``, ``"axis"``,
        ``"cavity"``, ``"percentile"``, ``"object"``, ``"tendon"``, ``"clamp"``, ``"region"``,
        ``"about"``. A function of such a metric takes a second argument, the objective or
        constraint that asks.
    slope
        Function of the same arguments that returns the derivative of the value by the positions of
        all vertices, (n, 3), for ``gradient`` and ``Study.optimize("gradient", ...)``; default:
        none.

    Returns
    -------
    Callable
        The decorator. Its function takes a :class:`~voxsoft.metrics.State`, such as a
        :class:`~voxsoft.Result`, and returns one number in SI units. The decorator
        returns the :class:`~voxsoft.metrics.Metric`.

    Raises
    ------
    DesignError
        A name that is taken by another metric, an unknown kind or option, or a function that
        takes other arguments. The same function may be registered again, as when a cell of a
        notebook runs twice.

    Notes
    -----
    Worker processes of a study import the module of the function. At the top of a script or of a
    module this just works; a metric that is typed into a session is known to threads alone.

    Examples
    --------
    >>> import voxsoft as vs
    >>> @vs.metric(kind="length", needs={"probe"})
    ... def highest(state, target):
    ...     return state.positions[state.places[target.probe].vertices, 2].max()
    >>> from voxsoft.design import families
    >>> result = vs.simulate(families.cylinder(radius="20 mm", height="30 mm"))
    >>> result.metric("highest", probe="top") > 0.03
    True
    """
    where = "metric" if name is None else f"metric {name}"
    if kind not in KINDS:
        raise DesignError(where, f'"{kind}" is not a kind of quantity', closest(kind, KINDS))
    for option in (*needs, *takes):
        if option not in _OPTIONS:
            raise DesignError(where, f'"{option}" is not an option', closest(option, _OPTIONS))
    options = frozenset(needs), frozenset(takes)

    def registered(function: Value) -> Metric:
        named = function.__name__ if name is None else check_name(name)
        asked = bool(needs or takes)
        value = _checked(named, function, asked)
        derivative = None if slope is None else _checked_slope(named, slope, asked)
        made = Metric(named, kind, value, derivative, *options, home=_home(function))
        register(made)
        return made

    return registered


def own_metrics(targets: Iterable[Target]) -> tuple[OwnMetric, ...]:
    """List the user's own metrics among those of some targets, each once."""
    names = dict.fromkeys(target.metric for target in targets)
    own = [METRICS[name] for name in names if name in METRICS and name not in BUILT_IN]
    return tuple(OwnMetric(each.name, each.home.partition(":")[0]) for each in own)


def missing_metrics(wanted: Iterable[OwnMetric]) -> tuple[str, ...]:
    """Import the modules that register metrics, and return the names that stay unknown."""
    missing = []
    for name, module in wanted:
        # A worker has run its own copy of a script as it started, if there is a file to run.
        if name not in METRICS and module not in sys.modules:
            with suppress(ImportError):
                import_module(module)
        if name not in METRICS:
            missing.append(name)
    return tuple(missing)


def _home(function: Value) -> str:
    """Return module and name of a function; a worker's copy of a script counts as the script."""
    module = function.__module__
    return f"{'__main__' if module == '__mp_main__' else module}:{function.__qualname__}"


def _checked(name: str, function: Value, asked: bool) -> Callable[[State, Target], float]:
    """Wrap a function with checks: it takes the right arguments and returns one number."""
    _check_arguments(name, function, asked)

    @wraps(function)
    def value(state: State, target: Target) -> float:
        found = _called(name, function, state, target, asked)
        if isinstance(found, np.ndarray) and found.ndim == 0:
            found = found[()]
        if not isinstance(found, Real):
            what = f"returned {_shown(found)}; expected one number in SI units"
            raise SimulationError(f"metric {name}", what)
        return float(found)

    return value


def _checked_slope(name: str, slope: Slope, asked: bool) -> Callable[[SlopeState, Target], Floats]:
    where = f"slope of {name}"
    _check_arguments(where, slope, asked)

    @wraps(slope)
    def checked(state: SlopeState, target: Target) -> Floats:
        found = np.asarray(_called(where, slope, state, target, asked), dtype=np.float64)
        if found.shape != state.positions.shape:
            what = f"has the shape {found.shape}; expected {state.positions.shape}"
            raise SimulationError(f"metric {where}", what, "return one row for each vertex")
        return found

    return checked


def _called(
    name: str, function: Callable[..., Any], state: State, target: Target, asked: bool
) -> Any:  # noqa: ANN401 - checked by who calls
    try:
        return function(state, target) if asked else function(state)
    except VoxSoftError:
        raise
    except Exception as error:
        what = f"failed: {type(error).__name__}: {error}"
        raise SimulationError(
            f"metric {name}", what, "fix the function that computes it"
        ) from error


def _check_arguments(name: str, function: Callable[..., Any], asked: bool) -> None:
    positional = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
    due = ("state", "target") if asked else ("state",)
    parameters = signature(function).parameters.values()
    needed = [each for each in parameters if each.default is Parameter.empty]
    if len(needed) != len(due) or any(each.kind not in positional for each in needed):
        came = ", ".join(each.name for each in needed) or "nothing"
        what = f"takes {came}; expected {' and '.join(due)}"
        hint = "only a metric with needs or takes gets the target that asks"
        raise DesignError(f"metric {name}", what, hint)


def _shown(found: object) -> str:
    return f"an array of the shape {found.shape}" if isinstance(found, np.ndarray) else repr(found)
