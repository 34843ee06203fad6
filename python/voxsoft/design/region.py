"""Places of a design: regions to clamp, load and measure at."""

from __future__ import annotations

from pydantic import model_validator

from voxsoft.design.operands import Name, ShapeOrName
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import ExtendedLength, Point, PositiveLength, format_quantity

Range = tuple[ExtendedLength, ExtendedLength]


class Region(Record):
    """A place in space: where all given conditions hold.

    Parameters
    ----------
    x, y, z
        Ranges ``(low, high)`` along the axes; equal bounds make a plane, ``-inf`` and ``inf``
        leave a side open. A missing axis is not limited.
    center, radius
        A ball.
    shape
        The inside of a shape: its name, or the shape itself.
    name
        The name of a region of the file, in a design whose body is the mesh of one: exactly its
        vertices.
    body
        The name of a body, in whose own frame all this is then meant, before it is turned and
        moved; alone: all of that body. Default: all bodies, in the frame of the design.

    Notes
    -----
    A region catches the vertices of the mesh that lie in it or within half a voxel of it,
    so that a plane given in meters finds its layer of vertices.

    Examples
    --------
    >>> from voxsoft.units import mm
    >>> Region(x=(0, 10 * mm)).x
    (0.0, 0.01)
    >>> Region(z=("5 mm", "2 mm"))
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: z: starts at 5 mm, above its end at 2 mm. Try: swap the two
    """

    x: Range | None = None
    y: Range | None = None
    z: Range | None = None
    center: Point | None = None
    radius: PositiveLength | None = None
    shape: ShapeOrName | None = None
    name: Name | None = None
    body: Name | None = None

    @model_validator(mode="after")
    def _check(self) -> Region:
        for axis in ("x", "y", "z"):
            _check_range(axis, getattr(self, axis))
        if (self.center is None) != (self.radius is None):
            raise DesignError("", "a ball needs both center and radius")
        self._check_conditions()
        return self

    def _check_conditions(self) -> None:
        if not self._conditions() and self.body is None:
            hint = "give x, y or z ranges, center and radius, or a shape"
            raise DesignError("", "says nowhere", hint)

    def _conditions(self) -> list[object]:
        places = (self.x, self.y, self.z, self.radius, self.shape, self.name)
        return [place for place in places if place is not None]


class Spot(Region):
    """A point, or a region."""

    point: Point | None = None

    def _check_conditions(self) -> None:
        if self.point is None:
            super()._check_conditions()
        elif self._conditions():
            raise DesignError("", "has both a point and a region", "keep one of them")


class Probe(Spot):
    """A place to measure at: a point, or the average over a region.

    Parameters
    ----------
    point
        A point in the undeformed body; values are interpolated in the voxel that holds it. With
        `body` it is in the own frame of that.

    Examples
    --------
    >>> Probe(point=("50 mm", 0, 0)).point
    (0.05, 0.0, 0.0)
    """


def _check_range(axis: str, bounds: Range | None) -> None:
    if bounds is not None and bounds[0] > bounds[1]:
        low, high = (format_quantity(bound, "length") for bound in bounds)
        raise DesignError(axis, f"starts at {low}, above its end at {high}", "swap the two")
