"""Warnings where an estimate of the discretization error is known to be too small."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.cavity import MeshCavity
from voxsoft.comparison.deck_design import BEARS_COMPRESSION
from voxsoft.design import Design
from voxsoft.design.chamber import chosen_cavities, name_of_cavity
from voxsoft.design.discretization.cut_cells import built_parts
from voxsoft.mesh import Mesh
from voxsoft.simulation import Setup
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.simulation.loads import readings
from voxsoft.simulation.setup.places import voxel_size

#: A face of a voxel that turns away from the surface it stands for by more than this is a step of
#: a stair: those of a sphere turn by up to 55 degrees, those of a box by none.
_STEP: Final = np.radians(15.0)
#: A wall is a stair where steps are more than this part of its area. Of a sphere or a round tube
#: they are 0.6 to 0.8 of it; rounded edges of a box are less.
_MOSTLY: Final = 0.3

#: Distance in voxels from the faces of voxels at which a smooth surface counts as another one.
_SMOOTH: Final = 0.01

Floats = NDArray[np.float64]


def cautions_of(design: Design, mesh: Mesh) -> Iterator[Diagnostic]:
    """Warn of chambers under pressure whose walls are stairs.

    The stair is another one for every size of voxels, so that errors show no order: of a thick
    sphere that grows by a tenth, 5 and 2.5 mm predict 14 % where 26 % are missing, and with cut
    voxels 2.5 and 1.25 mm predict 1.4 % where 2.2 % are (`docs/method/cut-voxels.md`).

    Parameters
    ----------
    design, mesh
        The compared design, and its mesh.
    """
    pressed: set[int] = set()
    for number, load in enumerate(readings(design)):
        if load.cavity is not None:
            pressed.update(chosen_cavities(load.cavity, mesh, f"loads[{number}].cavity"))
    for index in sorted(pressed):
        cavity = mesh.cavities[index]
        share, place = steps_of_wall(design, mesh, cavity)
        if share > _MOSTLY:
            yield Diagnostic(
                "warning",
                name_of_cavity(mesh, index),
                f"is under pressure, and {share:.0%} of its wall is a stair of voxels: estimates "
                "of the discretization error may be low by up to two times",
                "compare several voxel sizes, and take the spread between them for the error",
                place,
            )


def cautions_of_contact(setup: Setup) -> Iterator[Diagnostic]:
    """Warn where a body touches with a smooth surface that is not that of its voxels.

    Parameters
    ----------
    setup
        The compared design. Outside codes, and voxels that are split, touch with faces of voxels.
    """
    if setup.touching is None:
        return
    for skin in setup.touching.skins:
        if skin is None:
            continue
        size = setup.touching.voxel_size
        # Points of a skin on the faces are at corners, middles of edges and centers of faces.
        halves = (skin.points - setup.mesh.vertices.min(axis=0)) / (size / 2)
        off = float(np.abs(halves - np.rint(halves)).max()) / 2
        if off > _SMOOTH:
            yield Diagnostic(
                "warning",
                "contact.surface",
                f"the body touches with its smooth surface, {off:.2g} voxels off the faces of its "
                "voxels, with which it touches in outside codes and split voxels",
                'compare with surface = "voxels", or several voxel sizes',
            )


def cautions_of_layers(design: Design) -> Iterator[Diagnostic]:
    """Warn of layers, which are membranes in outside codes and do not wrinkle.

    Parameters
    ----------
    design
        The compared design.
    """
    for index in range(len(design.layers)):
        hint = "expect a difference where the layer is compressed"
        yield Diagnostic("warning", f"layers[{index}]", BEARS_COMPRESSION, hint)


def steps_of_wall(
    design: Design, mesh: Mesh, cavity: MeshCavity
) -> tuple[float, tuple[float, float, float]]:
    """Return the part of a chamber's wall that turns away from the surface it stands for.

    Parameters
    ----------
    design, mesh, cavity
        The body, and one of the mesh's cavities.

    Returns
    -------
    share, place
        Area share between 0 and 1; and the center of the step that turns most, m.
    """
    corners = mesh.vertices[cavity.triangles]
    a, b, c = corners.transpose(1, 0, 2)
    areas = np.cross(b - a, c - a)
    sizes = np.linalg.norm(areas, axis=1)
    centers = corners.mean(axis=1)
    slopes = _slopes(design, centers, voxel_size(mesh))
    lengths = np.linalg.norm(slopes, axis=1)
    known = (lengths > 0.0) & np.isfinite(lengths)
    cosines = np.ones(len(sizes))
    along = np.einsum("ij,ij->i", areas, slopes)
    cosines[known] = along[known] / (sizes * lengths)[known]
    steps = cosines < np.cos(_STEP)
    worst = centers[int(cosines.argmin())]
    share = float(sizes[steps].sum() / sizes.sum())
    return share, (float(worst[0]), float(worst[1]), float(worst[2]))


def _slopes(design: Design, points: Floats, size: float) -> Floats:
    """Gradient of the level of the union of all parts, which is negative inside, (n, 3)."""
    step = 0.05 * size
    shifts = step * np.concatenate([np.eye(3), -np.eye(3)])
    around = (points[:, None] + shifts).reshape(-1, 3)
    levels = np.min([shape.evaluate(around) for shape in built_parts(design)], axis=0)
    levels = levels.reshape(-1, 6)
    slopes: Floats = levels[:, :3] - levels[:, 3:]
    return slopes
