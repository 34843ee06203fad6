"""Viscoelastic materials in equilibria, which have no time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from voxsoft.design import Constraint, Design, Objective
from voxsoft.materials import Hyperelastic
from voxsoft.metrics.tangent import COMPLIANCE, NATURAL_FREQUENCY, STIFFNESS
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_quantity

#: Metrics of the tangent, which has no branches.
_OF_THE_TANGENT: Final = {each.name for each in (COMPLIANCE, STIFFNESS, NATURAL_FREQUENCY)}


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


def relaxed_tangents(design: Design) -> Iterator[Diagnostic]:
    """Warn of each goal of a crept state that the long-term stiffness decides.

    Examples
    --------
    >>> from voxsoft.design import families
    >>> beam = families.beam()
    >>> goal = {"softness": {"minimize": "natural_frequency"}}
    >>> print(*relaxed_tangents(beam.replace(objectives=goal)))  # doctest: +ELLIPSIS
    softness: is that of the long-term stiffness at the crept shape; ...
    """
    targets: dict[str, Objective | Constraint] = {**design.objectives, **design.constraints}
    for name, target in targets.items():
        if target.metric in _OF_THE_TANGENT:
            what = (
                "is that of the long-term stiffness at the crept shape; a quick change meets a "
                "stiffer body"
            )
            yield Diagnostic(
                "warning",
                name,
                what,
                'look at motion over time (method = "dynamics") for quick changes',
            )
