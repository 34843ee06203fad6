"""Isochoric energies of rubber as functions of principal stretches, for outside checks.

Independent of the core and written in another way, so that a mistake in one of the two shows.
Every model is a sum of functions ``f(s)`` of power sums ``s(α) = Σ λ̄_i^α`` of the isochoric
principal stretches ``λ̄_i = λ_i J^(-1/3)``: ``Ī1 = s(2)`` and, as ``λ̄1 λ̄2 λ̄3 = 1``,
``Ī2 = s(-2)``. In logarithmic stretches ``e_i = ln λ_i`` the derivatives of a power sum are plain::

    ∂s/∂e_i = α (x_i - s/3),   ∂²s/∂e_i∂e_j = α² (x_i δ_ij - (x_i + x_j)/3 + s/9),   x_i = λ̄_i^α
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import SimulationError

Floats = NDArray[np.float64]

#: Term of the energy: the exponent α, and value, first and second derivative of f at s.
Term = tuple[float, Callable[[Floats], tuple[Floats, Floats, Floats]]]


def terms_of(model: str, values: Sequence[float], where: str = "material") -> list[Term]:
    """Write a material model as terms.

    Parameters
    ----------
    model, values
        Name and constants as the core takes them: ``neo-hookean`` (c10), ``mooney-rivlin``
        (c10, c01), ``yeoh`` (c10, c20, c30), ``ogden`` (mu1, alpha1, ...), ``gent`` (shear, jm).
    where
        The place in the design, for messages.

    Raises
    ------
    SimulationError
        Another model.

    Examples
    --------
    >>> (alpha, f), = terms_of("neo-hookean", [2.0])
    >>> alpha, [float(each) for each in f(np.array(4.0))]
    (2.0, [2.0, 2.0, 0.0])
    """
    match model:
        case "neo-hookean":
            return [_linear(2.0, values[0])]
        case "mooney-rivlin":
            return [_linear(2.0, values[0]), _linear(-2.0, values[1])]
        case "yeoh":
            return [(2.0, _cubic([*values, 0.0, 0.0][:3]))]
        case "ogden":
            pairs = zip(values[::2], values[1::2], strict=True)
            return [_linear(alpha, 2.0 * mu / alpha**2) for mu, alpha in pairs]
        case "gent":
            return [(2.0, _limited(values[0], values[1]))]
        case _:
            raise SimulationError(where, f'there is no "{model}" energy here')


def _linear(alpha: float, constant: float) -> Term:
    def f(s: Floats) -> tuple[Floats, Floats, Floats]:
        return constant * (s - 3.0), np.full_like(s, constant), np.zeros_like(s)

    return alpha, f


def _cubic(c: Sequence[float]) -> Callable[[Floats], tuple[Floats, Floats, Floats]]:
    def f(s: Floats) -> tuple[Floats, Floats, Floats]:
        x = s - 3.0
        value = x * (c[0] + x * (c[1] + x * c[2]))
        return value, c[0] + x * (2 * c[1] + x * 3 * c[2]), 2 * c[1] + x * 6 * c[2]

    return f


def _limited(shear: float, limit: float) -> Callable[[Floats], tuple[Floats, Floats, Floats]]:
    def f(s: Floats) -> tuple[Floats, Floats, Floats]:
        # Past the limit there is no energy: NaN, which a line search steps back from.
        with np.errstate(invalid="ignore", divide="ignore"):
            rest = 1.0 - (s - 3.0) / limit
            rest = np.where(rest > 0.0, rest, np.nan)
            value = -0.5 * shear * limit * np.log(rest)
        return value, 0.5 * shear / rest, 0.5 * shear / limit / rest**2

    return f


def stretch_derivatives(terms: Sequence[Term], stretches: Floats) -> tuple[Floats, Floats, Floats]:
    """Energy per volume and its derivatives by the principal stretches.

    Parameters
    ----------
    terms
        Terms from :func:`terms_of`.
    stretches
        Positive, (..., 3).

    Returns
    -------
    energy, gradient, hessian
        Energy density and derivatives in J/m³ (Pa): (...), (..., 3), (..., 3, 3).

    Examples
    --------
    >>> energy, gradient, _ = stretch_derivatives(terms_of("neo-hookean", [1.0]), np.ones(3))
    >>> float(energy), gradient.tolist()
    (0.0, [0.0, 0.0, 0.0])
    """
    logs = np.log(stretches)
    even = logs - logs.mean(axis=-1, keepdims=True)
    one = np.eye(3)
    energy = np.zeros(stretches.shape[:-1])
    slope, bend = np.zeros(stretches.shape), np.zeros((*stretches.shape, 3))
    for alpha, f in terms:
        x = np.exp(alpha * even)
        s = x.sum(axis=-1)
        value, first, second = f(s)
        ds = alpha * (x - s[..., None] / 3)
        pairs = (x[..., :, None] + x[..., None, :]) / 3
        dds = alpha**2 * (x[..., None] * one - pairs + s[..., None, None] / 9)
        energy += value
        slope += first[..., None] * ds
        bend += first[..., None, None] * dds
        bend += second[..., None, None] * ds[..., :, None] * ds[..., None, :]
    both = stretches[..., :, None] * stretches[..., None, :]
    return energy, slope / stretches, (bend - slope[..., None] * one) / both
