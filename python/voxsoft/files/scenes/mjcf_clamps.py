"""Clamps on a prescribed way in MJCF: a rigid body of their vertices, moved by stiff servos."""

from __future__ import annotations

from typing import Final
from xml.etree import ElementTree

import numpy as np

from voxsoft.design import Motion
from voxsoft.files.scenes.mjcf_model import Element, Model, numbers
from voxsoft.materials import Rigid

#: Stiffness of a servo over that of a cube of the body's material as large as the body.
STIFFNESS: Final = 1e3


def add_clamps(model: Model) -> None:
    """Add a body for each clamp that moves vertices, with a servo for each joint of it."""
    setup = model.scene.setup
    design, mesh = setup.design, setup.mesh
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    stiff = STIFFNESS * _young(model) * size
    for index, clamp in enumerate(design.clamps):
        if clamp.motion is None:
            continue
        where = f"clamps[{index}]"
        vertices = np.array([v for v, by in model.moved.items() if by == index], dtype=int)
        if not len(vertices):
            model.lose(f"{where}.motion", "is not held: it does not hold all axes, and stays")
            continue
        turn = clamp.motion.rotation
        center = np.zeros(3) if turn is None else np.array(turn.center)
        body = model.add("worldbody", "body", name=clamp.name or where, pos=numbers(center))
        _add_inertia(model, body, vertices, center)
        _add_joints(model, body, clamp.name or where, clamp.motion, stiff, size)
        model.clamps[index] = body
        model.origins[vertices] = center
        what = "is followed by servos that give way a little, to its final value"
        model.lose(f"{where}.motion", what, "set their controls over time")


def _young(model: Model) -> float:
    """Return the largest Young's modulus of the soft parts [Pa]."""
    design = model.scene.design
    soft = [
        index
        for index, part in enumerate(design.parts)
        if not isinstance(design.material_of(part), Rigid)
    ]
    return max(model.scene.moduli(index)[0] for index in soft)


def _add_inertia(model: Model, body: Element, vertices: np.ndarray, center: np.ndarray) -> None:
    mesh = model.scene.setup.mesh
    masses = model.scene.masses[vertices]
    total = float(masses.sum())
    arms = mesh.vertices[vertices] - center
    middle = masses @ arms / total
    arms = arms - middle
    second = (masses[:, None] * arms).T @ arms
    # Each vertex is a cube of a voxel: a line of them has an inertia about itself, too.
    size = mesh.voxel_size or model.scene.design.voxel_size
    full = (np.trace(second) + total * size**2 / 6.0) * np.eye(3) - second
    rows = full[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
    attributes = {"pos": numbers(middle), "mass": repr(total), "fullinertia": numbers(rows)}
    ElementTree.SubElement(body, "inertial", attributes)


def _add_joints(
    model: Model, body: Element, name: str, motion: Motion, stiff: float, size: float
) -> None:
    """Add a slide joint, then a hinge: the body is turned first, and then displaced."""
    factor = 1.0 if motion.history is None else motion.history.factors[-1]
    way = np.array(motion.displacement)
    length = float(np.linalg.norm(way))
    if length:
        joint = {"name": f"{name}.displacement", "type": "slide", "axis": numbers(way / length)}
        ElementTree.SubElement(body, "joint", joint)
        servo = {"kp": repr(stiff), "dampratio": "1"}
        where = joint["name"]
        model.actuator("position", factor * length, name=where, joint=where, **servo)
    if motion.rotation is not None:
        axis = np.array(motion.rotation.axis) / np.linalg.norm(motion.rotation.axis)
        joint = {"name": f"{name}.rotation", "type": "hinge", "axis": numbers(axis)}
        ElementTree.SubElement(body, "joint", joint)
        servo = {"kp": repr(stiff * size**2), "dampratio": "1"}
        where = joint["name"]
        angle = factor * motion.rotation.angle
        model.actuator("position", angle, name=where, joint=where, **servo)
