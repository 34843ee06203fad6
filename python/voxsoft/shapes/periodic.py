"""Triply periodic surfaces and strut lattices; endless, so intersect them with a body.

A wall holds every point within half its thickness of the surface, at any thickness: distances are
true (see the Rust module ``periodic``). Where :class:`Grade` makes the period a function of space,
space is stretched, and a wall is as thick as asked only where the period changes slowly.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from voxsoft import _core
from voxsoft.errors import ShapeError
from voxsoft.shapes.base import Scope, Shape
from voxsoft.units import Dimensionless, PositiveLength

__all__ = [
    "IWP",
    "Bcc",
    "Cubic",
    "Fcc",
    "Gyroid",
    "Neovius",
    "Octet",
    "SchwarzD",
    "SchwarzP",
]

Graded = float | _core.Shape


class Periodic(Shape):
    """A lattice whose period and thickness can be graded; see :class:`Grade`."""

    period: PositiveLength = Field(description="Edge of the repeated cubic cell.")

    def make_graded(self, period: Graded | None, thickness: Graded | None) -> _core.Shape:
        """Return the compiled shape with other numbers, or with numbers that vary in space."""
        raise NotImplementedError

    def make(self, scope: Scope) -> _core.Shape:
        """Return the compiled shape."""
        return self.make_graded(None, None)


class _Surface(Periodic):
    """A triply periodic surface."""

    form: Literal["sheet", "solid"] = Field(
        "sheet", description="A wall around the surface, or everything on one side of it."
    )
    thickness: PositiveLength | None = Field(
        None, description="Wall thickness of a sheet: twice the distance from its middle surface."
    )
    level: Dimensionless = Field(
        0.0, description="Value of the surface's function; it sets the solid's volume fraction."
    )

    @classmethod
    def _positional(cls) -> tuple[str, ...]:
        """Period and, for a sheet, its thickness."""
        return ("period", "thickness")

    @model_validator(mode="after")
    def _has_thickness_if_sheet(self) -> _Surface:
        if self.form == "sheet" and self.thickness is None:
            hint = 'give the wall thickness, or form = "solid"'
            raise ShapeError("thickness", "is missing; a sheet needs one", hint)
        if self.form == "solid" and self.thickness is not None:
            hint = 'leave it out and set level, or use form = "sheet"'
            raise ShapeError("thickness", "a solid has no wall", hint)
        return self

    def make_graded(self, period: Graded | None, thickness: Graded | None) -> _core.Shape:
        """Return the compiled shape with other numbers, or with numbers that vary in space."""
        period = self.period if period is None else period
        wall = self.thickness if thickness is None else thickness
        if wall is None:
            return _core.Shape.surface_solid(self.kind, period, self.level)
        if self.form == "solid":
            raise ShapeError("thickness", "a solid has no wall to grade", 'use form = "sheet"')
        return _core.Shape.surface_sheet(self.kind, period, wall, self.level)


class Gyroid(_Surface):
    """The gyroid, sin x cos y + sin y cos z + sin z cos x = level (−1.5 to 1.5).

    Examples
    --------
    >>> Gyroid(period="10 mm", thickness="1 mm").bounds()
    ((-inf, -inf, -inf), (inf, inf, inf))
    """

    kind: Literal["gyroid"] = "gyroid"


class SchwarzP(_Surface):
    """Schwarz' primitive surface, cos x + cos y + cos z = level (−3 to 3).

    Examples
    --------
    >>> SchwarzP(period=0.01, form="solid").evaluate([[0.005, 0.005, 0.005]]) < 0
    array([ True])
    """

    kind: Literal["schwarz-p"] = "schwarz-p"


class SchwarzD(_Surface):
    """Schwarz' diamond surface, cos x cos y cos z − sin x sin y sin z = level (−1 to 1).

    Examples
    --------
    >>> SchwarzD(period=0.01, thickness=0.001).form
    'sheet'
    """

    kind: Literal["schwarz-d"] = "schwarz-d"


class Neovius(_Surface):
    """Neovius' surface, 3(cos x + cos y + cos z) + 4 cos x cos y cos z = level (−13 to 13).

    Examples
    --------
    >>> Neovius(period=0.01, thickness=0.001).form
    'sheet'
    """

    kind: Literal["neovius"] = "neovius"


class IWP(_Surface):
    """Schoen's I-WP surface, 2Σ cos x cos y − Σ cos 2x = level (−5 to 3).

    Examples
    --------
    >>> IWP(period=0.01, thickness=0.001).form
    'sheet'
    """

    kind: Literal["iwp"] = "iwp"


class _Struts(Periodic):
    """Round bars between points of a cubic cell with a corner at the origin."""

    thickness: PositiveLength = Field(description="Diameter of the bars.")

    def make_graded(self, period: Graded | None, thickness: Graded | None) -> _core.Shape:
        """Return the compiled shape with other numbers, or with numbers that vary in space."""
        period = self.period if period is None else period
        bar = self.thickness if thickness is None else thickness
        return _core.Shape.struts(self.kind, period, bar)


class Cubic(_Struts):
    """Bars along the edges of the cells.

    Examples
    --------
    >>> Cubic(period=0.01, thickness=0.002).evaluate([[0.005, 0, 0]])
    array([-0.001])
    """

    kind: Literal["cubic"] = "cubic"


class Bcc(_Struts):
    """Bars from the center of each cell to its corners.

    Examples
    --------
    >>> Bcc(period=0.01, thickness=0.002).evaluate([[0.005, 0.005, 0.005]])
    array([-0.001])
    """

    kind: Literal["bcc"] = "bcc"


class Fcc(_Struts):
    """Bars from the corners of each cell to the centers of its faces.

    Examples
    --------
    >>> Fcc(period=0.01, thickness=0.002).evaluate([[0.005, 0.005, 0]])
    array([-0.001])
    """

    kind: Literal["fcc"] = "fcc"


class Octet(_Struts):
    """The octet truss: FCC bars and the octahedron between the face centers.

    Examples
    --------
    >>> Octet(period=0.01, thickness=0.002).evaluate([[0.005, 0.0025, 0.0025]]) < 0
    array([ True])
    """

    kind: Literal["octet"] = "octet"
