"""What a body can be colored by, as the core says. A page without a server needs no more."""

from __future__ import annotations

from typing import Final

from voxsoft import _core
from voxsoft.studio import events

#: Fields that color the body, by the number that frames carry.
FIELDS: Final = tuple(
    events.Field(id=number, name=name, title=title, unit=unit, signed=signed)
    for number, name, title, unit, signed in _core.FIELDS
)
#: Number of the field that is zero wherever nothing has moved.
DISPLACEMENT: Final = next(field.id for field in FIELDS if field.name == "displacement")
