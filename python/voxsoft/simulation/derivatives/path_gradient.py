"""Derivatives of metrics with contact, along the load path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design.contact import BODY
from voxsoft.errors import DesignError, SimulationError
from voxsoft.metrics import Target, metric_named
from voxsoft.simulation.derivatives.loaded_state import LoadedState
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.setup.contact import has_friction
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.equilibrium import LoadControl, find_equilibrium, path_of
from voxsoft.units import format_percent

Floats = NDArray[np.float64]

#: Largest relative residual of a state that counts as an equilibrium. The residual forces enter a
#: derivative with that part of its size, times the condition of the body.
LARGEST_RESIDUAL: Final = 1e-5

#: Largest distance of the result from the end of the path that is followed again, in voxels: it
#: takes the same steps, and rounds as the same build does.
_SAME: Final = 1e-9


#: Largest part of the pressure under which surfaces may slip in a step. Points begin and end to
#: slip at values close by, and derivatives across that are not checked.
_MOST_SLIP: Final = 0.01
#: Largest part of the pressure, with friction, on surfaces that came into contact along the path.
#: The anchor of a surface that was just apart changes steeply with the motion that closes the gap.
_MOST_LATER: Final = 0.01
#: Largest tolerance of a state that is differentiated with friction. From 1e-8 on contact is first
#: corrected by loose equilibria, where its anchors depend on the residual of an iteration.
LARGEST_WITH_FRICTION: Final = 1e-9


class Variation(Protocol):
    """Variants of a design with a number a little off."""

    @property
    def states(self) -> Sequence[LoadedState]:
        """State for each value."""

    @property
    def weights(self) -> Sequence[float]:
        """Weight of each value in the derivative."""

    @property
    def offsets(self) -> Sequence[float]:
        """Difference of each value from the number."""


def path_gradient(
    setup: Setup,
    result: Result,
    targets: Mapping[str, Target],
    variations: Mapping[str, Variation],
) -> dict[str, dict[str, float]]:
    """Follow the load path of a result again, and differentiate it.

    Parameters
    ----------
    setup
        The prepared design of the result.
    result
        A result of statics with load control.
    targets
        Targets by name.
    variations
        The design with each number a little off.

    Raises
    ------
    SimulationError
        The path ends elsewhere now, something slips, moves freely or is bonded, the
        body presses itself, contact has not settled as precisely as was asked for, a tangent is
        singular, or there is too little memory.
    DesignError
        A number that changes which triangles a surface has.
    """
    if setup.loose_piece is not None:
        what = "something moves freely, and derivatives of where it ends are not known yet"
        raise SimulationError("gradient", what, "hold it, or give it a motion")
    if any(each.of == (BODY, BODY) and each.pressed > 0.0 for each in result.contacts):
        what = "the body presses itself, and multipliers of its surfaces do not settle well enough"
        hint = "keep it apart from itself, or use a sampler without gradients"
        raise SimulationError("gradient", what, hint)
    for name, variation in variations.items():
        _check_surfaces(setup, variation, name)
    problem, factors = _recorded_path(setup, result)
    ends = _ends(problem, factors, list(variations.values()))
    return {
        target_name: {
            name: _derivative(target, variation, places)
            for (name, variation), places in zip(variations.items(), ends, strict=True)
        }
        for target_name, target in targets.items()
    }


def _check_surfaces(setup: Setup, variation: Variation, name: str) -> None:
    for state in variation.states:
        if not _core.same_surfaces(setup.problem, state.setup.problem):
            raise DesignError(
                name,
                "cannot be varied: the surface of what touches then has other triangles",
                "move the object by its motion, or away from where its surface is on its grid",
            )


def _recorded_path(setup: Setup, result: Result) -> tuple[_core.Problem, list[float]]:
    """Return the problem at the end of a path recorded by its contact, and the load factors."""
    used = result.solver
    settings = LoadControl(tolerance=used["tolerance"], first_step=used["first_step"])
    _, report = find_equilibrium(setup, settings, None, _core.recording(setup.problem))
    points = path_of(report.answer).points
    # The residual of this path, not of the result: friction anchors have moved along since.
    check_residual(float(points[-1, 2]))
    precise, slip, later = _core.recorded_contact(report.answer.problem)
    if not precise:
        raise SimulationError(
            "gradient",
            f"contact does not settle as precisely as a tolerance of {used['tolerance']:g} asks",
            "solve with a looser tolerance, 1e-8 or less, or use a sampler without gradients",
        )
    if slip > _MOST_SLIP:
        raise SimulationError(
            "gradient",
            f"surfaces slip on the way under {format_percent(slip)} of their pressure, and "
            "derivatives are known only where they stick or have no friction",
            "raise the friction until they stick, set it to 0, or use a sampler without gradients",
        )
    if later > _MOST_LATER:
        raise SimulationError(
            "gradient",
            f"{format_percent(later)} of the pressure is on what came into contact under way, and "
            "with friction derivatives are known only for what touches from the first step on",
            "let it touch in the unloaded body, set the friction to 0, or use a sampler without "
            "gradients",
        )
    if has_friction(setup.design) and settings.tolerance > LARGEST_WITH_FRICTION:
        raise SimulationError(
            "gradient",
            f"a tolerance of {settings.tolerance:g} is too much for a derivative with friction",
            f"solve with a tolerance of {LARGEST_WITH_FRICTION:g} or less",
        )
    off = float(np.abs(report.answer.positions - result.positions).max())
    if not off <= _SAME * setup.design.voxel_size:
        raise SimulationError(
            "gradient",
            "the load path of this result ends elsewhere when it is followed again",
            "solve it again, and differentiate that result",
        )
    factors: list[float] = points[:, 0].tolist()
    return report.answer.problem, factors


def check_residual(residual: float) -> None:
    """Raise an error where forces are too far from balance for a derivative.

    Raises
    ------
    SimulationError
        The residual is too large.
    """
    if not residual <= LARGEST_RESIDUAL:
        left = f"{format_percent(residual)} of the load"
        raise SimulationError(
            "gradient",
            f"the residual is {left}, too much for a derivative",
            f"solve with a tolerance of {LARGEST_RESIDUAL:g} or less; 1e-10 costs one step more",
        )


def _ends(
    problem: _core.Problem, factors: list[float], variations: Sequence[Variation]
) -> list[list[tuple[Floats, _core.Problem]]]:
    varied = [
        [
            (state.setup.problem, offset, weight)
            for state, offset, weight in zip(each.states, each.offsets, each.weights, strict=True)
        ]
        for each in variations
    ]
    return _core.sensitivities(problem, factors, varied, memory=memory_limit())


def _derivative(
    target: Target, variation: Variation, ends: Sequence[tuple[Floats, _core.Problem]]
) -> float:
    value = metric_named(target.metric).value
    return sum(
        weight * value(LoadedState(state.setup, positions, problem), target)
        for state, weight, (positions, problem) in zip(
            variation.states, variation.weights, ends, strict=True
        )
    )
