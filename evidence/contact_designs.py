"""The designs of `contact.py`: bodies that touch each other, themselves and rigid objects.

Lengths are in mm. All bodies are of one rubber: neo-Hookean, E = 100 kPa. Cases with symmetry are
quarters or halves, and plane strain is a slab of one voxel between two planes without friction.
"""

from __future__ import annotations

import numpy as np

import voxsoft as vs
from voxsoft.design import Contact, ContactPair, Object
from voxsoft.units import kPa, mm

YOUNG = 100 * kPa
#: The radius of the half sphere, and of the rigid ball and the block that it is pressed into.
SPHERE, BALL, BLOCK = 20.0, 10.0, 30.0
#: Heights of the stacked blocks, and how wide the upper and the lower one are.
LAYER, UPPER, LOWER = 10.0, 20.0, 40.0
#: Where plane strain holds the slab.
EVERYWHERE = vs.Region(x=(-1.0, 1.0))
#: The body does not meet itself.
APART = ContactPair(of=("body", "body"), kind="none")


def rubber(poisson: float = 0.45) -> vs.NeoHookean:
    """The material of the references: the law is the same, mu/2 (I1 - 3) + K/2 (J - 1)^2."""
    return vs.NeoHookean(young=YOUNG, poisson=poisson)


def box(low: tuple[float, ...], high: tuple[float, ...]) -> vs.Box:
    """A box between two corners."""
    x, y, z = ((b - a) * mm for a, b in zip(low, high, strict=True))
    u, v, w = ((a + b) / 2 * mm for a, b in zip(low, high, strict=True))
    return vs.Box(size=(x, y, z), center=(u, v, w))


def symmetry(axes: str) -> list[vs.Clamp]:
    """Planes of symmetry through the origin."""
    return [vs.Clamp(region=vs.Region(**{axis: (0, 0)}), axes=axis) for axis in axes]


def moved(axes: str, way: tuple[float, float, float], **where: tuple[float, float]) -> vs.Clamp:
    """A clamp of a region in mm, moved by so many mm."""
    region = vs.Region(**{axis: (a * mm, b * mm) for axis, (a, b) in where.items()})
    x, y, z = (each * mm for each in way)
    return vs.Clamp(region=region, axes=axes, motion=vs.Motion(displacement=(x, y, z)))


def sphere_on_plane(
    voxel: float, depth: float, poisson: float = 0.45, *, cut: bool = False
) -> vs.Design:
    """A quarter of half a sphere; its equator moves down by `depth`, onto a rigid plane."""
    ball = vs.Sphere(radius=SPHERE * mm, center=(0, 0, SPHERE * mm))
    quarter = box((0, 0, 0), (SPHERE, SPHERE, SPHERE))
    plane = box((-5, -5, -5), (SPHERE + 15, SPHERE + 15, 0))
    return vs.Design(
        name="sphere-on-plane",
        voxel_size=voxel * mm,
        fill="fraction" if cut else "binary",
        parts=[vs.Part(shape=ball & quarter, material=rubber(poisson))],
        clamps=[moved("z", (0, 0, -depth), z=(SPHERE, SPHERE)), *symmetry("xy")],
        objects=[Object(name="plane", shape=plane)],
        contact=Contact(pairs=(APART,)),
    )


def ball_into_block(
    voxel: float, depth: float, poisson: float = 0.45, friction: float = 0.0
) -> vs.Design:
    """A quarter of a block that stands on the ground; a rigid ball moves into it by `depth`."""
    block = vs.Cylinder(radius=BLOCK * mm, height=BLOCK * mm)
    ball = vs.Sphere(radius=BALL * mm, center=(0, 0, (BLOCK + BALL) * mm))
    down = vs.Motion(displacement=(0, 0, -depth * mm))
    quarter = box((0, 0, 0), (BLOCK, BLOCK, BLOCK))
    return vs.Design(
        name="ball-into-block",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=block & quarter, material=rubber(poisson))],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0))), *symmetry("xy")],
        objects=[Object(name="ball", shape=ball, motion=down)],
        contact=Contact(friction=friction, pairs=(APART,)),
    )


def two_blocks(voxel: float, press: float, friction: float = 0.0) -> vs.Design:
    """Half of a block on a wider one. The gap of one voxel between them is added to `press`."""
    top = 2 * LAYER + voxel
    lower = box((0, 0, 0), (LOWER / 2, voxel, LAYER))
    upper = box((0, 0, LAYER + voxel), (UPPER / 2, voxel, top))
    corners = {"lower": (LOWER / 2, LAYER), "upper": (UPPER / 2, LAYER + voxel)}
    return vs.Design(
        name="two-blocks",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=lower | upper, material=rubber())],
        clamps=[
            vs.Clamp(region=vs.Region(z=(0, 0)), axes="xz"),
            moved("xz", (0, 0, -press - voxel), z=(top, top)),
            *symmetry("x"),
            vs.Clamp(region=EVERYWHERE, axes="y"),
        ],
        probes={
            name: vs.Probe(point=(x * mm, voxel / 2 * mm, z * mm))
            for name, (x, z) in corners.items()
        },
        contact=Contact(friction=friction),
    )


def bellows(voxel: float, pressure: float, *, touching: bool = True) -> vs.Design:
    """Two chambers whose facing walls meet under a pressure in kPa, held at one end."""
    body = box((0, 0, 0), (30, voxel, 25)) - box((14, 0, 3), (16, voxel, 25))
    chambers = [((2, 0, 3), (12, voxel, 23)), ((18, 0, 3), (28, voxel, 23))]
    for low, high in chambers:
        body = body - box(low, high)
    regions = [
        vs.Region(x=(low[0] * mm, high[0] * mm), z=(low[2] * mm, high[2] * mm))
        for low, high in chambers
    ]
    places = {"tip": (30, 0), "top": (7, 25), "outer": (0, 13)}
    return vs.Design(
        name="bellows",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=body, material=rubber())],
        clamps=[
            vs.Clamp(region=vs.Region(x=(0, 0), z=(0, 3 * mm)), axes="xz"),
            vs.Clamp(region=EVERYWHERE, axes="y"),
        ],
        loads=[vs.Traction(region=region, value=pressure * kPa) for region in regions],
        probes={
            name: vs.Probe(point=(x * mm, voxel / 2 * mm, z * mm))
            for name, (x, z) in places.items()
        },
        contact=Contact() if touching else None,
        solver={"method": "statics"},
    )


def mismatched_blocks(
    below: int, above: int, squeeze: float = 0.1
) -> tuple[vs.Design, float, float]:
    """Blocks of `below` and `above` voxels across, brought to one width and pressed together.

    Both states are uniform, and in one grid no voxel of one block faces one of the other.

    Returns
    -------
    design, force, stress
        With the exact force between them in N and the exact stress along z in Pa.
    """
    from scipy.optimize import brentq

    voxel, height = 4.0, 8.0
    width = voxel * (below + above) / 2
    floor = height + voxel
    wide = {0.0: voxel * below, floor: voxel * above}
    clamps = []
    for low, side in wide.items():
        for axis in "xy":
            way = (width - side if axis == "x" else 0.0, width - side if axis == "y" else 0.0, 0.0)
            around = {"z": (low, low + height)}
            clamps.append(moved(axis, (0, 0, 0), **around, **{axis: (0, 0)}))
            clamps.append(moved(axis, way, **around, **{axis: (side, side)}))
    top, total = floor + height, 2 * height * (1 - squeeze)
    clamps.append(moved("z", (0, 0, 0), z=(0, 0)))
    clamps.append(moved("z", (0, 0, total - top), z=(top, top)))
    blocks = [box((0, 0, low), (side, side, low + height)) for low, side in wide.items()]
    design = vs.Design(
        name="mismatched-blocks",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=blocks[0] | blocks[1], material=rubber())],
        clamps=clamps,
        contact=Contact(),
    )
    across = [width / side for side in wide.values()]

    def difference(along: float) -> float:
        rest = total / height - along
        return uniform_stress(across[0], along) - uniform_stress(across[1], rest)

    stress = uniform_stress(across[0], brentq(difference, 0.5, total / height - 0.5))
    return design, -stress * (width * mm) ** 2, stress


def uniform_stress(across: float, along: float, poisson: float = 0.45) -> float:
    """The Cauchy stress along z of a stretch `along`, with the stretch `across` it in Pa."""
    shear = YOUNG / 2 / (1 + poisson)
    bulk = YOUNG / 3 / (1 - 2 * poisson)
    volume = across**2 * along
    deviator = (along**2 - across**2) * 2 / 3
    return float(shear * volume ** (-5 / 3) * deviator + bulk * (volume - 1))


def block_under_plate(voxel: float, press: float, plate_voxel: float) -> tuple[vs.Design, float]:
    """A block of 12 mm held at its sides under a rigid plate of other facets, and its stress."""
    side = 12.0
    walls = [
        vs.Clamp(region=vs.Region(**{axis: (at * mm, at * mm)}), axes=axis)
        for axis in "xy"
        for at in (0.0, side)
    ]
    # The plate's grid is off by a part of a voxel.
    plate = box((-4.3, -3.1, side), (side + 4.1, side + 5.2, side + 5))
    down = vs.Motion(displacement=(0, 0, -press * mm))
    design = vs.Design(
        name="block-under-plate",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=box((0, 0, 0), (side, side, side)), material=rubber())],
        clamps=[moved("z", (0, 0, 0), z=(0, 0)), *walls],
        objects=[Object(name="plate", shape=plate, motion=down, voxel_size=plate_voxel * mm)],
        contact=Contact(pairs=(APART,)),
    )
    return design, uniform_stress(1.0, 1 - press / side)


def stress_error(result: vs.Result, stress: float) -> float:
    """The largest error of the stress along z of a voxel, over a uniform stress."""
    return float(np.abs(result.fields.stress[:, 2] / stress - 1.0).max())
