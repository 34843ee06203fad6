"""Numbers of a run that have error bars."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.number import Number, Numbers, vector
from voxsoft.comparison.supplied import supplied_growth, supplied_mass, supplied_pressure
from voxsoft.design import Constraint, Design, Objective
from voxsoft.design.chamber import chosen_cavities
from voxsoft.design.contact import FLOOR
from voxsoft.metrics import METRICS, Target
from voxsoft.metrics.definition import NOT_NEGATIVE
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.loads import readings
from voxsoft.simulation.results.vibration import modes
from voxsoft.simulation.setup.tendons import STIFF

#: Hold margin from which on it stands for a load of zero.
_BOUNDLESS: Final = 1e8

Entries = dict[tuple[str, ...], Number]


def numbers_of(setup: Setup, result: Result) -> Numbers:
    """Collect the numbers of a run, each with the part that the deformation of the body makes.

    Parameters
    ----------
    setup, result
        The run.

    Returns
    -------
    dict
        Numbers by group, entry and name: ``load_factor``, ``limit_factor``, ``snaps`` by their
        index, ``metrics``, ``probes``, ``volumes`` and ``pressures`` of cavities by their index,
        ``reactions``, ``contacts``, ``objects``, ``tendons`` and ``supplies``.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> cylinder = families.cylinder(radius="20 mm", height="30 mm")
    >>> setup = vs.simulation.Setup.of(cylinder)
    >>> found = numbers_of(setup, vs.simulate(setup))
    >>> found["metrics", "mass"].deformed, found["probes", "top", "z"].kind
    (0.0, 'length')
    """
    found = _Found(setup, result)
    entries: Entries = {}
    for part in (
        found.factors(),
        found.metrics(),
        found.probes(),
        found.cavities(),
        found.reactions(),
        found.contacts(),
        found.objects(),
        found.tendons(),
        found.supplies(),
    ):
        entries.update(part)
    return entries


def frequencies_of(result: Result, count: int) -> Numbers:
    """Collect the slowest natural frequencies of a run, as ``frequencies`` by their index.

    Raises
    ------
    SimulationError
        See :func:`voxsoft.modes`.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> beam = families.beam(length="60 mm").with_values("parts.0.material=ecoflex-00-30")
    >>> round(frequencies_of(vs.simulate(beam), 1)["frequencies", "0"].value, 1)
    5.6
    """
    return {
        ("frequencies", str(index)): Number.of(frequency, "rate", bounds=NOT_NEGATIVE)
        for index, frequency in enumerate(modes(result, count).frequencies.tolist())
    }


def is_peak(name: str, design: Design) -> bool:
    """Return True if a metric is the largest of all voxels, which grows at sharp corners."""
    target = asked_of(design).get(name)
    metric = METRICS[target.metric if target else name]
    return metric.is_peak and (target is None or target.percentile is None)


def asked_of(design: Design) -> Mapping[str, Objective | Constraint]:
    """Return the objectives and constraints of a design by name."""
    return {**design.objectives, **design.constraints}


class _Found:
    """The numbers of one result, group by group."""

    def __init__(self, setup: Setup, result: Result) -> None:
        self.setup, self.result = setup, result
        cavities = result.mesh.cavities
        self.rest = [float(cavity.volume) for cavity in cavities]
        volumes = zip(result.cavity_volumes, self.rest, strict=True)
        self.growth = [abs(now - before) for now, before in volumes]
        for number, supply in enumerate(result.supplies):
            if len(supply.cavities) == 1:
                (index,) = supply.cavities
                self.growth[index] = supplied_growth(setup, supply, number)
        self.prescribed = self._prescribed()

    def _prescribed(self) -> set[int]:
        """Indices of the cavities whose volumes together volume control prescribes."""
        if self.result.solver["way"] != "volume":
            return set()
        design, mesh = self.result.design, self.result.mesh
        choices = [load.cavity for load in readings(design) if load.cavity is not None]
        return {index for each in choices for index in chosen_cavities(each, mesh, "cavity")}

    def grown(self, cavities: set[int]) -> float:
        """Sum the growth of some cavities that the walls decide, m³."""
        if cavities == self.prescribed:
            return 0.0
        return sum(self.growth[index] for index in cavities)

    def factors(self) -> Entries:
        result = self.result
        found: Entries = {("load_factor",): Number.of(result.load_factor, "number")}
        if result.limit_factor is not None:
            found["limit_factor",] = Number.of(result.limit_factor, "number")
        for index, snap in enumerate(result.snaps):
            found["snaps", str(index)] = Number.of(snap, "number")
        return found

    def metrics(self) -> Entries:
        result, asked = self.result, asked_of(self.result.design)
        found: Entries = {}
        for name, value in result.metrics.items():
            if is_peak(name, result.design):
                continue
            target = asked.get(name) or Objective(maximize=name)
            metric = METRICS[target.metric]
            part = self.deformed(target, float(value))
            found["metrics", name] = Number(float(value), metric.kind, part, metric.bounds)
        return found

    def deformed(self, target: Target, value: float) -> float:
        """Size of the part of a metric that the deformation makes; all of it where not known."""
        result = self.result
        match target.metric:
            case "mass" | "volume" | "undercut" | "min_wall_thickness":
                return 0.0
            case "cavity_volume" | "cavity_volume_change":
                return self.grown(set(chosen_cavities(target.cavity, result.mesh, "cavity")))
            case "chamber_pressure":
                chosen = set(chosen_cavities(target.cavity, result.mesh, "cavity"))
                return max((self.pressure(index).deformed for index in chosen), default=0.0)
            case "contact_gap":
                return min(abs(value), abs(value - self.gap_at_rest(target)))
            case "tendon_length":
                return self.drawn(target.tendon or next(iter(result.tendons)))
            case "reaction" if target.region is None and target.object is None:
                named = target.clamp is None or len(result.design.clamps) == 1
                rest = self.carried if named else np.zeros(3)
                change = np.asarray(result.reaction) - rest
                if target.clamp is not None and not named:
                    return abs(value)
                part = change if target.axis is None else change["xyz".index(target.axis)]
                return min(abs(value), float(np.linalg.norm(part)))
        return abs(value)

    def gap_at_rest(self, target: Target) -> float:
        """Measure the gap between the unloaded body and an object where that is now, m."""
        still = replace(self.result, positions=self.setup.mesh.vertices, contacts=())
        return float(METRICS[target.metric].value(still, target))

    @property
    def carried(self) -> NDArray[np.float64]:
        """Reaction of all supports that would hold the loads on the unloaded body, N, (3,).

        Zero where that is not known: where the loads are an answer, or contact carries some.
        """
        if self.result.solver["way"] != "load" or self.setup.touching is not None:
            return np.zeros(3)
        rest = self.setup.mesh.vertices
        loads: NDArray[np.float64] = self.setup.problem.net_forces(rest).sum(axis=0)
        return -loads

    def probes(self) -> Entries:
        found: Entries = {}
        for name, moved in self.result.probes.items():
            found |= vector(("probes", name), moved.tolist(), "length")
        return found

    def cavities(self) -> Entries:
        found: Entries = {}
        bounds = METRICS["cavity_volume"].bounds
        for index, volume in enumerate(self.result.cavity_volumes):
            part = self.grown({index})
            found["volumes", str(index)] = Number(volume, "volume", part, bounds)
            found["pressures", str(index)] = self.pressure(index)
        return found

    def pressure(self, index: int) -> Number:
        """Return the pressure in a cavity."""
        bounds = METRICS["chamber_pressure"].bounds
        for number, supply in enumerate(self.result.supplies):
            if index in supply.cavities:
                return supplied_pressure(self.setup, supply, number)
        return Number.of(float(self.result.cavity_pressures[index]), "pressure", bounds=bounds)

    def reactions(self) -> Entries:
        result = self.result
        found: Entries = {}
        alone = len(result.clamp_reactions) == 1
        for name, force in result.clamp_reactions.items():
            # Supports of a closed cavity under pressure push and pull: their sum is rounding.
            scale = float(np.linalg.norm(result.reactions, axis=1).sum())
            rigid = self.carried.tolist() if alone else (0.0, 0.0, 0.0)
            found |= vector(("reactions", name), force, "force", rigid=rigid, scale=scale)
        return found

    def contacts(self) -> Entries:
        found: Entries = {}
        for each in self.result.contacts:
            key = ("contacts", *each.of)
            found |= vector(key, each.force, "force", scale=each.pressed)
            found[*key, "pressed"] = Number.of(each.pressed, "force", bounds=NOT_NEGATIVE)
            found[*key, "pressure"] = Number.of(each.pressure, "force", bounds=NOT_NEGATIVE)
            found[*key, "area"] = Number.of(each.area, "area", bounds=NOT_NEGATIVE)
        return found

    def objects(self) -> Entries:
        result, found = self.result, Entries()
        held = {name for each in result.contacts if FLOOR not in each.of for name in each.of}
        touching = self.setup.touching
        for index, each in enumerate(result.design.objects):
            name = each.name
            if touching is not None and name in result.objects:
                first = touching.surfaces[index].middle.tolist()
                place = result.objects[name].position
                found |= vector(("objects", name), place, "length", rigid=first)
            if name not in held:
                continue
            grip = result.metric("grip_force", object=name)
            found["objects", name, "grip_force"] = Number.of(grip, "force")
            margin = result.metric("hold_margin", object=name)
            if 0.0 < margin < _BOUNDLESS:
                found["objects", name, "hold_margin"] = Number.of(
                    margin, "number", bounds=NOT_NEGATIVE
                )
        return found

    def tendons(self) -> Entries:
        found: Entries = {}
        for own in self.setup.tendons:
            each = self.result.tendons[own.name]
            anchor = abs(each.anchor_tension)
            if own.tendon.tension is not None:
                anchor = min(abs(each.tension - each.anchor_tension), anchor)
            entries = {
                "tension": Number.of(each.tension, "force", bounds=NOT_NEGATIVE),
                "anchor_tension": Number(each.anchor_tension, "force", anchor, NOT_NEGATIVE),
                "length": Number(each.length, "length", self.drawn(own.name), NOT_NEGATIVE),
                "slack": Number.of(each.slack, "length", bounds=NOT_NEGATIVE),
                "shortening": Number(each.shortening, "length", self.drawn(own.name)),
            }
            found |= {("tendons", own.name, key): number for key, number in entries.items()}
        return found

    def drawn(self, name: str) -> float:
        """Part of the length of a tendon that the deformation of the body decides, m.

        Slack and the stretch under tension decide that of a tendon of given length.
        """
        state = self.result.tendons[name]
        (tendon,) = (each.tendon for each in self.setup.tendons if each.name == name)
        if tendon.tension is not None:
            return abs(state.shortening)
        stretch = abs(state.tension) * state.length / (tendon.stiffness or STIFF)
        return min(abs(state.shortening), state.slack + stretch)

    def supplies(self) -> Entries:
        found: Entries = {}
        for index, each in enumerate(self.result.supplies):
            part = supplied_growth(self.setup, each, index)
            entries = {
                "pressure": supplied_pressure(self.setup, each, index),
                "volume": Number(each.volume, "volume", part, NOT_NEGATIVE),
                "mass": supplied_mass(self.setup, each, index),
                "work": Number.of(each.work, "energy"),
                "energy": Number.of(each.energy, "energy"),
            }
            found |= {("supplies", each.name, key): number for key, number in entries.items()}
        return found
