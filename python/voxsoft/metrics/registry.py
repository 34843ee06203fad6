"""All metrics by name."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from voxsoft.errors import DesignError
from voxsoft.metrics.casting import MIN_WALL_THICKNESS, UNDERCUT
from voxsoft.metrics.chambers import CAVITY_VOLUME, CAVITY_VOLUME_CHANGE
from voxsoft.metrics.chord import CHORD_ANGLE, CURVATURE
from voxsoft.metrics.contact import CONTACT_AREA, CONTACT_FORCE, CONTACT_GAP, STICKING
from voxsoft.metrics.definition import Metric
from voxsoft.metrics.displacement import DISPLACEMENT, MAX_DISPLACEMENT
from voxsoft.metrics.grip import BLOCKED_FORCE, GRIP_FORCE, HOLD_MARGIN
from voxsoft.metrics.penetration import PENETRATION
from voxsoft.metrics.reaction import REACTION
from voxsoft.metrics.reaction_moment import REACTION_MOMENT
from voxsoft.metrics.rotation import ROTATION
from voxsoft.metrics.stress import MAX_STRESS
from voxsoft.metrics.stretch import MAX_STRETCH, MIN_VOLUME_RATIO, TESTED_SHARE
from voxsoft.metrics.supplies import (
    CHAMBER_PRESSURE,
    SUPPLIED_ENERGY,
    SUPPLIED_WORK,
    SUPPLY_EFFICIENCY,
)
from voxsoft.metrics.tangent import COMPLIANCE, NATURAL_FREQUENCY, STIFFNESS
from voxsoft.metrics.tendon import TENDON_LENGTH, TENDON_TENSION
from voxsoft.metrics.whole_body import ELASTIC_ENERGY, MASS, VOLUME
from voxsoft.records import closest

_ALL: Final[dict[str, Metric]] = {
    metric.name: metric
    for metric in (
        DISPLACEMENT,
        ROTATION,
        CHORD_ANGLE,
        CURVATURE,
        COMPLIANCE,
        STIFFNESS,
        NATURAL_FREQUENCY,
        MASS,
        VOLUME,
        CAVITY_VOLUME,
        CAVITY_VOLUME_CHANGE,
        ELASTIC_ENERGY,
        REACTION,
        REACTION_MOMENT,
        MAX_DISPLACEMENT,
        MAX_STRETCH,
        TESTED_SHARE,
        MAX_STRESS,
        MIN_VOLUME_RATIO,
        PENETRATION,
        CONTACT_FORCE,
        CONTACT_AREA,
        CONTACT_GAP,
        STICKING,
        GRIP_FORCE,
        HOLD_MARGIN,
        BLOCKED_FORCE,
        CHAMBER_PRESSURE,
        SUPPLIED_WORK,
        SUPPLIED_ENERGY,
        SUPPLY_EFFICIENCY,
        TENDON_TENSION,
        TENDON_LENGTH,
        UNDERCUT,
        MIN_WALL_THICKNESS,
    )
}

#: Names of VoxSoft's own metrics.
BUILT_IN: Final = frozenset(_ALL)

#: Every metric by its name in objectives and constraints; :func:`voxsoft.metric` adds to them.
METRICS: Final[Mapping[str, Metric]] = MappingProxyType(_ALL)


def register(metric: Metric) -> None:
    """Add a user's metric.

    Raises
    ------
    DesignError
        Another metric has its name.
    """
    taken = _ALL.get(metric.name)
    if taken is not None and taken.home != metric.home:
        by = f"the metric of {taken.home}" if taken.home else "a metric of VoxSoft"
        raise DesignError(f"metric {metric.name}", f"is the name of {by}", "give it another name")
    _ALL[metric.name] = metric


def metric_named(name: str) -> Metric:
    """Return a metric.

    Parameters
    ----------
    name
        A key of :data:`METRICS`.

    Raises
    ------
    DesignError
        There is none of this name.

    Examples
    --------
    >>> metric_named("max_strech")
    Traceback (most recent call last):
    ...
    voxsoft.errors.DesignError: metric: "max_strech" is not a metric. Try: did you mean \
"max_stretch"?
    """
    if name not in METRICS:
        raise DesignError("metric", f'"{name}" is not a metric', closest(name, METRICS))
    return METRICS[name]
