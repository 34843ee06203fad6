"""Writer of 3MF: an object for each surface, joined as components of one where there are several.

The file follows the core specification of the 3MF Consortium, version 1.3. The numbers are in mm,
and the file says so.
"""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from voxsoft.files.surface_formats.numbers import rows
from voxsoft.formats.threemf_names import CONTENT_TYPES, CORE, MODEL_PATH, RELATIONSHIPS

_XML: Final = '<?xml version="1.0" encoding="UTF-8"?>\n'
_PACKAGE: Final = "http://schemas.openxmlformats.org/package/2006"
_TYPES: Final = (
    f'{_XML}<Types xmlns="{_PACKAGE}/content-types"><Default Extension="rels" '
    f'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default '
    f'Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
    f"</Types>\n"
)
_RELATIONS: Final = (
    f'{_XML}<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="model" '
    f'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel" '
    f'Target="/{MODEL_PATH}"/></Relationships>\n'
)
#: Time of each file of the archive: the same surfaces give the same bytes.
_TIME: Final = (1980, 1, 1, 0, 0, 0)


def write(
    path: Path, surfaces: Mapping[str, tuple[NDArray[np.float64], NDArray[np.int64]]]
) -> None:
    """Write surfaces, in mm, each an object of its name."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(_entry(CONTENT_TYPES), _TYPES)
        archive.writestr(_entry(RELATIONSHIPS), _RELATIONS)
        with archive.open(_entry(MODEL_PATH), "w") as file:
            for text in _model(surfaces):
                file.write(text.encode("utf-8"))


def _entry(name: str) -> zipfile.ZipInfo:
    entry = zipfile.ZipInfo(name, _TIME)
    entry.compress_type = zipfile.ZIP_DEFLATED
    return entry


def _model(
    surfaces: Mapping[str, tuple[NDArray[np.float64], NDArray[np.int64]]],
) -> Iterator[str]:
    yield f'{_XML}<model unit="millimeter" xml:lang="en-US" xmlns="{CORE}">\n'
    yield '<metadata name="Application">VoxSoft</metadata>\n<resources>\n'
    for number, (name, (vertices, triangles)) in enumerate(surfaces.items(), start=1):
        yield f'<object id="{number}" type="model" name={_name(name)}>\n<mesh>\n<vertices>\n'
        yield from rows('<vertex x="%.9g" y="%.9g" z="%.9g"/>\n', vertices)
        yield "</vertices>\n<triangles>\n"
        yield from rows('<triangle v1="%d" v2="%d" v3="%d"/>\n', triangles)
        yield "</triangles>\n</mesh>\n</object>\n"
    built = len(surfaces)
    if built > 1:
        built += 1
        yield f'<object id="{built}" type="model">\n<components>\n'
        yield from (f'<component objectid="{number}"/>\n' for number in range(1, built))
        yield "</components>\n</object>\n"
    yield f'</resources>\n<build>\n<item objectid="{built}"/>\n</build>\n</model>\n'


def _name(name: str) -> str:
    """Quote a name; characters that XML cannot hold are left out."""
    return quoteattr("".join(letter for letter in name if letter.isprintable()))
