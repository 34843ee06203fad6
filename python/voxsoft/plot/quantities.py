"""Units of axes, chosen so that a set of numbers is easy to read."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from voxsoft.units import KINDS, parse


class Scale(NamedTuple):
    """Factor and unit of SI numbers on an axis."""

    factor: float
    unit: str

    def label(self, name: str) -> str:
        """Write the name of the axis with its unit."""
        return f"{name} ({self.unit})" if self.unit else name


def scale_for(values: ArrayLike, kind: str) -> Scale:
    """Choose the unit of a kind in which the largest value is between 0.1 and 1000.

    Parameters
    ----------
    values
        Numbers in SI units; those that are not finite do not count.
    kind
        Kind of quantity, a key of :data:`voxsoft.units.KINDS`, or ``""`` where it is not known:
        then the numbers stay as they are and the axis is labeled SI.

    Returns
    -------
    Scale
        Factor to multiply with, and unit.

    Examples
    --------
    >>> scale_for([0.001, 0.025], "length")
    Scale(factor=1000.0, unit='mm')
    >>> scale_for([40e3], "pressure").label("load")
    'load (kPa)'
    """
    if kind not in KINDS:
        return Scale(1.0, "SI")
    units = KINDS[kind].units
    if not units:
        return Scale(1.0, "")
    numbers = np.abs(np.asarray(values, dtype=np.float64))
    largest = float(np.max(numbers, where=np.isfinite(numbers), initial=0.0))
    scales = [Scale(round(1.0 / parse(f"1 {unit}", kind), 12), unit) for unit in units]
    fitting = (scale for scale in scales if 0.1 <= largest * scale.factor < 1000.0)
    return next(fitting, scales[0])
