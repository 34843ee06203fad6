"""Rigid objects and the floor in MJCF, and their contact."""

from __future__ import annotations

from itertools import combinations
from typing import Final
from xml.etree import ElementTree

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from voxsoft.files.scenes.mjcf_bodies import bit_of, friction_attributes
from voxsoft.files.scenes.mjcf_model import Element, Floats, Model, numbers
from voxsoft.simulation.setup.contact import Touching
from voxsoft.simulation.setup.distance import Surface
from voxsoft.simulation.setup.rigid_objects import Solid

#: Part of a volume by which a traced surface may differ from its hull and count as convex.
_CONVEX: Final = 1e-3


def add_objects(model: Model) -> None:
    """Add objects, the floor, and contact between them."""
    touching = model.scene.setup.touching
    floor = model.scene.design.floor
    if touching is not None:
        for index, surface in enumerate(touching.surfaces):
            _add_object(model, touching, index, surface)
        _add_pairs(model, touching)
        _say_contact(model, touching)
    if floor is not None:
        friction = 0.0
        if touching is not None:
            friction = _friction_of(model, touching, len(touching.names) - 1, "floor")
        attributes = {
            "name": "floor",
            "type": "plane",
            "pos": numbers([0.0, 0.0, floor.z]),
            "size": "0 0 1",
            **_masks(model, touching, -1),
            **friction_attributes(friction),
        }
        ElementTree.SubElement(model.section("worldbody"), "geom", attributes)


def _add_object(model: Model, touching: Touching, index: int, surface: Surface) -> None:
    each = model.scene.design.objects[index]
    where = f"objects[{index}]"
    body = model.add("worldbody", "body", name=each.name, pos=numbers(surface.middle))
    solid = touching.solids[index]
    if solid is not None:
        ElementTree.SubElement(body, "freejoint", {"name": each.name})
        _add_inertia(body, solid, surface.middle)
    elif each.way is not None:
        body.set("mocap", "true")
        what = "is not held: it is a mocap body at its first pose, which a program moves"
        model.lose(f"{where}.motion", what)
    corners = surface.vertices - surface.middle
    vertex, face = numbers(corners.ravel()), numbers(surface.triangles.ravel())
    model.add("asset", "mesh", name=each.name, vertex=vertex, face=face)
    number = len(model.scene.bodies) + index
    attributes = {
        "name": each.name,
        "type": "mesh",
        "mesh": each.name,
        "mass": "0",
        **_masks(model, touching, number),
        **friction_attributes(_friction_of(model, touching, number, where)),
    }
    ElementTree.SubElement(body, "geom", attributes)
    model.objects.append(body)
    a, b, c = (corners[surface.triangles[:, corner]] for corner in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
    if ConvexHull(corners).volume > (1.0 + _CONVEX) * volume:
        what = "is not convex: it is drawn as it is, and touches as its convex hull"
        model.lose(f"{where}.shape", what, "make it of several convex objects")


def _add_inertia(body: Element, solid: Solid, middle: Floats) -> None:
    axes = np.array(solid.axes)
    if np.linalg.det(axes) < 0.0:
        axes[2] = -axes[2]
    squares = np.square(solid.radii)
    attributes = {
        "pos": numbers(np.array(solid.center) - middle),
        "quat": numbers(np.roll(Rotation.from_matrix(axes.T).as_quat(), 1)),
        "mass": repr(solid.mass),
        "diaginertia": numbers(solid.mass * (squares.sum() - squares)),
    }
    ElementTree.SubElement(body, "inertial", attributes)


def _masks(model: Model, touching: Touching | None, surface: int) -> dict[str, str]:
    """Return the masks by which a surface touches bodies, and no other surface."""
    bodies, mask = len(model.scene.bodies), 0
    for body in range(bodies):
        if touching is None or not np.isnan(touching.friction[body, surface]):
            mask |= bit_of(body)
    return {"contype": "0", "conaffinity": str(mask), "priority": "1"}


def _friction_of(model: Model, touching: Touching, surface: int, where: str) -> float:
    """Return the friction of a surface with the bodies: that of the first that it touches."""
    row = touching.friction[: len(model.scene.bodies), surface]
    found = np.unique(row[~np.isnan(row)])
    if len(found) > 1:
        what = f"has several coefficients of friction with the bodies, and {found[0]:g} is written"
        model.lose(where, what)
    return float(found[0]) if len(found) else 0.0


def _add_pairs(model: Model, touching: Touching) -> None:
    first = len(model.scene.bodies)
    for a, b in combinations(range(first, len(touching.names)), 2):
        friction = float(touching.friction[a, b])
        if np.isnan(friction):
            continue
        attributes = {"geom1": touching.names[a], "geom2": touching.names[b], "condim": "1"}
        if friction > 0.0:
            attributes |= {"condim": "3", "friction": numbers([friction, friction, 0.0, 0.0, 0.0])}
        model.add("contact", "pair", **attributes)


def _say_contact(model: Model, touching: Touching) -> None:
    what = "is on the faces of whole voxels" if model.scene.setup.mesh.voxel_size else "is soft"
    model.lose("contact", f"{what}; MuJoCo's contact gives way, by its solref and solimp")
    for index, pair in enumerate(touching.contact.pairs):
        if pair.kind == "bonded":
            model.lose(f"contact.pairs[{index}]", "is a bond and is not held: the two touch")
