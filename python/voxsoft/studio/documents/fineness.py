"""Fineness of a mesh on the page: whether smaller voxels are possible, and their cost."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

from voxsoft._memory import memory_limit
from voxsoft.comparison.other_voxels import cost_on_voxels
from voxsoft.comparison.refining import refined
from voxsoft.design import Design
from voxsoft.design.document.formula import is_formula
from voxsoft.errors import DesignError
from voxsoft.materials import Hyperelastic
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.solving.choice import STATICS, kind_of
from voxsoft.studio.bodies.body import BYTES_PER_VOXEL
from voxsoft.studio.documents.copies import Change
from voxsoft.studio.documents.document import DesignDocument
from voxsoft.studio.outputs.exports import Shown
from voxsoft.studio.protocol import events
from voxsoft.units import format_quantity

_NUMBER_AND_UNIT: Final = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S.*)?")
_DIVIDED: Final = re.compile(r"=\s*\((?P<whole>.*)\)/(?P<by>\d+)")


def fineness_of(shown: Shown, document: DesignDocument) -> events.Fineness:
    """Estimate the cost of voxels half as large for the shown body, and the changes that make them.

    Parameters
    ----------
    shown
        The equilibrium.
    document
        The design that it is of.

    Raises
    ------
    DesignError
        The design is not valid, or another one than that of the body.
    VoxSoftError
        The body cannot be solved.
    """
    design, source = document.design, document.source
    if design is None or source is None or not document.valid or shown.body.rev != document.rev:
        what = "is not the one that is shown"
        raise DesignError("design", what, "wait for its body, or fix the underlined errors")
    result = shown.measured()
    voxels = Setup(result.design, result.mesh).elements
    half = cost_on_voxels(voxels, result.seconds, 0.5)
    # A state that no solver found has no time.
    timed = result.solver["method"] != "none"
    halving, not_halved = _halving(source, design)
    refinable, not_refined = _refinable(design)
    return events.Fineness(
        topology=shown.body.topology,
        voxel_size=design.voxel_size,
        voxels=voxels,
        memory=float(voxels * BYTES_PER_VOXEL),
        seconds=result.seconds if timed else None,
        half_voxels=half.voxels,
        half_memory=float(half.voxels * BYTES_PER_VOXEL),
        half_seconds=half.seconds if timed else None,
        free_memory=float(memory_limit()),
        halving=halving,
        not_halved=not_halved,
        refinable=refinable,
        not_refined=not_refined,
        refinements=len(design.refine),
        refining=_refining(result),
    )


def _refining(result: Result) -> list[events.TextChange]:
    """The change of a text that halves the voxels with most of the error, where that can be."""
    if kind_of(result.design, result.design.solver) not in STATICS:
        return []
    try:
        design = refined(result)
    except DesignError:
        return []
    return [events.TextChange(path=["refine"], value=design.document["refine"])]


def _halving(source: Mapping[str, Any], design: Design) -> tuple[list[events.TextChange], str]:
    try:
        changes = halved(source, design)
    except DesignError as error:
        return [], str(error)
    return [events.TextChange(path=path, value=value) for path, value in changes], ""


def halved(source: Mapping[str, Any], design: Design) -> list[Change]:
    """Return the changes of a text that make the voxels of all its bodies half as large.

    Parameters
    ----------
    source, design
        The document with its formulas, and the design that it is.

    Raises
    ------
    DesignError
        A body is a design of several bodies: their voxels are written in that design. Or the body
        is the mesh of a file.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> halved({"voxel_size": "5 mm"}, families.beam())
    [(['voxel_size'], '2.5 mm')]
    """
    if design.mesh is not None:
        what = f"the body is {design.mesh.label}, whose elements are as they are"
        raise DesignError("mesh", what, "name a finer mesh")
    changes: list[Change] = [(["voxel_size"], _half(source["voxel_size"]))]
    for index, body in enumerate(design.bodies):
        own = body.included
        if own is not None and own.bodies:
            what = "is a design of several bodies, whose voxels are written in that design"
            raise DesignError(f"bodies[{index}]", what, "halve them there")
        size = body.voxel_size
        if size is None and own is not None:
            size = own.voxel_size
        if size is not None:
            written = source["bodies"][index].get("voxel_size", format_quantity(size, "length"))
            changes.append((["bodies", index, "voxel_size"], _half(written)))
    return changes


def _half(written: object) -> object:
    """Half of a length as a design writes it.

    Examples
    --------
    >>> _half("5 mm"), _half("= wall"), _half("= (wall)/2"), _half(0.004)
    ('2.5 mm', '= (wall)/2', '= (wall)/4', 0.002)
    """
    if is_formula(written):
        text = str(written).strip()
        again = _DIVIDED.fullmatch(text)
        if again is not None and "(" not in again["whole"]:
            return f"= ({again['whole']})/{2 * int(again['by'])}"
        return f"= ({text.removeprefix('=').strip()})/2"
    found = _NUMBER_AND_UNIT.fullmatch(str(written))
    if found is None:
        raise DesignError("voxel_size", f"{written!r} is not a number with a unit")
    number, unit = float(found[1]) / 2.0, found[2]
    return number if unit is None else f"{number:.12g} {unit.strip()}"


def _refinable(design: Design) -> tuple[list[str], str]:
    """Parts that local refinement can be asked for, by their names; or why there are none."""
    if kind_of(design, design.solver) not in STATICS:
        return [], "Local refinement is known to statics, and this design is solved otherwise."
    if len(design.parts) < 2:
        return [], "The design has one part: local refinement takes a region of it, in the form."
    done = {refinement.part for refinement in design.refine if refinement.region is None}
    found: list[str] = []
    for part in design.parts:
        soft = isinstance(design.material_of(part), Hyperelastic)
        if part.label and part.label not in {*found, *done} and soft:
            found.append(part.label)
    if not found:
        return [], "No other part with a name is of rubber."
    return found, ""
