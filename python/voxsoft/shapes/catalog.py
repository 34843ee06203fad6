"""Union type of all shapes, for a design's ``shapes`` table and every operand."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from operator import or_
from types import ModuleType
from typing import TYPE_CHECKING, Annotated

from pydantic import Field

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
from voxsoft.shapes.base import Shape

#: Modules of shapes, in the order of lists for people.
FILES = (
    primitives,
    periodic,
    expressions,
    functions,
    triangles,
    booleans,
    surfaces,
    transforms,
    repeats,
)


def _shapes_of(file: ModuleType) -> Iterator[type[Shape]]:
    """Yield the shapes that a file defines, in its order: the models whose kind has a name."""
    for model in vars(file).values():
        if isinstance(model, type) and issubclass(model, Shape):
            # Read without the fields of operands, whose type is not there yet.
            kind = model.__pydantic_fields__.get("kind")
            if model.__module__ == file.__name__ and kind and not kind.is_required():
                yield model


#: Class of each kind.
KINDS: dict[str, type[Shape]] = {
    shape.__pydantic_fields__["kind"].default: shape for file in FILES for shape in _shapes_of(file)
}

if TYPE_CHECKING:
    AnyShape = Shape
else:
    #: Any shape, discriminated by its ``kind``.
    AnyShape = Annotated[reduce(or_, KINDS.values()), Field(discriminator="kind")]

# Fields of operands name this type, which exists only now; each class is built on its first use.
for _file in FILES:
    vars(_file)["AnyShape"] = AnyShape
