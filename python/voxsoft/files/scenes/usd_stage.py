"""Names and values of a USD stage."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Tf, Vt

if TYPE_CHECKING:
    from pxr import Usd

Floats = NDArray[np.float64]


class Names:
    """Paths of prims, each once: names of a design hold characters that paths do not.

    Examples
    --------
    >>> names = Names()
    >>> names.path("/robot", "left pad"), names.path("/robot", "left_pad")
    ('/robot/left_pad', '/robot/left_pad_2')
    """

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def path(self, parent: str, name: str) -> str:
        """Return a path of a child by its name, or one like it."""
        own = Tf.MakeValidIdentifier(name)
        path, number = f"{parent}/{own}", 1
        while path in self._taken:
            number += 1
            path = f"{parent}/{own}_{number}"
        self._taken.add(path)
        return path


def named(prim: Usd.SchemaBase, name: str) -> Usd.Prim:
    """Keep the name of a prim in the design as the one that programs show."""
    found = prim.GetPrim()
    found.SetMetadata("displayName", name)
    return found


def points(values: Floats) -> Vt.Vec3fArray:
    """Return points, (n, 3), m."""
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def extent(values: Floats) -> Vt.Vec3fArray:
    """Return the bounds of points, rounded outward to single precision."""
    low, high = np.float32(values.min(axis=0)), np.float32(values.max(axis=0))
    pad = np.float32(np.abs(values).max() * 1e-7)
    return points(np.array([low - pad, high + pad]))


def vector(values: Floats) -> Gf.Vec3f:
    """Return a vector, (3,)."""
    return Gf.Vec3f(*np.asarray(values).tolist())
