"""Contact of a design prepared for the core: surfaces, objects, friction, adhesion.

Long because surfaces are moved apart and checked where all that touches is known.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._shown import rounded
from voxsoft.design import Contact, Design, History, Motion
from voxsoft.design.contact import Adhesion, names_of
from voxsoft.errors import DesignError
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.distance import TOUCH, Surface, overlap_of, way_out
from voxsoft.simulation.setup.object_symmetry import Sharing
from voxsoft.simulation.setup.rigid_objects import Solid, surface_of
from voxsoft.simulation.setup.skin import skin_of, touches_with_skin
from voxsoft.units import format_quantity

#: Number of parts into which the points of contact search divide the edge of a voxel.
_SAMPLES: Final = 2
#: Largest distance or penetration of bonded surfaces in the unloaded design, in voxels.
_REACH: Final = 0.5
#: Extent of the floor to each side, in sizes of all that is above it: farther than anything may go.
_FLOOR: Final = 20.0


@dataclass(frozen=True)
class ContactState:
    """Contact of two surfaces.

    Attributes
    ----------
    of
        The body and an object, or the body twice; two bodies where there are several.
    force
        Force on the first [N]; zero for self-contact.
    pressed
        Sum of the magnitudes of all forces [N], each with its friction as one vector, bonds
        included: more than `pressure` where anything rubs or is bonded.
    pressure
        Sum of all normal forces that push apart [N]; `grip_force` is that of all contacts with an
        object but the floor's.
    friction
        Friction, a part of the force [N].
    bound
        Largest possible friction: the sum of these normal forces times their coefficients [N].
    area
        Contact area on the unloaded body [m²], with the bonded area.
    bonded
        Bonded area [m²].
    gap
        Smallest gap [m].
    slipping
        Part of the pressure under which the surfaces slip, 0 to 1.
    place
        Mean place of the pressure [m]; None where nothing presses.
    """

    of: tuple[str, str]
    force: tuple[float, float, float]
    pressed: float
    pressure: float
    friction: tuple[float, float, float]
    bound: float
    area: float
    bonded: float
    gap: float
    slipping: float
    place: tuple[float, float, float] | None = None

    @property
    def sentence(self) -> str:
        """The contact in a sentence."""
        size = self.pressed if self.of[0] == self.of[1] else float(np.linalg.norm(self.force))
        first, second = self.of
        who = "itself" if first == second else second
        return f"{first} touches {who} with {format_quantity(rounded(size), 'force')}"

    def summary(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "of": list(self.of),
            "force": list(self.force),
            "pressed": self.pressed,
            "pressure": self.pressure,
            "friction": list(self.friction),
            "friction_bound": self.bound,
            "area": self.area,
            "bonded": self.bonded,
            "gap": self.gap,
            "sticking": 1.0 - self.slipping,
            "place": None if self.place is None else list(self.place),
        }


@dataclass(frozen=True)
class Pose:
    """Pose of an object.

    Attributes
    ----------
    position
        Present place [m] of the middle of its bounding box: the box of its first pose along the
        axes, which rotates with it. Another point than its center of mass, unless it is symmetric.
    rotation
        Rotation from its first pose, (3, 3).
    center_of_mass
        Present center of mass [m] of a free object; None for one that is fixed or moved, whose mass
        no number depends on, and along a recording.
    """

    position: tuple[float, float, float]
    rotation: tuple[tuple[float, float, float], ...]
    center_of_mass: tuple[float, float, float] | None = None

    def summary(self) -> dict[str, Any]:
        """Return plain data."""
        center = self.center_of_mass
        return {
            "position": list(self.position),
            "rotation": [list(row) for row in self.rotation],
            "center_of_mass": None if center is None else list(center),
        }


def has_contact(design: Design) -> bool:
    """Return True if anything of a design may be in contact."""
    return design.contact is not None or bool(design.objects) or len(design.body_names) > 1


def has_friction(design: Design) -> bool:
    """Return True if any contact of a design has friction."""
    contact = design.contact or Contact()
    return has_contact(design) and (
        contact.friction > 0.0 or any(pair.friction for pair in contact.pairs)
    )


def keeps_apart(design: Design) -> bool:
    """Return True if contact keeps bodies out of themselves and each other."""
    contact, bodies = design.contact or Contact(), design.body_names
    table = contact.table(design.objects, design.floor is not None, bodies)
    own = [entry for row in table[: len(bodies)] for entry in row[: len(bodies)]]
    return has_contact(design) and not any(math.isnan(entry) for entry in own)


@dataclass(frozen=True)
class Bond:
    """Bond of two surfaces.

    Attributes
    ----------
    of
        Numbers of the surfaces.
    strength
        Traction at which it lets go [Pa]; infinite for one that does not.
    where
        Place in the design.
    """

    of: tuple[int, int]
    strength: float
    where: str


@dataclass(frozen=True)
class Touching:
    """Contact of a design.

    Attributes
    ----------
    design
        The design.
    mesh
        Its mesh.

    Raises
    ------
    DesignError
        An object without a surface, or one that penetrates the unloaded body.
    """

    design: Design
    mesh: Mesh

    @property
    def voxel_size(self) -> float:
        """Voxel size of the body, m."""
        return self.mesh.voxel_size or self.design.voxel_size

    @property
    def names(self) -> list[str]:
        """Names of surfaces in the order of their numbers: bodies, objects, a floor if any."""
        design = self.design
        return names_of(design.objects, design.floor is not None, design.body_names)

    @cached_property
    def friction(self) -> NDArray[np.float64]:
        """Friction coefficient of each pair, in the order of names; NaN without contact."""
        design = self.design
        floor = design.floor is not None
        return np.array(self.contact.table(design.objects, floor, design.body_names))

    @cached_property
    def skins(self) -> tuple[_core.Skin | None, ...]:
        """Smooth surface of each body, in its own frame; None where contact is on its voxels."""
        return tuple(
            skin_of(own, body.mesh) if touches_with_skin(self.design, own, body.mesh) else None
            for body in self.mesh.each_body
            for own in [self.design.alone(body.name)]
        )

    @cached_property
    def bodies(self) -> tuple[Surface, ...]:
        """Surface of each body.

        Raises
        ------
        DesignError
            A body penetrates another one.
        """
        names, found = self.design.body_names, list[Surface]()
        for index, (body, skin) in enumerate(zip(self.mesh.each_body, self.skins, strict=True)):
            own = body.mesh
            surface = (
                Surface(body.placed(own.vertices), own.triangles.astype(np.uint32))
                if skin is None
                else Surface(body.placed(skin.points), skin.triangles)
            )
            for other, before in enumerate(found):
                allowed = self._allowed(other, index)
                if allowed > 0.0 or not math.isnan(self.friction[index, other]):
                    where = f"bodies[{index}]"
                    self._check_apart(surface, before, where, f'"{names[other]}"', allowed)
            found.append(surface)
        return tuple(found)

    @cached_property
    def traced(self) -> tuple[Surface, ...]:
        """Traced surface of each object, before it is moved apart."""
        return tuple(
            surface_of(each, self.design, f"objects[{index}]")
            for index, each in enumerate(self.design.objects)
        )

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of each object, apart from the body and all else that it may touch."""
        return self.separated

    @cached_property
    def separated(self) -> tuple[Surface, ...]:
        """Traced surface of each object, moved apart.

        With ``separate = true`` objects that penetrate something are moved out of it.
        """
        found: list[Surface] = []
        for index, surface in enumerate(self.traced):
            others = self._beside(index, found)
            if self.contact.separate:
                free = [other for other, _, depth in others if depth == 0.0]
                surface = surface.moved(way_out(surface, free, self.voxel_size))
            where = f"objects[{index}]"
            for other, who, depth in others:
                self._check_apart(surface, other, where, who, depth)
            self._check_above(surface.vertices, where)
            found.append(surface)
        for body in self.bodies:
            self._check_above(body.vertices, "floor")
        self._check_bonds(found)
        return tuple(found)

    def _beside(self, index: int, found: list[Surface]) -> list[tuple[Surface, str, float]]:
        """List obstacles of an object: surface, name, and allowed penetration [m]."""
        each = self.design.objects[index]
        count = len(self.bodies)
        others = []
        for number, (name, body) in enumerate(zip(self.names, self.bodies, strict=False)):
            who = f'the body "{name}"' if self.mesh.bodies else "the body"
            others.append((body, who, self._allowed(number, count + index)))
        for number, other in enumerate(self.design.objects[:index]):
            if each.is_free or other.is_free:
                allowed = self._allowed(count + number, count + index)
                others.append((found[number], f'"{other.name}"', allowed))
        return others

    def _allowed(self, first: int, second: int) -> float:
        """Return the allowed penetration of two unloaded surfaces [m]: a little if bonded."""
        return self.reach if any(bond.of == (first, second) for bond in self.bonds) else 0.0

    def _check_above(self, vertices: NDArray[np.float64], where: str) -> None:
        if self.design.floor is None:
            return
        depth = self.design.floor.z - float(vertices[:, 2].min())
        if depth > TOUCH * self.voxel_size:
            who = "is above the lowest point of the body" if where == "floor" else "is in the floor"
            what = f"{who} by {1e3 * depth:.3g} mm"
            raise DesignError(where, what, "move one of them: nothing may be below the floor")

    def _check_apart(
        self, surface: Surface, other: Surface, where: str, who: str, allowed: float
    ) -> None:
        overlap = overlap_of(surface, other, self.voxel_size)
        if overlap.depth > allowed + TOUCH * self.voxel_size:
            x, y, z = 1e3 * overlap.place
            depth = 1e3 * overlap.depth
            what = f"is {depth:.3g} mm deep in {who} at ({x:.1f}, {y:.1f}, {z:.1f}) mm"
            hint = f"move it away by {depth:.3g} mm or more"
            if not self.contact.separate:
                hint += ", or write separate = true in [contact]"
            raise DesignError(where, what, hint)

    def _check_bonds(self, surfaces: Sequence[Surface]) -> None:
        """Raise unless bonded surfaces meet."""
        floor = self._floor_under(surfaces)
        everything = [*self.bodies, *surfaces, *([] if floor is None else [floor])]
        for bond in self.bonds:
            first, second = (everything[number] for number in bond.of)
            distance = -overlap_of(first, second, self.voxel_size).depth
            if distance > self.reach:
                a, b = (self.names[number] for number in bond.of)
                what = f'bonds "{a}" and "{b}", which are {1e3 * distance:.3g} mm apart'
                hint = f"move them to within half a voxel, {1e3 * self.reach:.3g} mm"
                raise DesignError(bond.where, what, hint)

    @property
    def reach(self) -> float:
        """Largest distance of bonded surfaces in the unloaded design, m."""
        return _REACH * self.voxel_size

    @property
    def contact(self) -> Contact:
        """Contact of the design, or the default where there is none."""
        return self.design.contact or Contact()

    @cached_property
    def bonds(self) -> tuple[Bond, ...]:
        """Bonds of surfaces; of two entries for one pair the later one counts."""
        found: dict[tuple[int, int], Bond | None] = {}
        for index, pair in enumerate(self.contact.pairs):
            a, b = sorted(self.names.index(name) for name in pair.of)
            strength = math.inf if pair.strength is None else pair.strength
            bond = Bond((a, b), strength, f"contact.pairs[{index}]")
            found[a, b] = bond if pair.kind == "bonded" else None
        return tuple(bond for bond in found.values() if bond is not None)

    @cached_property
    def adhesions(self) -> dict[tuple[int, int], Adhesion]:
        """Adhesion by numbers of surfaces; of two entries for one pair the later one counts."""
        count, common = len(self.names), self.contact.adhesion
        found = {(a, b): common for a in range(count) for b in range(a + 1, count)}
        for pair in self.contact.pairs:
            a, b = sorted(self.names.index(name) for name in pair.of)
            if a != b:
                found[a, b] = pair.adhesion or (common if pair.kind == "touching" else None)
        return {
            of: adhesion
            for of, adhesion in found.items()
            if adhesion is not None and not math.isnan(self.friction[of])
        }

    @cached_property
    def solids(self) -> tuple[Solid | None, ...]:
        """Mass and inertia of each free object; None for those that are held."""
        rows = zip(self.design.objects, self.traced, self.surfaces, strict=True)
        return tuple(
            Solid.of(traced, each, self.design, now.middle - traced.middle)
            if each.is_free
            else None
            for each, traced, now in rows
        )

    @cached_property
    def floor(self) -> Surface | None:
        """Floor under everything, a square."""
        return self._floor_under(self.surfaces)

    def _floor_under(self, surfaces: Sequence[Surface]) -> Surface | None:
        if self.design.floor is None:
            return None
        all_points = [self.mesh.vertices, *(surface.vertices for surface in surfaces)]
        points = np.concatenate(all_points)
        low, high = points.min(axis=0), points.max(axis=0)
        reach = _FLOOR * float(np.linalg.norm(high - low))
        middle = (low + high) / 2.0
        corners = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        level = np.full((4, 1), self.design.floor.z)
        vertices = np.hstack([middle[:2] + reach * corners, level])
        return Surface(vertices, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32))

    def give_to(
        self,
        parts: _core.ProblemParts,
        origin: NDArray[np.float64] | None = None,
        sharing: Sequence[Sharing] | None = None,
    ) -> None:
        """Add it to the parts of a problem.

        Parameters
        ----------
        parts
            Parts of the problem.
        origin
            Origin of the problem, (3,), m; default: that of the design.
        sharing
            Treatment of each object beside planes of symmetry; default: all solved by themselves.
        """
        shift = np.zeros(3) if origin is None else origin
        for body, skin in zip(self.mesh.each_body, self.skins, strict=True):
            triangles = (body.mesh.triangles + body.first_vertex).astype(np.uint32)
            size = body.mesh.voxel_size or self.design.voxel_size
            count = len(body.mesh.vertices)
            parts.touch(triangles, size, _SAMPLES, skin, body.first_vertex, count)
        shared = sharing or [Sharing()] * len(self.design.objects)
        for each, surface, solid, own in zip(
            self.design.objects, self.surfaces, self.solids, shared, strict=True
        ):
            points, triangles = surface.vertices - shift, surface.triangles
            if own.of is not None:
                parts.image_object(points, triangles, own.of, own.signs)
            elif solid is not None:
                parts.free_object(
                    points,
                    triangles,
                    solid.mass,
                    (np.array(solid.center) - shift).tolist(),
                    solid.axes,
                    solid.radii,
                    own.share,
                    own.held,
                )
            else:
                motion = motion_arguments(each.way)
                if "center" in motion:
                    motion["center"] = (np.array(motion["center"]) - shift).tolist()
                parts.object(points, triangles, **motion)
        if self.floor is not None:
            parts.object(self.floor.vertices - shift, self.floor.triangles)
        parts.friction(self.friction)
        for bond in self.bonds:
            parts.bond(*bond.of, self.reach, bond.strength)
        for of, adhesion in self.adhesions.items():
            parts.adhesion(*of, adhesion.strength, adhesion.range)

    def contacts(self, found: Sequence[_core.Contact]) -> tuple[ContactState, ...]:
        """Convert the core's contacts."""
        return tuple(
            ContactState(
                of=(self.names[each.a], self.names[each.b]),
                force=(each.force[0], each.force[1], each.force[2]),
                pressed=each.pressed,
                pressure=each.pressure,
                friction=(each.friction[0], each.friction[1], each.friction[2]),
                bound=each.bound,
                area=each.area,
                bonded=each.bonded,
                gap=each.gap,
                slipping=each.slipping,
                place=None if each.place is None else (each.place[0], each.place[1], each.place[2]),
            )
            for each in found
        )

    def poses(self, found: Sequence[_core.ObjectPose]) -> dict[str, Pose]:
        """Convert the core's poses of the objects, by name."""
        poses = {}
        # A floor comes last among the core's objects.
        for each, surface, solid, pose in zip(
            self.design.objects, self.surfaces, self.solids, found, strict=False
        ):
            turn, position = np.array(pose.rotation), np.array(pose.position)
            center: tuple[float, float, float] | None = None
            if solid is not None:  # the core follows its center of mass
                center = (float(position[0]), float(position[1]), float(position[2]))
                position = position + turn @ (surface.middle - np.array(solid.center))
            x, y, z = position.tolist()
            rotation = tuple((row[0], row[1], row[2]) for row in pose.rotation)
            poses[each.name] = Pose((x, y, z), rotation, center)
        return poses


#: Times [s] and factors, as the core takes them.
CoreHistory = tuple[list[float], list[float]] | None


def times_and_factors(history: History | None) -> CoreHistory:
    """Convert a history to that of the core."""
    return None if history is None else (list(history.times), list(history.factors))


def motion_arguments(motion: Motion | None) -> dict[str, Any]:
    """Convert a rigid motion to keyword arguments of the core; none without a motion."""
    if motion is None:
        return {}
    turn: dict[str, Any] = {}
    if motion.rotation is not None:
        axis = np.asarray(motion.rotation.axis) / np.linalg.norm(motion.rotation.axis)
        turn = {
            "axis": axis.tolist(),
            "angle": motion.rotation.angle,
            "center": motion.rotation.center,
        }
    history = times_and_factors(motion.history)
    return {"displacement": motion.displacement, "history": history, **turn}
