"""Names of 3MF that its reader and its writer share."""

from __future__ import annotations

from typing import Final

#: Namespace of the core specification.
CORE: Final = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
CONTENT_TYPES: Final = "[Content_Types].xml"
RELATIONSHIPS: Final = "_rels/.rels"
MODEL_PATH: Final = "3D/3dmodel.model"
