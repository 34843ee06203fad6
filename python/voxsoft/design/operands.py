"""Names, and fields that take either a name or the thing itself."""

from __future__ import annotations

import re
from typing import Annotated, Final

from pydantic import AfterValidator, Discriminator, StringConstraints, Tag

from voxsoft.errors import DesignError
from voxsoft.shapes import AnyShape

Name = Annotated[str, StringConstraints(min_length=1, max_length=200)]

_IN_FORMULAS: Final = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_RESERVED: Final = frozenset({"min", "max", "name", "description"})


def _check_parameter_name(name: str) -> str:
    if name in _RESERVED or not _IN_FORMULAS.fullmatch(name):
        what = f'"{name}" cannot be the name of a parameter'
        raise DesignError("", what, 'use letters, digits and "_", such as wall_2')
    return name


#: A name that formulas can use.
ParameterName = Annotated[Name, AfterValidator(_check_parameter_name)]


def name_or_table(value: object) -> str:
    """Tell pydantic which of the two a value is."""
    return "name" if isinstance(value, str) else "table"


ShapeOrName = Annotated[
    Annotated[Name, Tag("name")] | Annotated[AnyShape, Tag("table")],
    Discriminator(name_or_table),
]
