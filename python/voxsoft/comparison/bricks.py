"""The voxels of a design as bricks of an ordinary finite-element code, whole or split.

A voxel split ``r`` times along each axis gives ``r³`` bricks. Clamps, loads and cavities are taken
from the mesh of whole voxels, so that every split solves the same mechanical problem: a node of
the split grid is held where all corners of the edge, face or voxel that it lies on are held.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product
from typing import Final, Literal, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.comparison.brick_contact import BrickContact, facing_walls, floor_under, tools_of
from voxsoft.comparison.brick_layers import BrickLayer
from voxsoft.comparison.brick_loads import BrickLoad, BrickMotion, FacePressure, prescribed
from voxsoft.design import Clamp
from voxsoft.errors import SimulationError
from voxsoft.materials import Material
from voxsoft.mesh import Mesh
from voxsoft.simulation import Setup
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.loads import LoadReceiver

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Nodes of a brick: corners; with midpoints of edges; with those of faces and of the brick too.
NodeCount = Literal[8, 20, 27]

#: Corners of a brick in units of its edge: bottom counter-clockwise, then top.
CORNERS: Final = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
_EDGES: Final = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
]
#: Corners of each face in the numbering of Abaqus and CalculiX, F1 to F6.
FACES: Final = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
#: The face whose outward normal points along an axis: (axis, whether along it) → index in FACES.
_FACE_OF: Final = {
    (2, False): 0,
    (2, True): 1,
    (1, False): 2,
    (0, True): 3,
    (1, True): 4,
    (0, False): 5,
}
#: Nodes of a brick in half edges, in the order of CalculiX's C3D20, then faces and center.
_HALVES: Final = np.concatenate(
    [
        2 * CORNERS,
        [CORNERS[a] + CORNERS[b] for a, b in _EDGES],
        [CORNERS[list(face)].sum(axis=0) // 2 for face in FACES],
        [(1, 1, 1)],
    ]
)


@dataclass(frozen=True, eq=False)
class BrickModel:
    """Mechanical problem on bricks, as an outside code takes it.

    Attributes
    ----------
    nodes
        Positions in m, (n, 3).
    bricks
        Node indices, (m, k) with k = 8, 20 or 27.
    parts, materials
        The part of each brick (m,), counted from 0, and the material of each part.
    fixed, values
        Mask of the prescribed components, (n, 3), and their displacement in m.
    forces
        Dead forces in N, (n, 3); weight is not among them.
    gravity
        Acceleration in m/s², (3,).
    pressures
        Pressures on faces.
    vertex_nodes
        Node at each vertex of the voxel mesh.
    clamp_nodes
        Nodes that each clamp holds.
    edge
        Edge of a brick in m.
    split
        Bricks along each edge of a voxel.
    contact
        Surfaces in contact, if there are any.
    layers
        Membranes on faces.
    loads, motions
        Each load and clamp of the design with its history, of which `gravity`, `forces`,
        `pressures`, `fixed` and `values` are the last state.
    """

    nodes: Floats = field(repr=False)
    bricks: Ints = field(repr=False)
    parts: Ints = field(repr=False)
    materials: tuple[Material, ...]
    fixed: NDArray[np.bool_] = field(repr=False)
    values: Floats = field(repr=False)
    forces: Floats = field(repr=False)
    gravity: Floats
    pressures: tuple[FacePressure, ...] = field(repr=False)
    vertex_nodes: Ints = field(repr=False)
    clamp_nodes: tuple[Ints, ...] = field(repr=False)
    edge: float
    split: int
    contact: BrickContact | None = field(default=None, repr=False)
    layers: tuple[BrickLayer, ...] = field(default=(), repr=False)
    loads: tuple[BrickLoad, ...] = field(default=(), repr=False)
    motions: tuple[BrickMotion, ...] = field(default=(), repr=False)

    @classmethod
    def of(cls, setup: Setup, *, split: int = 1, nodes: NodeCount = 20) -> Self:
        """Make bricks of the voxels of a design.

        Parameters
        ----------
        setup
            A design made ready, with a mesh made of voxels.
        split
            Bricks along each edge of a voxel, at least 1.
        nodes
            Nodes of a brick: 8, 20 or 27.

        Raises
        ------
        SimulationError
            A mesh that is not made of full voxels, or a feature unknown to outside codes:
            layers that seal, springs, fibers, activations, objects that are free or turn, bonds.

        Examples
        --------
        >>> from voxsoft.design import families
        >>> BrickModel.of(Setup.of(families.beam()), nodes=8).bricks.shape
        (80, 8)
        >>> BrickModel.of(Setup.of(families.beam()), split=2).bricks.shape
        (640, 20)
        """
        refuse(setup.design, "outside codes")
        grid = _Lattice.of(setup)
        cells = _split_cells(grid.cells, split)
        keys = 2 * cells[:, None, :] + _HALVES[:nodes]
        found, bricks = np.unique(_flat(keys.reshape(-1, 3), grid.span, split), return_inverse=True)
        places = _unflat(found, grid.span, split)
        size = grid.size / split
        model = cls(
            nodes=grid.origin + places * (size / 2),
            bricks=bricks.reshape(len(cells), nodes).astype(np.int64),
            parts=np.repeat(grid.parts, split**3),
            materials=tuple(setup.materials),
            fixed=np.zeros((len(places), 3), dtype=bool),
            values=np.zeros((len(places), 3)),
            forces=np.zeros((len(places), 3)),
            gravity=np.zeros(3),
            pressures=(),
            vertex_nodes=np.searchsorted(
                found, _flat(2 * split * grid.vertices, grid.span, split)
            ).astype(np.int64),
            clamp_nodes=(),
            edge=size,
            split=split,
        )
        spread = _Spread(grid, places, split)
        loaded = model._with_clamps(setup, spread)._with_loads(setup, grid, spread)
        return loaded._with_layers(setup, grid)._with_contact(setup, grid)

    @cached_property
    def volumes(self) -> Floats:
        """Volume of each brick in m³, (m,)."""
        return np.full(len(self.bricks), self.edge**3)

    @cached_property
    def masses(self) -> Floats:
        """Mass at each node in kg, consistent with the shape functions, (n,)."""
        shares = {
            8: np.full(8, 1 / 8),
            20: np.repeat([-1 / 8, 1 / 6], [8, 12]),
            27: np.repeat([1 / 216, 4 / 216, 16 / 216, 64 / 216], [8, 12, 6, 1]),
        }[self.bricks.shape[1]]
        density = np.array([material.density for material in self.materials])[self.parts]
        mass = np.zeros(len(self.nodes))
        np.add.at(mass, self.bricks, (density * self.volumes)[:, None] * shares)
        for layer in self.layers:
            nodes = self.face_nodes(layer.faces)
            one = layer.density * layer.thickness * self.edge**2
            np.add.at(mass, nodes, np.tile(one * self.face_shares, (len(nodes), 1)))
        return mass

    @cached_property
    def weights(self) -> Floats:
        """Weight at each node in N, (n, 3)."""
        return np.outer(self.masses, self.gravity)

    def _with_clamps(self, setup: Setup, spread: _Spread) -> Self:
        fixed, values = self.fixed.copy(), self.values.copy()
        motions: list[BrickMotion] = []
        for clamp, vertices in zip(setup.design.clamps, setup.clamped, strict=True):
            held = spread.where_all(vertices)
            columns = tuple("xyz".index(axis) for axis in clamp.axes)

            def spread_out(factor: float | None, clamp: Clamp = clamp, held: Ints = held) -> Floats:
                moved = prescribed(clamp, setup.mesh.vertices, factor)
                return np.column_stack([spread.interpolate(row, held) for row in moved.T])

            last = spread_out(None)
            for column in columns:
                fixed[held, column] = True
                values[held, column] = last[:, column]
            motion = clamp.motion
            history = None if motion is None else motion.history
            turns = motion is not None and motion.rotation is not None
            full = last if history is None else spread_out(1.0)
            motions.append(BrickMotion(len(motions), held, columns, full, history, turns))
        nodes = tuple(each.nodes for each in motions)
        return replace(self, fixed=fixed, values=values, clamp_nodes=nodes, motions=tuple(motions))

    def _with_loads(self, setup: Setup, grid: _Lattice, spread: _Spread) -> Self:
        loads: list[BrickLoad] = []
        forces, gravity = self.forces.copy(), self.gravity.copy()
        pressures: list[FacePressure] = []
        for load in setup.loads:
            taken = _BrickLoads(setup.mesh, self, grid, spread)
            for action in load.actions:
                action.give_to(taken)
            factor = load.reading.final_factor
            gravity += factor * taken.gravity
            forces += factor * taken.dead
            pressures += [replace(each, value=factor * each.value) for each in taken.pressures]
            own = tuple(taken.pressures)
            loads.append(
                BrickLoad(len(loads), load.reading.history, taken.gravity, taken.dead, own)
            )
        return replace(
            self, forces=forces, gravity=gravity, pressures=tuple(pressures), loads=tuple(loads)
        )

    def _with_layers(self, setup: Setup, grid: _Lattice) -> Self:
        found = zip(setup.design.layers, setup.layers, strict=True)
        layers = [
            BrickLayer.of(number, layer, grid.faces_under(triangles.bonded, self.split))
            for number, (layer, triangles) in enumerate(found)
        ]
        return replace(self, layers=tuple(layers))

    def _with_contact(self, setup: Setup, grid: _Lattice) -> Self:
        touching = setup.touching
        tools = floor_under(setup) if touching is None else tools_of(touching)
        if touching is None and not tools:
            return self
        friction = np.nan if touching is None else float(touching.friction[0, 0])
        faces, walls = facing_walls(grid.cells)
        pairs = () if np.isnan(friction) else walls
        contact = BrickContact(
            outer=split_faces(faces, self.split),
            walls=tuple((split_faces(a, self.split), split_faces(b, self.split)) for a, b in pairs),
            friction=friction,
            tools=tools,
        )
        return replace(self, contact=contact)

    def face_nodes(self, faces: Ints) -> Ints:
        """Nodes of faces (f, 4, 8 or 9): corners, then middles of edges, then center."""
        count = {8: 4, 20: 8, 27: 9}[self.bricks.shape[1]]
        return self.bricks[faces[:, :1], _FACE_NODES[faces[:, 1], :count]]

    @property
    def face_shares(self) -> Floats:
        """Share of each node of a face in an even load, in the order of :meth:`face_nodes`."""
        return {
            8: np.full(4, 1 / 4),
            20: np.repeat([-1 / 12, 1 / 3], [4, 4]),
            27: np.repeat([1 / 36, 4 / 36, 16 / 36], [4, 4, 1]),
        }[self.bricks.shape[1]]


def _face_nodes() -> Ints:
    """Nodes of each face of a 27-node brick: corners in turn, edges in turn, center."""
    number = {tuple(half): index for index, half in enumerate(_HALVES.tolist())}
    rows = []
    for face in FACES:
        corners = 2 * CORNERS[list(face)]
        edges = (corners + np.roll(corners, -1, axis=0)) // 2
        row = [*corners, *edges, corners.sum(axis=0) // 4]
        rows.append([number[tuple(each.tolist())] for each in row])
    return np.array(rows)


_FACE_NODES: Final = _face_nodes()


@dataclass(frozen=True, eq=False)
class _Lattice:
    """Voxels and vertices on the integer grid of a mesh."""

    origin: Floats
    size: float
    span: Ints
    vertices: Ints
    cells: Ints
    parts: Ints

    @classmethod
    def of(cls, setup: Setup) -> Self:
        mesh = setup.mesh
        if mesh.voxel_size is None:
            raise SimulationError(
                "mesh", "is not made of voxels", "compare designs, or solids sampled as voxels"
            )
        origin = mesh.vertices.min(axis=0)
        vertices = np.rint((mesh.vertices - origin) / mesh.voxel_size).astype(np.int64)
        cells = vertices[mesh.tets].reshape(-1, 20, 3).min(axis=1)
        parts = mesh.tet_part[::5].astype(np.int64) - 1
        return cls(origin, mesh.voxel_size, vertices.max(axis=0), vertices, cells, parts)

    def faces_under(self, triangles: NDArray[np.integer], split: int) -> Ints:
        """Rows (brick, face) of the faces that triangles of the surface cover."""
        corners = self.vertices[triangles]
        low = corners.min(axis=1)
        axis = np.argmin(np.ptp(corners, axis=1), axis=1)
        sides = corners[:, 1:] - corners[:, :1]
        normal = np.cross(sides[:, 0], sides[:, 1])
        along = np.take_along_axis(normal, axis[:, None], axis=1)[:, 0] > 0
        cell = low - np.eye(3, dtype=np.int64)[axis] * along[:, None]
        number = {tuple(each): index for index, each in enumerate(self.cells.tolist())}
        voxels = np.array([number[tuple(each)] for each in cell.tolist()], dtype=np.int64)
        faces = np.column_stack((voxels, axis, along))
        return split_faces(np.unique(faces, axis=0), split)


class _Spread:
    """Transfer of flags and forces from vertices of voxels to nodes of the split grid."""

    def __init__(self, grid: _Lattice, places: Ints, split: int) -> None:
        self._count = len(places)
        unit = 2 * split
        number = np.full(grid.span + 1, -1)
        number[tuple(grid.vertices.T)] = np.arange(len(grid.vertices))
        low, fraction = np.divmod(places, unit)
        self._corners = np.full((self._count, 8), -1)
        self._weights = np.zeros((self._count, 8))
        for column, steps in enumerate(product((0, 1), repeat=3)):
            step = np.array(steps)
            weight = np.where(step, fraction / unit, 1 - fraction / unit).prod(axis=1)
            used = weight > 0
            self._corners[used, column] = number[tuple((low[used] + step).T)]
            self._weights[:, column] = weight

    def where_all(self, vertices: Iterable[int] | NDArray[np.integer]) -> Ints:
        """Nodes for which all corners of the edge, face or voxel around them are in a set."""
        inside = np.zeros(self._corners.max() + 2, dtype=bool)
        inside[np.asarray(vertices, dtype=np.int64)] = True
        return np.flatnonzero((inside[self._corners] | (self._weights == 0)).all(axis=1))

    def interpolate(self, values: Floats, nodes: Ints) -> Floats:
        """Interpolate values at vertices to nodes, trilinearly."""
        filled: Floats = (self._weights[nodes] * values[self._corners[nodes]]).sum(axis=1)
        return filled

    def share(self, vertices: NDArray[np.integer], total: Floats) -> Floats:
        """Spread a force shared by vertices over the edges, faces and voxels that they span."""
        nodes = self.where_all(vertices)
        corners, weights = self._corners[nodes], self._weights[nodes]
        sums = np.zeros(self._corners.max() + 2)
        np.add.at(sums, corners, weights)
        shares = (weights / np.where(sums > 0, sums, 1.0)[corners]).sum(axis=1) / len(vertices)
        forces = np.zeros((self._count, 3))
        forces[nodes] = np.outer(shares, total)
        return forces


class _BrickLoads(LoadReceiver):
    """Loads on bricks; forces are shared by the shape functions of the nodes."""

    def __init__(self, mesh: Mesh, bricks: BrickModel, grid: _Lattice, spread: _Spread) -> None:
        super().__init__(mesh)
        self._bricks, self._grid, self._spread = bricks, grid, spread
        self.gravity = np.zeros(3)
        self.dead = np.zeros_like(bricks.nodes)
        self.pressures: list[FacePressure] = []

    def acceleration(self, acceleration: Floats) -> None:
        self.gravity += acceleration

    def pressure(
        self, triangles: NDArray[np.int32], value: float, cavity: MeshCavity | None
    ) -> None:
        faces = self._grid.faces_under(triangles, self._bricks.split)
        self.pressures.append(FacePressure(faces, value))

    def forces(self, vertices: NDArray[np.uint32], forces: Floats) -> None:
        np.add.at(self.dead, self._bricks.vertex_nodes[vertices], forces)

    def shared_force(self, vertices: NDArray[np.uint32], total: Floats) -> None:
        self.dead += self._spread.share(vertices, total)

    def traction(self, triangles: NDArray[np.int32], stress: Floats) -> None:
        bricks = self._bricks
        nodes = bricks.face_nodes(self._grid.faces_under(triangles, bricks.split))
        area = np.zeros(len(bricks.nodes))
        np.add.at(area, nodes, np.tile(bricks.edge**2 * bricks.face_shares, (len(nodes), 1)))
        self.dead += np.outer(area, stress)


def split_faces(faces: Ints, split: int) -> Ints:
    """Split faces of voxels, rows (voxel, axis, 1 if it looks along), into rows (brick, face)."""
    fine = np.arange(split**3).reshape(split, split, split)
    rows: list[tuple[int, int]] = []
    for voxel, axis, up in faces.tolist():
        layer = np.take(fine, split - 1 if up else 0, axis=axis).ravel()
        face = _FACE_OF[axis, bool(up)]
        rows.extend((voxel * split**3 + brick, face) for brick in layer.tolist())
    return np.array(rows, dtype=np.int64).reshape(-1, 2)


def _split_cells(cells: Ints, split: int) -> Ints:
    inner = np.array(list(product(range(split), repeat=3)))
    fine: Ints = (cells[:, None, :] * split + inner).reshape(-1, 3)
    return fine


def _flat(keys: Ints, span: Ints, split: int) -> Ints:
    counts = 2 * split * span + 1
    flat: Ints = (keys[:, 0] * counts[1] + keys[:, 1]) * counts[2] + keys[:, 2]
    return flat


def _unflat(flat: Ints, span: Ints, split: int) -> Ints:
    counts = 2 * split * span + 1
    rest, z = np.divmod(flat, counts[2])
    x, y = np.divmod(rest, counts[1])
    return np.column_stack((x, y, z))
