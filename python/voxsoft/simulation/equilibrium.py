"""The statics solver: settings, and what to say of its answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from voxsoft import _core
from voxsoft._memory import memory_limit
from voxsoft.design import Solver
from voxsoft.errors import SimulationError
from voxsoft.simulation.freedom import moves_freely
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup import Setup
from voxsoft.units import format_percent

DEFAULT_STATICS_TOLERANCE = 1e-8
DEFAULT_STEPS = 20
#: The first step of arc-length control.
DEFAULT_ARC = 0.2
DEFAULT_VOLUME_RATIO = 1.5


#: What to try instead of a control that found no equilibrium, and of one that met a limit.
_OTHER_WAYS: Final[Mapping[str, str]] = {
    "load": 'control = "arc-length"',
    "arc-length": 'control = "load" or more steps',
    "volume": 'control = "load"',
}
_PAST_A_LIMIT: Final[Mapping[str, str]] = {
    "load": 'control = "volume" or "arc-length"',
    "arc-length": 'more steps, or control = "volume"',
    "volume": "more steps",
}


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
    if control == "volume" and not any(
        reading.cavity is not None for reading in readings(setup.design)
    ):
        raise SimulationError(
            "solver.control",
            '"volume" needs a volume to control, and the design has no pressure load',
            'add a pressure, or use "arc-length"',
        )
    asked: dict[str, Any] = {
        "tolerance": solver.tolerance or DEFAULT_STATICS_TOLERANCE,
        "first_step": solver.first_step or (DEFAULT_ARC if control == "arc-length" else 1.0),
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
    if control == "volume":
        used["volume_ratio"] = asked["ratio"]
    else:
        used["first_step"] = asked["first_step"]
    if control != "load":
        used["steps"] = asked["steps"]
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
                f"the path with {_PAST_A_LIMIT[report['way']]}"
            )
        case "mechanism":
            return (
                f"a part of the body moves freely (the tangent is singular) at {carried}; clamp "
                "it, or join voxels that meet only along edges or corners (the check of the "
                "design shows such hinges)"
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
                f'Try {_OTHER_WAYS[report["way"]]}, smaller voxels, or method = "xpbd"'
            )
