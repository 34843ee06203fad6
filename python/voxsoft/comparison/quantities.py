"""Numbers that a comparison puts side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.outside import OutsideAnswer
from voxsoft.design.chamber import name_of_cavity
from voxsoft.design.contact import BODY
from voxsoft.geometry import mean_displacement, mean_rotation
from voxsoft.simulation import Result, Setup
from voxsoft.units import format_quantity

Floats = NDArray[np.float64]


class Quantity(NamedTuple):
    """A number in SI units.

    Attributes
    ----------
    value
        The number.
    kind
        A key of :data:`voxsoft.units.KINDS`.
    scale
        Reference of a difference: the length of the vector that the number is a component of, or
        the size of the number.
    floor
        Size below which the number is only the rest of terms that cancel.
    """

    value: float
    kind: str
    scale: float
    floor: float = 0.0


# Least rotation in radians; and least share of the forces of a clamp, one by one.
_LEAST_TURN, _LEAST_SHARE = 1e-4, 1e-3

Quantities = Mapping[str, Quantity]


def in_words(value: float, kind: str) -> str:
    """Write an SI number with a unit that suits its size, to four digits.

    Examples
    --------
    >>> in_words(0.5, "angle"), in_words(-0.0123456, "length")
    ('28.65 deg', '-12.35 mm')
    """
    if kind == "angle":
        return f"{np.degrees(value):.4g} deg"
    return format_quantity(float(f"{value:.4g}"), kind)


def of_result(setup: Setup, result: Result) -> Quantities:
    """Collect displacements, reactions, cavity volumes and contact forces of a run of our own."""
    held = [result.reactions[vertices] for vertices in setup.clamped]
    found = {contact.of[1]: contact for contact in result.contacts}
    own = found.pop(BODY, None)
    touching = {
        name: np.array(found[name].force) if name in found else np.zeros(3)
        for name in _touching(setup)
    }
    pressed = own.pressed if own else 0.0
    return {**_quantities(setup, result.positions, held), **_contacts(touching, pressed)}


def of_answer(setup: Setup, model: BrickModel, answer: OutsideAnswer) -> Quantities:
    """Collect the quantities of :func:`of_result` from an answer of an outside code."""
    forces = np.zeros_like(model.nodes)
    forces[answer.held] = answer.reactions
    held = [forces[nodes] for nodes in model.clamp_nodes]
    found = _quantities(setup, setup.mesh.vertices + answer.displacements, held)
    return {**found, **_contacts(answer.contacts, answer.pressed or 0.0)}


def _touching(setup: Setup) -> list[str]:
    return [] if setup.touching is None else [each.name for each in setup.design.objects]


def _contacts(forces: Mapping[str, Floats], pressed: float) -> dict[str, Quantity]:
    """Collect forces of objects on the body, and of the body with itself, where there are any."""
    found: dict[str, Quantity] = {}
    for name, force in forces.items():
        found |= _components(f"contact with {name}", force, "force")
    if pressed > 0.0:
        found["contact with itself"] = Quantity(pressed, "force", pressed)
    return found


def _quantities(setup: Setup, positions: Floats, held: list[Floats]) -> Quantities:
    found: dict[str, Quantity] = {}
    rest = setup.mesh.vertices
    for name, place in setup.places.items():
        moved = mean_displacement(rest, positions, place.vertices, place.weights)
        found |= _components(name, moved, "length")
        flat = np.ptp(rest[place.vertices], axis=0)
        if np.count_nonzero(flat > 0) > 1 and setup.design.probes[name].point is None:
            turned = mean_rotation(rest, positions, place.vertices)
            found[f"{name} rotation"] = Quantity(turned, "angle", abs(turned), _LEAST_TURN)
    for index, forces in enumerate(held):
        name = "reaction" if len(held) == 1 else f"reaction of clamp {index}"
        # Supports of a closed cavity under pressure push and pull: their sum is rounding.
        floor = _LEAST_SHARE * float(np.linalg.norm(forces, axis=1).sum())
        found |= _components(name, forces.sum(axis=0), "force", floor)
    for index, cavity in enumerate(setup.mesh.cavities):
        volume = cavity.volume_at(positions)
        grown = volume - cavity.volume
        name = f"growth of {name_of_cavity(setup.mesh, index)}"
        found[name] = Quantity(grown, "volume", abs(grown))
    return found


def _components(name: str, vector: Floats, kind: str, floor: float = 0.0) -> dict[str, Quantity]:
    size = float(np.linalg.norm(vector))
    return {
        f"{name} {axis}": Quantity(float(value), kind, size, floor)
        for axis, value in zip("xyz", vector, strict=True)
    }
