"""The discretization error estimate on sequences whose limit is known."""

import numpy as np
import pytest

from voxsoft.comparison.richardson import discretization_error
from voxsoft.errors import SimulationError


def sequence(limit, constant, order, sizes):
    return [limit + constant * size**order for size in sizes]


@pytest.mark.parametrize("order", [0.6, 1.0, 1.37, 2.0])
@pytest.mark.parametrize("sizes", [(4.0, 2.0, 1.0), (3.0, 2.0, 1.0), (5.0, 2.5, 1.0)])
def test_three_sizes_give_order_and_limit_exactly(order, sizes):
    found = discretization_error(sizes, sequence(7.0, -0.3, order, sizes))
    assert found.order == pytest.approx(order, rel=1e-9)
    assert found.limit == pytest.approx(7.0, rel=1e-9)
    # The safety factor, and nothing else, is between the error and its estimate.
    assert found.error == pytest.approx(2.0 * 0.3, rel=1e-8)


def test_two_sizes_hold_every_order_from_two_fifths_on():
    # 2^p - 1 >= 1/3
    for order in np.linspace(np.log2(4 / 3), 4.0, 13):
        values = sequence(1.0, 0.2, order, (2.0, 1.0))
        assert discretization_error((2.0, 1.0), values).error >= 0.2 * (1 - 1e-12)


def test_orders_are_kept_in_range():
    sizes = (4.0, 2.0, 1.0)
    assert discretization_error(sizes, sequence(1.0, 1.0, 2.15, sizes)).order == 2.0
    # Nearly no convergence: five times the last change is called possible.
    slow = discretization_error(sizes, [3.0, 2.0, 1.0])
    assert slow.order == 0.5
    assert slow.error == pytest.approx(2.0 / (np.sqrt(2) - 1))


def test_faster_than_the_elements_can_is_no_order():
    sizes = (4.0, 2.0, 1.0)
    found = discretization_error(sizes, sequence(1.0, 1.0, 4.0, sizes))
    assert (found.order, found.basis) == (1.0, "two sizes")
    assert found.error == pytest.approx(3 * 15.0)
    assert found.values == (257.0, 17.0, 2.0)


def test_oscillating_values_are_not_extrapolated():
    found = discretization_error((4.0, 2.0, 1.0), [1.0, 2.0, 1.5])
    assert found.basis == "oscillating"
    assert found.limit == 1.5
    assert found.error == pytest.approx(1.25)


def test_equal_values_have_no_error():
    assert discretization_error((2.0, 1.0), [3.0, 3.0]).error == 0.0
    assert discretization_error((4.0, 2.0, 1.0), [3.0, 3.0, 3.0]).error == 0.0


def test_the_error_of_a_coarser_size_holds_the_distance_to_the_finest():
    found = discretization_error((4.0, 2.0, 1.0), sequence(0.0, 1.0, 2.0, (4.0, 2.0, 1.0)))
    assert found.error_at(0) >= 16.0
    assert found.error_at(2) == found.error


def test_nine_of_ten_contaminated_sequences_are_held():
    """A leading term of order 1 to 2 and a second one of order 3, up to as large at the coarsest.

    The sizes are 1, 1/2 and 1/4; the estimate is for the last. Its count is deterministic.
    """
    random = np.random.default_rng(4)
    sizes = np.array([1.0, 0.5, 0.25])
    held = {2: 0, 3: 0}
    for _ in range(1000):
        order, second = random.uniform(1, 2), random.uniform(-1, 1)
        values = sizes**order + second * sizes**3
        for count in held:
            error = discretization_error(sizes[-count:], values[-count:]).error
            held[count] += error >= abs(values[-1])
    assert held[2] >= 900
    assert held[3] >= 900


@pytest.mark.parametrize("sizes", [(), (1.0,), (1.0, 2.0), (1.0, 1.0), (1.0, 0.0)])
def test_sizes_that_do_not_fall_are_refused(sizes):
    with pytest.raises(SimulationError, match="voxel_sizes"):
        discretization_error(sizes, [1.0] * len(sizes))
