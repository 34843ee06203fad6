"""Workspace of a robot: equilibria of a place over a grid of drives."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design, require_design
from voxsoft.errors import SimulationError
from voxsoft.records import closest
from voxsoft.simulation.runs.load_path import LoadPath, follow
from voxsoft.simulation.runs.over import Over
from voxsoft.simulation.runs.run import ProgressCallback

Floats = NDArray[np.float64]

#: Kinds of quantity of the size of a workspace with one, two and three drives.
KINDS_OF_SIZE: Final = ("length", "area", "volume")
#: Rounding as a part of the longest extent: places so close to a plane lie in it.
_FLAT: Final = 1e-9


@dataclass(frozen=True)
class Workspace:
    """Positions of a place of a robot over a grid of drives.

    Attributes
    ----------
    design
        The robot.
    probe
        The place.
    drives
        The keys that drive it, each with its values.
    paths
        A path for each line of the grid: the last drive changes along it. Fewer while it is solved.
    """

    design: Design
    probe: str
    drives: tuple[Over, ...]
    paths: tuple[LoadPath, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each drive."""
        return tuple(len(drive.values) for drive in self.drives)

    @property
    def points(self) -> Floats:
        """Positions of the place, (*shape, 3), m; NaN where no equilibrium was found."""
        *lines, along = self.shape
        found = np.full((int(np.prod(lines)), along, 3), np.nan)
        for line, path in zip(found, self.paths, strict=False):
            for number, result in enumerate(path.results):
                if result.status == "ok":
                    place = result.places[self.probe]
                    line[number] = place.weights @ result.positions[place.vertices]
        return found.reshape(*self.shape, 3)

    @property
    def unloaded(self) -> Floats:
        """Position of the place in the unloaded design, (3,), m."""
        first = self.paths[0].results[0]
        place = first.places[self.probe]
        found: Floats = place.weights @ first.mesh.vertices[place.vertices]
        return found

    @property
    def missing(self) -> int:
        """Number of points of the grid at which no equilibrium was found."""
        return int(np.isnan(self.points[..., 0]).sum())

    @property
    def size(self) -> float:
        """Length, area or volume of the net of places; see :func:`size_of_net`."""
        return size_of_net(self.points)

    @property
    def size_kind(self) -> str:
        """``"length"``, ``"area"`` or ``"volume"``."""
        return KINDS_OF_SIZE[len(self.drives) - 1]

    @property
    def hull_volume(self) -> float:
        """Volume of the convex hull of all places, m³; 0 where they lie in a plane.

        It is no less than the volume that can be reached: a bowl is filled.
        """
        from scipy.spatial import ConvexHull, QhullError  # slow to load

        points = self.points.reshape(-1, 3)
        points = points[np.isfinite(points[:, 0])]
        if len(points) < 4:
            return 0.0
        spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if spread[-1] <= _FLAT * spread[0]:
            return 0.0
        try:
            return float(ConvexHull(points).volume)
        except QhullError:
            return 0.0

    @property
    def extents(self) -> tuple[tuple[float, float], ...]:
        """Smallest and largest x, y and z, m."""
        points = self.points.reshape(-1, 3)
        if not np.isfinite(points).any():
            return ((np.nan, np.nan),) * 3
        rounding = _FLAT * np.nanmax(np.abs(points))
        points = np.where(np.abs(points) <= rounding, 0.0, points)
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        return tuple(zip(low.tolist(), high.tolist(), strict=True))

    def table(self) -> list[dict[str, float]]:
        """Return a row for each point of the grid: the drives by their keys, and x, y, z in m."""
        grid = itertools.product(*(drive.values for drive in self.drives))
        keys = [drive.key for drive in self.drives]
        return [
            {**dict(zip(keys, values, strict=True)), "x": x, "y": y, "z": z}
            for values, (x, y, z) in zip(grid, self.points.reshape(-1, 3).tolist(), strict=True)
        ]


def size_of_net(points: Floats) -> float:
    """Compute length, area or volume of a net of one, two or three directions.

    Parameters
    ----------
    points
        Positions, (n, 3), (n, m, 3) or (n, m, k, 3), m. Cells are cut into simplices: space that is
        reached in two ways counts twice, and a cell with a corner that is NaN does not count.

    Examples
    --------
    >>> square = np.array([[[0, 0, 1], [0, 2, 1]], [[3, 0, 1], [3, 2, 1]]], dtype=float)
    >>> round(size_of_net(square), 12)
    6.0
    """
    count = points.ndim - 1
    corners = {each: _corner(points, each) for each in itertools.product((0, 1), repeat=count)}
    complete = np.all([np.isfinite(each).all(axis=-1) for each in corners.values()], axis=0)
    total = 0.0
    # Kuhn's triangulation of a cube: one simplex for each order of its axes.
    for walk in itertools.permutations(range(count)):
        way = [
            tuple(int(axis in walk[:steps]) for axis in range(count))
            for steps in range(1, count + 1)
        ]
        first = corners[(0,) * count][complete]
        edges = np.stack([corners[each][complete] - first for each in way], axis=-2)
        # The volume of a simplex by the Gram determinant of its edges.
        gram = np.linalg.det(edges @ edges.swapaxes(-1, -2))
        total += float(np.sqrt(np.maximum(gram, 0.0)).sum())
    return total / math.factorial(count)


def _corner(points: Floats, corner: tuple[int, ...]) -> Floats:
    """Return one corner of every cell of a grid of points."""
    each = tuple(slice(c, n - 1 + c) for c, n in zip(corner, points.shape[:-1], strict=True))
    found: Floats = points[each]
    return found


def workspace(
    design: Design,
    probe: str,
    drives: Sequence[Over | str],
    *,
    progress: ProgressCallback | None = None,
    line: Callable[[Workspace], None] | None = None,
    **settings: Any,  # noqa: ANN401 - the fields of Solver declare the types
) -> Workspace:
    """Find the workspace of a place of a robot, over a grid of drives.

    Parameters
    ----------
    design
        The robot.
    probe
        The place, a probe of the design.
    drives
        One to three keys with their values, as :func:`voxsoft.follow` takes them: pressures,
        tensions, or parameters of them. The last changes fastest, each equilibrium beginning at
        the one before it, so let the smoothest be the last.
    progress
        See :func:`voxsoft.simulate`.
    line
        Called after each line of the grid with the workspace so far.
    **settings
        Fields of :class:`voxsoft.design.Solver` that replace the design's own.

    Returns
    -------
    Workspace
        Places without an equilibrium are NaN.

    Raises
    ------
    DesignError, SimulationError
        Errors of :func:`voxsoft.follow`; an unknown probe; no drive, or more than three.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> finger = families.pneunet(chambers=2)
    >>> found = vs.workspace(finger, "tip", ["loads[0].value=0..1 kPa/3"])
    >>> found.shape, found.size_kind, f"{1e3 * found.size:.1f} mm"
    ((3,), 'length', '1.4 mm')
    """
    given = require_design(design)
    if probe not in given.probes:
        raise SimulationError("probe", f'there is no probe "{probe}"', closest(probe, given.probes))
    asked = tuple(each if isinstance(each, Over) else Over.read(each) for each in drives)
    if not 1 <= len(asked) <= len(KINDS_OF_SIZE):
        what = f"has {len(asked)} entries"
        raise SimulationError("drives", what, 'give one to three, such as "left=0..6 N/7"')
    repeated = [each.key for each in asked if [other.key for other in asked].count(each.key) > 1]
    if repeated:
        raise SimulationError("drives", f"has {repeated[0]} twice", "give each key once")
    *outer, inner = asked
    found = Workspace(given, probe, asked, ())
    for values in itertools.product(*(drive.values for drive in outer)):
        set_to = [f"{d.key}={d.toml(v)}" for d, v in zip(outer, values, strict=True)]
        path = follow(given.with_values(*set_to), inner, progress=progress, **settings)
        found = replace(found, paths=(*found.paths, path))
        if line is not None:
            line(found)
    return found
