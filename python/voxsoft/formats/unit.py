"""Unit of a file's numbers: from the file, from the caller, or an error with sizes in each unit."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import UnitError
from voxsoft.formats.registry import counts_voxels
from voxsoft.units import format_quantity, parse

UNITS: Final = ("mm", "cm", "inch", "m")
#: Limits of the size of a soft robot [m]; beyond, the numbers are likely in another unit.
_SMALLEST, _LARGEST = 0.5e-3, 5.0
#: Lengths of most soft robots [m].
_USUAL: Final = (5e-3, 1.0)


def meter_of(
    where: str, stated: float | None, given: str | None, points: NDArray[np.float64], ask: str
) -> float:
    """Return meters in one unit of the numbers; a given unit overrides the file's own.

    Parameters
    ----------
    where
        Name of the file, for messages.
    stated
        Meters in the unit that the file gives, None if it gives none.
    given
        A unit such as ``"mm"``, a length such as ``"0.5 mm"``, or None.
    points
        Positions of the body in the file's unit, (n, 3).
    ask
        Option by which a caller gives the unit: ``--unit`` or ``unit=``.

    Raises
    ------
    UnitError
        If the unit is unknown; the message has the size of the body in each.

    Examples
    --------
    >>> meter_of("a.inp", None, "mm", np.eye(3), "unit=")
    0.001
    """
    if given is not None:
        return length_of(given)
    if stated is None:
        raise UnitError(where, *sizes(np.ptp(points, axis=0), ask, where))
    return stated


def length_of(unit: str) -> float:
    """Return meters in a unit: its name, or a length with one, such as the size of a voxel.

    Raises
    ------
    UnitError
        If it is no length, or not positive.

    Examples
    --------
    >>> length_of("mm"), length_of("0.5 mm")
    (0.001, 0.0005)
    """
    is_length = unit.lstrip()[:1] in ("+", "-", ".") or unit.lstrip()[:1].isdigit()
    found = parse(unit if is_length else f"1 {unit}", "length", where="unit")
    if not (math.isfinite(found) and found > 0.0):
        raise UnitError("unit", f'"{unit}" is no positive length', 'write "mm", or "0.5 mm"')
    return found


def name_of(meter: float) -> str:
    """Return the name of a unit from its length in meters; the length itself where none has it.

    Examples
    --------
    >>> name_of(0.001), name_of(0.0254), name_of(1e-6), name_of(0.0005)
    ('mm', 'inch', 'um', '0.0005 m')
    """
    known = {parse(f"1 {unit}", "length"): unit for unit in (*UNITS, "um", "nm", "ft")}
    size, name = min(known.items(), key=lambda each: abs(np.log(each[0] / meter)))
    return name if math.isclose(size, meter, rel_tol=1e-6) else f"{meter!r} m"


def sizes(extents: NDArray[np.float64], ask: str, name: str = "") -> tuple[str, str]:
    """Return message and hint of the error about a missing unit; `name` is that of the file.

    Examples
    --------
    >>> print(*sizes(np.array([80.0, 20, 20]), "unit="), sep="; ")
    a mesh file does not say its unit; its numbers span 80 × 20 × 20; give unit=, one of mm, cm, \
inch, m; the body would be, in mm: 80 mm long, cm: 800 mm long, inch: 2.03 m long, m: 80 m long
    """
    shown = " × ".join(f"{extent:.4g}" for extent in extents)
    if counts_voxels(name):
        what = f"the file does not say how large its voxels are; its body is {shown} voxels"
        return what, f'give {ask} the side of a voxel, such as "1 mm"'
    listed = ", ".join(
        f"{unit}: {_longest(extents, parse(f'1 {unit}', 'length'))}" for unit in UNITS
    )
    return (
        f"a mesh file does not say its unit; its numbers span {shown}",
        f"give {ask}, one of {', '.join(UNITS)}; the body would be, in {listed}",
    )


def guess(longest: float) -> str:
    """Guess the unit of numbers from the length of a body in them; most programs write mm.

    Examples
    --------
    >>> [guess(longest) for longest in (80.0, 0.08, 3.2)]
    ['mm', 'm', 'cm']
    """
    usual = ("mm", "m", "cm", "inch")
    low, high = _USUAL
    likely = (unit for unit in usual if low <= longest * parse(f"1 {unit}", "length") <= high)
    return next(likely, "mm")


def doubt(extents: NDArray[np.float64], meter: float) -> str:
    """Return a caution about a body of an unlikely size, else an empty text.

    Examples
    --------
    >>> doubt(np.array([80.0, 20, 20]), 1.0)
    'The body is 80 m long: is the unit right? In mm it would be 80 mm long'
    >>> doubt(np.array([80.0, 20, 20]), 1e-3)
    ''
    """
    longest = float(extents.max()) * meter
    if _SMALLEST <= longest <= _LARGEST:
        return ""
    other = "mm" if longest > _LARGEST else "m"
    would = _longest(extents, parse(f"1 {other}", "length"))
    found = _longest(extents, meter)
    return f"The body is {found}: is the unit right? In {other} it would be {would}"


def _longest(extents: NDArray[np.float64], meter: float) -> str:
    longest = float(f"{float(extents.max()) * meter:.3g}")
    return f"{format_quantity(longest, 'length')} long"
