"""Report of a load that has no value where a body comes to."""

from __future__ import annotations

from collections.abc import Sequence

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
    point = ", ".join(f"{value * 1e3:.4g}" for value in place)
    return (
        f"loads[{owners[load]}].acceleration[{axis}] has no finite value at ({point}) mm, "
        f"where the body comes at {when:.4g} s"
    )
