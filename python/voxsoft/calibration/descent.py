"""Gradient method: initial samples, then weighted Gauss-Newton steps with the exact slopes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.calibration.misfit import Evaluation, Linearized, Misfit

Floats = NDArray[np.float64]

# Number of initial samples, for one constant and for each further one.
_FIRST: Final = 5
_EACH: Final = 4
# Longest step of a constant: a factor of 4. A step below the other one ends the descent.
_LONGEST: Final = float(np.log(4.0))
_ARRIVED: Final = 1e-5
# Residuals below this part of their mean weigh no more: the weights of a sum of lengths are their
# inverses, which have no bound.
_FLOOR: Final = 1e-3
# Damping of the first step with its bounds, in parts of the diagonal (Levenberg and Marquardt).
_DAMPING: Final = (1e-9, 1e-3, 1e6)


def descend(
    misfit: Misfit, generations: int, population: int, seed: int
) -> Iterator[Sequence[Evaluation]]:
    r"""Minimize the mean length of the error vectors.

    A sum of lengths :math:`\sum |r|` is that of the squares :math:`\sum |r|^2/w` with the weights
    :math:`w = |r|` of the step before (Weiszfeld 1937; iteratively reweighted least squares), so
    that each step is one of Levenberg and Marquardt (Marquardt 1963, doi:10.1137/0111030), in the
    logarithms of the constants and the free scales.

    Parameters
    ----------
    misfit
        Function to minimize, solved by statics.
    generations
        Number of batches: the initial samples and the most steps after them.
    population
        Most initial samples.
    seed
        Seed of the initial samples.

    Yields
    ------
    sequence of Evaluation
        Initial samples, then one candidate at a time.
    """
    count = len(misfit.space)
    looks = min(population, _FIRST + _EACH * (count - 1))
    if count == 1:
        around = ((np.arange(looks) + 0.5) / looks)[:, None]
    else:
        from scipy.stats import qmc  # slow to load

        around = qmc.LatinHypercube(count, seed=seed).random(looks)
    batch = misfit.many(around)
    yield batch
    best = min(batch, key=lambda each: each.error)
    if not np.isfinite(best.error):
        return
    here = misfit.linearized(best.genes)
    least, damping, most = _DAMPING
    for _ in range(generations - 1):
        assert not isinstance(here, str)  # it was accepted because it came to rest
        step = _step(misfit, here, damping)
        genes = np.clip(here.evaluation.genes + step / misfit.space.spans(), 0.0, 1.0)
        moved = (genes - np.asarray(here.evaluation.genes)) * misfit.space.spans()
        if np.abs(moved).max() < _ARRIVED or damping > most:
            return
        there = misfit.linearized(genes)
        if isinstance(there, str):
            yield [misfit.at(genes)]
            damping = max(damping, 1e-2) * 10.0
            continue
        yield [there.evaluation]
        if there.evaluation.error < here.evaluation.error:
            here, damping = there, max(damping / 10.0, least)
        else:
            damping = max(damping, 1e-4) * 10.0


def _step(misfit: Misfit, here: Linearized, damping: float) -> Floats:
    """Solve one weighted, damped step in the logarithms of the constants, (k,)."""
    count = len(misfit.space)
    unknowns = count + (len(here.deviations) if misfit.free_scale else 0)
    rows, sides = [], []
    for index, (deviation, slopes) in enumerate(zip(here.deviations, here.slopes, strict=True)):
        lengths = deviation.errors
        weights = np.maximum(lengths, max(_FLOOR * lengths.mean(), 1e-12)) ** -0.5
        weights /= np.sqrt(len(lengths))
        columns = np.zeros((*deviation.simulated.shape, unknowns))
        columns[..., :count] = deviation.scale * slopes
        if misfit.free_scale:
            columns[..., count + index] = deviation.simulated
        residual = deviation.simulated - deviation.measured
        rows.append((weights[:, None, None] * columns).reshape(-1, unknowns))
        sides.append((weights[:, None] * residual).ravel())
    matrix, side = np.vstack(rows), np.concatenate(sides)
    normal = matrix.T @ matrix
    # Only constants are damped: the scales are found anew at every candidate.
    free = np.where(np.arange(unknowns) < count, np.diag(normal), 0.0)
    normal += damping * np.diag(np.maximum(free, 1e-12 * np.trace(normal)))
    found = -np.linalg.lstsq(normal, matrix.T @ side, rcond=None)[0][:count]
    longest = float(np.abs(found).max())
    step: Floats = np.asarray(found, dtype=np.float64)
    return step * min(1.0, _LONGEST / max(longest, 1e-300))
