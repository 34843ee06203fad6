"""The grid of a design: the size of its cells and where they lie."""

from __future__ import annotations

from voxsoft.design.model import Design
from voxsoft.shapes.base import Triple
from voxsoft.shapes.sampling import Body


def grid_of(design: Design) -> Body:
    """Put the parts of a design with one body on their grid.

    Along the axis of a plane of symmetry the plane lies on faces of voxels; else the phase is
    chosen from the shapes.

    Raises
    ------
    ShapeError
        A shape has no end or no value somewhere, no cell's center lies inside a part, or the grid
        would not fit in memory.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> grid_of(families.beam()).phase
    (0.0, 0.0, 0.0)
    """
    given: list[float | None] = [None, None, None]
    for plane in design.symmetry:
        given[plane.axis] = plane.at
    shapes = [design.shapes[s] if isinstance(s := p.shape, str) else s for p in design.parts]
    return Body(shapes, design.voxel_size, design.shapes, given)


def phase_of(design: Design) -> Triple:
    """Return where the grid of a design with one body lies: a corner of a cell [m].

    Every finer grid of the design passes through it too. Errors are those of :func:`grid_of`.
    """
    return grid_of(design).phase
