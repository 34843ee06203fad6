"""Limit of the memory that a grid or a mesh may take before it is refused."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Final

import psutil

from voxsoft._cgroups import free_in_groups

#: Seconds for which an answer holds: asking takes as long as meshing a small body.
_LASTING: Final = 0.2

#: Bytes beyond which the system is asked anew. An answer of 0.2 s ago may come from before the
#: last large thing was made; to fill so many bytes takes longer than to ask.
_LARGE: Final = 10e6


class _Reading:
    """The last answer of the system and when it came."""

    limit = 0
    time = float("-inf")


def memory_limit() -> int:
    """Return the bytes that can be used without swapping or being stopped.

    The least of the memory available on the machine, of the rest in the control groups of a
    container or a scheduler (:func:`voxsoft._cgroups.free_in_groups`), and of the rest that the
    process may take (``ulimit -v`` and ``ulimit -d``).

    Examples
    --------
    >>> memory_limit() > 0
    True
    """
    now = time.monotonic()
    if now - _Reading.time > _LASTING:
        _Reading.limit, _Reading.time = _read(), now
    return _Reading.limit


def _read() -> int:
    groups = free_in_groups()
    bounds = [psutil.virtual_memory().available, *_free_to_process()]
    return max(0, min(bounds if groups is None else [*bounds, groups]))


def _free_to_process() -> Iterator[int]:
    """Rest under the limits of the process: of its address space, and of its data."""
    try:
        import resource
    except ImportError:  # Windows
        return
    used = psutil.Process().memory_info()
    for kind, taken in ((resource.RLIMIT_AS, used.vms), (resource.RLIMIT_DATA, used.data)):
        limit, _ = resource.getrlimit(kind)
        if limit != resource.RLIM_INFINITY:
            yield limit - taken


def shortage(due: float) -> str:
    """Say that so many bytes are more than there are; empty where they fit.

    Examples
    --------
    >>> shortage(0), shortage(1e30).partition(", ")[0]
    ('', 'needs about 1,000,000,000,000,000,000,000 GB of memory')
    """
    free = memory_limit() if due < _LARGE else _read()
    if due <= free:
        return ""
    return f"needs about {gigabytes(due)} of memory, more than the limit of {gigabytes(free)}"


def gigabytes(size: float) -> str:
    """Say a number of bytes in gigabytes, to two digits and without powers of ten.

    Examples
    --------
    >>> gigabytes(14e6), gigabytes(2.4e10), gigabytes(2.21e17)
    ('0.014 GB', '24 GB', '220,000,000 GB')
    """
    rounded = float(f"{size / 1e9:.2g}")
    return f"{rounded:,.0f} GB" if rounded >= 10 else f"{rounded:g} GB"
