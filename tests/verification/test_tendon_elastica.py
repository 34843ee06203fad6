"""A cantilever that a tendon bends, beside the elastica."""

import numpy as np
import pytest

import voxsoft as vs
from voxsoft.simulation import simulate
from voxsoft.units import kPa, mm

YOUNG, LENGTH = 500 * kPa, 100 * mm
#: Distance of the tendon from the middle, as a part of the height.
OFFSET = 0.4


def bent(height, angle):
    """Tip place over length, and its angle, of a square rod with a tendon in a channel beside its
    axis, under the tension that bends the elastica by an angle.

    A line of tension ``T`` at a distance ``e`` has the potential ``T ∫ (1 + ε − e κ) ds``, so that
    the rod has the curvature ``T e / E I`` all along: an arc.
    """
    offset = OFFSET * height
    tension = YOUNG * height**4 / 12 * (angle / LENGTH) / offset
    # The anchor is in a stiff end, which it does not dent.
    rod = vs.Box(size=(LENGTH, height, height))
    end = vs.Box(size=(height, height, height), corner=(LENGTH, 0, 0))
    line = [
        (0, height / 2, height / 2 + offset),
        (LENGTH + height / 2, height / 2, height / 2 + offset),
    ]
    design = vs.Design(
        name="rod",
        voxel_size=height / 2,
        parts=[
            vs.Part(shape=rod, material=vs.NeoHookean(young=YOUNG, poisson=0.3)),
            vs.Part(shape=end, material=vs.NeoHookean(young=1e3 * YOUNG, poisson=0.3)),
        ],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        probes={
            "near": vs.Probe(x=(LENGTH, LENGTH)),
            "far": vs.Probe(x=(LENGTH + height, LENGTH + height)),
        },
        tendons=[vs.Tendon(through=line, tension=tension)],
    )
    result = simulate(design)
    assert result.status == "ok"
    near, far = (result.probes[name] for name in ("near", "far"))
    heading = far - near + np.array([height, 0, 0])
    place = (near + np.array([LENGTH, 0, 0])) / LENGTH
    return np.array([place[0], place[2], np.arctan2(heading[2], heading[0])])


@pytest.mark.parametrize("degrees", [45, 90])
def test_a_rod_pulled_by_a_tendon_is_an_arc(degrees):
    angle = np.radians(degrees)
    arc = np.array([np.sin(angle) / angle, (1 - np.cos(angle)) / angle, angle])
    thick, thin = (bent(height, angle) for height in (2 * mm, 1 * mm))
    # Elastica theory is the limit of a thin rod: the axial strain T/EA, and ends as long as the rod
    # is thick, are off by the height over the length.
    assert thin == pytest.approx(arc, rel=0.01)
    assert 2 * thin - thick == pytest.approx(arc, rel=0.001)
