"""Colors of pixels: of text such as ``"#0072b2"``, and of numbers by the color map.

Pictures of bodies are computed a pixel at a time, and the small one of every run would otherwise
load matplotlib for a table of 256 rows.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from voxsoft.plot.style import COLOR_MAP

Floats = NDArray[np.float64]


def rgb(color: str) -> tuple[float, float, float]:
    """Return red, green and blue, 0 to 1, of six hexadecimal digits after a ``#``.

    Examples
    --------
    >>> rgb("#ff0033")
    (1.0, 0.0, 0.2)
    """
    red, green, blue = (part / 255 for part in bytes.fromhex(color.removeprefix("#")))
    return red, green, blue


@cache
def _table() -> Floats:
    """Return the color map, (256, 3) red, green, blue.

    The numbers are those of ``viridis`` by Stéfan van der Walt and Nathaniel Smith, which its
    authors gave to the public domain (CC0), https://bids.github.io/colormap/.
    """
    file = Path(__file__).with_name(f"{COLOR_MAP}.csv")
    return np.array([line.split(",") for line in file.read_text("ascii").split()], np.float64)


def mapped(values: Floats, low: float, high: float) -> Floats:
    """Return the color of each number, (n, 3), with the ends of the map at `low` and `high`.

    Numbers beyond the ends have the colors of the ends, NaN is black.

    Examples
    --------
    >>> mapped(np.array([0.0, 2.0]), 0.0, 1.0)
    array([[0.267004, 0.004874, 0.329415],
           [0.993248, 0.906157, 0.143936]])
    """
    table = _table()
    part = np.zeros_like(values) if low == high else (values - low) / (high - low)
    unknown = np.isnan(values)
    row = np.clip(np.where(unknown, 0.0, part * len(table)), 0, len(table) - 1).astype(int)
    return np.where(unknown[..., None], 0.0, table[row])
