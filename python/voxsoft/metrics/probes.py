"""Place of the probe at which a metric is measured."""

from __future__ import annotations

from voxsoft.errors import DesignError
from voxsoft.metrics.definition import Place, State, Target
from voxsoft.records import closest


def place_of_target(state: State, target: Target) -> Place:
    """Return the place of a target's probe; default: the only probe.

    Raises
    ------
    DesignError
        There is no such probe, or a choice of several.
    """
    places, name = state.places, target.probe
    if name is None and len(places) == 1:
        return next(iter(places.values()))
    if name is None:
        known = f"name one of {', '.join(places)}" if places else "add one under [probes]"
        raise DesignError("probe", f"is missing: where is {target.metric} measured?", known)
    if name not in places:
        raise DesignError("probe", f'"{name}" is not a probe', closest(name, places))
    return places[name]
