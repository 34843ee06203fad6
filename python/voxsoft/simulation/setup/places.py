"""Vertices of named places: regions for clamps and loads, probes to measure at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, Probe, Region
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.errors import DesignError
from voxsoft.mesh import BodyMesh, Mesh
from voxsoft.metrics import Place
from voxsoft.shapes import Shape
from voxsoft.units import format_quantity

# A tie at exactly half a voxel goes to neither side.
_HALF = 0.5 * (1 - 1e-6)


def vertices_in(
    region: Region,
    mesh: Mesh,
    shapes: Mapping[str, Shape],
    where: str,
    points: NDArray[np.float64] | None = None,
) -> NDArray[np.uint32]:
    """Find the indices of the vertices in a region or within half a voxel of it.

    Parameters
    ----------
    region
        The place.
    mesh
        The mesh whose vertices are tested.
    shapes
        Named shapes that a region may refer to.
    where
        The place in the design, for messages.
    points
        Positions of the vertices for this test, (n, 3), m, from :func:`on_the_body`; default:
        their own.

    Raises
    ------
    DesignError
        No vertex is caught.
    """
    points = mesh.vertices if points is None else points
    caught = [
        np.flatnonzero(
            inside_region(region, at, shapes, _HALF * voxel_size(body.mesh))
            & is_named(region, body.mesh)
        )
        + body.first_vertex
        for body, at in _bodies_meant(region, mesh, points)
    ]
    found = np.concatenate(caught).astype(np.uint32)
    if found.size == 0:
        raise DesignError(where, f"touches nothing; {_spans(region, mesh)}", _TRY)
    return found


# Distance in voxels from a layer of vertices up to which a place is in it.
_ON_LAYER = 1e-9

_TRY = "move or widen the region so that it touches the body"


def _bodies_meant(
    region: Region, mesh: Mesh, points: NDArray[np.float64]
) -> Iterator[tuple[BodyMesh, NDArray[np.float64]]]:
    """Yield the bodies that a region may catch, and their vertices in its frame."""
    for body in mesh.each_body:
        if region.body is None:
            yield body, points[body.vertices]
        elif region.body == body.name:
            yield body, body.own(points[body.vertices])


def on_the_body(design: Design, mesh: Mesh) -> NDArray[np.float64]:
    """Compute the positions of vertices for the tests of regions: on the surface if outside.

    Parameters
    ----------
    design
        The design of the mesh.
    mesh
        Its mesh.

    Returns
    -------
    ndarray, shape (n, 3)
        Positions in m: the vertices themselves, unless the mesh has cut voxels: those reach out of
        the body, and a vertex outside it counts as the nearest point of its surface, within a
        voxel's diagonal. So a region at a surface catches the vertices that carry it, and not those
        beside.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> short = families.beam(length="98 mm").replace(fill="fraction")
    >>> mesh = mesh_of(short)
    >>> print(mesh.vertices[:, 0].max().round(4), on_the_body(short, mesh)[:, 0].max().round(4))
    0.1 0.098
    """
    return _moved_to_surface(design, mesh, inner=False)


def on_the_surface(design: Design, mesh: Mesh) -> NDArray[np.float64]:
    """Compute where the surface of voxels is drawn, (n, 3): on that of the shapes that cut them.

    Vertices of the surface on either side of that of the shapes, within a voxel's diagonal, are at
    its nearest point; all others, and those of a mesh without cut voxels, are where they are.
    Parameters are those of :func:`on_the_body`.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> from voxsoft.shapes import Sphere
    >>> ball = families.beam().replace(shapes={"body": Sphere(radius=0.02)})
    >>> mesh = mesh_of(ball)
    >>> radii = np.linalg.norm(on_the_surface(ball, mesh)[np.unique(mesh.triangles)], axis=1)
    >>> set(radii.round(6).tolist())
    {0.02}
    """
    return _moved_to_surface(design, mesh, inner=True)


def _moved_to_surface(design: Design, mesh: Mesh, *, inner: bool) -> NDArray[np.float64]:
    """Move the vertices of the surface that are outside the shapes, or inside too, to theirs."""
    if mesh.fractions is None:
        return mesh.vertices
    if mesh.bodies:
        own = [_moved_to_surface(design.alone(b.name), b.mesh, inner=inner) for b in mesh.bodies]
        return np.concatenate([b.placed(at) for b, at in zip(mesh.bodies, own, strict=True)])
    shapes = built_parts(design)
    size = voxel_size(mesh)
    steps = 0.01 * size * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
    points = mesh.vertices.copy()
    moved = np.unique(mesh.triangles)
    # Two steps of Newton's method along the gradient: exact at once for distances.
    for _ in range(2):
        around = (points[moved][:, None] + steps).reshape(-1, 3)
        levels = np.min([shape.evaluate(around) for shape in shapes], axis=0).reshape(-1, 7)
        slope = (levels[:, 1:4] - levels[:, 4:]) / (0.02 * size)
        square = np.square(slope).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            counts = (levels[:, 0] > 0.0) | inner
            step = np.where(counts, levels[:, 0] / square, 0.0)[:, None] * slope
        far = np.linalg.norm(step, axis=1) > np.sqrt(3.0) * size
        step[far | ~np.isfinite(step).all(axis=1)] = 0.0
        points[moved] -= step
    return points


def place_of(
    probe: Probe,
    mesh: Mesh,
    shapes: Mapping[str, Shape],
    where: str,
    points: NDArray[np.float64] | None = None,
) -> Place:
    """Find vertices and weights that a probe averages over.

    A point takes the corners of the tetrahedron around it, with barycentric weights. A range of
    zero width takes the two layers of vertices next to it, weighted for linear interpolation
    between them. Everything else weighs all vertices in the region alike. Parameters are those of
    :func:`vertices_in`.

    Raises
    ------
    DesignError
        A point outside the body, or a region that catches no vertex.
    """
    if probe.point is not None:
        return _point(np.asarray(probe.point), probe.body, mesh, where)
    points = mesh.vertices if points is None else points
    weights = np.zeros(len(mesh.vertices))
    meant = zip(
        _bodies_meant(probe, mesh, points), _bodies_meant(probe, mesh, mesh.vertices), strict=True
    )
    for (body, at), (_, exactly) in meant:
        size = voxel_size(body.mesh)
        is_cut = body.mesh.fractions is not None
        weights[body.vertices] = _weights(probe, at, exactly, shapes, size, is_cut=is_cut)
        weights[body.vertices] *= is_named(probe, body.mesh)
    caught = np.flatnonzero(weights)
    if caught.size == 0:
        raise DesignError(where, f"touches nothing; {_spans(probe, mesh)}", _TRY)
    return Place(caught.astype(np.uint32), weights[caught] / weights[caught].sum())


def _weights(
    probe: Probe,
    points: NDArray[np.float64],
    vertices: NDArray[np.float64],
    shapes: Mapping[str, Shape],
    size: float,
    *,
    is_cut: bool,
) -> NDArray[np.float64]:
    """Compute the weight of each vertex of a body for a probe, (n,)."""
    reach = np.full(3, _HALF * size)
    planes: list[tuple[int, float]] = []
    for axis, name in enumerate("xyz"):
        bounds = getattr(probe, name)
        if bounds is not None and bounds[0] == bounds[1]:
            reach[axis] = size
            # Motion is interpolated between layers: vertices are at their true positions here.
            points = vertices
            planes.append((axis, bounds[0]))
    weights = inside_region(probe, points, shapes, reach).astype(np.float64)
    for axis, level in planes:
        # Layers a whole voxel away have the weight 0 up to rounding.
        beyond = (vertices[:, axis] - level) / size
        weights[np.abs(beyond) > 1.0 - _ON_LAYER] = 0.0
        caught = beyond[weights > 0.0]
        if is_cut and caught.size and (np.all(caught < 0.0) or np.all(caught > 0.0)):
            weights = _extrapolated(weights, vertices, axis, beyond, size)
        else:
            weights *= 1.0 - np.abs(beyond)
    return weights


def _extrapolated(
    weights: NDArray[np.float64],
    vertices: NDArray[np.float64],
    axis: int,
    beyond: NDArray[np.float64],
    size: float,
) -> NDArray[np.float64]:
    """Follow a layer of vertices and that behind it to a plane in front of the voxels.

    Material in front of the last voxels, in cells too empty to be voxels, moves with them.
    """
    inward = int(np.sign(beyond[weights != 0.0][0]))
    lattice = np.rint((vertices - vertices.min(axis=0)) / size).astype(np.int64) + 1
    strides = np.cumprod([1, *(lattice.max(axis=0) + 2)[:-1]])
    places = lattice @ strides
    order = np.argsort(places)
    layer = np.flatnonzero(weights)
    behind = places[layer] + inward * strides[axis]
    partner = order[np.searchsorted(places, behind, sorter=order) % len(order)]
    share = np.where(places[partner] == behind, (weights * np.abs(beyond))[layer], 0.0)
    found = weights.copy()
    np.add.at(found, layer, share)
    np.subtract.at(found, partner, share)
    return found


def voxel_size(mesh: Mesh) -> float:
    """The voxel size in m, or for another mesh the edge of a cube with five mean tetrahedra."""
    if mesh.voxel_size is not None:
        return float(mesh.voxel_size)
    return float(np.cbrt(5.0 * mesh.quality.volume / len(mesh.tets)))


def is_named(region: Region, mesh: Mesh) -> NDArray[np.bool_]:
    """Mark the vertices of a mesh in the region of its file that a region names, (n,).

    All are marked where it names none; an unknown name is reported where the design is read.
    """
    if region.name is None:
        return np.ones(len(mesh.vertices), dtype=bool)
    return np.isin(np.arange(len(mesh.vertices)), mesh.regions.get(region.name, ()))


def inside_region(
    region: Region,
    points: NDArray[np.float64],
    shapes: Mapping[str, Shape],
    reach: float | NDArray[np.float64],
) -> NDArray[np.bool_]:
    """Mark points (n, 3) that lie in a region or within some reach (m) of it, (n,)."""
    reach = np.broadcast_to(reach, (3,))
    inside = np.ones(len(points), dtype=bool)
    for axis, name in enumerate("xyz"):
        bounds = getattr(region, name)
        if bounds is not None:
            inside &= points[:, axis] >= bounds[0] - reach[axis]
            inside &= points[:, axis] <= bounds[1] + reach[axis]
    if region.center is not None and region.radius is not None:
        distance = np.linalg.norm(points - np.asarray(region.center), axis=1)
        inside &= distance <= region.radius + reach.min()
    if region.shape is not None:
        shape = shapes[region.shape] if isinstance(region.shape, str) else region.shape
        inside &= shape.evaluate(points, names=shapes) <= reach.min()
    return inside


def _point(point: NDArray[np.float64], name: str | None, mesh: Mesh, where: str) -> Place:
    """Find the place of a point in the frame of a body, or else in that of the mesh."""
    body = next((each for each in mesh.bodies if each.name == name), None)
    if body is not None:
        found = _point(point, None, body.mesh, where)
        return Place(found.vertices + np.uint32(body.first_vertex), found.weights)
    corners = mesh.vertices[mesh.tets]
    base = corners[:, 0]
    frames = np.swapaxes(corners[:, 1:] - base[:, None], 1, 2)
    inner = np.linalg.solve(frames, (point - base)[..., None])[..., 0]
    coordinates = np.column_stack([1.0 - inner.sum(axis=1), inner])
    # A point on the true surface may lie a little outside full voxels: it is measured at the
    # nearest point of the tetrahedron that it is least outside of.
    best = int(np.argmax(coordinates.min(axis=1)))
    weights = np.clip(coordinates[best], 0.0, None)
    weights /= weights.sum()
    reach = 0.5
    if mesh.fractions is not None and coordinates[best].min() < -_ON_LAYER:
        # Cells less full than the least are no voxels: their material moves with those beside.
        reach = 1.0
        size, voxels = voxel_size(mesh), mesh.tets.reshape(-1, 20)
        low = mesh.vertices[voxels].min(axis=1)
        outside = np.maximum(np.maximum(low - point, point - low - size), 0.0)
        best = int(np.argmin(np.linalg.norm(outside, axis=1)))
        if np.linalg.norm(outside[best]) <= size:
            (around,) = mesh.voxel_corners(np.array([best]))
            at = (point - low[best]) / size
            factors = np.where(np.indices((2, 2, 2)).reshape(3, 8).T, at, 1.0 - at)
            return Place(around.astype(np.uint32), factors.prod(axis=1))
    if np.linalg.norm(weights @ corners[best] - point) > reach * voxel_size(mesh):
        shown = ", ".join(format_quantity(float(value), "length") for value in point)
        raise DesignError(
            where,
            f"the point ({shown}) is outside the body, which spans {_span(mesh)}",
            "move the point into the body",
        )
    return Place(mesh.tets[best].astype(np.uint32), weights)


def _spans(region: Region, mesh: Mesh) -> str:
    """Describe the extents of the bodies that a region may catch, in its frame."""
    for body in mesh.bodies:
        if region.body == body.name:
            return f'the body "{body.name}" spans {_span(body.mesh)} in its own frame'
    return f"the {'bodies span' if mesh.bodies else 'body spans'} {_span(mesh)}"


def _span(mesh: Mesh) -> str:
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    return ", ".join(
        f"{name} {format_quantity(float(a), 'length')} to {format_quantity(float(b), 'length')}"
        for name, a, b in zip("xyz", low, high, strict=True)
    )
