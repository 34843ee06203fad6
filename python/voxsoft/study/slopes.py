"""Trials with derivatives of their objectives and constraints by the parameters."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from voxsoft.design import Constraint, Design, Objective
from voxsoft.design.variation import with_number
from voxsoft.errors import DisconnectedError, NoCavityError, StudyError, VoxSoftError
from voxsoft.search.gradient_sampler import Answer
from voxsoft.search.optuna_bridge import FrozenTrial
from voxsoft.simulation import gradient, simulate
from voxsoft.simulation.derivatives.path_gradient import LARGEST_WITH_FRICTION
from voxsoft.simulation.setup.contact import has_friction
from voxsoft.study.outcome import Outcome, outcome_of_result
from voxsoft.study.trial import OUTCOME_KEY

# Residual of each solution: slopes are as exact as the state.
_TOLERANCE: Final = 1e-8
# A descent ends on a bound from either side, by less than this part of it; aiming so far inside
# keeps its end feasible.
_MARGIN: Final = 1e-6


def slope_name(target: str, parameter: str) -> str:
    """Name of a derivative among the metrics of a trial.

    Examples
    --------
    >>> slope_name("rise", "wall")
    'd rise / d wall'
    """
    return f"d {target} / d {parameter}"


def evaluate_slopes(design: Design, parameters: Sequence[str]) -> Outcome:
    """Solve a design by statics, and differentiate its objectives and constraints.

    Parameters
    ----------
    design
        Design with the objectives and constraints of the study.
    parameters
        Names of the parameters.

    Returns
    -------
    Outcome
        Derivatives are metrics of their own, see :func:`slope_name`.
    """
    started = time.perf_counter()
    try:
        tolerance = LARGEST_WITH_FRICTION if has_friction(design) else _TOLERANCE
        result = simulate(design, method="statics", tolerance=tolerance)
        metrics = dict(result.metrics)
        if result.status == "ok":
            targets: dict[str, Objective | Constraint] = {
                **design.objectives,
                **design.constraints,
            }
            found = gradient(result, targets, parameters)
            metrics |= {
                slope_name(target, name): value
                for target, slopes in found.items()
                for name, value in slopes.items()
            }
        outcome = outcome_of_result(result, metrics)
    except NoCavityError as error:
        outcome = Outcome("no-cavity", str(error))
    except DisconnectedError as error:
        outcome = Outcome("disconnected", str(error))
    except VoxSoftError as error:
        outcome = Outcome("failed", str(error))
    return replace(outcome, seconds=time.perf_counter() - started)


def answers_of(
    objectives: Mapping[str, Objective],
    constraints: Mapping[str, Constraint],
    parameters: Sequence[str],
) -> Callable[[FrozenTrial], Answer | None]:
    """Make a function that reads the trials of a study for the sampler.

    Parameters
    ----------
    objectives
        One objective, minimized: a maximum is the minimum of its negative.
    constraints
        Each bound is scaled by its size.
    parameters
        Names in the order of the space.
    """
    ((objective, target),) = objectives.items()
    sign = 1.0 if target.direction == "minimize" else -1.0

    def answer(trial: FrozenTrial) -> Answer | None:
        record = trial.user_attrs.get(OUTCOME_KEY)
        if record is None or record["status"] != "ok":
            return None
        metrics = record["metrics"]

        def slope(name: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
            return np.array([metrics[slope_name(name, each)] for each in parameters])

        try:
            limits, slopes = [], []
            for name, constraint in constraints.items():
                for bound, way in ((constraint.min, -1.0), (constraint.max, 1.0)):
                    if bound is not None:
                        size = abs(bound) or 1.0
                        limits.append(way * (metrics[name] - bound) / size + _MARGIN)
                        slopes.append(way * slope(name) / size)
            return Answer(
                sign * metrics[objective],
                sign * slope(objective),
                np.array(limits),
                np.array(slopes).reshape(len(limits), len(parameters)),
            )
        except KeyError:  # the outcome of another sampler, which computed no slopes
            return None

    return answer


def require_slopes(family: object, parameters: Sequence[str]) -> Design:
    """Refuse a family whose shapes change in jumps, or that is a function.

    Raises
    ------
    StudyError
        Names an alternative.
    """
    if not isinstance(family, Design):
        what = '"gradient" needs a parametric design, and the family is a function'
        raise StudyError("sampler", what, 'write it as a Design with parameters, or use "tpe"')
    for name in parameters:
        value = family.parameters[name].value
        other = with_number(family, name, value * (1.0 + 1e-6) or 1e-6)
        jumps = not family.has_cut_voxels and other.shapes != family.shapes
        if jumps:
            raise StudyError(
                f"space.{name}",
                "changes the shape, and voxels are either full or empty",
                'use fill = "fraction", or another sampler',
            )
        if other.voxel_size != family.voxel_size:
            what = "changes the voxel size, and the grid with it"
            raise StudyError(f"space.{name}", what, "vary no voxel_size, or use another sampler")
    return family
