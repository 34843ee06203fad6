"""Tendons on the page: a line through the body, and a slider that pulls it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voxsoft.design.tendon import Tendon
from voxsoft.errors import VoxSoftError
from voxsoft.simulation import Setup
from voxsoft.simulation.setup.tendons import ResolvedTendon
from voxsoft.studio.bodies.surface import Surface
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.message import Triple
from voxsoft.units import format_quantity, parse

#: Points of a line that are drawn at most: as a curve it needs no more.
_MOST_DRAWN: Final = 24
#: Drawn vertices that a point inside of the body goes with: so many that it lies between them.
_NEIGHBORS: Final = 8


def tendons_of(setup: Setup) -> tuple[ResolvedTendon, ...]:
    """The tendons on the mesh; none where one is a finding of the check."""
    try:
        return setup.tendons
    except VoxSoftError:
        return ()


def tendon_loads(setup: Setup) -> list[events.BodyLoad]:
    """A slider for each tendon: its tension, or by how much it is drawn in."""
    first = len(setup.design.loads)
    return [_slider(first + at, each) for at, each in enumerate(tendons_of(setup))]


def _slider(index: int, tendon: ResolvedTendon) -> events.BodyLoad:
    pulls = tendon.tendon.drive == "tension"
    kind = "force" if pulls else "length"
    value = tendon.size * tendon.final_factor
    unit = format_quantity(value, kind).partition(" ")[2] if value else ""
    unit = unit or ("N" if pulls else "mm")
    end, following = tendon.points[:2]
    return events.BodyLoad(
        index=index,
        kind="tendon",
        label=f"{'tension' if pulls else 'shortening'} of {tendon.name}",
        value=value,
        quantity=kind,
        unit=unit,
        factor=parse(f"1 {unit}", kind),
        min=min(0.0, 2.0 * value),
        max=max(0.0, 2.0 * value) or parse("1 N" if pulls else "1 mm", kind),
        at=_triple(end),
        direction=_triple((end - following) / np.linalg.norm(end - following)),
    )


def pulled(setup: Setup, factors: Sequence[float]) -> tuple[Tendon, ...]:
    """The tendons of a design, each pulled so many times as hard or drawn in by so many times."""
    pairs = zip(setup.tendons, factors, strict=True)
    return tuple(each.tendon if factor == 1.0 else each.scaled(factor) for each, factor in pairs)


def tendon_attachments(setup: Setup, surface: Surface) -> list[events.BodyAttachment]:
    """A line for each tendon, through points that follow the drawn vertices beside them."""
    found = []
    first = len(setup.design.loads)
    for number, tendon in enumerate(tendons_of(setup)):
        count = len(tendon.points)
        chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_DRAWN)).round().astype(int))
        places = [_place(setup, surface, tendon, at) for at in chosen]
        summary = tendon.tendon.summary
        line = events.BodyAttachment(
            name=tendon.name, summary=summary, places=places, load=first + number
        )
        found.append(line)
    return found


def _place(setup: Setup, surface: Surface, tendon: ResolvedTendon, at: int) -> events.BodyPlace:
    place, center = tendon.places[at], tendon.points[at]
    carried = np.array(place.get("vertices", ()), dtype=np.uint32)
    vertices = surface.index_of(carried)
    if len(carried) and not len(vertices):  # inside: it goes with the drawn vertices around it
        drawn = setup.mesh.vertices[surface.vertices]
        distance = np.linalg.norm(drawn - center, axis=1)
        vertices = np.argsort(distance)[:_NEIGHBORS].astype(np.uint32)
    return events.BodyPlace(center=_triple(center), vertices=vertices.tolist())


def _triple(point: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Triple:
    x, y, z = (float(value) for value in point)
    return (x, y, z)
