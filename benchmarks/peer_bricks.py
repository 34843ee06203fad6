"""VoxSoft and the codes with bricks: CalculiX and scikit-fem, each at its best.

CalculiX gets the voxels of the beam and the bar as bricks, and the sphere as bricks that are fitted
to it; both it and scikit-fem get an eighth of the sphere, as VoxSoft does.
"""

from __future__ import annotations

import resource
import statistics
import time
from collections.abc import Callable
from typing import Final

import numpy as np
import peer_bodies
from peer_bodies import BAR, BEAM, PRESSURE, SPHERE, rubber, to_sphere

import voxsoft as vs
from voxsoft.comparison.bricks import FACES, BrickModel, FacePressure
from voxsoft.comparison.calculix_deck import NODES_OF, Element
from voxsoft.comparison.outside import OutsideAnswer
from voxsoft.errors import OutsideCodeError
from voxsoft.files.calculix import run_calculix
from voxsoft.simulation import Setup

#: Residual of statics that keeps the number within 1 % (checked in every run).
LOOSE: Final = 1e-3
REACHED: Final = 1e-2
REPEATS: Final = 5
#: Elements of CalculiX, and the wall-clock seconds that each of its runs may take.
ELEMENTS: Final[tuple[Element, ...]] = ("C3D8R", "C3D8I", "C3D20R")
PATIENCE: Final = 90.0

DESIGNS: Final[dict[str, Callable[[int], vs.Design]]] = {
    BEAM.name: peer_bodies.beam,
    BAR.name: peer_bodies.twisted_bar,
    SPHERE.name: peer_bodies.thick_sphere,
}
#: The middles of the edges of a brick, by the corners at their ends, as CalculiX counts them.
_EDGES: Final = np.array(
    [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)


def voxsoft_number(result: vs.Result) -> np.ndarray:
    """What is looked at, of a result."""
    if result.design.name == BEAM.name:
        return np.asarray(result.probes["tip"])
    if result.design.name == SPHERE.name:
        return np.array([float(result.metric("cavity_volume_change"))])
    far = result.mesh.vertices[:, 0] > peer_bodies.BAR_LENGTH - 1e-9
    return peer_bodies.torque(result.positions[far], result.reactions[far])


def voxsoft(body: str, across: int) -> tuple[float, np.ndarray]:
    """Processor seconds of statics to within 1 % of the number at rest, and that number."""
    setup = Setup.of(DESIGNS[body](across))
    _ = setup.problem, setup.places
    own = voxsoft_number(vs.simulate(setup, method="statics"))
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        near = voxsoft_number(vs.simulate(setup, method="statics", tolerance=LOOSE))
        times.append(time.process_time() - start)
        if not np.linalg.norm(near - own) < REACHED * np.linalg.norm(own):
            raise SystemExit(f"wrong answer: {body}, a loose tolerance misses by more than 1 %")
    return statistics.median(times), own


def calculix(body: str, across: int, element: Element) -> tuple[float, np.ndarray]:
    """Processor seconds of CalculiX's process, and the number.

    Raises
    ------
    OutsideCodeError
        It gave up, or took longer than the limit.
    """
    model = _fitted(across, element) if body == SPHERE.name else _voxels(body, across, element)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    answer = run_calculix(model, element=element, time_limit=PATIENCE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if answer.status != "ok":
        raise OutsideCodeError("CalculiX", answer.message, "use other elements")
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, _calculix_number(body, across, model, answer)


def _voxels(body: str, across: int, element: Element) -> BrickModel:
    return BrickModel.of(Setup.of(DESIGNS[body](across)), split=1, nodes=NODES_OF[element])


def _fitted(wall: int, element: Element) -> BrickModel:
    """Bricks that follow an eighth of the sphere, as many along an edge as through the wall."""
    points, bricks = peer_bodies.cube_shell(wall, wall)
    if NODES_OF[element] == 20:
        middles = points[bricks[:, _EDGES]].mean(axis=2).reshape(-1, 3)
        keys = np.rint(middles / 1e-9).astype(np.int64)
        _, kept, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        edges = len(points) + number.reshape(len(bricks), 12)
        points, bricks = np.concatenate((points, middles[kept])), np.hstack((bricks, edges))
    inside = np.isclose(points[bricks[:, list(FACES[0])]].max(axis=2), peer_bodies.INNER)
    faces = np.flatnonzero(inside.all(axis=1))
    load = FacePressure(np.column_stack((faces, np.zeros_like(faces))), PRESSURE)
    nodes = to_sphere(points)
    return BrickModel(
        nodes=nodes,
        bricks=bricks,
        parts=np.zeros(len(bricks), dtype=np.int64),
        materials=(rubber(),),
        fixed=np.abs(nodes) < 1e-9,
        values=np.zeros_like(nodes),
        forces=np.zeros_like(nodes),
        gravity=np.zeros(3),
        pressures=(load,),
        vertex_nodes=np.arange(len(nodes)),
        clamp_nodes=(),
        edge=(peer_bodies.OUTER - peer_bodies.INNER) / wall,
        split=1,
    )


def _calculix_number(
    body: str, across: int, model: BrickModel, answer: OutsideAnswer
) -> np.ndarray:
    if body == SPHERE.name:
        faces = model.face_nodes(model.pressures[0].faces)
        moved = model.nodes + answer.displacements
        return 8 * np.array([_room(moved[faces]) - _room(model.nodes[faces])])
    if body == BEAM.name:
        place = Setup.of(peer_bodies.beam(across)).places["tip"]
        return np.asarray(place.weights @ answer.displacements[place.vertices])
    rest = model.nodes[answer.held]
    far = rest[:, 0] > peer_bodies.BAR_LENGTH - 1e-9
    return peer_bodies.torque(rest[far] + model.values[answer.held][far], answer.reactions[far])


def _room(faces: np.ndarray) -> float:
    """Volume under faces (f, 4 or 8, 3) seen from the origin: a third of the flux of the place."""
    nodes = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)])
    own = nodes[: faces.shape[1]]
    spots, weights = np.polynomial.legendre.leggauss(3)
    volume = 0.0
    for x, wx in zip(spots, weights, strict=True):
        for y, wy in zip(spots, weights, strict=True):
            shapes = _shapes(own, x, y)
            # Central differences of a step of 1 are exact for polynomials of degree two.
            by_x = (_shapes(own, x + 1, y) - _shapes(own, x - 1, y)) / 2
            by_y = (_shapes(own, x, y + 1) - _shapes(own, x, y - 1)) / 2
            place, along, across = (np.einsum("a,fai->fi", s, faces) for s in (shapes, by_x, by_y))
            volume += wx * wy * float(np.einsum("fi,fi->", place, np.cross(along, across))) / 3
    return abs(volume)


def _shapes(nodes: np.ndarray, x: float, y: float) -> np.ndarray:
    """Shape functions of a face of 4 or 8 nodes at a point of the square."""
    across = 1 + x * nodes[:, 0], 1 + y * nodes[:, 1]
    if len(nodes) == 4:
        return across[0] * across[1] / 4
    corners = across[0] * across[1] * (x * nodes[:, 0] + y * nodes[:, 1] - 1) / 4
    on_x = (1 - x**2) * across[1] / 2
    on_y = (1 - y**2) * across[0] / 2
    return np.where(nodes[:, 0] == 0, on_x, np.where(nodes[:, 1] == 0, on_y, corners))


SCIKIT_FEM_BODIES: Final = {
    BEAM.name: "beam",
    BAR.name: "twisted_bar",
    SPHERE.name: "thick_sphere",
}


def scikit_fem(body: str, across: int) -> tuple[float, np.ndarray]:
    """Processor seconds of a solver with scikit-fem to 1e-3 of the forces, and the number."""
    import peer_scikit_fem

    problem = getattr(peer_scikit_fem, SCIKIT_FEM_BODIES[body])(across)
    number, seconds = peer_scikit_fem.solve(problem, LOOSE)
    return seconds, number
