"""Description and actions of each kind of load: the registry of all kinds."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from voxsoft import _core
from voxsoft.design import (
    Drag,
    Force,
    ForceField,
    Gravity,
    Immersion,
    MagneticField,
    Pressure,
    Traction,
)
from voxsoft.design.chamber import chosen_cavities
from voxsoft.errors import DesignError
from voxsoft.simulation.loads.actions import (
    Acceleration,
    Action,
    DepthPressure,
    FieldAcceleration,
    FieldForces,
    SharedForce,
    SurfaceDrag,
    SurfacePressure,
    SurfaceTraction,
    Triangles,
)
from voxsoft.simulation.loads.immersion import filled_parts, other_tets
from voxsoft.simulation.loads.kind import LoadedBody, LoadKind, LoadReading
from voxsoft.simulation.loads.magnets import magnet_forces
from voxsoft.units import format_quantity


class GravityKind(LoadKind[Gravity]):
    """Gravity: an acceleration of the whole body."""

    def read(self, load: Gravity) -> LoadReading:
        """Describe the load."""
        return LoadReading(
            load.kind, "gravity", "acceleration", (load.value,), load.direction, load.history
        )

    def actions(self, load: Gravity, body: LoadedBody, where: str) -> list[Acceleration]:
        """Return the actions of the load."""
        down = np.asarray(load.direction) / np.linalg.norm(load.direction)
        return [Acceleration(load.value, down)]


class PressureKind(LoadKind[Pressure]):
    """Pressure in cavities: one action for each."""

    def read(self, load: Pressure) -> LoadReading:
        """Describe the load."""
        return LoadReading(
            load.kind,
            f"pressure in {_named(load.cavity)}",
            "pressure",
            (load.value,),
            (0.0, 0.0, 0.0),
            load.history,
            load.cavity,
        )

    def actions(self, load: Pressure, body: LoadedBody, where: str) -> list[SurfacePressure]:
        """Return the actions of the load."""
        cavities = body.mesh.cavities
        chosen = chosen_cavities(load.cavity, body.mesh, f"{where}.cavity")
        return [SurfacePressure(cavities[i].triangles, load.value, cavities[i]) for i in chosen]


def _named(choice: str | int) -> str:
    if choice == "all":
        return "all cavities"
    return f"cavity {choice}" if isinstance(choice, int) else f"chamber {choice}"


class ForceKind(LoadKind[Force]):
    """Force that the vertices of a region share."""

    def read(self, load: Force) -> LoadReading:
        """Describe the load."""
        return LoadReading(load.kind, "force", "force", load.value, load.value, load.history)

    def actions(self, load: Force, body: LoadedBody, where: str) -> list[SharedForce]:
        """Return the actions of the load."""
        return [SharedForce(body.vertices_in(load.region, where), np.asarray(load.value))]


class TractionKind(LoadKind[Traction]):
    """Traction on a surface: one number is a pressure, three are a dead load."""

    def read(self, load: Traction) -> LoadReading:
        """Describe the load."""
        if isinstance(load.value, float):
            label, components, direction = "pressure on a surface", (load.value,), (0.0, 0.0, 0.0)
            return LoadReading(load.kind, label, "pressure", components, direction, load.history)
        return LoadReading(load.kind, "traction", "pressure", load.value, load.value, load.history)

    def actions(self, load: Traction, body: LoadedBody, where: str) -> list[Action]:
        """Return the actions of the load."""
        triangles = _triangles(load, body, where)
        if isinstance(load.value, float):
            return [SurfacePressure(triangles, load.value)]
        return [SurfaceTraction(triangles, np.asarray(load.value))]


def _triangles(load: Traction, body: LoadedBody, where: str) -> Triangles:
    """Triangles of the surface with all three vertices in the region, (t, 3)."""
    inside = np.zeros(len(body.mesh.vertices), dtype=bool)
    inside[body.vertices_in(load.region, where)] = True
    triangles = body.mesh.triangles[inside[body.mesh.triangles].all(axis=1)]
    if len(triangles) == 0:
        raise DesignError(where, "the region holds no triangle of the surface")
    return triangles


class MagneticFieldKind(LoadKind[MagneticField]):
    """Magnetic field: dead forces on parts with a remanence."""

    def read(self, load: MagneticField) -> LoadReading:
        """Describe the load."""
        return LoadReading(
            load.kind, "magnetic field", "magnetic field", load.value, load.value, load.history
        )

    def actions(self, load: MagneticField, body: LoadedBody, where: str) -> list[Action]:
        """Return the actions of the load."""
        field = np.asarray(load.value)
        vertices, forces = magnet_forces(body.design, body.mesh, field, where)
        return [FieldForces(vertices, forces, field=field)]


class ImmersionKind(LoadKind[Immersion]):
    """Immersion in a liquid: a pressure that grows with depth, on all that displaces it."""

    def read(self, load: Immersion) -> LoadReading:
        """Describe the load."""
        return LoadReading(
            load.kind, "immersion", "density", (load.value,), (0.0, 0.0, 1.0), load.history
        )

    def actions(self, load: Immersion, body: LoadedBody, where: str) -> list[DepthPressure]:
        """Return the actions of the load."""
        mesh = body.mesh
        height = float(mesh.vertices[:, 2].max()) - load.level
        if height > 1e-9 * float(np.ptp(mesh.vertices[:, 2])):
            shown = format_quantity(float(f"{height:.3g}"), "length")
            what = f"is {shown} below the highest voxels, and only bodies wholly in it are known"
            raise DesignError(f"{where}.level", what, "raise the level, or move the body down")
        # Half of it on each of the two splits of a voxel: its faces are bilinear, and the mean of
        # both loads the corners of a face alike.
        slope, filled = load.value * load.gravity / 2.0, filled_parts(mesh)
        return [
            DepthPressure(
                np.concatenate([_NO_TRIANGLE, *(each.splits[-which][0] for each in mesh.cavities)]),
                np.concatenate([tets, *(cavity.void_tets for cavity in mesh.cavities)]),
                np.concatenate([filled, *(cavity.void_parts for cavity in mesh.cavities)]),
                slope,
                load.level,
            )
            for which, tets in enumerate((mesh.tets, other_tets(body.design, mesh)))
        ]


_NO_TRIANGLE: Final[Triangles] = np.zeros((0, 3), dtype=np.int32)


class DragKind(LoadKind[Drag]):
    """Drag of a fluid on the outer surface: one action for each body."""

    def read(self, load: Drag) -> LoadReading:
        """Describe the load."""
        return LoadReading(load.kind, "drag", "density", (load.value,), load.flow, load.history)

    def actions(self, load: Drag, body: LoadedBody, where: str) -> list[SurfaceDrag]:
        """Return the actions of the load."""
        law = (load.value, load.normal, load.tangential, load.linear)
        return [SurfaceDrag(each, *law, np.asarray(load.flow)) for each in body.outer_surfaces]


class ForceFieldKind(LoadKind[ForceField]):
    """Field of force: an acceleration by formulas."""

    def read(self, load: ForceField) -> LoadReading:
        """Describe the load."""
        varies = any("t" in _core.Formula(text).variables for text in load.acceleration)
        return LoadReading(
            load.kind,
            "force field",
            "number",
            (load.value,),
            (0.0, 0.0, 0.0),
            load.history,
            varies=varies,
        )

    def actions(self, load: ForceField, body: LoadedBody, where: str) -> list[FieldAcceleration]:
        """Return the actions of the load."""
        x, y, z = (_core.Formula(text) for text in load.acceleration)
        field, points = FieldAcceleration(load.value, (x, y, z)), body.mesh.vertices
        if found := field.undefined(points):
            axis, vertex = found
            first = ", ".join(f"{1e3 * c:.4g}" for c in points[vertex])
            what = f"has no finite value at ({first}) mm, for the body at rest and t = 0"
            hint = "add a small number to what it divides by, or keep it where it has a value"
            raise DesignError(f"{where}.acceleration[{axis}]", what, hint)
        return [field]


#: Kind of load of each model.
KINDS: Final[Mapping[type[object], LoadKind[Any]]] = MappingProxyType(
    {
        Gravity: GravityKind(),
        Pressure: PressureKind(),
        Force: ForceKind(),
        Traction: TractionKind(),
        MagneticField: MagneticFieldKind(),
        Immersion: ImmersionKind(),
        Drag: DragKind(),
        ForceField: ForceFieldKind(),
    }
)
