"""Arrows of loads in the page's picture: their places and directions."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Drag, ForceField
from voxsoft.studio.bodies.body import StudioBody


@pytest.mark.parametrize("direction", [(0, 0, -1), (1, 0, 0), (1, 2, -2)])
def test_the_arrow_of_gravity_ends_where_it_enters_the_body(direction):
    part = vs.Part(
        shape=vs.Box(size=("40 mm", "10 mm", "10 mm"), corner=(0, 0, 0)), material="ecoflex-00-30"
    )
    design = vs.Design(
        name="bar", voxel_size="5 mm", parts=(part,), loads=(vs.Gravity(direction=direction),)
    )
    body = StudioBody.of(design, rev=1, topology=1)
    (load,) = body.loads
    low, high = body.mesh.vertices.min(axis=0), body.mesh.vertices.max(axis=0)
    at, along = np.array(load.at), np.array(load.direction)
    # On the bounds of the body: its arrow is outside, and a point just beyond the tip is inside.
    before, after = at - 1e-6 * along, at + 1e-6 * along
    assert not np.all((low < before) & (before < high))
    assert np.all((low < after) & (after < high))
    # The line goes through the middle.
    middle = body.mesh.vertices.mean(axis=0)
    assert np.linalg.norm(np.cross(middle - at, along)) == pytest.approx(0.0, abs=1e-12)


def test_fluids_and_fields_have_sliders_too():
    part = vs.Part(
        shape=vs.Box(size=("10 mm", "10 mm", "10 mm"), corner=(0, 0, 0)), material="ecoflex-00-30"
    )
    loads = (Drag(flow=("0.1 m/s", 0, 0)), ForceField(acceleration=(0, 0, "-9.81 - 8*vz")))
    design = vs.Design(name="bar", voxel_size="5 mm", parts=(part,), loads=loads)
    drag, field = StudioBody.of(design, rev=1, topology=1).loads
    assert (drag.value, drag.unit, drag.direction) == (1000.0, "kg/m^3", (1.0, 0.0, 0.0))
    assert (field.value, field.unit, field.direction) == (1.0, "", (0.0, 0.0, -1.0))
    assert (field.min, field.max, field.factor) == (0.0, 2.0, 1.0)
