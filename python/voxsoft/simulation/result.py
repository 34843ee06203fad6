"""The answer of a simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft import metrics
from voxsoft.design import Constraint, Design, Objective
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.records import closest
from voxsoft.simulation.places import Place

if TYPE_CHECKING:
    from voxsoft.studio.html import LivePage

#: How a trial can end; ``ok`` is the only one whose numbers may be compared.
Status = Literal["ok", "no-cavity", "disconnected", "diverged", "not-at-rest", "failed"]


@dataclass(frozen=True)
class History:
    """What was recorded over time.

    Attributes
    ----------
    times
        Instants in s, (f,).
    probes
        Displacement of each probe in m, (f, 3) by name.
    frames
        Positions of all vertices in m, (f, n, 3); f is 0 unless frames were asked for.
    """

    times: NDArray[np.float64]
    probes: Mapping[str, NDArray[np.float64]]
    frames: NDArray[np.float64]


@dataclass(frozen=True)
class Result:
    """Where a design ended up, and how sure that is.

    Attributes
    ----------
    design, mesh
        What was simulated.
    status
        ``ok``: at rest (or at the end time, where one was set). ``not-at-rest`` and
        ``diverged`` keep the last good positions.
    message
        The status in a sentence.
    positions, velocities
        Vertices in m and m/s, (n, 3).
    residual
        Norm of the forces left over on free vertices over that of the loads or reactions.
    reactions
        Support forces in N, (n, 3), zero on free vertices.
    reaction, reaction_moment, load, load_moment
        Totals in N and N m (about the origin), (3,).
    elastic_energy
        In J.
    solver
        Which solver answered, and its settings.
    steps, back_offs
        Substeps taken, and how often the step was halved.
    time
        Simulated time in s; 0 for relaxation, which has none.
    seconds
        Wall-clock time of the solution.
    history
        What was recorded, for runs over time; for statics one entry for each point of the load
        path, with the load factor as time.
    load_factor
        The part of the loads that ``positions`` carry; 1 unless statics met a limit (or, in
        volume control, what the pressure came to).
    limit_factor
        The largest load factor of a path that turned back, if it did: 0.8 means that a
        pressure of 5 kPa has its limit at 4 kPa.
    stable
        Whether the equilibrium is stable; None where the solver does not tell.
    """

    design: Design
    mesh: Mesh
    places: Mapping[str, Place] = field(repr=False)
    status: Status
    message: str
    positions: NDArray[np.float64] = field(repr=False)
    velocities: NDArray[np.float64] = field(repr=False)
    residual: float
    reactions: NDArray[np.float64] = field(repr=False)
    reaction: tuple[float, float, float]
    reaction_moment: tuple[float, float, float]
    load: tuple[float, float, float]
    load_moment: tuple[float, float, float]
    elastic_energy: float
    mass: float
    solver: Mapping[str, Any]
    steps: int
    back_offs: int
    time: float
    seconds: float
    history: History = field(repr=False)
    load_factor: float = 1.0
    limit_factor: float | None = None
    stable: bool | None = None

    @property
    def displacements(self) -> NDArray[np.float64]:
        """Displacement of every vertex in m, (n, 3)."""
        moved: NDArray[np.float64] = self.positions - self.mesh.vertices
        return moved

    @cached_property
    def probes(self) -> Mapping[str, NDArray[np.float64]]:
        """Displacement of each probe in m, (3,) by name."""
        return {
            name: metrics.mean_displacement(
                self.mesh.vertices, self.positions, place.vertices, place.weights
            )
            for name, place in self.places.items()
        }

    @cached_property
    def cavity_volumes(self) -> tuple[float, ...]:
        """Volume of each cavity now, in m³, in the order of the mesh's cavities."""
        return tuple(cavity.volume_at(self.positions) for cavity in self.mesh.cavities)

    def metric(
        self,
        name: str,
        *,
        probe: str | None = None,
        axis: Literal["x", "y", "z"] | None = None,
        cavity: int | None = None,
    ) -> float:
        """Return one metric in SI units.

        Parameters
        ----------
        name
            A key of :data:`voxsoft.metrics.METRICS`.
        probe
            Where, for ``displacement`` and ``rotation``; may be left out if there is one probe.
        axis
            The component of a vector; default: its magnitude.
        cavity
            The cavity for ``cavity_volume`` and ``cavity_volume_change``; default: all of them.

        Raises
        ------
        DesignError
            An unknown metric, probe or cavity, or a probe that is missing.
        """
        if name not in metrics.METRICS:
            raise DesignError("metric", f'"{name}" is not a metric', closest(name, metrics.METRICS))
        if name == "displacement":
            return _component(self.probes[self._probe(probe)], axis)
        if name == "rotation":
            place = self.places[self._probe(probe)]
            return metrics.mean_rotation(self.mesh.vertices, self.positions, place.vertices)
        if name == "reaction":
            return _component(np.asarray(self.reaction), axis)
        if name in ("cavity_volume", "cavity_volume_change"):
            return self._cavity(cavity, change=name == "cavity_volume_change")
        return self._plain_metric(name)

    def _plain_metric(self, name: str) -> float:
        match name:
            case "mass":
                return self.mass
            case "volume":
                return self.mesh.volume
            case "elastic_energy":
                return self.elastic_energy
            case "max_displacement":
                return float(np.linalg.norm(self.displacements, axis=1).max())
            case _:
                edges, rest = self.mesh.edges, self.mesh.vertices
                return metrics.max_stretch(edges, rest, self.positions)

    def _probe(self, name: str | None) -> str:
        if name is None and len(self.places) == 1:
            return next(iter(self.places))
        if name is None:
            raise DesignError("probe", "is missing", f"name one of {', '.join(self.places)}")
        if name not in self.places:
            raise DesignError("probe", f'"{name}" is not a probe', closest(name, self.places))
        return name

    def _cavity(self, index: int | None, *, change: bool) -> float:
        count = len(self.mesh.cavities)
        if index is not None and index >= count:
            raise DesignError("cavity", f"there are {count} cavities, {index} is past the last")
        chosen = range(count) if index is None else [index]
        now = sum(self.cavity_volumes[i] for i in chosen)
        before = sum(float(self.mesh.cavities[i].volume) for i in chosen)
        return now - before if change else now

    @cached_property
    def metrics(self) -> Mapping[str, float]:
        """The design's objectives and constraints by name, or everything that needs no choice."""
        asked: dict[str, Objective | Constraint] = {
            **self.design.objectives,
            **self.design.constraints,
        }
        values = {
            name: self.metric(
                target.metric, probe=target.probe, axis=target.axis, cavity=target.cavity
            )
            for name, target in asked.items()
        }
        free = set(metrics.METRICS) - metrics.PROBE_METRICS
        return values | {name: self.metric(name) for name in sorted(free - values.keys())}

    def show(self) -> LivePage:
        """Show the design as a page that is alive: in a notebook, or as a file with ``save``.

        The page begins at the unloaded shape and comes to this result when time runs.
        """
        # `studio` lies above `simulation` in the layers; this convenience reaches up when called.
        from voxsoft.studio.html import page_of

        return page_of(self)

    def summary(self) -> dict[str, Any]:
        """Everything a record needs, as plain data in SI units (the ``--json`` of ``run``)."""
        pressures = [
            self.load_factor * value for value in _pressures(self.design, len(self.mesh.cavities))
        ]
        return {
            "status": self.status,
            "message": self.message,
            "solver": self.solver["method"],
            "settings": dict(self.solver),
            "residual": self.residual,
            "probes": {
                name: {"displacement": moved.tolist()} for name, moved in self.probes.items()
            },
            "metrics": dict(self.metrics),
            "cavities": [
                {"volume": volume, "rest_volume": float(cavity.volume), "pressure": pressure}
                for volume, cavity, pressure in zip(
                    self.cavity_volumes, self.mesh.cavities, pressures, strict=True
                )
            ],
            "reaction": list(self.reaction),
            "load": list(self.load),
            "voxels": len(self.mesh.tets) // 5 if self.mesh.voxel_size else None,
            "load_factor": self.load_factor,
            "limit_factor": self.limit_factor,
            "stable": self.stable,
            "steps": self.steps,
            "time": self.time,
            "seconds": self.seconds,
        }


def _component(vector: NDArray[np.float64], axis: str | None) -> float:
    return float(np.linalg.norm(vector) if axis is None else vector["xyz".index(axis)])


def _pressures(design: Design, count: int) -> list[float]:
    """The final pressure in Pa in each cavity."""
    pressures = [0.0] * count
    for load in design.loads:
        if load.kind == "pressure":
            final = load.history.factor[-1] if load.history else 1.0
            for index in range(count) if load.cavity == "all" else [load.cavity]:
                pressures[index] += final * load.value
    return pressures
