"""Control of a body in motion: responses, controllers, and closed loops around a simulator.

A loop takes a :class:`~voxsoft.Simulator`, one of its commands, one of its quantities and a
controller. :func:`step_response` and :func:`frequency_response` measure how the quantity follows
the command; :meth:`PIDController.tuned` and :class:`PredictiveController` are made of a step
response, and :class:`StaticInverse` gives the command at rest by the design's own gradient.

Examples
--------
>>> import voxsoft as vs
>>> from voxsoft import control
>>> from voxsoft.design import families
>>> simulator = vs.Simulator(families.cylinder(radius="20 mm", height="30 mm"))
>>> response = control.step_response(
...     simulator, "pressure", to=500.0, output="probes.top[2]", duration=0.4
... )
>>> controller = control.PIDController.tuned(response, high=5e3)
>>> tracked = control.track(
...     simulator, controller, lambda time: 20e-6, "pressure", "probes.top[2]", duration=0.6
... )
>>> bool(abs(tracked.values[-1] - 20e-6) < 1e-6)
True
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxsoft._lazy import lazy_names

if TYPE_CHECKING:
    from voxsoft.control.feedforward import StaticInverse
    from voxsoft.control.frequency import FrequencyResponse, frequency_response
    from voxsoft.control.loop import Controller, Track, track
    from voxsoft.control.pid import PIDController
    from voxsoft.control.predictive import PredictiveController
    from voxsoft.control.step import StepResponse, step_response

__all__ = [
    "Controller",
    "FrequencyResponse",
    "PIDController",
    "PredictiveController",
    "StaticInverse",
    "StepResponse",
    "Track",
    "frequency_response",
    "step_response",
    "track",
]

_HOMES = {
    "Controller": "loop",
    "FrequencyResponse": "frequency",
    "PIDController": "pid",
    "PredictiveController": "predictive",
    "StaticInverse": "feedforward",
    "StepResponse": "step",
    "Track": "loop",
    "frequency_response": "frequency",
    "step_response": "step",
    "track": "loop",
}

__getattr__, __dir__ = lazy_names(
    __name__, {name: f"{__name__}.{home}" for name, home in _HOMES.items()}
)
