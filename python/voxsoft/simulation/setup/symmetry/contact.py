"""Contact of a whole symmetric body, on the mirror images of the solved sector."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Motion, Object
from voxsoft.design.symmetry import Symmetry
from voxsoft.errors import DesignError
from voxsoft.simulation.setup.contact import ContactState, Touching
from voxsoft.simulation.setup.distance import Surface, distances_to
from voxsoft.simulation.setup.motion import moved_by
from voxsoft.simulation.setup.object_symmetry import Sharing
from voxsoft.simulation.setup.symmetry.contact_images import with_images
from voxsoft.simulation.setup.symmetry.sector import Sector
from voxsoft.simulation.setup.symmetry.surface import image_of, symmetric

Floats = NDArray[np.float64]

#: Largest distance of the traced surface of an object from that of its image, in voxels of the
#: body: as much as the fractions of voxels may differ. Tracing alone rounds edges that are not on
#: the grid.
_SAME_SURFACE: Final = 0.02
#: Largest difference of the motions of objects and of their images, in voxels: rounding.
_SAME_PLACE: Final = 1e-6
#: Parts of a motion at which it is compared with its image: a rotation is not linear in its angle.
_PARTS: Final = (1.0, 0.5)

_HINT: Final = "make it symmetric, or leave the plane of symmetry out"


@dataclass(frozen=True)
class SectorTouching(Touching):
    """Contact of a symmetric body, with its mirror images.

    Contact sees the whole body: surfaces that meet across a plane, also a body and its own image,
    meet as in the whole. Of contacts that are images of each other the core counts one. Objects
    that are held or moved are all there. A free object is solved once among its images, and stays
    in the planes that cut it.

    Attributes
    ----------
    sector
        The sector that is solved.

    Raises
    ------
    DesignError
        An object, its motion, friction, or a bond that is not symmetric.
    """

    sector: Sector

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of each object, images of each other to rounding.

        Traced surfaces are not exact images: their triangles would press both sides differently.
        """
        found: list[Surface] = []
        for index, (surface, (first, flips)) in enumerate(
            zip(self.separated, self.orbits, strict=True)
        ):
            if first != index:
                made = found[first]
                for plane in flips:
                    made = image_of(made, plane)
            else:
                pairs = zip(self.sector.planes, self.images, strict=True)
                across = [plane for plane, images in pairs if images[index] == index]
                size = self.design.objects[index].voxel_size or self.design.voxel_size
                made = symmetric(surface, across, size)
            found.append(made)
        return tuple(found)

    def give_to(
        self,
        parts: _core.ProblemParts,
        origin: Floats | None = None,
        sharing: Sequence[Sharing] | None = None,
    ) -> None:
        """Add it to the parts of the problem of the sector; errors as for the class."""
        self._check_table()
        sector = self.sector
        own = self.sharing if sharing is None else sharing
        super().give_to(parts, sector.origin if origin is None else origin, own)
        voxels = [
            body.mesh.voxel_corners(np.arange(len(body.mesh.tets) // 5)) + body.first_vertex
            for body in self.mesh.each_body
        ]
        images = sector.source.astype(np.uint32), sector.signs
        planes = [
            (axis, image.astype(np.uint32))
            for axis, image in zip(sector.axes, sector.images, strict=True)
        ]
        parts.whole(images, np.concatenate(voxels).astype(np.uint32), planes)

    def contacts(self, found: Sequence[_core.Contact]) -> tuple[ContactState, ...]:
        """Convert the core's contacts, and add their images."""
        states = super().contacts(found)
        for axis, numbers in zip(self.sector.axes, self.all_images, strict=True):
            pairs = {self.names[at]: self.names[image] for at, image in enumerate(numbers)}
            states = with_images(states, pairs, axis, self.names)
        return states

    @cached_property
    def all_images(self) -> tuple[list[int], ...]:
        """Image of each of :attr:`names` for each plane: of bodies, objects, a floor."""
        count = len(self.sector.body_images[0])
        floor = [] if self.design.floor is None else [len(self.names) - 1]
        pairs = zip(self.sector.body_images, self.images, strict=True)
        return tuple(
            [*bodies, *(count + image for image in objects), *floor] for bodies, objects in pairs
        )

    @cached_property
    def images(self) -> tuple[list[int], ...]:
        """Number of the image of each object for each plane.

        Raises
        ------
        DesignError
            An object without an image.
        """
        count = len(self.design.objects)
        return tuple(
            [self._image_of(index, plane) for index in range(count)] for plane in self.sector.planes
        )

    @cached_property
    def orbits(self) -> list[tuple[int, tuple[Symmetry, ...]]]:
        """First image of each object, and the planes that mirror it there."""
        found = []
        for index in range(len(self.design.objects)):
            orbit: dict[int, tuple[Symmetry, ...]] = {}
            for chosen in product([False, True], repeat=len(self.images)):
                number = index
                pairs = zip(chosen, self.sector.planes, self.images, strict=True)
                flips = [(plane, images) for flip, plane, images in pairs if flip]
                for _, images in flips:
                    number = images[number]
                orbit.setdefault(number, tuple(plane for plane, _ in flips))
            first = min(orbit)
            found.append((first, orbit[first]))
        return found

    @cached_property
    def sharing(self) -> list[Sharing]:
        """Sharing of each object among its images."""
        sector, found = self.sector, list[Sharing]()
        firsts = [first for first, _ in self.orbits]
        for index, (first, flips) in enumerate(self.orbits):
            if self.design.objects[index].is_free and first != index:
                signs = np.ones(3)
                signs[[plane.axis for plane in flips]] = -1.0
                found.append(Sharing(of=first, signs=signs.tolist()))
                continue
            held = [False] * 3
            for axis, images in zip(sector.axes, self.images, strict=True):
                held[axis] = images[index] == index
            count = firsts.count(first)
            if count * 2 ** sum(held) != sector.count:
                what = "is its own image only across two planes at once"
                self._refuse(f"objects[{index}]", what)
            found.append(Sharing(share=count / sector.count, held=held))
        return found

    def _image_of(self, index: int, plane: Symmetry) -> int:
        """Find the number of the image of an object."""
        design, surfaces = self.design, self.separated
        mirrored = _mirrored(surfaces[index].vertices, plane)
        size = self.voxel_size
        best, off, place = -1, math.inf, np.zeros(3)
        for other, surface in enumerate(surfaces):
            if np.abs(surface.middle - Surface(mirrored, surface.triangles).middle).max() > size:
                continue
            distances = np.abs(distances_to(surface, mirrored))
            worst = int(distances.argmax())
            if distances[worst] < off:
                best, off = other, float(distances[worst])
                place = surfaces[index].vertices[worst]
        where = f"objects[{index}]"
        name = design.objects[index].name
        if off > _SAME_SURFACE * size:
            what = f'is not symmetric: "{name}" has no image across {plane.plane}'
            if best >= 0:
                x, y, z = 1e3 * place
                what += (
                    f', "{design.objects[best].name}" is {1e3 * off:.3g} mm off at '
                    f"({x:.1f}, {y:.1f}, {z:.1f}) mm"
                )
            raise DesignError(where, what, _HINT)
        self._check_same(index, best, plane)
        return best

    def _check_same(self, index: int, image: int, plane: Symmetry) -> None:
        """Raise unless an object and its image move alike."""
        each, other = (self.design.objects[number] for number in (index, image))
        where, across = f"objects[{index}]", f'"{other.name}", its image across {plane.plane}'
        if (each.is_free, each.mass, each.density) != (other.is_free, other.mass, other.density):
            what = f"is not symmetric: it is not held, or not as heavy, as {across}"
            raise DesignError(where, what, _HINT)
        if each.is_free:
            return
        if _history(each) != _history(other):
            what = f"is not symmetric: it has another history than {across}"
            raise DesignError(f"{where}.motion", what, _HINT)
        points = self.separated[index].vertices
        for part in _PARTS:
            mine = _mirrored(_moved(each, part, points), plane)
            its = _moved(other, part, _mirrored(points, plane))
            off = float(np.abs(mine - its).max())
            if off > _SAME_PLACE * self.voxel_size:
                what = f"is not symmetric: it moves {1e3 * off:.3g} mm away from {across}"
                raise DesignError(f"{where}.motion", what, _HINT)

    def _check_table(self) -> None:
        """Raise where friction differs from that of the images."""
        for plane, numbers in zip(self.sector.planes, self.all_images, strict=True):
            if plane.axis == 2 and self.floor is not None:
                self._refuse("floor", "points across z")
            table = self.friction
            differs = ~((table == table[np.ix_(numbers, numbers)]) | np.isnan(table))
            differs |= np.isnan(table) != np.isnan(table[np.ix_(numbers, numbers)])
            if differs.any():
                first, second = (self.names[at] for at in np.argwhere(differs)[0])
                what = f'"{first}" and "{second}" touch otherwise than their images across'
                self._refuse("contact", f"{what} {plane.plane}")

    def _refuse(self, where: str, what: str) -> NoReturn:
        raise DesignError(where, f"is not symmetric: {what}", _HINT)


def _mirrored(points: Floats, plane: Symmetry) -> Floats:
    found = points.copy()
    found[:, plane.axis] = 2.0 * plane.at - found[:, plane.axis]
    return found


def _history(each: Object) -> object:
    return None if each.way is None else each.way.history


def _moved(each: Object, part: float, points: Floats) -> Floats:
    """Move points by a part of the motion of an object, whatever its history."""
    way = each.way
    if way is None:
        return points
    rotation = way.rotation
    turned = rotation and rotation.model_copy(update={"angle": part * rotation.angle})
    displacement = tuple(part * along for along in way.displacement)
    changes = {"displacement": displacement, "rotation": turned, "history": None}
    return moved_by(Motion.model_copy(way, update=changes), points)
