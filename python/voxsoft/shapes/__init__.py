"""Implicit shapes: a solid is a function s(x, y, z) in m, negative inside.

Primitives, periodic surfaces and lattices, free expressions, Python functions and triangle meshes,
joined by operators. Each shape is a frozen model; the same models read the ``[shapes]`` of a
design file, where ``kind`` names the class. Lengths are SI floats or text with a unit.

A cell belongs to a shape when s < 0 at its center, a shell when |s| < thickness/2 there: the
classification of the paper's Algorithm 1, equal to a float64 evaluation of every center.

Examples
--------
>>> from voxsoft.shapes import Box, Gyroid, voxelize
>>> sponge = Box(size=(0.02, 0.02, 0.02)) & Gyroid(period="10 mm", thickness="1 mm")
>>> voxels = voxelize(sponge, voxel_size=0.0005)
>>> voxels.shape
(40, 40, 40)
"""

from voxsoft.shapes import (
    booleans,
    expressions,
    functions,
    periodic,
    primitives,
    repeats,
    surfaces,
    transforms,
    triangles,
)
from voxsoft.shapes.base import Scope, Shape
from voxsoft.shapes.booleans import *
from voxsoft.shapes.catalog import KINDS, AnyShape
from voxsoft.shapes.expressions import *
from voxsoft.shapes.functions import *
from voxsoft.shapes.grammar import random_shape
from voxsoft.shapes.periodic import *
from voxsoft.shapes.primitives import *
from voxsoft.shapes.repeats import *
from voxsoft.shapes.sampling import inside, voxelize
from voxsoft.shapes.surfaces import *
from voxsoft.shapes.transforms import *
from voxsoft.shapes.triangles import *

__all__ = [
    "KINDS",
    "AnyShape",
    "Scope",
    "Shape",
    "inside",
    "random_shape",
    "voxelize",
]
__all__ += booleans.__all__
__all__ += expressions.__all__
__all__ += functions.__all__
__all__ += periodic.__all__
__all__ += primitives.__all__
__all__ += repeats.__all__
__all__ += surfaces.__all__
__all__ += transforms.__all__
__all__ += triangles.__all__
