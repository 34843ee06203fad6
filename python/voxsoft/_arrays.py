"""Arrays that nobody changes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def frozen(array: ArrayLike, dtype: type[np.generic]) -> NDArray[Any]:
    """Return a read-only view, so that the caller's own array keeps its flags."""
    view = np.ascontiguousarray(array, dtype=dtype).view()
    view.setflags(write=False)
    return view
