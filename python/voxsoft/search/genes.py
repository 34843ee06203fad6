"""Map from a gene in [0, 1] to a value of a search range."""

from __future__ import annotations

from typing import Any

from optuna.distributions import (
    BaseDistribution,
    CategoricalDistribution,
    FloatDistribution,
    IntDistribution,
)

from voxsoft.errors import StudyError
from voxsoft.units import round_significant


def value_of_gene(distribution: BaseDistribution, gene: float) -> Any:  # noqa: ANN401
    """Map a gene onto a range, so that a uniform gene gives Optuna's own random values.

    Stepped ranges and choices get equal shares of [0, 1]; a range with ``log`` is uniform in the
    logarithm.

    Parameters
    ----------
    distribution
        An Optuna distribution of floats, whole numbers or choices.
    gene
        Number from 0 to 1.

    Raises
    ------
    StudyError
        A distribution of another kind.

    Examples
    --------
    >>> round(value_of_gene(FloatDistribution(1.0, 100.0, log=True), 0.5), 12)
    10.0
    >>> value_of_gene(IntDistribution(1, 3), 1.0)
    3
    """
    if isinstance(distribution, CategoricalDistribution):
        return distribution.choices[_share(gene, len(distribution.choices))]
    if not isinstance(distribution, FloatDistribution | IntDistribution):
        raise StudyError("space", f"{type(distribution).__name__} is no range of genes")
    low, high = distribution.low, distribution.high
    if distribution.log:
        value = low * (high / low) ** gene
        whole = round(value) if isinstance(distribution, IntDistribution) else value
        return min(max(whole, low), high)
    if distribution.step is None:
        return low + gene * (high - low)
    count = round((high - low) / distribution.step) + 1
    value = low + _share(gene, count) * distribution.step
    return value if isinstance(distribution, IntDistribution) else round_significant(value)


def _share(gene: float, count: int) -> int:
    return min(int(gene * count), count - 1)
