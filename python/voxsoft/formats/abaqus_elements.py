"""Element types of Abaqus and CalculiX, and the kind of cell of each."""

from __future__ import annotations

import re
from typing import Final

#: Cells by the letters of the type and its number of nodes; letters after the number give the
#: integration, or that it is hybrid, and change no shape.
_SOLIDS: Final = {
    4: "tetra",
    5: "pyramid",
    6: "wedge",
    8: "hexahedron",
    10: "tetra10",
    13: "pyramid13",
    15: "wedge15",
    20: "hexahedron20",
    27: "hexahedron27",
}
_FACES: Final = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_TYPES: Final = (
    (r"(?:D|A)?C3D(\d+)|SC(\d+)", _SOLIDS),
    (r"(?:CPS|CPE|CPEG|CAX|DS|DC2D|M3D|SFM3D|R3D|STRI|S)(\d+)", _FACES),
    (r"T[23]D([23])", {2: "line", 3: "line3"}),
    (r"B[23]([12])", {1: "line", 2: "line3"}),
)


def kind_of(element: str) -> str | None:
    """Return the kind of cell of an element type; None for types without a shape, such as masses.

    Examples
    --------
    >>> kind_of("C3D4H"), kind_of("c3d10mh"), kind_of("C3D8R"), kind_of("S4R"), kind_of("MASS")
    ('tetra', 'tetra10', 'hexahedron', 'quad', None)
    """
    if re.fullmatch(r"STRI65", element, re.IGNORECASE):
        return "triangle6"
    for pattern, kinds in _TYPES:
        found = re.fullmatch(f"(?:{pattern})[A-Z]*", element, re.IGNORECASE)
        if found:
            return kinds.get(int(next(filter(None, found.groups()))))
    return None
