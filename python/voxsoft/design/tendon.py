"""Tendons: lines through a body that are pulled at one end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Final, Literal, Self

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from voxsoft.design.history import History
from voxsoft.design.operands import Name
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import Length, Point, PositiveLength, UnitOf, format_quantity


class Guide(Record):
    """A point on the way of a tendon that needs more than its place in the body.

    Parameters
    ----------
    point
        Point of the line in a body or an object, in the undeformed design.
    body
        The body that carries the point, in whose own frame it is then; default: whichever it is in.
    object
        The rigid object that carries the point.
    fixed
        A point in space that does not move: a pulley, an eyelet of the frame, the motor.
    radius
        Radius of a ball around a point of a body over which the pull is spread, as by a disc or a
        knot in the rubber; default: none, as by a channel. An anchor that pulls hard needs one.

    Examples
    --------
    >>> Guide(fixed=("-20 mm", 0, 0)).fixed
    (-0.02, 0.0, 0.0)
    >>> Guide(object="post")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: says nowhere. Try: give "point", or "fixed" for a point in space
    """

    point: Point | None = None
    body: Name | None = None
    object: Name | None = None
    fixed: Point | None = None
    radius: PositiveLength | None = None

    @model_validator(mode="after")
    def _is_one_place(self) -> Self:
        if self.point is None and self.fixed is None:
            hint = 'give "point", or "fixed" for a point in space'
            raise DesignError("", "says nowhere", hint)
        if self.point is not None and self.fixed is not None:
            raise DesignError("", 'has both "point" and "fixed"', "keep one of them")
        if self.body is not None and self.object is not None:
            raise DesignError("", "is of a body and of an object", "keep one of them")
        if self.fixed is not None and (self.body or self.object):
            what = 'is "fixed", and what moves carries it'
            raise DesignError("", what, 'write "point", or leave the body or object out')
        if self.radius is not None and (self.fixed is not None or self.object is not None):
            what = "is that of a place in a body, and this is rigid"
            raise DesignError("radius", what, "leave it out")
        return self


def _point_or_table(value: object) -> str:
    return "point" if isinstance(value, (list, tuple)) else "table"


#: A point of the body, or a table that says which body carries it.
Waypoint = Annotated[
    Annotated[Point, Tag("point")] | Annotated[Guide, Tag("table")],
    Discriminator(_point_or_table),
]

Drive = Literal["tension", "length", "shortening"]
_DRIVES: Final[tuple[Drive, ...]] = ("tension", "length", "shortening")
#: Entries that give its pull.
PULLS: Final = (*_DRIVES, "history")


class Tendon(Record):
    """A line through points of the body, pulled at the first one and anchored at the last one.

    Parameters
    ----------
    through
        Two or more points in the undeformed body, in turn; or tables that say more, see
        :class:`Guide`. Between points of one body the line runs in a channel and bends with the
        material; elsewhere it is straight.
    tension
        The force at the first point, zero or more.
    length
        The length without tension between the first point and the last.
    shortening
        Length drawn in from the length that it has in the undeformed design; negative
        pays it out. Give one of `tension`, `length` and `shortening`.
    history
        The factor on that over time; default: constant.
    stiffness
        Force per strain, ``EA``, where `length` or `shortening` is given. Default: 100 kN, a steel
        rope of a millimeter, which 10 N make longer by a ten-thousandth.
    friction
        The coefficient ``μ`` of friction of the line where it bends; default: 0. The tensions on
        both sides of a bend of angle ``θ`` have a ratio of at most ``exp(μ θ)``.
    guide
        ``"channel"`` (default): between points of one body the line runs inside of it, as in a
        tube that is molded in. ``"eyelets"``: it is guided at the points alone, and straight
        between them.
    name
        Name in results.

    Notes
    -----
    It pulls and never pushes: a line that is longer than its way is slack. It has no mass, and
    has no contact with things beside its way.

    Examples
    --------
    >>> flexor = Tendon(through=[(0, 0, "5 mm"), ("60 mm", 0, "5 mm")], tension="6 N")
    >>> flexor.summary
    'tendon, 6 N'
    >>> Tendon(through=[(0, 0, 0), (1, 0, 0)], tension=-1)
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: tension: -1 N is negative. Try: give a force of zero or more
    """

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"through": [[0, 0, "5 mm"], [0, 0, "60 mm"]], "tension": "6 N"}]
        }
    )

    through: tuple[Waypoint, ...] = Field(min_length=2, max_length=1000)
    tension: Annotated[float, UnitOf("force", non_negative=True)] | None = None
    length: PositiveLength | None = None
    shortening: Length | None = None
    history: History | None = None
    stiffness: Annotated[float, UnitOf("force", positive=True)] | None = None
    friction: Annotated[float, UnitOf("number", non_negative=True)] = 0.0
    guide: Literal["channel", "eyelets"] = "channel"
    name: Name | None = None

    @model_validator(mode="after")
    def _is_driven_once(self) -> Self:
        given = [name for name in _DRIVES if getattr(self, name) is not None]
        if not given:
            hint = 'give "tension", or "length" or "shortening" for a line that is drawn in'
            raise DesignError("", "is not pulled", hint)
        if len(given) > 1:
            what = f'has both "{given[0]}" and "{given[1]}"'
            raise DesignError("", what, "keep one of them")
        if self.stiffness is not None and self.tension is not None:
            what = "changes nothing where the tension is given"
            raise DesignError("stiffness", what, "leave it out, or give a length or shortening")
        lowest = 0.0 if self.history is None else min(self.history.factors)
        if lowest < 0.0 and self.shortening is None:
            what = f"has a factor of {lowest:g}, and a line cannot be pushed"
            raise DesignError("history", what, "give factors of zero or more")
        return self

    @property
    def drive(self) -> Drive:
        """Which of the three is given."""
        return next(name for name in _DRIVES if getattr(self, name) is not None)

    @property
    def value(self) -> float:
        """The given one of `tension`, `length` and `shortening`."""
        return float(getattr(self, self.drive))

    @property
    def summary(self) -> str:
        """Short description with its size, for pictures and lists."""
        kind = "force" if self.drive == "tension" else "length"
        words = {"tension": "tendon, ", "length": "tendon of ", "shortening": "tendon drawn in by "}
        return words[self.drive] + format_quantity(self.value, kind)

    def with_value(self, value: float) -> Self:
        """Return the same with another tension, length or shortening."""
        return self.replace(**{self.drive: value})

    def placed(self, guide: Callable[[Guide], Guide]) -> Self:
        """Return the same for a body in another frame.

        Parameters
        ----------
        guide
            Function that maps a point on its way.
        """
        return self.replace(through=[guide(guide_of(each)) for each in self.through])


def guide_of(waypoint: Guide | Point) -> Guide:
    """Return a point on the way as a table.

    Examples
    --------
    >>> guide_of((0.0, 0.0, 0.01)).point
    (0.0, 0.0, 0.01)
    """
    return waypoint if isinstance(waypoint, Guide) else Guide(point=waypoint)
