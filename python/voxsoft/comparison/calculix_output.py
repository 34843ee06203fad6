"""Reader of CalculiX's output: displacements and forces of node sets, and contact forces."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_TOTAL: Final = re.compile(
    r"^\s*(?:total force .*for set (\S+)|statistics for slave set (\S+), master set \S+) "
    r"and time\s+(\S+)\s*$"
)
_HEAD: Final = re.compile(r"^\s*(displacements|forces) .*for set (\S+) and time\s+(\S+)\s*$")
# Fortran writes 1.0-100 where an exponent has three digits.
_LONG_EXPONENT: Final = re.compile(r"(\d)([+-]\d{3})\b")


@dataclass(frozen=True, eq=False)
class Printed:
    """Rows of one set at one time: node numbers counted from 0 (k,), values (k, 3)."""

    quantity: str
    name: str
    time: float
    nodes: NDArray[np.int64]
    values: Floats


def read_printed(text: str) -> list[Printed]:
    r"""Read the blocks of a ``.dat`` file, in order; a block that breaks off is left out.

    Parameters
    ----------
    text
        Content of the file.

    Examples
    --------
    >>> head = " displacements (vx,vy,vz) for set TIP and time  0.5000000E+00"
    >>> read_printed(head + "\n\n  7  1.000000E+00  0.000000E+00 -2.5-101\n")[0].time
    0.5
    """
    blocks: list[Printed] = []
    head: re.Match[str] | None = None
    rows: list[list[float]] = []

    def close() -> None:
        if head is not None and rows:
            table = np.array(rows)
            nodes = table[:, 0].astype(np.int64) - 1
            blocks.append(Printed(head[1], head[2], float(head[3]), nodes, table[:, 1:]))

    for line in text.splitlines():
        found = _HEAD.match(line)
        if found:
            close()
            head, rows = found, []
        elif head is not None and line.strip():
            row = _row(line)
            if row is None:
                close()
                head, rows = None, []
            else:
                rows.append(row)
    close()
    return blocks


def read_totals(text: str) -> dict[tuple[str, float], Floats]:
    r"""Read total forces: of sets of nodes, and of slave surfaces of contact, by name and time.

    Parameters
    ----------
    text
        Content of the ``.dat`` file.

    Examples
    --------
    >>> head = " total force (fx,fy,fz) for set TOOL and time  0.1000000E+01"
    >>> read_totals(head + "\n\n       -4.2E-01  0.0E+00  2.0E+00\n")
    {('TOOL', 1.0): array([-0.42,  0.  ,  2.  ])}
    """
    found: dict[tuple[str, float], Floats] = {}
    key: tuple[str, float] | None = None
    for line in text.splitlines():
        head = _TOTAL.match(line)
        if head:
            key = (head[1] or head[2], float(head[3]))
        elif key is not None:
            # Rows of surfaces hold moments on the same line; a line of words comes before them.
            row = _row(line, 3) or _row(line, 6)
            if row is not None:
                found[key], key = np.array(row[:3]), None
    return found


def _row(line: str, count: int = 4) -> list[float] | None:
    words = _LONG_EXPONENT.sub(r"\1E\2", line).split()
    if len(words) != count:
        return None
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
