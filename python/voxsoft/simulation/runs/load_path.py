"""A path of equilibria: a value of a design, or the time of its histories, changes step by step.

Each equilibrium begins where the one before ended, with its contact: friction depends on the load
path, so that a path there and back is a loop. Loads and motions are made histories of one body,
which is meshed once.

Long because all that may change along a path, and how it becomes one design, stands here.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from statistics import fmean
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._core import Status
from voxsoft.design import Design, Solver, require_design
from voxsoft.design.activation import AnyActivation
from voxsoft.design.dielectric import Dielectric
from voxsoft.design.growth import Growth
from voxsoft.design.history import History
from voxsoft.design.shape_memory import ShapeMemory
from voxsoft.design.target import Along
from voxsoft.design.tendon import Tendon
from voxsoft.errors import DesignError, SimulationError
from voxsoft.metrics import METRICS, Target
from voxsoft.simulation.compatibility import refuse, refused_together
from voxsoft.simulation.features import has_feature
from voxsoft.simulation.results.result import Result
from voxsoft.simulation.runs.fluid_path import FluidPath, SetupAlong
from voxsoft.simulation.runs.over import TIME, Over
from voxsoft.simulation.runs.run import ProgressCallback, result_of
from voxsoft.simulation.runs.solved_state import SolvedState, is_given_by_positions
from voxsoft.simulation.runs.symmetric_body import SectorSetup
from voxsoft.simulation.setup.materials import core_materials
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.choice import method_of
from voxsoft.simulation.solving.equilibrium import (
    LoadControl,
    Stretch,
    find_equilibrium,
    lost_creep,
)
from voxsoft.simulation.solving.start import Start

#: Longest step where the answer depends on the path, as a part of all of it.
_LONGEST: Final = 0.05
#: Entries of a design that may change along a path: the rest decides the mesh.
_ALONG: Final = ("loads", "tendons", "clamps", "objects")
#: Entries that may change too, each in a way of its own.
_ALONG_OTHERWISE: Final = ("activations", "supplies")
#: Reduction of the values along a path to one, by :data:`voxsoft.design.target.Along`.
_ALONG_PATH: Final[Mapping[Along, Callable[[Sequence[float]], float]]] = {
    "last": lambda values: values[-1],
    "largest": max,
    "smallest": min,
    "mean": fmean,
}
#: Tolerance of equal values, relative to the largest.
_SAME: Final = 1e-9


@dataclass(frozen=True)
class LoadPath:
    """The equilibria along a path.

    Attributes
    ----------
    design
        The design that was asked for, with the settings that were used.
    over
        The key that changes, and its values.
    results
        The equilibrium at each value that was reached; where the path was lost the last one is not
        at rest.
    creep
        Viscous stress at the last equilibrium of a creep, as numbers; else None.
    """

    design: Design
    over: Over
    results: tuple[Result, ...]
    creep: NDArray[np.float64] | None = field(default=None, repr=False, compare=False)

    @property
    def status(self) -> str:
        """Status of the last equilibrium."""
        return self.results[-1].status

    @property
    def message(self) -> str:
        """End of the path in words, and its position where the path was lost."""
        found, asked = len(self.results), len(self.over.values)
        last = self.results[-1]
        if last.status == "ok":
            iterations = sum(result.steps for result in self.results)
            return f"{found} equilibria, {iterations} Newton iterations"
        where = self.over.in_words(self.over.values[found - 1])
        return f"lost at {where}, after {found - 1} of {asked} equilibria: {last.message}"

    @property
    def values(self) -> tuple[float, ...]:
        """The values that were reached, in SI units."""
        return self.over.values[: len(self.results)]

    @cached_property
    def columns(self) -> Mapping[str, tuple[str, tuple[float, ...]]]:
        """The kind and the values of each number along the path, by its name.

        Metrics first, then the components of the displacement of each probe, then volumes and
        pressures of chambers.
        """
        design = self.results[0].design
        asked: dict[str, Target] = {**design.objectives, **design.constraints}
        found: dict[str, tuple[str, tuple[float, ...]]] = {}
        for name in self.results[0].metrics:
            metric = asked[name].metric if name in asked else name
            values = tuple(float(result.metrics[name]) for result in self.results)
            found[name] = (METRICS[metric].kind, values)
        for probe in self.results[0].probes:
            for axis, letter in enumerate("xyz"):
                moved = tuple(float(result.probes[probe][axis]) for result in self.results)
                found[f"{probe}.{letter}"] = ("length", moved)
        for index, cavity in enumerate(self.results[0].mesh.cavities):
            name = cavity.name or f"cavity {index}"
            volumes = tuple(result.cavity_volumes[index] for result in self.results)
            found[f"{name}.volume"] = ("volume", volumes)
            pressures = tuple(float(result.cavity_pressures[index]) for result in self.results)
            found[f"{name}.pressure"] = ("pressure", pressures)
        return found

    @property
    def metrics(self) -> Mapping[str, float]:
        """One number for each metric, in SI units: as the design's target says, or the last one."""
        design = self.results[0].design
        asked: dict[str, Target] = {**design.objectives, **design.constraints}
        return {
            name: _ALONG_PATH[(asked[name].along if name in asked else None) or "last"](
                [float(result.metrics[name]) for result in self.results]
            )
            for name in self.results[0].metrics
        }

    def summary(self) -> dict[str, Any]:
        """Return plain data in SI units: each value of ``path`` with the numbers of its result."""
        return {
            "status": self.status,
            "message": self.message,
            "over": self.over.key,
            "metrics": dict(self.metrics),
            "path": [
                {"value": value, **result.summary()}
                for value, result in zip(self.values, self.results, strict=True)
            ],
            "seconds": sum(result.seconds for result in self.results),
        }


def follow(
    design: Design,
    over: Over | str,
    values: Sequence[float | str] | None = None,
    *,
    progress: ProgressCallback | None = None,
    step: Callable[[LoadPath], None] | None = None,
    earlier: Sequence[tuple[NDArray[np.float64], SolvedState]] = (),
    creep: NDArray[np.float64] | None = None,
    **settings: Any,  # noqa: ANN401 - the fields of Solver declare the types
) -> LoadPath:
    """Follow equilibria along the values of a load, a motion or a parameter of them.

    Over ``"time"``, rubber with ``prony`` branches relaxes and creeps, from time zero on, at which
    all that has no history acts suddenly. Along any other value it has its long-term stiffness.

    Parameters
    ----------
    design
        The design to be loaded.
    over
        The key that changes, as :meth:`~voxsoft.Design.with_values` names keys
        (``"loads[0].value"``, or a parameter), or ``"time"``: then loads and motions are those of
        their histories at given instants, quasi-statically. With its values in one text:
        ``"loads[0].value=0..30 kPa/16"`` (:class:`Over` reads it).
    values
        Values in SI units or with their unit, in the order in which they are reached; a path there
        and back may show a loop.
    progress
        See :func:`voxsoft.simulate`.
    step
        Called after each equilibrium with the path so far.
    earlier
        Vertex positions and all other state of the first equilibria of a path that was stopped.
        It resumes behind them where positions determine an equilibrium; contact, tendons, supplies,
        softening and planes of symmetry make it start over.
    creep
        Viscous stress at the last of these, :attr:`LoadPath.creep`: a creep starts over without it.
    **settings
        Fields of :class:`voxsoft.design.Solver` that replace the design's own.

    Returns
    -------
    LoadPath
        Up to the first value at which no equilibrium was found.

    Raises
    ------
    DesignError
        A value that changes the body itself, or a load's direction; a value that is not valid.
    SimulationError
        The design asks for motion over time, arc length or volume control; times of rubber that
        relaxes are negative or go back.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> path = vs.follow(families.pneunet(chambers=2), "loads[0].value=0..1 kPa/3")
    >>> [round(1e3 * z, 1) for z in path.columns["tip.z"][1][1:]]
    [-0.4, -0.8]
    """
    given = require_design(design).assembled
    asked = over if isinstance(over, Over) else _read(over, values, given)
    solver = given.solver if not settings else given.solver.replace(**settings)
    given = given.replace(solver=solver)
    _check(given, solver)
    if refused := list(refused_together(given)):
        raise DesignError.listing(refused)
    if asked.key == TIME:
        _check_supplies(given, over_time=True)
    creeps = asked.key == TIME and has_feature(given, "viscosity")
    if creeps:
        _check_times(asked)
    designs = [_with_value(given, asked, number) for number in range(len(asked.values))]
    if asked.key != TIME:
        designs = _remembering(designs)
    timed, instants = _joined(designs, asked, given)
    setup = Setup.of(timed, refine=solver.refine)
    if asked.key != TIME and any(each.supplies != timed.supplies for each in designs):
        _check_supplies(given, over_time=False)
        fluids = FluidPath(
            timed,
            setup.mesh,
            designs=tuple(designs),
            instants=tuple(instants),
            key=asked.key,
        )
        setup = SetupAlong(setup.design, setup.mesh, along=fluids)
    part = SectorSetup.part_of(setup)
    solved = setup if part is None else part
    swells = any(_sizes(each) != _sizes(given) for each in designs)
    if swells:
        refuse(given, "path of activations")
    method = method_of(given, solver)
    tolerance = {"tolerance": method.tolerance} if isinstance(method, LoadControl) else {}
    statics = LoadControl(**tolerance)
    results: list[Result] = []
    problem = solved.problem
    if swells and creeps:
        # Steps of time between the values follow the histories of activations.
        own = core_materials(timed, setup.materials, solved.mesh, solved.origin, over_time=True)
        problem = problem.with_materials(own)
    start: Start | None = None
    before: float | None = None
    share = max(1, len(instants) - 1)
    known = part is None and is_given_by_positions(given) and not given.tendons
    if known and (creep is not None or not creeps):
        for number, (positions, state) in enumerate(earlier):
            found = state.result(setup, positions)
            if found.status != "ok":
                break
            results.append(replace(found, design=designs[number]))
            start, before = Start(positions), instants[number]
    if creeps and results:
        try:
            problem = _crept(problem, instants[: len(results)], earlier, creep)
        except ValueError:
            results, start, before = [], None, None
    if results and step is not None:
        step(LoadPath(given, asked, tuple(results), creep))
    for number, instant in enumerate(instants):
        if number < len(results):
            continue
        started = time.perf_counter()
        if swells and not creeps:
            own = core_materials(designs[number], setup.materials, solved.mesh, solved.origin)
            problem = problem.with_materials(own)
        stretch = Stretch(before, instant, min(1.0, _LONGEST * share), creeps)
        used, report = find_equilibrium(
            solved, statics, progress, problem, start=start, stretch=stretch
        )
        used["refine"] = solver.refine
        result = result_of(solved, used, report, time.perf_counter() - started)
        if creeps and report.status == Status.NOT_CONVERGED:
            result = replace(result, message=lost_creep(solved, stretch, report))
        # The next equilibrium continues from the whole state of this one.
        problem, start, before = report.answer.problem, Start(result.positions), instant
        whole = result if part is None else part.unfolded(result)
        results.append(replace(whole, design=designs[number]))
        path = LoadPath(given, asked, tuple(results), problem.creep() if creeps else None)
        if step is not None:
            step(path)
        if result.status != "ok":
            break
    return path


def _crept(
    problem: _core.Problem,
    instants: Sequence[float],
    earlier: Sequence[object],
    creep: NDArray[np.float64] | None,
) -> _core.Problem:
    """Return to a creep at the last of some instants; ValueError if its state is unknown."""
    if creep is None or len(earlier) != len(instants):
        raise ValueError("not all equilibria can be read")
    return problem.with_creep(instants[-1], creep)


def _read(over: str, values: Sequence[float | str] | None, design: Design) -> Over:
    """Read a key with its values, given in one text or apart."""
    return Over.read(over) if values is None else Over.of(over, values, design)


def _check(design: Design, solver: Solver) -> None:
    """Refuse solvers without an equilibrium, and controls that find the load themselves."""
    if not method_of(design, solver).to_rest or solver.is_timed:
        raise SimulationError(
            "solver",
            "asks for motion over time, and a path is made of equilibria",
            "leave out end_time and other settings of motion",
        )
    if solver.control not in (None, "load"):
        raise SimulationError(
            "solver.control",
            f'is "{solver.control}", which looks for the load by itself',
            'leave it out for a path over a value, or write control = "load"',
        )


def _check_times(over: Over) -> None:
    """Refuse times that rubber which relaxes cannot go through."""
    if over.values[0] < 0.0 or any(np.diff(over.values) < 0.0):
        raise SimulationError(
            "over",
            "goes back in time, and rubber with prony branches remembers",
            'let it rise from zero or later, such as "time=0..300 s/4"',
        )


def _check_supplies(design: Design, *, over_time: bool) -> None:
    """Refuse histories of supplies where equilibria cannot follow them: flow takes time."""
    for where in _supply_histories(design, of_valves_alone=over_time):
        what = "is gone through at each value of the path"
        raise SimulationError(
            where,
            "is not followed by a path of equilibria" if over_time else what,
            "leave it out, or give the design an end_time: motion over time fills the chamber",
        )


def _supply_histories(design: Design, *, of_valves_alone: bool) -> Iterator[str]:
    """Yield the places of histories of supplies and of their valves."""
    for index, supply in enumerate(design.supplies):
        if supply.history is not None and not of_valves_alone:
            yield f"supplies[{index}].history"
        for name in ("valve", "leak"):
            valve = getattr(supply, name, None)
            if valve is not None and valve.history is not None:
                yield f"supplies[{index}].{name}.history"
    for index, connection in enumerate(design.connections):
        valve = connection.valve
        if valve is not None and valve.history is not None:
            yield f"connections[{index}].valve.history"


def _with_value(design: Design, over: Over, number: int) -> Design:
    """Return the design at one of the values."""
    value = over.values[number]
    if over.key == TIME:
        return _at_instant(design, value)
    return design.with_values(f"{over.key}={over.toml(value)}").assembled


def _sizes(design: Design) -> list[Growth | None]:
    """Return the growth of parts by each activation of a design."""
    return [activation.growth for activation in design.activations]


def _remembering(designs: list[Design]) -> list[Design]:
    """Continue shape memory along designs, each from the state of the one before."""
    found = designs[:1]
    for design in designs[1:]:
        found.append(design.replace(activations=_after(found[-1].activations, design.activations)))
    return found


def _after(
    before: Sequence[AnyActivation], now: Sequence[AnyActivation]
) -> tuple[AnyActivation, ...]:
    """Continue activations from the state of others."""
    found: list[AnyActivation] = []
    for index, (old, new) in enumerate(zip(before, now, strict=True)):
        if isinstance(old, ShapeMemory) and isinstance(new, ShapeMemory):
            if new.history is not None:
                raise DesignError(
                    f"activations[{index}].history",
                    "would be gone through at each value of the path",
                    'leave it out, or follow "time"',
                )
            found.append(new.after(old))
        else:
            found.append(new)
    return tuple(found)


def _at_instant(design: Design, instant: float) -> Design:
    """Return the design with the loads and motions of an instant."""

    def history(own: History | None) -> History | None:
        return own if own is None else History(time=(0.0,), factor=(own.at(instant),))

    activations = tuple(each.at(instant) for each in design.activations)
    supplies = tuple(each.replace(history=history(each.history)) for each in design.supplies)
    changed = _with_histories(design, history, history)
    return changed.replace(activations=activations, supplies=supplies)


def _with_histories(
    design: Design,
    of_load: Callable[[History | None], History | None],
    of_motion: Callable[[History | None], History | None],
) -> Design:
    """Return the design with other histories."""

    def moved(holder: Any) -> Any:  # noqa: ANN401 - a clamp or an object
        motion = holder.motion
        if not hasattr(motion, "history"):
            return holder
        return holder.replace(motion=motion.replace(history=of_motion(motion.history)))

    return design.replace(
        loads=tuple(load.replace(history=of_load(load.history)) for load in design.loads),
        tendons=tuple(each.replace(history=of_load(each.history)) for each in design.tendons),
        clamps=tuple(moved(clamp) for clamp in design.clamps),
        objects=tuple(moved(each) for each in design.objects),
    )


def _joined(designs: list[Design], over: Over, given: Design) -> tuple[Design, list[float]]:
    """Join designs to one with their loads and motions as histories, and return its instants."""
    if over.key == TIME:
        return given, list(over.values)
    instants = [float(number) for number in range(len(designs))]
    first = designs[0]
    for other in designs[1:]:
        for name in Design.model_fields:
            if name in (*_ALONG, *_ALONG_OTHERWISE, "parameters", "included"):
                continue
            if getattr(first, name) != getattr(other, name):
                raise DesignError(
                    over.key,
                    f"changes {name}, and a path keeps the body as it is",
                    "vary a load, a motion, or a parameter that only these use; a study varies "
                    "the body",
                )
    changes: dict[str, Any] = {}
    for name in _ALONG:
        lists = [getattr(design, name) for design in designs]
        changes[name] = tuple(
            _one_of([each[index] for each in lists], instants, f"{name}[{index}]", over)
            for index in range(len(lists[0]))
        )
    changes["activations"] = tuple(
        _one_of(
            [each.activations[index] for each in designs], instants, f"activations[{index}]", over
        )
        if isinstance(activation, Dielectric)
        else activation
        for index, activation in enumerate(first.activations)
    )
    return first.replace(**changes), instants


def _one_of(variants: list[Any], instants: list[float], where: str, over: Over) -> Any:  # noqa: ANN401
    """Join variants to one load, clamp or object with their values as its history."""
    if all(each == variants[0] for each in variants):
        return _at_the_end(variants[0])
    if not hasattr(variants[0], "motion"):
        size = variants[0].drive if isinstance(variants[0], Tendon) else "value"
        values = [getattr(each, size) for each in variants]
        if any(value is None for value in values):
            raise DesignError(over.key, f"changes how {where} is pulled", f"vary its {size}")
        sizes = [np.atleast_1d(np.asarray(value, dtype=float)) for value in values]
        largest, factors = _factors(sizes, where, over)
        same = [each.replace(**{size: values[largest]}) for each in variants]
        history = _history(variants, factors, instants)
        joined = [each.replace(history=history) for each in same]
    else:
        motions = [each.motion for each in variants]
        if not all(hasattr(motion, "history") for motion in motions):
            raise DesignError(over.key, f"changes what {where} is", "vary how far it moves")
        sizes = [
            np.array([*m.displacement, m.rotation.angle if m.rotation else 0.0]) for m in motions
        ]
        largest, factors = _factors(sizes, where, over)
        history = _history(motions, factors, instants)
        joined = [
            each.replace(motion=motions[largest].replace(history=history)) for each in variants
        ]
    if any(each != joined[0] for each in joined):
        raise DesignError(
            over.key, f"changes more of {where} than how large it is", "vary its value alone"
        )
    return joined[0]


def _at_the_end(item: Any) -> Any:  # noqa: ANN401 - a load, clamp or object
    """Keep a load, clamp or object at the end of its history, where equilibria are."""
    holder = item if hasattr(item, "history") else getattr(item, "motion", None)
    history = getattr(holder, "history", None)
    if holder is None or history is None:
        return item
    ended = holder.replace(history=History(time=(0.0,), factor=(history.factors[-1],)))
    return ended if holder is item else item.replace(motion=ended)


def _factors(sizes: list[np.ndarray[Any, Any]], where: str, over: Over) -> tuple[int, list[float]]:
    """Return the number of the largest of some vectors, and all as multiples of it."""
    lengths = [float(np.linalg.norm(size)) for size in sizes]
    largest = int(np.argmax(lengths))
    axis = sizes[largest]
    factors = [float(size @ axis) / lengths[largest] ** 2 for size in sizes]
    for size, factor in zip(sizes, factors, strict=True):
        if np.abs(size - factor * axis).max() > _SAME * lengths[largest]:
            raise DesignError(
                over.key,
                f"changes the direction of {where}",
                "vary how large it is; make two of it, one for each direction or axis",
            )
    return largest, factors


def _history(holders: list[Any], factors: list[float], instants: list[float]) -> History:
    """Return the history of factors at instants, times the final factors of the histories."""
    ends = [1.0 if each.history is None else each.history.factors[-1] for each in holders]
    return History(
        time=tuple(instants),
        factor=tuple(factor * end for factor, end in zip(factors, ends, strict=True)),
    )
