"""Central differences of forces and metrics at given positions, which need no solution."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", float, NDArray[np.float64])

#: Relative step of a number, taken once and twice to either side. Forces are differenced at
#: positions that do not change. Rounding leaves 1e-16/5e-6 of the largest force, and the
#: curvature of the steepest law, the bulk modulus at ν = 0.4999, 4 (ν/(0.5 - ν) 5e-6)⁴ = 2e-6.
STEP: Final = 5e-6

#: Central differences of fourth order: multiples of the step, and their weights over it.
STENCIL: Final = ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12))


def derivative(function: Callable[[float], T], value: float) -> T:
    """Differentiate a function of a positive number.

    Parameters
    ----------
    function
        A function of a number; its values are numbers or arrays.
    value
        The argument; steps are :data:`STEP` of it.

    Examples
    --------
    >>> round(derivative(lambda x: x**3, 2.0), 8)
    12.0
    """
    step = STEP * value
    terms = [weight / step * function(value + multiple * step) for multiple, weight in STENCIL]
    total: T = terms[0] + terms[1] + terms[2] + terms[3]
    return total
