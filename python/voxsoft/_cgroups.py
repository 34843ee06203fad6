"""Memory left by a container or a scheduler: Linux' control groups, both versions.

No library that VoxSoft builds on reads them: psutil tells of the machine and of the process.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple


class _Files(NamedTuple):
    """Files in which a version keeps its numbers."""

    mount: str
    limits: tuple[str, ...]
    used: str
    #: Row of ``memory.stat`` with the part of a group's memory that is cache, which gives way.
    cache: str


_SECOND: Final = _Files(
    "sys/fs/cgroup", ("memory.max", "memory.high"), "memory.current", "inactive_file"
)
#: Mount point of version 2 where both stand side by side, as systemd can.
_UNIFIED: Final = _SECOND._replace(mount="sys/fs/cgroup/unified")
_FIRST: Final = _Files(
    "sys/fs/cgroup/memory",
    ("memory.limit_in_bytes",),
    "memory.usage_in_bytes",
    "total_inactive_file",
)


def free_in_groups(root: Path = Path("/")) -> int | None:
    """Return the bytes that the control groups of this process still allow.

    Every group limits the ones in it, so the least of all counts. Above ``memory.high`` a process
    is slowed down until it hardly runs, so that counts as a limit too.

    Parameters
    ----------
    root
        Mount point of ``proc`` and ``sys``.

    Returns
    -------
    int or None
        None where no group has a limit, or where there are no groups.
    """
    known = [free for files, path in _groups(root) if (free := _free(files, path)) is not None]
    return min(known, default=None)


def _groups(root: Path) -> Iterator[tuple[_Files, Path]]:
    """The groups of this process and all that hold them."""
    try:
        lines = (root / "proc/self/cgroup").read_text(encoding="utf-8").splitlines()
    except OSError:
        return
    for line in lines:
        _, _, rest = line.partition(":")
        controllers, colon, path = rest.partition(":")
        if not colon:
            continue
        if not controllers:
            versions: tuple[_Files, ...] = (_SECOND, _UNIFIED)
        elif "memory" in controllers.split(","):
            versions = (_FIRST,)
        else:
            continue
        for files in versions:
            mount = root / files.mount
            # A container sees its own group as the mount, under a path that only the host knows.
            group = mount / path.lstrip("/")
            for each in (group, *group.parents):
                yield files, each
                if each == mount:
                    break


def _free(files: _Files, group: Path) -> int | None:
    limits = [limit for name in files.limits if (limit := _number(group / name)) is not None]
    used = _number(group / files.used)
    if not limits or used is None:
        return None
    return max(0, min(limits) - used + _cache(files, group))


def _cache(files: _Files, group: Path) -> int:
    try:
        rows = (group / "memory.stat").read_text(encoding="ascii").splitlines()
        return next(int(row.split()[1]) for row in rows if row.split()[0] == files.cache)
    except (OSError, ValueError, IndexError, StopIteration):
        return 0


def _number(file: Path) -> int | None:
    """The number in a file; None where there is none, or ``max``."""
    try:
        return int(file.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None
