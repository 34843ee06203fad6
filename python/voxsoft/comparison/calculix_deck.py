"""The input file of CalculiX for a problem on bricks.

Units are mm, N, MPa and t, as is custom there; keywords and element names are those of the manual
of CalculiX CrunchiX 2.20 (Dhondt, http://www.dhondt.de).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.bricks import BrickModel, NodeCount
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

#: Names of the printed sets: the vertices of the voxel mesh, and the held nodes.
VERTICES, HELD = "VERTICES", "HELD"

_M, _PA, _KG = 1e3, 1e-6, 1e-3  # to mm, MPa, t
_PER_LINE = 12


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
    yield "*NODE, NSET=ALL"
    for number, (x, y, z) in enumerate((model.nodes * _M).tolist(), start=1):
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
        yield from _set("ELSET", f"PART{number}", members)
        yield f"*MATERIAL, NAME=MATERIAL{number}"
        yield from _material(material, f"parts[{number}].material")
        yield f"*DENSITY\n{material.density * _KG / _M**3:.12g}"
        yield f"*SOLID SECTION, ELSET=PART{number}, MATERIAL=MATERIAL{number}"
    yield from _set("NSET", VERTICES, model.vertex_nodes)
    held = np.flatnonzero(model.fixed.any(axis=1))
    yield from _set("NSET", HELD, held)
    yield "*STEP, NLGEOM, INC=1000\n*STATIC\n0.25, 1.0, 1e-6, 1.0"
    # Residual and correction a hundred times below CalculiX's defaults: a last Newton step or two.
    yield "*CONTROLS, PARAMETERS=FIELD\n5e-5, 1e-3"
    yield "*BOUNDARY"
    for node, axis in np.argwhere(model.fixed).tolist():
        yield f"{node + 1}, {axis + 1}, {axis + 1}, {model.values[node, axis] * _M:.12g}"
    yield from _loads(model)
    yield f"*NODE PRINT, NSET={VERTICES}\nU\n*NODE PRINT, NSET={HELD}\nRF\n*END STEP"


def _loads(model: BrickModel) -> Iterator[str]:
    pull = float(np.linalg.norm(model.gravity))
    if pull:
        x, y, z = model.gravity / pull
        yield f"*DLOAD\nALL, GRAV, {pull * _M:.12g}, {x:.12g}, {y:.12g}, {z:.12g}"
    for pressure in model.pressures:
        yield "*DLOAD"
        for brick, face in pressure.faces.tolist():
            yield f"{brick + 1}, P{face + 1}, {pressure.value * _PA:.12g}"
    loaded = np.argwhere(model.forces)
    if len(loaded):
        yield "*CLOAD"
        for node, axis in loaded.tolist():
            yield f"{node + 1}, {axis + 1}, {model.forces[node, axis]:.12g}"


def _set(kind: str, name: str, members: NDArray[np.integer]) -> Iterator[str]:
    yield f"*{kind}, {kind}={name}"
    numbers = [str(member + 1) for member in members.tolist()]
    for start in range(0, len(numbers), _PER_LINE):
        yield ",".join(numbers[start : start + _PER_LINE])


Constants = list[float]


def _neo_hookean(values: Constants, d1: float) -> tuple[str, Constants]:
    return "NEO HOOKE", [values[0] * _PA, d1]


def _mooney_rivlin(values: Constants, d1: float) -> tuple[str, Constants]:
    return "MOONEY-RIVLIN", [values[0] * _PA, values[1] * _PA, d1]


def _yeoh(values: Constants, d1: float) -> tuple[str, Constants]:
    return "YEOH", [*(value * _PA for value in (*values, 0.0, 0.0)[:3]), d1, 0.0, 0.0]


def _ogden(values: Constants, d1: float) -> tuple[str, Constants]:
    terms = len(values) // 2
    pairs = [value * (_PA if index % 2 == 0 else 1.0) for index, value in enumerate(values)]
    return f"OGDEN, N={terms}", [*pairs, d1, *[0.0] * (terms - 1)]


_KEYWORDS: Final[dict[str, Callable[[Constants, float], tuple[str, Constants]]]] = {
    "neo-hookean": _neo_hookean,
    "mooney-rivlin": _mooney_rivlin,
    "yeoh": _yeoh,
    "ogden": _ogden,
}


def _material(material: Material, where: str) -> Iterator[str]:
    model, values, bulk = rubber(material, "CalculiX", where)
    if model not in _KEYWORDS:
        raise no_such_material("CalculiX", model, where)
    # U = (J - 1)²/D1 in CalculiX and K/2 (J - 1)² here.
    keyword, constants = _KEYWORDS[model](list(values), 2.0 / (bulk * _PA))
    yield f"*HYPERELASTIC, {keyword}"
    for start in range(0, len(constants), 8):
        yield ", ".join(f"{value:.12g}" for value in constants[start : start + 8])
