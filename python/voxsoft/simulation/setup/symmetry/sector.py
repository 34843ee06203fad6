"""Sector of a symmetric body that is solved, and its mirror images in the rest of the body.

The planes of symmetry pass between voxels. The five tetrahedra of neighbors mirror each other, so
that the whole mesh is symmetric where its voxels are, and a vertex on one side has its image on the
other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, Self

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.discretization.joined import edge_directions
from voxsoft.design.symmetry import Symmetry
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.symmetry.bodies import BodyImages

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Largest distance of a plane from faces of voxels, in voxels: rounding.
_OFF: Final = 1e-6
#: Largest difference of the fractions of a voxel and of its image: they are measured by points of
#: which some lie on the surface of symmetric shapes, where rounding decides.
_SAME_FRACTION: Final = 0.02

_WHOLE: Final = "describe the whole body (shape.mirror keeps both halves), or leave the plane out"


@dataclass(frozen=True, eq=False)
class Sector:
    """A half, quarter or eighth of a body, on the positive side of its planes.

    Attributes
    ----------
    planes
        The planes of symmetry.
    whole
        The mesh of the whole body, made of voxels.
    images
        Image of each vertex of the whole for each plane, (n,).
    vertices
        The vertices of the whole that are in the sector, (m,).
    source
        Vertex of the sector whose image each vertex of the whole is, (n,).
    signs
        Factors on the components of a vector from its source to each vertex of the whole, (n, 3).
    body_images
        Number of the image of each body for each plane.
    """

    planes: tuple[Symmetry, ...]
    whole: Mesh
    images: tuple[Ints, ...] = field(repr=False)
    vertices: Ints = field(repr=False)
    source: Ints = field(repr=False)
    signs: Floats = field(repr=False)
    body_images: tuple[list[int], ...] = field(repr=False)

    @classmethod
    def of(cls, planes: Sequence[Symmetry], mesh: Mesh, kinds: Ints | None = None) -> Self:
        """Find the sector of a mesh.

        Parameters
        ----------
        planes
            One or more, across different axes.
        mesh
            The whole body, or several bodies that are images of themselves or of each other.
        kinds
            A number for each part from 1 on, which parts of one material share; default: every part
            is mirrored to itself.

        Raises
        ------
        DesignError
            A plane that is not on faces of voxels, or in which the voxels are not their own image.

        Examples
        --------
        >>> from voxsoft.voxels import Voxels
        >>> mesh = Voxels.from_array(np.ones((2, 2, 3), bool), 0.01, (-0.01, -0.01, 0)).mesh()
        >>> quarter = Sector.of([Symmetry(plane="x"), Symmetry(plane="y")], mesh)
        >>> len(quarter.mesh.tets), quarter.count
        (15, 4)
        """
        size = mesh.voxel_size
        if size is None:
            what = "is known for bodies of voxels only"
            raise DesignError("symmetry", what, "leave the plane out")
        if mesh.bodies:
            return cls._of_bodies(planes, mesh, kinds)
        lattice = _Lattice(mesh, planes, size)
        for index, plane in enumerate(planes):
            lattice.check_plane(plane, f"symmetry[{index}]")
        keys = lattice.vertices
        axes = [plane.axis for plane in planes]
        images = tuple(_found_in(keys, _mirrored(keys, axis)) for axis in axes)
        folded = keys.copy()
        folded[:, axes] = np.abs(folded[:, axes])
        signs = np.ones(keys.shape)
        signs[:, axes] = np.where(keys[:, axes] < 0, -1.0, 1.0)
        kept = np.flatnonzero((keys[:, axes] >= 0).all(axis=1))
        source = _found_in(keys[kept], folded)
        return cls(tuple(planes), mesh, images, kept, source, signs, ([0],) * len(planes))

    @classmethod
    def _of_bodies(cls, planes: Sequence[Symmetry], mesh: Mesh, kinds: Ints | None) -> Self:
        """Find the sector of several bodies."""
        parts = np.arange(int(mesh.tet_part.max())) if kinds is None else kinds
        found = BodyImages(mesh, planes, parts)
        source = np.arange(len(mesh.vertices))
        signs = np.ones((len(source), 3))
        for plane, image, here in zip(planes, found.vertices, found.kept.T, strict=True):
            source = np.where(here, source, image[source])
            signs[:, plane.axis] = np.where(here, 1.0, -1.0)
        kept = np.flatnonzero(found.kept.all(axis=1))
        numbers = np.full(len(source), -1)
        numbers[kept] = np.arange(len(kept))
        return cls(tuple(planes), mesh, found.vertices, kept, numbers[source], signs, found.bodies)

    @property
    def axes(self) -> list[int]:
        """The axes across the planes."""
        return [plane.axis for plane in self.planes]

    @property
    def count(self) -> int:
        """Number of sectors of the body."""
        return int(2 ** len(self.planes))

    @cached_property
    def origin(self) -> Floats:
        """A point on all planes [m], (3,): the origin of the sector's own frame.

        In it, the cone from the origin over the rim of a chamber that the planes cut lies in them,
        so that the volume of the part is that of its surface alone.
        """
        found = np.zeros(3)
        for plane in self.planes:
            found[plane.axis] = plane.at
        return found

    @cached_property
    def on_planes(self) -> NDArray[np.bool_]:
        """Marks of the vertices of the whole that are on each plane, (n, p)."""
        own = np.arange(len(self.whole.vertices))
        return np.stack([image == own for image in self.images], axis=1)

    @cached_property
    def numbers(self) -> Ints:
        """The number in the sector of each vertex of the whole, -1 outside of it, (n,)."""
        found = np.full(len(self.whole.vertices), -1, dtype=np.int64)
        found[self.vertices] = np.arange(len(self.vertices))
        return found

    @cached_property
    def shares(self) -> Floats:
        """Share of the sector in a force on each vertex of the whole, (n,)."""
        parts = 0.5 ** self.on_planes.sum(axis=1)
        return np.where(self.numbers >= 0, parts, 0.0)

    @cached_property
    def voxels(self) -> Ints:
        """The voxels of the whole that are in the sector."""
        corners = self.whole.tets.reshape(-1, 20)
        return np.flatnonzero((self.numbers[corners] >= 0).all(axis=1))

    @cached_property
    def directions(self) -> Floats | None:
        """The directions of the edges of its voxels, (v, 9); None where all are along the axes."""
        found = edge_directions(self.whole)
        return None if found is None else found[self.voxels]

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh of the sector in its own frame, without the faces in the planes."""
        whole, voxels = self.whole, self.voxels
        tets = self.numbers[whole.tets.reshape(-1, 5, 4)[voxels].reshape(-1, 4)]
        parts = whole.tet_part.reshape(-1, 5)[voxels].ravel()
        found = Mesh.from_tets(whole.vertices[self.vertices] - self.origin, tets, parts)
        return replace(
            found,
            tet_voxel=np.arange(len(tets), dtype=np.int32) // 5,
            voxel_size=whole.voxel_size,
            triangles=self.restricted(whole.triangles).astype(np.int32),
            cavities=(),
            fractions=None if whole.fractions is None else whole.fractions[voxels],
            moments=None if whole.moments is None else whole.moments[voxels],
            surfaces=None if whole.surfaces is None else whole.surfaces[voxels],
        )

    def inside(self, elements: NDArray[np.integer]) -> NDArray[np.bool_]:
        """Mark elements, (e, k) vertices of the whole, with all their corners in the sector."""
        return np.asarray((self.numbers[elements] >= 0).all(axis=1))

    def restricted(self, elements: NDArray[np.integer]) -> NDArray[np.uint32]:
        """Select elements of the whole that are in the sector, by its own numbers."""
        found: NDArray[np.uint32] = self.numbers[elements[self.inside(elements)]].astype(np.uint32)
        return found

    def images_of(
        self, elements: NDArray[np.integer]
    ) -> tuple[NDArray[np.uint32], Floats, NDArray[np.uint32]]:
        """Renumber the corners of elements of the whole, (e, k), as images of the sector.

        Returns
        -------
        of, signs, elements
            The source of each image in the sector, the factors on its vectors, and the elements.
        """
        used, numbered = np.unique(elements, return_inverse=True)
        of = self.source[used].astype(np.uint32)
        return of, self.signs[used], numbered.reshape(elements.shape).astype(np.uint32)

    def unfolded(self, vectors: Floats) -> Floats:
        """Map vectors on the vertices of the sector, (..., m, 3), to those of the whole."""
        found: Floats = vectors[..., self.source, :] * self.signs
        return found

    def places(self, positions: Floats) -> Floats:
        """Map positions in the sector's frame, (..., m, 3), to those of the whole."""
        return self.unfolded(positions) + self.origin

    def patterns(self) -> Iterator[tuple[Floats, NDArray[np.bool_]]]:
        """Yield the factors on vectors in each sector, and the marks of its vertices."""
        for number in range(self.count):
            sign = np.ones(3)
            sign[self.axes] = [-1.0 if number >> bit & 1 else 1.0 for bit in range(len(self.axes))]
            yield sign, (self.signs == sign).all(axis=1)


@dataclass(frozen=True, eq=False)
class _Lattice:
    """Vertices and voxels of a mesh by integer coordinates, counted from the planes."""

    mesh: Mesh
    planes: Sequence[Symmetry]
    size: float

    @cached_property
    def origin(self) -> Floats:
        """Origin of the coordinates [m], (3,)."""
        found: Floats = self.mesh.vertices.min(axis=0)
        for plane in self.planes:
            found[plane.axis] = plane.at
        return found

    @cached_property
    def vertices(self) -> Ints:
        """Coordinates of the vertices, (n, 3)."""
        return np.rint((self.mesh.vertices - self.origin) / self.size).astype(np.int64)

    @cached_property
    def voxels(self) -> Ints:
        """Coordinates of the lower corners of the voxels, (v, 3)."""
        found: Ints = self.vertices[self.mesh.tets.reshape(-1, 20)].min(axis=1)
        return found

    def check_plane(self, plane: Symmetry, where: str) -> None:
        """Raise an error where the voxels are not symmetric in a plane."""
        first = (self.mesh.vertices[0, plane.axis] - plane.at) / self.size
        off = abs(first - np.rint(first))
        if off > _OFF:
            what = f"passes through voxels, {1e3 * off * self.size:.3g} mm from the nearest faces"
            hint = "move the shapes or the plane by that, or take voxels that divide the distance"
            raise DesignError(where, what, hint)
        mirrored = _mirrored(self.voxels, plane.axis)
        mirrored[:, plane.axis] -= 1  # the upper corner becomes the lower one
        image = _found_in(self.voxels, mirrored)
        self._check_all(image >= 0, plane, where, "has no image")
        parts = self.mesh.tet_part[::5]
        self._check_all(parts == parts[image], plane, where, "is of another part than its image")
        if (fractions := self.mesh.fractions) is not None:
            same = np.abs(fractions - fractions[image]) <= _SAME_FRACTION
            self._check_all(same, plane, where, "is not as full as its image")

    def _check_all(self, good: NDArray[np.bool_], plane: Symmetry, where: str, what: str) -> None:
        if good.all():
            return
        worst = int(np.flatnonzero(~good)[0])
        x, y, z = 1e3 * (self.origin + (self.voxels[worst] + 0.5) * self.size)
        at = f"({x:.1f}, {y:.1f}, {z:.1f}) mm"
        others = int((~good).sum()) - 1
        more = f", and {others:,} more" if others else ""
        message = f"is no plane of symmetry: the voxel at {at} {what} across {plane.plane}{more}"
        points = self.mesh.vertices[:, plane.axis]
        middle = (points.min() + points.max()) / 2.0
        moved = abs(middle - plane.at) > _OFF * self.size
        there = f"the body's middle is at {1e3 * middle:.6g} mm: write that, or "
        raise DesignError(where, message, (there if moved else "") + _WHOLE)


def _mirrored(keys: Ints, axis: int) -> Ints:
    found = keys.copy()
    found[:, axis] = -found[:, axis]
    return found


def _found_in(keys: Ints, wanted: Ints) -> Ints:
    """Find integers (w, 3) among others (k, 3), all different; -1 where they are missing."""
    low = np.minimum(keys.min(axis=0), wanted.min(axis=0))
    shape = np.maximum(keys.max(axis=0), wanted.max(axis=0)) - low + 1
    codes = np.ravel_multi_index(tuple((keys - low).T), tuple(shape))
    asked = np.ravel_multi_index(tuple((wanted - low).T), tuple(shape))
    order = np.argsort(codes)
    at = np.minimum(np.searchsorted(codes, asked, sorter=order), len(codes) - 1)
    found = order[at]
    return np.where(codes[found] == asked, found, -1)
