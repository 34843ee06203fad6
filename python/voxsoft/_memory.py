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
