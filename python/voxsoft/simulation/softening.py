"""Designs of rubber that softens (Mullins effect), and features that do not support it."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft.design import Design
from voxsoft.errors import DesignError, ErrorDetail
from voxsoft.materials import Hyperelastic


def softening_parts(design: Design) -> Iterator[int]:
    """Yield the indices of the parts whose material softens."""
    for index, part in enumerate(design.parts):
        material = design.material_of(part)
        if isinstance(material, Hyperelastic) and material.mullins is not None:
            yield index


def refuse_softening(design: Design, who: str) -> None:
    """Raise an error where a material softens, which `who` does not support.

    Raises
    ------
    DesignError
        A material of the design softens.
    """
    for index in softening_parts(design):
        raise DesignError(
            f"parts[{index}].material.mullins",
            f"is not known to {who}",
            'find equilibria, along a path with "voxsoft run --over", or leave mullins out',
        )


def unknown_with_softening(design: Design) -> Iterator[ErrorDetail]:
    """Find entries of a design that are not supported with a softening material."""
    if next(softening_parts(design), None) is None:
        return
    for name, what in (
        ("symmetry", "solves a part of the body"),
        ("activations", "changes what a part is at rest"),
    ):
        if getattr(design, name):
            problem = f"{what}, and what softening voxels remember is not known then"
            yield ErrorDetail(name, problem, "leave it out, or leave mullins out of the materials")


def check_softening(design: Design) -> None:
    """Raise an error where a design has entries that are not supported with softening.

    Raises
    ------
    DesignError
        Entries that are not supported, each by its name.
    """
    if found := list(unknown_with_softening(design)):
        raise DesignError.listing(found)
