"""Grip of an object: grip force, hold margin, and the force that blocks a motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.contact import FLOOR
from voxsoft.errors import DesignError
from voxsoft.metrics.contact import object_of_target
from voxsoft.metrics.definition import Metric, State, Target, Touch
from voxsoft.metrics.vectors import component

#: Largest hold margin: without a load it has no bound, and numbers of files are finite.
_LARGEST_MARGIN: Final = 1e9


def _contacts(metric: Metric, state: State, target: Target) -> tuple[str, Sequence[Touch]]:
    """The object that a target names, and all contacts with it but that with the floor."""
    name = object_of_target(metric, target, state.design)
    if all(each.name != name for each in state.design.objects):
        what = f'"{name}" is no object, and {metric.name} asks how something is held'
        raise DesignError("object", what, "name one of [[objects]]")
    return name, [each for each in state.contacts if name in each.of and FLOOR not in each.of]


def _stands(name: str, state: State) -> bool:
    """Return True if the floor carries a part of an object."""
    return any({name, FLOOR} == set(each.of) and each.pressure > 0.0 for each in state.contacts)


def _on(name: str, contact: Touch, force: tuple[float, float, float]) -> NDArray[np.float64]:
    """Return a contact's force on an object; contacts store the force on their first."""
    return np.asarray(force) if contact.of[0] == name else -np.asarray(force)


def _grip(state: State, target: Target) -> float:
    _, contacts = _contacts(GRIP_FORCE, state, target)
    return sum(each.pressure for each in contacts)


def _margin(state: State, target: Target) -> float:
    name, contacts = _contacts(HOLD_MARGIN, state, target)
    bound = sum(each.bound for each in contacts)
    # No margin if apart, frictionless or on the floor: else a study would drop it to hold it best.
    if bound == 0.0 or _stands(name, state):
        return 0.0
    friction = sum((_on(name, each, each.friction) for each in contacts), np.zeros(3))
    carried = float(np.linalg.norm(friction))
    return bound / max(carried, bound / _LARGEST_MARGIN)


def _blocked(state: State, target: Target) -> float:
    name, contacts = _contacts(BLOCKED_FORCE, state, target)
    (blocked,) = (each for each in state.design.objects if each.name == name)
    if blocked.is_free:
        what = f'"{name}" moves freely, and blocked_force asks what it takes to hold it'
        raise DesignError("object", what, 'fix it by motion = "fixed", or ask for grip_force')
    pushed = sum((_on(name, each, each.force) for each in contacts), np.zeros(3))
    return component(pushed, target)


# Without slopes: gradients know no contact.
GRIP_FORCE: Final = Metric("grip_force", "force", _grip, None, frozenset({"object"}))
HOLD_MARGIN: Final = Metric("hold_margin", "number", _margin, None, frozenset({"object"}))
BLOCKED_FORCE: Final = Metric(
    "blocked_force", "force", _blocked, None, frozenset({"object"}), frozenset({"axis"})
)
