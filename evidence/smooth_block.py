"""A block with a smooth exact solution, to read the order of convergence from.

Two shears, one after the other, move a unit cube without a change of volume::

    x = X + a sin(πY) sin(πZ)        y = Y + b sin(πx) sin(πZ)        z = Z

The surface is moved as they say, and the body force ``b = -Div P`` with the stress ``P`` of the
motion's gradient holds the inside there. Nothing is singular: the error is that of the elements
alone, at any Poisson's ratio.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft import _core
from voxsoft.simulation import Setup

Floats = NDArray[np.float64]

#: How far the shears move, in edges of the cube: strains of a third.
FIRST, SECOND = 0.1, 0.1
#: Step of the central differences of the stress, in edges of the cube: errors of 1e-8 of it.
STEP = 1e-4


def motion(points: Floats) -> Floats:
    """Where points of the unit cube go, (n, 3) → (n, 3)."""
    x, y, z = points.T
    moved = x + FIRST * np.sin(np.pi * y) * np.sin(np.pi * z)
    return np.stack([moved, y + SECOND * np.sin(np.pi * moved) * np.sin(np.pi * z), z], axis=1)


def gradient(points: Floats) -> Floats:
    """The motion's gradient, (n, 3) → (n, 3, 3)."""
    moved, y, z = motion(points)[:, 0], points[:, 1], points[:, 2]
    f = np.tile(np.eye(3), (len(points), 1, 1))
    f[:, 0, 1] = FIRST * np.pi * np.cos(np.pi * y) * np.sin(np.pi * z)
    f[:, 0, 2] = FIRST * np.pi * np.sin(np.pi * y) * np.cos(np.pi * z)
    f[:, 1] += (SECOND * np.pi * np.cos(np.pi * moved) * np.sin(np.pi * z))[:, None] * f[:, 0]
    f[:, 1, 2] += SECOND * np.pi * np.sin(np.pi * moved) * np.cos(np.pi * z)
    return f


def stress(points: Floats, material: vs.NeoHookean) -> Floats:
    """First Piola–Kirchhoff stress of the neo-Hookean energy in Pa, (n, 3) → (n, 3, 3)."""
    f = gradient(points)
    j = np.linalg.det(f)[:, None, None]
    inverse = np.linalg.inv(f).transpose(0, 2, 1)
    first = (f**2).sum(axis=(1, 2))[:, None, None]
    shear = material.shear * j ** (-2 / 3) * (f - first / 3 * inverse)
    return shear + material.bulk * (j - 1) * j * inverse


def body_force(points: Floats, material: vs.NeoHookean) -> Floats:
    """The force ``-Div P`` in N per unit of volume of the unit cube, (n, 3) → (n, 3)."""
    total = np.zeros_like(points)
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = STEP
        ahead, behind = stress(points + step, material), stress(points - step, material)
        total -= (ahead - behind)[:, :, axis] / (2 * STEP)
    return total


def error(cells: int, material: vs.NeoHookean) -> float:
    """Root mean square of the error at the corners, over that of the motion itself."""
    design = vs.Design(
        name="smooth-block",
        voxel_size=1.0 / cells,
        shapes={"block": vs.Box(size=(1.0, 1.0, 1.0))},
        parts=(vs.Part(shape="block", material=material),),
        clamps=(vs.Clamp(region=vs.Region(x=(0, 0))),),
    )
    mesh = Setup.of(design).mesh
    points = mesh.vertices
    parts = _core.ProblemParts()
    skin = np.flatnonzero((np.abs(points - 0.5) > 0.5 - 0.1 / cells).any(axis=1))
    exact = motion(points)
    for vertex in skin.astype(np.uint32):
        moved = (exact[vertex] - points[vertex]).tolist()
        parts.clamp(np.array([vertex]), [True] * 3, displacement=moved)
    forces = body_force(points, material) / cells**3
    parts.forces(np.arange(len(points), dtype=np.uint32), forces)
    assert mesh.tet_voxel is not None
    problem = _core.Problem(
        points,
        mesh.tets.astype(np.uint32),
        mesh.tet_part - np.uint8(1),
        mesh.tet_voxel.astype(np.uint32),
        [material.core],
        parts,
    )
    report = _core.equilibrium(problem, tolerance=1e-10)
    if report.status != _core.Status.AT_REST:
        raise SystemExit(f"wrong answer: the smooth block came to {report.status}")
    off = np.linalg.norm(report.positions - exact, axis=1)
    return float(np.sqrt((off**2).sum() / ((exact - points) ** 2).sum()))
