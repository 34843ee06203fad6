"""Walls and chambers that whole voxels make thinner or thicker than the shapes say."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.errors import VoxSoftError
from voxsoft.materials import Hyperelastic
from voxsoft.mesh import Mesh
from voxsoft.shapes import TriangleMesh
from voxsoft.simulation.checks.unloaded import once_for_each_mesh
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.simulation.setup.volumes import GridRegions, shapes_of
from voxsoft.units import format_quantity

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
_Aside = Sequence[tuple[float, float]]

#: Relative difference from which a thickness is doubtful: bending stiffness goes with its cube.
LARGE: Final = 0.15
#: Thickest wall that is examined, in voxels: a thicker one is off by less than that, as each end is
#: by half a voxel at most.
_MOST_VOXELS: Final = 6
#: Rows that are measured along each axis, fewer for surfaces from files, and points in a voxel.
_ROWS, _ROWS_OF_A_FILE, _POINTS = 200, 40, 16
#: Factor on the points in a voxel for the thickness that is printed.
_FINER: Final = 32
#: Points by which a thickness of so few may be off: one for each of two layers in a wall.
_OFF: Final = 2
#: Offsets of parallel lines, in voxels: a wall is flat where it is as thick on all, to one point.
_ASIDE: Final[_Aside] = ((0.0, 0.0), (0.45, 0.45), (0.45, -0.45), (-0.45, 0.45), (-0.45, -0.45))
#: Smallest share of rows along an axis for a thickness to be judged.
_SHARE: Final = 0.1
#: Deviation from whole voxels up to which a voxel size fits; smallest such size over the present.
_FITS, _SMALLEST = 0.05, 0.2


class _Rows(NamedTuple):
    """Cells in rows along an axis: walls, or the insides of chambers.

    `first` is the first cell of each, (n, 3), `number` how many it has, (n,).
    """

    axis: int
    is_wall: bool
    first: Ints
    number: Ints


class _Measured(NamedTuple):
    """Walls, or chambers, of one thickness [m] along an axis: as described and as simulated."""

    is_wall: bool
    described: float
    simulated: float
    at: Floats

    @property
    def difference(self) -> float:
        """Relative difference of the simulated thickness from the described one."""
        return abs(self.simulated / self.described - 1.0)


@once_for_each_mesh
def coarse_walls(design: Design, mesh: Mesh) -> Iterator[Diagnostic]:
    """Find walls of chambers, and chambers, whose voxels have another thickness than their shapes.

    Rows of voxels along the axes that begin or end at a chamber are measured in the shapes along
    the same line. Flat walls along the grid are judged: voxels of inclined and curved ones are too
    thick here and too thin there; :mod:`voxsoft.simulation.setup.volumes` compares their sum. Cut
    voxels carry their share of material, and are not examined.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> box = vs.Box(size=(0.02, 0.02, 0.02), corner=(0, 0, 0))
    >>> room = vs.Box(size=(0.013, 0.013, 0.013), corner=(0.0035, 0.0035, 0.0035))
    >>> hollow = families.beam().replace(shapes={"body": box - room}, voxel_size=0.0025)
    >>> hollow = hollow.replace(fill="binary")
    >>> found = list(coarse_walls(hollow, vs.mesh_of(hollow)))
    >>> print(found[0])  # doctest: +ELLIPSIS
    voxel_size: walls 3.5 mm thick are solved as 2.5 mm (1 voxel), near ...
    """
    for body in mesh.each_body:
        own = design.alone(body.name) if body.name else design
        size = body.mesh.voxel_size
        if size is None or body.mesh.fractions is not None or not body.mesh.cavities:
            continue
        try:
            found = _of_body(own, body.mesh, size)
        except VoxSoftError:
            continue  # a shape without a value somewhere is reported where it is sampled
        where = f'body "{body.name}", voxel_size' if body.name else "voxel_size"
        yield from _worded(found, size, where, may_cut=_may_cut(own))


def _of_body(design: Design, mesh: Mesh, size: float) -> list[_Measured]:
    cells = GridRegions.of(mesh, size)
    shapes = built_parts(design)
    slow = any(isinstance(each, TriangleMesh) for each in shapes_of(design))
    every = [
        _some(rows, _ROWS_OF_A_FILE if slow else _ROWS)
        for axis in range(3)
        for rows in _rows(cells.rooms, axis)
    ]
    every = [rows for rows in every if len(rows.number)]
    # More lines and finer points take most of the time: first for those that may be doubtful, then
    # for all.
    doubted = (_doubted(rows, shapes, cells) for rows in every)
    finer = (each for rows in doubted for each in _measured(rows, shapes, cells))
    if not any(each.difference >= LARGE for each in finer):
        return []
    found = (_flat(rows, shapes, cells, len(rows.number)) for rows in every)
    return [each for rows in found for each in _measured(rows, shapes, cells)]


def _rows(rooms: NDArray[np.int16], axis: int) -> Iterator[_Rows]:
    """Yield the rows of cells along an axis in walls beside a chamber, and in chambers."""
    lines = np.moveaxis(rooms, axis, -1)
    shape = lines.shape
    flat = np.ascontiguousarray(lines).reshape(-1, shape[-1])
    line, last = np.nonzero(flat[:, 1:] != flat[:, :-1])
    # Between two changes of one line lies a row; the grid has empty cells around the body.
    inner = np.flatnonzero(line[1:] == line[:-1])
    line, first, count = line[inner], last[inner] + 1, last[inner + 1] - last[inner]
    region, before = flat[line, first], flat[line, first - 1]
    after = flat[line, first + count]
    cell = np.stack([*np.unravel_index(line, shape[:-1]), first], axis=1)
    cell = np.insert(cell[:, :2], axis, first, axis=1)
    is_wall = (region == -2) & ((before >= 0) | (after >= 0))
    for wanted, kind in ((is_wall, True), (region >= 0, False)):
        wanted &= count <= _MOST_VOXELS
        yield _Rows(axis, kind, cell[wanted], count[wanted])


def _some(rows: _Rows, most: int) -> _Rows:
    return _picked(rows, slice(None, None, max(1, -(-len(rows.number) // most))))


def _picked(rows: _Rows, which: slice | Ints | NDArray[np.bool_]) -> _Rows:
    return rows._replace(first=rows.first[which], number=rows.number[which])


def _described(
    rows: _Rows,
    shapes: Sequence[_core.Shape],
    cells: GridRegions,
    finer: int = 1,
    aside: _Aside = _ASIDE,
) -> Floats:
    """Measure the material, or void, of the shapes along each row [m]; 0 where it varies, (n,).

    Half a voxel at both ends belongs to a row: no flat face is farther from the ends of its voxels.
    """
    points = finer * _POINTS
    longest = int(rows.number.max(initial=0))
    steps = (np.arange((longest + 1) * points) + 0.5) / points - 0.5
    places = np.tile((rows.first + 0.5)[None, :, None, :], (len(aside), 1, len(steps), 1))
    places[..., rows.axis] += steps - 0.5
    places[..., np.arange(3) != rows.axis] += np.array(aside)[:, None, None, :]
    spots = np.ascontiguousarray((cells.origin + cells.size * places).reshape(-1, 3))
    inside = np.zeros(len(spots), dtype=bool)
    for shape in shapes:
        inside |= shape.evaluate(spots) < 0.0
    wanted = inside.reshape(len(aside), len(rows.number), len(steps)) == rows.is_wall
    wanted &= steps < rows.number[:, None] + 0.5
    within = wanted.sum(axis=-1)
    lengths: Floats = within[0] * (cells.size / points)
    return np.where(np.ptp(within, axis=0) <= finer, lengths, 0.0)


def _doubted(rows: _Rows, shapes: Sequence[_core.Shape], cells: GridRegions) -> _Rows:
    """Return those rows of :func:`_flat` whose thickness may be a doubtful one."""
    # A flat row is as thick on all lines as on the first, so that many rows share it there too.
    points = _points(rows, shapes, cells, _ASIDE[:1])
    _, kind, count = np.unique(_kinds(rows, points), return_inverse=True, return_counts=True)
    shared = count[kind.reshape(-1)] >= _SHARE * len(points)
    some = _picked(rows, shared & (points > 0.0) & _may_differ(rows, points))
    return _flat(some, shapes, cells, len(points)) if len(some.number) else some


def _flat(rows: _Rows, shapes: Sequence[_core.Shape], cells: GridRegions, total: int) -> _Rows:
    """Return one row of each thickness that many rows of a total number share."""
    points = _points(rows, shapes, cells, _ASIDE)
    _, first, count = np.unique(_kinds(rows, points), return_index=True, return_counts=True)
    return _picked(rows, first[(count >= _SHARE * total) & (points[first] > 0.0)])


def _points(
    rows: _Rows, shapes: Sequence[_core.Shape], cells: GridRegions, aside: _Aside
) -> Floats:
    """Thickness of each row in points, (n,)."""
    lengths = _described(rows, shapes, cells, 1, aside)
    points: Floats = np.rint(lengths * (_POINTS / cells.size))
    return points


def _kinds(rows: _Rows, points: Floats) -> Ints:
    """One number for each pair of a thickness and a number of voxels, in their order, (n,)."""
    kinds: Ints = points.astype(np.intp) * (_MOST_VOXELS + 1) + rows.number
    return kinds


def _may_differ(rows: _Rows, points: Floats) -> NDArray[np.bool_]:
    """Mark rows whose thickness, so many points, may be a doubtful one, (n,)."""
    simulated = rows.number * _POINTS
    least = np.maximum(points - _OFF, 1e-300)
    off: NDArray[np.bool_] = simulated / least - 1.0 >= LARGE
    return off | (1.0 - simulated / (points + _OFF) >= LARGE)


def _measured(
    rows: _Rows, shapes: Sequence[_core.Shape], cells: GridRegions
) -> Iterator[_Measured]:
    """Yield the thickness of each row, with finer points."""
    described = _described(rows, shapes, cells, _FINER)
    for cell, number, length in zip(rows.first, rows.number, described.tolist(), strict=True):
        middle = cell + 0.5
        middle[rows.axis] += 0.5 * (number - 1)
        at = cells.origin + cells.size * middle
        if length > 0.0:
            yield _Measured(rows.is_wall, length, float(cells.size * number), at)


def _worded(
    found: Sequence[_Measured], size: float, where: str, *, may_cut: bool
) -> Iterator[Diagnostic]:
    if not found:
        return
    fitting = _fitting([each.described for each in found], size)
    hint = f'set voxel_size = "{_length(fitting, 4)}" or smaller, or make both multiples of a voxel'
    if may_cut:
        hint = f'set fill = "fraction", {hint.removeprefix("set ")}'
    for is_wall, words in ((True, "walls {} thick"), (False, "chambers {} wide")):
        off = [each for each in found if each.is_wall == is_wall and each.difference >= LARGE]
        if not off:
            continue
        worst = max(off, key=lambda each: each.difference)
        voxels = worst.simulated / size
        number = f"{voxels:.2g} voxel{'' if round(voxels, 1) == 1.0 else 's'}"
        x, y, z = worst.at.tolist()
        what = (
            f"{words.format(_length(worst.described))} are solved as {_length(worst.simulated)} "
            f"({number}), {near((x, y, z))}"
        )
        yield Diagnostic("warning", where, what, hint, (x, y, z))


def _fitting(lengths: Sequence[float], size: float) -> float:
    """The largest voxel size below `size` of which all lengths are nearly multiples."""
    least = min(lengths)
    for times in range(int(np.ceil(least / size - _FITS)), int(least / (_SMALLEST * size)) + 1):
        if times < 1 or least / times > size * (1.0 - _FITS):
            continue
        parts = np.asarray(lengths) * times / least
        if (np.abs(parts - np.rint(parts)) <= _FITS * np.maximum(1.0, parts / 4)).all():
            return least / times
    return min(size, least) / 2.0


def _length(value: float, digits: int = 3) -> str:
    return format_quantity(float(f"{value:.{digits}g}"), "length")


def _may_cut(design: Design) -> bool:
    """Return True if cut voxels are a remedy: all is rubber, and its voxels are full or empty."""
    return not design.has_cut_voxels and all(
        isinstance(design.material_of(part), Hyperelastic) for part in design.parts
    )
