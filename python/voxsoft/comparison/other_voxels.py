"""Design on voxels of another size, and the cost of solving it."""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from voxsoft.design import Design

#: Growth of the time of a run when voxels are halved (:mod:`voxsoft.simulation.solving.cost`).
TIMES_AS_LONG: Final = 12.0


class OtherCost(NamedTuple):
    """Predicted cost of a run on voxels of another size: their number, and seconds."""

    voxels: int
    seconds: float


def cost_on_voxels(voxels: int, seconds: float, factor: float) -> OtherCost:
    """Predict the cost of a run on other voxels from that of one that was made.

    Parameters
    ----------
    voxels, seconds
        Number of voxels and seconds of the run that was made.
    factor
        Ratio of the voxel sizes: 0.5 for half as large.

    Examples
    --------
    >>> cost_on_voxels(1_000, 2.0, 0.5)
    OtherCost(voxels=8000, seconds=24.0)
    """
    finer = factor**-3.0
    return OtherCost(round(finer * voxels), seconds * TIMES_AS_LONG ** -math.log2(factor))


def on_voxels(design: Design, factor: float) -> Design:
    """Scale the voxels of all bodies of a design by a factor.

    Parameters
    ----------
    design
        The design.
    factor
        2 makes voxels twice as large.

    Raises
    ------
    DesignError
        A design that is invalid with such voxels.

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
    # Each body of a design of several bodies has a size of its own, within that design.
    bodies = [
        body.replace(design=on_voxels(own, factor), set={})
        if (own := body.included) is not None and own.bodies
        else body
        for body in resized.bodies
    ]
    return resized.replace(bodies=bodies)


def _size(size: float) -> str:
    return f"{size * 1e3!r} mm"
