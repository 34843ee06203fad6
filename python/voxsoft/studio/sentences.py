"""What the studio says of a simulation, in plain words."""

from __future__ import annotations

from collections.abc import Sequence

from voxsoft.units import format_percent, format_quantity


def time_text(seconds: float) -> str:
    """Say a time with three digits.

    Examples
    --------
    >>> time_text(0.81234)
    '0.812 s'
    """
    return format_quantity(float(f"{seconds:.3g}"), "time") if seconds else "0 s"


def at_rest(seconds: float, tolerance: float) -> str:
    """Say that a body came to rest.

    Examples
    --------
    >>> at_rest(0.8, 1e-5)
    'At rest after 0.8 s: forces balance within 0.001 % of the load.'
    """
    share = format_percent(tolerance)
    return f"At rest after {time_text(seconds)}: forces balance within {share} of the load."


def slowed(factor: float, rest_in: float | None) -> str:
    """Say how slowly a motion is shown and, where it slows itself down, why.

    Examples
    --------
    >>> slowed(0.02, 0.0497)
    'Shown 50 times slower than real time, as it comes to rest within 49.7 ms.'
    >>> slowed(0.5, None)
    'Shown 2 times slower than real time.'
    """
    why = "" if rest_in is None else f", as it comes to rest within {time_text(rest_in)}"
    return f"Shown {1 / factor:.3g} times slower than real time{why}."


def diverged(seconds: float, place: Sequence[float] | None) -> str:
    """Say that a body could not be followed, where, and what to try.

    Examples
    --------
    >>> diverged(0.31, (0.01, 0.0, 0.02))
    'Diverged at 0.31 s near (10.0, 0.0, 20.0) mm: the material cannot carry the load there. \
Try a smaller load, a stiffer material or thicker walls, then reset.'
    """
    near = ""
    if place is not None:
        near = f" near ({', '.join(f'{1e3 * value:.1f}' for value in place)}) mm"
    return (
        f"Diverged at {time_text(seconds)}{near}: the material cannot carry the load there. "
        "Try a smaller load, a stiffer material or thicker walls, then reset."
    )
