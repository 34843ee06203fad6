"""Contact metrics: force, area, gap to an object, and the share that sticks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.design.contact import BODY, names_of
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.metrics.definition import (
    NOT_NEGATIVE,
    SHARE,
    Floats,
    Metric,
    SlopeState,
    State,
    Target,
    Touch,
)
from voxsoft.metrics.vectors import component
from voxsoft.records import closest


def object_problems(metric: Metric, target: Target, design: Design) -> Iterator[ErrorDetail]:
    """Find why a metric cannot be measured at the object that a target names, or does not name."""
    if "object" not in metric.needs | metric.takes:
        return
    names, name = [each.name for each in design.objects], target.object
    bodies = design.body_names
    if design.contact is None and not names and len(bodies) == 1:
        if name is not None or "object" in metric.needs:
            what = f"nothing touches in this design, and {metric.name} asks what does"
            yield ErrorDetail("object", what, "add [[objects]], or [contact] for the body alone")
        return
    if name is None and "object" in metric.needs and len(names) > 1:
        some = ", ".join([*names, *bodies])
        yield ErrorDetail("object", f"is missing: what does {metric.name} ask of?", f"name {some}")
    known = names_of(design.objects, design.floor is not None, bodies)
    if name is None and "object" in metric.needs and not names and len(bodies) > 1:
        what = f"is missing: what does {metric.name} ask of?"
        yield ErrorDetail("object", what, f"name {', '.join(bodies)}")
    if name is not None and name not in known:
        hint = closest(name, known) or f'write "{bodies[0]}" or the name of an object'
        yield ErrorDetail("object", f'there is no object "{name}"', hint)
    if _named(target, design) in bodies and len(bodies) > 1:
        if metric.name == CONTACT_GAP.name:
            what = "the gap of two bodies is not measured yet"
            yield ErrorDetail("object", what, "name an object, or ask for contact_area")
    elif _named(target, design) == BODY:
        if metric.name == CONTACT_GAP.name:
            what = "a body has no gap to itself: what is beside a place is at no distance"
            yield ErrorDetail("object", what, "name an object, or ask for contact_area")
        if metric.name == CONTACT_FORCE.name and target.axis is not None:
            what = "the forces of a body on itself cancel, and have no component"
            yield ErrorDetail("axis", what, "leave axis out")


def object_of_target(metric: Metric, target: Target, design: Design) -> str:
    """Return the name of a target's object or body; default: the only object.

    Raises
    ------
    DesignError
        There is no such object, a choice of several, or no contact in the design.
    """
    problems = list(object_problems(metric, target, design))
    if problems:
        raise DesignError.listing(problems)
    return _named(target, design)


def _named(target: Target, design: Design) -> str:
    if target.object is not None:
        return target.object
    return design.objects[0].name if design.objects else design.body_names[0]


def _contacts(metric: Metric, state: State, target: Target) -> list[Touch]:
    """Return the contacts of a target's object or body; empty while all are apart.

    Contacts of an object are those with every body; of one body of several, those with the others.
    """
    name = object_of_target(metric, target, state.design)
    bodies = state.design.body_names
    if name in bodies and len(bodies) > 1:
        return [
            each
            for each in state.contacts
            if name in each.of and each.of[0] != each.of[1] and {*each.of} <= {*bodies}
        ]
    return [each for each in state.contacts if each.of[0] in bodies and each.of[1] == name]


def _force(state: State, target: Target) -> float:
    contacts = _contacts(CONTACT_FORCE, state, target)
    if any(each.of == (BODY, BODY) for each in contacts):
        return contacts[0].pressed  # self-contact: each pair of forces cancels
    return component(force_on_bodies(CONTACT_FORCE, state, target), target) if contacts else 0.0


def force_on_bodies(metric: Metric, state: State, target: Target) -> Floats:
    """Sum the contact forces of a target on the bodies, (3,), N; on the named one of two bodies."""
    bodies, total = state.design.body_names, np.zeros(3)
    for each in _contacts(metric, state, target):
        turned = target.object in bodies and each.of[0] != target.object
        total += np.asarray(each.force) * (-1.0 if turned else 1.0)
    return total


def _slope_at_given_forces(state: SlopeState, target: Target) -> Floats:
    """Zero derivative by the positions: contact forces are unknowns of their own beside them."""
    return np.zeros_like(state.positions)


def _area(state: State, target: Target) -> float:
    return sum(each.area for each in _contacts(CONTACT_AREA, state, target))


def _gap(state: State, target: Target) -> float:
    return state.gap_to(object_of_target(CONTACT_GAP, target, state.design))


def _sticking(state: State, target: Target) -> float:
    contacts = _contacts(STICKING, state, target)
    pressed = sum(each.pressed for each in contacts)
    if pressed == 0.0:
        return 0.0
    return 1.0 - sum(each.pressed * each.slipping for each in contacts) / pressed


CONTACT_FORCE: Final = Metric(
    "contact_force",
    "force",
    _force,
    _slope_at_given_forces,
    frozenset({"object"}),
    frozenset({"axis"}),
)
CONTACT_GAP: Final = Metric(
    "contact_gap", "length", _gap, _slope_at_given_forces, frozenset({"object"})
)
# Without slopes: they jump where a point comes into contact or begins to slip.
CONTACT_AREA: Final = Metric(
    "contact_area", "area", _area, None, frozenset({"object"}), bounds=NOT_NEGATIVE
)
STICKING: Final = Metric("sticking", "number", _sticking, None, frozenset({"object"}), bounds=SHARE)
