"""Viscoelastic materials in equilibria, which have no time."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft.design import Design
from voxsoft.materials import Hyperelastic
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_quantity


def relaxed_parts(design: Design) -> Iterator[Diagnostic]:
    """Warn of each part whose Prony branches an equilibrium leaves out.

    An equilibrium, and each one along a path, also over the time of histories, is that of a fully
    relaxed material: the stiffer initial response and creep are left out.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> soft = '{model="neo-hookean", young="60 kPa", prony=[{g=0.3, tau="100 s"}]}'
    >>> (found,) = relaxed_parts(families.beam().with_values(f"parts.0.material={soft}"))
    >>> found.where, found.what
    ('parts[0].material', 'relaxes over 100 s, and an equilibrium is that after all of it: creep \
is left out')
    """
    for index, part in enumerate(design.parts):
        material = design.material_of(part)
        if isinstance(material, Hyperelastic) and material.prony:
            slowest = format_quantity(max(branch.tau for branch in material.prony), "time")
            what = (
                f"relaxes over {slowest}, and an equilibrium is that after all of it: creep is "
                "left out"
            )
            hint = (
                'write method = "dynamics" with an end_time for what happens on the way, or leave '
                "prony out"
            )
            yield Diagnostic("warning", f"parts[{index}].material", what, hint)
