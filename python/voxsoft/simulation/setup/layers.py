"""Triangles of the layers of a design, and the chambers that they close.

A layer is bonded to faces of voxels. A layer that seals also spans the openings that its bonded
faces enclose in its plane. There it has no vertices of its own: an opening is triangulated between
the vertices of its rim, which all belong to the body. So nothing in the problem hangs on a membrane
alone, which has no stiffness across its plane until it is under tension.

The edges of a rim join neighbors of the grid. The circle about such an edge holds no third point of
the grid, so the edge is in every Delaunay triangulation of the vertices in the plane, and the
triangles of that triangulation whose centers lie in the opening fill it exactly.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft._components import components
from voxsoft.cavity import MeshCavity
from voxsoft.design import Design, Layer
from voxsoft.design.discretization.cut_voxels import CutVoxels
from voxsoft.design.discretization.joined import of_body, own_cavities
from voxsoft.design.discretization.rooms import ROOM_TETS
from voxsoft.design.discretization.voids import Film, Void
from voxsoft.errors import DesignError
from voxsoft.mesh import BodyMesh, Mesh
from voxsoft.simulation.setup.places import on_the_body, vertices_in

Triangles = NDArray[np.int32]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

#: Distance in voxels that is rounding.
_ROUNDING = 1e-9

_NO_TRIANGLE: Final[Triangles] = np.zeros((0, 3), dtype=np.int32)
_NO_FACE: Final[Ints] = np.zeros((0, 3), dtype=np.int64)

_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


@dataclass(frozen=True, eq=False)
class LayerTriangles:
    """The triangles of one layer.

    Attributes
    ----------
    bonded
        Triangles on faces of voxels, (b, 3) vertices.
    spanning
        Triangles over openings, (s, 3) vertices, with their normals along the axis.
    openings
        The faces of the grid that they span, (f, 3): the cell above each, in voxels from the lower
        corner of the mesh.
    axis
        The axis across the layer's plane, if it lies in one.
    covered
        The faces of the grid that a layer that seals is bonded to, as the openings.
    gap
        Distance of the layer that the design describes from these faces, along the axis [m].
    """

    bonded: Triangles
    spanning: Triangles
    openings: Ints
    axis: int | None
    covered: Ints
    gap: float = 0.0

    def moved(self, first: int) -> LayerTriangles:
        """Renumber the vertices for a joined mesh, in which its body begins with `first`."""
        shift = np.int32(first)
        return replace(self, bonded=self.bonded + shift, spanning=self.spanning + shift)

    def film(self, shape: tuple[int, int, int], shift: Ints, size: float) -> Film:
        """Return the plane that it covers in an array of cells.

        Parameters
        ----------
        shape
            Numbers of cells of the array.
        shift
            The cell at the lower corner of the mesh, (3,).
        size
            Edge of a cell [m].
        """
        assert self.axis is not None  # only a layer in a plane spans openings
        axis, flat = self.axis, tuple(np.delete(shape, self.axis))
        openings, covered = np.zeros(flat, dtype=bool), np.zeros(flat, dtype=bool)
        openings[tuple(np.delete(self.openings + shift, axis, axis=1).T)] = True
        covered[tuple(np.delete(self.covered + shift, axis, axis=1).T)] = True
        level = int(self.openings[0, axis] + shift[axis])
        gap = self.gap / size
        gap = 0.0 if abs(gap) < _ROUNDING else gap
        return Film(axis, level, covered | openings, openings, gap)

    @property
    def all(self) -> Triangles:
        """All triangles, (b + s, 3)."""
        return np.concatenate([self.bonded, self.spanning])


@dataclass(frozen=True, eq=False)
class Chamber:
    """Empty cells that body and layers enclose, and the triangles around them.

    Attributes
    ----------
    cells
        Cells, in voxels from the lower corner of the mesh, (c, 3).
    surface
        Volume, area and triangles, as a mesh has them.
    """

    cells: Ints
    surface: MeshCavity


def layer_triangles(layer: Layer, design: Design, mesh: Mesh, where: str) -> LayerTriangles:
    """Find the triangles of a layer.

    Parameters
    ----------
    layer
        The layer.
    design
        Its design, whose shapes the region may name.
    mesh
        The mesh of the body.
    where
        The place of the layer in the design, for messages.

    Raises
    ------
    DesignError
        The region catches no vertex or no whole face, or a layer that seals meets a mesh that is
        not made of voxels.

    Examples
    --------
    >>> from voxsoft.design import Region, families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> beam = families.beam()  # 100 x 10 x 10 mm in voxels of 5 mm
    >>> film = Layer(region=Region(z=(0, 0)), young="1 GPa", thickness="0.1 mm")
    >>> len(layer_triangles(film, beam, mesh_of(beam), "layers[0]").bonded)
    80
    """
    for body in mesh.bodies:
        if body.name == layer.region.body:
            lone = layer.replace(region=layer.region.replace(body=None))
            found = layer_triangles(lone, design.alone(body.name), body.mesh, where)
            return found.moved(body.first_vertex)
    inside = np.zeros(len(mesh.vertices), dtype=bool)
    points = on_the_body(design, mesh)
    inside[vertices_in(layer.region, mesh, design.shapes, f"{where}.region", points)] = True
    bonded = _bonded(layer, mesh, inside)
    if len(bonded) == 0:
        raise DesignError(
            f"{where}.region",
            "holds no face of a voxel",
            "widen it until it holds all corners of some faces, on the surface or in a plane",
        )
    if layer.seal:
        return _spanning(layer, mesh, bonded, where)
    return LayerTriangles(bonded, _NO_TRIANGLE, _NO_FACE, layer.axis, _NO_FACE)


def all_layer_triangles(design: Design, mesh: Mesh) -> tuple[LayerTriangles, ...]:
    """Find the triangles of every layer of a design, see :func:`layer_triangles`."""
    return tuple(
        layer_triangles(layer, design, mesh, f"layers[{index}]")
        for index, layer in enumerate(design.layers)
    )


def sealed(
    mesh: Mesh,
    layers: tuple[LayerTriangles, ...],
    design: Design,
    cut: CutVoxels | None = None,
) -> Mesh:
    """Return the mesh with the cavities that there are once the layers close their openings.

    Parameters
    ----------
    mesh
        A mesh of voxels, or any mesh if no layer spans an opening.
    layers
        The triangles of the layers.
    design
        The design that fills the voxels.
    cut
        Cut voxels of the mesh whose shape the design varies; default: those of the design.

    Raises
    ------
    DesignError
        The mesh has other cut voxels than the design.
    """
    if not any(len(layer.openings) for layer in layers):
        return mesh
    if not mesh.bodies:
        return replace(mesh, cavities=_closed(mesh, layers, design, cut))
    found: list[MeshCavity] = []
    for body in mesh.bodies:
        own = replace(body.mesh, cavities=own_cavities(mesh, body))
        closed = sealed(own, layers_on(body, layers), design.alone(body.name))
        found += [of_body(cavity, body) for cavity in closed.cavities]
    return replace(mesh, cavities=tuple(sorted(found, key=lambda cavity: -cavity.volume)))


def _closed(
    mesh: Mesh, layers: tuple[LayerTriangles, ...], design: Design, cut: CutVoxels | None
) -> tuple[MeshCavity, ...]:
    """Return all chambers of a body, largest first; the room in cut voxels counts."""
    found = chambers(mesh, layers)
    cavities = [chamber.surface for chamber in found]
    new = [i for i, each in enumerate(cavities) if all(each is not own for own in mesh.cavities)]
    if mesh.fractions is not None and new:
        voids = _voids(mesh, layers, design, cut, [chamber.cells for chamber in found])
        closed = replace(mesh, cavities=tuple(cavities[i] for i in new))
        closed = closed.with_voids(ROOM_TETS, [voids[i] for i in new])
        for index, cavity in zip(new, closed.cavities, strict=True):
            cavities[index] = cavity
    return tuple(sorted(cavities, key=lambda cavity: -cavity.volume))


def _voids(
    mesh: Mesh,
    layers: tuple[LayerTriangles, ...],
    design: Design,
    cut: CutVoxels | None,
    cells: list[Ints],
) -> tuple[Void, ...]:
    """Return the voids of chambers whose cells count from the lower corner of the mesh."""
    low, size = _frame(mesh)
    if cut is None:
        cut = CutVoxels.of(design, max(1, round(design.voxel_size / size)))
        if mesh.fractions is None or not np.array_equal(cut.fractions, mesh.fractions):
            raise DesignError(
                next(f"layers[{i}].seal" for i, each in enumerate(layers) if len(each.openings)),
                "cannot close a chamber here: the mesh has other cut voxels than its design",
                "mesh the design anew",
            )
    shift = np.rint((low - np.asarray(cut.voxels.origin)) / size).astype(np.int64)
    films = [layer.film(cut.voxels.shape, shift, size) for layer in layers if len(layer.openings)]
    return cut.voids_of(design, [each + shift for each in cells], films)


def _key(cavity: MeshCavity) -> frozenset[tuple[int, ...]]:
    return frozenset(map(tuple, np.sort(cavity.triangles, axis=1).tolist()))


def layers_on(body: BodyMesh, layers: tuple[LayerTriangles, ...]) -> tuple[LayerTriangles, ...]:
    """Return the layers of a joined mesh on one of its bodies, with the body's own vertices."""
    return tuple(
        layer.moved(-body.first_vertex)
        for layer in layers
        if body.vertices.start <= int(layer.bonded[0, 0]) < body.vertices.stop
    )


def chambers(mesh: Mesh, layers: tuple[LayerTriangles, ...]) -> list[Chamber]:
    """Find all chambers that voxels and layers enclose, largest first.

    Parameters
    ----------
    mesh
        A mesh of voxels; chambers that are cavities of it have their volumes and voids.
    layers
        The triangles of the layers.
    """
    low, size = _frame(mesh)
    filled = _filled(mesh)
    labels = _connected_air(filled, layers)
    outside = labels[0, 0, 0]
    a, b, c = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    in_front = _cells((a + b + c) / 3.0 + 0.25 * size * normals, low, size) + 1
    label_of = labels[tuple(in_front.T)]
    faces, owners = [mesh.triangles], [label_of]
    for layer in layers:
        # A normal along the axis points into the chamber above; below, the triangle is turned.
        for turned, step in ((layer.spanning, 0), (layer.spanning[:, ::-1], -1)):
            faces.append(turned)
            owners.append(labels[tuple(_cells_of_spanning(layer, mesh, step).T)])
    surface, owner = np.concatenate(faces), np.concatenate(owners)
    corners = mesh.vertices[surface]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    own = {_key(cavity): cavity for cavity in mesh.cavities}
    found = []
    for label in np.unique(labels[labels >= 0]):
        if label == outside:
            continue
        cells = np.argwhere(labels == label) - 1
        mine = owner == label
        cavity = MeshCavity(surface[mine], len(cells) * size**3, float(area[mine].sum() / 2.0))
        found.append(Chamber(cells, own.get(_key(cavity), cavity)))
    return sorted(found, key=lambda chamber: (-len(chamber.cells), chamber.cells[0].tolist()))


def _bonded(layer: Layer, mesh: Mesh, inside: Mask) -> Triangles:
    """Find triangles with all corners inside: in the layer's plane, or else on the surface.

    Both sides of a cut voxel may be within reach of a plane: the nearer one stands for it.
    """
    axis = layer.axis
    if axis is None:
        return mesh.triangles[inside[mesh.triangles].all(axis=1)]
    faces = mesh.tets[inside[mesh.tets].sum(axis=1) >= 3][:, _FACES].reshape(-1, 3)
    faces = faces[inside[faces].all(axis=1)]
    heights = mesh.vertices[faces, axis]
    flat = faces[np.ptp(heights, axis=1) < 1e-6 * np.ptp(mesh.vertices, axis=0).max()]
    far = np.abs(mesh.vertices[flat[:, 0], axis] - _height(layer, axis))
    flat = flat[far < far.min(initial=np.inf) + 1e-6 * np.ptp(mesh.vertices, axis=0).max()]
    _, first = np.unique(np.sort(flat, axis=1), axis=0, return_index=True)
    found: Triangles = flat[np.sort(first)]
    return found


def _spanning(layer: Layer, mesh: Mesh, bonded: Triangles, where: str) -> LayerTriangles:
    """Add to the bonded triangles of a layer those over openings that they enclose."""
    from scipy.ndimage import binary_fill_holes
    from scipy.spatial import Delaunay

    if mesh.voxel_size is None:
        raise DesignError(f"{where}.seal", "needs a body of voxels, and this mesh is another one")
    axis = layer.axis
    if axis is None:
        raise DesignError(f"{where}.seal", "needs a region that is a plane")
    low, size = _frame(mesh)
    across = [other for other in range(3) if other != axis]
    filled = np.pad(_filled(mesh), 1)
    level = int(np.rint((mesh.vertices[bonded[0, 0], axis] - low[axis]) / size))
    below, above = (np.take(filled, level + step, axis=axis)[1:-1, 1:-1] for step in (0, 1))
    centers = (mesh.vertices[bonded].mean(axis=1) - low)[:, across] / size
    covered = np.zeros(below.shape, dtype=np.int64)
    np.add.at(covered, tuple(np.floor(centers).astype(np.int64).T), 1)
    footprint = covered == 2  # both triangles of a face
    holes = binary_fill_holes(footprint) & ~footprint & ~below & ~above
    if not holes.any():
        return LayerTriangles(bonded, _NO_TRIANGLE, _NO_FACE, axis, _NO_FACE)

    lattice = np.rint((mesh.vertices - low) / size).astype(np.int64)
    in_plane = np.flatnonzero(lattice[:, axis] == level)
    points = lattice[in_plane][:, across]
    triangles = in_plane[Delaunay(points).simplices]
    corners = lattice[triangles][:, :, across].astype(np.float64)
    middle = np.floor(corners.mean(axis=1)).astype(np.int64)
    within = ((middle >= 0) & (middle < holes.shape)).all(axis=1)
    within[within] = holes[tuple(middle[within].T)]
    triangles, corners = triangles[within], corners[within]
    sides = corners[:, 1:] - corners[:, :1]
    double = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
    if axis == 1:  # x, z, y is left-handed
        double = -double
    if round(float(np.abs(double).sum())) != 2 * int(holes.sum()):
        raise DesignError(
            f"{where}.seal",
            "an opening could not be spanned between the vertices of its rim",
            "make the voxels smaller, or close the chamber by a layer of voxels",
        )
    turned = double < 0.0
    triangles[turned] = triangles[turned][:, ::-1]
    openings, under = (
        np.insert(np.argwhere(faces), axis, level, axis=1) for faces in (holes, footprint)
    )
    gap = _height(layer, axis) - float(low[axis] + level * size)
    return LayerTriangles(bonded, triangles.astype(np.int32), openings, axis, under, gap)


def _height(layer: Layer, axis: int) -> float:
    """The place of a layer's plane along the axis across it [m]."""
    height: float = getattr(layer.region, "xyz"[axis])[0]
    return height


def _cells_of_spanning(layer: LayerTriangles, mesh: Mesh, step: int) -> Ints:
    """The cell of the padded grid next to each spanning triangle: above (0) or below (-1)."""
    if layer.axis is None or len(layer.spanning) == 0:
        return np.zeros((0, 3), dtype=np.int64)
    low, size = _frame(mesh)
    centers = mesh.vertices[layer.spanning].mean(axis=1)
    centers[:, layer.axis] += (0.5 + step) * size
    return _cells(centers, low, size) + 1


def _frame(mesh: Mesh) -> tuple[NDArray[np.float64], float]:
    """The lower corner of a mesh of voxels, and their size, in m."""
    if mesh.voxel_size is None:
        raise DesignError("layers", "only bodies of voxels have chambers for layers to close")
    return mesh.vertices.min(axis=0), mesh.voxel_size


def _cells(points: NDArray[np.float64], low: NDArray[np.float64], size: float) -> Ints:
    cells: Ints = np.floor((points - low) / size).astype(np.int64)
    return cells


def _filled(mesh: Mesh) -> Mask:
    """Mark the filled cells of the mesh's bounding box."""
    low, size = _frame(mesh)
    # Every tetrahedron of a voxel has its center inside it.
    cells = _cells(mesh.vertices[mesh.tets].mean(axis=1), low, size)
    shape = np.rint(np.ptp(mesh.vertices, axis=0) / size).astype(int)
    filled = np.zeros(shape, dtype=bool)
    filled[tuple(cells.T)] = True
    return filled


def _connected_air(filled: Mask, layers: tuple[LayerTriangles, ...]) -> Ints:
    """Number the empty regions of the padded grid; -1 where filled.

    Two empty cells are connected if they share a face that no layer spans.
    """
    air = ~np.pad(filled, 1)
    index = np.cumsum(air).reshape(air.shape) - 1
    links = []
    for axis in range(3):
        behind = [slice(None)] * 3
        ahead = [slice(None)] * 3
        behind[axis], ahead[axis] = slice(None, -1), slice(1, None)
        open_face = air[tuple(behind)] & air[tuple(ahead)]
        for layer in layers:
            if layer.axis == axis:
                at = layer.openings + 1
                at[:, axis] -= 1
                open_face[tuple(at.T)] = False
        first, second = index[tuple(behind)][open_face], index[tuple(ahead)][open_face]
        links.append(np.stack([first, second]))
    first, second = np.concatenate(links, axis=1)
    numbered = np.full(air.shape, -1, dtype=np.int64)
    numbered[air] = components(first, second, int(air.sum()))
    return numbered
