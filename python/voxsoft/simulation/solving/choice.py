"""Choice of the method that a design's settings mean, and of the settings that it uses.

The flat keys of :class:`~voxsoft.design.Solver` are read here and nowhere else: a setting that only
some methods have a field for chooses one of them, and one that the chosen method has none for is
refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, Final

from voxsoft.design import Design, Solver
from voxsoft.design.solver import OF_THE_ERROR
from voxsoft.errors import ErrorDetail, SimulationError
from voxsoft.materials import Hyperelastic, Rigid
from voxsoft.simulation.compatibility import (
    refusals,
    refused_features,
    refused_together,
)
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.simulation.solving.dynamics import Dynamics, DynamicsToEnd, DynamicsToRest
from voxsoft.simulation.solving.equilibrium import (
    ArcLengthControl,
    LoadControl,
    Statics,
    VolumeControl,
)
from voxsoft.simulation.solving.method import Method
from voxsoft.simulation.solving.rest import QuickestRest, Relaxation

#: Every method.
METHODS: Final[tuple[type[Method], ...]] = (
    LoadControl,
    ArcLengthControl,
    VolumeControl,
    Relaxation,
    QuickestRest,
    DynamicsToRest,
    DynamicsToEnd,
)
Kinds = frozenset[type[Method]]

#: Settings of the mesh, of the discretization error, or of the choice itself.
_OF_ALL: Final = frozenset({"method", "refine"}) | OF_THE_ERROR
_CONTROLS: Final[Mapping[str, type[Statics]]] = {
    "load": LoadControl,
    "arc-length": ArcLengthControl,
    "volume": VolumeControl,
}


STATICS: Final[Kinds] = frozenset({LoadControl, ArcLengthControl, VolumeControl})
DYNAMICS: Final[Kinds] = frozenset({DynamicsToRest, DynamicsToEnd})
_RELAXATION: Final[Kinds] = frozenset({Relaxation})
_ALL: Final = frozenset(METHODS)
_TO_REST: Final = frozenset(kind for kind in METHODS if kind.to_rest)


def _users(name: str) -> Kinds:
    if name in _OF_ALL:
        return _ALL
    return frozenset(kind for kind in METHODS if name in {*kind.model_fields, *kind.extra})


#: Every setting of a solver and of `simulate` itself, with the methods that use it.
USERS: Final[Mapping[str, Kinds]] = MappingProxyType(
    {name: _users(name) for name in (*Solver.model_fields, *sorted(Dynamics.extra))}
)

#: Name of each control of statics in the table of features and uses.
_USES: Final[Mapping[type[Method], str]] = {
    LoadControl: "load control",
    ArcLengthControl: "arc length",
    VolumeControl: "volume control",
}
#: Settings of explicit dynamics alone, where the method is open.
_EXPLICIT: Final = ("substeps", "iterations")

#: Advice for each setting: the entry that chooses a method that uses it.
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


def kind_of(design: Design, solver: Solver) -> type[Method]:
    """Return the kind of method that settings mean for a design.

    Parameters
    ----------
    design
        Its materials and layers decide where the settings leave it open.
    solver
        The settings.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> kind_of(families.beam(), Solver(end_time="1 s")).title
    'dynamics to an end time'
    """
    design = design.assembled
    given = set(given_settings(solver))
    timed = DynamicsToEnd if solver.is_timed else DynamicsToRest
    controlled = _CONTROLS[solver.control or "load"]
    dynamic = bool(given & _deciding(DYNAMICS)) or solver.damping not in (None, "auto")
    match solver.method:
        case "statics":
            return controlled
        case "relaxation":
            return Relaxation
        case "dynamics":
            return timed
        case "xpbd":
            return timed if dynamic else Relaxation
        case "auto":
            pass
    if given & _deciding(STATICS):
        return controlled
    if any(each.is_free for each in design.objects):
        return timed
    needs_statics = has_contact(design) or has_supplies(design) or design.tendons
    if needs_statics and not dynamic:
        return LoadControl
    if dynamic:
        return timed
    materials = [design.material_of(part) for part in design.parts]
    if design.layers or design.refine or any(isinstance(m, Rigid) for m in materials):
        return LoadControl
    # A body that only lies on a floor may slide: Newton's method needs a unique equilibrium.
    is_held = bool(design.clamps) or len(design.symmetry) == 3
    if solver.damping is not None or not is_held:
        return Relaxation
    return LoadControl if all(isinstance(m, Hyperelastic) for m in materials) else QuickestRest


def method_of(design: Design, solver: Solver) -> Method:
    """Return the method that settings mean for a design, with the settings that it uses.

    Parameters
    ----------
    design, solver
        See :func:`kind_of`; :func:`check_solver` refuses settings that are not used.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> method_of(families.beam(), Solver(control="volume", steps=30))
    VolumeControl(steps=30)
    >>> method_of(families.beam(), Solver(end_time="1 s", damping="5 1/s"))
    DynamicsToEnd(damping=5.0, end_time=1.0)
    """
    kind = kind_of(design, solver)
    given = given_settings(solver)
    return kind(**{name: given[name] for name in kind.model_fields if name in given})


def unused_settings(
    design: Design, solver: Solver, extra: Mapping[str, object] | None = None
) -> Iterator[ErrorDetail]:
    """Find the settings that would not be used.

    Parameters
    ----------
    design, solver
        The design to be solved, and the settings.
    extra
        Other keys of :data:`USERS`, where they are given.
    """
    kind = kind_of(design, solver)
    yield from refusals(design, _use_of(kind, solver))
    yield from refused_together(design)
    if kind not in DYNAMICS:
        for index, load in enumerate(readings(design)):
            if load.varies:
                what = f"changes with t, and {kind.title} looks for rest"
                hint = 'write method = "dynamics", or a field without t with a history'
                yield ErrorDetail(f"loads[{index}].acceleration", what, hint)
    if kind in DYNAMICS and solver.method != "xpbd":
        for feature in refused_features(design, "explicit dynamics"):
            for name in _EXPLICIT:
                if getattr(solver, name) is not None:
                    what = f"is a setting of explicit dynamics, which knows no {feature}"
                    yield ErrorDetail(f"solver.{name}", what, f"leave {name} out")
    given = given_settings(solver)
    for name in [*given, *(key for key, value in (extra or {}).items() if value)]:
        users = USERS[name]
        if name == "damping" and solver.damping != "auto":
            users &= DYNAMICS  # relaxation has "auto" alone
        if kind in users:
            continue
        where = name if extra and name in extra else f"solver.{name}"
        instead = _ASKING.get(name, _ASKING_FOR_DYNAMICS)
        what = f"is a setting of {_together(users)}, and {_because(name, kind, solver)}"
        yield ErrorDetail(where, what, f"{instead}, or leave {name} out")


def _use_of(kind: type[Method], solver: Solver) -> str:
    """Return the name of a kind of method in the table of features and uses."""
    if kind in DYNAMICS:
        return "explicit dynamics" if solver.method == "xpbd" else "dynamics"
    return _USES.get(kind, "relaxation")


def check_solver(
    design: Design, solver: Solver | None = None, extra: Mapping[str, object] | None = None
) -> None:
    """Refuse settings that would not be used.

    Parameters
    ----------
    design, solver, extra
        See :func:`unused_settings`; without a solver, that of the design.

    Raises
    ------
    SimulationError
        Settings that are not used, each with the methods that use it and a remedy.

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
    """Return the settings of the solution that differ from their defaults."""
    names = type(solver).model_fields.keys() - OF_THE_ERROR
    values = {name: getattr(solver, name) for name in type(solver).model_fields if name in names}
    plain = Solver()
    return {name: value for name, value in values.items() if value != getattr(plain, name)}


def _deciding(kinds: Kinds) -> set[str]:
    """Return the settings of a solver that only methods of some kinds use."""
    return {name for name, users in USERS.items() if users <= kinds} & set(Solver.model_fields)


def _together(kinds: Kinds) -> str:
    """Describe some kinds in words.

    Examples
    --------
    >>> _together(frozenset({VolumeControl, ArcLengthControl}))
    'arc-length control and volume control'
    """
    if kinds == _TO_REST:
        return "runs to rest"
    words = []
    for group in (_RELAXATION, STATICS, DYNAMICS):
        part = [kind for kind in METHODS if kind in kinds & group]
        words += [part[0].family] if len(part) == len(group) else [kind.title for kind in part]
    return " and ".join(words)


def _because(name: str, kind: type[Method], solver: Solver) -> str:
    """Explain why settings mean a kind that does not use one of them."""
    if not kind.to_rest and USERS[name] & _TO_REST and not USERS[name] <= STATICS:
        return "an end_time asks for motion up to it"
    if kind in STATICS and USERS[name] & STATICS:
        return f'the control is "{solver.control or "load"}"'
    if solver.method != "auto":
        return f'the method is "{solver.method}"'
    asking = [name for name in given_settings(solver) if name in _deciding(STATICS)]
    if asking:
        return f"{' and '.join(asking)} ask{'s' if len(asking) == 1 else ''} for statics"
    return f"this design is solved by {'statics' if kind in STATICS else kind.title}"


def settings_at_rest() -> dict[str, Any]:
    """Return None for each setting of runs over time: the search for rest uses none of them."""
    return dict.fromkeys((*sorted(_deciding(DYNAMICS)), "damping"))


def check_settings_of(design: Design, used: frozenset[str], by: str) -> None:
    """Refuse settings of a design that a procedure with settings of its own would not use.

    Parameters
    ----------
    design
        The design with the solver settings.
    used
        The settings that are used.
    by
        The procedure and its purpose, to follow "is not used by".

    Raises
    ------
    SimulationError
        Settings that are not used, each by its name.
    """
    problems = [
        ErrorDetail(f"solver.{name}", f"is not used by {by}", "leave it out of the design")
        for name in given_settings(design.solver)
        if name not in used
    ]
    if problems:
        raise SimulationError.listing(problems)
