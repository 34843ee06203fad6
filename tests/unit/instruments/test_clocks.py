"""Clocks of instruments: steps, shifts, rates, and gaps that stay gaps."""

import numpy as np
import pytest

from voxsoft.errors import MeasurementError
from voxsoft.instruments import Column, Measured


def course(times):
    """A course without a period: the sum of two waves whose ratio is no fraction, and a bump."""
    return (
        np.sin(2.1 * times)
        + 0.6 * np.sin(2.1 * np.sqrt(2) * times)
        + 3.0 * np.exp(-((times - 4.0) ** 2))
    )


def log(name, column, times, values, unit="V"):
    return Measured(name, (Column(column, unit, values, times),))


def test_a_step_is_where_the_middle_is_crossed():
    # Half of the way up at 2.3 s, between rows.
    times = np.arange(50) * 0.1
    ramp = np.clip((times - 2.2) / 0.2, 0.0, 1.0)
    assert log("a", "p", times, 5.0 + 7.0 * ramp).step("p") == pytest.approx(2.3, abs=1e-12)
    assert log("a", "p", times, 5.0 - 7.0 * ramp).step("p") == pytest.approx(2.3, abs=1e-12)


def test_a_step_stands_out_of_noise_and_gaps():
    random = np.random.default_rng(0)
    times = np.arange(400) * 0.01
    values = 10.0 * (times > 1.505) + 0.5 * random.standard_normal(400)
    values[30:60] = np.nan
    # Between two rows of 0.01 s; noise moves the crossing by less than that of a step of 10.
    assert log("a", "p", times, values).step("p") == pytest.approx(1.505, abs=0.005)


@pytest.mark.parametrize("values", [np.zeros(100), np.random.default_rng(1).standard_normal(100)])
def test_noise_has_no_step(values):
    with pytest.raises(MeasurementError, match=r"no step that stands out.*during\(start, end\)"):
        log("a", "p", np.arange(100) / 10, values).step("p")


@pytest.mark.parametrize(("late", "rate"), [(1.2345, 40.0), (-0.777, 250.0), (0.0, 100.0)])
def test_two_recordings_of_one_course_are_aligned(late, rate):
    random = np.random.default_rng(2)
    mine = np.arange(0.0, 10.0, 0.01)
    its = np.arange(0.0, 8.0, 1.0 / rate)
    first = log("a", "trigger", mine, course(mine))
    noisy = 4.0 * course(its + late) - 2.0 + 0.02 * random.standard_normal(len(its))
    second = log("b", "trigger", its, noisy)
    both = first.synchronized(second, by="trigger")
    # A parabola through three rows of the finer rate: a fifth of its step.
    assert both["b/trigger"].times[0] == pytest.approx(late, abs=0.2 * max(1.0 / rate, 0.01))
    assert both.notes[-1].startswith("b is shifted by ")


def test_courses_that_are_not_alike_are_refused():
    times = np.arange(0.0, 20.0, 0.05)
    random = np.random.default_rng(3)
    first = log("a", "p", times, course(times))
    second = log("b", "p", times, random.standard_normal(len(times)))
    with pytest.raises(MeasurementError, match="are not alike at any shift"):
        first.synchronized(second, by="p")
    with pytest.raises(MeasurementError, match="needs by=, a column of both, or step="):
        first.synchronized(second)


def test_resampling_reads_lines_between_rows_and_keeps_gaps():
    times = np.arange(11) / 10
    line = 3.0 + 2.0 * times
    seen = line.copy()
    seen[4:6] = np.nan
    slow = Column("slow", "N", line[::5], times[::5])
    both = Measured("a", (Column("p", "N", seen, times), slow)).resampled("40 Hz")
    grid = np.arange(41) / 40
    assert both["p"].times == pytest.approx(grid)
    inside = (grid > 0.3 + 1e-9) & (grid < 0.6 - 1e-9)
    assert np.isnan(both["p"].values[inside]).all()
    # A line is read off exactly, up to rounding.
    np.testing.assert_allclose(both["p"].values[~inside], 3.0 + 2.0 * grid[~inside], rtol=1e-12)
    np.testing.assert_allclose(both["slow"].values, 3.0 + 2.0 * grid, rtol=1e-12)
    assert both.notes == (
        "p: resampled to 40 Hz by lines between rows",
        "slow: resampled to 40 Hz by lines between rows",
    )
    bridged = Measured("a", (Column("p", "N", seen, times),)).resampled(40.0, over_gaps=True)
    np.testing.assert_allclose(bridged["p"].values, 3.0 + 2.0 * grid, rtol=1e-12)


def test_resampling_to_fewer_rows_takes_their_mean():
    times = np.arange(1000) / 1000
    # A hum of 50 Hz is gone in means of 100 rows, which hold five of its periods.
    values = 2.0 + np.sin(2 * np.pi * 50 * times)
    found = log("a", "p", times, values).resampled(10.0)
    assert len(found["p"].values) == 10
    # Means of 100 rows around the inner times; the first has half of them, 2.5 periods.
    np.testing.assert_allclose(found["p"].values[1:], 2.0, atol=1e-9)
    assert found.notes == ("p: resampled to 10 Hz by means of about 100 rows",)


def test_columns_that_share_no_time_cannot_be_resampled():
    early = Column("a", "N", [1, 2], [0.0, 1.0])
    late = Column("b", "N", [1, 2], [5.0, 6.0])
    with pytest.raises(MeasurementError, match="share no time"):
        Measured("t", (early, late)).resampled(10.0)


def test_rows_between_two_times_and_their_mean():
    times = np.arange(10.0)
    found = log("a", "p", times, times).during("2 s", 4.0)
    assert found["p"].values.tolist() == [2.0, 3.0, 4.0]
    assert found.mean("p") == 3.0
    with pytest.raises(MeasurementError, match=r"no row of p between 20 s and 30 s.*0 s to 9 s"):
        log("a", "p", times, times).during(20.0, 30.0)
    with pytest.raises(MeasurementError, match="all its rows are gaps"):
        log("a", "p", times, np.full(10, np.nan)).mean("p")


def test_uneven_times_have_no_rate():
    assert Column("p", "N", [1, 2, 3], [0.0, 0.1, 0.5]).rate is None
    # Loggers write milliseconds.
    assert Column("p", "N", [1, 2, 3, 4], [0.0, 0.033, 0.067, 0.1]).rate == pytest.approx(30.0)
