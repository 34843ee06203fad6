"""Materials of a design for the solver, with a stiff material in place of a rigid one."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.assembly import voxel_size_of
from voxsoft.errors import DesignError
from voxsoft.materials import CompliantLattice, Hyperelastic, Lattice, Material, Rigid
from voxsoft.mesh import Mesh
from voxsoft.simulation.setup.growth import PartGrowth, growths_of
from voxsoft.simulation.setup.profiles import shares_of


def solid_materials(design: Design) -> list[Material]:
    """Return the material of each part, with a stiff one in place of a rigid one.

    Parameters
    ----------
    design
        The design. The stiffest of its soft parts, by initial shear modulus, decides how stiff a
        rigid one is: see :class:`voxsoft.materials.Rigid`.

    Raises
    ------
    DesignError
        All parts are rigid, or one that is not hyperelastic has fibers.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> [material.model for material in solid_materials(families.beam())]
    ['yeoh']
    """
    materials = [design.material_of(part) for part in design.parts]
    for index, (part, material) in enumerate(zip(design.parts, materials, strict=True)):
        if part.fibers and not isinstance(material, Hyperelastic):
            raise DesignError(
                f"parts[{index}].fibers",
                f'need a hyperelastic material around them, and this one is "{material.model}"',
                "use the neo-Hookean one of the same Young's modulus",
            )
    soft = [
        _shear(material, voxel_size_of(design, part))
        for part, material in zip(design.parts, materials, strict=True)
        if not isinstance(material, Rigid)
    ]
    if not soft:
        raise DesignError(
            "parts",
            "all are rigid: nothing can deform",
            "give at least one of them a soft material",
        )
    return [
        material.beside(max(soft)) if isinstance(material, Rigid) else material
        for material in materials
    ]


def core_materials(
    design: Design,
    materials: list[Material],
    mesh: Mesh,
    origin: NDArray[np.float64],
    *,
    over_time: bool = False,
) -> list[_core.Material]:
    """Return the core's material of each part of a design, with fibers and growth.

    Parameters
    ----------
    design
        The design whose parts have the fibers.
    materials
        One for each part, such as :func:`solid_materials` gives.
    mesh
        The mesh of the voxels.
    origin
        Origin of the solver [m], (3,).
    over_time
        True to follow the histories of activations; default: their final values.

    Raises
    ------
    DesignError
        An activation that its part cannot have.
    """
    found: list[_core.Material] = []
    growths = growths_of(design)
    poses = {body.name: body.pose for body in design.bodies}
    for index, (part, material) in enumerate(zip(design.parts, materials, strict=True)):
        core = material.core
        growth = growths.get(index, PartGrowth())
        at_once = growth.is_uniform and not over_time
        if part.fibers:
            free = growth.fiber_stretch if at_once else 1.0
            straight = [fiber.core(free) for fiber in part.fibers if not fiber.is_wound]
            rotation, position = poses.get(part.body or "", (np.eye(3), np.zeros(3)))
            place = rotation, position - origin
            wound = [fiber.winding(*place, free) for fiber in part.fibers if fiber.is_wound]
            core = core.with_fibers(straight).with_windings(wound)
        if growth.of_part and at_once:
            core = core.with_swelling(growth.part_stretch)
        if index in growths and not at_once:
            shares = partial(shares_of, design, mesh, index)
            core = growth.give_to(core, shares, over_time=over_time)
        found.append(core)
    return found


def _shear(material: Hyperelastic | Lattice | CompliantLattice, voxel_size: float) -> float:
    """The initial shear modulus in Pa."""
    if isinstance(material, Hyperelastic):
        return material.shear
    poisson = material.poisson(voxel_size)
    return material.young(voxel_size) / (2.0 * (1.0 + poisson))
