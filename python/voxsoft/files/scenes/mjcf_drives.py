"""Drives in MJCF: loads and tendons as actuators, springs as tendons, probes as sensors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core_data
from voxsoft.cavity import MeshCavity
from voxsoft.design import Spring
from voxsoft.design.attachment import PlaceOnBody, attachments_of
from voxsoft.files.scenes.mjcf_model import Element, Floats, Model, numbers
from voxsoft.simulation.loads import LoadReceiver
from voxsoft.simulation.loads.actions import DepthPressure
from voxsoft.simulation.setup.tendons import STIFF, Place, ResolvedTendon

#: Bound of a force that cannot push [N]: MuJoCo takes no infinity.
_ENDLESS: Final = "-1e9 0"
_DEAD: Final = (
    "is a generalized force on the unloaded surface: MuJoCo has no pressure, so that "
    "neither its direction nor its area follows the deformation"
)


def add_loads(model: Model) -> None:
    """Add gravity, and an actuator for each other load."""
    for index, load in enumerate(model.scene.setup.loads):
        where = f"loads[{index}]"
        factor = load.reading.final_factor
        taken = _Loads(model)
        for action in load.actions:
            action.give_to(taken)
        if load.reading.history is not None:
            what = "is not held: the file has its final value"
            model.lose(f"{where}.history", what, "set gravity and controls over time")
        if taken.areas.any() and model.linear(where, taken.areas):
            # The length of this tendon is the change of the volume, to first order.
            final, size = factor * taken.value, {"input": "pressure", "gainprm": "1"}
            model.actuator("general", final, name=where, tendon=where, **size)
            faces = np.concatenate(taken.faces).ravel().tolist()
            name = f"{where}.triangles"
            model.add("custom", "numeric", name=name, size=str(len(faces)), data=numbers(faces))
            model.lose(where, _DEAD, f'give it by a program from "{name}", as the guide does')
        if taken.dead.any() and model.linear(where, taken.dead):
            model.actuator("motor", factor, name=where, tendon=where)
        if taken.follows:
            model.lose(where, "is held as its forces on the unloaded body, which do not follow it")


class _Loads(LoadReceiver):
    """Receiver of one load, on the vertices of the unloaded body.

    Attributes
    ----------
    dead
        Dead forces on the vertices, (n, 3), N.
    value, areas
        Pressure [Pa], and its force on each vertex for 1 Pa, (n, 3), m².
    faces
        Triangles under it, each face of a voxel along both of its diagonals.
    follows
        True if the dead forces are those of a load that follows the body.
    """

    def __init__(self, model: Model) -> None:
        super().__init__(model.scene.setup.mesh)
        self._split = model.scene.setup.other_split
        self.dead = np.zeros_like(self.mesh.vertices)
        self.value = 0.0
        self.areas = np.zeros_like(self.mesh.vertices)
        self.faces: list[NDArray[np.int32]] = []
        self.follows = False

    def acceleration(self, acceleration: Floats) -> None:
        """Leave it to the gravity of the scene."""

    def pressure(
        self, triangles: NDArray[np.int32], value: float, cavity: MeshCavity | None
    ) -> None:
        self.value = value
        surfaces = [triangles, self._split.triangles(triangles)]
        if cavity is not None:
            surfaces = [found for found, _ in cavity.splits]
            self._add_voids(cavity)
        self.faces += surfaces * (2 // len(surfaces))
        points = self.mesh.vertices
        for found in surfaces:
            a, b, c = points[found].transpose(1, 0, 2)
            thirds = np.cross(b - a, c - a) / (-6.0 * len(surfaces))
            for corner in range(3):
                np.add.at(self.areas, found[:, corner], thirds)

    def _add_voids(self, cavity: MeshCavity) -> None:
        """Add the slopes of the volumes that a cavity has beyond its triangles."""
        a, b, c, d = self.mesh.vertices[cavity.void_tets].transpose(1, 0, 2)
        slopes = np.stack(
            [
                np.cross(d - b, c - b),
                np.cross(c - a, d - a),
                np.cross(d - a, b - a),
                np.cross(b - a, c - a),
            ],
            axis=1,
        )
        factors = cavity.void_parts[:, None, None] / 6.0
        np.add.at(self.areas, cavity.void_tets, factors * slopes)

    def forces(self, vertices: NDArray[np.uint32], forces: Floats) -> None:
        np.add.at(self.dead, vertices, forces)

    def depth_pressure(self, volume: DepthPressure) -> None:
        super().depth_pressure(volume)
        self.follows = True

    def traction(self, triangles: NDArray[np.int32], stress: Floats) -> None:
        both = np.concatenate([triangles, self._split.triangles(triangles)])
        super().traction(both, 0.5 * stress)


def add_tendons(model: Model) -> None:
    """Add a spatial tendon with its actuator for each tendon of the design."""
    for index, tendon in enumerate(model.scene.setup.tendons):
        where = f"tendons[{index}]"
        sites = [
            _site(model, f"{tendon.name}/{number}", place, point)
            for number, (place, point) in enumerate(zip(tendon.places, tendon.points, strict=True))
        ]
        _spatial(model, tendon.name, sites)
        _add_pull(model, tendon)
        what = "is guided by the vertices nearest to it: its forces are not spread over a voxel"
        model.lose(where, what)
        if tendon.tendon.friction:
            model.lose(f"{where}.friction", "is not held: MuJoCo's tendons slide freely")
        if tendon.history is not None:
            what = "is not held: the file has its final value"
            model.lose(f"{where}.history", what, "set its control over time")


def _add_pull(model: Model, tendon: ResolvedTendon) -> None:
    final = tendon.final_factor * tendon.size
    if tendon.tendon.drive == "tension":
        # A force along a tendon pushes its ends apart.
        model.actuator("motor", final, name=tendon.name, tendon=tendon.name, gear="-1")
        return
    length = tendon.length - final
    stiffness = (tendon.tendon.stiffness or STIFF) / length
    attributes = {"kp": repr(stiffness), "forcerange": _ENDLESS}
    model.actuator("position", length, name=tendon.name, tendon=tendon.name, **attributes)


def add_springs(model: Model) -> None:
    """Add a spatial tendon with a stiffness for each spring of the design."""
    setup = model.scene.setup
    for where, attachment in attachments_of(setup.design):
        if not isinstance(attachment, Spring):
            model.lose(where, "is not held: MJCF has no such element")
            continue
        sites, ends = [], []
        name = attachment.name or where
        for number, end in enumerate((attachment.at, attachment.to)):
            if end is None:
                point = np.array(attachment.anchor)
                place: Place = {"vertices": [], "weights": [], "offset": point.tolist()}
            else:
                found = setup.place(end, where)
                place, point = _place(found), setup.position(found)
            ends.append(point)
            sites.append(_site(model, f"{name}/{number}", place, point))
        length = attachment.length
        rest = float(np.linalg.norm(ends[1] - ends[0])) if length is None else length
        tendon = _spatial(model, name, sites)
        tendon.attrib |= {"stiffness": repr(attachment.stiffness), "springlength": repr(rest)}
        model.lose(where, "pulls at the vertices nearest to its ends")


def _place(found: PlaceOnBody) -> _core_data.BodyPlace:
    vertices, weights = found.vertices.tolist(), found.weights.tolist()
    return {"vertices": vertices, "weights": weights, "offset": [0.0, 0.0, 0.0]}


def add_probes(model: Model) -> None:
    """Add sensors of the displacement of each probe, by its name and the axis."""
    for name, place in model.scene.setup.places.items():
        if not model.moved.keys().isdisjoint(place.vertices.tolist()):
            model.lose(f"probes.{name}", "is not held: a moved clamp carries it")
            continue
        for axis in range(3):
            slopes = np.zeros_like(model.scene.setup.mesh.vertices)
            np.add.at(slopes[:, axis], place.vertices, place.weights)
            along = f"{name}.{'xyz'[axis]}"
            if model.linear(along, slopes):
                model.add("sensor", "tendonpos", name=along, tendon=along)


def _spatial(model: Model, name: str, sites: Sequence[str]) -> Element:
    tendon = model.add("tendon", "spatial", name=name)
    for site in sites:
        ElementTree.SubElement(tendon, "site", {"site": site})
    return tendon


def _site(model: Model, name: str, place: Place, point: Floats) -> str:
    """Add a site at a point of the unloaded design: to an object, to the world, or to a vertex."""
    setup = model.scene.setup
    if "object" in place:
        assert setup.touching is not None  # objects have contact
        parent = model.objects[place["object"]]
        at = np.array(place["point"]) - setup.touching.surfaces[place["object"]].middle
    elif place["vertices"]:
        nearest = place["vertices"][int(np.argmax(place["weights"]))]
        parent, at = model.vertices[nearest], point - model.origins[nearest]
    else:
        parent, at = model.section("worldbody"), np.array(place["offset"])
    ElementTree.SubElement(parent, "site", {"name": name, "pos": numbers(at)})
    return name
