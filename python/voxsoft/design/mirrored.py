"""The mirror image of a design's entries: shapes, places and directions."""

from __future__ import annotations

from typing import Any, Literal, TypeVar

from voxsoft.design.activation import AnyActivation
from voxsoft.design.dielectric import Dielectric
from voxsoft.design.part import Part
from voxsoft.design.region import Region
from voxsoft.materials import Fiber
from voxsoft.shapes import Mirror, Shape

Triple = tuple[float, float, float]
Axis = Literal["x", "y", "z"]
_Region = TypeVar("_Region", bound=Region)


def mirrored_point(at: Triple, axis: Axis) -> Triple:
    """Return the image of a point or direction in the plane through the origin across an axis.

    Examples
    --------
    >>> mirrored_point((1.0, 2.0, 3.0), "y")
    (1.0, -2.0, 3.0)
    """
    x, y, z = (
        0.0 - value if name == axis else value for name, value in zip("xyz", at, strict=True)
    )
    return x, y, z


def mirrored_shape(shape: str | Shape, axis: Axis) -> Shape:
    """Return the image of a shape, or of the one that a name means."""
    return Mirror(of=shape, normal=axis)


def mirrored_region(region: _Region, axis: Axis) -> _Region:
    """Return the image of a place: a region, probe or chamber.

    Examples
    --------
    >>> mirrored_region(Region(x=("-1 mm", "5 mm"), z=(0, 0)), "x").x
    (-0.005, 0.001)
    """
    changes: dict[str, Any] = {}
    bounds = getattr(region, axis)
    if bounds is not None:
        changes[axis] = (0.0 - bounds[1], 0.0 - bounds[0])
    for key in ("center", "point"):
        at = getattr(region, key, None)
        if at is not None:
            changes[key] = mirrored_point(at, axis)
    if region.shape is not None:
        changes["shape"] = mirrored_shape(region.shape, axis)
    return region.replace(**changes)


def mirrored_part(part: Part, axis: Axis) -> Part:
    """Return the image of a part, under its name or else that of its shape.

    Fibers and the arrow of a remanence are mirrored with it, as they are drawn.
    """
    named = part.shape if isinstance(part.shape, str) else None
    fibers = [mirrored_fiber(fiber, axis) for fiber in part.fibers]
    remanence = None if part.remanence is None else mirrored_point(part.remanence, axis)
    return part.replace(
        shape=mirrored_shape(part.shape, axis),
        fibers=fibers,
        remanence=remanence,
        name=part.name or named,
    )


def mirrored_activation(activation: AnyActivation, axis: Axis) -> AnyActivation:
    """Mirror the activation of a part: a sheet with its normal, a profile with its axis."""
    if isinstance(activation, Dielectric):
        return activation.replace(normal=mirrored_point(activation.normal, axis))
    profile = getattr(activation, "profile", None)
    return activation if profile is None else activation.replace(profile=profile.mirrored(axis))


def mirrored_fiber(fiber: Fiber, axis: Axis) -> Fiber:
    """The image of a family of fibers: a right-handed helix becomes a left-handed one."""
    if fiber.direction is not None:
        return fiber.replace(direction=mirrored_point(fiber.direction, axis))
    assert fiber.angle is not None  # fibers that are not straight are wound
    center = None if fiber.center is None else mirrored_point(fiber.center, axis)
    return fiber.replace(axis=mirrored_point(fiber.unit, axis), center=center, angle=-fiber.angle)
