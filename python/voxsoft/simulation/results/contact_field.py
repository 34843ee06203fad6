"""Contact over the surface of a body: pressure, friction and gap at each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from voxsoft._core import ContactField as CoreContactField

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class ContactField:
    """Contact at each vertex of a body; 0 at inner vertices and at those without contact.

    Attributes
    ----------
    pressure
        Contact force on a vertex over its present tributary area, Pa, (n,).
    friction
        Friction on the body, Pa, (n, 3).
    gap
        Distance of a vertex from the surface that it faces, m, (n,); infinite where none is near.
    area
        Tributary area of each vertex on the deformed surface, m², (n,); where it is pressed, of the
        side toward the contact. The sum of pressure times area is the sum of the contact forces; in
        self-contact both sides count.
    """

    pressure: Floats
    friction: Floats
    gap: Floats
    area: Floats

    @classmethod
    def of(cls, found: CoreContactField | None) -> Self | None:
        """Wrap the core's contact field; None for a problem without contact."""
        if found is None:
            return None
        return cls(found.pressure, found.friction, found.gap, found.area)

    def point_data(self) -> dict[str, Floats]:
        """Arrays on the vertices for a VTU file, in SI units; NaN for the gap to nothing."""
        return {
            "contact_pressure": self.pressure,
            "contact_friction": self.friction,
            "contact_gap": np.where(np.isfinite(self.gap), self.gap, np.nan),
        }

    def __repr__(self) -> str:
        return f"ContactField({np.count_nonzero(self.pressure)} vertices touch)"
