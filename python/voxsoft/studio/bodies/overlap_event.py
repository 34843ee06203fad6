"""Event of a body that is in itself at some positions, for the page."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.mesh import Mesh
from voxsoft.simulation.checks.overlaps import NEGLIGIBLE, overlapping, penetration_of
from voxsoft.simulation.setup.contact import keeps_apart
from voxsoft.simulation.setup.places import voxel_size
from voxsoft.studio.protocol import events

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
    least = NEGLIGIBLE * voxel_size(mesh)
    overlaps = [
        overlap
        for overlap in penetration_of(design, mesh, positions).overlaps
        if overlap.depth > least and not overlap.inverted
    ]
    if not overlaps:
        return events.Overlap(topology=topology, depth=0.0, sentence="", places=[])
    where, what = overlapping(design, overlaps[0])
    others = len(overlaps) - 1
    apart = keeps_apart(design)
    cause = "contact has not kept them apart" if apart else "contact is not simulated"
    more = f" and at {others} more place{'s' if others > 1 else ''}" if others else ""
    return events.Overlap(
        topology=topology,
        depth=overlaps[0].depth,
        sentence=f"{where}: {what}{more}: {cause}",
        places=[
            events.OverlapPlace(depth=overlap.depth, rest=overlap.at_rest, now=overlap.at_now)
            for overlap in overlaps[:_MARKED]
        ],
    )
