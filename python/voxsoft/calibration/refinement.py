"""Local refinement: from the result of a search to the nearest minimum."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.misfit import Evaluation, Misfit

# Edge of the first simplex, and the size at which it has converged, in natural logarithms of the
# moduli: 10 % and 0.02 %.
_FIRST_STEP: Final = 0.1
_CONVERGED: Final = 2e-4
_RELATIVE_ERROR: Final = 1e-6
_RESTARTS: Final = 4
_LARGEST_ERROR: Final = 1e3


def refine(misfit: Misfit, start: Evaluation) -> Evaluation:
    """Minimize the error from a candidate on, by the simplex method of Nelder and Mead.

    The simplex lives on the log scale of the moduli, inside their ranges, and restarts at its
    result until that gains nothing: a valley that ends at a bound flattens the simplex.
    The same start gives the same answer, whatever the number of workers.

    Source: Nelder and Mead 1965, doi:10.1093/comjnl/7.4.308.

    Parameters
    ----------
    misfit
        Function to minimize.
    start
        Candidate to start from.

    Returns
    -------
    Evaluation
        Candidate that is never worse than `start`.
    """
    best = start
    for _ in range(_RESTARTS):
        genes = minimized(
            lambda genes: misfit.at(genes).error, np.array(best.genes), misfit.space.spans()
        )
        found = misfit.at(genes)
        gain = best.error - found.error
        best = found if gain > 0 else best
        if gain <= _RELATIVE_ERROR * best.error:
            break
    return best


def minimized(
    error: Callable[[NDArray[np.float64]], float],
    start: NDArray[np.float64],
    spans: NDArray[np.float64],
    *,
    first_step: float = _FIRST_STEP,
    converged: float = _CONVERGED,
) -> NDArray[np.float64]:
    """Find the genes near `start` at which an error is smallest.

    Parameters
    ----------
    error
        Function from genes (n,) to an error in m; may be infinite.
    start
        Genes, (n,).
    spans
        Length of each range in the natural logarithm, (n,).
    first_step, converged
        Edge of the simplex at first and at the end, in natural logarithms.
    """
    from scipy.optimize import minimize  # slow to load

    def finite(logs: NDArray[np.float64]) -> float:
        return min(error(np.clip(logs / spans, 0.0, 1.0)), _LARGEST_ERROR)

    first = start * spans
    # Each corner steps into the range, also from a bound.
    steps = np.where(start > 0.5, -first_step, first_step)
    simplex = np.vstack([first, first + np.diag(steps)])
    scale = max(finite(first), 1e-12)
    found = minimize(
        finite,
        first,
        method="Nelder-Mead",
        bounds=list(zip(np.zeros(len(spans)), spans, strict=True)),
        options={
            "initial_simplex": np.clip(simplex, 0.0, spans),
            "xatol": converged,
            "fatol": _RELATIVE_ERROR * scale,
        },
    )
    return np.clip(np.asarray(found.x) / spans, 0.0, 1.0)
