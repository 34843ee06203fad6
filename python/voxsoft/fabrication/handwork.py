"""Steps of making a robot that are left to the hand."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from voxsoft.fabrication.body import Body
from voxsoft.fabrication.inlets import Inlet
from voxsoft.fabrication.patterns import Pattern
from voxsoft.fabrication.planning import Plan
from voxsoft.units import format_quantity


def steps_before(body: Body, plans: list[Plan], patterns: Mapping[str, Pattern]) -> list[str]:
    """Return the steps before molds are poured: layers, threads and tubes of tendons laid in."""
    design, steps = body.design, []
    for number, layer in enumerate(design.layers, 1):
        name = layer.name or f"layer {number}"
        thick = format_quantity(layer.thickness, "length")
        file = next((file for file, each in patterns.items() if each.name == name), None)
        cut = "" if file is None else f", cut by {file}.svg"
        steps.append(
            f"Lay {name}, {thick} thick{cut}, into the mold before pouring, flat on its side there."
        )
    # A part may be in several components, of which some are no tubes.
    unwound = {k for plan in plans if plan.winding is None for k in plan.component.parts}
    for index, part in enumerate(design.parts):
        for fiber in part.fibers if index in unwound else ():
            along = f"({', '.join(f'{each:.3g}' for each in fiber.unit)})"
            if fiber.angle is None:
                steps.append(f"Lay thread along {along} into the wall before it is poured full.")
            else:
                steps.append(
                    f"Wind thread at {np.degrees(fiber.angle):.3g} deg to the axis {along} on the "
                    "first layer of the wall, before the second is poured."
                )
    for number, tendon in enumerate(design.tendons, 1):
        name = tendon.name or f"tendon {number}"
        steps.append(f"Span a tube for {name} through the mold before pouring.")
    return steps


def steps_after(body: Body, plans: list[Plan], inlets: list[Inlet]) -> list[str]:
    """Return the steps after the cure that no mold does: holes to be punched."""
    steps = []
    for inlet in inlets:
        if not _is_molded(inlet, body, plans):
            at = ", ".join(f"{1e3 * each + 0.0:.3g}" for each in inlet.at)
            wide = f"{2e3 * inlet.radius:.2g} mm"
            steps.append(f"Punch the inlet of {inlet.chamber}: {wide} wide, at ({at}) mm.")
    return steps


def _is_molded(inlet: Inlet, body: Body, plans: list[Plan]) -> bool:
    """Return True if pins of cores, or prints, make an inlet all through its wall."""
    share = (np.arange(int(np.ceil(inlet.length / body.grid.step))) + 0.5) * body.grid.step
    points = np.tile(np.array(inlet.at), (len(share), 1))
    points[:, inlet.axis] -= inlet.sign * share
    wall = body.grid.nearest(points)
    left = np.zeros(len(points), dtype=bool)
    for each in plans:
        if each.way != "printed" and (each.cut is None or each.cut.axis != inlet.axis):
            left |= each.component.values[wall] < 0.0
    return not left.any()
