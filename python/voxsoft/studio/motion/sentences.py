"""Times in sentences."""

from __future__ import annotations

from voxsoft.units import format_quantity


def time_text(seconds: float) -> str:
    """Say a time with three digits.

    Examples
    --------
    >>> time_text(0.81234)
    '0.812 s'
    """
    return format_quantity(float(f"{seconds:.3g}"), "time") if seconds else "0 s"
