"""Report of a load that has no value where a body comes to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.simulation.loads.resolve import ResolvedLoad

#: Parts of the whole load, past the last equilibrium, at which a load without a value is looked
#: for: the step of a load path that failed last is at least a thousandth.
_AHEAD: Final = (0.0, 1e-3, 2e-3, 4e-3)

#: Number of a load of the core, component, place [m] and time [s] without a finite value.
Undefined = tuple[int, int, list[float], float]


def undefined_in_words(found: Undefined, owners: Sequence[int]) -> str:
    """Tell which load has no value, where and when.

    Parameters
    ----------
    found
        Finding of the core.
    owners
        Index in the design of the load behind each load of the core.

    Examples
    --------
    >>> undefined_in_words((1, 0, [0.01, 0.0, 0.002], 0.25), [0, 3])
    'loads[3].acceleration[0] has no finite value at (10, 0, 2) mm, where the body comes at 0.25 s'
    """
    load, axis, place, when = found
    return f"{_nowhere(owners[load], axis, place)}, where the body comes at {when:.4g} s"


def _nowhere(load: int, axis: int, place: Sequence[float]) -> str:
    point = ", ".join(f"{value * 1e3:.4g}" for value in place)
    return f"loads[{load}].acceleration[{axis}] has no finite value at ({point}) mm"


def undefined_past(
    loads: Sequence[ResolvedLoad],
    rest: NDArray[np.float64],
    positions: NDArray[np.float64],
    factor: float,
) -> str | None:
    """Tell which load has no value where a load path would lead next, if one has none.

    Parameters
    ----------
    loads
        The loads of a design.
    rest, positions
        Vertices of the unloaded body and of the last equilibrium, (n, 3), m.
    factor
        Load factor of that.
    """
    for ahead in _AHEAD:
        points = positions + ahead / max(factor, _AHEAD[1]) * (positions - rest)
        for index, load in enumerate(loads):
            for action in load.actions:
                if found := action.undefined(points):
                    axis, vertex = found
                    nowhere = _nowhere(index, axis, points[vertex].tolist())
                    return (
                        f"{nowhere}, where the body comes past {100.0 * factor:.4g} % of the load"
                    )
    return None
