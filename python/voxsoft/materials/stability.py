"""Stability of a hyperelastic material: the stretches over which its stress rises."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.materials.homogeneous import MODES, Mode, nominal_tangent, principal_stretches
from voxsoft.materials.hyperelastic import Floats, Hyperelastic

Flags = NDArray[np.bool_]

#: Range of stretches of :func:`stable_range`: from a third to five times the length.
SCANNED: Final = (0.3, 5.0)

_SAMPLES: Final = 2001

# The other two axes of each, in turn: (1, 2), (2, 0), (0, 1) give cofactors with their signs.
_OTHERS: Final = ((1, 2), (2, 0), (0, 1))


class StableRange(NamedTuple):
    """Stretches around 1 at which a material is stable in one mode.

    Attributes
    ----------
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    monotone
        Stretches between which the nominal stress rises with the stretch.
    drucker
        Stretches between which a change of true strain in the plane of the sheet always costs work:
        the Hessian of the energy in logarithmic strains is positive definite (Drucker).
    scanned
        Scanned range; a stable range that ends there may continue.
    """

    mode: Mode
    monotone: tuple[float, float]
    drucker: tuple[float, float]
    scanned: tuple[float, float]

    @property
    def stable(self) -> tuple[float, float]:
        """Stretches that are stable in both senses."""
        return (
            max(self.monotone[0], self.drucker[0]),
            min(self.monotone[1], self.drucker[1]),
        )

    def holds(self, low: float, high: float) -> bool:
        """Return True if the material is stable in both senses from stretch `low` to `high`."""
        return self.stable[0] <= low and high <= self.stable[1]

    @property
    def sentence(self) -> str:
        """Warning in one line; empty if all of the range is stable.

        Examples
        --------
        >>> from voxsoft.materials import MooneyRivlin
        >>> soft = MooneyRivlin(c10="49.1 kPa", c01="-35.1 kPa")
        >>> stable_range(soft, "uniaxial").sentence
        'uniaxial: unstable below stretch 0.84 and above stretch 1.18'
        """
        low, high = self.stable
        ends = [f"below stretch {low:.2f}"] if low > self.scanned[0] else []
        ends += [f"above stretch {high:.2f}"] if high < self.scanned[1] else []
        return f"{self.mode}: unstable {' and '.join(ends)}" if ends else ""


def stable_range(
    material: Hyperelastic,
    mode: Mode = "uniaxial",
    low: float = SCANNED[0],
    high: float = SCANNED[1],
) -> StableRange:
    """Find the range around the stretch 1 in which a material is stable.

    Parameters
    ----------
    material
        Material; its Poisson's ratio is ignored, as volume is kept.
    mode
        ``"uniaxial"``, ``"equibiaxial"`` or ``"planar"``.
    low, high
        Limits of the scan, below and above 1. Default 0.3 and 5.

    Returns
    -------
    StableRange
        Range whose ends are found on a grid of 2001 stretches, so within 0.15 % of the true ones.

    Raises
    ------
    MaterialError
        An unknown mode, or a stretch that is not above zero.

    Notes
    -----
    With the faces free of stress, ``Ŵ(ε₁, ε₂) = W(ε₁, ε₂, -ε₁ - ε₂)`` in logarithmic strains has
    the Hessian ``Ŵ₁₁ = w₁₁ + w₃₃ - 2 w₁₃``, ``Ŵ₂₂ = w₂₂ + w₃₃ - 2 w₂₃``,
    ``Ŵ₁₂ = w₁₂ + w₃₃ - w₁₃ - w₂₃``, which is the matrix of the criterion. Beyond the limit of a
    Gent material there is no stress: that is not counted as unstable.

    Examples
    --------
    >>> from voxsoft.materials import Yeoh
    >>> stable_range(Yeoh(c=["20.4 kPa", "4.5 kPa", "-0.5 kPa"])).monotone[1] < 3
    True
    """
    # Geometric grid through 1, with equal steps on both sides.
    share = np.log(high) / (np.log(high) - np.log(low)) if high > 1.0 > low else 0.5
    above = max(2, round(share * _SAMPLES))
    grid = np.concatenate(
        [np.geomspace(low, 1.0, _SAMPLES - above + 1)[:-1], np.geomspace(1.0, high, above)]
    )
    with np.errstate(all="ignore"):
        rising = nominal_tangent(material, grid, mode) > 0.0
        convex = _convex(material.log_hessian(principal_stretches(mode, grid)))
    missing = np.isnan(material.log_gradient(principal_stretches(mode, grid))[0])
    return StableRange(
        mode, _around_one(grid, rising | missing), _around_one(grid, convex | missing), (low, high)
    )


def stable_ranges(
    material: Hyperelastic, low: float = SCANNED[0], high: float = SCANNED[1]
) -> tuple[StableRange, ...]:
    """Find the stable ranges of all three modes; see :func:`stable_range`.

    Examples
    --------
    >>> from voxsoft.materials import NeoHookean
    >>> any(found.sentence for found in stable_ranges(NeoHookean(young="60 kPa")))
    False
    """
    return tuple(stable_range(material, mode, low, high) for mode in MODES)


def _convex(hessian: Floats) -> Flags:
    first = hessian[0, 0] + hessian[2, 2] - 2.0 * hessian[0, 2]
    # The determinant of Ŵ as the sum of all cofactors of w, because Ŵ₁₁ Ŵ₂₂ - Ŵ₁₂² cancels
    # where one entry of w is far above the others.
    determinant = sum(
        hessian[i, k] * hessian[j, m] - hessian[i, m] * hessian[j, k]
        for i, j in _OTHERS
        for k, m in _OTHERS
    )
    positive: Flags = (first > 0.0) & (np.asarray(determinant) > 0.0)
    return positive


def _around_one(grid: Floats, good: Flags) -> tuple[float, float]:
    """Return the ends of the run of good stretches that holds 1; both 1 if 1 itself is bad."""
    start = int(np.searchsorted(grid, 1.0 - 1e-12))
    if not good[start]:
        return 1.0, 1.0
    bad = np.flatnonzero(~good)
    below, above = bad[bad < start], bad[bad > start]
    first = int(below[-1]) + 1 if len(below) else 0
    last = int(above[0]) - 1 if len(above) else len(grid) - 1
    return float(grid[first]), float(grid[last])
