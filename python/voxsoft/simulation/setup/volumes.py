"""Volumes of parts and chambers: as simulated, and as the shapes describe them."""

from __future__ import annotations

import math
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import beside_others, built_parts
from voxsoft.errors import VoxSoftError
from voxsoft.geometry import tet_volumes
from voxsoft.materials import Hyperelastic
from voxsoft.mesh import Mesh
from voxsoft.shapes import Shape, TriangleMesh
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_quantity
from voxsoft.voxels import Voxels

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

#: Relative difference from which a volume is doubtful.
LARGE: Final = 0.03
#: Difference beyond which it is printed in whole percent, the accuracy of a quick estimate.
_LARGER: Final = 0.1
#: Largest number of points for a table, and for a warning, some 0.3 %: a body of k cells at its
#: surface with m³ random points in each is off by some √k/(2 m²) cells.
PRECISE, QUICK = 200_000, 5_000
#: Relative accuracy of the smallest part or cavity at which more points are of no use.
_ENOUGH = 1e-3
#: Differences between which a quick estimate is repeated, and its factor on the points.
_SUSPECT, _AGAIN = (0.02, 0.05), 8
#: Divisor of the points for surfaces from files, whose distance takes fifty times as long.
_OF_A_FILE = 10
#: Points along a cell, at most, and empty cells around the body.
_MOST_ALONG, _RIM = 24, 2
#: Points evaluated at once.
_CHUNK = 1 << 18


class Volume(NamedTuple):
    """A volume [m³] as simulated and as described."""

    simulated: float
    described: float

    @property
    def difference(self) -> float:
        """Relative difference of the simulated from the described volume."""
        if self.described <= 0.0:
            return math.inf if self.simulated > 0.0 else 0.0
        return self.simulated / self.described - 1.0

    def summary(self) -> dict[str, float]:
        """Return both as plain data."""
        return {"simulated": self.simulated, "described": self.described}


@dataclass(frozen=True)
class Volumes:
    """Volumes of a design.

    Attributes
    ----------
    parts
        Volume of each part, by its name or else ``parts[i]``.
    cavities
        Volume of each cavity, by its name or else ``cavity i``. Cavities that a layer closes or
        divides are left out.
    """

    parts: Mapping[str, Volume] = field(default_factory=dict)
    cavities: Mapping[str, Volume] = field(default_factory=dict)

    @property
    def every(self) -> tuple[Volume, ...]:
        """Volumes of all parts and cavities."""
        return (*self.parts.values(), *self.cavities.values())

    def summary(self) -> dict[str, dict[str, dict[str, float]]]:
        """Return everything as plain data (``volumes`` of ``--json``)."""
        return {
            "parts": {name: volume.summary() for name, volume in self.parts.items()},
            "cavities": {name: volume.summary() for name, volume in self.cavities.items()},
        }


#: Cache of the volumes of meshes that are still in use, by their identity.
_known: dict[int, tuple[Design, int, Volumes]] = {}


def volumes_of(design: Design, mesh: Mesh, points: int = PRECISE) -> Volumes:
    """Compare the volumes of a body's voxels with those of its shapes.

    The shapes are sampled at random points, evenly spread over each cell near the surface; cells
    within and outside of it count as a whole.

    Parameters
    ----------
    design
        The design.
    mesh
        Its mesh of voxels; other elements give no volumes.
    points
        Number of sample points.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> beam = families.beam()
    >>> (volume,) = volumes_of(beam, mesh_of(beam)).parts.values()
    >>> round(volume.simulated * 1e6, 6), round(volume.described * 1e6, 6)
    (10.0, 10.0)
    """
    known = _known.get(id(mesh))
    if known is not None and known[0] is design and known[1] >= points:
        return known[2]
    parts: dict[str, Volume] = {}
    cavities: dict[str, Volume] = {}
    first = 0
    for body in mesh.each_body:
        own = design.alone(body.name) if body.name else design
        found = _of_body(own, body.mesh, points)
        number = len(body.mesh.cavities)
        if found is not None:
            labels = labels_of(design, body.name)
            parts |= dict(zip(labels, found[0], strict=True))
            names = [
                mesh.cavities[first + index].name or f"cavity {first + index}"
                for index in range(number)
            ]
            pairs = zip(names, found[1], strict=True)
            cavities |= {name: volume for name, volume in pairs if volume is not None}
        first += number
    volumes = Volumes(parts, cavities)
    if known is None:
        weakref.finalize(mesh, _known.pop, id(mesh), None)
    _known[id(mesh)] = (design, points, volumes)
    return volumes


def volumes_in(shape: Shape, mesh: Mesh, name: str, points: int = PRECISE) -> Volumes:
    """Compare the voxels of one shape with it; parameters are those of :func:`volumes_of`.

    `name` is the name of the shape.

    Examples
    --------
    >>> from voxsoft.shapes import Box, voxelize
    >>> box = Box(size=(0.01, 0.01, 0.01))
    >>> found = volumes_in(box, voxelize(box, 0.003).mesh(), "box").parts["box"]
    >>> f"{found.difference:.1%}"
    '-27.1%'
    """
    if mesh.voxel_size is None:
        return Volumes()
    cells = GridRegions.of(mesh, mesh.voxel_size)
    (material,), rooms = _described([shape.build()], cells, _affordable(shape.every(None), points))
    pairs = zip(mesh.cavities, rooms.tolist(), strict=True)
    return Volumes(
        {name: Volume(mesh.volume, float(material))},
        {f"cavity {i}": Volume(float(c.volume), room) for i, (c, room) in enumerate(pairs)},
    )


def doubtful_volumes(
    design: Design, mesh: Mesh, positions: Floats | None = None, points: int = QUICK
) -> Iterator[Diagnostic]:
    """Find parts and chambers whose voxels have another volume than their shapes.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> from voxsoft.design.discretization.discretize import mesh_of
    >>> ball = families.sphere().replace(fill="binary")
    >>> print(*doubtful_volumes(ball, mesh_of(ball)))  # doctest: +ELLIPSIS
    cavity 0: the chamber has 17 mL in voxels; its shapes have 14 mL (+2...%). Try: ...
    """
    low, high = _SUSPECT
    try:
        volumes = volumes_of(design, mesh, points)
        if any(low < abs(each.difference) < high for each in volumes.every):
            volumes = volumes_of(design, mesh, max(points, _AGAIN * QUICK))
    except VoxSoftError:
        return  # a shape without a value somewhere is reported where it is sampled
    yield from doubts(volumes, _remedy(design))


def doubts(volumes: Volumes, remedy: str) -> Iterator[Diagnostic]:
    """Warn of large differences among volumes, with a remedy."""
    for kind, found in (("part", volumes.parts), ("chamber", volumes.cavities)):
        for name, volume in found.items():
            if abs(volume.difference) >= LARGE:
                yield _doubt(kind, name, volume, remedy)


def _remedy(design: Design) -> str:
    whole = "multiples" if not design.symmetry else "even multiples across a plane of symmetry"
    ways = f"make the voxels smaller, or its sizes {whole} of the voxel size"
    may_cut = not design.has_cut_voxels and not design.bodies and _is_rubber(design)
    return f'set fill = "fraction", {ways}' if may_cut else ways


def _doubt(kind: str, name: str, volume: Volume, remedy: str) -> Diagnostic:
    simulated, described = (format_quantity(float(f"{v:.3g}"), "volume") for v in volume)
    what = f"the {kind} has {simulated} in voxels; its shapes have {described}"
    if math.isfinite(volume.difference):
        digits = 0 if abs(volume.difference) > _LARGER else 1
        what += f" ({volume.difference:+.{digits}%})"
    return Diagnostic("warning", name, what, remedy)


def _is_rubber(design: Design) -> bool:
    return all(isinstance(design.material_of(part), Hyperelastic) for part in design.parts)


def labels_of(design: Design, body: str) -> list[str]:
    """Return the names of the parts of a body, each by another name."""
    labels: list[str] = []
    for index, part in enumerate(design.parts):
        if body and part.body != body:
            continue
        label = part.label
        labels.append(f"parts[{index}]" if not label or label in labels else label)
    return labels


def _of_body(
    design: Design, mesh: Mesh, points: int
) -> tuple[list[Volume], list[Volume | None]] | None:
    """Compare the volumes of parts and cavities of one body; None where it has no voxels.

    Cavities that a layer closes or divides have none.
    """
    size = mesh.voxel_size
    if size is None or mesh.tet_voxel is None or not design.parts:
        return None
    cells = GridRegions.of(mesh, size)
    material, room = _described(built_parts(design), cells, _affordable(shapes_of(design), points))
    own = tet_volumes(mesh.vertices, mesh.tets)
    if mesh.fractions is not None:
        own = own * mesh.fractions[mesh.tet_voxel]
    simulated = np.bincount(mesh.tet_part, own, len(design.parts) + 1)[1:]
    pairs = zip(mesh.cavities, _rooms_of(mesh, cells, len(room)), strict=True)
    return (
        [Volume(*pair) for pair in zip(simulated.tolist(), material.tolist(), strict=True)],
        [None if at is None else Volume(float(c.volume), float(room[at])) for c, at in pairs],
    )


def _rooms_of(mesh: Mesh, cells: GridRegions, count: int) -> list[int | None]:
    """Find the room of the grid that each cavity of a mesh is; None for one that a layer bounds."""
    if len(mesh.cavities) == count:
        return [*range(count)]
    found = [cells.room_behind(mesh.vertices[cavity.triangles]) for cavity in mesh.cavities]
    return [room if found.count(room) == 1 else None for room in found]


@dataclass(frozen=True, eq=False)
class GridRegions:
    """Cells of a body's grid, with a rim of empty ones.

    `parts` is the part of each from 1, 0 for none; `rooms` the cavity of each from 0, -1 for the
    outside and -2 for material.
    """

    origin: Floats
    size: float
    parts: NDArray[np.uint8]
    rooms: NDArray[np.int16]

    @classmethod
    def of(cls, mesh: Mesh, size: float) -> GridRegions:
        """Return the cells of the voxels of a mesh, of edge `size` [m]; found once for a mesh."""
        if id(mesh) not in _regions_known:
            _regions_known[id(mesh)] = cls._of(mesh, size)
            weakref.finalize(mesh, _regions_known.pop, id(mesh), None)
        return _regions_known[id(mesh)]

    @classmethod
    def _of(cls, mesh: Mesh, size: float) -> GridRegions:
        corners = mesh.vertices[mesh.tets.reshape(-1, 20)].min(axis=1)
        origin = corners.min(axis=0) - _RIM * size
        cells = np.rint((corners - origin) / size).astype(np.intp)
        parts = np.zeros(cells.max(axis=0) + 1 + _RIM, dtype=np.uint8)
        parts[tuple(cells.T)] = mesh.tet_part[::5]
        voxels = Voxels.from_array(parts, size)
        rooms = np.where(parts > 0, -2, -1).astype(np.int16)
        for index, cavity in enumerate(voxels.cavities):
            rooms[tuple(cavity.cells.T)] = index
        return cls(origin, size, parts, rooms)

    def room_behind(self, triangles: Floats) -> int | None:
        """Find the enclosed room that triangles on faces of voxels point into, (t, 3, 3) [m]."""
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        beside = (triangles.mean(axis=1) - self.origin) / self.size + 0.5 * normals
        found = self.rooms[tuple(np.floor(beside).astype(np.intp).T)]
        enclosed = found[found >= 0]
        return int(np.bincount(enclosed).argmax()) if len(enclosed) else None

    @property
    def near(self) -> NDArray[np.bool_]:
        """Cells with a cell of another part beside them."""
        return beside_others(self.parts)


def _affordable(shapes: Iterable[Shape], points: int) -> int:
    return points // _OF_A_FILE if any(isinstance(e, TriangleMesh) for e in shapes) else points


def _described(
    shapes: Sequence[_core.Shape], cells: GridRegions, points: int
) -> tuple[Floats, Floats]:
    """Estimate the volumes of parts and cavities of the shapes [m³], each by number."""
    near = cells.near
    whole = np.bincount(cells.parts[~near], minlength=len(shapes) + 1)[1:].astype(float)
    count = int(cells.rooms.max(initial=-1)) + 1
    rooms = np.bincount(np.maximum(cells.rooms[~near] + 1, 0), minlength=count + 1)[1:].astype(
        float
    )
    places = np.argwhere(near)
    sizes = [*np.bincount(cells.parts.reshape(-1))[1:], *np.bincount(cells.rooms[cells.rooms >= 0])]
    smallest = min((int(each) for each in sizes if each), default=1)
    enough = np.ceil(np.sqrt(np.sqrt(len(places)) / (2.0 * _ENOUGH * smallest)))
    most = round((points / max(len(places), 1)) ** (1 / 3))
    along = int(np.clip(min(most, enough), 2, _MOST_ALONG))
    rng = np.random.default_rng(0)
    step = max(1, _CHUNK // along**3)
    for start in range(0, len(places), step):
        chunk = places[start : start + step]
        within = (_strata(along) + rng.random((len(chunk), along**3, 3))) / along
        owner = np.zeros(within.shape[:2], dtype=np.intp)
        spots = cells.origin + cells.size * (chunk[:, None, :] + within)
        flat = np.ascontiguousarray(spots.reshape(-1, 3))
        for number in range(len(shapes), 0, -1):  # the first part wins
            values = shapes[number - 1].evaluate(flat).reshape(owner.shape)
            owner[values < 0.0] = number
        share = 1.0 / along**3
        whole += share * np.bincount(owner.reshape(-1), minlength=len(shapes) + 1)[1:]
        if count:
            empty = np.nonzero(owner == 0)
            region = _regions(cells.rooms, chunk, within, empty)
            rooms += share * np.bincount(region + 1, minlength=count + 1)[1:]
    return whole * cells.size**3, rooms * cells.size**3


def _regions(
    rooms: NDArray[np.int16], places: Ints, within: Floats, empty: tuple[Ints, ...]
) -> Ints:
    """Find the cavity of each empty point, -1 for none: that of the nearest empty cell."""
    around = places[:, None, :] + _AROUND.astype(np.intp)
    inside = ((around >= 0) & (around < rooms.shape)).all(axis=-1)
    clipped = np.minimum(np.maximum(around, 0), np.array(rooms.shape) - 1)
    labels = np.where(inside, rooms[tuple(np.moveaxis(clipped, -1, 0))], -1)
    row, column = empty
    found = np.full(len(row), -1, dtype=np.intp)
    # Rows whose empty cells are of one region need no distances.
    high = labels.max(axis=1)
    low = np.where(labels == -2, np.iinfo(np.int16).max, labels).min(axis=1)
    clear = (high == low)[row]
    found[clear] = np.maximum(high[row[clear]], -1)
    torn = np.flatnonzero(~clear & (high[row] >= 0))
    for start in range(0, len(torn), _CHUNK // len(_AROUND)):
        some = torn[start : start + _CHUNK // len(_AROUND)]
        spot = within[row[some], column[some]]
        # Squared distance along an axis to the cell below, to its own and to the one above.
        x, y, z = np.stack([spot**2, np.zeros_like(spot), (1.0 - spot) ** 2], axis=-1).swapaxes(
            0, 1
        )
        far = (x[:, :, None, None] + y[:, None, :, None] + z[:, None, None]).reshape(len(some), -1)
        far[labels[row[some]] == -2] = np.inf
        found[some] = np.maximum(labels[row[some], far.argmin(axis=1)], -1)
    return found


def shapes_of(design: Design) -> Iterator[Shape]:
    """Yield every shape that the parts of a design are made of."""
    for part in design.parts:
        shape = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        yield from shape.every(design.shapes)


def _strata(along: int) -> Floats:
    """Lowest corners of small cubes in a cell of edge `along`, (along³, 3)."""
    steps = np.arange(along)
    found: Floats = (
        np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
        .reshape(-1, 3)
        .astype(np.float64)
    )
    return found


_AROUND: Final[Floats] = _strata(3) - 1.0
#: Cells of meshes that are still in use, by their identity.
_regions_known: Final[dict[int, GridRegions]] = {}
