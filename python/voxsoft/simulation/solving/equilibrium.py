"""The statics solver: its controls with their settings, and messages about its answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Final, Literal, NamedTuple

from voxsoft import _core
from voxsoft._core import Status
from voxsoft._memory import memory_limit
from voxsoft.design.solver import Count, Ratio, Share, Tolerance
from voxsoft.errors import SimulationError
from voxsoft.simulation.loads import LoadReading, readings
from voxsoft.simulation.setup.freedom import free_motion
from voxsoft.simulation.setup.materials import core_materials
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.solving.method import Answer, Method, Progress, Report, Watch
from voxsoft.simulation.solving.start import Start
from voxsoft.units import format_percent, format_quantity

DEFAULT_STATICS_TOLERANCE: Final = 1e-8
DEFAULT_STEPS: Final = 20
#: The first step of arc-length control.
DEFAULT_ARC: Final = 0.2
DEFAULT_VOLUME_RATIO: Final = 1.5


#: Shortest step of swelling, as a part of the whole, where one step is too large.
_SHORTEST_STEP: Final = 1.0 / 128.0
#: After a step of so few iterations the next one is twice as long.
_FEW: Final = 6

#: Alternatives to a control that found no equilibrium, and to one that met a limit.
_OTHER_WAYS: Final[Mapping[str, str]] = {
    "load": 'control = "arc-length"',
    "arc-length": 'control = "load" or more steps',
    "volume": 'control = "load"',
    "creep": "a slower load",
}
_PAST_A_LIMIT: Final[Mapping[str, str]] = {
    "load": 'control = "volume" or "arc-length"',
    "arc-length": 'more steps, or control = "volume"',
    "volume": "more steps",
}


class Statics(Method):
    """Equilibrium by Newton's method on the sparse tangent."""

    family: ClassVar[str] = "statics"
    extra: ClassVar[frozenset[str]] = frozenset({"frames"})

    tolerance: Tolerance = DEFAULT_STATICS_TOLERANCE
    control: str

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Find the equilibrium under the final loads."""
        return find_equilibrium(setup, self, watch.progress, frames=watch.frames)


class LoadControl(Statics):
    """Load control: all loads grow together."""

    title: ClassVar[str] = "load control"

    control: Literal["load"] = "load"
    first_step: Share = 1.0

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Find the equilibrium under the final loads; swelling grows in steps if need be."""
        found = super().solve(setup, watch)
        grows = any(each.growth is not None for each in setup.design.activations)
        if found[1].status != Status.NOT_CONVERGED or not grows:
            return found
        steps, share, step = found[1].steps, 0.0, 0.25
        start: Start | None = None
        while share < 1.0:
            share_then = min(1.0, share + step)
            swollen = [each.share(share_then) for each in setup.design.activations]
            design = setup.design.replace(activations=tuple(swollen))
            own = core_materials(design, setup.materials, setup.mesh, setup.origin)
            problem = setup.problem.with_materials(own)
            used, report = find_equilibrium(
                setup, self, watch.progress, problem, frames=watch.frames, start=start
            )
            steps += report.steps
            if report.status == Status.AT_REST:
                start, share = Start(report.answer.positions), share_then
                step *= 2.0 if report.steps <= _FEW else 1.0
            elif report.status == Status.NOT_CONVERGED and step > _SHORTEST_STEP:
                step /= 4.0
            else:
                return found
        return used, Report(report.answer, report.status, steps)


class ArcLengthControl(Statics):
    """Arc-length control: all loads grow together, and the path is followed through snaps."""

    title: ClassVar[str] = "arc-length control"

    control: Literal["arc-length"] = "arc-length"
    first_step: Share = DEFAULT_ARC
    steps: Count = DEFAULT_STEPS


class VolumeControl(Statics):
    """Volume control: the pressurized volume grows to `volume_ratio`, the pressure follows."""

    title: ClassVar[str] = "volume control"

    control: Literal["volume"] = "volume"
    volume_ratio: Ratio = DEFAULT_VOLUME_RATIO
    steps: Count = DEFAULT_STEPS

    def solve(self, setup: Setup, watch: Watch) -> Answer:
        """Find the equilibrium at the final volume."""
        if all(reading.cavity is None for reading in readings(setup.design)):
            raise SimulationError(
                "solver.control",
                '"volume" needs a volume to control, and the design has no pressure load',
                'add a pressure, or use "arc-length"',
            )
        return super().solve(setup, watch)


class Stretch(NamedTuple):
    """Quasi-static interval from one instant of all histories to another.

    Attributes
    ----------
    since
        Instant in s of the equilibrium and the contact that it begins with; None at the beginning,
        where loads grow from zero.
    until
        Instant in s of the equilibrium to be found.
    longest
        Longest step where the answer depends on the load path, as a part of this interval.
    creeps
        True to integrate the viscous stress of Prony branches over the time, from a sudden load at
        time zero on.
    """

    since: float | None
    until: float
    longest: float
    creeps: bool = False

    @property
    def settings(self) -> dict[str, Any]:
        """Settings by their names in the core."""
        return {
            "control": "creep" if self.creeps else "time",
            "from_time": self.since,
            "to_time": self.until,
            "longest": self.longest,
        }


def find_equilibrium(
    setup: Setup,
    statics: Statics,
    progress: Progress,
    problem: _core.Problem | None = None,
    *,
    frames: bool = False,
    start: Start | None = None,
    stretch: Stretch | None = None,
) -> Answer:
    """Solve a setup by statics, or a variant of its problem; `frames` keeps all of the path.

    Without a start it begins at the unloaded body. A stretch of time replaces the control.

    Returns
    -------
    used, report
        The settings as used, and the core's report.

    Raises
    ------
    SimulationError
        Not enough memory.
    """
    settings = statics.model_dump(exclude={"control"})
    asked = {"ratio" if key == "volume_ratio" else key: each for key, each in settings.items()}
    answer = _core.equilibrium(
        problem or setup.problem,
        **asked,
        start=None if start is None else start.positions,
        pressures=None if start is None else start.pressures,
        **({"control": statics.control} if stretch is None else stretch.settings),
        memory=memory_limit(),
        sensors=[(place.vertices, place.weights) for place in setup.places.values()],
        frames=frames,
        progress=progress,
    )
    path, status = path_of(answer), answer.status
    if stretch is not None and stretch.creeps and stretch.since is not None:
        # A body that was at rest before is no mechanism: its tangent is singular at a limit.
        status = Status.NOT_CONVERGED if status == Status.MECHANISM else status
    elif status == Status.NOT_CONVERGED and free_motion(setup):
        # The factorization shows a mechanism only as a tangent that is singular up to rounding.
        status = Status.MECHANISM
    if status == Status.OUT_OF_MEMORY:
        raise SimulationError(
            "solver.method",
            too_large_a_tangent(len(setup.mesh.vertices), path.needed_bytes),
            'use larger voxels, or method = "xpbd"',
        )
    way = "creep" if stretch is not None and stretch.creeps else statics.control
    used = {"method": "statics", "way": way, **settings}
    return used, Report(answer, status, answer.steps)


def lost_creep(setup: Setup, stretch: Stretch, report: Report) -> str:
    """Describe where a creep was lost: its time, its loads, and other ways."""
    since = stretch.since or 0.0
    reached = path_of(report.answer).reached
    last = since + reached * (stretch.until - since)
    if stretch.since is None and reached == 0.0:
        at, met = "at time zero, when loads act suddenly", "the instantaneous stiffness"
    else:
        at, met = f"after {_instant(last)}", "the stiffness that is left"
    loads = ", ".join(_at_instant(each, last) for each in readings(setup.design))
    under = f" under {loads}" if loads else ""
    return (
        f"no equilibrium found {at}{under}, after {report.steps} Newton iterations: {met} may not "
        "carry the load (a limit, as of a balloon that bursts or a column that buckles); kept is "
        "the last one. Try a smaller load, an earlier end, smaller voxels, or motion with inertia "
        '(end_time, method = "dynamics")'
    )


def _at_instant(reading: LoadReading, instant: float) -> str:
    factor = 1.0 if reading.history is None else reading.history.at(instant)
    size = float(f"{factor * reading.size:.4g}")
    return f"{reading.label} of {format_quantity(size, reading.quantity)}"


def _instant(seconds: float) -> str:
    return format_quantity(float(f"{seconds:.6g}"), "time") if seconds else "0 s"


def path_of(answer: _core.Answer) -> _core.LoadPath:
    """Return the load path of an answer of statics."""
    assert answer.path is not None  # the core gives one with every answer of statics
    return answer.path


def too_large_a_tangent(vertices: int, needed: int) -> str:
    """Explain that a tangent takes `needed` bytes, or is too large if that is 0."""
    size = f"takes about {needed / 1e9:.1f} GB, and" if needed else "does not fit:"
    free = f"{memory_limit() / 1e9:.1f} GB of memory are free"
    return f"the tangent of {vertices} vertices {size} {free}"


def sentence(
    way: str,
    status: Status,
    steps: int,
    residual_left: float,
    path: _core.LoadPath,
    *,
    touches: bool = False,
    is_cut: bool = False,
) -> str:
    """Describe how statics ended: control, status, iterations, residual and path.

    With contact (`touches`) the only alternatives are statics and motion over time; where voxels
    are cut (`is_cut`) contact may converge on full ones.
    """
    iterations = f"{steps} Newton iterations"
    residual = f"residual {format_percent(residual_left)} of the load"
    limit = "" if path.limit is None else f"{100 * path.limit:.4g} % of the load"
    carried = f"{100 * path.factor:.4g} % of the load"
    match status:
        case Status.AT_REST:
            words = f"equilibrium after {iterations}, {residual}"
            if path.snaps and way == "creep":
                words += f"; the body snapped at {_instant(path.snaps[0])}"
            elif path.snaps:
                words += f"; the body snapped at {100 * path.snaps[0]:.4g} % of the load"
            if path.limit is not None:
                words += f"; the path has a limit at {limit}"
            if path.stable:
                return words
            if touches and way == "load":
                return (
                    f"{words}; it is not stable: the slightest push lets it buckle, tip or roll on"
                )
            if way == "load":
                words += ", and shorter load steps led past a point where the body can buckle"
            return f"{words}; under constant loads it is not stable"
        case Status.LIMIT_REACHED if not path.stable:
            return (
                f"the path has a limit at {limit}; its steps "
                f"ended past it, at {carried}. Raise steps to follow it further"
            )
        case Status.LIMIT_REACHED:
            return (
                f"no equilibrium past {limit}, the limit of this "
                f"path; kept is the last stable state, at {carried}. Lower the load, or follow "
                f"the path with {_PAST_A_LIMIT[way]}"
            )
        case Status.MECHANISM:
            return (
                f"a part of the body moves freely (the tangent is singular) at {carried}; clamp "
                "it, or join voxels that meet only along edges or corners (the check of the "
                "design shows such hinges)"
            )
        case _ if way == "volume" and path.reached > 0.0:
            words = (
                f"followed for {100 * path.reached:.4g} % of the growth in volume, to "
                f"{carried}, and lost there after {iterations}; kept are the path so far and its "
                "last state. Ask for more steps, or for a smaller volume_ratio"
            )
            if path.limit is not None:
                words += f"; the path has a limit at {limit}"
            return words
        case _:
            ways = f'{_OTHER_WAYS[way]}, smaller voxels, or method = "xpbd"'
            if touches:
                ways = (
                    f"{_OTHER_WAYS[way]}, a smaller load, smaller voxels, or motion over time "
                    '(method = "dynamics")'
                )
                if is_cut:
                    ways = f'fill = "binary", as contact settles on full voxels more surely; {ways}'
            if way == "arc-length" and path.factor > 0.0:
                return (
                    f"the path was followed to {carried}, where its steps ended or found no way "
                    f"on, after {iterations}; kept is its last equilibrium. Try {ways}"
                )
            return (
                f"no equilibrium found past {carried} after {iterations}; kept is the last one. "
                f"Try {ways}"
            )
