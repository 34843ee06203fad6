"""A design on voxels of another size."""

from __future__ import annotations

from voxsoft.design import Design


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
