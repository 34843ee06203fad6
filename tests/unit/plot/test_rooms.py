"""Pictures of a room: a body is where it is, and as large as it is."""

from dataclasses import replace

import numpy as np
import pytest

from voxsoft.plot import body_image
from voxsoft.units import mm
from voxsoft.voxels import Voxels

FRONT = (-90.0, 0.0)
ROOM = ((0.0, 0.0, 0.0), (40 * mm, 10 * mm, 20 * mm))


def picture(along):
    """Draw a cube of 10 mm at a place along x; returns the columns and rows that it covers."""
    mesh = Voxels.from_array(np.ones((2, 2, 2), dtype=np.uint8), voxel_size=5 * mm).mesh()
    moved = replace(mesh, vertices=mesh.vertices + np.array([along, 0.0, 0.0]))
    image = body_image(moved, pixels=416, view=FRONT, field="plain", room=ROOM)
    dark = image.min(axis=2) < 250
    return image.shape, np.flatnonzero(dark.any(axis=0)), np.flatnonzero(dark.any(axis=1))


def test_a_room_is_shown_whole_wherever_the_body_is():
    # 40 mm and margins of 2 % to each side are 416 pixels: ten for each mm, to one of each edge.
    (shape, columns, rows), (other, moved, _) = picture(0.0), picture(20 * mm)
    assert shape == other
    assert len(columns) == pytest.approx(100, abs=2)
    assert len(rows) == pytest.approx(100, abs=2)
    assert moved[0] - columns[0] == pytest.approx(200, abs=1)
    assert columns[0] == pytest.approx(8, abs=2)
