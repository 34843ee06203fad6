"""The bodies that several benchmarks bring to rest."""

from __future__ import annotations

from typing import Final

import numpy as np

import voxsoft as vs
from voxsoft.design import families
from voxsoft.materials import Material
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

#: The two families of materials; the same number in Pa, not the same stiffness.
MATERIALS: Final[dict[str, Material]] = {
    "lattice": vs.Lattice(edge=60 * kPa, bulk=400 * kPa, density=1070.0),
    "neo-Hookean": vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0),
}
#: Two roundings of the same forces, added up in another order.
ROUNDING: Final = 1.01


def beam(material: Material) -> vs.Design:
    """A cantilever of 100 x 10 x 10 mm under its weight: 80 voxels, the first 10 mm clamped."""
    return _with_material(families.paper_beam(), material)


def cylinder(material: Material) -> vs.Design:
    """The paper's (5,7,1): radius, height and wall in voxels, 4 kPa in its chamber."""
    return _with_material(families.paper_cylinder(), material)


def block(material: Material, across: int) -> vs.Design:
    """A cube of 100 mm that stands on its foot under its weight."""
    side = 100 * mm
    return vs.Design(
        name="block",
        voxel_size=side / across,
        parts=[vs.Part(shape=vs.Box(size=(side, side, side)), material=material)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity()],
        probes={"tip": vs.Probe(z=(side, side))},
    )


def tip(result: vs.Result) -> np.ndarray:
    """Displacement of the last probe, (3,), m."""
    return np.asarray(result.probes[list(result.design.probes)[-1]])


def require_rest(setup: Setup, result: vs.Result, tolerance: float) -> None:
    """Refuse a state whose forces do not balance, found again from its positions alone.

    The net forces are those of the loads and of the plain loops over the elements.
    """
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {result.message}")
    held = np.zeros(len(setup.mesh.vertices), dtype=bool)
    held[np.concatenate(setup.clamped)] = True
    left = setup.problem.net_forces(result.positions)[~held]
    # The norm over vertices: the pushes on a closed chamber do not cancel in it.
    loads = setup.problem.net_forces(setup.mesh.vertices)[~held]
    part = float(np.linalg.norm(left) / np.linalg.norm(loads))
    if not part < tolerance * ROUNDING:
        raise SystemExit(f"wrong answer: {part:.1e} of the load is out of balance")


def _with_material(design: vs.Design, material: Material) -> vs.Design:
    parts = [part.replace(material=material) for part in design.parts]
    return design.replace(parts=tuple(parts))
