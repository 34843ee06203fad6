"""Names, and fields that take either a name or the thing itself."""

from __future__ import annotations

import os
import re
from typing import Annotated, Final

from pydantic import AfterValidator, Discriminator, Tag

from voxsoft.errors import DesignError
from voxsoft.materials import is_card_path
from voxsoft.records import Name
from voxsoft.shapes import AnyShape

__all__ = ["MaterialName", "Name", "ParameterName", "ShapeOrName", "name_or_table"]

_IN_FORMULAS: Final = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_RESERVED: Final = frozenset({"min", "max", "name", "description"})


def _check_parameter_name(name: str) -> str:
    if name in _RESERVED or not _IN_FORMULAS.fullmatch(name):
        what = f'"{name}" cannot be the name of a parameter'
        raise DesignError("", what, 'use letters, digits and "_", such as wall_2')
    return name


#: A name that formulas can use.
ParameterName = Annotated[Name, AfterValidator(_check_parameter_name)]


def _check_material_name(name: str) -> str:
    if is_card_path(name):
        what = (
            f'"{name}" cannot be the name of a material: it would be taken for the path of a card'
        )
        raise DesignError("", what, "leave .toml out")
    return name


#: A name that no part can mean a card's file by.
MaterialName = Annotated[Name, AfterValidator(_check_material_name)]


def name_or_table(value: object) -> str:
    """Tell pydantic which of the two a value is."""
    return "name" if isinstance(value, (str, os.PathLike)) else "table"


ShapeOrName = Annotated[
    Annotated[Name, Tag("name")] | Annotated[AnyShape, Tag("table")],
    Discriminator(name_or_table),
]
