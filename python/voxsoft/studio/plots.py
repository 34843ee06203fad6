"""What is plotted over time: residual, energies and how far probes moved."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.errors import VoxSoftError
from voxsoft.studio import events
from voxsoft.studio.body import StudioBody
from voxsoft.studio.mover import Mover

#: Rows that are kept for a tab that comes later; of more, every other one is.
MOST_ROWS: Final = 5_000

_NAMES: Final = ("time", "residual", "elastic energy", "kinetic energy")
_UNITS: Final = ("s", "", "J", "J")

Row = list[float | None]


@dataclass(frozen=True, eq=False)
class _Probe:
    """A place whose displacement is plotted; `by_hand` where it was set on the page."""

    name: str
    vertices: NDArray[np.uint32] = field(repr=False)
    weights: NDArray[np.float64] = field(repr=False)
    by_hand: bool = False


class Plots:
    """Rows of the plots of one body, and which of them the tabs have not got yet."""

    def __init__(self) -> None:
        self._body: StudioBody | None = None
        self._probes: list[_Probe] = []
        self._rows: list[Row] = []
        self._fresh: list[Row] = []

    def begin(self, body: StudioBody) -> None:
        """Begin anew with another body; probes that were set by hand stay where they are."""
        kept = [] if self._body is None else self._moved_to(body, self._body)
        try:
            places = body.setup.places
        except VoxSoftError:
            places = {}
        named = [_Probe(name, place.vertices, place.weights) for name, place in places.items()]
        self._probes = [*named, *kept]
        self._body = body
        self.clear()

    def clear(self) -> None:
        """Forget all rows."""
        self._rows, self._fresh = [], []

    def add_probe(self, vertex: int) -> None:
        """Plot a vertex of the surface from now on."""
        assert self._body is not None
        at = self._body.surface.vertices[vertex : vertex + 1]
        probe = _Probe(f"vertex {vertex}", at, np.ones(1), by_hand=True)
        if any(other.name == probe.name for other in self._probes):
            return
        self._probes.append(probe)
        # A curve that begins later has no values before.
        self._rows = [[*row, None] for row in self._rows]
        self._fresh = []

    def record(self, mover: Mover, positions: NDArray[np.float64]) -> None:
        """Add a row for the present."""
        assert self._body is not None
        moved = positions - self._body.mesh.vertices
        probes = [float(np.linalg.norm(p.weights @ moved[p.vertices])) for p in self._probes]
        row: Row = [mover.time, mover.residual, mover.elastic, mover.kinetic, *probes]
        self._rows.append(row)
        self._fresh.append(row)
        if len(self._rows) > MOST_ROWS:
            self._rows = self._rows[::2]

    def whole(self) -> events.Plot:
        """All rows, to replace those that a tab has."""
        return self._event(self._rows, clear=True)

    def news(self) -> events.Plot | None:
        """The rows that no tab has got yet, if there are any."""
        fresh, self._fresh = self._fresh, []
        return self._event(fresh, clear=False) if fresh else None

    def _event(self, rows: list[Row], *, clear: bool) -> events.Plot:
        return events.Plot(
            topology=0 if self._body is None else self._body.topology,
            names=[*_NAMES, *(probe.name for probe in self._probes)],
            units=[*_UNITS, *["m"] * len(self._probes)],
            rows=list(rows),
            clear=clear,
        )

    def _moved_to(self, body: StudioBody, before: StudioBody) -> list[_Probe]:
        """Probes that were set by hand, at the vertices of a body that are nearest to them now."""
        drawn = body.mesh.vertices[body.surface.vertices]
        kept = {}
        for probe in self._probes:
            if probe.by_hand:
                distances = np.linalg.norm(drawn - before.mesh.vertices[probe.vertices[0]], axis=1)
                nearest = int(distances.argmin())
                vertices = body.surface.vertices[nearest : nearest + 1]
                name = f"vertex {nearest}"
                kept[name] = replace(probe, name=name, vertices=vertices)
        return list(kept.values())
