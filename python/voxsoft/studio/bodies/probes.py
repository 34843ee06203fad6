"""Places of a body whose displacement is plotted."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import VoxSoftError
from voxsoft.studio.bodies.body import StudioBody


@dataclass(frozen=True, eq=False)
class Probe:
    """The weighted mean of some vertices; `by_hand` where it was set on the page."""

    name: str
    vertices: NDArray[np.uint32] = field(repr=False)
    weights: NDArray[np.float64] = field(repr=False)
    by_hand: bool = False

    @classmethod
    def at(cls, body: StudioBody, shown: int) -> Probe:
        """One vertex of the surface, set by hand."""
        vertices = body.surface.vertices[shown : shown + 1]
        return cls(f"vertex {shown}", vertices, np.ones(1), by_hand=True)


def placed_probes(body: StudioBody) -> list[Probe]:
    """The probes that the design of a body names."""
    try:
        places = body.setup.places
    except VoxSoftError:
        return []
    return [Probe(name, place.vertices, place.weights) for name, place in places.items()]


def moved_probes(probes: list[Probe], before: StudioBody, body: StudioBody) -> list[Probe]:
    """Those that were set by hand, at the vertices of another body that are nearest to them."""
    drawn = body.mesh.vertices[body.surface.vertices]
    moved = {}
    for probe in probes:
        if probe.by_hand:
            distances = np.linalg.norm(drawn - before.mesh.vertices[probe.vertices[0]], axis=1)
            found = Probe.at(body, int(distances.argmin()))
            moved[found.name] = found
    return list(moved.values())
