"""One body of several, with all that decides how it is made."""

from __future__ import annotations

import math

from voxsoft.design import Clamp, Design, Region
from voxsoft.errors import DesignError


def one_body(design: Design, name: str) -> Design:
    """Return a design of one body in its own frame, with its clamps, layers and chambers.

    Raises
    ------
    DesignError
        No body has the name.

    Examples
    --------
    >>> from voxsoft.design import Body, families
    >>> beam = Body(name="left", design=families.beam(), position=(0, 0, 1))
    >>> pair = Design(name="one", voxel_size=0.01, bodies=[beam])
    >>> len(one_body(pair, "left").clamps)
    1
    """
    whole = design.assembled
    if name not in whole.body_names:
        known = ", ".join(whole.body_names)
        raise DesignError("body", f"{name!r} is not known", f"one of {known}")
    if not whole.bodies:
        return design
    inner = next((each.design for each in design.bodies if each.name == name), None)
    return whole.alone(name).replace(
        molds=design.molds or (inner.molds if isinstance(inner, Design) else None),
        clamps=[
            Clamp(region=_alone(each.region), axes=each.axes, name=each.name)
            for each in whole.clamps
            if each.region.body == name
        ],
        layers=[
            each.replace(region=_alone(each.region))
            for each in whole.layers
            if each.region.body == name
        ],
        chambers={
            key.removeprefix(f"{name}."): each.replace(body=None)
            for key, each in whole.chambers.items()
            if each.body == name
        },
    )


def _alone(region: Region) -> Region:
    """Return a region of a design of one body; all of it where there is no condition."""
    places = (region.x, region.y, region.z, region.radius, region.shape, region.name)
    if all(place is None for place in places):
        return Region(z=(-math.inf, math.inf))
    return region.replace(body=None)
