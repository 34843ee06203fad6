"""Setup of a design as a mechanical problem: mesh, materials, clamps, loads, probes.

Long because all that is derived from a design stands in one class, a short property each.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core, _core_data
from voxsoft._memory import shortage
from voxsoft.cavity import MeshCavity
from voxsoft.design import Design, Probe, Region
from voxsoft.design.assembly import with_origins
from voxsoft.design.attachment import PlaceOnBody, attachments_of
from voxsoft.design.clamp import check_clamps
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.design.discretization.joined import edge_directions
from voxsoft.errors import (
    DesignError,
    DisconnectedError,
    NoCavityError,
    SimulationError,
    VoxSoftError,
)
from voxsoft.materials import Material
from voxsoft.mesh import Mesh
from voxsoft.metrics import Place
from voxsoft.simulation.compatibility import refuse
from voxsoft.simulation.loads import LoadReceiver, ResolvedLoad, readings, resolve
from voxsoft.simulation.loads.actions import DepthPressure, FieldAcceleration, SurfaceDrag
from voxsoft.simulation.loads.surface import OuterSurface
from voxsoft.simulation.setup.chambers import check_chambers, with_chamber_names
from voxsoft.simulation.setup.contact import (
    CoreHistory,
    Touching,
    has_contact,
    motion_arguments,
    times_and_factors,
)
from voxsoft.simulation.setup.dielectrics import ResolvedDielectric, dielectrics_of
from voxsoft.simulation.setup.fluids import Fluids, has_supplies
from voxsoft.simulation.setup.large_voxels import large_voxels
from voxsoft.simulation.setup.layers import LayerTriangles, all_layer_triangles, sealed
from voxsoft.simulation.setup.materials import core_materials, solid_materials
from voxsoft.simulation.setup.missing_cavity import why_no_cavity
from voxsoft.simulation.setup.other_split import OtherSplit, with_other_split
from voxsoft.simulation.setup.outer_surface import outer_surfaces
from voxsoft.simulation.setup.places import on_the_body, place_of, vertices_in
from voxsoft.simulation.setup.profiles import check_profile_symmetry
from voxsoft.simulation.setup.supports import clamped_vertices
from voxsoft.simulation.setup.symmetry.bodies import kinds_of
from voxsoft.simulation.setup.symmetry.contact import SectorTouching
from voxsoft.simulation.setup.symmetry.fibers import check_fiber_symmetry
from voxsoft.simulation.setup.symmetry.parts import SectorParts
from voxsoft.simulation.setup.symmetry.sector import Sector
from voxsoft.simulation.setup.targets import check_targets
from voxsoft.simulation.setup.tendons import ResolvedTendon, resolve_tendons
from voxsoft.simulation.setup.windings import check_windings

#: Bytes that a voxel takes until it can be solved; measured on a block of 125,000: 540
#: (lattice) and 810 (rubber), half as much again for bodies of other shapes.
BYTES_PER_VOXEL: Final = 1_200


@dataclass(frozen=True, repr=False)
class Setup:
    """A design prepared for a solver.

    Attributes
    ----------
    design
        The design, with the entries of the designs of its bodies in its own lists.
    mesh
        Its tetrahedra. Chambers that layers close are among its cavities, and cavities have the
        names of the design's chambers.

    Raises
    ------
    DesignError
        A layer catches no face of the mesh.

    Notes
    -----
    Everything else is derived on first use and kept; :meth:`problem_with` shares it.
    """

    design: Design
    mesh: Mesh

    def __repr__(self) -> str:
        return f"Setup({self.design.name!r}, {self.mesh!r})"

    def __post_init__(self) -> None:
        object.__setattr__(self, "design", self.design.assembled)
        closed = sealed(self.mesh, self.layers, self.design)
        named = with_chamber_names(self.design, closed)
        object.__setattr__(self, "mesh", with_other_split(self.design, named))

    @classmethod
    def of(
        cls, design: Design, *, allow_loose: bool | None = None, refine: int | None = None
    ) -> Setup:
        """Voxelize and mesh a design and check that it can be loaded.

        Parameters
        ----------
        design
            The design.
        allow_loose
            True if nothing needs to hold the body; default: if the design's solver has an end
            time, because a run over time need not come to rest.
        refine
            Cut every voxel into this many along each axis; default: as the design's solver says.

        Raises
        ------
        DesignError
            Nothing holds the body, or a clamp, load or probe catches nothing.
        DisconnectedError
            A component of the body is held by no clamp.
        NoCavityError
            A pressure is asked for, or a chamber named, and there is no such cavity.
        SimulationError
            The problem does not fit in the memory.
        """
        try:
            return cls._checked(design.assembled, allow_loose, refine)
        except VoxSoftError as error:
            raise with_origins(error, design) from None

    @classmethod
    def _checked(cls, design: Design, allow_loose: bool | None, refine: int | None) -> Setup:
        setup = cls(design, mesh_of(design, refine or design.solver.refine))
        voxels = len(setup.mesh.tets) // 5
        if short := shortage(voxels * BYTES_PER_VOXEL):
            if design.mesh is not None:
                what = f"the problem of {len(setup.mesh.tets):,} tetrahedra {short}"
                raise SimulationError("mesh", what, "take a coarser mesh")
            what = f"the problem of {voxels:,} voxels {short}"
            raise SimulationError("voxel_size", what, "make the voxels larger")
        setup.check(allow_loose=allow_loose)
        return setup

    def check(self, *, allow_loose: bool | None = None) -> None:
        """Raise the error that keeps this setup from being solved, if any."""
        check_targets(self.design)
        check_clamps(self.design.clamps)
        check_chambers(self.design, self.mesh)
        check_windings(self.design, self.mesh)
        self._check_cavities()
        timed = self.design.solver.is_timed
        if not (timed if allow_loose is None else allow_loose):
            self._check_support()
        _ = self.places, self.attached, self.tendons
        if self.design.refine:
            _ = self.large_voxels
        if self.fluids is not None:
            _ = self.fluids.network
        if self.touching is not None:
            _ = self.touching.surfaces
        if self.sector is not None:
            _ = self.sector_parts

    @cached_property
    def layers(self) -> tuple[LayerTriangles, ...]:
        """Triangles of each layer of the design."""
        return all_layer_triangles(self.design, self.mesh)

    @cached_property
    def large_voxels(self) -> NDArray[np.uint32]:
        """Groups of eight voxels of the mesh that are one, with local refinement, (g, 8).

        With planes of symmetry, those of the solved sector.

        Raises
        ------
        DesignError
            A refinement that catches nothing.
        """
        return large_voxels(self)

    @property
    def elements(self) -> int:
        """Number of voxels, large and small; five tetrahedra of another mesh count as one."""
        return len(self.mesh.tets) // 5 - 7 * self.large_count

    @property
    def large_count(self) -> int:
        """Number of voxels that stay large beside local refinement, in all of the body."""
        if not self.design.refine:
            return 0
        return len(self.large_voxels) * (1 if self.sector is None else self.sector.count)

    @cached_property
    def other_split(self) -> OtherSplit:
        """Other split of the faces under pressure into triangles."""
        return OtherSplit.of(self.design, self.mesh)

    @cached_property
    def outer_surfaces(self) -> tuple[OuterSurface, ...]:
        """Outer surface of each body."""
        return outer_surfaces(self.design, self.other_split)

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Positions of the vertices for the tests of regions, (n, 3), m."""
        return on_the_body(self.design, self.mesh)

    @cached_property
    def places(self) -> dict[str, Place]:
        """Vertices and weights of each probe."""
        return {
            name: self.place(probe, f"probes.{name}") for name, probe in self.design.probes.items()
        }

    @property
    def origin(self) -> NDArray[np.float64]:
        """Origin of the solver, (3,), m."""
        return np.zeros(3)

    @cached_property
    def sector(self) -> Sector | None:
        """Sector of the body that is solved; None without planes of symmetry.

        Raises
        ------
        DesignError
            The voxels or the fibers are not symmetric, or the design has a feature that is not
            known with planes of symmetry.
        """
        planes = self.design.symmetry
        if not planes:
            return None
        refuse(self.design, "symmetry")
        found = Sector.of(planes, self.mesh, kinds_of(self.design.parts))
        check_fiber_symmetry(self.design)
        check_profile_symmetry(self.design, self.mesh)
        return found

    @cached_property
    def sector_parts(self) -> _core.ProblemParts:
        """Clamps, layers and loads of the solved sector.

        Raises
        ------
        DesignError
            An entry that is not symmetric.
        """
        assert self.sector is not None  # used with planes of symmetry alone
        spanning = [np.zeros((0, 3), np.int32), *(layer.spanning for layer in self.layers)]
        parts = SectorParts(self.sector, np.concatenate(spanning))
        self._give_to(parts)
        parts.check()
        if self.sector_touching is not None:
            self.sector_touching.give_to(parts.kept)
        elif self.design.floor is not None:
            parts.where = "floor"
            parts.floor(self.design.floor.z)
        parts.hold_planes()
        return parts.kept

    @cached_property
    def sector_touching(self) -> SectorTouching | None:
        """Contact of the solved sector with all of the body, where the design has it."""
        if self.sector is None or not has_contact(self.design):
            return None
        return SectorTouching(self.design, self.mesh, self.sector)

    @cached_property
    def problem(self) -> _core.Problem:
        """Problem of the Rust core, with the design's own materials."""
        return core_problem(
            self.mesh,
            core_materials(self.design, self.materials, self.mesh, self.origin),
            self._parts(),
        )

    @cached_property
    def problem_alone(self) -> _core.Problem:
        """Problem without contact, for drawing and for fields of strain."""
        if self.touching is None:
            return self.problem
        parts = self._parts(touching=False)
        return core_problem(
            self.mesh, core_materials(self.design, self.materials, self.mesh, self.origin), parts
        )

    def problem_with(self, materials: list[Material]) -> _core.Problem:
        """Return the problem with other materials, one for each part of the design."""
        return self.problem.with_materials(
            core_materials(self.design, materials, self.mesh, self.origin)
        )

    @cached_property
    def materials(self) -> list[Material]:
        """Material of each part, with a stiff one in place of a rigid one."""
        return solid_materials(self.design)

    def _parts(self, *, touching: bool = True) -> _core.ProblemParts:
        parts = _core.ProblemParts()
        self._give_to(parts, touching=touching)
        if self.touching is not None and touching:
            self.touching.give_to(parts)
        elif self.design.floor is not None:
            parts.floor(self.design.floor.z)
        return parts

    def _give_to(self, parts: _core.ProblemParts | SectorParts, *, touching: bool = False) -> None:
        """Add layers, clamps, loads and attachments to the problem of the core."""
        for where, layer, found in _numbered("layers", self.design.layers, self.layers):
            _say_where(parts, where)
            parts.membrane(
                found.all.astype(np.uint32),
                young=layer.young,
                poisson=layer.poisson,
                thickness=layer.thickness,
                density=layer.density,
            )
        for where, clamp, vertices in _numbered("clamps", self.design.clamps, self.clamped):
            _say_where(parts, where)
            axes = [axis in clamp.axes for axis in "xyz"]
            parts.clamp(vertices, axes, **motion_arguments(clamp.motion))
        for index, load in enumerate(self.loads):
            _say_where(parts, f"loads[{index}]")
            receiver = _CoreLoads(self.other_split, parts, times_and_factors(load.reading.history))
            for action in load.actions:
                action.give_to(receiver)
        if self.design.refine:
            parts.coarse(self.large_voxels)
        if self.fluids is not None and isinstance(parts, _core.ProblemParts):
            self.fluids.give_to(parts)
        for term, elements in self.attached.items():
            _say_where(parts, term)
            parts.attach(term, elements)
        for index, tendon in enumerate(self.tendons):
            _say_where(parts, f"tendons[{index}]")
            core = tendon.core(objects=touching)
            parts.tendon(core, tendon.history)
        for sheet in self.dielectrics:
            assert isinstance(parts, _core.ProblemParts)  # there are none with planes of symmetry
            sheet.give_to(parts)

    @cached_property
    def touching(self) -> Touching | None:
        """Contact, where the design has it.

        Raises
        ------
        DesignError
            An object without a surface, or one that penetrates the unloaded body.
        """
        return Touching(self.design, self.mesh) if has_contact(self.design) else None

    @cached_property
    def fluids(self) -> Fluids | None:
        """Supplies of its chambers, where the design has any; errors as for that class."""
        return Fluids(self.design, self.mesh) if has_supplies(self.design) else None

    @cached_property
    def loads(self) -> tuple[ResolvedLoad, ...]:
        """Each load of the design, resolved to its actions on the mesh.

        Raises
        ------
        DesignError
            A load catches nothing.
        """
        return tuple(self.load(index) for index in range(len(self.design.loads)))

    def load(self, index: int) -> ResolvedLoad:
        """Resolve one load of the design; errors as for :attr:`loads`."""
        return resolve(self.design.loads[index], self, f"loads[{index}]")

    @cached_property
    def attached(self) -> dict[str, list[_core_data.Element]]:
        """Elements of each term of the core that the design attaches, by the term's name.

        Raises
        ------
        DesignError
            An element with an end that is not on the body.
        """
        found: dict[str, list[_core_data.Element]] = {}
        for where, attachment in attachments_of(self.design):
            found.setdefault(attachment.term, []).append(attachment.element(self, where))
        return found

    @cached_property
    def tendons(self) -> tuple[ResolvedTendon, ...]:
        """Tendons of the design on the mesh.

        Raises
        ------
        DesignError
            A tendon that leaves the body, crosses itself, or is too short to reach its ends.
        """
        return resolve_tendons(self)

    @cached_property
    def dielectrics(self) -> tuple[ResolvedDielectric, ...]:
        """Dielectric sheets of the design on the mesh; errors as for :func:`dielectrics_of`."""
        return dielectrics_of(self.design, self.mesh)

    def place(self, probe: Probe, where: str) -> Place:
        """Find vertices and weights of a point or region; `where` is the place an error names."""
        return place_of(probe, self.mesh, self.design.shapes, where, self.points)

    def position(self, place: PlaceOnBody) -> NDArray[np.float64]:
        """Compute the position of a place in the undeformed body, (3,), m."""
        return np.asarray(place.weights @ self.mesh.vertices[place.vertices])

    @cached_property
    def clamped(self) -> list[NDArray[np.uint32]]:
        """Vertices of each clamp."""
        return clamped_vertices(self.design, self.mesh, self.points)

    def vertices_in(self, region: Region, where: str) -> NDArray[np.uint32]:
        """Find the vertices that a region catches; `where` is the place an error names."""
        return vertices_in(region, self.mesh, self.design.shapes, where, self.points)

    def _check_cavities(self) -> None:
        count = len(self.mesh.cavities)
        for index, reading in enumerate(readings(self.design)):
            if reading.cavity is None:
                continue
            where = f"loads[{index}]"
            if count == 0:
                why, hint = why_no_cavity(self.design, self.mesh)
                what = f"there is no enclosed cavity to put a pressure in: {why}"
                raise NoCavityError(where, what, hint)
            self.load(index)

    @cached_property
    def loose_piece(self) -> NDArray[np.int32] | None:
        """Vertices of the largest component that no clamp holds; None if each is held."""
        held = np.zeros(len(self.mesh.vertices), dtype=bool)
        for vertices in self.clamped:
            held[vertices] = True
        return _loose_piece(self.mesh, held)

    def _check_support(self) -> None:
        """Raise unless every component is held, or may come to lie on a floor or an object."""
        if self.design.floor is not None or self.design.objects:
            return
        if len(self.design.symmetry) == 3:
            return  # its middle cannot move
        if not self.design.clamps:
            raise DesignError(
                "clamps",
                "nothing holds the body: it would fall or fly for ever",
                "add a clamp, a floor, or an end_time to watch it fly",
            )
        loose = self.loose_piece
        if loose is not None:
            center = self.mesh.vertices[loose].mean(axis=0) * 1e3
            raise DisconnectedError(
                "parts",
                f"a component of {len(loose)} vertices around "
                f"({center[0]:.1f}, {center[1]:.1f}, {center[2]:.1f}) mm touches no clamp",
                "join it to the rest by whole faces of voxels, or clamp it",
            )


def named_regions(design: Design, mesh: Mesh) -> dict[str, NDArray[np.uint32]]:
    """Find vertices of clamps and probes that catch any, and of the regions of the body's file."""
    design = design.assembled
    regions: dict[str, NDArray[np.uint32]] = {
        name: vertices.astype(np.uint32) for name, vertices in mesh.regions.items()
    }
    places: dict[str, Region] = {
        **{f"clamp_{each.name or i}": each.region for i, each in enumerate(design.clamps)},
        **{f"probe_{name}": probe for name, probe in design.probes.items()},
    }
    points = on_the_body(design, mesh)
    for name, region in places.items():
        try:
            if isinstance(region, Probe):
                regions[name] = place_of(region, mesh, design.shapes, name, points).vertices
            else:
                regions[name] = vertices_in(region, mesh, design.shapes, name, points)
        except DesignError:
            continue  # A place outside the body is a finding of `check`, not of an export.
    return regions


def _loose_piece(mesh: Mesh, held: NDArray[np.bool_]) -> NDArray[np.int32] | None:
    """Find the vertices of the largest component of which none is held, if there is one.

    Tetrahedra joined by whole faces make a component; those that share only an edge or a vertex
    hinge on it and count as separate components.
    """
    labels = _core.mesh_pieces(mesh.tets)
    count = int(labels.max()) + 1
    reached = np.bincount(labels, weights=held[mesh.tets].any(axis=1), minlength=count)
    loose = [np.unique(mesh.tets[labels == label]) for label in np.flatnonzero(reached == 0)]
    return max(loose, key=len, default=None)


def core_problem(
    mesh: Mesh,
    materials: list[_core.Material],
    parts: _core.ProblemParts,
    directions: NDArray[np.float64] | None = None,
) -> _core.Problem:
    """Build the problem of the Rust core.

    Parameters
    ----------
    mesh
        The body.
    materials
        One for each part, as :func:`~voxsoft.simulation.setup.materials.core_materials` gives them.
    parts
        Membranes, clamps and loads.
    directions
        Directions of the edges of voxels, (v, 9); default: those of the bodies of the mesh.
    """
    if mesh.fractions is not None:
        parts.fractions(mesh.fractions, mesh.moments, mesh.surfaces)
    if directions is None:
        directions = edge_directions(mesh)
    if directions is not None:
        parts.axes(directions)
    blocks = mesh.tet_voxel if mesh.tet_voxel is not None else np.arange(len(mesh.tets))
    return _core.Problem(
        mesh.vertices,
        mesh.tets.astype(np.uint32),
        mesh.tet_part - np.uint8(1),
        blocks.astype(np.uint32),
        materials,
        parts,
    )


_First = TypeVar("_First")
_Second = TypeVar("_Second")


def _numbered(
    name: str, first: Iterable[_First], second: Iterable[_Second]
) -> Iterator[tuple[str, _First, _Second]]:
    """Yield pairs, each with its place in the design."""
    for index, (one, other) in enumerate(zip(first, second, strict=True)):
        yield f"{name}[{index}]", one, other


def _say_where(parts: _core.ProblemParts | SectorParts, where: str) -> None:
    if isinstance(parts, SectorParts):
        parts.where = where


class _CoreLoads(LoadReceiver):
    """Receiver that adds loads to the core's problem."""

    def __init__(
        self,
        split: OtherSplit,
        parts: _core.ProblemParts | SectorParts,
        history: CoreHistory,
    ) -> None:
        super().__init__(split.mesh)
        self._split, self._parts, self._history = split, parts, history

    def acceleration(self, acceleration: NDArray[np.float64]) -> None:
        self._parts.gravity(acceleration.tolist(), self._history)

    def pressure(
        self, triangles: NDArray[np.int32], value: float, cavity: MeshCavity | None
    ) -> None:
        # Half the pressure on both splits at once is the mean of the two, and one load.
        if cavity is None:
            surfaces = [triangles, self._split.triangles(triangles)]
            voids = None
        else:
            surfaces = [each for each, _ in cavity.splits]
            parts = len(surfaces) * cavity.void_parts  # each void counts once
            voids = (cavity.void_tets.astype(np.uint32), parts)
        each = value / len(surfaces)
        found = np.concatenate(surfaces).astype(np.uint32)
        closed = cavity is not None
        self._parts.pressure(found, each, self._history, voids, closed)

    def traction(self, triangles: NDArray[np.int32], stress: NDArray[np.float64]) -> None:
        both = np.concatenate([triangles, self._split.triangles(triangles)])
        super().traction(both, 0.5 * stress)

    def forces(self, vertices: NDArray[np.uint32], forces: NDArray[np.float64]) -> None:
        self._parts.forces(vertices, forces, self._history)

    def depth_pressure(self, volume: DepthPressure) -> None:
        assert isinstance(self._parts, _core.ProblemParts)  # planes of symmetry refuse it
        # The liquid presses from outside: a pressure within that falls with depth does the same.
        self._parts.hydrostatic(
            volume.triangles.astype(np.uint32),
            [0.0, 0.0, volume.slope],
            [0.0, 0.0, volume.level],
            self._history,
            (volume.tets.astype(np.uint32), volume.parts),
        )

    def drag(self, drag: SurfaceDrag) -> None:
        assert isinstance(self._parts, _core.ProblemParts)  # planes of symmetry refuse it
        surface = drag.surface
        self._parts.drag(
            surface.triangles,
            [drag.density, drag.normal, drag.tangential, drag.linear],
            drag.flow.tolist(),
            surface.share,
            self._history,
            surface.skin,
            surface.first,
        )

    def field(self, field: FieldAcceleration) -> None:
        assert isinstance(self._parts, _core.ProblemParts)  # planes of symmetry refuse it
        times, factors = self._history or ([0.0], [1.0])
        history = (times, [field.value * factor for factor in factors])
        vertices = np.arange(len(self.mesh.vertices), dtype=np.uint32)
        self._parts.force_field(vertices, field.formulas, history)
