"""From a design to the body that the page shows and the engine moves."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft._memory import gigabytes, memory_limit
from voxsoft.design import Design, Probe
from voxsoft.design.attachment import attachments_of
from voxsoft.design.discretization.discretize import Filled, filled, voxels_of
from voxsoft.design.load import scaled
from voxsoft.errors import MeshError, ShapeError, VoxSoftError
from voxsoft.mesh import Mesh
from voxsoft.shapes.sampling import corners_of
from voxsoft.simulation import Setup
from voxsoft.simulation.checks.check import CheckReport, examine
from voxsoft.simulation.compatibility import sentences_of_refusals
from voxsoft.simulation.loads import read
from voxsoft.simulation.setup.contact import has_contact
from voxsoft.simulation.setup.large_voxels import evenly_small
from voxsoft.simulation.solving.choice import method_of
from voxsoft.studio.bodies.bonds import bonds_of
from voxsoft.studio.bodies.equilibrium import finding_of
from voxsoft.studio.bodies.objects import not_live, objects_of, touches_live
from voxsoft.studio.bodies.surface import Surface
from voxsoft.studio.bodies.tendons import pulled, tendon_attachments, tendon_loads
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.message import Triple
from voxsoft.units import KINDS, Point, format_quantity, parse
from voxsoft.voxels import Voxels

#: Bytes that a voxel takes with its mesh, its problem and its stepper; measured on blocks of 8,000
#: and 64,000 voxels, and rounded up.
BYTES_PER_VOXEL: Final = 6_000
#: The part of the free memory that one body may take.
SHARE_OF_MEMORY: Final = 0.5
#: Cells of the grid of a look at a body that may be too large.
CELLS_OF_A_LOOK: Final = 1_000_000
#: Colors of parts, distinct also for color-blind eyes (Okabe and Ito), lightened.
PART_COLORS: Final = ("#e8b88a", "#8ab8dc", "#7fc8a9", "#d9a3c4", "#e6d27a", "#b9b9c9")
#: Points of a clamp that are drawn.
_SHOWN_POINTS: Final = 400


@dataclass(frozen=True, eq=False)
class StudioBody:
    """A design, meshed and ready to be shown.

    Attributes
    ----------
    topology
        Number of this body; frames name it.
    rev
        Revision of the document that it was made of.
    setup, surface
        The mesh of the design for the solver, and its drawn surface.
    voxels
        Voxels of each body by its name; of a design without bodies, by an empty one.
    lost
        Volume of the material that found no voxel [m³].
    refusal
        Reason why it cannot be solved, or None.
    seconds
        Time that its making took.
    """

    topology: int
    rev: int
    setup: Setup = field(repr=False)
    voxels: Mapping[str, Voxels] = field(repr=False)
    surface: Surface = field(repr=False)
    lost: float
    refusal: VoxSoftError | None
    seconds: float

    @classmethod
    def of(cls, design: Design, rev: int, topology: int) -> StudioBody:
        """Mesh a design; a design that only cannot be solved is shown all the same.

        Raises
        ------
        VoxSoftError
            It cannot be meshed, or would need more memory than there is.
        """
        started = time.perf_counter()
        design = design.assembled
        cells = filled_within_memory(design)
        setup = Setup(design, cells.mesh())
        surface = Surface.of(setup.mesh)
        refusal: VoxSoftError | None = None
        try:
            method = method_of(design, design.solver)
            setup.check(allow_loose=not method.to_rest)
            _ = setup.problem, setup.problem_alone
        except VoxSoftError as error:
            refusal = error
        seconds = time.perf_counter() - started
        return cls(
            topology, rev, setup, cells.voxels_by_body, surface, cells.lost, refusal, seconds
        )

    @property
    def voxel_count(self) -> int:
        """Number of voxels of all bodies; 0 where the body is the mesh of a file."""
        return sum(voxels.count for voxels in self.voxels.values())

    @property
    def mesh(self) -> Mesh:
        """The tetrahedra."""
        return self.setup.mesh

    @cached_property
    def loads(self) -> list[events.BodyLoad]:
        """Each load with the range of its slider."""
        own = [_load(self.setup, index) for index in range(len(self.setup.design.loads))]
        return own + tendon_loads(self.setup)

    @property
    def load_values(self) -> list[float]:
        """Size of each load in the end, SI."""
        return [load.value for load in self.loads]

    @cached_property
    def objects(self) -> list[events.BodyObject]:
        """The rigid objects beside it."""
        return objects_of(self.setup)

    @cached_property
    def bonds(self) -> list[events.BodyBond]:
        """Marks of bonded surfaces."""
        return bonds_of(self.setup)

    @property
    def not_live(self) -> str:
        """Why time does not run, or an empty text."""
        return not_live(self.setup)

    @property
    def played(self) -> _core.Problem:
        """The problem as it moves live: with its contact, where that is found live."""
        setup = self.setup
        if setup.design.refine:
            setup = Setup(evenly_small(setup.design, setup.design.solver.refine), self.mesh)
        return setup.problem if touches_live(setup) else setup.problem_alone

    def under(self, factors: Sequence[float]) -> Setup:
        """Return the body with each load, and each tendon after them, scaled by a factor."""
        if all(factor == 1.0 for factor in factors):
            return self.setup
        design = self.setup.design
        loads = tuple(
            scaled(load, factor) for load, factor in zip(design.loads, factors, strict=False)
        )
        tendons = pulled(self.setup, factors[len(loads) :])
        return Setup(design.replace(loads=loads, tendons=tendons), self.mesh)

    def report(self) -> CheckReport:
        """Report of the checks; slower than the mesh itself."""
        setup = self.setup
        return examine(setup.design, self.voxels, self.mesh, self.lost, setup)

    def event(self, report: CheckReport | None = None) -> events.Body:
        """All that the page is told; without a report there are no findings and leaks yet."""
        mesh, setup = self.mesh, self.setup
        rest = mesh.vertices
        problems = () if self.refusal is None else self.refusal.problems
        findings = [
            events.Finding(severity="error", where=p.where, what=p.what, hint=p.hint)
            for p in problems
        ]
        if report is not None:
            findings = [finding_of(found) for found in report.findings]
        problem = setup.problem if self.refusal is None else None
        return events.Body(
            topology=self.topology,
            rev=self.rev,
            voxels=self.voxel_count,
            vertices=len(rest),
            tets=len(mesh.tets),
            surface_vertices=len(self.surface.vertices),
            triangles=len(mesh.triangles),
            voxel_size=mesh.voxel_size or 0.0,
            cavities=[
                events.Cavity(
                    name=cavity.name,
                    volume=float(cavity.volume),
                    area=float(cavity.area),
                    center=_point(rest[np.unique(cavity.triangles)].mean(axis=0)),
                )
                for cavity in mesh.cavities
            ],
            leaks=[] if report is None else _leaks(report),
            mass=None if problem is None else problem.mass,
            volume=mesh.volume,
            bounds=(_point(rest.min(axis=0)), _point(rest.max(axis=0))),
            findings=findings,
            clamps=_clamps(setup),
            loads=self.loads,
            probes=self._probes(),
            parts=_parts(setup.design),
            layers=_layers(setup, self.surface),
            attachments=_attachments(setup, self.surface) + tendon_attachments(setup, self.surface),
            objects=self.objects,
            not_live=self.not_live,
            touches=has_contact(setup.design),
            seconds=self.seconds,
            memory=len(mesh.tets) / 5 * BYTES_PER_VOXEL,
            cut=mesh.fractions is not None,
            bodies=_bodies(mesh, self.surface),
            planes=[
                events.BodyPlane(axis=plane.axis, at=plane.at) for plane in setup.design.symmetry
            ],
            floor=None if setup.design.floor is None else setup.design.floor.z,
            bonds=self.bonds,
            refused=sentences_of_refusals(setup.design),
        )

    def _probes(self) -> list[events.BodyProbe]:
        try:
            places = self.setup.places
        except VoxSoftError:
            return []
        rest = self.mesh.vertices
        return [
            events.BodyProbe(
                name=name,
                center=_point(place.weights @ rest[place.vertices]),
                vertices=self.surface.index_of(place.vertices).tolist(),
            )
            for name, place in places.items()
        ]


def filled_within_memory(design: Design) -> Filled:
    """Put a design, with all its bodies, on its grid, within the memory that is free.

    Raises
    ------
    VoxSoftError
        It would need more, or cannot be put on a grid.
    """
    for name in design.body_names if design.mesh is None else ():
        _refuse_far_too_large(design.alone(name))
    cells = filled(design, design.solver.refine)
    _refuse_too_large(cells.count)
    return cells


def _refuse_far_too_large(design: Design) -> None:
    """Refuse a far too large design, seen with larger voxels, before it takes memory.

    Thin walls may be lost to such a look, and others counted too thick by a voxel: a design within
    a factor of four is counted in full.
    """
    cells = 0
    for part in design.parts:
        shape = design.shapes[part.shape] if isinstance(part.shape, str) else part.shape
        low, high = corners_of(shape, None, design.shapes)
        sides = (math.ceil((b - a) / design.voxel_size) for a, b in zip(low, high, strict=True))
        cells += math.prod(sides)
    coarser = math.ceil((cells / CELLS_OF_A_LOOK) ** (1 / 3))
    if coarser < 2:
        return
    with suppress(ShapeError):  # nothing is left of the body: the full count tells
        look = design.replace(voxel_size=coarser * design.voxel_size)
        _refuse_too_large(voxels_of(look).count * coarser**3, within=4.0)


def _refuse_too_large(voxels: int, within: float = 1.0) -> None:
    due, free = voxels * BYTES_PER_VOXEL, memory_limit()
    if due > within * SHARE_OF_MEMORY * free:
        about = "" if within == 1.0 else "some "
        raise MeshError(
            "voxel_size",
            f"{about}{voxels:,} voxels would need about {gigabytes(due)} of memory; "
            f"{gigabytes(free)} are free",
            "make the voxels larger",
        )


def _clamps(setup: Setup) -> list[events.BodyClamp]:
    try:
        clamped = setup.clamped
    except VoxSoftError:
        return []
    found = []
    for index, (clamp, vertices) in enumerate(zip(setup.design.clamps, clamped, strict=True)):
        points = setup.mesh.vertices[vertices]
        step = max(1, len(points) // _SHOWN_POINTS)
        moved = " (moved)" if clamp.motion is not None else ""
        axes = "" if clamp.axes == "xyz" else f" along {clamp.axes}"
        found.append(
            events.BodyClamp(
                name=f"clamp {index + 1}{axes}{moved}",
                vertices=len(points),
                center=_point(points.mean(axis=0)),
                points=[_point(point) for point in points[::step][:_SHOWN_POINTS]],
            )
        )
    return found


def _layers(setup: Setup, surface: Surface) -> list[events.BodyLayer]:
    try:
        found = setup.layers
    except VoxSoftError:
        return []
    reported = []
    drawn = np.full(len(setup.mesh.vertices), -1)
    drawn[surface.vertices] = np.arange(len(surface.vertices))
    for index, (layer, triangles) in enumerate(zip(setup.design.layers, found, strict=True)):
        # Those inside the body are not drawn, as its vertices there are not.
        shown = drawn[triangles.all]
        shown = shown[(shown >= 0).all(axis=1)]
        reported.append(
            events.BodyLayer(
                name=layer.name or f"layer {index + 1}",
                stiffness=layer.young * layer.thickness,
                center=_point(setup.mesh.vertices[np.unique(triangles.all)].mean(axis=0)),
                triangles=shown.ravel().tolist(),
            )
        )
    return reported


def _attachments(setup: Setup, surface: Surface) -> list[events.BodyAttachment]:
    found = []
    for where, attachment in attachments_of(setup.design):
        section, _, index = where.rstrip("]").partition("[")
        try:
            places = [_body_place(setup, surface, end, where) for end in attachment.places]
        except VoxSoftError:
            continue  # a finding of the check
        name = attachment.name or f"{section.removesuffix('s')} {int(index) + 1}"
        found.append(events.BodyAttachment(name=name, summary=attachment.summary, places=places))
    return found


def _body_place(setup: Setup, surface: Surface, end: Probe | Point, where: str) -> events.BodyPlace:
    if not isinstance(end, Probe):
        return events.BodyPlace(center=end, vertices=[])
    place = setup.place(end, where)
    center = setup.position(place)
    vertices = surface.index_of(place.vertices[place.weights > 1e-9])
    if len(vertices) == 0:  # inside the body: it goes with the nearest drawn vertices
        drawn = setup.mesh.vertices[surface.vertices]
        vertices = np.array([np.linalg.norm(drawn - center, axis=1).argmin()], dtype=np.uint32)
    return events.BodyPlace(center=_point(center), vertices=vertices.tolist())


def _load(setup: Setup, index: int) -> events.BodyLoad:
    load = read(setup.design.loads[index])
    at, direction = _place(setup, index)
    value, kind = load.size * load.final_factor, load.quantity
    unit = format_quantity(value, kind).partition(" ")[2] if value else ""
    unit = unit or next(iter(KINDS[kind].units), "")
    return events.BodyLoad(
        index=index,
        kind=load.kind,
        label=load.label,
        value=value,
        quantity=kind,
        unit=unit,
        factor=_factor(unit, kind),
        min=min(0.0, 2.0 * value),
        max=max(0.0, 2.0 * value) or 1.0,
        at=at,
        direction=direction,
    )


def _factor(unit: str, kind: str) -> float:
    return parse(f"1 {unit}", kind) if unit else 1.0


def _place(setup: Setup, index: int) -> tuple[Triple, Triple]:
    """Position and direction in which a load is drawn."""
    try:
        load = setup.load(index)
    except VoxSoftError:  # said among the findings
        return _point(setup.mesh.vertices.mean(axis=0)), (0.0, 0.0, 0.0)
    return _point(load.at), _point(load.direction)


def _parts(design: Design) -> list[events.BodyPart]:
    found = []
    for index, part in enumerate(design.parts):
        shape = part.shape if isinstance(part.shape, str) else part.shape.kind
        material = part.material if isinstance(part.material, str) else part.material.model
        color = PART_COLORS[index % len(PART_COLORS)]
        name, body = part.name or shape, part.body or ""
        found.append(events.BodyPart(name=name, material=material, color=color, body=body))
    return found


def _bodies(mesh: Mesh, surface: Surface) -> list[events.BodyOfSeveral]:
    found = []
    for body in mesh.bodies:
        of_body = body.vertices
        first, end = np.searchsorted(surface.vertices, (of_body.start, of_body.stop))
        rest = mesh.vertices[of_body]
        bounds = _point(rest.min(axis=0)), _point(rest.max(axis=0))
        own = events.BodyOfSeveral(
            name=body.name, bounds=bounds, vertices=(int(first), int(end) - 1)
        )
        found.append(own)
    return found


def _leaks(report: CheckReport) -> list[events.Leak]:
    pairs = zip(report.leaks, report.leak_points, strict=True)
    return [events.Leak(volume=float(leak.volume), point=point) for leak, point in pairs]


def _point(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(value) for value in values)
    return (x, y, z)
