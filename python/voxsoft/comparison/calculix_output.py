"""What CalculiX prints: displacements and forces of node sets, an increment after another."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_HEAD: Final = re.compile(r"^\s*(displacements|forces) .*for set (\S+) and time\s+(\S+)\s*$")
# Fortran writes 1.0-100 where an exponent has three digits.
_LONG_EXPONENT: Final = re.compile(r"(\d)([+-]\d{3})\b")


@dataclass(frozen=True, eq=False)
class Printed:
    """The rows of one set at one time: node numbers counted from 0 (k,), values (k, 3)."""

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


def _row(line: str) -> list[float] | None:
    words = _LONG_EXPONENT.sub(r"\1E\2", line).split()
    if len(words) != 4:
        return None
    try:
        return [float(word) for word in words]
    except ValueError:
        return None
