"""Moment of the clamps about a point: of all, of one, or of those in a region."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.errors import DesignError
from voxsoft.metrics.definition import Metric, State, Target
from voxsoft.metrics.reaction import support_problems
from voxsoft.metrics.vectors import component

#: Default point.
_ORIGIN: Final = (0.0, 0.0, 0.0)


def _value(state: State, target: Target) -> float:
    problems = list(support_problems(REACTION_MOMENT, target, state.design))
    if problems:
        raise DesignError.listing(problems)
    moment = state.support_moment(target.about or _ORIGIN, clamp=target.clamp, region=target.region)
    return component(np.asarray(moment), target)


# Without a slope: arms and forces change with all that the body does.
REACTION_MOMENT: Final = Metric(
    "reaction_moment",
    "torque",
    _value,
    None,
    takes=frozenset({"axis", "clamp", "region", "about"}),
)
