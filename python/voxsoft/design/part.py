"""Parts: shapes with their materials."""

from __future__ import annotations

import os
from typing import Annotated

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Discriminator,
    Field,
    StringConstraints,
    Tag,
)

from voxsoft.design.load import FluxDensity
from voxsoft.design.operands import Name, ShapeOrName, name_or_table
from voxsoft.materials import AnyMaterial, Fiber, is_card_path
from voxsoft.records import Record, check_name


def _whole_path(name: object) -> object:
    """Complete the path of a card's file, so that it leads there from everywhere."""
    if isinstance(name, (str, os.PathLike)) and is_card_path(name):
        return os.path.abspath(name)  # noqa: PTH100 - as text, and without asking the disk
    return name


#: A name, or the path of a card's file, which may be longer.
CardOrName = Annotated[
    str,
    StringConstraints(min_length=1, max_length=4096),
    BeforeValidator(_whole_path),
    AfterValidator(check_name),
]


class Part(Record):
    """A shape made of a material. Where parts overlap, the first one wins.

    Parameters
    ----------
    shape
        Name of a shape of the design, or a shape; where the body is a mesh, the name of a part of
        its file, or ``"all"``.
    material
        Name of a material card or of one of the design's own materials, the path of a card's
        file (``"runs/mine/mine.toml"``), or a material. A relative path is meant from the folder of
        the design file, in Python from the working directory.
    fibers
        Families of fibers, up to 10, spread over the part, whose material must then be a
        hyperelastic one. Default: none.
    remanence
        Components x, y, z of the flux density that a hard magnet keeps, along the axes of its body,
        before it deforms; 0.05 to 0.2 T in rubber filled with powder of neodymium-iron-boron.
        Default: no magnet. It takes a load ``magnetic_field`` to act.
    name
        Name in results; default: the shape's name.
    body
        The body that it is of, in a design that has several.

    Examples
    --------
    >>> Part(shape="body", material="ecoflex-00-30").material
    'ecoflex-00-30'
    """

    shape: ShapeOrName
    material: Annotated[
        Annotated[CardOrName, Tag("name")] | Annotated[AnyMaterial, Tag("table")],
        Discriminator(name_or_table),
    ]
    fibers: tuple[Fiber, ...] = Field((), max_length=10)
    remanence: FluxDensity | None = None
    name: Name | None = None
    body: Name | None = None

    @property
    def label(self) -> str:
        """Its name, or that of its shape; empty where neither has one."""
        return self.name or (self.shape if isinstance(self.shape, str) else "")
