"""Things that fall onto a pad or are gripped by two."""

import voxsoft as vs
from voxsoft.design import Contact, History, Object
from voxsoft.units import kPa, mm

GRAVITY = 9.81
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45, density=1000)
BALL = vs.Sphere(radius=6 * mm, center=(10 * mm, 10 * mm, 20 * mm))


def dropped(**changes):
    """A heavy ball above a soft pad."""
    whole = {
        "name": "dropped",
        "voxel_size": 4 * mm,
        "parts": [vs.Part(shape=vs.Box(size=(20 * mm, 20 * mm, 8 * mm)), material=RUBBER)],
        "clamps": [vs.Clamp(region=vs.Region(z=(0, 0)))],
        "loads": [vs.Gravity()],
        "objects": [Object(name="ball", shape=BALL, motion="free", mass="10 g", voxel_size=3 * mm)],
        "contact": Contact(friction=0.5),
        "probes": {"top": vs.Probe(z=(8 * mm, 8 * mm))},
    }
    return vs.Design(**(whole | changes))


def pinched(friction, **changes):
    """A capsule between two pads that close, and its weight, which comes after."""
    pad = [vs.Box(size=(4 * mm, 8 * mm, 8 * mm), center=(x, 0, 0)) for x in (-6 * mm, 6 * mm)]
    close = History(time=[0.0, 0.05], factor=[0.0, 1.0])
    firm = vs.NeoHookean(young=1000 * kPa, poisson=0.45, density=1000)
    capsule = vs.Capsule(start=(0, -2 * mm, 0), end=(0, 2 * mm, 0), radius=3.9 * mm)
    whole = {
        "name": "pinched",
        "voxel_size": 2 * mm,
        "parts": [vs.Part(shape=pad[0] | pad[1], material=firm)],
        "clamps": [
            vs.Clamp(
                region=vs.Region(x=(8 * mm * side, 8 * mm * side)),
                motion=vs.Motion(displacement=(-0.5 * mm * side, 0, 0), history=close),
            )
            for side in (-1, 1)
        ],
        "loads": [vs.Gravity(history=History(time=[0.05, 0.1], factor=[0.0, 1.0]))],
        "objects": [
            Object(name="capsule", shape=capsule, motion="free", mass="45 g", voxel_size=2 * mm)
        ],
        "contact": Contact(friction=friction),
    }
    return vs.Design(**(whole | changes))


def bar(height):
    """A block between the pads, with faces wider than theirs."""
    return Object(
        name="block",
        shape=vs.Box(size=(8 * mm, 16 * mm, height), center=(0, 0, 0)),
        motion="free",
        mass="45 g",
        voxel_size=4 * mm,
    )
