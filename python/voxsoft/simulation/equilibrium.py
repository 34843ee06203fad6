"""The statics solver: settings, and what to say of its answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design import Pressure, Solver
from voxsoft.errors import SimulationError
from voxsoft.simulation.freedom import moves_freely
from voxsoft.simulation.setup import Setup
from voxsoft.units import format_percent

DEFAULT_STATICS_TOLERANCE = 1e-8
DEFAULT_STEPS = 20
DEFAULT_VOLUME_RATIO = 1.5

#: Fields of a solver that only statics knows, and those that only a run over time knows.
_STATICS_ONLY = ("control", "steps", "volume_ratio", "first_step")
_TIME_ONLY = ("time_step", "substeps", "iterations", "retardation", "end_time", "max_time")


def check_solver(solver: Solver) -> None:
    """Refuse settings of one solver that are given to the other.

    Raises
    ------
    SimulationError
        Naming the setting and the method that knows it.

    Examples
    --------
    >>> check_solver(Solver(method="xpbd", control="volume"))
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: solver.control: is a setting of statics, and the method is \
"xpbd". Try: use method = "statics", or leave control out
    """
    foreign = {"xpbd": (_STATICS_ONLY, "statics"), "statics": (_TIME_ONLY, "xpbd")}
    if solver.method not in foreign:
        return
    names, other = foreign[solver.method]
    for name in names:
        if getattr(solver, name) is not None:
            raise SimulationError(
                f"solver.{name}",
                f'is a setting of {other}, and the method is "{solver.method}"',
                f'use method = "{other}", or leave {name} out',
            )


def find_equilibrium(
    setup: Setup,
    solver: Solver,
    progress: Callable[[int, float, float], None] | None,
    problem: _core.Problem | None = None,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Solve a setup by statics, or a variant of its problem.

    Returns
    -------
    used, report
        The settings as used, and the core's report.

    Raises
    ------
    SimulationError
        Volume control without a pressure, or not enough memory.
    """
    control = solver.control or "load"
    if control == "volume" and not any(isinstance(load, Pressure) for load in setup.design.loads):
        raise SimulationError(
            "solver.control",
            '"volume" needs a volume to control, and the design has no pressure load',
            'add a pressure, or use "arc-length"',
        )
    asked: dict[str, Any] = {
        "tolerance": solver.tolerance or DEFAULT_STATICS_TOLERANCE,
        "first_step": solver.first_step or 1.0,
        "control": control,
        "steps": solver.steps or DEFAULT_STEPS,
        "ratio": solver.volume_ratio or DEFAULT_VOLUME_RATIO,
    }
    report = _core.equilibrium(
        problem or setup.problem,
        **asked,
        memory=memory_limit(),
        sensors=[(place.vertices, place.weights) for place in setup.places.values()],
        progress=progress,
    )
    report["way"] = control
    if report["status"] == "not-converged" and report["factor"] == 0.0 and moves_freely(setup):
        # Singular up to rounding is all that the factor shows of it.
        report["status"] = "mechanism"
    if report["status"] == "out-of-memory":
        raise SimulationError(
            "solver.method",
            too_large_a_tangent(len(setup.mesh.vertices), report["needed_bytes"]),
            'use larger voxels, or method = "xpbd"',
        )
    used = {"method": "statics", "way": control, "tolerance": asked["tolerance"]}
    if control != "load":
        used["steps"] = asked["steps"]
    if control == "volume":
        used["volume_ratio"] = asked["ratio"]
    return used, report


def too_large_a_tangent(vertices: int, needed: int) -> str:
    """Say that a tangent of so many vertices takes `needed` bytes, or is too large if that is 0."""
    size = f"takes about {needed / 1e9:.1f} GB, and" if needed else "does not fit:"
    free = f"{memory_limit() / 1e9:.1f} GB of memory are free"
    return f"the tangent of {vertices} vertices {size} {free}"


def sentence(report: dict[str, Any]) -> str:
    """Say how statics ended."""
    iterations = f"{report['steps']} Newton iterations"
    residual = f"residual {format_percent(report['residual'])} of the load"
    carried = f"{100 * report['factor']:.4g} % of the load"
    match report["status"]:
        case "at-rest":
            words = f"equilibrium after {iterations}, {residual}"
            if report["limit"] is not None:
                words += f"; the path has a limit at {100 * report['limit']:.4g} % of the load"
            if report["stable"]:
                return words
            if report["way"] == "load":
                words += ", and shorter load steps led past a point where the body can buckle"
            return f"{words}; under constant loads it is not stable"
        case "limit-reached" if not report["stable"]:
            return (
                f"the path has a limit at {100 * report['limit']:.4g} % of the load; its steps "
                f"ended past it, at {carried}. Raise steps to follow it further"
            )
        case "limit-reached":
            return (
                f"no equilibrium past {100 * report['limit']:.4g} % of the load, the limit of this "
                f"path; kept is the last stable state, at {carried}. Lower the load, or follow "
                'the path with control = "volume" or "arc-length"'
            )
        case "mechanism":
            return (
                f"a part of the body moves freely (the tangent is singular) at {carried}; clamp "
                "it, or join voxels that meet only along edges or corners (`voxsoft check` shows "
                "such hinges)"
            )
        case _ if report["way"] == "volume" and report["reached"] > 0.0:
            words = (
                f"followed for {100 * report['reached']:.4g} % of the growth in volume, to "
                f"{carried}, and lost there after {iterations}; kept are the path so far and its "
                "last state. Ask for more steps, or for a smaller volume_ratio"
            )
            if report["limit"] is not None:
                words += f"; the path has a limit at {100 * report['limit']:.4g} % of the load"
            return words
        case _:
            return (
                f"no equilibrium found past {carried} after {iterations}; kept is the last one. "
                'Try control = "arc-length", smaller voxels, or method = "xpbd"'
            )
