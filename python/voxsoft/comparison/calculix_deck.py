"""Input file of CalculiX for a problem on bricks.

Keywords and element names are those of the manual of CalculiX CrunchiX 2.20 (Dhondt,
http://www.dhondt.de); :class:`~voxsoft.comparison.calculix_units.DeckUnits` has the units.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, Literal

import numpy as np

from voxsoft.comparison.bricks import BrickModel, NodeCount
from voxsoft.comparison.calculix_contact import contact_lines, printed_contact, tool_lines
from voxsoft.comparison.calculix_lines import member_lines
from voxsoft.comparison.calculix_units import DeckUnits
from voxsoft.comparison.outside import no_such_material, rubber
from voxsoft.errors import SimulationError
from voxsoft.materials import Material

#: Elements that a comparison may use, and the nodes of each.
Element = Literal["C3D8", "C3D8I", "C3D8R", "C3D20", "C3D20R"]
NODES_OF: Final[dict[Element, NodeCount]] = {
    "C3D8": 8,
    "C3D8I": 8,
    "C3D8R": 8,
    "C3D20": 20,
    "C3D20R": 20,
}

#: First and largest step of the load path with contact, a 24th of it: more at once passes through
#: a surface. Bending under pressure that follows the walls converges linearly, so that increments
#: may take 40 iterations before they are cut.
_CONTACT_STEPS: Final = (
    "0.0416666667, 1.0, 1e-6, 0.0416666667\n"
    "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n40,60,9,120,50,6,,10,,"
)

#: Names of the printed sets: the vertices of the voxel mesh, and the held nodes.
VERTICES, HELD = "VERTICES", "HELD"


def calculix_deck(model: BrickModel, element: Element = "C3D20R") -> str:
    """Write a problem as the text of an input file.

    Parameters
    ----------
    model
        The problem, with as many nodes for each brick as the element has.
    element
        Name of the element. C3D20R neither shear-locks nor volume-locks at ν = 0.49.

    Raises
    ------
    SimulationError
        Bricks that do not fit the element, or a material that CalculiX does not have.

    Examples
    --------
    >>> from voxsoft.comparison.bricks import BrickModel
    >>> from voxsoft.design import families
    >>> from voxsoft.simulation import Setup
    >>> springs = families.beam().with_values("parts.0.material=ecoflex-00-30-lattice")
    >>> calculix_deck(BrickModel.of(Setup.of(springs)))
    Traceback (most recent call last):
    ...
    voxsoft.errors.SimulationError: parts[0].material: CalculiX has no "lattice" material. Try: \
compare a hyperelastic material, such as the neo-Hookean one of the same Young's modulus
    """
    if model.bricks.shape[1] != NODES_OF[element]:
        raise SimulationError(
            "element",
            f"{element} has {NODES_OF[element]} nodes, the bricks {model.bricks.shape[1]}",
        )
    return "\n".join(_lines(model, element)) + "\n"


def _lines(model: BrickModel, element: Element) -> Iterator[str]:
    units = DeckUnits.of(model)
    yield f"** Units: {units.length:.12g} m, {units.stress:.12g} Pa, {units.force:.12g} N"
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate((model.nodes / units.length).tolist(), start=1):
        yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"
    yield f"*ELEMENT, TYPE={element}, ELSET=ALL"
    for number, nodes in enumerate((model.bricks + 1).tolist(), start=1):
        row = [number, *nodes]
        # A line that is continued ends in a comma and holds at most 16 entries.
        for start in range(0, len(row), 15):
            part = ",".join(map(str, row[start : start + 15]))
            yield part + ("," if start + 15 < len(row) else "")
    for number, material in enumerate(model.materials):
        members = np.flatnonzero(model.parts == number)
        if not len(members):
            continue
        yield from member_lines("ELSET", f"PART{number}", members)
        yield f"*MATERIAL, NAME=MATERIAL{number}"
        yield from _material(material, f"parts[{number}].material", units.stress)
        yield f"*DENSITY\n{material.density / units.density:.12g}"
        yield f"*SOLID SECTION, ELSET=PART{number}, MATERIAL=MATERIAL{number}"
    yield from member_lines("NSET", VERTICES, model.vertex_nodes)
    held = np.flatnonzero(model.fixed.any(axis=1))
    yield from member_lines("NSET", HELD, held)
    yield from tool_lines(model, units)
    yield from contact_lines(model)
    yield "*STEP, NLGEOM, INC=1000\n*STATIC"
    yield "0.25, 1.0, 1e-6, 1.0" if model.contact is None else _CONTACT_STEPS
    # Residual and correction a hundred times below CalculiX's defaults: a last Newton step or two.
    yield "*CONTROLS, PARAMETERS=FIELD\n5e-5, 1e-3"
    yield "*BOUNDARY"
    for node, axis in np.argwhere(model.fixed).tolist():
        yield f"{node + 1}, {axis + 1}, {axis + 1}, {model.values[node, axis] / units.length:.12g}"
    yield from _loads(model, units)
    yield f"*NODE PRINT, NSET={VERTICES}\nU\n*NODE PRINT, NSET={HELD}\nRF"
    yield from printed_contact(model, units)
    yield "*END STEP"


def _loads(model: BrickModel, units: DeckUnits) -> Iterator[str]:
    pull = float(np.linalg.norm(model.gravity))
    if pull:
        x, y, z = model.gravity / pull
        yield f"*DLOAD\nALL, GRAV, {pull:.12g}, {x:.12g}, {y:.12g}, {z:.12g}"
    for pressure in model.pressures:
        yield "*DLOAD"
        for brick, face in pressure.faces.tolist():
            yield f"{brick + 1}, P{face + 1}, {pressure.value / units.stress:.12g}"
    loaded = np.argwhere(model.forces)
    if len(loaded):
        yield "*CLOAD"
        for node, axis in loaded.tolist():
            yield f"{node + 1}, {axis + 1}, {model.forces[node, axis] / units.force:.12g}"


Constants = list[float]


def _neo_hookean(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "NEO HOOKE", [values[0] / stress, d1]


def _mooney_rivlin(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "MOONEY-RIVLIN", [values[0] / stress, values[1] / stress, d1]


def _volumetric(d1: float, terms: int) -> Constants:
    """Return D1 and higher terms that are negligible.

    A zero would do in the manual's formula. The program's answer then depends on the units, by 0.4
    % of the displacement of a drawn bar of Yeoh's rubber; these values have no such effect.
    """
    return [d1, *[1e8 * d1] * (terms - 1)]


def _yeoh(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    return "YEOH", [*(value / stress for value in (*values, 0.0, 0.0)[:3]), *_volumetric(d1, 3)]


def _ogden(values: Constants, d1: float, stress: float) -> tuple[str, Constants]:
    terms = len(values) // 2
    pairs = [value / (stress if index % 2 == 0 else 1.0) for index, value in enumerate(values)]
    return f"OGDEN, N={terms}", [*pairs, *_volumetric(d1, terms)]


_KEYWORDS: Final[dict[str, Callable[[Constants, float, float], tuple[str, Constants]]]] = {
    "neo-hookean": _neo_hookean,
    "mooney-rivlin": _mooney_rivlin,
    "yeoh": _yeoh,
    "ogden": _ogden,
}


def _material(material: Material, where: str, stress: float) -> Iterator[str]:
    model, values, bulk = rubber(material, "CalculiX", where)
    if model not in _KEYWORDS:
        raise no_such_material("CalculiX", model, where)
    # U = (J - 1)²/D1 in CalculiX and K/2 (J - 1)² here.
    keyword, constants = _KEYWORDS[model](list(values), 2.0 * stress / bulk, stress)
    yield f"*HYPERELASTIC, {keyword}"
    for start in range(0, len(constants), 8):
        yield ", ".join(f"{value:.12g}" for value in constants[start : start + 8])
