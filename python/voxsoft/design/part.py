"""Parts: what is made of what."""

from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag

from voxsoft.design.operands import Name, ShapeOrName, name_or_table
from voxsoft.materials import AnyMaterial, Fiber
from voxsoft.records import Record


class Part(Record):
    """A shape made of a material. Where parts overlap, the first one wins.

    Parameters
    ----------
    shape
        Name of a shape of the design, or a shape.
    material
        Name of a material card or of one of the design's own materials, or a
        material.
    fibers
        Families of fibers, up to 10, spread over the part, whose material must then be a
        hyperelastic one. Default: none.
    name
        What results call it; default: the shape's name.

    Examples
    --------
    >>> Part(shape="body", material="ecoflex-00-30").material
    'ecoflex-00-30'
    """

    shape: ShapeOrName
    material: Annotated[
        Annotated[Name, Tag("name")] | Annotated[AnyMaterial, Tag("table")],
        Discriminator(name_or_table),
    ]
    fibers: tuple[Fiber, ...] = Field((), max_length=10)
    name: Name | None = None
