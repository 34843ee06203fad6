"""Files of CAD programs, which hold no triangles, and the error message for them."""

from __future__ import annotations

from typing import Final

#: Suffixes of files that hold curved faces as formulas, in any case.
CAD_SUFFIXES: Final = (
    *(".step", ".stp", ".p21", ".iges", ".igs", ".brep", ".brp", ".fcstd"),
    *(".sldprt", ".sldasm", ".ipt", ".f3d", ".x_t", ".x_b", ".sat", ".3dm"),
)
WHAT: Final = "is a CAD model, whose faces are formulas: only triangles are read"
HINT: Final = (
    "export the part as STL or OBJ in the CAD program, or open it in FreeCAD, choose the body and "
    "take File, Export"
)


def is_cad_file(name: str) -> bool:
    """Return True if a file name is that of a CAD model.

    Examples
    --------
    >>> is_cad_file("Finger v2.STEP"), is_cad_file("finger.stl")
    (True, False)
    """
    return name.lower().endswith(CAD_SUFFIXES)
