"""Checks of a design or a body of voxels before it is solved.

Long because the report and its text stand beside the checks that fill it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from voxsoft._shown import Shown, counted, rounded, shortened
from voxsoft.design import Design, require_design
from voxsoft.design.discretization.discretize import filled
from voxsoft.design.discretization.joined import own_cavities
from voxsoft.design.region import Region
from voxsoft.errors import VoxSoftError
from voxsoft.formats.report import ReadReport
from voxsoft.materials import SILICONE_DENSITY, Hyperelastic
from voxsoft.mesh import BodyMesh, Mesh
from voxsoft.simulation.checks.anchors import weak_anchors
from voxsoft.simulation.checks.coarse_walls import coarse_walls
from voxsoft.simulation.checks.file_tets import cavities_of_tets, findings_of_tets
from voxsoft.simulation.checks.plausible import implausible_numbers
from voxsoft.simulation.checks.relaxed import relaxed_parts
from voxsoft.simulation.checks.surfaces import doubtful_surfaces
from voxsoft.simulation.checks.thickness import doubtful_thickness
from voxsoft.simulation.checks.thin_seals import thin_seals
from voxsoft.simulation.checks.unheld import unheld
from voxsoft.simulation.checks.vanished import vanished_shapes
from voxsoft.simulation.diagnostic import Diagnostic, near
from voxsoft.simulation.setup.chambers import ambiguous_indices
from voxsoft.simulation.setup.layers import LayerTriangles, chambers, layers_on
from voxsoft.simulation.setup.setup import Setup
from voxsoft.simulation.setup.volumes import PRECISE, Volumes, doubtful_volumes, volumes_of
from voxsoft.simulation.solving.choice import kind_of, unused_settings
from voxsoft.simulation.solving.cost import Cost, cost_of
from voxsoft.units import format_quantity
from voxsoft.voxels import Cavity, Leak, Voxels, Wall
from voxsoft.voxels.regions import Cell

#: Smallest thickness of a wall that bends correctly, in voxels.
GOOD_WALL = 2

Point = tuple[float, float, float]

# Bytes of the core's tables for one constraint, as measured.
_BYTES_PER_CONSTRAINT = 120
# Share of the material that may be lost without a warning.
_LOST = 1e-3
# A place of a design that is a region: "probes.top", "clamps[0].region".
_OF_A_REGION: Final = re.compile(r"(?P<section>probes|clamps|loads|layers)[.\[](?P<name>[^.\[\]]+)")
# Largest number of components and leaks that are listed.
_LISTED = 5


@dataclass(frozen=True, repr=False)
class CheckReport(Shown):
    """Findings of :func:`check`, with sizes and expected costs.

    Attributes
    ----------
    findings
        Errors and warnings, errors first.
    voxels, vertices, tets
        Sizes of the mesh.
    cavities, leaks
        Enclosed chambers, and chambers that are open somewhere.
    chambers
        Name of each cavity in the design; an empty text where it has none.
    mass
        Mass [kg]; None for a design that cannot be prepared.
    thinnest_wall
        Thickness of the thinnest wall, in voxels; None for an empty body.
    cost
        Predicted seconds of one run by the design's solver; None for voxels, and for a design
        without a :class:`Setup`.
    memory
        Memory of the solver, an order of magnitude [bytes].
    leak_points
        Position of the first opening of each leak [m].
    volumes
        Volumes of parts and cavities, as simulated and as described; empty for voxels without a
        design.
    phases
        Phase of the grid of each body [m], by the body's name.
    bodies
        Number of voxels of each body by its name, where there are several; messages then give
        places in the frame of the body.
    file
        Report of reading the body's file, its contents beside the parts used; None for shapes.
    """

    findings: tuple[Diagnostic, ...]
    voxels: int = 0
    vertices: int = 0
    tets: int = 0
    cavities: tuple[Cavity, ...] = field(default=(), repr=False)
    leaks: tuple[Leak, ...] = field(default=(), repr=False)
    chambers: tuple[str, ...] = ()
    mass: float | None = None
    thinnest_wall: int | None = None
    cost: Cost | None = None
    memory: float = 0.0
    bodies: Mapping[str, int] = field(default_factory=dict)
    leak_points: tuple[Point, ...] = field(default=(), repr=False)
    volumes: Volumes = field(default_factory=Volumes, repr=False)
    phases: Mapping[str, Point] = field(default_factory=dict, repr=False)
    file: ReadReport | None = field(default=None, repr=False)

    @property
    def valid(self) -> bool:
        """True if there is no error; warnings are allowed."""
        return not any(finding.severity == "error" for finding in self.findings)

    def _named_cavities(self) -> Iterator[tuple[str, Cavity]]:
        names = self.chambers or ("",) * len(self.cavities)
        yield from zip(names, self.cavities, strict=True)

    def _lines(self) -> Iterator[str]:
        errors = sum(finding.severity == "error" for finding in self.findings)
        reported = [
            counted(n, w)
            for n, w in ((errors, "error"), (len(self.findings) - errors, "warning"))
            if n
        ]
        yield ", ".join(["valid" if self.valid else "not valid", *reported])
        mass = self.mass
        weight = "" if mass is None else f", mass {format_quantity(rounded(mass), 'mass')}"
        yield f"{counted(self.voxels, 'voxel')}{weight}"
        yield from (f"body {name}: {counted(n, 'voxel')}" for name, n in self.bodies.items())
        for name, cavity in self._named_cavities():
            called = f"chamber {name}" if name else "cavity"
            yield f"{called} of {format_quantity(rounded(cavity.volume), 'volume')}"
        if self.file is not None:
            yield from str(self.file).splitlines()
        yield from shortened([f"{found.severity}: {found}" for found in self.findings])

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (the ``--json`` of ``check``)."""
        return {
            "valid": self.valid,
            "problems": [finding.summary() for finding in self.findings],
            "voxels": self.voxels,
            "vertices": self.vertices,
            "tets": self.tets,
            "cavities": [
                {
                    "name": name,
                    "volume": cavity.volume,
                    "area": cavity.area,
                    "bounds": cavity.bounds.tolist(),
                    "leaks": [],
                }
                for name, cavity in self._named_cavities()
            ]
            + [
                {"volume": leak.volume, "leaks": [list(cell) for cell in leak.openings]}
                for leak in self.leaks
            ],
            "mass": self.mass,
            "thinnest_wall": self.thinnest_wall,
            "seconds": None if self.cost is None else self.cost.seconds,
            "seconds_range": None if self.cost is None else [self.cost.low, self.cost.high],
            "memory": self.memory,
            "bodies": [
                {"name": name, "voxels": n, "phase": list(self.phases[name])}
                for name, n in self.bodies.items()
            ],
            "phase": list(next(iter(self.phases.values()))) if len(self.phases) == 1 else None,
            "volumes": self.volumes.summary(),
            "file": None if self.file is None else self.file.summary(),
        }


def check(body: Design | Voxels) -> CheckReport:
    """Examine a design, or a body of voxels without loads.

    Parameters
    ----------
    body
        A design is checked for everything that would stop or spoil its simulation; voxels for
        components, hinges, leaks and walls.

    Returns
    -------
    CheckReport
        Never raises for a bad design: its errors are in the findings.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> report = check(families.beam())
    >>> report.valid, report.voxels, report.thinnest_wall
    (True, 80, 2)
    """
    if not isinstance(body, Voxels):
        body = require_design(body, "body").assembled
    try:
        voxels, mesh, lost = _discretized(body)
    except VoxSoftError as error:
        return CheckReport(tuple(_errors(error, body)))
    return examine(body, voxels, mesh, lost)


def examine(
    body: Design | Voxels,
    voxels: Mapping[str, Voxels],
    mesh: Mesh,
    lost: float = 0.0,
    setup: Setup | None = None,
) -> CheckReport:
    """Examine a body that is meshed already, as :func:`check` does.

    Parameters
    ----------
    body
        The design or the voxels that were meshed.
    voxels, mesh
        The voxels of each of its bodies by name, none of a body that is the mesh of a file, and
        their mesh.
    lost
        Volume of the material that fills no voxel [m³].
    setup
        The prepared design, where it is known.
    """
    findings = _findings_of_loss(lost, mesh)
    mass = mesh.volume * SILICONE_DENSITY
    each = [
        _ExaminedBody(of, voxels[of.name], _alone(body, of), of.mesh, ())
        for of in mesh.each_body
        if of.name in voxels
    ]
    ready = not isinstance(body, Design)
    is_held, elements = False, len(mesh.tets) // 5
    if isinstance(body, Design):
        try:
            setup = setup or Setup(body, mesh)
            each = [one.closed(setup) for one in each]
            setup.check()
            elements = setup.elements
            is_held = setup.loose_piece is None
            mass, ready = setup.problem.mass, True
            findings += weak_anchors(setup)
            findings += unheld(setup)
        except VoxSoftError as error:
            findings += [_placed(found, body, mesh) for found in _errors(error, body)]
        findings += [*doubtful_surfaces(body), *doubtful_thickness(body, mesh)]
        findings += doubtful_volumes(body, mesh, points=PRECISE)
        findings += [*coarse_walls(body, mesh), *vanished_shapes(body)]
        findings += _findings_of_settings(body)
        findings += [Diagnostic("warning", *problem) for problem in body.left_out]
        if kind_of(body, body.solver).to_rest:
            findings += relaxed_parts(body)
    if isinstance(body, Design) and setup is not None:
        findings += ambiguous_indices(body, setup.mesh)
    findings += thin_seals(None, mesh if setup is None else setup.mesh)
    findings += implausible_numbers(body, mesh, mass)
    for one in each:
        findings += one.findings(is_held)
    findings += _findings_of_mesh(mesh)
    constraints = len(mesh.edges) + len(mesh.tets)
    walls = [(wall.thickness, one) for one in each if (wall := _thinnest_wall(one.voxels))]
    thinnest = min((thickness for thickness, _ in walls), default=None)
    cost = None
    if isinstance(body, Design) and setup is not None:
        lengths = [thickness * one.voxels.voxel_size for thickness, one in walls]
        share = elements / (len(mesh.tets) // 5 or 1)
        cost = cost_of(body, setup.mesh, min(lengths, default=None), mass, share)
    cavities = [cavity for one in each for cavity in one.cavities]
    if not each:
        cavities = cavities_of_tets(mesh)
        findings += findings_of_tets(body, mesh)
    refined = isinstance(body, Design) and bool(body.refine)
    return CheckReport(
        findings=tuple(sorted(findings, key=lambda finding: finding.severity)),
        voxels=elements if refined else sum(one.voxels.count for one in each),
        vertices=len(mesh.vertices),
        tets=len(mesh.tets),
        file=mesh.report,
        cavities=tuple(sorted(cavities, key=lambda cavity: -cavity.volume)),
        leaks=tuple(leak for one in each for leak in one.leaks),
        chambers=() if setup is None else tuple(each.name for each in setup.mesh.cavities),
        mass=mass if ready else None,
        thinnest_wall=thinnest,
        cost=cost,
        memory=float(constraints * _BYTES_PER_CONSTRAINT),
        bodies={one.of.name: one.voxels.count for one in each if mesh.bodies},
        volumes=_volumes(body, mesh),
        phases={one.of.name: one.voxels.phase for one in each},
        leak_points=tuple(
            one.placed(_middle(one.voxels, leak.openings[0])) for one in each for leak in one.leaks
        ),
    )


def _volumes(body: Design | Voxels, mesh: Mesh) -> Volumes:
    try:
        return volumes_of(body, mesh) if isinstance(body, Design) else Volumes()
    except VoxSoftError:
        return Volumes()  # a shape without a value somewhere is a finding of its own


def _discretized(body: Design | Voxels) -> tuple[Mapping[str, Voxels], Mesh, float]:
    """Return voxels by body, their mesh, and the volume [m³] of material that fills no voxel."""
    if not isinstance(body, Design):
        return {"": body}, body.mesh(), 0.0
    cells = filled(body)
    return cells.voxels_by_body, cells.mesh(), cells.lost


def _errors(error: VoxSoftError, body: Design | Voxels) -> Iterator[Diagnostic]:
    for problem in error.problems:
        where = body.origin_of(problem.where) if isinstance(body, Design) else problem.where
        yield Diagnostic("error", where, problem.what, problem.hint)


def _alone(body: Design | Voxels, of: BodyMesh) -> Design | Voxels:
    return body.alone(of.name) if isinstance(body, Design) else body


@dataclass(frozen=True)
class _ExaminedBody:
    """One body: its voxels, its design, its own mesh with the cavities that layers close."""

    of: BodyMesh
    voxels: Voxels
    design: Design | Voxels
    mesh: Mesh
    layers: tuple[LayerTriangles, ...]

    def closed(self, setup: Setup) -> _ExaminedBody:
        """Close the body by those layers of the whole that are on it."""
        own = own_cavities(setup.mesh, self.of)
        layers = layers_on(self.of, setup.layers)
        return replace(self, mesh=replace(self.of.mesh, cavities=own), layers=layers)

    @property
    def cavities(self) -> tuple[Cavity, ...]:
        return self._closed_by_layers[0]

    @property
    def leaks(self) -> tuple[Leak, ...]:
        return self._closed_by_layers[1]

    @cached_property
    def _closed_by_layers(self) -> tuple[tuple[Cavity, ...], tuple[Leak, ...]]:
        return _closed_by_layers(self.mesh, self.layers, self.voxels)

    def findings(self, is_held: bool) -> Iterator[Diagnostic]:
        """Find faults of its voxels; the findings name the body where it has a name."""
        for found in _findings_of_voxels(self.design, self.voxels, self.leaks, is_held):
            if not self.of.name:
                yield found
                continue
            at = None if found.at is None else self.placed(found.at)
            yield replace(found, where=f'body "{self.of.name}", {found.where}', at=at)

    def placed(self, point: Point) -> Point:
        """Transform a point [m] from its frame to that of the design."""
        x, y, z = self.of.placed(np.array([point]))[0].tolist()
        return x, y, z


def _placed(found: Diagnostic, design: Design, mesh: Mesh) -> Diagnostic:
    """Return a finding with the position of the region that it is about, if any."""
    match = _OF_A_REGION.match(found.where)
    if match is None or mesh.bodies:
        return found
    section, name = match["section"], match["name"]
    owner: Any = getattr(design, section)
    owner = owner[name] if section == "probes" else owner[int(name)]
    region = owner if section == "probes" else getattr(owner, "region", None)
    return found if region is None else replace(found, at=_middle_of(region, mesh))


def _middle_of(region: Region, mesh: Mesh) -> tuple[float, float, float]:
    """Return the point of a region, or its middle within the body's bounding box [m]."""
    point = getattr(region, "point", None) or region.center
    if point is not None:
        x, y, z = point
        return (float(x), float(y), float(z))
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    for axis, bounds in enumerate((region.x, region.y, region.z)):
        if bounds is not None:
            low[axis], high[axis] = np.clip((low[axis], high[axis]), *bounds)
    x, y, z = (low + high) / 2
    return (float(x), float(y), float(z))


def _cavities(voxels: Voxels, mesh: Mesh) -> tuple[Cavity, ...]:
    """Return the cavities of the voxels with the volumes of the mesh, which counts voids."""
    pairs = zip(voxels.cavities, mesh.cavities, strict=True)
    return tuple(replace(cavity, volume=float(surface.volume)) for cavity, surface in pairs)


def _findings_of_loss(lost: float, mesh: Mesh) -> list[Diagnostic]:
    if lost <= _LOST * mesh.volume:
        return []
    share = lost / (lost + mesh.volume)
    what = f"{share:.1%} of the material is in walls too thin to fill a voxel, and is left out"
    return [Diagnostic("warning", "parts", what, "make the voxels smaller")]


def _closed_by_layers(
    mesh: Mesh, layers: tuple[LayerTriangles, ...], voxels: Voxels
) -> tuple[tuple[Cavity, ...], tuple[Leak, ...]]:
    """Find cavities and leaks of a body whose layers close the openings that they span."""
    if not any(len(layer.openings) for layer in layers):
        return _cavities(voxels, mesh), voxels.leaks
    size, origin = voxels.voxel_size, np.asarray(voxels.origin)
    shift = np.rint((mesh.vertices.min(axis=0) - origin) / size).astype(np.int64)
    cavities = []
    closed: set[tuple[int, ...]] = set()
    for chamber in chambers(mesh, layers):
        cells = chamber.cells + shift
        closed.update(map(tuple, cells.tolist()))
        runs = np.column_stack([cells, cells[:, 2]]).astype(np.int32)  # each a run of one cell
        bounds = origin + size * np.stack([cells.min(axis=0), cells.max(axis=0) + 1])
        surface = chamber.surface
        cavities.append(Cavity(runs, len(cells), surface.volume, bounds, surface.area))
    leaks = [leak for leak in voxels.leaks if tuple(leak.cells[0].tolist()) not in closed]
    return tuple(cavities), tuple(leaks)


def _findings_of_settings(design: Design) -> Iterator[Diagnostic]:
    for problem in unused_settings(design, design.solver):
        yield Diagnostic("error", problem.where, problem.what, problem.hint)


def _findings_of_voxels(
    body: Design | Voxels, voxels: Voxels, leaks: tuple[Leak, ...], is_held: bool
) -> Iterator[Diagnostic]:
    if voxels.hinges:
        yield _finding_of_hinges(voxels)
    components = voxels.components("face")
    if len(components) > 1 and not is_held:
        sizes = ", ".join(f"{component.count:,}" for component in components[:_LISTED])
        yield Diagnostic(
            "warning",
            "voxels",
            f"the body is in {len(components)} components of {sizes} voxels"
            + (" and more" if len(components) > _LISTED else ""),
            "join them by whole faces of voxels, or clamp each of them",
            _middle(voxels, tuple(components[-1].cells[0].tolist())),
        )
    for leak in leaks[:_LISTED]:
        cells = ", ".join(str(cell) for cell in leak.openings[:3])
        at = _middle(voxels, leak.openings[0])
        yield Diagnostic(
            "warning",
            f"voxel {leak.openings[0]}",
            f"a chamber of {leak.volume * 1e6:.3g} mL is open through {cells}, {near(at)}",
            "close the opening by a voxel, unless it is meant to be open",
            at,
        )
    thinnest = _thinnest_wall(voxels)
    if thinnest is not None and thinnest.thickness < GOOD_WALL and _locks(body, voxels, thinnest):
        at = _middle(voxels, thinnest.cell)
        yield Diagnostic(
            "warning",
            f"voxel {thinnest.cell}",
            f"the wall is {thinnest.thickness} voxel thick {near(at)} and bends too stiffly",
            f"make the voxels smaller: {GOOD_WALL} or more across a wall",
            at,
        )


def _finding_of_hinges(voxels: Voxels) -> Diagnostic:
    """Report all hinges in one finding: a line of them is one fault."""
    first, *others = voxels.hinges
    at = _middle(voxels, *first.cells)
    contact = "an edge" if first.contact == "edge" else "a corner"
    what = f"touch at {contact} only, a hinge, {near(at)}"
    if others:
        what = f"{what}, and {counted(len(others), 'more hinge')} in other places"
    hint = "thicken the body there by a voxel, or make the voxels smaller"
    return Diagnostic("warning", f"voxels {first.cells[0]} and {first.cells[1]}", what, hint, at)


def _middle(voxels: Voxels, *cells: Cell) -> tuple[float, float, float]:
    """The middle of some cells of a grid [m]."""
    middle = np.asarray(cells, dtype=np.float64).mean(axis=0) + 0.5
    x, y, z = np.asarray(voxels.origin) + voxels.voxel_size * middle
    return (float(x), float(y), float(z))


def _locks(body: Design | Voxels, voxels: Voxels, wall: Wall) -> bool:
    """Return True if a wall of one voxel locks, as five tetrahedra of a lattice do.

    A voxel of rubber bends as it should (docs/method/elements.md). The walls of the pneunet family,
    one voxel thick, leave its tip 6 % short of where walls of two voxels bring it, no more than the
    same voxels miss elsewhere.
    """
    if isinstance(body, Voxels):
        return True
    part = body.parts[int(voxels.array[wall.cell]) - 1]
    return not isinstance(body.material_of(part), Hyperelastic)


def _thinnest_wall(voxels: Voxels) -> Wall | None:
    """The thinnest wall of a cavity, or of the body where there is no cavity."""
    walls = sorted(voxels.cavity_walls, key=lambda wall: wall.thickness)
    return walls[0] if walls else voxels.wall_thickness.thinnest


def _findings_of_mesh(mesh: Mesh) -> Iterator[Diagnostic]:
    quality = mesh.quality
    if not quality.conforming or quality.smallest_tet <= 0.0:
        yield Diagnostic(
            "error",
            "mesh",
            "is not conforming, or holds a tetrahedron without volume",
            "report this with the design: no shape should do that",
        )
