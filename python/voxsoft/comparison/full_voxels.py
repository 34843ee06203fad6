"""Full voxels of a design, which outside codes know, in place of cut ones."""

from __future__ import annotations

from voxsoft.design import Design
from voxsoft.design.discretization.discretize import mesh_of
from voxsoft.simulation import Diagnostic


def with_full_voxels(design: Design) -> tuple[Design, tuple[Diagnostic, ...]]:
    """Return a design with the voxels that outside codes know, and a warning where it has others.

    A `fill` that the design names stays.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> ball, warnings = with_full_voxels(families.sphere())
    >>> ball.fill, [each.where for each in warnings]
    ('binary', ['fill'])
    """
    whole = design.replace(
        fill=design.fill or "binary",
        bodies=[
            body if body.design is not None else body.replace(fill=body.fill or "binary")
            for body in design.bodies
        ],
    )
    if mesh_of(design).fractions is None or mesh_of(whole).fractions is not None:
        return design, ()
    what = "is binary here, in all runs: outside codes are given full voxels, not cut ones"
    return whole, (Diagnostic("warning", "fill", what, 'compare cut voxels with outside = "none"'),)
