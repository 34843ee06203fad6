"""Strain beyond the tested range of a material."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.design.tested import tested_ranges
from voxsoft.fields import Fields
from voxsoft.simulation.diagnostic import Diagnostic
from voxsoft.units import format_percent

#: Percent of a part's volume that must stay within the tests.
#:
#: At a sharp inner corner strain has no bound: the finer the voxels the larger it is, in an ever
#: smaller volume around the corner. The largest of all voxels thus says more of the mesh than of
#: the body; the strain that the most strained hundredth of the volume exceeds converges.
WITHIN: Final = 99.0


def beyond_tests(design: Design, fields: Fields) -> Iterator[Diagnostic]:
    """Find parts of which more than a hundredth is strained beyond the tests of its material.

    Parameters
    ----------
    design
        The design, whose materials may state their tested range.
    fields
        Its stress and strain.

    Yields
    ------
    Diagnostic
        At most two for each part: pulled too far, pressed too far; at the worst voxel.
    """
    for index, (part, tested) in enumerate(zip(design.parts, tested_ranges(design), strict=True)):
        own = np.flatnonzero(fields.parts == index)
        if tested is None or len(own) == 0:
            continue
        where = f'parts[{index}] "{part.name}"' if part.name else f"parts[{index}]"
        pulled = fields.principal_stretches[own, 0]
        yield from _beyond(fields, own, pulled, tested.largest, where, "stretched", 1.0)
        if tested.smallest is not None:
            pressed = fields.principal_stretches[own, 2]
            yield from _beyond(fields, own, pressed, tested.smallest, where, "pressed", -1.0)


def _beyond(
    fields: Fields,
    own: NDArray[np.intp],
    stretches: NDArray[np.float64],
    limit: float,
    where: str,
    how: str,
    sign: float,
) -> Iterator[Diagnostic]:
    beyond = sign * stretches > sign * limit
    share = float(fields.volumes[own][beyond].sum() / fields.volumes[own].sum())
    if share <= 1.0 - WITHIN / 100.0:
        return
    worst = int(np.argmax(sign * stretches))
    x, y, z = fields.centers[own[worst]]
    yield Diagnostic(
        "warning",
        where,
        f"{format_percent(share)} of its volume is {how} beyond {limit:g} times its length, which "
        f"is as far as its material was tested; the worst voxel to {stretches[worst]:.3g}",
        "take the numbers there for an extrapolation; lower the load, make it thicker, or use a "
        "material that was tested farther",
        at=(float(x), float(y), float(z)),
    )
