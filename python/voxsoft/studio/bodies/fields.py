"""Fields that color a body: those of the core, and those that contact adds.

A page without a server needs no more than the first.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voxsoft import _core
from voxsoft.simulation.results.contact_field import ContactField
from voxsoft.studio.protocol import events

#: Fields that color the body, by the number that frames carry.
FIELDS: Final = tuple(
    events.Field(id=number, name=name, title=title, unit=unit, signed=signed)
    for number, name, title, unit, signed in _core.FIELDS
)
#: Number of the field that is zero wherever nothing has moved.
DISPLACEMENT: Final = next(field.id for field in FIELDS if field.name == "displacement")
#: Fields that a solution with contact has at its end; their numbers follow those of the core.
CONTACT_FIELDS: Final = tuple(
    events.Field(
        id=len(FIELDS) + index, name=name, title=title, unit=unit, signed=False, contact=True
    )
    for index, (name, title, unit) in enumerate(
        (
            ("contact_pressure", "Contact pressure", "Pa"),
            ("contact_friction", "Friction of contact", "Pa"),
            ("contact_gap", "Gap of contact", "m"),
        )
    )
)
_NAMES: Final = {field.id: field.name for field in CONTACT_FIELDS}


def contact_values(number: int, found: ContactField | None) -> NDArray[np.float64] | None:
    """A field of contact at each vertex of the mesh, (n,); None for a field of the core.

    Zero where contact is not known. Where nothing is near, the gap is the largest that there is:
    pictures have no color for infinite values.
    """
    name = _NAMES.get(number)
    if name is None:
        return None
    if found is None:
        return np.zeros(0)
    if name == "contact_pressure":
        return found.pressure
    if name == "contact_friction":
        sizes: NDArray[np.float64] = np.linalg.norm(found.friction, axis=1)
        return sizes
    near = np.isfinite(found.gap)
    return np.where(near, found.gap, found.gap[near].max(initial=0.0))
