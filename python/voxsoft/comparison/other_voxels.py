"""A design on voxels of another size, and what that costs."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from voxsoft.design import Design

#: How the time of a run grows as voxels get half as large (:mod:`voxsoft.simulation.cost`).
TIMES_AS_LONG: Final = 12.0


class OtherCost(NamedTuple):
    """What a run on voxels of another size is likely to take: how many, and seconds."""

    voxels: int
    seconds: float


def cost_on_voxels(voxels: int, seconds: float, factor: float) -> OtherCost:
    """Predict the cost of a run on other voxels from that of one that was made.

    Parameters
    ----------
    voxels, seconds
        Of the run that was made.
    factor
        How many times as large the other voxels are: 0.5 for half as large.

    Examples
    --------
    >>> cost_on_voxels(1_000, 2.0, 0.5)
    OtherCost(voxels=8000, seconds=24.0)
    """
    finer = factor**-3.0
    return OtherCost(round(finer * voxels), seconds * TIMES_AS_LONG ** -math.log2(factor))


def on_voxels(design: Design, factor: float) -> Design:
    """Return the design with the voxels of all its bodies so many times as large.

    Parameters
    ----------
    design
        The design.
    factor
        2 makes voxels twice as large.

    Raises
    ------
    DesignError
        A design that is none with such voxels.

    Examples
    --------
    >>> from voxsoft.design import Body, families
    >>> on_voxels(families.beam(), 0.5).voxel_size
    0.0025
    >>> two = [Body(name=name, design=families.beam()) for name in ("left", "right")]
    >>> both = on_voxels(Design(name="both", voxel_size="1 mm", bodies=two), 2.0)
    >>> [body.voxel_size for body in both.assembled.bodies]
    [0.01, 0.01]
    """
    sizes = [f"voxel_size={_size(factor * design.voxel_size)}"]
    for number, body in enumerate(design.bodies):
        own = body.included
        size = body.voxel_size
        if size is None and own is not None and not own.bodies:
            size = own.voxel_size
        if size is not None:
            sizes.append(f"bodies.{number}.voxel_size={_size(factor * size)}")
    resized = design.with_values(*sizes)
    if all(body.included is None or not body.included.bodies for body in design.bodies):
        return resized
    # Of a design of several bodies each has a size of its own, within that design.
    bodies = [
        body.replace(design=on_voxels(own, factor), set={})
        if (own := body.included) is not None and own.bodies
        else body
        for body in resized.bodies
    ]
    return resized.replace(bodies=bodies)


def _size(size: float) -> str:
    return f"{size * 1e3!r} mm"
