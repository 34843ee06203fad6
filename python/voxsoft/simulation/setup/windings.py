"""Check of wound fibers on a mesh: their axis must not run through their part."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft._shown import rounded
from voxsoft.design import Design
from voxsoft.errors import DesignError
from voxsoft.materials import Fiber
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.part_voxels import part_voxels


def check_windings(design: Design, mesh: Mesh) -> None:
    """Check that no part with wound fibers lies on their axis.

    Within a voxel of the axis the direction around it turns by more than a radian from one end of
    a voxel to the other, which an element cannot represent.

    Parameters
    ----------
    design
        The design, with the parts of all its bodies.
    mesh
        The mesh of its voxels.

    Raises
    ------
    DesignError
        The axis of a family of fibers runs through the part that has them.
    """
    for index, number, fiber in _wound(design):
        voxels = part_voxels(design, mesh, index)
        if voxels is None:
            continue
        near = fiber.distances(voxels.centers) < voxels.size
        if near.any():
            x, y, z = (rounded(1e3 * value) for value in voxels.centers[near][0])
            raise DesignError(
                f"parts[{index}].fibers[{number}].axis",
                f"runs through the part itself, at ({x}, {y}, {z}) mm: there is no way around"
                " it within a voxel of it",
                "give what is wound, such as the wall without its ends, a part of its own, "
                "or move the axis by center",
            )


def _wound(design: Design) -> Iterator[tuple[int, int, Fiber]]:
    for index, part in enumerate(design.parts):
        for number, fiber in enumerate(part.fibers):
            if fiber.is_wound:
                yield index, number, fiber
