"""Metrics: the numbers that objectives and constraints of a design may ask of its state.

:data:`METRICS` lists them all. To add one, write a :class:`Metric` with its value, and its slope
where it has one, in a file of its own, and name it in ``registry.py``.
"""

from voxsoft.metrics.metric import Metric, Option, Place, SlopeState, State, Target
from voxsoft.metrics.registry import METRICS, metric_named

__all__ = [
    "METRICS",
    "Metric",
    "Option",
    "Place",
    "SlopeState",
    "State",
    "Target",
    "metric_named",
]
