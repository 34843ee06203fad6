"""The bodies of `squeeze.py`, and their verdicts: random shapes of rubber between rigid plates.

A body is the first shape that the grammar of the property tests draws from a seed and that makes
one component of so many voxels without hinges (where voxels share an edge only, the unloaded
surface touches itself). It stands on the lower plate, held by the vertices of its lowest faces as
if they were glued to it: what stands on a point alone would tip over whatever a solver does. The
upper plate comes down by half of the body's height. Everything touches with Coulomb friction: the
body itself and both plates.

What came out is judged by three that share no line: whether it is made of numbers, and which faces
of the smooth surface of the body and of the plates pass through each other, by the exact
predicates of ``voxsoft._core.penetration`` and by ``ipctk``, at every point of the load path.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from crossing_faces import Faces

import voxsoft as vs
from voxsoft.design import Contact, Object
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.errors import ShapeError, VoxSoftError
from voxsoft.shapes import Shape, random_shape, voxelize
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.skin import skin_of
from voxsoft.units import kPa, mm

#: Shapes lie in a cube of this half edge [m], divided into so many voxels along an edge.
EXTENT = 20 * mm
ACROSS = (7, 14)
#: How many voxels a body has, and how many it is high at least.
VOXELS, HIGH = (60, 300), 4
FRICTION = 0.5
#: Of the height that is left.
LEFT = 0.5
#: Between the unloaded body and the plates, in voxels.
AWAY = 0.01
RUBBER = vs.NeoHookean(young=100 * kPa, poisson=0.45)


def shape_of(seed: int, voxels: tuple[int, int] = VOXELS) -> tuple[Shape, float]:
    """The first shape of a seed that makes a body, and its voxel size in m."""
    rng = np.random.default_rng(seed)
    while True:
        shape = random_shape(rng, size=EXTENT)
        size = 2 * EXTENT / int(rng.integers(*ACROSS))
        try:
            grid = voxelize(shape, size)
        except ShapeError:  # encloses nothing
            continue
        if not voxels[0] <= grid.count <= voxels[1]:
            continue
        (body, *others) = grid.components()
        high = np.ptp(body.bounds[:, 2]) / size
        if not others and not grid.hinges and high > HIGH - 0.5:
            return shape, size


def squeezed(seed: int, voxels: tuple[int, int] = VOXELS) -> vs.Design:
    """The body of a seed between its plates, of full voxels."""
    shape, size = shape_of(seed, voxels)
    clamp = vs.Clamp(region=vs.Region(z=("-inf", 0)))
    part = vs.Part(shape=shape, material=RUBBER)
    alone = vs.Design(
        name=f"squeeze-{seed}", voxel_size=size, fill="binary", parts=[part], clamps=[clamp]
    )
    mesh = mesh_of(alone)
    skin = skin_of(alone, mesh)
    assert skin is not None  # of a mesh whose voxels are those of the shape
    low, high = skin.points.min(axis=0), skin.points.max(axis=0)
    bottom = float(mesh.vertices[:, 2].min())
    height = float(high[2] - low[2])
    # What bulges or buckles moves to the side.
    wide = high - low + 1.5 * height
    middle = (low + high) / 2.0

    def plate(name: str, from_z: float, to_z: float, down: float | None) -> Object:
        box = vs.Box(
            size=(wide[0], wide[1], to_z - from_z),
            center=(middle[0], middle[1], (from_z + to_z) / 2.0),
        )
        motion = "fixed" if down is None else vs.Motion(displacement=(0, 0, -down))
        return Object(name=name, shape=box, motion=motion, voxel_size=3.0 * size)

    thick, away = 4.0 * size, AWAY * size
    below, above = float(low[2]) - away, float(high[2]) + away
    down = height * (1.0 - LEFT) + away
    return alone.replace(
        clamps=[vs.Clamp(region=vs.Region(z=(bottom, bottom)))],
        objects=[
            plate("below", below - thick, below, None),
            plate("above", above, above + thick, down),
        ],
        contact=Contact(friction=FRICTION),
    )


@dataclass(frozen=True)
class Verdict:
    """How the squeeze of one body ended.

    Attributes
    ----------
    seed, voxels
        Which body.
    kind
        One of :data:`KINDS`.
    reached
        The part of the way that lies behind.
    message
        What the solver says, or the exception.
    seconds
        Processor time of the solution.
    iterations
        Of Newton's method.
    pairs, plates, folds, depth
        The most pairs of faces that pass through each other at any point of the path: that contact
        must keep apart, those of them with a plate, and folds; how deep any are at least, in
        voxels.
    crossing_points, points
        How many points of the path have any, and how many there are.
    disagreements
        Points at which the two judges say different things.
    stable
        Whether the last equilibrium is stable.
    """

    seed: int
    voxels: int = 0
    kind: str = "exception"
    reached: float = 0.0
    message: str = ""
    seconds: float = 0.0
    iterations: int = 0
    pairs: int = 0
    plates: int = 0
    folds: int = 0
    depth: float = 0.0
    crossing_points: int = 0
    points: int = 0
    disagreements: int = 0
    stable: bool = True


#: How a squeeze may end, the worst first. Only the last two are no failures. Folded is where faces
#: pass through each other that are less than `crossing_faces.FOLD` voxels apart when unloaded.
KINDS = (
    "penetrates, called at rest",
    "penetrates, ends early",
    "judges disagree",
    "no numbers",
    "time limit",
    "exception",
    "ends early",
    "at half its height, folded",
    "at half its height, not stable",
    "at half its height",
)
GOOD = KINDS[-2:]


def judged(seed: int, voxels: tuple[int, int] = VOXELS) -> Verdict:
    """Squeeze the body of a seed, and judge what comes out."""
    try:
        setup = Setup.of(squeezed(seed, voxels))
        started = time.process_time()
        result = vs.simulate(setup, frames=True)
        seconds = time.process_time() - started
    except VoxSoftError as error:
        return Verdict(seed, message=f"{type(error).__name__}: {error}")
    faces = Faces(setup)
    states = [*zip(result.recording.frames, result.recording.times, strict=True)]
    states.append((result.positions, result.load_factor))
    common: dict[str, Any] = {
        "seed": seed,
        "voxels": len(setup.mesh.tets) // 5,
        "reached": result.load_factor,
        "message": result.message,
        "seconds": seconds,
        "iterations": result.steps,
        "points": len(states),
        "stable": result.stable is not False,
    }
    if not all(np.isfinite(positions).all() for positions, _ in states):
        return Verdict(kind="no numbers", **common)
    pairs, plates, folds, depth, crossing, disagreements = 0, 0, 0, 0.0, 0, 0
    for positions, factor in states:
        points = faces.at(positions, factor)
        met, of_plates, folded, deep = faces.crossings(points)
        crossing += met + folded > 0
        disagreements += (met + folded > 0) != faces.crosses_by_ipctk(points)
        pairs, plates = max(pairs, met), max(plates, of_plates)
        folds, depth = max(folds, folded), max(depth, deep)
    common |= {
        "pairs": pairs,
        "plates": plates,
        "folds": folds,
        "depth": depth / setup.design.voxel_size,
        "crossing_points": crossing,
        "disagreements": disagreements,
    }
    ended = result.status == "ok" and result.load_factor == 1.0
    if pairs:
        return Verdict(kind=KINDS[0] if ended else KINDS[1], **common)
    if disagreements:
        return Verdict(kind="judges disagree", **common)
    if not ended:
        return Verdict(kind="ends early", **common)
    if folds:
        return Verdict(kind="at half its height, folded", **common)
    return Verdict(kind=GOOD[1] if common["stable"] else GOOD[0], **common)
