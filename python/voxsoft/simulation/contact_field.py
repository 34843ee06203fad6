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
    """What touches each vertex of a body; inner vertices and those that nothing touches have 0.

    Attributes
    ----------
    pressure
        In Pa, (n,): the contact force that a vertex carries over the area that it stands for now.
    friction
        On the body, in Pa, (n, 3).
    gap
        To what a vertex faces, in m, (n,); infinite where nothing is near.
    area
        Of the surface now that each vertex stands for, in m², (n,); where it is pressed, of the
        side toward that. The sum of pressure times area is the sum of the contact forces; of a body
        that touches itself both sides count.
    """

    pressure: Floats
    friction: Floats
    gap: Floats
    area: Floats

    @classmethod
    def of(cls, found: CoreContactField | None) -> Self | None:
        """As the core found it; None for a problem without contact."""
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
