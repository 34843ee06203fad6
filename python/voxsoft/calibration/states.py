"""Measurements from data over time: displacements of points while a load is held."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from voxsoft.calibration.line import LineName
from voxsoft.calibration.measurement import Measurement
from voxsoft.errors import MeasurementError, UnitError
from voxsoft.instruments import Measured
from voxsoft.instruments.column import Floats
from voxsoft.units import KINDS, format_quantity, parse, si_value, write_exactly

#: Two times in s, or with a unit.
Interval = Sequence[float | str]


def measurements_at(
    data: Measured,
    *,
    rest: Interval,
    loaded: Iterable[Interval],
    stations: Mapping[str, str] | None = None,
    axes: Sequence[str] | str = "",
    changes: Mapping[str, str] | None = None,
    line: LineName | None = None,
    source: str = "",
) -> list[Measurement]:
    """Return a measurement for each interval in which a body was held at rest under a load.

    Displacements are differences of the mean places of points in two intervals; frames in which a
    point was hidden do not count.

    Parameters
    ----------
    data
        Points over time, with columns of the loads over the same clock, if any; axes
        are those of the design.
    rest
        Interval without the load.
    loaded
        Intervals with it, at least one.
    stations
        Probes of the design by the names of points, or distances from the clamp face along the
        undeformed body, with a unit. Default: each point is at the probe of its name.
    axes
        Axes that count, such as ``"xz"``; default: all that were seen.
    changes
        Columns by keys of the design, ``{"loads[0].value": "pressure"}``: their means in each
        interval are the values of the design there.
    line
        Line of the body that distances are along.
    source
        Source of the data and its license.

    Raises
    ------
    MeasurementError
        No such point or column, one that was hidden all the time, or numbers without a unit.
    UnitError
        An interval without a unit of time.

    Examples
    --------
    >>> from voxsoft.instruments import Column
    >>> times = np.arange(6.0)
    >>> tip = Column("tip z", "mm", [1, 1, 1, -4, -4, -4], times)
    >>> press = Column("p", "kPa", [0, 0, 0, 12, 12, 12], times)
    >>> (seen,) = measurements_at(
    ...     Measured("t", (tip, press)), rest=(0, 2), loaded=[(3, 5)], changes={"pressure": "p"}
    ... )
    >>> seen.values.tolist(), seen.changes
    ([[-0.005]], ('pressure=12 kPa',))
    """
    chosen = dict(stations) if stations is not None else {name: name for name in data.tracks}
    if not chosen:
        raise MeasurementError(data.name, "holds no points", "columns of them end in x, y or z")
    intervals = [_ends(each, data.name) for each in loaded]
    if not intervals:
        raise MeasurementError(data.name, "loaded: names no interval", 'write [["1 s", "2 s"]]')
    still = _ends(rest, data.name)
    before = _places(data, chosen, still)
    counted = _axes(data.name, axes, [place for place, _ in before])
    arcs = _arcs(data.name, chosen)
    found = []
    for ends in intervals:
        after = _places(data, chosen, ends)
        moved = np.array([b - a for (a, _), (b, _) in zip(before, after, strict=True)])
        spread = max(float(np.nanmax(s[counted])) for _, s in (*before, *after))
        shown = format_quantity(float(f"{spread:.2g}"), "length")
        note = f"{data.name}: {_shown(ends)} less {_shown(still)}; frames scatter by up to {shown}"
        found.append(
            Measurement(
                quantities=[f"d{'xyz'[axis]}" for axis in counted],
                values=moved[:, counted],
                arcs=arcs,
                probes=None if arcs else list(chosen.values()),
                name=f"{data.name}, {_shown(ends)}",
                source=" ".join(filter(None, (source, note))),
                line=line,
                changes=tuple(
                    f"{key}={_held(data, column, ends)}" for key, column in (changes or {}).items()
                ),
            )
        )
    return found


def _ends(interval: Interval, name: str) -> tuple[float, float]:
    if len(interval) != 2:
        raise MeasurementError(name, f"{list(interval)} is no interval", 'write ["1 s", "2 s"]')
    low, high = (si_value(each, "time", "interval") for each in interval)
    if low > high:
        raise MeasurementError(name, f"{_shown((low, high))} ends before it begins")
    return low, high


def _shown(ends: tuple[float, float]) -> str:
    return f"{ends[0]:g} s to {ends[1]:g} s"


def _places(
    data: Measured, points: Mapping[str, str], ends: tuple[float, float]
) -> list[tuple[Floats, Floats]]:
    """Return the mean place of each point in an interval and its scatter, (3,) each, m."""
    found = []
    for point in points:
        times, positions = data.track(point)
        inside = positions[(times >= ends[0]) & (times <= ends[1])]
        known = np.isfinite(positions).any(axis=0)
        seen = inside[np.isfinite(inside[:, known]).all(axis=1)]
        if not len(seen):
            what = f"{point} was not seen in any of {len(inside):,} frames from {_shown(ends)}"
            raise MeasurementError(data.name, what, "leave it out, or name another interval")
        found.append((seen.mean(axis=0), seen.std(axis=0)))
    return found


def _axes(name: str, asked: Sequence[str] | str, places: Sequence[Floats]) -> list[int]:
    """Return the axes that count, 0 to 2: those that were asked for, or all that were seen."""
    seen = [axis for axis in range(3) if all(np.isfinite(place[axis]) for place in places)]
    chosen = ["xyz".index(each) for each in asked if each in ("x", "y", "z")]
    if len(chosen) != len(asked) or not {*chosen} <= {*seen}:
        what = f"axes {', '.join(asked)} are not those that all points have"
        raise MeasurementError(name, what, f"they have {', '.join('xyz'[a] for a in seen)}")
    return chosen or seen


def _arcs(name: str, chosen: Mapping[str, str]) -> list[float] | None:
    """Return distances along the body in m; None if the stations are probes."""
    arcs = []
    for station in chosen.values():
        try:
            arcs.append(parse(station, "length"))
        except UnitError:
            continue
    if arcs and len(arcs) < len(chosen):
        what = "has points at probes and points at distances"
        raise MeasurementError(name, what, "give all of them alike, or make two tests")
    return arcs or None


def _held(data: Measured, column: str, ends: tuple[float, float]) -> str:
    """Return the mean of a column in an interval, with its unit."""
    only = data.selected(column).during(*ends)
    kind = only.columns[0].kind
    if kind not in KINDS or (kind == "number" and only.columns[0].unit == ""):
        what = f"{column} has no unit" if kind == "number" else f"{column} is no load: {kind}"
        raise MeasurementError(data.name, what, f'give units={{"{column}": "kPa"}}, say')
    return write_exactly(float(f"{only.mean(only.names[0]):.9g}"), kind)
