"""What one evaluation of a design gave."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from voxsoft.design import Design
from voxsoft.errors import DisconnectedError, NoCavityError, VoxSoftError
from voxsoft.simulation import Status, simulate


@dataclass(frozen=True)
class Outcome:
    """How an evaluation ended, and its numbers.

    Attributes
    ----------
    status
        ``ok``, or why the numbers cannot be compared.
    message
        The status in a sentence.
    metrics
        In SI units. An ``ok`` outcome holds every objective and constraint under its name.
    seconds
        Wall-clock time of the evaluation.
    """

    status: Status
    message: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    seconds: float = 0.0


#: Evaluates a design in a worker process; it is sent there by pickle.
Evaluate = Callable[[Design], Outcome]


def evaluate_design(design: Design) -> Outcome:
    """Simulate a design and give a status to whatever happens.

    Parameters
    ----------
    design
        With the objectives and constraints of the study.

    Returns
    -------
    Outcome
        An error that VoxSoft raises on purpose becomes a status; all others are raised.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> evaluate_design(families.cylinder(wall="15 mm", radius="15 mm")).status
    'no-cavity'
    """
    started = time.perf_counter()
    try:
        result = simulate(design)
        outcome = Outcome(result.status, result.message, dict(result.metrics))
    except NoCavityError as error:
        outcome = Outcome("no-cavity", str(error))
    except DisconnectedError as error:
        outcome = Outcome("disconnected", str(error))
    except VoxSoftError as error:
        outcome = Outcome("failed", str(error))
    seconds = time.perf_counter() - started
    return Outcome(outcome.status, outcome.message, outcome.metrics, seconds)
