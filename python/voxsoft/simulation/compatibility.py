"""Table of the features of a design against their uses: a use is known, or refused with a reason.

Every refusal of a feature by a use is looked up here, and ``docs/compatibility.md`` is written from
the same table. A cell that is not in :data:`REASONS` works; the tests run each of them.

Refusals that depend on more than the design stand where they are found: a derivative where
surfaces slip, a path along a number that changes the mesh, a setting that a method does not use.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple

from voxsoft.design import Design
from voxsoft.errors import DesignError, ErrorDetail, SimulationError, VoxSoftError
from voxsoft.simulation.features import FEATURES, IMPLIED, has_feature


class Reason(NamedTuple):
    """Reason of a refusal, to follow the place of the feature, and a remedy."""

    what: str
    hint: str


@dataclass(frozen=True)
class Use:
    """A use of a design.

    Attributes
    ----------
    who
        Name in messages.
    title
        Name in the documentation.
    error
        Type of the error.
    """

    who: str
    title: str
    error: type[VoxSoftError] = DesignError


#: Every use, by its name.
USES: Final[Mapping[str, Use]] = MappingProxyType(
    {
        "check": Use("checks", "check"),
        "load control": Use("statics", "statics, load control", SimulationError),
        "arc length": Use("arc-length control", "statics, arc length", SimulationError),
        "volume control": Use("volume control", "statics, volume control", SimulationError),
        "dynamics": Use("dynamics", "dynamics", SimulationError),
        "explicit dynamics": Use("dynamics by xpbd", "dynamics by xpbd", SimulationError),
        "relaxation": Use("relaxation", "relaxation", SimulationError),
        "error bars": Use("error bars", "error bars"),
        "gradient": Use("gradients", "gradient"),
        "path": Use("paths", "path"),
        "path of activations": Use("a path of activations", "path of activations"),
        "study": Use("studies", "study"),
        "modes": Use("modes", "modes", SimulationError),
        "simulator": Use("the simulator", "Simulator"),
        "live motion": Use("live motion", "live motion"),
        "comparison": Use("comparisons", "compare"),
        "outside codes": Use("outside codes", "outside codes", SimulationError),
        "scikit-fem": Use("the code with scikit-fem", "scikit-fem", SimulationError),
        "mesh file": Use("mesh files", "mesh to .inp"),
        "page": Use("exported pages", "page"),
        "refining": Use("refining", "refine by itself"),
        "calibration": Use("calibrations", "calibrate"),
        "calibration along gradients": Use("calibration along gradients", "calibrate by gradients"),
        "confirmation": Use("the confirmation of a study", "confirm"),
        "unsolved states": Use("states that no solver ended in", "states as they stand"),
        "symmetry": Use("planes of symmetry", "with planes of symmetry"),
        "softening": Use("rubber that softens", "with softening"),
    }
)

_LEAVE_OUT: Final = "compare the design without it"
_NO_VOXELS: Final = Reason(
    "is not known to {who}, which need voxels",
    'fill voxels with it: a shape of the kind "mesh", and voxel_size',
)
_BODIES: Final = Reason(
    "are not known to {who} yet",
    "take the design of one of them, or solve it with `voxsoft run`",
)
_CONTACT: Final = Reason(
    "is not known to {who} yet",
    'find the equilibrium with "voxsoft run", or leave contact and objects out',
)
_NO_SUPPLIES: Final = Reason(
    "are not known to {who} yet",
    "give the chambers pressure loads instead, or leave the supplies out",
)
_SOFTENING: Final = Reason(
    "is not known to {who}",
    'find equilibria, along a path with "voxsoft run --over", or leave mullins out',
)
_SOFTENING_AT_REST: Final = Reason(
    "is known to statics and implicit dynamics, and the settings mean {who}",
    'write method = "statics" or method = "dynamics", or leave mullins out',
)
_CONTACT_IMPLICIT: Final = Reason(
    "is found by statics and by implicit dynamics, and the settings mean {who}",
    'write method = "statics", or method = "dynamics", or leave contact and objects out',
)
_TENDONS_IMPLICIT: Final = Reason(
    "is pulled by statics and implicit dynamics, and the settings mean {who}",
    'write method = "statics", or method = "dynamics", or leave tendons out',
)
_IMPLICIT_STEPS: Final = Reason(
    "is known to steps that are implicit, and the settings mean {who}",
    'write method = "dynamics", or leave it out',
)
_SUPPLIES_BY: Final = Reason(
    "are known to load control and implicit dynamics, and the settings mean {who}",
    'write method = "statics", or method = "dynamics"',
)
_PEAKS_OF_A_PART: Final = Reason(
    "solves a part of the body, and what softening voxels remember is not known then",
    "leave it out, or leave mullins out of the materials",
)
_PEAKS_AT_REST: Final = Reason(
    "changes what a part is at rest, and what softening voxels remember is not known then",
    "leave it out, or leave mullins out of the materials",
)
_GROWTH_OVER_TIME: Final = Reason(
    "is not followed by {who}", "leave it out, or run the design over time"
)
_OUTSIDE: Final = Reason("cannot be given to an outside code", _LEAVE_OUT)
_WITH_PLANES: Final = Reason(
    "is not known together with planes of symmetry yet", "leave it out, or the planes"
)

#: Reason of each refusal, by feature and uses; all other cells work.
_REFUSED: Final[tuple[tuple[str, tuple[str, ...], Reason], ...]] = (
    ("softening", ("explicit dynamics", "relaxation"), _SOFTENING_AT_REST),
    ("softening", ("gradient", "live motion", "page"), _SOFTENING),
    ("contact", ("explicit dynamics", "relaxation"), _CONTACT_IMPLICIT),
    ("tendons", ("explicit dynamics", "relaxation"), _TENDONS_IMPLICIT),
    (
        "supplies",
        ("arc length", "volume control", "explicit dynamics", "relaxation"),
        _SUPPLIES_BY,
    ),
    (
        "free objects",
        ("arc length",),
        Reason(
            "is free, and past a limit of the load nothing holds what arc length follows",
            'fix it or move it, or write control = "load" or control = "volume"',
        ),
    ),
    (
        "symmetry and contact",
        ("arc length",),
        Reason(
            'is not known together with contact and control = "arc-length" yet',
            'leave the planes out, or write control = "load"',
        ),
    ),
    (
        "symmetry and friction",
        ("volume control",),
        Reason(
            'is not known together with contact and friction and control = "volume" yet',
            'leave the planes out, or write control = "load"',
        ),
    ),
    (
        "free objects",
        ("gradient",),
        Reason(
            "is free, and derivatives of where it ends are not known yet",
            "hold it, or give it a motion",
        ),
    ),
    (
        "bonds",
        ("gradient",),
        Reason(
            "is a bond, and derivatives of what bonds carry are not known yet",
            "use a sampler without gradients",
        ),
    ),
    (
        "adhesion",
        ("gradient", "page", "live motion", "outside codes", "symmetry"),
        Reason("is not known to {who} yet", "leave adhesion out"),
    ),
    ("several bodies", ("gradient", "page", "live motion"), _BODIES),
    (
        "several bodies",
        ("outside codes", "calibration", "confirmation"),
        _BODIES,
    ),
    (
        "contact",
        ("path of activations", "calibration along gradients", "unsolved states"),
        _CONTACT,
    ),
    (
        "contact",
        ("scikit-fem",),
        Reason(_CONTACT.what, "compare with CalculiX: apt install calculix-ccx"),
    ),
    ("bonds", ("page", "live motion"), _CONTACT),
    ("spring lattice and contact", ("page", "live motion"), _CONTACT),
    (
        "supplies",
        ("live motion", "page", "outside codes"),
        _NO_SUPPLIES,
    ),
    ("activations over time", ("page", "live motion"), _GROWTH_OVER_TIME),
    (
        "activations with a profile",
        ("page",),
        Reason(
            "is not known to {who} yet", "leave it out, or give several parts values of their own"
        ),
    ),
    (
        "profiles and contact",
        ("live motion",),
        Reason("is not known to {who} beside contact yet", "press Solve"),
    ),
    ("mesh of a file", ("comparison", "confirmation"), _NO_VOXELS),
    ("immersion", ("outside codes",), Reason(_OUTSIDE.what, "compare the design without it")),
    ("immersion", ("symmetry",), Reason(_WITH_PLANES.what, "leave the planes out")),
    ("drag", ("explicit dynamics",), _IMPLICIT_STEPS),
    ("drag", ("outside codes",), Reason(_OUTSIDE.what, "compare the design without it")),
    ("drag", ("symmetry",), Reason(_WITH_PLANES.what, "leave the planes out")),
    ("force field", ("explicit dynamics",), _IMPLICIT_STEPS),
    ("force field", ("outside codes",), Reason(_OUTSIDE.what, "compare the design without it")),
    ("force field", ("symmetry",), Reason(_WITH_PLANES.what, "leave the planes out")),
    (
        "floor",
        ("scikit-fem",),
        Reason("is not known to {who}", "compare with CalculiX: apt install calculix-ccx"),
    ),
    (
        "layers",
        ("scikit-fem",),
        Reason("are not known to {who}", "compare with CalculiX: apt install calculix-ccx"),
    ),
    (
        "layers that seal",
        ("outside codes",),
        Reason(
            "spans openings, and outside codes are given layers on faces of voxels",
            "leave seal out, or close the chamber by a layer of voxels",
        ),
    ),
    ("springs and the like", ("outside codes",), _OUTSIDE),
    ("tendons", ("outside codes",), _OUTSIDE),
    ("activations", ("outside codes",), Reason(_OUTSIDE.what, "compare without them")),
    ("fibers", ("outside codes",), Reason(_OUTSIDE.what, "compare the design without them")),
    (
        "cut voxels",
        ("outside codes",),
        Reason(
            "outside codes are given full voxels, and these are partly filled",
            'compare with fill = "binary"',
        ),
    ),
    (
        "free objects",
        ("outside codes",),
        Reason(
            "is free, and outside codes are given objects that are fixed or moved",
            "fix it, or give it a displacement",
        ),
    ),
    (
        "objects that turn",
        ("outside codes",),
        Reason(
            "turns the object, and outside codes are given objects that move without turning",
            "leave the rotation out",
        ),
    ),
    (
        "bonds",
        ("outside codes",),
        Reason(
            "is a bond, which outside codes are not given",
            "let the two touch, or make them parts of one body",
        ),
    ),
    (
        "supplies",
        ("symmetry",),
        Reason(_WITH_PLANES.what, "leave the planes out, or give pressure loads"),
    ),
    ("springs and the like", ("symmetry",), _WITH_PLANES),
    ("tendons", ("symmetry",), _WITH_PLANES),
    ("dielectrics", ("symmetry",), _WITH_PLANES),
    ("bonds", ("symmetry",), Reason(_WITH_PLANES.what, "leave the planes out, or let it touch")),
    ("fibers of several bodies", ("symmetry",), _WITH_PLANES),
    ("activations of several bodies", ("symmetry",), _WITH_PLANES),
    ("planes of symmetry", ("softening",), _PEAKS_OF_A_PART),
    ("softening", ("symmetry",), _PEAKS_OF_A_PART),
    ("activations", ("softening",), _PEAKS_AT_REST),
    ("softening", ("path of activations",), _PEAKS_AT_REST),
    (
        "spring lattice",
        ("path of activations",),
        Reason(
            "acts on hyperelastic parts",
            "use the neo-Hookean material of the same Young's modulus",
        ),
    ),
)

#: Reason of each refusal, by feature and use.
REASONS: Final[Mapping[tuple[str, str], Reason]] = MappingProxyType(
    {
        (feature, use): Reason(reason.what.format(who=USES[use].who), reason.hint)
        for feature, uses, reason in _REFUSED
        for use in uses
    }
)


def reason_of(feature: str, use: str) -> Reason | None:
    """Return the reason why a use refuses a feature; None if it works."""
    found = (REASONS.get((each, use)) for each in (feature, *IMPLIED.get(feature, ())))
    return next((reason for reason in found if reason is not None), None)


def refused_features(design: Design, use: str) -> Iterator[str]:
    """Find the features of a design that a use refuses; parameters as for :func:`refusals`."""
    found = (feature for feature, by in REASONS if by == use)
    return (feature for feature in found if has_feature(design, feature))


def refusals(design: Design, use: str) -> Iterator[ErrorDetail]:
    """Find the entries of a design that a use refuses, each place once.

    Parameters
    ----------
    design
        The design.
    use
        The name of a use, of :data:`USES`.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> wet = families.beam().replace(loads=[{"kind": "immersion", "level": "1 m"}])
    >>> [str(each) for each in refusals(wet, "outside codes")]
    ['loads[0]: cannot be given to an outside code. Try: compare the design without it']
    """
    design, seen = design.assembled, set[str]()
    for feature in refused_features(design, use):
        for where in FEATURES[feature](design):
            if where not in seen:
                seen.add(where)
                yield ErrorDetail(where, *REASONS[feature, use])


def refuse(design: Design, use: str) -> None:
    """Raise an error where a design has a feature that a use refuses.

    Parameters
    ----------
    design, use
        See :func:`refusals`.

    Raises
    ------
    VoxSoftError
        Entries of the design that the use refuses, with the reasons; of the type of the use.
    """
    if found := list(refusals(design, use)):
        raise USES[use].error.listing(found)


def sentences_of_refusals(design: Design) -> dict[str, str]:
    """Return a sentence for each use that refuses a design, by the name of the use.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> sentences_of_refusals(families.beam())
    {}
    """
    found = {}
    for use in USES:
        for first in refusals(design, use):
            place = f"{first.where} " if first.where else ""
            found[use] = f"{place}{first.what}: {first.hint}."
            break
    return found


def refused_together(design: Design) -> Iterator[ErrorDetail]:
    """Find the entries of a design that rubber which softens, another feature of it, refuses."""
    if has_feature(design, "softening"):
        yield from refusals(design, "softening")
