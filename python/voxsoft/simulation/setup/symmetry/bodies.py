"""Mirror images of several bodies: each is its own image, or that of another one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.part import Part
from voxsoft.design.symmetry import Symmetry
from voxsoft.errors import DesignError
from voxsoft.mesh import BodyMesh, Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

#: Largest distance of a vertex from the image of another one, in voxels: rounding of poses.
_OFF: Final = 1e-6
#: Largest difference of the fractions of a voxel and of its image, as for one body.
_SAME_FRACTION: Final = 0.02

_HINT: Final = (
    'place the image with mirror = "x", "y" or "z" of the same design, move the plane, or leave it '
    "out"
)


@dataclass(frozen=True, eq=False)
class BodyImages:
    """Images of the vertices of several bodies.

    Parameters
    ----------
    mesh
        A mesh of several bodies of voxels.
    planes
        The planes of symmetry.
    kinds
        A number for each part from 1 on, which parts of one material share.
    """

    mesh: Mesh
    planes: Sequence[Symmetry]
    kinds: Ints

    @property
    def vertices(self) -> tuple[Ints, ...]:
        """Image of each vertex for each plane, (n,); errors as for :attr:`kept`."""
        return tuple(image for _, image in self._found)

    @property
    def bodies(self) -> tuple[list[int], ...]:
        """Number of the image of each body for each plane; errors as for :attr:`kept`."""
        return tuple(bodies for bodies, _ in self._found)

    @cached_property
    def kept(self) -> NDArray[np.bool_]:
        """Marks of the vertices on the solved side of each plane, (n, p).

        Raises
        ------
        DesignError
            A body without an image, or one whose middle is in the plane to its image.
        """
        kept = np.zeros((len(self.mesh.vertices), len(self.planes)), dtype=bool)
        for number, (plane, (bodies, _)) in enumerate(zip(self.planes, self._found, strict=True)):
            for body, image in zip(self.mesh.bodies, bodies, strict=True):
                across = self.mesh.vertices[body.vertices, plane.axis] - plane.at
                near = _OFF * _size(body)
                if self.mesh.bodies[image] is body:
                    kept[body.vertices, number] = across >= -near
                    continue
                if abs(float(across.mean())) <= near:
                    what = f'the middle of the body "{body.name}", which is not its own image, is'
                    self._refuse(f"symmetry[{number}]", f"{what} in the plane", plane)
                kept[body.vertices, number] = across.mean() > 0.0
        return kept

    @cached_property
    def _found(self) -> list[tuple[list[int], Ints]]:
        """Images of bodies and of vertices for each plane."""
        found = []
        for number, plane in enumerate(self.planes):
            image = np.zeros(len(self.mesh.vertices), dtype=np.int64)
            bodies = []
            for body in self.mesh.bodies:
                other, vertices = self._image_of(body, plane, f"symmetry[{number}]")
                image[body.vertices] = vertices + self.mesh.bodies[other].first_vertex
                bodies.append(other)
            self._check_voxels(image, plane, f"symmetry[{number}]")
            found.append((bodies, image))
        return found

    def _image_of(self, body: BodyMesh, plane: Symmetry, where: str) -> tuple[int, Ints]:
        """Find the number of the body that is the image of one, and its vertices."""
        from scipy.spatial import cKDTree

        mirrored = self.mesh.vertices[body.vertices].copy()
        mirrored[:, plane.axis] = 2.0 * plane.at - mirrored[:, plane.axis]
        nearest, place = np.inf, np.zeros(3)
        for number, other in enumerate(self.mesh.bodies):
            if len(other.mesh.vertices) != len(mirrored):
                continue
            found = cKDTree(self.mesh.vertices[other.vertices]).query(mirrored)
            off, vertices = (np.asarray(each) for each in found)
            worst = int(off.argmax())
            if off[worst] <= _OFF * _size(body):
                return number, np.asarray(vertices, dtype=np.int64)
            if off[worst] < nearest:
                nearest, place = off[worst], self.mesh.vertices[body.vertices][worst]
        what = f'is no plane of symmetry: the body "{body.name}" has no image across {plane.plane}'
        if np.isfinite(nearest):
            x, y, z = 1e3 * place
            what += f": at ({x:.1f}, {y:.1f}, {z:.1f}) mm it is {1e3 * nearest:.3g} mm off"
        raise DesignError(where, what, _HINT)

    def _check_voxels(self, image: Ints, plane: Symmetry, where: str) -> None:
        """Raise unless the image of every voxel is a voxel, of the same material and as full."""
        corners = np.sort(self._voxels, axis=1)
        mirrored = np.sort(image[self._voxels], axis=1)
        numbers = {tuple(row): at for at, row in enumerate(corners.tolist())}
        found = np.array([numbers.get(tuple(row), -1) for row in mirrored.tolist()])
        self._check_all(found >= 0, "has no image", plane, where)
        kinds = self.kinds[self.mesh.tet_part[::5].astype(np.int64) - 1]
        self._check_all(kinds == kinds[found], "is of another material than", plane, where)
        if (fractions := self.mesh.fractions) is not None:
            same = np.abs(fractions - fractions[found]) <= _SAME_FRACTION
            self._check_all(same, "is not as full as", plane, where)

    @cached_property
    def _voxels(self) -> NDArray[np.int32]:
        every = [
            body.mesh.voxel_corners(np.arange(len(body.mesh.tets) // 5)) + body.first_vertex
            for body in self.mesh.bodies
        ]
        return np.concatenate(every).astype(np.int32)

    def _check_all(self, good: NDArray[np.bool_], what: str, plane: Symmetry, where: str) -> None:
        if good.all():
            return
        worst = int(np.flatnonzero(~good)[0])
        x, y, z = 1e3 * self.mesh.vertices[self._voxels[worst]].mean(axis=0)
        end = "" if what.endswith("image") else " its image"
        others = int((~good).sum()) - 1
        more = f", and {others:,} more" if others else ""
        voxel = f"the voxel at ({x:.1f}, {y:.1f}, {z:.1f}) mm"
        self._refuse(where, f"{voxel} {what}{end}", plane, more)

    def _refuse(self, where: str, what: str, plane: Symmetry, more: str = "") -> NoReturn:
        message = f"is no plane of symmetry: {what} across {plane.plane}{more}"
        raise DesignError(where, message, _HINT)


def kinds_of(parts: Sequence[Part]) -> Ints:
    """Number parts by material: equal where they differ in name, shape and body alone, (k,)."""
    found: list[dict[str, Any]] = []
    kinds = []
    for part in parts:
        own = part.model_dump(exclude={"name", "shape", "body"})
        if own not in found:
            found.append(own)
        kinds.append(found.index(own))
    return np.array(kinds, dtype=np.int64)


def _size(body: BodyMesh) -> float:
    size = body.mesh.voxel_size
    assert size is not None  # bodies are made of voxels
    return size
