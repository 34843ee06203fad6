"""Clocks: times of columns, steps, shifts between instruments, and steady rates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voxsoft.errors import MeasurementError
from voxsoft.instruments.column import Column, Floats

#: Least ratio of a step to the scatter about its two levels: less may be noise.
_CLEAR: Final = 4.0
#: Least correlation of two recordings of one quantity.
_ALIKE: Final = 0.7
#: Largest number of rows of a correlation or of resampled data.
_MOST: Final = 20_000_000
#: Multiple of the usual step between rows from which on there is a gap between them.
_GAP: Final = 1.5


def times_of(name: str, column: Column) -> Floats:
    """Return the times of a column.

    Raises
    ------
    MeasurementError
        It has none.
    """
    if column.times is None:
        hint = "give the rate, rate=, or the column of the time, time="
        raise MeasurementError(name, f"{column.name} has no times", hint)
    return column.times


def step_of(name: str, column: Column) -> float:
    """Return the time of the step of a column in s; see :meth:`Measured.step`.

    The two levels are the medians of the rows before and after a split, that which leaves the least
    squared scatter about the means of both.
    """
    times, seen = times_of(name, column), np.isfinite(column.numbers)
    times, values = times[seen], column.numbers[seen]
    if len(values) < 4:
        raise MeasurementError(name, f"{column.name} has too few rows for a step")
    count = np.arange(1, len(values))
    centered = values - values.mean()
    below = np.cumsum(centered)[:-1]
    # Sum of squares between the two sides, for a split before each row but the first.
    between = below**2 * (1.0 / count + 1.0 / (len(values) - count))
    split = int(np.argmax(between)) + 1
    low, high = float(np.median(values[:split])), float(np.median(values[split:]))
    rest = np.concatenate([values[:split] - low, values[split:] - high])
    scatter = float(np.sqrt(rest @ rest / len(rest)))
    if abs(high - low) < _CLEAR * scatter or high == low:
        what = f"{column.name} makes no step that stands out: its levels are {low:.4g} and "
        what += f"{high:.4g} {column.unit}, with a scatter of {scatter:.2g}".rstrip()
        raise MeasurementError(name, what, "cut it to one step by .during(start, end)")
    beyond = (values - 0.5 * (low + high)) * np.sign(high - low) > 0.0
    crossings = np.flatnonzero(~beyond[:-1] & beyond[1:])
    at = int(crossings[np.argmin(np.abs(crossings + 1 - split))])
    share = (0.5 * (low + high) - values[at]) / (values[at + 1] - values[at])
    return float(times[at] + share * (times[at + 1] - times[at]))


def shift_between(name: str, first: Column, other_name: str, other: Column) -> tuple[float, float]:
    """Return the time to add to the second of two columns of one quantity, and their correlation.

    Both are read off at the finer of their rates, with gaps at their mean. The correlation is of
    the rows that overlap, of which there must be a quarter of the shorter one.
    """
    from scipy.signal import correlate

    rates = [_usual_rate(name, first), _usual_rate(other_name, other)]
    rate = max(rates)
    grids = []
    for label, column in ((name, first), (other_name, other)):
        times = times_of(label, column)
        length = int((times[-1] - times[0]) * rate) + 1
        if length > _MOST:
            raise MeasurementError(label, f"is too long to be compared at {rate:g} Hz")
        grid = times[0] + np.arange(length) / rate
        seen = np.isfinite(column.numbers)
        if not seen.any():
            raise MeasurementError(label, f"{column.name} holds no number")
        grids.append(np.interp(grid, times[seen], column.numbers[seen]))
    a, b = (each - each.mean() for each in grids)
    ones = [np.ones_like(a), np.ones_like(b)]

    def sliding(u: Floats, v: Floats) -> Floats:
        found: Floats = correlate(u, v, mode="full", method="fft")
        return found

    overlap = np.maximum(sliding(ones[0], ones[1]), 1.0)
    sum_a, sum_b = sliding(a, ones[1]), sliding(ones[0], b)
    across = sliding(a, b) - sum_a * sum_b / overlap
    spread = (sliding(a**2, ones[1]) - sum_a**2 / overlap) * (
        sliding(ones[0], b**2) - sum_b**2 / overlap
    )
    # Below: rounding of the transforms. Nothing is alike where nothing changes.
    least = 1e-9 * (a @ a) * (b @ b)
    alike = np.where(spread > least, across / np.sqrt(np.maximum(spread, least)), 0.0)
    alike[overlap < 0.25 * min(len(a), len(b))] = 0.0
    # The longer of two overlaps that are equally alike says more; then up to the nearest peak.
    best = int(np.argmax(alike * np.sqrt(overlap / overlap.max())))
    while (near := max(0, best - 1) + int(np.argmax(alike[max(0, best - 1) : best + 2]))) != best:
        best = near
    if not alike[best] >= _ALIKE:
        what = f"{first.name} and {other.name} of {other_name} are not alike at any shift"
        what += f": they correlate to {alike[best]:.2f} at best"
        raise MeasurementError(name, what, "take another column, or step=")
    fine = 0.0
    if 0 < best < len(alike) - 1:
        before, here, after = alike[best - 1 : best + 2]
        bend = before - 2.0 * here + after
        fine = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    lag = (best - (len(b) - 1) + float(np.clip(fine, -0.5, 0.5))) / rate
    return lag + times_of(name, first)[0] - times_of(other_name, other)[0], float(alike[best])


def common_times(name: str, columns: Sequence[Column], rate: float) -> Floats:
    """Return times at a steady rate where all columns have rows, (n,)."""
    spans = [times_of(name, column)[[0, -1]] for column in columns]
    start, end = max(float(s[0]) for s in spans), min(float(s[1]) for s in spans)
    count = np.floor((end - start) * rate * (1.0 + 1e-12) + 1e-9) + 1
    if not count >= 1:
        what = f"its columns share no time: one begins at {start:g} s, one ends at {end:g} s"
        raise MeasurementError(name, what, "synchronize them, or resample each alone")
    if count > _MOST:
        raise MeasurementError(name, f"would have {count:,.0f} rows", "give a lower rate")
    times: Floats = start + np.arange(int(count)) / rate
    return times


def resampled(
    name: str, column: Column, times: Floats, rate: float, *, over_gaps: bool
) -> tuple[Floats, str]:
    """Return the numbers of a column at other times, (n,), and in words how."""
    own = times_of(name, column)
    seen = np.isfinite(column.numbers)
    usual = _usual_rate(name, column)
    numbers = np.full(len(times), np.nan)
    if usual > 1.5 * rate:
        bins = np.round((own[seen] - times[0]) * rate).astype(np.int64)
        inside = (bins >= 0) & (bins < len(times))
        count = np.bincount(bins[inside], minlength=len(times))
        total = np.bincount(bins[inside], column.numbers[seen][inside], minlength=len(times))
        numbers[count > 0] = total[count > 0] / count[count > 0]
        how = f"means of about {usual / rate:.3g} rows"
    else:
        if seen.any():
            numbers = np.interp(times, own[seen], column.numbers[seen], left=np.nan, right=np.nan)
        how = "lines between rows"
    if over_gaps:
        kept = np.isfinite(numbers)
        return np.interp(times, times[kept], numbers[kept]), f"{how}, and over gaps"
    if seen.any() and usual <= 1.5 * rate:
        finite = own[seen]
        right = np.clip(np.searchsorted(finite, times), 1, max(len(finite) - 1, 1))
        if len(finite) > 1:
            wide = finite[right] - finite[right - 1] > _GAP / usual
            away = np.minimum(np.abs(times - finite[right - 1]), np.abs(finite[right] - times))
            numbers[wide & (away > 1e-9 / rate)] = np.nan
    return numbers, how


def _usual_rate(name: str, column: Column) -> float:
    times = times_of(name, column)
    if len(times) < 2:
        raise MeasurementError(name, f"{column.name} has one row", "give more of the test")
    return float(1.0 / np.median(np.diff(times)))
