"""What touches: the force, the area, the gap to an object, and how much of it sticks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.design.contact import BODY, names_of
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.metrics.definition import Metric, State, Target, Touch
from voxsoft.metrics.vectors import component
from voxsoft.records import closest


def object_problems(metric: Metric, target: Target, design: Design) -> Iterator[ErrorDetail]:
    """Find why a metric cannot be measured at the object that a target names, or does not name."""
    if "object" not in metric.needs | metric.takes:
        return
    names, name = [each.name for each in design.objects], target.object
    if design.contact is None and not names:
        if name is not None or "object" in metric.needs:
            what = f"nothing touches in this design, and {metric.name} asks what does"
            yield ErrorDetail("object", what, "add [[objects]], or [contact] for the body alone")
        return
    if name is None and "object" in metric.needs and len(names) > 1:
        some = ", ".join([*names, BODY])
        yield ErrorDetail("object", f"is missing: what does {metric.name} ask of?", f"name {some}")
    known = names_of(design.objects, design.floor is not None)
    if name is not None and name not in known:
        hint = closest(name, known) or f'write "{BODY}" or the name of an object'
        yield ErrorDetail("object", f'there is no object "{name}"', hint)
    if _named(target, design) == BODY:
        if metric.name == CONTACT_GAP.name:
            what = "a body has no gap to itself: what is beside a place is at no distance"
            yield ErrorDetail("object", what, "name an object, or ask for contact_area")
        if metric.name == CONTACT_FORCE.name and target.axis is not None:
            what = "the forces of a body on itself cancel, and have no component"
            yield ErrorDetail("axis", what, "leave axis out")


def object_of_target(metric: Metric, target: Target, design: Design) -> str:
    """Return what a target names: an object or the body; without a name, the only object.

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
    return design.objects[0].name if design.objects else BODY


def _contact(metric: Metric, state: State, target: Target) -> Touch | None:
    """The contact that a target asks for; None while both are apart."""
    name = object_of_target(metric, target, state.design)
    return next((each for each in state.contacts if each.of == (BODY, name)), None)


def _force(state: State, target: Target) -> float:
    contact = _contact(CONTACT_FORCE, state, target)
    if contact is None:
        return 0.0
    if contact.of == (BODY, BODY):  # what it presses itself with; each pair of forces cancels
        return contact.pressed
    return component(np.asarray(contact.force), target)


def _area(state: State, target: Target) -> float:
    contact = _contact(CONTACT_AREA, state, target)
    return 0.0 if contact is None else contact.area


def _gap(state: State, target: Target) -> float:
    return state.gap_to(object_of_target(CONTACT_GAP, target, state.design))


def _sticking(state: State, target: Target) -> float:
    contact = _contact(STICKING, state, target)
    return 0.0 if contact is None else 1.0 - contact.slipping


# Without slopes: gradients know no contact.
CONTACT_FORCE: Final = Metric(
    "contact_force", "force", _force, None, frozenset({"object"}), frozenset({"axis"})
)
CONTACT_AREA: Final = Metric("contact_area", "area", _area, None, frozenset({"object"}))
CONTACT_GAP: Final = Metric("contact_gap", "length", _gap, None, frozenset({"object"}))
STICKING: Final = Metric("sticking", "number", _sticking, None, frozenset({"object"}))
