"""The materials of a design as a solver takes them: nothing in them is rigid any more."""

from __future__ import annotations

from voxsoft import _core
from voxsoft.design import Design
from voxsoft.design.assembly import voxel_size_of
from voxsoft.errors import DesignError
from voxsoft.materials import CompliantLattice, Hyperelastic, Lattice, Material, Rigid


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


def core_materials(design: Design, materials: list[Material]) -> list[_core.Material]:
    """What the core takes for each part of a design: its material and its fibers.

    Parameters
    ----------
    design
        Whose parts have the fibers.
    materials
        One for each part, such as :func:`solid_materials` gives.
    """
    return [
        material.core.with_fibers([fiber.core for fiber in part.fibers])
        if part.fibers
        else material.core
        for part, material in zip(design.parts, materials, strict=True)
    ]


def _shear(material: Hyperelastic | Lattice | CompliantLattice, voxel_size: float) -> float:
    """The initial shear modulus in Pa."""
    if isinstance(material, Hyperelastic):
        return material.shear
    poisson = material.poisson(voxel_size)
    return material.young(voxel_size) / (2.0 * (1.0 + poisson))
