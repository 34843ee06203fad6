"""Simulation of a design in one call."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from voxsoft import _core
from voxsoft._core import Status as Ended
from voxsoft.design import Design, Solver, require_design
from voxsoft.design.refinement import TIMES_AS_SMALL
from voxsoft.errors import SimulationError
from voxsoft.simulation.checks.falling import falls, flies
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.loads import undefined_in_words, undefined_past
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.simulation.results.result import Recording, Result, Status
from voxsoft.simulation.runs.nested import nested
from voxsoft.simulation.runs.symmetric_body import SectorSetup
from voxsoft.simulation.setup.freedom import free_motion
from voxsoft.simulation.setup.growth import at_time
from voxsoft.simulation.setup.large_voxels import evenly_small
from voxsoft.simulation.setup.places import voxel_size
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.choice import check_solver, method_of
from voxsoft.simulation.solving.equilibrium import LoadControl, Statics, find_equilibrium, sentence
from voxsoft.simulation.solving.method import Report, Watch
from voxsoft.units import format_percent, si_value

#: Called now and then with (steps, time in s, residual).
ProgressCallback = Callable[[int, float, float], None]


def simulate(
    design: Design | Setup,
    *,
    record_interval: float | str | None = None,
    frames: bool = False,
    progress: ProgressCallback | None = None,
    coarser: Result | None = None,
    **settings: Any,  # noqa: ANN401 - the fields of Solver declare the types
) -> Result:
    """Simulate a design until it comes to rest, or to an end time.

    Designs of hyperelastic parts, and those with layers, are solved by statics, Newton's method on
    the equilibrium. Others are brought to rest by dynamic relaxation, which is quick and has no
    time, or, where its first 200 steps leave more than 0.6 of the load out of balance, by statics.
    With any of `end_time`, `max_time`, `time_step`, `substeps`, `iterations`, `retardation`, or a
    `damping` that is not ``"auto"``, real time is simulated (Algorithm 3 of the paper, extended
    position-based dynamics); all come to rest in the same state. Real time is damped critically
    on the way to rest and not at all on the way to an end time, unless `damping` says otherwise.

    Parameters
    ----------
    design
        The design to simulate; a :class:`Setup` saves meshing again. Threads that share one wait
        for each other.
    record_interval
        Interval between two records of the probes, in s or with its unit, ``"50 ms"``; default
        1/50 s. For runs over time only.
    frames
        True to record all vertices as well. For runs over time, and for the load path of statics.
    progress
        Called about ten times a second with (steps, time, residual); an exception it raises
        ends the run.
    coarser
        An equilibrium of the same design on voxels twice as large. Load control without contact
        begins there, in a fraction of the iterations, where the voxels fill the large ones; other
        methods begin at the unloaded body.
    **settings
        Fields of :class:`voxsoft.design.Solver` that replace the design's own: ``time_step``,
        ``substeps``, ``iterations``, ``damping``, ``tolerance``, ``max_time``, ``end_time`` ...

    Returns
    -------
    Result
        Result with the ``status`` ``ok``, ``not-at-rest`` or ``diverged``.

    Raises
    ------
    DesignError
        The design cannot be solved: no clamp, a probe outside the body, ...
    NoCavityError, DisconnectedError
        Special cases of that, which a study counts apart.
    SimulationError
        A setting that would not be used, with the methods that use it and a remedy; a tangent too
        large for the memory; a setup that is solved from within its own progress.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> result = simulate(families.beam())
    >>> result.status
    'ok'
    """
    given = design.design if isinstance(design, Setup) else require_design(design).assembled
    if record_interval is not None:
        record_interval = si_value(record_interval, "time", "record_interval", positive=True)
    solver = _settings(given.solver, settings)
    check_solver(given, solver, {"record_interval": record_interval, "frames": frames})
    method = method_of(given, solver)
    if isinstance(design, Setup):
        setup = design
        _check_refinement(setup, settings)
    else:
        setup = Setup.of(given, allow_loose=not method.to_rest, refine=solver.refine)
    if setup.design.refine and not isinstance(method, Statics):
        setup = Setup(evenly_small(setup.design, refinement(setup)), setup.mesh)
    started = time.perf_counter()
    part = SectorSetup.part_of(setup)
    solved = setup if part is None else part
    if isinstance(method, LoadControl) and coarser is not None:
        start = nested(coarser, solved)
        used, report = find_equilibrium(solved, method, progress, frames=frames, start=start)
    else:
        used, report = method.solve(solved, Watch(progress, record_interval, frames))
    used["refine"] = refinement(setup)
    result = result_of(solved, used, report, time.perf_counter() - started)
    return result if part is None else part.unfolded(result)


def relax(setup: Setup, problem: _core.Problem, tolerance: float, max_steps: int) -> Result:
    """Bring one variant of a setup's problem to rest (other materials, say).

    Parameters
    ----------
    setup
        The setup of the problem.
    problem
        The problem to solve, from :meth:`Setup.problem_with`.
    tolerance
        Largest relative residual at rest.
    max_steps
        Steps after which the run counts as not at rest.
    """
    refuse(setup.design, "relaxation")
    started = time.perf_counter()
    used = {"method": "xpbd", "way": "relaxation", "tolerance": tolerance, "max_steps": max_steps}
    answer = problem.relax(tolerance=tolerance, max_steps=max_steps)
    return result_of(setup, used, Report.of(answer), time.perf_counter() - started)


def balance(setup: Setup, problem: _core.Problem, tolerance: float) -> Result:
    """Find the equilibrium of one variant of a setup's problem (other materials, say) by statics.

    Parameters
    ----------
    setup
        The setup of the problem.
    problem
        The problem to solve, from :meth:`Setup.problem_with`.
    tolerance
        Largest relative residual.
    """
    started = time.perf_counter()
    used, report = find_equilibrium(setup, LoadControl(tolerance=tolerance), None, problem)
    return result_of(setup, used, report, time.perf_counter() - started)


def _settings(own: Solver, changes: dict[str, Any]) -> Solver:
    return own if not changes else own.replace(**changes)


def refinement(setup: Setup) -> int:
    """Return the refinement of a setup: the parts of the design's voxels along each axis."""
    first = setup.mesh.each_body[0]
    own = setup.design.alone(first.name).voxel_size / voxel_size(first.mesh)
    return max(1, round(own / TIMES_AS_SMALL if setup.design.refine else own))


def _check_refinement(setup: Setup, settings: dict[str, Any]) -> None:
    """Refuse another refinement of a setup, which is meshed already."""
    asked, done = settings.get("refine"), refinement(setup)
    if asked is not None and asked != done:
        raise SimulationError(
            "solver.refine",
            f"is {asked}, and the voxels of this setup are cut into {done} along each axis",
            f"make it by Setup.of(design, refine={asked}), or simulate the design",
        )


_STATUSES: dict[_core.Status, Status] = {
    Ended.AT_REST: "ok",
    Ended.END_TIME: "ok",
    Ended.NOT_AT_REST: "not-at-rest",
    Ended.DIVERGED: "diverged",
    Ended.LIMIT_REACHED: "not-at-rest",
    Ended.NOT_CONVERGED: "not-at-rest",
    Ended.MECHANISM: "not-at-rest",
}


def result_of(setup: Setup, used: dict[str, Any], report: Report, seconds: float) -> Result:
    """Wrap the report of a solver in a :class:`Result`."""
    answer, path, touching = report.answer, report.answer.path, setup.touching
    fluids = setup.fluids
    rest = setup.mesh.vertices
    still = [place.weights @ rest[place.vertices] for place in setup.places.values()]
    records = answer.records
    recording = Recording(
        times=answer.record_times,
        probes={
            name: records[:, index] - still[index] if len(records) else np.zeros((0, 3))
            for index, name in enumerate(setup.places)
        },
        frames=answer.frames,
        chambers={} if fluids is None else fluids.histories(answer.chamber_records),
        **_touch_history(setup, answer),
    )
    return Result(
        design=at_time(setup.design, answer.time) if used["way"] == "dynamics" else setup.design,
        mesh=setup.mesh,
        places=setup.places,
        status=_STATUSES[report.status],
        message=_sentence(setup, report, used["way"]),
        positions=answer.positions,
        velocities=answer.velocities,
        residual=answer.residual,
        reactions=answer.reactions,
        reaction=_triple(answer.reaction),
        reaction_moment=_triple(answer.reaction_moment),
        load=_triple(answer.load),
        load_moment=_triple(answer.load_moment),
        elastic_energy=answer.elastic_energy,
        mass=setup.problem.mass,
        solver=used,
        steps=report.steps,
        back_offs=answer.back_offs,
        time=answer.time,
        seconds=seconds,
        recording=recording,
        load_factor=1.0 if path is None else path.factor,
        limit_factor=None if path is None else path.limit,
        snaps=() if path is None else tuple(path.snaps),
        stable=None if path is None else path.stable,
        contacts=() if touching is None else touching.contacts(answer.contacts),
        objects={} if touching is None else touching.poses(answer.objects),
        contact_field=ContactField.of(answer.contact_field),
        tendons={
            tendon.name: tendon.state(found)
            for tendon, found in zip(setup.tendons, answer.tendons, strict=True)
        },
        supplies=() if fluids is None else fluids.states(answer.chambers),
        peaks=answer.problem.peaks(),
    )


def _touch_history(setup: Setup, answer: _core.Answer) -> dict[str, Any]:
    """Return contacts, poses of objects, energies and momentum, as keywords of a recording."""
    if setup.touching is None or answer.history is None:
        return {}
    history = answer.history
    poses = [setup.touching.poses(found) for found in history.objects]
    return {
        "contacts": tuple(setup.touching.contacts(found) for found in history.contacts),
        "objects": {
            each.name: (
                np.array([pose[each.name].position for pose in poses]),
                np.array([pose[each.name].rotation for pose in poses]),
            )
            for each in setup.design.objects
        },
        "elastic_energy": np.array(history.elastic),
        "kinetic_energy": np.array(history.kinetic),
        "load_potential": np.array(history.loads),
        "momentum": np.array(history.momentum),
    }


def _sentence(setup: Setup, report: Report, way: str) -> str:
    answer = report.answer
    if answer.path is not None:
        if report.status == Ended.NOT_AT_REST:
            return falls(setup, answer)
        if report.status == Ended.MECHANISM and (free := free_motion(setup)):
            return (
                f"nothing holds the body: it is free to {free}, so that its place under the loads "
                "is not known; clamp it along these axes, or give the design an end_time"
            )
        if report.status == Ended.NOT_CONVERGED and (nowhere := _undefined(setup, answer)):
            return f"{nowhere}; kept is the last equilibrium"
        touches = setup.touching is not None
        ended = (report.status, report.steps, answer.residual, answer.path)
        is_cut = setup.mesh.fractions is not None
        return sentence(way, *ended, touches=touches, is_cut=is_cut)
    residual = f"residual {format_percent(answer.residual)} of the load"
    steps = f"{report.steps} steps"
    match report.status:
        case Ended.AT_REST:
            return f"at rest after {steps}, {residual}"
        case Ended.END_TIME:
            return f"reached the end time after {steps}, {residual}"
        case Ended.NOT_AT_REST:
            return (
                f"not at rest after {steps}, {residual}; raise max_time, or check that the body "
                "is held well enough to find a rest"
            )
        case _:
            if answer.undefined is not None:
                numbered = enumerate(setup.loads)
                owners = [index for index, load in numbered for _ in load.actions]
                return f"{undefined_in_words(answer.undefined, owners)}; kept is the last state"
            assert answer.breakdown is not None  # the core gives it where a body diverged
            _, place, when = answer.breakdown
            if setup.touching is not None:
                return _lost_contact(setup, answer)
            point = ", ".join(f"{value * 1e3:.1f}" for value in setup.origin + place)
            return (
                f"diverged at ({point}) mm, after {when:.6g} "
                f"{'s' if answer.substep else 'steps'} and {answer.back_offs} halvings of "
                "the step: the material cannot carry the load, or it is a mechanism"
            )


def _undefined(setup: Setup, answer: _core.Answer) -> str | None:
    """Tell which load has no value past the end of a load path."""
    assert answer.path is not None
    rest, factor = setup.mesh.vertices, answer.path.factor
    return undefined_past(setup.loads, rest, answer.positions, factor)


def _lost_contact(setup: Setup, answer: _core.Answer) -> str:
    """Explain why a run over time with contact ended early."""
    return flies(setup, answer) or (
        f"no step goes on from {answer.time:.6g} s, after {answer.back_offs} halvings: contact did "
        "not settle, or the material cannot carry the load; kept is the last state. Try a shorter "
        "time_step, smaller voxels, or less friction"
    )


def _triple(values: list[float]) -> tuple[float, float, float]:
    x, y, z = values
    return x, y, z
