"""Command at rest that gives a target, by the design's own gradient."""

from __future__ import annotations

from voxsoft.design import Design, require_design
from voxsoft.design.variation import number_of, with_number
from voxsoft.errors import SimulationError
from voxsoft.simulation import gradient, simulate
from voxsoft.simulation.setup.setup import Setup

#: Most solutions for one target: Newton's method on a monotone curve takes four or less.
_MOST = 20


class StaticInverse:
    """Value of a number of the design at which a metric at rest equals a target.

    Newton's method on the equilibria, with slopes of :func:`voxsoft.simulation.gradient`. Found
    values are remembered, and each search begins at the nearest of them: targets that change
    slowly take one or two solutions each. With it as feed-forward, the feedback of a
    :class:`PIDController` has the dynamics alone to correct.

    Parameters
    ----------
    design
        The design, with the number as a load: ``"loads.0.value"``.
    metric
        Name of an objective or constraint of the design, or of a metric that needs no choice.
    number
        Parameter or path of the number, as for :func:`voxsoft.simulation.gradient`.
    tolerance
        Allowed distance from the target, in units of the metric; default: 1e-4 of the target.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> cup = families.cylinder(radius="20 mm", height="30 mm")
    >>> import voxsoft as vs
    >>> inverse = StaticInverse(cup, "rise", "loads.0.value")
    >>> pressure = inverse(2e-4)
    >>> found = simulate(cup.replace(loads=[vs.Pressure(value=pressure)]))
    >>> round(1e6 * found.metrics["rise"])
    200
    """

    def __init__(
        self, design: Design, metric: str, number: str, *, tolerance: float | None = None
    ) -> None:
        self._design = require_design(design, "design").assembled
        self._metric, self._number, self._tolerance = metric, number, tolerance
        #: Value, metric and slope of the equilibria found so far.
        self._known: list[tuple[float, float, float]] = []

    def __call__(self, target: float) -> float:
        """Return the value for a target of the metric, SI units.

        Raises
        ------
        SimulationError
            No equilibrium with that metric was found.
        """
        near = 1e-4 * abs(target) if self._tolerance is None else self._tolerance
        if not self._known:
            self._solve(1e-3 * (number_of(self._design, self._number) or 1.0))
        part = 1.0
        for _ in range(_MOST):
            value, metric, slope = min(self._known, key=lambda each: abs(each[1] - target))
            if abs(metric - target) <= near:
                return value + (target - metric) / slope
            try:
                self._solve(self._next(target, part))
                part = 1.0
            except SimulationError:
                # A tangent that leads past a limit of the load: half the way.
                part *= 0.5
        what = f"{self._metric} = {target:g} was not reached by {self._number} in {_MOST} solutions"
        raise SimulationError("feed-forward", what, "give a target within the range at rest")

    def _next(self, target: float, part: float) -> float:
        """Return the value to solve for next.

        Follows the tangent at the nearest equilibrium, or `part` of its way; stays between two
        equilibria on both sides of the target.
        """
        sides = [[each for each in self._known if (each[1] > target) == above] for above in (0, 1)]
        ends = [min(side, key=lambda each: abs(each[1] - target)) for side in sides if side]
        ends.sort(key=lambda each: abs(each[1] - target))
        guesses = [value + (target - metric) / slope for value, metric, slope in ends]
        if len(ends) < 2:
            return ends[0][0] + part * (guesses[0] - ends[0][0])
        low, high = sorted(each[0] for each in ends)
        within = [each for each in guesses if low < each < high]
        return within[0] if within else 0.5 * (low + high)

    def _solve(self, value: float) -> None:
        varied = with_number(self._design, self._number, value)
        result = simulate(Setup.of(varied), method="statics")
        slope = gradient(result, self._metric, self._number)[self._metric][self._number]
        self._known.append((value, float(result.metrics[self._metric]), slope))
