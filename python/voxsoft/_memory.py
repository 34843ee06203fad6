"""How much memory a grid or a mesh may take before it is refused."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Final

#: Used where the operating system does not say (Windows, some containers) [bytes].
UNKNOWN_MEMORY = 8 << 30


#: Seconds for which an answer holds: asking takes as long as meshing a small body.
_LASTING: Final = 0.2


class _Reading:
    """The last answer of the system and when it came."""

    limit = 0
    time = float("-inf")


def memory_limit() -> int:
    """Return the bytes that can be used without swapping, as far as the system says.

    Linux tells what is available; other Unix systems only what is installed, of which half is
    taken; elsewhere it is :data:`UNKNOWN_MEMORY`.

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
    try:
        for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
            if line.startswith("MemAvailable:"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
    except (AttributeError, OSError, ValueError):
        return UNKNOWN_MEMORY


def gigabytes(size: float) -> str:
    """Say a number of bytes in gigabytes, to two digits and without powers of ten.

    Examples
    --------
    >>> gigabytes(14e6), gigabytes(2.4e10), gigabytes(2.21e17)
    ('0.014 GB', '24 GB', '220,000,000 GB')
    """
    rounded = float(f"{size / 1e9:.2g}")
    return f"{rounded:,.0f} GB" if rounded >= 10 else f"{rounded:g} GB"
