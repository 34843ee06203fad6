"""How much memory a grid or a mesh may take before it is refused."""

from __future__ import annotations

import os
from pathlib import Path

#: Used where the operating system does not say (Windows, some containers) [bytes].
UNKNOWN_MEMORY = 8 << 30


def memory_limit() -> int:
    """Return the bytes that can be used without swapping, as far as the system says.

    Linux tells what is available; other Unix systems only what is installed, of which half is
    taken; elsewhere it is :data:`UNKNOWN_MEMORY`.

    Examples
    --------
    >>> memory_limit() > 0
    True
    """
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
