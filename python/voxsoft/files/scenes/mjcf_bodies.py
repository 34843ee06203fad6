"""Bodies in MJCF: a body for each vertex, and flexes of tetrahedra between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final
from xml.etree import ElementTree

import numpy as np

from voxsoft.files.scenes.mjcf_model import Element, Ints, Model, joint_name, numbers, vertex_name
from voxsoft.materials import Hyperelastic
from voxsoft.mesh import BodyMesh

#: Largest Poisson's ratio that is written. Elements of fully integrated volume lock above, and the
#: steps of MuJoCo 4.0 are not solved: a beam of tetrahedra of 0.499 was seen to come to rest with
#: 0.65 to 1.6 times the deflection that they have in equilibrium, as its time step was.
POISSON: Final = 0.45
#: Classes of the part of a cut voxel that is filled: the moduli of each are those of its mean.
LEVELS: Final = 8
#: Difference of a filled part from all of a voxel that is rounding.
_ROUNDING: Final = 1e-9
#: Rayleigh damping [s] where the design gives none. It changes no state of rest.
DAMPING: Final = 0.02
#: Inertia above the least that MuJoCo takes, 1e-15 [kg m²].
LEAST_INERTIA: Final = 1e-12


@dataclass(frozen=True)
class _Block:
    """Tetrahedra of one part that are filled alike; those of whole voxels where they are bricks."""

    name: str
    part: int
    filled: float
    tets: Ints
    is_cells: bool


def add_vertices(model: Model) -> None:
    """Add a body for each vertex: its mass, and a slide joint along each axis that is free."""
    setup = model.scene.setup
    world = model.section("worldbody")
    size = setup.mesh.voxel_size or setup.design.voxel_size
    for index, (place, mass) in enumerate(
        zip(setup.mesh.vertices, model.scene.masses.tolist(), strict=True)
    ):
        if index in model.moved:
            model.vertices.append(model.clamps[model.moved[index]])
            continue
        body = ElementTree.SubElement(
            world, "body", {"name": vertex_name(index), "pos": numbers(place)}
        )
        # It never turns, so that its inertia, that of a cube of a voxel, has no effect.
        inertia = numbers([max(mass * size**2 / 6.0, LEAST_INERTIA)] * 3)
        attributes = {"pos": "0 0 0", "mass": repr(mass), "diaginertia": inertia}
        ElementTree.SubElement(body, "inertial", attributes)
        for axis in np.flatnonzero(~model.held[index]).tolist():
            attributes = {
                "name": joint_name(index, axis),
                "type": "slide",
                "axis": numbers(np.eye(3, dtype=int)[axis]),
            }
            ElementTree.SubElement(body, "joint", attributes)
        model.vertices.append(body)
    if setup.design.solver.damping is not None:
        what = "is not held: MuJoCo refuses damping of the joints of vertices"
        model.lose("solver.damping", what, "give a retardation, which a flex has")


def add_flexes(model: Model) -> None:
    """Add the flexes of all bodies, and say which of their laws MuJoCo does not have."""
    for number, (name, body) in enumerate(model.scene.bodies):
        blocks = list(_blocks(model, body))
        flexes = [_flex(model, each.name, body, each) for each in blocks]
        for flex, block in zip(flexes, blocks, strict=True):
            _add_elasticity(model, flex, block)
        if len(flexes) == 1:
            flexes[0].set("name", name)
            _add_contact(model, flexes[0], number)
            continue
        for flex in flexes:
            ElementTree.SubElement(flex, "contact", _NO_CONTACT)
        if _collides(model, number):
            # Flexes of one body share vertices and must not touch each other: one around them does.
            first, count = body.first_tet, len(body.mesh.tets)
            every = _Block(name, 0, 1.0, np.arange(first, first + count), False)
            around = _flex(model, name, body, every)
            _add_contact(model, around, number)
    _say_laws(model)


def add_layers(model: Model) -> None:
    """Add a flex of triangles for each layer."""
    setup = model.scene.setup
    for index, (layer, found) in enumerate(zip(setup.design.layers, setup.layers, strict=True)):
        where = f"layers[{index}]"
        flex = model.add(
            "deformable",
            "flex",
            name=layer.name or where,
            dim="2",
            radius=repr(layer.thickness / 2.0),
            **_nodes(model, found.all),
        )
        attributes = {
            "young": repr(layer.young),
            "poisson": repr(min(max(layer.poisson, 0.0), POISSON)),
            "thickness": repr(layer.thickness),
            "damping": repr(_damping(model)),
            "elastic2d": "stretch",
        }
        ElementTree.SubElement(flex, "elasticity", attributes)
        ElementTree.SubElement(flex, "contact", _NO_CONTACT)
        model.lose(where, "has its full stiffness where it is compressed: it does not wrinkle")


_NO_CONTACT: Final = {"contype": "0", "conaffinity": "0", "selfcollide": "none"}


def bit_of(body: int) -> int:
    """Return the bit of a body in the masks of contact, of which MuJoCo has 31."""
    return 1 << min(body, 30)


def _blocks(model: Model, body: BodyMesh) -> Iterator[_Block]:
    mesh = model.scene.setup.mesh
    tets = np.arange(body.first_tet, body.first_tet + len(body.mesh.tets))
    filled = np.ones(len(tets))
    if mesh.fractions is not None and mesh.tet_voxel is not None:
        filled = mesh.fractions[mesh.tet_voxel[tets]]
    is_full = np.abs(filled - 1.0) < _ROUNDING
    level = np.where(is_full, -1, np.floor(filled * LEVELS)).astype(int)
    for part in np.unique(mesh.tet_part[tets]).tolist():
        own = mesh.tet_part[tets] == part
        for each in np.unique(level[own]).tolist():
            chosen = own & (level == each)
            name = model.scene.part_names[part - 1]
            if each >= 0:
                name = f"{name}, {each}/{LEVELS} to {each + 1}/{LEVELS} filled"
            yield _Block(
                name,
                part - 1,
                float(filled[chosen].mean()),
                tets[chosen],
                _is_cells(model, body, part - 1),
            )


def _is_cells(model: Model, body: BodyMesh, part: int) -> bool:
    """Check if the voxels of a part are bricks along the axes, and not springs."""
    soft = isinstance(model.scene.setup.materials[part], Hyperelastic)
    return soft and body.mesh.voxel_size is not None and body.is_along_axes


def _flex(model: Model, name: str, body: BodyMesh, block: _Block) -> Element:
    corners = model.scene.setup.mesh.tets[block.tets]
    nodes = _cells(model, body, corners) if block.is_cells else _nodes(model, corners)
    return model.add("deformable", "flex", name=name, dim="3", radius="0", **nodes)


def _cells(model: Model, body: BodyMesh, corners: Ints) -> dict[str, str]:
    """Return the voxels of a flex as the filled cells of a box of cells.

    Nodes of the box that no voxel has are points of the world: no stiffness reaches them.
    """
    mesh, size = model.scene.setup.mesh, body.mesh.voxel_size
    assert size is not None  # the voxels are bricks
    used, own = np.unique(corners, return_inverse=True)
    places = body.mesh.vertices[used - body.first_vertex]
    first = places.min(axis=0)
    cells = np.rint((places - first) / size).astype(int)
    shape = cells.max(axis=0) + 1
    grid = np.full(shape, -1)
    grid[tuple(cells.T)] = used
    nodes = grid.ravel()
    is_vertex = nodes >= 0
    corner = np.stack(np.unravel_index(np.arange(len(nodes)), shape), axis=1)
    local = body.placed(first + corner * size)
    local[is_vertex] = mesh.vertices[nodes[is_vertex]] - model.origins[nodes[is_vertex]]
    names = ("world" if v < 0 else model.vertices[v].attrib["name"] for v in nodes.tolist())
    return {
        "dof": "trilinear",
        "cellcount": numbers(shape - 1),
        "node": " ".join(names),
        "nodecoord": numbers(local.ravel()),
        "body": " ".join(["world"] * len(used)),
        "vertex": numbers(mesh.vertices[used].ravel()),
        "element": numbers(own.ravel()),
    }


def _nodes(model: Model, corners: Ints) -> dict[str, str]:
    """Return the vertices of a flex, and the corners of its elements among them."""
    used, own = np.unique(corners, return_inverse=True)
    bodies = " ".join(model.vertices[index].attrib["name"] for index in used.tolist())
    found = {"body": bodies, "element": numbers(own.ravel())}
    local = model.scene.setup.mesh.vertices[used] - model.origins[used]
    return {**found, "vertex": numbers(local.ravel())} if local.any() else found


def _damping(model: Model) -> float:
    given = model.scene.design.solver.retardation
    return DAMPING if given is None else given


def _add_elasticity(model: Model, flex: Element, block: _Block) -> None:
    young, poisson = model.scene.moduli(block.part)
    attributes = {
        "young": repr(young * block.filled),
        "poisson": repr(min(max(poisson, 0.0), POISSON)),
        "damping": repr(_damping(model)),
    }
    ElementTree.SubElement(flex, "elasticity", attributes)


def _say_laws(model: Model) -> None:
    scene = model.scene
    for index, material in enumerate(scene.setup.materials):
        where = f"parts[{index}].material"
        bricks = any(_is_cells(model, body, index) for _, body in scene.bodies)
        law = "linear in a frame that turns with each voxel" if bricks else "St Venant-Kirchhoff"
        kind = "full bricks" if bricks else "linear tetrahedra"
        what = f'"{material.model}" is written by its moduli at small strain, {law}, on {kind}'
        hint = "refine: halved voxels quarter what these elements add in bending"
        model.lose(where, what, hint)
        _, poisson = scene.moduli(index)
        if not 0.0 <= poisson <= POISSON:
            least = min(max(poisson, 0.0), POISSON)
            what = f"has Poisson's ratio {poisson:.4g}, written as {least:g}"
            model.lose(where, f"{what}: beyond it these elements lock, and MuJoCo's steps fail")
    if scene.setup.mesh.fractions is not None:
        what = "has whole voxels where the surface cuts them, as stiff as the part that is filled"
        model.lose("fill", f"{what}, in {LEVELS} classes; masses are those of VoxSoft")


def _collides(model: Model, body: int) -> bool:
    touching = model.scene.setup.touching
    if touching is None:
        return model.scene.design.floor is not None
    return not bool(np.isnan(touching.friction[body]).all())


def _add_contact(model: Model, flex: Element, body: int) -> None:
    if not _collides(model, body):
        ElementTree.SubElement(flex, "contact", _NO_CONTACT)
        return
    touching = model.scene.setup.touching
    own, others = float("nan"), 0
    if touching is not None:
        row = touching.friction[body][: len(model.scene.bodies)]
        own = float(row[body])
        for other, value in enumerate(row.tolist()):
            if other != body and not np.isnan(value):
                others |= bit_of(other)
    friction = 0.0 if np.isnan(own) else own
    attributes = {
        "contype": str(bit_of(body)),
        "conaffinity": str(others),
        "selfcollide": "none" if np.isnan(own) else "auto",
        **friction_attributes(friction),
    }
    ElementTree.SubElement(flex, "contact", attributes)


def friction_attributes(coefficient: float) -> dict[str, str]:
    """Return the attributes of Coulomb friction, without torsion and rolling."""
    if coefficient == 0.0:
        return {"condim": "1"}
    return {"condim": "3", "friction": numbers([coefficient, 0.0, 0.0])}
