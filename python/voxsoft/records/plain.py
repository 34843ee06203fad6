"""Arrays and quantities of other packages, as the models can read them."""

from __future__ import annotations

from collections.abc import ItemsView, Iterator, KeysView, Mapping, ValuesView
from typing import Any

from pydantic import BaseModel


def plain_values(value: Any) -> Any:  # noqa: ANN401 - a user hands over anything
    """Turn arrays, series and generators into lists, arrays of quantities into such of quantities.

    Everything else stays as it is, in lists and mappings of its own: later changes to the
    caller's own lists and mappings have no effect.

    Examples
    --------
    >>> import numpy as np
    >>> plain_values({"center": np.zeros(3), "name": "ball"})
    {'center': [0.0, 0.0, 0.0], 'name': 'ball'}
    """
    if value is None or isinstance(value, (str, int, float)):
        return value
    if isinstance(value, dict):
        return {key: plain_values(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [plain_values(entry) for entry in value]
    if type(value) is tuple:
        return tuple(plain_values(entry) for entry in value)
    if isinstance(value, Mapping):
        return {key: plain_values(entry) for key, entry in value.items()}
    if isinstance(value, (Iterator, KeysView, ValuesView, ItemsView)):
        return [plain_values(entry) for entry in value]
    if isinstance(value, BaseModel):
        return value  # a look for an attribute that it has not would be slow
    if hasattr(value, "tolist"):  # NumPy and pandas; a quantity has it too
        if hasattr(value, "units"):
            return [*value] if getattr(value, "ndim", 0) else value
        return value.tolist()
    return value
