"""Layers on faces of bricks: membranes that share their nodes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Layer

Ints = NDArray[np.int64]

#: Largest Poisson's ratio of a membrane, which outside codes make a thin solid.
_LARGEST_POISSON = 0.49


@dataclass(frozen=True, eq=False)
class BrickLayer:
    """A layer bonded to faces of bricks.

    Attributes
    ----------
    number
        Number of the layer in the design.
    faces
        Faces that it covers, rows (brick, face); one brick of the two beside an inner face.
    young, poisson
        Young's modulus in Pa and Poisson's ratio, 0.49 at most.
    thickness
        Thickness in m.
    density
        Density in kg/m³.
    """

    number: int
    faces: Ints = field(repr=False)
    young: float
    poisson: float
    thickness: float
    density: float

    @classmethod
    def of(cls, number: int, layer: Layer, faces: Ints) -> BrickLayer:
        """Take the constants of a layer of a design."""
        poisson = min(layer.poisson, _LARGEST_POISSON)
        return cls(number, faces, layer.young, poisson, layer.thickness, layer.density)
