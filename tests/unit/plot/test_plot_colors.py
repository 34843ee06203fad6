"""Colors of pixels are those of matplotlib, which draws the color bar beside them."""

import numpy as np
import pytest
from matplotlib import colormaps
from matplotlib.colors import Normalize, to_rgb

from voxsoft.plot.colors import mapped, rgb
from voxsoft.plot.style import COLOR_MAP, SERIES


@pytest.mark.parametrize("ends", [(0.0, 1.0), (-3.0, 7.5), (2.0, 2.0)])
def test_numbers_have_the_colors_of_the_bar(ends):
    # Each row of the map, the ends, numbers beyond them and none at all.
    low, high = ends
    inside = np.linspace(low, high, 1025)
    values = np.concatenate([inside, [low - 1.0, high + 1.0, -np.inf, np.inf, np.nan]])
    expected = colormaps[COLOR_MAP](Normalize(low, high)(values))[:, :3]
    if low == high:  # matplotlib paints all of a range without length alike, NaN too
        expected[-1] = 0.0
    np.testing.assert_array_equal(mapped(values, low, high), expected)


def test_text_is_read_as_matplotlib_reads_it():
    assert [rgb(color) for color in SERIES] == [to_rgb(color) for color in SERIES]
