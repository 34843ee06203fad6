"""Local refinement: designs whose voxels are small where their error is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.comparison.local_error import local_errors
from voxsoft.design import Design, Refinement, Region
from voxsoft.errors import DesignError
from voxsoft.mesh import BodyMesh
from voxsoft.simulation import Result
from voxsoft.simulation.setup.places import voxel_size

Ints = NDArray[np.int64]

#: Share of the whole error in small voxels; nine tenths lie in a tenth of the voxels of a block
#: with a chamber, and in half of those of a finger (`docs/method/refinement.md`).
SHARE: Final = 0.9
#: Most boxes of a design: more are hard to read, and a text has room for 250.
_MOST_BOXES: Final = 120
#: Relative difference below which errors are the same.
_ALIKE: Final = 1e-6


def refined(result: Result, share: float = SHARE) -> Design:
    """Halve the voxels that hold most of the error of a run.

    The voxels with the largest :func:`local_errors` are taken, as few as hold the `share` of the
    sum, and written as boxes: plain regions of ``[[refine]]``, to be read, changed and kept.

    Parameters
    ----------
    result
        An equilibrium of a design without ``refine``.
    share
        Share of the estimated error that small voxels are to hold, between 0 and 1. Default: 0.9.

    Returns
    -------
    Design
        Design with ``refine``.

    Raises
    ------
    DesignError
        The run is no equilibrium, its voxels have two sizes already, or the share is not between 0
        and 1.

    Examples
    --------
    >>> import voxsoft as vs
    >>> from voxsoft.design import families
    >>> finger = families.pneunet(chambers=2)
    >>> result = vs.simulate(finger)
    >>> better = vs.simulate(refined(result))
    >>> bool(better.probes["tip"][2] < result.probes["tip"][2] < 0.0)  # large ones are too stiff
    True
    """
    design = result.design
    check_share(share)
    if design.refine:
        what = "is there already, and two sizes of voxels are the most there can be"
        raise DesignError("refine", what, "solve the design without it, and add to what is found")
    if result.status != "ok":
        raise DesignError("", f"has no equilibrium: {result.message}", "solve that first")
    if any(body.mesh.voxel_size is None for body in result.mesh.each_body):
        raise DesignError("", "has a mesh that is not made of voxels", "give it shapes and parts")
    errors = local_errors(result)
    if not errors.any():
        raise DesignError("", "has no strain that differs from place to place", "load it first")
    falling = -np.sort(-errors)
    held = np.cumsum(falling)
    least = falling[int(np.searchsorted(held, share * held[-1]))]
    # Images of each other, which differ by rounding, are taken together.
    worst = np.flatnonzero(errors >= (1.0 - _ALIKE) * least)
    bodies = result.mesh.each_body
    found = [
        Refinement(region=region)
        for body in bodies
        for region in _boxes(body, worst, _MOST_BOXES // len(bodies))
    ]
    return design.replace(refine=found)


def check_share(share: float) -> None:
    """Raise an error unless a share is between 0 and 1.

    Raises
    ------
    DesignError
        It is not.
    """
    if not 0.0 < share < 1.0:
        what = f"is {share:g}, and stands for a part of the error"
        raise DesignError("share", what, "take a number between 0 and 1, such as 0.9")


def _boxes(body: BodyMesh, voxels: Ints, most: int) -> Iterator[Region]:
    """Yield regions that catch some voxels of a body, and few others."""
    mesh = body.mesh
    voxels = voxels - body.first_tet // 5
    voxels = voxels[(voxels >= 0) & (voxels < len(mesh.tets) // 5)]
    size, low = voxel_size(mesh), mesh.vertices.min(axis=0)
    first = mesh.vertices[mesh.voxel_corners(voxels)[:, 0]]
    cells = np.rint((first - low) / size).astype(np.int64)
    coarse = 1
    while len(found := _merged(np.unique(cells // coarse, axis=0))) > most:
        coarse *= 2
    for begin, end in found:
        # From the middle of the first voxel to that of the last: a region catches vertices within
        # half of a small voxel's edge, and so none of the neighbors' own.
        sides = np.stack([begin * coarse + 0.5, (end + 1) * coarse - 0.5], axis=1)
        ranges = np.round(low[:, None] + size * sides, 9)
        x, y, z = ((float(a), float(b)) for a, b in ranges)
        yield Region(x=x, y=y, z=z, body=body.name or None)


def _merged(cells: Ints) -> list[tuple[Ints, Ints]]:
    """Merge cells to boxes that fill the same room, as the first and the last cell of each."""
    boxes = [(cell, cell) for cell in cells]
    for axis in (2, 1, 0):
        others = [other for other in range(3) if other != axis]
        boxes.sort(
            key=lambda box: (
                *(int(box[0][k]) for k in others),
                *(int(box[1][k]) for k in others),
                int(box[0][axis]),
            )
        )
        merged: list[tuple[Ints, Ints]] = []
        for begin, end in boxes:
            if merged:
                first, last = merged[-1]
                alike = all(first[k] == begin[k] and last[k] == end[k] for k in others)
                if alike and last[axis] + 1 == begin[axis]:
                    merged[-1] = (first, np.where(np.arange(3) == axis, end, last))
                    continue
            merged.append((begin, end))
        boxes = merged
    return boxes
