"""The doctor: what would go wrong with a design or a body of voxels, found before it is solved."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np

from voxsoft.design import Design
from voxsoft.design.cut_voxels import CutVoxels
from voxsoft.design.discretize import voxels_of
from voxsoft.errors import VoxSoftError
from voxsoft.materials import SILICONE_DENSITY
from voxsoft.mesh import Mesh
from voxsoft.shapes import TriangleMesh
from voxsoft.simulation.layers import chambers
from voxsoft.simulation.setup import Setup
from voxsoft.voxels import Cavity, Leak, Voxels, Wall

Severity = Literal["error", "warning"]

#: Walls bend as they should from two voxels of thickness on.
GOOD_WALL = 2

# Measured on one core of a 2.4 GHz server: time for one constraint and step of relaxation, and
# bytes of the core's tables for one constraint.
_SECONDS_PER_CONSTRAINT_STEP = 2e-8
_BYTES_PER_CONSTRAINT = 120
# Less material than this part may vanish without a word.
_LOST = 1e-3
# Voxels and their hinges are listed by name up to this number.
_LISTED = 5


@dataclass(frozen=True)
class Finding:
    """Something wrong (``error``) or doubtful (``warning``), where it is, and what to try."""

    severity: Severity
    where: str
    what: str
    hint: str


@dataclass(frozen=True)
class CheckReport:
    """What :func:`check` found.

    Attributes
    ----------
    findings
        Errors and warnings, errors first.
    voxels, vertices, tets
        Sizes of the mesh.
    cavities, leaks
        Enclosed chambers, and chambers that are open somewhere.
    mass
        In kg.
    thinnest_wall
        In voxels; None for an empty body.
    seconds, memory
        What one run to rest is likely to take: an order of magnitude.
    """

    findings: tuple[Finding, ...]
    voxels: int = 0
    vertices: int = 0
    tets: int = 0
    cavities: tuple[Cavity, ...] = field(default=(), repr=False)
    leaks: tuple[Leak, ...] = field(default=(), repr=False)
    mass: float = 0.0
    thinnest_wall: int | None = None
    seconds: float = 0.0
    memory: float = 0.0

    @property
    def valid(self) -> bool:
        """Whether there is no error; warnings are allowed."""
        return not any(finding.severity == "error" for finding in self.findings)

    def summary(self) -> dict[str, Any]:
        """Everything as plain data in SI units (the ``--json`` of ``check``)."""
        return {
            "valid": self.valid,
            "problems": [
                {"severity": f.severity, "where": f.where, "what": f.what, "try": f.hint}
                for f in self.findings
            ],
            "voxels": self.voxels,
            "vertices": self.vertices,
            "tets": self.tets,
            "cavities": [
                {"volume": c.volume, "area": c.area, "bounds": c.bounds.tolist(), "leaks": []}
                for c in self.cavities
            ]
            + [
                {"volume": leak.volume, "leaks": [list(cell) for cell in leak.openings]}
                for leak in self.leaks
            ],
            "mass": self.mass,
            "thinnest_wall": self.thinnest_wall,
            "seconds": self.seconds,
            "memory": self.memory,
        }


def check(body: Design | Voxels) -> CheckReport:
    """Examine a design, or a body of voxels without loads.

    Parameters
    ----------
    body
        A design is checked for everything that would stop or spoil its simulation; voxels for
        pieces, hinges, leaks and walls.

    Returns
    -------
    CheckReport
        Never raises for a bad design: what is wrong is in the findings.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> report = check(families.beam())
    >>> report.valid, report.voxels, report.thinnest_wall
    (True, 80, 2)
    """
    try:
        voxels, mesh, lost = _discretized(body)
    except VoxSoftError as error:
        return CheckReport(tuple(_errors(error)))
    return examine(body, voxels, mesh, lost)


def examine(
    body: Design | Voxels, voxels: Voxels, mesh: Mesh, lost: float = 0.0, setup: Setup | None = None
) -> CheckReport:
    """Do what :func:`check` does for a body that is meshed already.

    Parameters
    ----------
    body
        What was meshed.
    voxels, mesh
        Its voxels, and their mesh.
    lost
        Volume of the material that found no voxel [m³].
    setup
        The design made ready, where it is known.
    """
    findings = _findings_of_loss(lost, mesh)
    mass = mesh.volume * SILICONE_DENSITY
    cavities, leaks = _cavities(voxels, mesh), voxels.leaks
    if isinstance(body, Design):
        try:
            setup = setup or Setup(body, mesh)
            cavities, leaks = _closed_by_layers(setup, voxels)
            setup.check()
            mass = setup.problem.mass
        except VoxSoftError as error:
            findings += _errors(error)
        findings += _findings_of_surfaces(body)
    findings += [*_findings_of_voxels(voxels, leaks), *_findings_of_mesh(mesh)]
    constraints = len(mesh.edges) + len(mesh.tets)
    thinnest = _thinnest_wall(voxels)
    return CheckReport(
        findings=tuple(sorted(findings, key=lambda finding: finding.severity)),
        voxels=voxels.count,
        vertices=len(mesh.vertices),
        tets=len(mesh.tets),
        cavities=cavities,
        leaks=leaks,
        mass=mass,
        thinnest_wall=None if thinnest is None else thinnest.thickness,
        seconds=constraints * _steps_to_rest(voxels) * _SECONDS_PER_CONSTRAINT_STEP,
        memory=float(constraints * _BYTES_PER_CONSTRAINT),
    )


def _discretized(body: Design | Voxels) -> tuple[Voxels, Mesh, float]:
    """Voxels, their mesh, and the volume [m³] of material that found no voxel."""
    if isinstance(body, Design) and body.fill == "fraction":
        cut = CutVoxels.of(body)
        return cut.voxels, cut.mesh(), cut.lost
    voxels = voxels_of(body) if isinstance(body, Design) else body
    return voxels, voxels.mesh(), 0.0


def _errors(error: VoxSoftError) -> Iterator[Finding]:
    for problem in error.problems:
        yield Finding("error", problem.where, problem.what, problem.hint)


def _cavities(voxels: Voxels, mesh: Mesh) -> tuple[Cavity, ...]:
    """The cavities of the voxels with the volumes of the mesh, which knows of voids."""
    pairs = zip(voxels.cavities, mesh.cavities, strict=True)
    return tuple(replace(cavity, volume=float(surface.volume)) for cavity, surface in pairs)


def _findings_of_loss(lost: float, mesh: Mesh) -> list[Finding]:
    if lost <= _LOST * mesh.volume:
        return []
    share = lost / (lost + mesh.volume)
    what = f"{share:.1%} of the material is in walls too thin to fill a voxel, and is left out"
    return [Finding("warning", "parts", what, "make the voxels smaller")]


def _closed_by_layers(setup: Setup, voxels: Voxels) -> tuple[tuple[Cavity, ...], tuple[Leak, ...]]:
    """Cavities and leaks once the layers of a design close what they span."""
    if not any(len(layer.openings) for layer in setup.layers):
        return _cavities(voxels, setup.mesh), voxels.leaks
    size, origin = voxels.voxel_size, np.asarray(voxels.origin)
    shift = np.rint((setup.mesh.vertices.min(axis=0) - origin) / size).astype(np.int64)
    cavities = []
    closed: set[tuple[int, ...]] = set()
    for chamber in chambers(setup.mesh, setup.layers):
        cells = chamber.cells + shift
        closed.update(map(tuple, cells.tolist()))
        runs = np.column_stack([cells, cells[:, 2]]).astype(np.int32)  # each a run of one cell
        bounds = origin + size * np.stack([cells.min(axis=0), cells.max(axis=0) + 1])
        surface = chamber.surface
        cavities.append(Cavity(runs, len(cells), surface.volume, bounds, surface.area))
    leaks = [leak for leak in voxels.leaks if tuple(leak.cells[0].tolist()) not in closed]
    return tuple(cavities), tuple(leaks)


def findings_of_holes(bare: int, edges: int, where: str) -> list[Finding]:
    """Say that a surface has holes, where some of its edges belong to one triangle only."""
    if bare == 0:
        return []
    what = f"the surface has holes: {bare:,} of {edges:,} edges belong to one triangle"
    hint = "look at the voxels, whose inside was guessed, or close the surface where it was made"
    return [Finding("warning", where, what, hint)]


def _findings_of_surfaces(design: Design) -> Iterator[Finding]:
    for name, shape in design.shapes.items():
        if isinstance(shape, TriangleMesh):
            yield from findings_of_holes(*shape.open_edges(), f"shapes.{name}.path")


def _findings_of_voxels(voxels: Voxels, leaks: tuple[Leak, ...]) -> Iterator[Finding]:
    hint = "thicken the body there by a voxel, or make the voxels smaller"
    for hinge in voxels.hinges[:_LISTED]:
        yield Finding(
            "warning",
            f"voxels {hinge.cells[0]} and {hinge.cells[1]}",
            f"touch at {'an edge' if hinge.contact == 'edge' else 'a corner'} only: a hinge",
            hint,
        )
    if len(voxels.hinges) > _LISTED:
        what = f"there are {len(voxels.hinges) - _LISTED:,} more hinges"
        yield Finding("warning", "voxels", what, hint)
    pieces = voxels.components("face")
    if len(pieces) > 1:
        sizes = ", ".join(f"{piece.count:,}" for piece in pieces[:_LISTED])
        yield Finding(
            "warning",
            "voxels",
            f"the body is in {len(pieces)} pieces of {sizes} voxels"
            + (" and more" if len(pieces) > _LISTED else ""),
            "join them by whole faces of voxels, or clamp each of them",
        )
    for leak in leaks[:_LISTED]:
        cells = ", ".join(str(cell) for cell in leak.openings[:3])
        yield Finding(
            "warning",
            f"voxel {leak.openings[0]}",
            f"a chamber of {leak.volume * 1e6:.3g} mL is open through {cells}",
            "close the opening by a voxel, unless it is meant to be open",
        )
    thinnest = _thinnest_wall(voxels)
    if thinnest is not None and thinnest.thickness < GOOD_WALL:
        yield Finding(
            "warning",
            f"voxel {thinnest.cell}",
            f"the wall is {thinnest.thickness} voxel thick there and bends too stiffly",
            f"make the voxels smaller: {GOOD_WALL} or more across a wall",
        )


def _thinnest_wall(voxels: Voxels) -> Wall | None:
    """The thinnest wall of a cavity, or of the body where there is no cavity.

    Rounded ends of a body have rows of one voxel that are no walls.
    """
    walls = sorted(voxels.cavity_walls, key=lambda wall: wall.thickness)
    return walls[0] if walls else voxels.wall_thickness.thinnest


def _findings_of_mesh(mesh: Mesh) -> Iterator[Finding]:
    quality = mesh.quality
    if not quality.conforming or quality.smallest_tet <= 0.0:
        yield Finding(
            "error",
            "mesh",
            "is not conforming, or holds a tetrahedron without volume",
            "report this with the design: no shape should do that",
        )


def _steps_to_rest(voxels: Voxels) -> float:
    """Steps of relaxation: proportional to the highest over the lowest frequency.

    A slender body of length ``L`` and thickness ``t`` in voxels bends with a frequency of order
    ``t/L²`` of that of a voxel; 10 was measured on the paper's beam (L = 18, t = 2).
    """
    extents = np.sort(np.diff(voxels.bounds, axis=0)[0]) / voxels.voxel_size
    thickness, length = max(float(extents[0]), 1.0), float(extents[-1])
    return float(max(200.0, 10.0 * length**2 / thickness))
