"""Rows of numbers as text, quickly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from numpy.typing import NDArray

#: Rows that are formatted at once.
_ROWS: Final = 8192


def rows(form: str, values: NDArray[Any]) -> Iterator[str]:
    """Yield the text of rows of an array (n, k), each by a format of k numbers.

    Examples
    --------
    >>> import numpy as np
    >>> "".join(rows("v %.9g %.9g;", np.array([[1.0, 0.5]])))
    'v 1 0.5;'
    """
    for first in range(0, len(values), _ROWS):
        chunk = values[first : first + _ROWS]
        yield form * len(chunk) % tuple(chunk.ravel().tolist())
