"""Planes of symmetry, each of which saves the solver one half of a body."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

from voxsoft.errors import ErrorDetail
from voxsoft.records import Record
from voxsoft.units import Length


class Symmetry(Record):
    """A plane in which body, clamps and loads are their own mirror images.

    The design describes the whole robot, and results and pictures show the whole; only the part on
    the positive side of the plane is solved. Two planes leave a quarter, three an eighth.

    Parameters
    ----------
    plane
        The axis across the plane: ``"y"`` is the plane of x and z.
    at
        Position of the plane along this axis, on faces of voxels; default: 0.

    Notes
    -----
    Of two equilibria the symmetric one is found, and whether it is stable is known for symmetric
    motions alone: a column that buckles across the plane stays straight.

    Examples
    --------
    >>> Symmetry(plane="y").at
    0.0
    >>> Symmetry(plane="w")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: plane: "w" came; expected "x", "y" or "z"
    """

    plane: Literal["x", "y", "z"]
    at: Length = 0.0

    @property
    def axis(self) -> int:
        """The axis across the plane, 0 to 2."""
        return "xyz".index(self.plane)


def symmetry_problems(planes: Iterable[Symmetry]) -> Iterator[ErrorDetail]:
    """Find two planes across one axis."""
    seen: dict[str, int] = {}
    for index, each in enumerate(planes):
        if each.plane in seen:
            what = f'is "{each.plane}" as that of symmetry[{seen[each.plane]}]'
            yield ErrorDetail(f"symmetry[{index}].plane", what, "keep one plane for each axis")
        seen.setdefault(each.plane, index)
