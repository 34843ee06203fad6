r"""Discretization error from a few sizes of voxels (Richardson 1911; Roache 1994).

If a number converges as ``v(h) = v₀ + c h^p``, two sizes ``h₁ > h₂`` with a known order ``p``
give its limit and the error of the finer one, with ``r = h₁/h₂``::

    v(h₂) - v₀ = c h₂^p = (v₁ - v₂)/(r^p - 1)

Three sizes give the order too, from ``(v₁ - v₂)/(v₂ - v₃) = (h₁^p - h₂^p)/(h₂^p - h₃^p)``, whose
right side rises with ``p`` from ``ln(h₁/h₂)/ln(h₂/h₃)``.

The elements are of second order where the field is smooth. Edges of clamps and re-entrant edges,
of which voxels have many, lower the order to about 1: on ten varied bodies 0.9 to 1.6 was measured
(`tests/crosscheck/test_discretization_estimates.py`). So two sizes assume the order 1, and three
keep the observed order between 0.5 and 2.

Above 2 the elements cannot converge: where three sizes show more than 2.2, the change from the
coarsest was no part of a convergence yet, and the other two assume the order 1 as if alone. They
may agree by chance: that change itself, by the order 2, gives the least error.

An estimate is not a bound. It is multiplied by a safety factor, as in Roache's grid convergence
index (doi 10.1115/1.2910291). Two sizes do not show their order, and Roache takes 3 for them;
halved sizes then hold the error of any order from 0.42 on. A smaller factor of 1.25, which holds
orders from 0.85 on, was tried first and failed where the coarser size has one element through a
wall. Where three sizes show the order it is 2. Roache takes 1.25 there; where a second term of the
error is as large as the first at the coarsest, that holds three cases of four, and 2 holds 96 of
100 (the unit test of this module draws a thousand).

If both sizes hold the same body, and at least two voxels through each wall, two sizes are
*regular*: their error falls with an order of 0.5 or more, known or not. With the change
``d = v₂ - v₁`` the limit then is between ``v₂``, for a very high order, and ``v₂ + d/(r^0.5 - 1)``.
Two sizes cannot distinguish a value that nears its limit from one that has passed it, as terms of
the error cancel: the change itself is added on the near side. The middle of that range is the
limit, half its width the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from voxsoft.errors import SimulationError

#: Accepted range of the order of convergence.
LOWEST_ORDER, HIGHEST_ORDER = 0.5, 2.0
#: Assumed order where two sizes cannot show it.
USUAL_ORDER: Final = 1.0
#: An observed order is still that of the elements up to a tenth above theirs (Oberkampf and Roy,
#: Verification and Validation in Scientific Computing, 2010, section 8.6.3, give it that tenth).
NO_ORDER: Final = 1.1 * HIGHEST_ORDER
#: Safety factors for an observed order, for an assumed one, and on the larger change where
#: values go up and down, which they do about their limit.
SEEN: Final = 2.0
ASSUMED: Final = 3.0
SWINGING: Final = 1.25
#: Distance, in changes, by which a regular value may have passed its limit.
PASSED: Final = 1.0

#: Basis of an estimate.
Basis = Literal["three sizes", "two sizes", "regular sizes", "oscillating"]


@dataclass(frozen=True)
class Estimate:
    """Error estimate of a number from a few sizes.

    Attributes
    ----------
    sizes, values
        Falling sizes in m, and the number at each.
    order
        The order of convergence that was used.
    limit
        The number extrapolated to size zero; that of the finest size where values oscillate.
    error
        Estimated error of the value at the finest size, safety included.
    basis
        Basis of the estimate; ``two sizes`` also where a third shows no order, and ``regular
        sizes`` for two that were given as regular.
    """

    sizes: tuple[float, ...]
    values: tuple[float, ...]
    order: float
    limit: float
    error: float
    basis: Basis

    def error_at(self, index: int) -> float:
        """Estimate the error of the value at one of the sizes.

        Bounded, by the triangle inequality, by the distance to the finest value and that value's
        own error.
        """
        return abs(self.values[index] - self.values[-1]) + self.error


def discretization_error(
    sizes: Sequence[float], values: Sequence[float], *, regular: bool = False
) -> Estimate:
    """Estimate the discretization error of a number that is known at two or more sizes.

    Parameters
    ----------
    sizes
        Edges of voxels or bricks in m, falling; the last three are used.
    values
        The number at each of them.
    regular
        True if the two finest hold the same body with two voxels or more through each wall.

    Raises
    ------
    SimulationError
        Fewer than two sizes, or sizes that do not fall.

    Examples
    --------
    >>> exact = discretization_error([4.0, 2.0, 1.0], [1 + 16, 1 + 4, 1 + 1])
    >>> exact.order, exact.limit, exact.error
    (2.0, 1.0, 2.0)
    >>> discretization_error([2.0, 1.0], [1 + 2, 1 + 1]).error
    3.0
    >>> bar = discretization_error([2.0, 1.0], [1 + 2, 1 + 1], regular=True)
    >>> f"{bar.limit:.2f} +- {bar.error:.2f}"
    '1.29 +- 1.71'
    """
    sizes, values = tuple(map(float, sizes)), tuple(map(float, values))
    if len(sizes) < 2 or len(values) != len(sizes):
        raise SimulationError(
            "voxel_sizes", f"holds {len(sizes)} sizes", "give two or three, such as h and h/2"
        )
    if any(fine >= coarse for coarse, fine in pairwise(sizes)) or sizes[-1] <= 0:
        raise SimulationError("voxel_sizes", "do not fall", "name the coarsest first, each once")
    order = USUAL_ORDER
    basis: Basis = "two sizes"
    if len(sizes) > 2:
        before, after = values[-3] - values[-2], values[-2] - values[-1]
        if before * after < 0:
            return _oscillating(sizes, values, max(abs(before), abs(after)))
        seen = _order(sizes[-3:], before, after)
        if seen < NO_ORDER:
            order, basis = min(seen, HIGHEST_ORDER), "three sizes"
    least = 0.0
    if len(sizes) > 2 and basis == "two sizes":
        shrink = (sizes[-3] ** HIGHEST_ORDER - sizes[-2] ** HIGHEST_ORDER) / sizes[
            -1
        ] ** HIGHEST_ORDER
        least = SEEN * abs(values[-3] - values[-2]) / shrink
    if regular and basis == "two sizes":
        return _regular(sizes, values, least)
    step = (values[-1] - values[-2]) / ((sizes[-2] / sizes[-1]) ** order - 1.0)
    safety = SEEN if basis == "three sizes" else ASSUMED
    error = max(safety * abs(step), least)
    return Estimate(sizes, values, order, values[-1] + step, error, basis)


def _regular(sizes: tuple[float, ...], values: tuple[float, ...], least: float) -> Estimate:
    change = values[-1] - values[-2]
    farthest = 1.0 / ((sizes[-2] / sizes[-1]) ** LOWEST_ORDER - 1.0)
    limit = values[-1] + 0.5 * (farthest - PASSED) * change
    error = max(0.5 * (farthest + PASSED) * abs(change), least)
    return Estimate(sizes, values, USUAL_ORDER, limit, error, "regular sizes")


def _oscillating(sizes: tuple[float, ...], values: tuple[float, ...], largest: float) -> Estimate:
    error = SWINGING * largest / ((sizes[-2] / sizes[-1]) ** USUAL_ORDER - 1.0)
    return Estimate(sizes, values, USUAL_ORDER, values[-1], error, "oscillating")


def _order(sizes: tuple[float, ...], before: float, after: float) -> float:
    """Find the observed order, at least the lowest that is accepted and at most `NO_ORDER`."""
    from scipy.optimize import brentq

    first, second, third = sizes

    def excess(order: float) -> float:
        seen = after * (first**order - second**order)
        return float((seen - before * (second**order - third**order)) / third**order)

    low, high = LOWEST_ORDER, NO_ORDER
    if after == 0.0:
        return high
    sign = float(np.sign(after))
    if sign * excess(low) >= 0.0:
        return low
    if sign * excess(high) <= 0.0:
        return high
    return float(brentq(excess, low, high, xtol=1e-12))
