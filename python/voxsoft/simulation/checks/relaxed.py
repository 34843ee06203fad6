"""Viscoelastic materials in equilibria, which have no time."""

from __future__ import annotations

from collections.abc import Iterator

from voxsoft.design import Design
from voxsoft.materials import Hyperelastic
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_quantity


def relaxed_parts(design: Design) -> Iterator[Diagnostic]:
    """Warn of each part whose Prony branches an equilibrium leaves out.

    An equilibrium, and each one along a path but that over ``"time"``, is that of a fully relaxed
    material: it has the long-term stiffness, without the stiffer initial response and creep.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> soft = '{model="neo-hookean", young="60 kPa", prony=[{g=0.3, tau="100 s"}]}'
    >>> (found,) = relaxed_parts(families.beam().with_values(f"parts.0.material={soft}"))
    >>> found.where, found.what
    ('parts[0].material', 'relaxes over 100 s; this equilibrium has the long-term stiffness, and a \
sudden load meets 1.43 times that')
    """
    for index, part in enumerate(design.parts):
        material = design.material_of(part)
        if isinstance(material, Hyperelastic) and material.prony:
            slowest = format_quantity(max(branch.tau for branch in material.prony), "time")
            sudden = 1.0 / (1.0 - sum(branch.g for branch in material.prony))
            what = (
                f"relaxes over {slowest}; this equilibrium has the long-term stiffness, and a "
                f"sudden load meets {sudden:.3g} times that"
            )
            hint = (
                "follow its creep, without inertia, by --over 'time=0..300 s/4', with inertia by "
                'method = "dynamics" and an end_time; or leave prony out'
            )
            yield Diagnostic("warning", f"parts[{index}].material", what, hint)
