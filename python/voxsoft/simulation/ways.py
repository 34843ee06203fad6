"""Which way to the answer a design's settings mean, and which of them that way uses.

The flat keys of :class:`~voxsoft.design.Solver` are read here and nowhere else: a setting that only
some ways know chooses one of them, and one that the chosen way does not use is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Any, Final

from voxsoft.design import Design, Solver
from voxsoft.errors import Problem, SimulationError
from voxsoft.materials import Hyperelastic, Rigid


class Way(StrEnum):
    """A way to the answer, named as an error calls it."""

    LOAD = "load control"
    ARC_LENGTH = "arc-length control"
    VOLUME = "volume control"
    #: Timeless relaxation.
    RELAXATION = "relaxation"
    #: Relaxation, or statics under load control where that is quicker.
    QUICKEST = "the quickest way to rest"
    #: Dynamics until the body is at rest.
    SETTLING = "dynamics run to rest"
    #: Dynamics to an end time.
    MOTION = "dynamics to an end time"


STATICS: Final = frozenset({Way.LOAD, Way.ARC_LENGTH, Way.VOLUME})
DYNAMICS: Final = frozenset({Way.SETTLING, Way.MOTION})
_RELAXATION: Final = frozenset({Way.RELAXATION})
_ALL: Final = frozenset(Way)
_TO_REST: Final = _ALL - {Way.MOTION}
_CONTROLS: Final[Mapping[str, Way]] = {
    "load": Way.LOAD,
    "arc-length": Way.ARC_LENGTH,
    "volume": Way.VOLUME,
}

#: Every setting of a solver, with the ways that use it.
USERS: Final[Mapping[str, frozenset[Way]]] = MappingProxyType(
    {
        "method": _ALL,
        "refine": _ALL,
        "tolerance": _TO_REST,
        "control": STATICS,
        "first_step": frozenset({Way.LOAD, Way.ARC_LENGTH}),
        "steps": frozenset({Way.ARC_LENGTH, Way.VOLUME}),
        "volume_ratio": frozenset({Way.VOLUME}),
        "time_step": DYNAMICS,
        "substeps": DYNAMICS,
        "iterations": DYNAMICS,
        # "auto" is known to relaxation, too; a rate and "critical" ask for dynamics.
        "damping": DYNAMICS | _RELAXATION,
        "retardation": DYNAMICS,
        "max_time": frozenset({Way.SETTLING}),
        "end_time": frozenset({Way.MOTION}),
        # Of `simulate` itself: statics records its path, and relaxation knows no time.
        "record_interval": DYNAMICS,
        "frames": DYNAMICS,
    }
)

#: What to write to be solved in a way that uses a setting.
_ASKING: Final[Mapping[str, str]] = {
    "tolerance": "leave end_time out",
    "control": 'write method = "statics"',
    "first_step": 'write control = "load"',
    "steps": 'write control = "arc-length" or control = "volume"',
    "volume_ratio": 'write control = "volume"',
    "max_time": "leave end_time out",
    "record_interval": "add an end_time",
    "frames": "add an end_time",
}
_ASKING_FOR_DYNAMICS: Final = 'write method = "xpbd"'


def way_of(design: Design, solver: Solver) -> Way:
    """Return the way that settings mean for a design.

    Parameters
    ----------
    design
        Its materials and layers decide where the settings leave it open.
    solver
        The settings.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> way_of(families.beam(), Solver(end_time="1 s"))
    <Way.MOTION: 'dynamics to an end time'>
    """
    given = set(given_settings(solver))
    timed = Way.SETTLING if solver.end_time is None else Way.MOTION
    controlled = _CONTROLS[solver.control or "load"]
    dynamic = bool(given & _deciding(DYNAMICS)) or solver.damping not in (None, "auto")
    if solver.method == "statics":
        return controlled
    if solver.method == "xpbd":
        return timed if dynamic else Way.RELAXATION
    if given & _deciding(STATICS):
        return controlled
    if dynamic:
        return timed
    materials = [design.material_of(part) for part in design.parts]
    if design.layers or any(isinstance(material, Rigid) for material in materials):
        return Way.LOAD
    # What only lies on a floor may slide: its place is not unique, which Newton's method needs.
    if solver.damping is not None or not design.clamps:
        return Way.RELAXATION
    return Way.LOAD if all(isinstance(m, Hyperelastic) for m in materials) else Way.QUICKEST


def unused_settings(
    design: Design, solver: Solver, extra: Mapping[str, object] | None = None
) -> Iterator[Problem]:
    """Find the settings that would not be used.

    Parameters
    ----------
    design, solver
        What is solved, and how.
    extra
        Other keys of :data:`USERS`, where they are given.
    """
    way = way_of(design, solver)
    given = given_settings(solver)
    for name in [*given, *(key for key, value in (extra or {}).items() if value)]:
        users = USERS[name]
        if way in users:
            continue
        where = name if extra and name in extra else f"solver.{name}"
        instead = _ASKING.get(name, _ASKING_FOR_DYNAMICS)
        what = f"is a setting of {_together(users)}, and {_because(name, way, solver)}"
        yield Problem(where, what, f"{instead}, or leave {name} out")


def check_solver(
    design: Design, solver: Solver | None = None, extra: Mapping[str, object] | None = None
) -> None:
    """Refuse settings that would not be used.

    Parameters
    ----------
    design, solver, extra
        As for :func:`unused_settings`; without a solver, that of the design.

    Raises
    ------
    SimulationError
        Naming each setting, the ways that use it, and what to write.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> check_solver(families.beam(), Solver(method="xpbd", control="volume"))
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: solver.control: is a setting of statics, and the method is \
"xpbd". Try: write method = "statics", or leave control out
    """
    problems = list(unused_settings(design, solver or design.solver, extra))
    if problems:
        raise SimulationError.listing(problems)


def given_settings(solver: Solver) -> dict[str, object]:
    """Return the settings that are not as they are by default."""
    values = {name: getattr(solver, name) for name in type(solver).model_fields}
    plain = Solver()
    return {name: value for name, value in values.items() if value != getattr(plain, name)}


def _deciding(ways: frozenset[Way]) -> set[str]:
    """The settings of a solver that mean one of some ways."""
    return {name for name, users in USERS.items() if users <= ways} & set(Solver.model_fields)


def _together(ways: frozenset[Way]) -> str:
    """Some ways in words.

    Examples
    --------
    >>> _together(frozenset({Way.VOLUME, Way.ARC_LENGTH}))
    'arc-length control and volume control'
    """
    if ways == _TO_REST:
        return "runs to rest"
    groups = (("relaxation", _RELAXATION), ("statics", STATICS), ("dynamics", DYNAMICS))
    words = []
    for name, group in groups:
        part = [str(way) for way in Way if way in ways & group]
        words += [name] if len(part) == len(group) else part
    return " and ".join(words)


def _because(name: str, way: Way, solver: Solver) -> str:
    """Why settings mean a way that does not use one of them."""
    if way is Way.MOTION and USERS[name] & _TO_REST and not USERS[name] <= STATICS:
        return "an end_time asks for motion up to it"
    if way in STATICS and USERS[name] & STATICS:
        return f'the control is "{solver.control or "load"}"'
    if solver.method != "auto":
        return f'the method is "{solver.method}"'
    asking = [name for name in given_settings(solver) if name in _deciding(STATICS)]
    if asking:
        return f"{' and '.join(asking)} ask{'s' if len(asking) == 1 else ''} for statics"
    return f"this design is solved by {'statics' if way in STATICS else way}"


def settings_at_rest() -> dict[str, Any]:
    """Return what takes all of runs over time out of settings: the search for rest needs none."""
    return dict.fromkeys((*sorted(_deciding(DYNAMICS)), "damping"))


def check_settings_of(design: Design, used: frozenset[str], by: str) -> None:
    """Refuse the settings of a design that something with settings of its own would not use.

    Parameters
    ----------
    design
        Whose solver is looked at.
    used
        The settings that are used.
    by
        What it is and does, after "is not used by".

    Raises
    ------
    SimulationError
        Naming each setting that is not used.
    """
    problems = [
        Problem(f"solver.{name}", f"is not used by {by}", "leave it out of the design")
        for name in given_settings(design.solver)
        if name not in used
    ]
    if problems:
        raise SimulationError.listing(problems)
