"""All shapes as one type: what a design's ``shapes`` table and every operand hold."""

from __future__ import annotations

import typing
from typing import Annotated

from pydantic import Field

from voxsoft.shapes.base import Shape
from voxsoft.shapes.booleans import Difference, Intersection, Union
from voxsoft.shapes.expressions import Expression
from voxsoft.shapes.functions import Function
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
from voxsoft.shapes.surfaces import Blend, Grade, Offset, Shell
from voxsoft.shapes.transforms import Bend, Mirror, Rotate, Scale, Taper, Translate, Twist
from voxsoft.shapes.triangles import TriangleMesh

#: Any shape, told apart by its ``kind``.
AnyShape = Annotated[
    Box
    | RoundedBox
    | Sphere
    | Ellipsoid
    | Cylinder
    | Tube
    | Cone
    | Capsule
    | Torus
    | HalfSpace
    | Prism
    | Revolve
    | Gyroid
    | SchwarzP
    | SchwarzD
    | Neovius
    | IWP
    | Cubic
    | Bcc
    | Fcc
    | Octet
    | Expression
    | Function
    | TriangleMesh
    | Union
    | Intersection
    | Difference
    | Offset
    | Shell
    | Blend
    | Grade
    | Translate
    | Rotate
    | Scale
    | Mirror
    | Twist
    | Bend
    | Taper
    | Array
    | PolarArray,
    Field(discriminator="kind"),
]

#: The class of each kind.
KINDS: dict[str, type[Shape]] = {
    shape.model_fields["kind"].default: shape
    for shape in typing.get_args(typing.get_args(AnyShape)[0])
}

# Operands may be any shape, which exists only now.
for _shape in KINDS.values():
    _shape.model_rebuild(_types_namespace={"AnyShape": AnyShape})
