"""Actions of loads on a mesh, and their receivers: the core, outside codes, pictures.

Every load is made of these actions. A receiver must take three of them, accelerations, pressures
and forces on vertices; it may override how forces on regions and surfaces are shared.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.cavity import MeshCavity
from voxsoft.mesh import Mesh
from voxsoft.simulation.loads.surface import OuterSurface

Floats = NDArray[np.float64]
Vertices = NDArray[np.uint32]
Triangles = NDArray[np.int32]

_NOWHERE = (0.0, 0.0, 0.0)


class LoadReceiver(ABC):
    """Receiver of the actions of loads on a mesh; all values are those at a load factor of 1."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh

    @abstractmethod
    def acceleration(self, acceleration: Floats) -> None:
        """Take an acceleration of the whole body, (3,), m/s²."""

    @abstractmethod
    def pressure(self, triangles: Triangles, value: float, cavity: MeshCavity | None) -> None:
        """Take a pressure in Pa that follows triangles (t, 3), those of a cavity if given."""

    @abstractmethod
    def forces(self, vertices: Vertices, forces: Floats) -> None:
        """Take dead forces on vertices, (v, 3), N."""

    def shared_force(self, vertices: Vertices, total: Floats) -> None:
        """Take a dead force, (3,), N, that vertices share evenly."""
        self.forces(vertices, np.tile(total / len(vertices), (len(vertices), 1)))

    def depth_pressure(self, volume: DepthPressure) -> None:
        """Take a pressure that grows with depth; by default as forces on the unloaded body."""
        forces = volume.forces(self.mesh.vertices)
        loaded = np.flatnonzero(forces.any(axis=1)).astype(np.uint32)
        self.forces(loaded, forces[loaded])

    def drag(self, drag: SurfaceDrag) -> None:  # noqa: B027 - few receivers know velocities
        """Take the drag of a fluid; by default none, as of a body at rest in a fluid at rest."""

    def field(self, field: FieldAcceleration) -> None:  # noqa: B027 - few receivers know any
        """Take an acceleration by formulas; by default none."""

    def traction(self, triangles: Triangles, stress: Floats) -> None:
        """Take a dead force for each undeformed area of triangles, (3,), Pa."""
        a, b, c = self.mesh.vertices[triangles].transpose(1, 0, 2)
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
        forces = np.zeros_like(self.mesh.vertices)
        for corner in range(3):
            np.add.at(forces, triangles[:, corner], np.outer(areas / 3.0, stress))
        loaded = np.unique(triangles).astype(np.uint32)
        self.forces(loaded, forces[loaded])


class Action(ABC):
    """One action of a load; the core counts each as a load of its own."""

    @abstractmethod
    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""

    @abstractmethod
    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return its arrow on vertices (n, 3), m: position and direction, zero for none."""

    def undefined(self, points: Floats) -> tuple[int, int] | None:
        """Find a component without a finite value on points at rest, (n, 3), m.

        Returns
        -------
        tuple or None
            The component, 0 to 2, and the index of the point.
        """
        return None


@dataclass(frozen=True, eq=False)
class Acceleration(Action):
    """An acceleration of the whole body in m/s² along a direction of length 1, (3,)."""

    value: float
    direction: Floats

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.acceleration(self.value * self.direction)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the point where a line along it through the body's middle enters the bounds.

        An arrow that ends there stands outside of the body: in its middle the head would be hidden.
        """
        return _into_bounds(rest, self.direction)


@dataclass(frozen=True, eq=False)
class SurfacePressure(Action):
    """A pressure in Pa that follows triangles, (t, 3): those of a cavity, if one is given."""

    triangles: Triangles = field(repr=False)
    value: float
    cavity: MeshCavity | None = None

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.pressure(self.triangles, self.value, self.cavity)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the middle of the surface and the inward direction, zero for a cavity."""
        a, b, c = rest[self.triangles].transpose(1, 0, 2)
        inward = -np.cross(b - a, c - a).sum(axis=0)
        direction = _unit(inward) if self.cavity is None else np.array(_NOWHERE)
        return rest[np.unique(self.triangles)].mean(axis=0), direction


@dataclass(frozen=True, eq=False)
class SurfaceTraction(Action):
    """A dead force for each undeformed area of triangles, (3,), Pa."""

    triangles: Triangles = field(repr=False)
    value: Floats

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.traction(self.triangles, self.value)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the middle of the surface and the direction of the traction."""
        return rest[np.unique(self.triangles)].mean(axis=0), _unit(self.value)


@dataclass(frozen=True, eq=False)
class SharedForce(Action):
    """A dead force, (3,), N, that vertices share evenly."""

    vertices: Vertices = field(repr=False)
    value: Floats

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.shared_force(self.vertices, self.value)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the middle of the vertices and the direction of the force."""
        return rest[self.vertices].mean(axis=0), _unit(self.value)


@dataclass(frozen=True, eq=False)
class VertexForces(Action):
    """Dead forces, (v, 3), N, one on each of some vertices."""

    vertices: Vertices = field(repr=False)
    value: Floats = field(repr=False)

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.forces(self.vertices, self.value)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the middle of the vertices and the direction of the total force."""
        return rest[self.vertices].mean(axis=0), _unit(self.value.sum(axis=0))


@dataclass(frozen=True, eq=False)
class FieldForces(VertexForces):
    """Dead forces on vertices by a field, (3,)."""

    field: Floats = field(kw_only=True)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the point where a line along the field through the middle enters the bounds."""
        return _into_bounds(rest, _unit(self.field))


@dataclass(frozen=True, eq=False)
class DepthPressure(Action):
    """A pressure that grows with depth around all that displaces a liquid, and follows it.

    Attributes
    ----------
    triangles
        Walls of closed cavities, pointing out of the material, (t, 3).
    tets, parts
        Further tets that displace the liquid, (k, 4), and the part of each that does, (k,).
    slope
        Pressure over depth in Pa/m.
    level
        Height along z where there is none, m.
    """

    triangles: Triangles = field(repr=False)
    tets: NDArray[np.int32] = field(repr=False)
    parts: Floats = field(repr=False)
    slope: float
    level: float

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.depth_pressure(self)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the point where a line upward through the middle enters the bounds."""
        return _into_bounds(rest, np.array([0.0, 0.0, 1.0]))

    def forces(self, positions: Floats) -> Floats:
        """Compute the forces on all vertices, (n, 3), N: minus the slopes of ∫ p dV.

        With the mean pressure over a tet that is the volume times the pressure at its center;
        walls count by the tets between them and a point of the surface.
        """
        found = np.zeros_like(positions)
        at = positions - np.array([0.0, 0.0, self.level])
        walls = np.column_stack((self.triangles, np.full(len(self.triangles), -1)))
        for corners, parts in ((self.tets, self.parts), (walls, np.full(len(walls), 1.0))):
            a, b, c = at[corners[:, :3]].transpose(1, 0, 2)
            closed = corners[:, 3] < 0
            d = np.where(closed[:, None], 0.0, at[corners[:, 3]])
            slopes = np.stack(
                (
                    np.cross(d - b, c - b),
                    np.cross(c - a, d - a),
                    np.cross(d - a, b - a),
                    np.cross(b - a, c - a),
                ),
                axis=1,
            )
            volumes = np.einsum("ij,ij->i", slopes[:, 3], d - a)
            heights = (a + b + c + d)[:, 2] / 4.0
            each = slopes * heights[:, None, None]
            each[:, :, 2] += volumes[:, None] / 4.0
            each *= (self.slope / 6.0 * parts)[:, None, None]
            for corner in range(4):
                kept = corners[:, corner] >= 0
                np.add.at(found, corners[kept, corner], each[kept, corner])
        return found


@dataclass(frozen=True, eq=False)
class SurfaceDrag(Action):
    """Drag of a fluid on the outer surface of a body.

    Attributes
    ----------
    surface
        The surface.
    density
        Density of the fluid, kg/m³.
    normal, tangential
        Coefficients across the surface and along it.
    linear
        Speed of the linear part, m/s.
    flow
        Velocity of the fluid, (3,), m/s.
    """

    surface: OuterSurface
    density: float
    normal: float
    tangential: float
    linear: float
    flow: Floats

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.drag(self)

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the point where the flow through the middle enters the bounds, as an arrow."""
        return _into_bounds(rest, _unit(self.flow))


@dataclass(frozen=True, eq=False)
class FieldAcceleration(Action):
    """An acceleration of all mass by formulas in m/s² along x, y and z, times a factor."""

    value: float
    formulas: tuple[_core.Formula, _core.Formula, _core.Formula]

    def give_to(self, receiver: LoadReceiver) -> None:
        """Hand this to its receiver."""
        receiver.field(self)

    def undefined(self, points: Floats) -> tuple[int, int] | None:
        """Find a component without a finite value."""
        still = np.zeros_like(points)
        for axis, formula in enumerate(self.formulas):
            if len(wrong := np.flatnonzero(~np.isfinite(formula.at(points, still, 0.0)))):
                return axis, int(wrong[0])
        return None

    def arrow(self, rest: Floats) -> tuple[Floats, Floats]:
        """Return the point where a line along it in the middle enters the bounds, as an arrow."""
        middle, still = rest.mean(axis=0, keepdims=True), np.zeros((1, 3))
        found = np.concatenate([each.at(middle, still, 0.0) for each in self.formulas])
        known = self.value * np.where(np.isfinite(found), found, 0.0)
        return _into_bounds(rest, _unit(known))


def _into_bounds(rest: Floats, direction: Floats) -> tuple[Floats, Floats]:
    middle: Floats = rest.mean(axis=0)
    behind = np.where(direction > 0.0, middle - rest.min(axis=0), rest.max(axis=0) - middle)
    moves = np.abs(direction) > 1e-9  # along other axes the line never leaves the bounds
    if moves.any():
        middle -= direction * float(np.min(behind[moves] / np.abs(direction[moves])))
    return middle, direction


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return vector / length if length else np.array(_NOWHERE)
