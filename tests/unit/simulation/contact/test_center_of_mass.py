"""Center of mass of free objects beside the middle of their bounding box."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.design import Object
from voxsoft.units import kPa, mm


def test_a_cone_that_falls_has_its_center_of_mass_at_a_quarter_of_its_height():
    cone = vs.Cone(base=(0, 0, 20 * mm), radius=8 * mm, height=12 * mm)
    block = vs.Box(size=(10 * mm, 10 * mm, 10 * mm), corner=(30 * mm, 0, 0))
    ball = vs.Sphere(radius=8 * mm, center=(-30 * mm, 0, 10 * mm))
    design = vs.Design(
        name="falling",
        voxel_size=5 * mm,
        parts=[vs.Part(shape=block, material=vs.NeoHookean(young=100 * kPa, poisson=0.3))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        objects=[
            Object(name="cone", shape=cone, motion="free", density="1000 kg/m^3"),
            Object(name="ball", shape=ball, motion="fixed"),
        ],
        loads=[vs.Gravity()],
        solver=vs.Solver(end_time="10 ms", time_step="5 ms", error="off"),
    )
    found = vs.simulate(design).objects
    center = found["cone"].center_of_mass
    # The surface is traced on voxels of 5 mm, which leaves 0.007 mm; on 2.5 mm it is 0.0004 mm.
    fallen = 0.5 * 9.80665 * 0.01**2
    assert center[2] == pytest.approx(23 * mm - fallen, abs=0.01 * mm)
    assert found["cone"].position[2] - center[2] > 1 * mm
    assert np.allclose(center[:2], 0.0, atol=1e-5)
    assert found["cone"].summary()["center_of_mass"] == list(center)
    assert found["ball"].center_of_mass is None
