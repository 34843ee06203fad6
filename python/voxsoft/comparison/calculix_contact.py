"""Contact in CalculiX's input files: surfaces, pairs, and objects as shells that move rigidly.

Surfaces meet face to face with a linear penalty of 500 Young's moduli for each edge of a brick: at
a pressure of a tenth of Young's modulus they are 0.0002 edges in each other. The stick slope is
25 times smaller. There is no stabilization and no adjustment of the unloaded mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.brick_contact import RigidTool
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.calculix_names import DeckNames
from voxsoft.comparison.calculix_units import DeckUnits, softest_young

#: Penalty stiffness, in Young's moduli of the softest part for each edge of a brick.
_SLOPE: Final = 1000.0
#: Depth of the shell of an object behind its surface, as a part of a triangle's size.
_DEPTH: Final = 0.3

#: Names of the surfaces of the body: all of it, and walls that face each other.
_BODY: Final = "BODY"


def wall_names(index: int) -> tuple[str, str]:
    """Names of two walls that face each other."""
    return f"WALL{index}A", f"WALL{index}B"


def tool_lines(model: BrickModel, units: DeckUnits, names: DeckNames) -> Iterator[str]:
    """Write nodes and elements of rigid objects: a tetrahedron behind each triangle.

    All nodes are prescribed, so that their stiffness and density do not count.
    """
    node = len(model.nodes)
    element = len(model.bricks) + sum(len(layer.faces) for layer in model.layers)
    young = softest_young(model) / units.stress
    density = model.materials[0].density / units.density
    for name, tool in zip(names.tools, _tools(model), strict=True):
        nodes, tets = shell_of(tool)
        yield f"*NODE, NSET={name}"
        for number, (x, y, z) in enumerate((nodes / units.length).tolist(), start=node + 1):
            yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"
        yield f"*ELEMENT, TYPE=C3D4, ELSET={name}"
        for number, tet in enumerate((tets + node + 1).tolist(), start=element + 1):
            yield ",".join(map(str, [number, *tet]))
        yield f"*SURFACE, NAME={name}"
        yield from (f"{element + number + 1}, S1" for number in range(len(tets)))
        yield f"*MATERIAL, NAME={name}\n*ELASTIC\n{young:.12g}, 0.3"
        yield f"*DENSITY\n{density:.12g}"
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"
        node, element = node + len(nodes), element + len(tets)


def shell_of(tool: RigidTool) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Nodes in m (n, 3) and tetrahedra (t, 4) of an object; the first face of each is outside."""
    corners = tool.vertices[tool.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    full = sizes > 1e-9 * sizes.max()  # slivers of a traced surface have no volume behind them
    depth = _DEPTH / np.sqrt(sizes[full])
    inner = corners[full].mean(axis=1) - depth[:, None] * normals[full]
    first = len(tool.vertices)
    # The fourth node of a CalculiX tetrahedron lies on the side that the first three face.
    a, b, c = tool.triangles[full].astype(np.int64).T
    tets = np.column_stack([a, c, b, np.arange(first, first + len(inner))])
    return np.concatenate([tool.vertices, inner]), tets


def contact_lines(model: BrickModel, units: DeckUnits, names: DeckNames) -> Iterator[str]:
    """Write surfaces of the body and pairs; nothing where nothing touches."""
    contact = model.contact
    if contact is None:
        return
    slope = _SLOPE * softest_young(model) / model.edge / units.slope
    yield from _surface(_BODY, contact.outer)
    for index, walls in enumerate(contact.walls):
        for name, faces in zip(wall_names(index), walls, strict=True):
            yield from _surface(name, faces)
    pairs = [(*wall_names(index), contact.friction) for index in range(len(contact.walls))]
    pairs += [
        (_BODY, name, tool.friction) for name, tool in zip(names.tools, contact.tools, strict=True)
    ]
    for number, friction in enumerate(sorted({each for _, _, each in pairs})):
        name = f"FRICTION{number}"
        yield f"*SURFACE INTERACTION, NAME={name}"
        yield f"*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{slope:.12g}"
        if friction > 0.0:
            yield f"*FRICTION\n{friction:.12g}, {slope / 25:.12g}"
        for slave, master, own in pairs:
            if own == friction:
                yield f"*CONTACT PAIR, INTERACTION={name}, TYPE=SURFACE TO SURFACE"
                yield f"{slave}, {master}"


def printed_contact(model: BrickModel, names: DeckNames) -> Iterator[str]:
    """Write the request for the forces that hold the objects, and between all walls."""
    if model.contact is None:
        return
    for name in names.tools:
        yield f"*NODE PRINT, NSET={name}, TOTALS=ONLY\nRF"
    for index in range(len(model.contact.walls)):
        slave, master = wall_names(index)
        yield f"*CONTACT PRINT, SLAVE={slave}, MASTER={master}\nCF"


def _tools(model: BrickModel) -> tuple[RigidTool, ...]:
    return () if model.contact is None else model.contact.tools


def _surface(name: str, faces: NDArray[np.int64]) -> Iterator[str]:
    yield f"*SURFACE, NAME={name}"
    yield from (f"{brick + 1}, S{face + 1}" for brick, face in faces.tolist())
