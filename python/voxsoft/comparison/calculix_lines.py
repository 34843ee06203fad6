"""Lists of numbers in CalculiX's input files."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

_PER_LINE: Final = 12


def member_lines(kind: str, name: str, members: NDArray[np.integer]) -> Iterator[str]:
    """Define a set of nodes (``NSET``) or elements (``ELSET``), which are counted from 0 here.

    Examples
    --------
    >>> list(member_lines("NSET", "TIP", np.arange(3)))
    ['*NSET, NSET=TIP', '1,2,3']
    """
    yield f"*{kind}, {kind}={name}"
    numbers = [str(member + 1) for member in members.tolist()]
    for start in range(0, len(numbers), _PER_LINE):
        yield ",".join(numbers[start : start + _PER_LINE])
