"""Metrics: numbers of a state that objectives and constraints of a design refer to.

:data:`METRICS` lists them all. :func:`metric` adds a user's own. Each of VoxSoft's is a
:class:`Metric` with its value, and its slope where it has one, in a file of its own, and its name
in ``registry.py``.
"""

from voxsoft.metrics.definition import Metric, Option, Place, SlopeState, State, Target, Touch
from voxsoft.metrics.own import metric
from voxsoft.metrics.registry import METRICS, metric_named

__all__ = [
    "METRICS",
    "Metric",
    "Option",
    "Place",
    "SlopeState",
    "State",
    "Target",
    "Touch",
    "metric",
    "metric_named",
]
