"""Where a body at some positions is in itself, as the page is told of it."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.overlaps import TOLD, overlapping, penetration_of
from voxsoft.simulation.places import voxel_size
from voxsoft.studio import events

#: Places that are marked in the picture.
_MARKED: Final = 12


def overlap_of(
    design: Design, mesh: Mesh, positions: NDArray[np.float64], topology: int
) -> events.Overlap:
    """Say where the body of a design is in itself at some positions, the deepest place first.

    Parameters
    ----------
    design, mesh
        The body.
    positions
        Its vertices in m, (n, 3).
    topology
        Its number.
    """
    least = TOLD * voxel_size(mesh)
    regions = [
        region
        for region in penetration_of(design, mesh, positions).regions
        if region.depth > least and not region.inverted
    ]
    if not regions:
        return events.Overlap(topology=topology, depth=0.0, sentence="", places=[])
    where, what = overlapping(design, regions[0])
    others = len(regions) - 1
    more = f" and at {others} more place{'s' if others > 1 else ''}" if others else ""
    return events.Overlap(
        topology=topology,
        depth=regions[0].depth,
        sentence=f"{where}: {what}{more}: contact is not simulated",
        places=[
            events.OverlapPlace(depth=region.depth, rest=region.at_rest, now=region.at_now)
            for region in regions[:_MARKED]
        ],
    )
