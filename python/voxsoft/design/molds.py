"""Options for the molds of a design: the way, the shrinkage, and the printer."""

from __future__ import annotations

from typing import Annotated, Final, Literal, get_args

from pydantic import AfterValidator

from voxsoft.design.printer import Printer
from voxsoft.errors import DesignError
from voxsoft.records import Record
from voxsoft.units import UnitOf

#: Ways to make a robot, the simplest first.
Way = Literal["cast", "core", "halves", "lost-core", "printed"]
WAYS: Final[tuple[Way, ...]] = get_args(Way)
#: Ways to ask for: one of these, or the first that the shape allows, whatever the design names.
AskedWay = Way | Literal["first"]
ASKED_WAYS: Final[tuple[AskedWay, ...]] = (*WAYS, "first")
#: Shrinkage that no casting has.
_MOST: Final = 0.1


def _of_a_casting(shrinkage: float) -> float:
    if not 0.0 <= shrinkage < _MOST:
        what = f"is {shrinkage:g}; expected 0 to {_MOST:g}"
        raise DesignError("", what, "silicones shrink by about 0.1 %: 0.001")
    return shrinkage


#: Part of its length that a casting loses as it cures.
Shrinkage = Annotated[float, UnitOf("number"), AfterValidator(_of_a_casting)]


class Molds(Record):
    """Options for the molds from which ``voxsoft make`` casts the design.

    Parameters
    ----------
    way
        ``"cast"`` in one mold, ``"core"`` drawn out through an opening, ``"halves"`` cast apart
        and bonded, ``"lost-core"`` of wax or soluble print, ``"printed"`` directly; default: the
        first of these that the shape allows.
    shrinkage
        Part of its length that a casting loses as it cures, 0 to below 0.1, for which molds are
        larger; default: the largest that the maker of each silicone states.
    printer
        Limits of the printer, and sizes of details that follow from them.

    Examples
    --------
    >>> Molds(way="halves", shrinkage="0.2 %", printer={"wall": "1.2 mm"}).printer.wall
    0.0012
    """

    way: Way | None = None
    shrinkage: Shrinkage | None = None
    printer: Printer = Printer()
