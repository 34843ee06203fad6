"""The materials of a design as a solver takes them: nothing in them is rigid any more."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.assembly import voxel_size_of
from voxsoft.errors import DesignError
from voxsoft.materials import CompliantLattice, Hyperelastic, Lattice, Material, Rigid
from voxsoft.records import closest


def solid_materials(design: Design) -> list[Material]:
    """Return the material of each part, with something stiff in place of what is rigid.

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
    design: Design, materials: list[Material], origin: NDArray[np.float64]
) -> list[_core.Material]:
    """What the core takes for each part of a design: its material and its fibers.

    Parameters
    ----------
    design
        Whose parts have the fibers.
    materials
        One for each part, such as :func:`solid_materials` gives.
    origin
        Where the solver's origin is [m], (3,).
    """
    found = []
    stretches, of_fibers = _stretches(design)
    poses = {body.name: body.pose for body in design.bodies}
    for index, (part, material) in enumerate(zip(design.parts, materials, strict=True)):
        core = material.core
        if part.fibers:
            free = of_fibers.get(index, 1.0)
            straight = [fiber.core(free) for fiber in part.fibers if not fiber.is_wound]
            rotation, position = poses.get(part.body or "", (np.eye(3), np.zeros(3)))
            place = rotation, position - origin
            wound = [fiber.winding(*place, free) for fiber in part.fibers if fiber.is_wound]
            core = core.with_fibers(straight).with_windings(wound)
        if index in stretches:
            core = core.with_swelling(stretches[index])
        found.append(core)
    return found


def _stretches(design: Design) -> tuple[dict[int, float], dict[int, float]]:
    """How many times as long parts and their fibers are by themselves, by the index of the part.

    Several activations of one multiply.

    Raises
    ------
    DesignError
        There is no such part, it is a lattice or rigid, or has no fibers that could be longer.
    """
    of_parts: dict[int, float] = {}
    of_fibers: dict[int, float] = {}
    for number, activation in enumerate(design.activations):
        where = f"activations[{number}].part"
        named = [i for i, part in enumerate(design.parts) if activation.part == part.label]
        if not named:
            labels = [part.label for part in design.parts]
            what = f'there is no part "{activation.part}"'
            raise DesignError(where, what, closest(activation.part, labels))
        for index in named:
            material = design.material_of(design.parts[index])
            if not isinstance(material, Hyperelastic):
                raise DesignError(
                    where,
                    f'swells hyperelastic parts, and "{activation.part}" is "{material.model}"',
                    "use the neo-Hookean material of the same Young's modulus",
                )
            if activation.of_fibers and not design.parts[index].fibers:
                what = f'is for the fibers of a part, and "{activation.part}" has none'
                hint = 'give the part fibers, or take kind = "strain"'
                raise DesignError(where, what, hint)
            found = of_fibers if activation.of_fibers else of_parts
            found[index] = found.get(index, 1.0) * activation.stretch
    return of_parts, of_fibers


def _shear(material: Hyperelastic | Lattice | CompliantLattice, voxel_size: float) -> float:
    """The initial shear modulus in Pa."""
    if isinstance(material, Hyperelastic):
        return material.shear
    poisson = material.poisson(voxel_size)
    return material.young(voxel_size) / (2.0 * (1.0 + poisson))
