"""What a body can be colored by. A page without a server needs no more of the catalog."""

from __future__ import annotations

from typing import Final

from voxsoft.studio import events

#: Number of the field that is zero wherever nothing has moved.
DISPLACEMENT: Final = 0
#: Fields that color the body, by the number that frames carry.
FIELDS: Final = (
    events.Field(
        id=DISPLACEMENT, name="displacement", title="Displacement", unit="m", signed=False
    ),
    events.Field(id=1, name="dx", title="Displacement along x", unit="m", signed=True),
    events.Field(id=2, name="dy", title="Displacement along y", unit="m", signed=True),
    events.Field(id=3, name="dz", title="Displacement along z", unit="m", signed=True),
    events.Field(id=4, name="stretch", title="Largest principal stretch", unit="", signed=False),
    events.Field(id=5, name="stress", title="Von Mises stress", unit="Pa", signed=False),
    events.Field(id=6, name="energy", title="Strain energy density", unit="J/m^3", signed=False),
    events.Field(id=7, name="pressure", title="Pressure (mean stress)", unit="Pa", signed=True),
    events.Field(id=8, name="speed", title="Speed", unit="m/s", signed=False),
)
