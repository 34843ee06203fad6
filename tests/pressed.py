"""A block of rubber under a plate that comes down on it."""

import voxsoft as vs
from voxsoft.design import Object
from voxsoft.units import kPa, mm

SIDE, PRESS = 12 * mm, 1.5 * mm
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45)
BLOCK = vs.Box(size=(SIDE, SIDE, SIDE))
PLATE = Object(
    name="plate",
    # Width of the block after it has bulged, and half a millimeter above it.
    shape=vs.Box(size=(20 * mm, 20 * mm, 4 * mm), center=(6 * mm, 6 * mm, 14.5 * mm)),
    motion=vs.Motion(displacement=(0, 0, -PRESS - 0.5 * mm)),
)
#: Beside the block; nothing touches it.
POST = Object(
    name="post",
    shape=vs.Box(size=(4 * mm, 4 * mm, 4 * mm), center=(-7 * mm, 6 * mm, 6 * mm)),
    voxel_size=1 * mm,
)


def pressed(**changes):
    """The block, with some entries of the design changed."""
    whole = {
        "name": "pressed",
        "voxel_size": 4 * mm,
        "parts": [vs.Part(shape=BLOCK, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "objects": [PLATE],
    }
    return vs.Design(**(whole | changes))


def slit(**changes):
    """Two lips with a gap of one voxel between them; the upper one is pressed down."""
    size = 2 * mm
    lips = vs.Box(size=(20 * mm, 4 * mm, 10 * mm)) - vs.Box(
        size=(16 * mm, 4 * mm, size), center=(12 * mm, 2 * mm, 5 * mm)
    )
    down = vs.Motion(displacement=(0, 0, -1.5 * size))
    over = vs.Region(x=(14 * mm, 16 * mm), z=(10 * mm, 10 * mm))
    whole = {
        "name": "slit",
        "voxel_size": size,
        "parts": [vs.Part(shape=lips, material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0))), vs.Clamp(region=over, motion=down)],
    }
    return vs.Design(**(whole | changes))
