"""Mirror symmetry of fibers in the planes of symmetry of a design."""

from __future__ import annotations

from typing import Final

import numpy as np

from voxsoft.design import Design
from voxsoft.design.mirrored import mirrored_fiber
from voxsoft.design.symmetry import Symmetry
from voxsoft.errors import DesignError
from voxsoft.materials import Fiber

#: Tolerance between numbers of a family and those of its image, relative to 1: rounding of units.
_SAME: Final = 1e-9


def check_fiber_symmetry(design: Design) -> None:
    """Check that each plane of symmetry mirrors every family of fibers onto one of the same part.

    Parameters
    ----------
    design
        A design with planes of symmetry, and voxels that are symmetric in them.

    Raises
    ------
    DesignError
        A family without its image, such as a single helix.
    """
    for number, plane in enumerate(design.symmetry):
        for index, part in enumerate(design.parts):
            for fiber in part.fibers:
                image = _image(fiber, plane)
                if not any(_is_same(image, other) for other in part.fibers):
                    family = part.fibers.index(fiber)
                    raise DesignError(
                        f"symmetry[{number}].plane",
                        f"mirrors parts[{index}].fibers[{family}] onto fibers that the part does "
                        "not have",
                        "add the family at the opposite angle, or leave the plane out",
                    )


def _image(fiber: Fiber, plane: Symmetry) -> Fiber:
    image = mirrored_fiber(fiber, plane.plane)
    if not fiber.is_wound:
        return image
    center = np.array(image.center or (0.0, 0.0, 0.0))
    center[plane.axis] += 2.0 * plane.at
    return image.replace(center=tuple(center.tolist()))


def _is_same(one: Fiber, other: Fiber) -> bool:
    """Return True if two families run along the same lines, in either direction."""
    if (one.modulus, one.compression) != (other.modulus, other.compression):
        return False
    if one.is_wound != other.is_wound:
        return False
    if np.linalg.norm(np.cross(one.unit, other.unit)) > _SAME:
        return False
    if one.angle is None or other.angle is None:
        return True
    # An axis and its opposite have the same families: both parts of the direction change sign.
    point = np.array([one.center or (0.0, 0.0, 0.0)])
    size = max(1e-3, float(np.abs(point).max()))
    if other.distances(point)[0] > _SAME * size:
        return False
    return bool(abs(np.sin(one.angle - other.angle)) < _SAME)
