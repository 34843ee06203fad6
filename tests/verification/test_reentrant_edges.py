"""A plane frame whose inner edges are re-entrant, against squares refined without any relief.

The frame (24 mm, room of 4 by 8 mm) is drawn apart by tractions on two sides. Truth at small strain
is the Richardson limit of bilinear squares with Wilson's modes, which share no line with VoxSoft
(``research/reentrant_edges.py`` has them). Large strain: that of our own voxels of 0.5 and 0.25 mm
with the order 1.6.
"""

from __future__ import annotations

import pytest

import voxsoft as vs
from voxsoft.units import kPa, mm

SIDE, YOUNG = 24.0, 100.0
#: Walls beside the room, and above and below it.
WALLS = (10.0, 8.0)
#: Motion of the middle of a side in mm for a traction of 1 kPa, by Poisson's ratio.
SMALL = {0.3: 0.17381, 0.49: 0.14514}
#: By the traction in % of Young's modulus, in mm; nu = 0.49.
LARGE = {2: 0.29393, 10: 1.56653, 20: 3.4816}
#: Without relief 2.3 to 2.8 % are missing at 2 mm and 0.6 to 0.9 % at 1 mm. What is left is of
#: second order, most at 2 mm, where the room is two voxels wide.
TOLERANCE = {2.0: 0.015, 1.0: 0.005}


def drawn_apart(size: float, traction: float, poisson: float) -> float:
    """Motion of the middle of a side in mm; the traction in kPa."""
    beside, above = WALLS
    room = (SIDE - 2 * beside, 4 * size, SIDE - 2 * above)
    outer = vs.Box(size=(SIDE * mm, 2 * size * mm, SIDE * mm), corner=(0, 0, 0))
    inner = vs.Box(
        size=tuple(length * mm for length in room),
        corner=(beside * mm, -size * mm, above * mm),
    )
    rubber = vs.NeoHookean(young=YOUNG * kPa, poisson=poisson, density=1000.0)
    middle = (SIDE / 2 * mm, SIDE / 2 * mm)
    sides = {0.0: -traction, SIDE: traction}
    design = vs.Design(
        name="frame",
        voxel_size=size * mm,
        parts=[vs.Part(shape=outer - inner, material=rubber)],
        clamps=[
            vs.Clamp(region=vs.Region(y=(0, 0)), axes="y"),
            vs.Clamp(region=vs.Region(y=(2 * size * mm, 2 * size * mm)), axes="y"),
            vs.Clamp(region=vs.Region(z=(0, 0)), axes="z"),
            vs.Clamp(region=vs.Region(x=middle, z=(0, 0)), axes="x"),
        ],
        loads=[
            vs.Traction(region=vs.Region(x=(at * mm, at * mm)), value=(pull * kPa, 0, 0))
            for at, pull in sides.items()
        ],
        probes={"side": vs.Probe(point=(0, size * mm, SIDE / 2 * mm))},
        solver={"error": "off"},
    )
    result = vs.simulate(design)
    assert result.status == "ok", result.message
    return float(-result.probes["side"][0]) / mm


@pytest.mark.parametrize("poisson", SMALL)
@pytest.mark.parametrize("size", [2.0, 1.0])
def test_a_frame_is_as_soft_as_its_edges_allow(size: float, poisson: float) -> None:
    traction = 0.02
    found = drawn_apart(size, traction, poisson)
    assert found == pytest.approx(SMALL[poisson] * traction, rel=TOLERANCE[size])


@pytest.mark.parametrize("traction", LARGE)
@pytest.mark.parametrize("size", [2.0, 1.0])
def test_its_edges_stay_right_at_large_strain(size: float, traction: float) -> None:
    assert drawn_apart(size, traction, 0.49) == pytest.approx(LARGE[traction], rel=TOLERANCE[size])
