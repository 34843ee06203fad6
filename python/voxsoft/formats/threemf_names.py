"""Names of 3MF that its reader and its writer share."""

from __future__ import annotations

from typing import Final

#: Namespace of the core specification.
CORE: Final = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
CONTENT_TYPES: Final = "[Content_Types].xml"
RELATIONSHIPS: Final = "_rels/.rels"
MODEL_PATH: Final = "3D/3dmodel.model"
#: Meters in each unit.
UNITS: Final = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
