"""Parts of the design model: loads, motions, histories, regions, objectives, solver choices."""

import pytest

from voxsoft.design import (
    Clamp,
    Constraint,
    Force,
    Gravity,
    History,
    Motion,
    Objective,
    Pressure,
    Region,
    Rotation,
    Solver,
    Traction,
)
from voxsoft.errors import DesignError


def test_every_load_reads_text_and_floats():
    region = Region(center=(0, 0, 0), radius="5 mm")
    assert Traction(region=region, value=["1 kPa", 0, 0]).value == (1e3, 0.0, 0.0)
    assert Traction(region=region, value=1e3).value == 1e3
    assert Force(region=region, value=["1 N", 0, "-2 mN"]).value == (1.0, 0.0, -0.002)
    assert Pressure(value="-1 kPa", cavity=0).cavity == 0
    with pytest.raises(DesignError, match="no direction"):
        Gravity(direction=(0, 0, 0))


def test_prescribed_motion():
    turn = Rotation(axis=(0, 0, 1), angle="90 deg")
    clamp = Clamp(region=Region(x=(0, 0)), motion=Motion(rotation=turn))
    assert clamp.motion.rotation.angle == pytest.approx(1.5707963267948966)
    with pytest.raises(DesignError, match="turns about z holds xy or all axes"):
        Clamp(region=Region(x=(0, 0)), axes="xz", motion=Motion(rotation=turn))


@pytest.mark.parametrize(("axis", "axes"), [((2, 0, 0), "yz"), ((0, -1, 1e-17), "xz")])
def test_a_turning_clamp_may_leave_its_axis_free(axis, axes):
    turn = Motion(rotation=Rotation(axis=axis, angle="90 deg"))
    assert Clamp(region=Region(x=(0, 0)), axes=axes, motion=turn).axes == axes
    with pytest.raises(DesignError, match="or all axes"):
        Clamp(region=Region(x=(0, 0)), axes="xy"[: len(axes) - 1], motion=turn)


def test_a_clamp_that_turns_about_a_slanted_axis_holds_all_axes():
    turn = Motion(rotation=Rotation(axis=(1, 0, 1), angle="90 deg"))
    with pytest.raises(DesignError, match="holds all axes"):
        Clamp(region=Region(x=(0, 0)), axes="xy", motion=turn)


def test_a_history_is_linear_between_and_constant_outside():
    history = History(time=("0 s", "100 ms", "0.2 s"), factor=(0, 1, 0.5))
    assert [history.at(t) for t in (-1, 0, 0.05, 0.1, 0.15, 9)] == pytest.approx(
        [0, 0, 0.5, 1, 0.75, 0.5]
    )
    with pytest.raises(DesignError, match="does not rise"):
        History(time=(0, 0), factor=(0, 1))
    with pytest.raises(DesignError, match="2 times and 1 factors"):
        History(time=(0, 1), factor=(0,))


def test_a_region_may_be_open_on_a_side():
    region = Region(x=(float("-inf"), 0), y=("1 mm", float("inf")))
    assert region.y == (0.001, float("inf"))
    with pytest.raises(DesignError, match="not a finite number"):
        Region(x=(float("nan"), 0))


def test_objectives_and_constraints():
    assert Objective(minimize="mass").direction == "minimize"
    bound = Constraint(metric="mass", min="1 g", max="30 g")
    assert (bound.min, bound.max, bound.kind) == (0.001, 0.03, "mass")
    with pytest.raises(DesignError, match="is above max"):
        Constraint(metric="mass", min="2 g", max="1 g")
    with pytest.raises(DesignError, match="expected a mass"):
        Constraint(metric="mass", min="2 g", max="1 mm")


def test_solver_choices():
    assert Solver(damping="critical").damping == "critical"
    assert Solver(damping=2.0, time_step="1 ms").time_step == 0.001
    with pytest.raises(DesignError, match="negative"):
        Solver(damping="-1 1/s")
