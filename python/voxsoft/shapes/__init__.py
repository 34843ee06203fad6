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

from voxsoft.shapes.base import Scope, Shape
from voxsoft.shapes.booleans import Difference, Intersection, Union
from voxsoft.shapes.catalog import KINDS, AnyShape
from voxsoft.shapes.expressions import (
    Expression,
    atan2,
    cos,
    exp,
    log,
    maximum,
    minimum,
    sin,
    sqrt,
    tan,
    x,
    y,
    z,
)
from voxsoft.shapes.functions import Function
from voxsoft.shapes.grammar import random_shape
from voxsoft.shapes.periodic import (
    IWP,
    Bcc,
    Cubic,
    Fcc,
    Gyroid,
    Neovius,
    Octet,
    SchwarzD,
    SchwarzP,
)
from voxsoft.shapes.primitives import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    Prism,
    Revolve,
    RoundedBox,
    Sphere,
    Torus,
    Tube,
)
from voxsoft.shapes.repeats import Array, PolarArray
from voxsoft.shapes.sampling import grid_bounds, inside, voxelize
from voxsoft.shapes.surfaces import Blend, Grade, Offset, Shell
from voxsoft.shapes.transforms import Bend, Mirror, Rotate, Scale, Taper, Translate, Twist
from voxsoft.shapes.triangles import TriangleMesh

__all__ = [
    "IWP",
    "KINDS",
    "AnyShape",
    "Array",
    "Bcc",
    "Bend",
    "Blend",
    "Box",
    "Capsule",
    "Cone",
    "Cubic",
    "Cylinder",
    "Difference",
    "Ellipsoid",
    "Expression",
    "Fcc",
    "Function",
    "Grade",
    "Gyroid",
    "HalfSpace",
    "Intersection",
    "Mirror",
    "Neovius",
    "Octet",
    "Offset",
    "PolarArray",
    "Prism",
    "Revolve",
    "Rotate",
    "RoundedBox",
    "Scale",
    "SchwarzD",
    "SchwarzP",
    "Scope",
    "Shape",
    "Shell",
    "Sphere",
    "Taper",
    "Torus",
    "Translate",
    "TriangleMesh",
    "Tube",
    "Twist",
    "Union",
    "atan2",
    "cos",
    "exp",
    "grid_bounds",
    "inside",
    "log",
    "maximum",
    "minimum",
    "random_shape",
    "sin",
    "sqrt",
    "tan",
    "voxelize",
    "x",
    "y",
    "z",
]
