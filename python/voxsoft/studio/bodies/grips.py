"""Grip on free objects, in a sentence: held or not, by which bodies, with which margin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft.design.contact import FLOOR
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.contact import ContactState, Touching
from voxsoft.studio.protocol import events
from voxsoft.units import format_quantity

Verdict = Literal["held", "slips", "touched", "lost"]

#: An object that rises less than this part of its height was not lifted: it rolls or tilts.
_LIFTED: Final = 0.1
#: The part of the pressure under which surfaces slip from which on more slips than sticks.
_MOSTLY: Final = 0.5


def grips_of(result: Result) -> list[events.Grip]:
    """Say of each free object whether it is held at the end of a run.

    Parameters
    ----------
    result
        Result of a design with or without objects.

    Returns
    -------
    list
        One entry for each free object; empty where there is none.
    """
    if not any(each.is_free for each in result.design.objects):
        return []
    touching = Setup(result.design, result.mesh).touching
    assert touching is not None  # there is an object
    free = (index for index, each in enumerate(result.design.objects) if each.is_free)
    return [_grip(result, touching, index) for index in free]


def _grip(result: Result, touching: Touching, index: int) -> events.Grip:
    name = result.design.objects[index].name
    fixed = {FLOOR, *(each.name for each in result.design.objects if each.motion == "fixed")}
    touches = [contact for contact in result.contacts if name in contact.of]
    holding = [contact for contact in touches if not fixed & set(contact.of)]
    stands = len(holding) < len(touches)
    pressed = sum(contact.pressure for contact in holding)
    bound = sum(contact.bound for contact in holding)
    friction = sum((_friction_on(name, contact) for contact in holding), np.zeros(3))
    carried = float(np.linalg.norm(friction))
    margin = bound / carried if bound > 0.0 and carried > 0.0 else None
    weight = _weight(result, touching, index)
    rise = _rise(result, name)
    verdict: Verdict
    if pressed == 0.0:
        verdict, what = "lost", "not held"
    elif stands:
        verdict, what = "touched", "gripped, and it still stands on something that is fixed"
    elif _slipping(holding) > _MOSTLY:
        verdict, what = "slips", "slips through what holds it"
    elif rise > _LIFTED * np.ptp(touching.surfaces[index].vertices[:, 2]):
        verdict, what = "held", f"held {_short(rise, 'length')} above where it began"
    else:
        verdict, what = "held", "held"
    sentences = [f"{name}: {what}."]
    if pressed > 0.0:
        heavy = "" if weight is None else f", weight {_short(weight, 'force')}"
        sentences.append(f"Gripped with {_short(pressed, 'force')}{heavy}.")
    if verdict == "held" and margin is not None:
        sentences.append(f"Friction could carry {margin:.2g} times as much.")
    return events.Grip(
        name=name,
        verdict=verdict,
        sentence=" ".join(sentences),
        rise=rise,
        pressed=pressed,
        weight=weight,
        margin=margin,
    )


def _friction_on(name: str, contact: ContactState) -> NDArray[np.float64]:
    """Friction on an object; contacts have it on their first."""
    friction = np.asarray(contact.friction)
    return friction if contact.of[0] == name else -friction


def _slipping(contacts: Sequence[ContactState]) -> float:
    pressure = sum(each.pressure for each in contacts)
    return sum(each.pressure * each.slipping for each in contacts) / pressure


def _rise(result: Result, name: str) -> float:
    """Rise of an object since the first recorded instant [m]."""
    recorded = result.recording.objects.get(name)
    if recorded is None or len(recorded[0]) == 0:
        return 0.0
    return float(result.objects[name].position[2] - recorded[0][0, 2])


def _weight(result: Result, touching: Touching, index: int) -> float | None:
    """The weight of an object at the end [N]; None without gravity."""
    pulls = [
        load.size * (1.0 if load.history is None else load.history.at(result.time))
        for load in readings(result.design)
        if load.quantity == "acceleration"
    ]
    solid = touching.solids[index]
    assert solid is not None  # it is free
    return float(solid.mass * sum(pulls)) if pulls else None


def _short(value: float, kind: str) -> str:
    """A quantity to three digits."""
    return format_quantity(float(f"{value:.3g}"), kind)
