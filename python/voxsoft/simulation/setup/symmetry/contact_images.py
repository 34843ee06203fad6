"""Contacts of a symmetric body: the core counts one of each image, the others are added."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from voxsoft.simulation.setup.contact import ContactState

Triple: TypeAlias = tuple[float, float, float]


def with_images(
    states: Sequence[ContactState], images: Mapping[str, str], axis: int, order: Sequence[str]
) -> tuple[ContactState, ...]:
    """Join contacts with their images in one plane.

    Parameters
    ----------
    states
        The contacts.
    images
        The name of the image of each surface in contact; others are their own.
    axis
        Axis across the plane, 0 to 2.
    order
        All names, in the order of contacts and of the two surfaces of each.
    """
    mirrored = [_image_of(state, images, axis, order) for state in states]
    found: dict[tuple[str, str], list[ContactState]] = {}
    for state in (*states, *mirrored):
        found.setdefault(state.of, []).append(state)
    ranks = {name: rank for rank, name in enumerate(order)}
    pairs = sorted(found, key=lambda of: (ranks[of[0]], ranks[of[1]]))
    return tuple(_sum(found[of]) for of in pairs)


def _image_of(
    state: ContactState, images: Mapping[str, str], axis: int, order: Sequence[str]
) -> ContactState:
    first, second = (images.get(name, name) for name in state.of)
    sign = 1.0
    if order.index(first) > order.index(second):
        first, second, sign = second, first, -1.0

    def image(force: Triple, sign: float = sign) -> Triple:
        x, y, z = (sign * (-along if at == axis else along) for at, along in enumerate(force))
        return x, y, z

    force, friction = image(state.force), image(state.friction)
    place = None if state.place is None else image(state.place, 1.0)
    return replace(state, of=(first, second), force=force, friction=friction, place=place)


def _sum(states: Sequence[ContactState]) -> ContactState:
    """Sum the parts of a contact of two surfaces."""

    def total(name: str) -> float:
        return float(sum(getattr(each, name) for each in states))

    def total_force(name: str) -> Triple:
        x, y, z = np.sum([getattr(each, name) for each in states], axis=0)
        return float(x), float(y), float(z)

    pressure = total("pressure")
    slipping = float(sum(each.slipping * each.pressure for each in states))
    return ContactState(
        of=states[0].of,
        force=total_force("force"),
        pressed=total("pressed"),
        pressure=pressure,
        friction=total_force("friction"),
        bound=total("bound"),
        area=total("area"),
        bonded=total("bonded"),
        gap=min(each.gap for each in states),
        slipping=slipping / pressure if pressure > 0.0 else states[0].slipping,
        place=_mean_place(states),
    )


def _mean_place(states: Sequence[ContactState]) -> Triple | None:
    """Mean of the places by their pressures."""
    pressed = [(each.place, each.pressure) for each in states if each.place is not None]
    if not pressed:
        return None
    places, pressures = zip(*pressed, strict=True)
    x, y, z = np.average(places, axis=0, weights=pressures).tolist()
    return x, y, z
