"""Smooth closed surfaces of the parts that were simulated, which move with the voxels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import beside_others, built_parts
from voxsoft.mesh import Mesh
from voxsoft.shapes.nets import Labels, Net, closed, measures, net_of, with_volumes
from voxsoft.simulation.setup.volumes import GridRegions, labels_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Samples along a voxel: the fewest that keep a part in one, and its volume.
SAMPLES: Final = (2, 3, 4)
#: Most cells of the sample grid, and samples of the shapes.
_LARGEST_GRID, _MOST_SAMPLES = 120_000_000, 6_000_000
#: Relative error of a volume at which a surface is not traced again, and above which samples become
#: finer, or the surface between parts is that of voxels. Points move for the rest.
_GOOD, _POOR = 3e-3, 2e-2
#: Part of a part's samples below which a component is left out where the finest samples divide it.
_CRUMB: Final = 0.02
#: Times that the surface is traced at most.
_MOVES: Final = 6
#: Largest move at once and in all, in voxels: shapes that need more are not those of the voxels.
_REACH, _FARTHEST = 0.25, 0.75
#: Distance from a surface, in steps between samples, within which samples count as outside.
_TIE: Final = 1e-5
#: Distance of finite differences, in steps.
_DIFFERENCE: Final = 1e-3
#: Steps of the search for the surface between two samples.
_SECANTS: Final = 5
#: Largest extrapolation of the motion of a voxel, in halves of its edge from its center.
_FAR: Final = 3.0
#: Sides of the corners of a voxel, in the order of :meth:`voxsoft.Mesh.voxel_corners`.
_SIGNS: Final = 2.0 * np.array([[c >> 2 & 1, c >> 1 & 1, c & 1] for c in range(8)]) - 1.0


@dataclass(frozen=True, eq=False)
class SmoothSurfaces:
    """Closed surfaces of the parts of a design.

    Attributes
    ----------
    mesh
        Mesh of voxels that carries them.
    names
        Name of each part by its number.
    net
        Surface of the unloaded body [m], between the numbers of parts; 0 is outside.
    corners
        Vertices of the mesh that each point moves with, (n, 8).
    weights
        Weight of each of them, (n, 8).
    """

    mesh: Mesh = field(repr=False)
    names: dict[int, str]
    net: Net = field(repr=False)
    corners: Ints = field(repr=False)
    weights: Floats = field(repr=False)

    def at(self, positions: Floats | None = None) -> Net:
        """Return the surface with the mesh unloaded, or its vertices at positions [m], (n, 3).

        The parts have the volumes that their tetrahedra have there.
        """
        mesh, net = self.mesh, self.net
        if positions is not None:
            moved = np.asarray(positions, dtype=np.float64) - mesh.vertices
            way = np.einsum("nk,nkj->nj", self.weights, moved[self.corners])
            mesh, net = replace(mesh, vertices=positions), net._replace(points=net.points + way)
        return with_volumes(net, part_volumes(mesh, max(self.names)))

    def surfaces(self, positions: Floats | None = None) -> dict[str, tuple[Floats, Ints]]:
        """Return vertices [m] and triangles of each part by its name; parameters as for `at`."""
        net, found = self.at(positions), {}
        for number, name in self.names.items():
            if len(triangles := net.around(number)):
                used, own = np.unique(triangles, return_inverse=True)
                found[name] = (net.points[used], own.reshape(-1, 3).astype(np.int64))
        return found


def part_names(design: Design) -> dict[int, str]:
    """Return the name of each part by its number in a mesh, as the volumes have it.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> part_names(families.beam())
    {1: 'body'}
    """
    design = design.assembled if design.bodies else design
    names: dict[int, str] = {}
    for body in dict.fromkeys(part.body or "" for part in design.parts):
        own = [i for i, part in enumerate(design.parts, 1) if (part.body or "") == body]
        names |= dict(zip(own, labels_of(design, body), strict=True))
    return dict(sorted(names.items()))


def part_volumes(mesh: Mesh, count: int) -> Floats:
    """Return the volume of the material of the parts 1 to `count` [m³], (count,).

    Examples
    --------
    >>> from voxsoft.voxels import Voxels
    >>> mesh = Voxels.from_array([[[1, 2, 2]]], voxel_size=0.01).mesh()
    >>> (part_volumes(mesh, 2) * 1e6).round(9).tolist()
    [1.0, 2.0]
    """
    volumes = mesh.tet_volumes
    if mesh.fractions is not None and mesh.tet_voxel is not None:
        volumes = volumes * mesh.fractions[mesh.tet_voxel]
    found = np.bincount(mesh.tet_part, volumes, count + 1)[1 : count + 1]
    return found.astype(np.float64)


def smooth_surfaces(design: Design, mesh: Mesh) -> SmoothSurfaces | None:
    """Return the surfaces of a design's parts with the volumes that are simulated.

    The surface is that of the shapes, moved along itself until each part has the volume of its
    voxels: by some thousandths of a voxel where voxels are cut, by a part of a voxel where they are
    full.

    Parameters
    ----------
    design
        The design.
    mesh
        Its mesh.

    Returns
    -------
    SmoothSurfaces or None
        None for a mesh of other elements than voxels, or of voxels that are not those of the
        shapes: its faces are the surface.

    Raises
    ------
    ShapeError
        A shape has no value somewhere.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere()
    >>> mesh = mesh_of(ball)
    >>> ((name, (points, triangles)),) = smooth_surfaces(ball, mesh).surfaces().items()
    >>> a, b, c = points[triangles].transpose(1, 0, 2)
    >>> volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    >>> name, bool(abs(volume / mesh.volume - 1) < 1e-3)
    ('body', True)
    """
    design = design.assembled if design.bodies else design
    nets, corners, weights = [], [], []
    count = 0
    for body in mesh.each_body:
        own = design.alone(body.name) if body.name else design
        if body.mesh.voxel_size is None or body.mesh.tet_voxel is None or not own.parts:
            return None
        grid = _Grid(own, body.mesh)
        net = grid.best()
        if net is None:
            return None
        numbers = [i for i, part in enumerate(design.parts, 1) if (part.body or "") == body.name]
        carriers, shares = grid.carriers(net.points)
        sides = np.array([0, *numbers], dtype=np.uint8)[net.sides]
        nets.append(Net(body.placed(net.points), net.triangles + count, sides))
        corners.append(carriers + body.first_vertex)
        weights.append(shares)
        count += len(net.points)
    whole = Net(*(np.concatenate(each) for each in zip(*nets, strict=True)))
    return SmoothSurfaces(
        mesh, part_names(design), whole, np.concatenate(corners), np.concatenate(weights)
    )


@dataclass
class _Levels:
    """Moves of the surface [m]: outward by the part, and between parts toward others."""

    outer: Floats
    inner: Floats


class _Grid:
    """Voxels of a body with the samples of its shapes."""

    def __init__(self, design: Design, mesh: Mesh) -> None:
        assert mesh.voxel_size is not None
        self.mesh, self.size = mesh, mesh.voxel_size
        self.shapes = built_parts(design)
        self.cells = GridRegions.of(mesh, self.size)
        self.expected = part_volumes(mesh, len(self.shapes))
        #: Cells beside the surface; with full voxels that were cut the shapes are farther away.
        self.near = self.cells.near
        for _ in range(round(design.voxel_size / self.size) - 1):
            self.near = beside_others(self.near.astype(np.uint8)) | self.near

    def best(self) -> Net | None:
        """Return the net of the coarsest samples that keep the parts in one and their volumes.

        None where the shapes do not have the volumes of the voxels.
        """
        least: tuple[float, int, bool] | None = None
        for along in [n for n in SAMPLES if self._fits(n)] or [1]:
            samples = _Samples(self, along)
            for keeps_shapes in (True, False) if len(self.shapes) > 1 else (True,):
                excess = samples.excess(keeps_shapes)
                if excess == 0:
                    wrong, net = samples.fitted(keeps_shapes)
                    if wrong < _POOR:
                        return net
                    excess += wrong
                if least is None or excess < least[0]:
                    least = (excess, along, keeps_shapes)
        assert least is not None
        wrong, net = _Samples(self, least[1], drops_crumbs=True).fitted(least[2])
        return net if math.isfinite(wrong) else None

    def _fits(self, along: int) -> bool:
        samples = int(self.near.sum()) * along**3 * len(self.shapes)
        return samples <= _MOST_SAMPLES and self.near.size * along**3 <= _LARGEST_GRID

    def nearest(self) -> tuple[Ints, ...]:
        """Return the nearest voxel of each cell, by its indices."""
        from scipy import ndimage

        found = ndimage.distance_transform_edt(
            self.cells.parts == 0, return_distances=False, return_indices=True
        )
        return tuple(np.asarray(each, dtype=np.int64) for each in found)

    def carriers(self, points: Floats) -> tuple[Ints, Floats]:
        """Return the corners of the voxel that each point moves with, and their weights."""
        cell = np.floor((points - self.cells.origin) / self.size).astype(np.int64)
        cell = np.clip(cell, 0, np.array(self.cells.parts.shape) - 1)
        voxel = np.stack([each[tuple(cell.T)] for each in self.nearest()], axis=1)
        blocks = self.mesh.vertices[self.mesh.tets.reshape(-1, 20)]
        corner = np.rint((blocks.min(axis=1) - self.cells.origin) / self.size).astype(np.int64)
        number = np.full(self.cells.parts.shape, -1, dtype=np.int64)
        number[tuple(corner.T)] = np.arange(len(corner))
        own, index = np.unique(number[tuple(voxel.T)], return_inverse=True)
        vertices = self.mesh.voxel_corners(own)[index.reshape(-1)].astype(np.int64)
        middle = self.cells.origin + (voxel + 0.5) * self.size
        local = np.clip((points - middle) / (self.size / 2.0), -_FAR, _FAR)
        weights: Floats = np.prod(1.0 + local[:, None] * _SIGNS, axis=2) / 8.0
        return vertices, weights


class _Samples:
    """Samples of the shapes of a body, finer than its voxels.

    Parameters
    ----------
    grid
        The voxels.
    along
        Samples along an edge of a voxel.
    drops_crumbs
        True to leave out small components of a part that is one of voxels.
    """

    def __init__(self, grid: _Grid, along: int, *, drops_crumbs: bool = False) -> None:
        self.drops_crumbs = drops_crumbs
        self.grid, self.step = grid, grid.size / along
        self.first = grid.cells.origin + self.step / 2.0
        self.voxel = _refined(grid.cells.parts, along)
        self.asked = np.nonzero(_refined(grid.near.astype(np.uint8), along))
        places = self.first + self.step * np.column_stack(self.asked)
        self.values = self._values(places)
        nearest = grid.nearest()
        cell = tuple(each // along for each in self.asked)
        self.owner = grid.cells.parts[tuple(each[cell] for each in nearest)].astype(np.int64) - 1

    def _values(self, places: Floats) -> Floats:
        """Return the function of each shape, (p, k), positive where it has none."""
        shapes: Sequence[_core.Shape] = self.grid.shapes
        found = np.array([shape.evaluate(np.ascontiguousarray(places)) for shape in shapes])
        values: Floats = np.nan_to_num(found, nan=self.step, posinf=1e9, neginf=-1e9)
        return values

    def excess(self, keeps_shapes: bool) -> float:
        """Count the parts that the samples divide and cavities that they open; see `fitted`."""
        from scipy import ndimage

        cube, cells = np.ones((3, 3, 3), dtype=bool), self.grid.cells.parts
        count = len(self.grid.shapes)
        labels = self._labels(_Levels(np.zeros(count), np.zeros(count)), keeps_shapes)
        found = max(0, ndimage.label(cells == 0)[1] - ndimage.label(labels == 0)[1])
        for part in range(1, count + 1):
            own, finer = (ndimage.label(each == part, cube)[1] for each in (cells, labels))
            found += max(0, finer - own) + max(0, min(own, 1) - finer)
        return float(found)

    def fitted(self, keeps_shapes: bool) -> tuple[float, Net]:
        """Return the largest relative error of a volume, and the net, moved to that of the voxels.

        The error is infinite where the surface would have to be moved too far.

        Parameters
        ----------
        keeps_shapes
            False for a surface between parts that is that of their voxels.
        """
        expected = self.grid.expected
        levels = _Levels(np.zeros(len(expected)), np.zeros(len(expected)))
        best: tuple[float, Net] | None = None
        for _ in range(_MOVES):
            net = self._net(levels, keeps_shapes)
            volumes, areas = measures(net, len(expected))
            wrong = float((np.abs(volumes - expected) / np.maximum(expected, 1e-300)).max())
            if best is None or wrong < best[0]:
                best = (wrong, net)
            if wrong < _GOOD:
                return best
            self._move(levels, expected - volumes, areas)
        assert best is not None
        is_far = np.abs(levels.outer).max() > _FARTHEST * self.grid.size
        return (math.inf, best[1]) if is_far else best

    def _move(self, levels: _Levels, missing: Floats, areas: Floats) -> None:
        """Move the surfaces by the missing volume of each part over the areas around it."""
        reach = _REACH * self.grid.size
        between = areas[1:, 1:]
        group = _groups(between > 0.0)
        outer = areas[1:, 0]
        total = np.bincount(group, missing) / np.maximum(np.bincount(group, outer), 1e-300)
        moves = np.clip(total[group], -reach, reach)
        levels.outer += moves
        rest = missing - moves * outer
        laplacian = np.diag(between.sum(axis=1)) - between
        levels.inner += np.clip(np.linalg.pinv(laplacian) @ (2.0 * rest), -reach, reach)

    def _labels(self, levels: _Levels, keeps_shapes: bool) -> Labels:
        labels = self.voxel.copy()
        outer, inner = _sides(self.values, levels)
        part = inner.argmin(axis=0) if keeps_shapes else self.owner
        labels[self.asked] = np.where(outer < -_TIE * self.step, part + 1, 0)
        # Material without a voxel is not simulated; that of a part goes to the part beside it.
        labels[self._lone(labels > 0, self.voxel > 0)] = 0
        if len(self.values) > 1 or self.drops_crumbs:
            lone = np.zeros(labels.shape, dtype=bool)
            for part in range(1, len(self.values) + 1):
                lone |= self._lone(labels == part, self.voxel == part)
            _give(labels, lone)
        # A part thinner than the samples has them all over its voxels.
        for part in np.setdiff1d(self.voxel, labels):
            labels[self.voxel == part] = part
        return closed(labels)

    def _lone(self, samples: NDArray[np.bool_], voxels: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return the components of samples that lie in none of the voxels."""
        from scipy import ndimage

        cube = np.ones((3, 3, 3), dtype=bool)
        found, count = ndimage.label(samples, cube)
        sizes = np.bincount(found.ravel(), minlength=count + 1)
        has_voxel = np.zeros(count + 1, dtype=bool)
        has_voxel[found[samples & voxels]] = True
        if self.drops_crumbs:
            expected = max(1, ndimage.label(voxels, cube)[1])
            largest = np.argsort(sizes[1:])[::-1][:expected] + 1
            is_large = sizes > _CRUMB * sizes[1:].sum()
            is_large[largest] = True
            has_voxel &= is_large
        has_voxel[0] = True
        lone: NDArray[np.bool_] = ~has_voxel[found]
        return lone

    def _net(self, levels: _Levels, keeps_shapes: bool) -> Net:
        def difference(places: Floats, behind: Labels, before: Labels) -> Floats:
            """Return a function that is negative behind the surface and positive before it."""
            outer, inner = _sides(self._values(places), levels)
            rows = np.arange(len(places))
            one, other = behind.astype(np.int64) - 1, before.astype(np.int64) - 1
            between = inner[one, rows] - inner[other, rows] if keeps_shapes else np.zeros(len(rows))
            return np.where(before == 0, outer, np.where(behind == 0, -outer, between))

        def crossings(
            start: Floats, end: Floats, behind: Labels, before: Labels
        ) -> tuple[Floats, Floats]:
            low, high = difference(start, behind, before), difference(end, behind, before)
            known = (low <= _TIE * self.step) & (high >= -_TIE * self.step) & (high > low)
            low, high = np.minimum(low, 0.0), np.maximum(high, 0.0)
            left, right = np.zeros(len(low)), np.ones(len(low))
            with np.errstate(invalid="ignore", divide="ignore"):
                for _ in range(_SECANTS):
                    part = np.where(known, left + (right - left) * low / (low - high), 0.5)
                    part = np.nan_to_num(part, nan=0.5)
                    value = difference(start + part[:, None] * (end - start), behind, before)
                    # The bound that stays counts half (Illinois): both close in.
                    under = value < 0.0
                    left, right = np.where(under, part, left), np.where(under, right, part)
                    low = np.where(under, value, low / 2.0)
                    high = np.where(under, high / 2.0, value)
            places = start + part[:, None] * (end - start)
            reach = _DIFFERENCE * self.step
            normals = np.empty_like(places)
            for axis, way in enumerate(reach * np.eye(3)):
                normals[:, axis] = difference(places + way, behind, before)
                normals[:, axis] -= difference(places - way, behind, before)
            lengths = np.linalg.norm(normals, axis=1)
            sound = known & (lengths > 0.0)
            normals[sound] /= lengths[sound, None]
            normals[~sound] = 0.0
            if not keeps_shapes:
                flat = (behind > 0) & (before > 0)
                normals[flat] = (end - start)[flat] / self.step
            return places, normals

        return net_of(self._labels(levels, keeps_shapes), self.first, self.step, crossings)


def _give(labels: Labels, lone: NDArray[np.bool_]) -> None:
    """Give samples the label of one beside them that is kept, those next to such first."""
    flat, kept = labels.reshape(-1), ~lone.reshape(-1)
    kept &= flat > 0
    left = np.flatnonzero(lone)
    ways = [sign * stride for stride in np.array(labels.strides) for sign in (-1, 1)]
    while len(left):
        sources = left[:, None] + np.array(ways)
        is_kept = kept[sources]
        gets = is_kept.any(axis=1)
        if not gets.any():
            flat[left] = 0
            return
        rows = np.flatnonzero(gets)
        flat[left[rows]] = flat[sources[rows, is_kept[rows].argmax(axis=1)]]
        kept[left[rows]] = True
        left = left[~gets]


def _sides(values: Floats, levels: _Levels) -> tuple[Floats, Floats]:
    """Return the function of the union, (k,), and of each part without those before it, (p, k)."""
    outer = (values - levels.outer[:, None]).min(axis=0)
    inner = values.copy()
    if len(values) > 1:
        before = np.minimum.accumulate(values, axis=0)[:-1]
        inner[1:] = np.maximum(values[1:], -before)
    inner -= levels.inner[:, None]
    return outer, inner


def _groups(touches: NDArray[np.bool_]) -> Ints:
    """Number the groups of parts that touch, (p,)."""
    group = np.arange(len(touches))
    for _ in range(len(touches)):
        for one, other in np.argwhere(touches):
            group[one] = group[other] = min(group[one], group[other])
    return np.unique(group, return_inverse=True)[1].reshape(-1)


def _refined(cells: Labels, along: int) -> Labels:
    """Repeat each cell as several samples along each axis."""
    for axis in range(3):
        cells = cells.repeat(along, axis)
    return cells
