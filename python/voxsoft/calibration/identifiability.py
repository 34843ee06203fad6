"""Identifiability of a parameter from the data: its profile and its likelihood interval."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.misfit import Evaluation, Misfit
from voxsoft.calibration.refinement import minimized
from voxsoft.units import format_quantity

#: Largest ratio of the ends of an interval for its parameter to count as identifiable.
WIDEST: Final = 3.0

# 95 % quantile of the chi-square distribution with one degree of freedom.
_THRESHOLD: Final = 3.841458820694124

# First step away from the optimum in natural logarithms; each further step is twice as long.
_FIRST_STEP: Final = 0.05
# Tolerance of an interval's end, as a part of the threshold, and most cuts to find it.
_END_FOUND: Final = 0.02
_MOST_CUTS: Final = 5
# Inner minimum: first step and size of the last simplex, in natural logarithms. The error is
# flat there, so that half a percent off changes it by parts in 10⁵.
_INNER_STEP: Final = 0.1
_INNER_FOUND: Final = 5e-3


@dataclass(frozen=True)
class Profile:
    r"""Profile likelihood of one parameter.

    The error is minimized over all other parameters, scales included, for values of this parameter
    away from its best. With an error vector of :math:`d` numbers at each of :math:`n` stations
    and the probability density of an error falling as :math:`b^{-d} e^{-|r|/b}`, the likelihood
    that belongs to a sum of lengths, the noise :math:`b` estimated from the residuals
    themselves, and :math:`J` the mean length, twice the logarithm of the likelihood ratio is

    .. math:: \Lambda = 2 n d \ln(J / J_{min}),

    and the 95 % interval is where :math:`\Lambda \le 3.84` (Wilks 1938,
    doi:10.1214/aoms/1177732360; Raue et al. 2009, doi:10.1093/bioinformatics/btp358).

    Attributes
    ----------
    name, best
        Name of the parameter and its best value, SI.
    low, high
        Ends of the 95 % interval, SI; None where the interval reaches the end of the search range.
    values, errors
        The profile: values in SI, rising, and the smallest mean error at each in m, (k,).
    kind
        Kind of quantity of the parameter.
    identifiable
        True if the interval ends on both sides within the range, and its ends are less than a
        factor of 3 apart.

    Notes
    -----
    Residuals of a model that does not fit are no independent noise: neighboring stations err
    alike, so that true intervals are wider. The converse is safe: a parameter that is not
    identifiable here is not identifiable.

    Measured loads (:attr:`Measurement.changes`) have errors of their own, each of which
    moves all numbers of its experiment together. Of more such experiments than parameters the
    interval holds also that of :func:`spread_of_experiments`.
    """

    name: str
    best: float
    low: float | None
    high: float | None
    values: NDArray[np.float64]
    errors: NDArray[np.float64]
    kind: str = "modulus"

    @property
    def identifiable(self) -> bool:
        """True if the data determine this parameter."""
        return self.low is not None and self.high is not None and self.high < WIDEST * self.low

    @property
    def sentence(self) -> str:
        """Interval of the parameter in words."""
        digits = 3
        if self.low is not None and self.high is not None:
            # Enough to tell the two ends apart.
            digits = next(
                (n for n in range(3, 7) if self._shown(self.low, n) != self._shown(self.high, n)), 7
            )
        low, high = (
            None if end is None else self._shown(end, digits) for end in (self.low, self.high)
        )
        if low and high:
            within = f"between {low} and {high} (95 %)"
            return within if self.identifiable else f"{within}: too wide to count as identified"
        if high:
            return f"only bounded from above, by {high} (95 %)"
        if low:
            return f"only bounded from below, by {low} (95 %)"
        return "not identifiable: the data fit as well anywhere in the range"

    def _shown(self, value: float, digits: int) -> str:
        return format_quantity(float(f"{value:.{digits}g}"), self.kind)


def profiles(misfit: Misfit, best: Evaluation) -> tuple[Profile, ...]:
    """Profile every parameter of a calibration.

    Parameters
    ----------
    misfit
        Function that was minimized.
    best
        Minimum of the function.
    """
    sides = [(index, side) for index in range(len(misfit.space)) for side in (-1, 1)]
    walked = misfit.side_by_side(lambda way: _Walk(misfit, best, *way).run(), sides)
    found = [
        _joined(misfit, best, index, walked[2 * index], walked[2 * index + 1])
        for index in range(len(misfit.space))
    ]
    loaded = all(experiment.measurement.changes for experiment in misfit.experiments)
    if not loaded or misfit.free_scale or len(misfit.experiments) <= len(misfit.space):
        return tuple(found)
    linear = misfit.linearized(best.genes)
    if isinstance(linear, str):
        return tuple(found)
    residuals = [(each.simulated - each.measured).ravel() for each in linear.deviations]
    slopes = [each.reshape(-1, len(misfit.space)) for each in linear.slopes]
    widths = spread_of_experiments(residuals, slopes)
    return tuple(_widened(each, float(w)) for each, w in zip(found, widths, strict=True))


def spread_of_experiments(
    residuals: Sequence[NDArray[np.float64]], slopes: Sequence[NDArray[np.float64]]
) -> NDArray[np.float64]:
    r"""Return half of the 95 % intervals of parameters by the scatter of experiments, (k,).

    It is the cluster-robust interval of least squares (Liang and Zeger 1986,
    doi:10.1093/biomet/73.1.13), with residuals :math:`r_g` and slopes :math:`J_g` of experiment
    g, any of whose residuals may follow one another:

    .. math:: V = A^{-1} \Big(\sum_g J_g^T r_g r_g^T J_g\Big) A^{-1} \frac{G}{G - k},
        \quad A = \sum_g J_g^T J_g,

    times the quantile of Student's distribution with :math:`G - k` degrees of freedom.

    Parameters
    ----------
    residuals
        Residuals of each of G experiments, (n,).
    slopes
        Their derivatives by k parameters, (n, k); k is less than G.

    Examples
    --------
    >>> rows = [np.ones((4, 1))] * 3
    >>> apart = spread_of_experiments([np.full(4, r) for r in (-1.0, 0.0, 1.0)], rows)
    >>> round(float(apart[0] / np.sqrt(1.0 / 3.0)), 3)  # the t of three numbers with variance 1
    4.303
    """
    from scipy.special import stdtrit

    count, size = len(residuals), slopes[0].shape[1]
    within = sum(jacobian.T @ jacobian for jacobian in slopes)
    pulls = [j.T @ r for j, r in zip(slopes, residuals, strict=True)]
    between = sum(np.outer(pull, pull) for pull in pulls)
    inverse = np.linalg.pinv(np.asarray(within))
    variance = np.diag(inverse @ np.asarray(between) @ inverse) * count / (count - size)
    reach = float(stdtrit(count - size, 0.975))
    half: NDArray[np.float64] = reach * np.sqrt(np.maximum(variance, 0.0))
    return half


def _widened(profile: Profile, half: float) -> Profile:
    """Return a profile whose interval holds one of half a width in natural logarithms."""
    low, high = (float(profile.best * np.exp(sign * half)) for sign in (-1.0, 1.0))
    return replace(
        profile,
        low=None if profile.low is None else min(profile.low, low),
        high=None if profile.high is None else max(profile.high, high),
    )


@dataclass(frozen=True)
class _Point:
    log: float
    genes: NDArray[np.float64]
    error: float


@dataclass(frozen=True)
class _Walked:
    points: list[_Point]
    end: float | None


class _Walk:
    """Walk from the optimum along one parameter, in one direction, to the end of its interval."""

    def __init__(self, misfit: Misfit, best: Evaluation, index: int, side: int) -> None:
        self.misfit, self.best, self.index, self.side = misfit, best, index, side
        self.spans = misfit.space.spans()

    def run(self) -> _Walked:
        genes = np.array(self.best.genes)
        start = _Point(float(genes[self.index] * self.spans[self.index]), genes, self.best.error)
        points = [start]
        for log in self._steps(start.log):
            points.append(self._at(log, points[-1].genes))
            if self._excess(points[-1]) > 0:
                end = self._cut(points[-2], points[-1], points)
                return _Walked(points, end)
        return _Walked(points, None)

    def _steps(self, log: float) -> Iterator[float]:
        bound = 0.0 if self.side < 0 else float(self.spans[self.index])
        step = _FIRST_STEP
        while log != bound:
            log += self.side * step
            step *= 2
            # A last step shorter than the first is left out.
            if self.side * (bound - log) < _FIRST_STEP:
                log = bound
            yield log

    def _cut(self, inside: _Point, outside: _Point, points: list[_Point]) -> float:
        """Find the point at which the statistic crosses its threshold.

        Its root is nearly linear in the parameter, so that a cut by proportion lands close.
        """
        for _ in range(_MOST_CUTS):
            a, b = (np.sqrt(max(self._statistic(p), 0.0)) for p in (inside, outside))
            share = float(np.clip((np.sqrt(_THRESHOLD) - a) / (b - a), 0.1, 0.9))
            middle = self._at(inside.log + share * (outside.log - inside.log), inside.genes)
            points.append(middle)
            if abs(self._excess(middle)) < _END_FOUND * _THRESHOLD:
                break
            inside, outside = (inside, middle) if self._excess(middle) > 0 else (middle, outside)
        return middle.log

    def _at(self, log: float, nearby: NDArray[np.float64]) -> _Point:
        """Minimize over all other parameters at a fixed value of this one."""
        held = float(np.clip(log / self.spans[self.index], 0.0, 1.0))
        others = np.delete(np.arange(len(self.spans)), self.index)

        def genes_with(free: NDArray[np.float64]) -> NDArray[np.float64]:
            genes = np.full(len(self.spans), held)
            genes[others] = free
            return genes

        found = nearby[others]
        if others.size:
            found = minimized(
                lambda free: self.misfit.at(genes_with(free)).error,
                nearby[others],
                self.spans[others],
                first_step=_INNER_STEP,
                converged=_INNER_FOUND,
            )
        genes = genes_with(found)
        return _Point(log, genes, self.misfit.at(genes).error)

    def _statistic(self, point: _Point) -> float:
        # A fit without residuals leaves no noise to estimate: 1 nm is the least.
        floor = max(self.best.error, 1e-9)
        error = min(max(point.error, floor), 1e3)
        return float(2.0 * self.misfit.numbers * np.log(error / floor))

    def _excess(self, point: _Point) -> float:
        return self._statistic(point) - _THRESHOLD


def _joined(misfit: Misfit, best: Evaluation, index: int, down: _Walked, up: _Walked) -> Profile:
    low = misfit.space.low[index]
    points = sorted([*down.points, *up.points[1:]], key=lambda point: point.log)
    return Profile(
        name=misfit.space.names[index],
        best=float(misfit.space.values(best.genes)[index]),
        low=None if down.end is None else float(low * np.exp(down.end)),
        high=None if up.end is None else float(low * np.exp(up.end)),
        values=np.array([low * np.exp(point.log) for point in points]),
        errors=np.array([point.error for point in points]),
        kind=misfit.space.kinds[misfit.space.names[index]],
    )
