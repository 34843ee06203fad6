"""Read report of a file that is read as a surface, to be filled with voxels."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from voxsoft.files import vtu
from voxsoft.formats.contents import CORNERS, Contents
from voxsoft.formats.read import read_contents
from voxsoft.formats.report import ReadReport, counted_cells, held_by
from voxsoft.formats.split import FACES
from voxsoft.formats.unit import doubt, meter_of
from voxsoft.shapes.surface_files import Surface


def account_of_surface(path: Path, surface: Surface, unit: str | None, ask: str) -> ReadReport:
    """Report all contents of a file beside the surface that was taken of it.

    Parameters
    ----------
    path, surface
        Path of the file, and its triangles.
    unit
        Unit of the numbers, None where the file should give it.
    ask
        Option by which a caller gives the unit: ``--unit`` or ``unit=``.

    Raises
    ------
    UnitError
        If neither the file nor the caller gives the unit.
    """
    points = surface.points[np.unique(surface.triangles)]
    contents = read_contents(path)
    known = 1.0 if path.suffix.lower() == ".vtu" and vtu.is_ours(path) else contents.unit
    meter = meter_of(path.name, known, unit, points, ask)
    caution = doubt(np.ptp(points, axis=0), meter)
    return ReadReport(
        contents.format,
        meter,
        held_by(contents),
        {"points": len(points), "triangles": len(surface.triangles)},
        differences=(*contents.notes, *_differences(contents)),
        cautions=(caution,) if caution else (),
    )


def _differences(contents: Contents) -> list[str]:
    """Write sentences on cells, sets and arrays that a surface does not have."""
    held = held_by(contents)
    solids = {kind: n for kind, n in held["cells"].items() if _base(kind) in FACES}
    sentences = []
    if solids:
        listed = ", ".join(counted_cells(kind, count) for kind, count in solids.items())
        sentences.append(f"The boundary of {listed} is taken")
    for kind, count in held["cells"].items():
        if kind != _base(kind) and CORNERS.get(_base(kind), 0) > 1:
            sentences.append(
                f"{counted_cells(kind, count)}: taken by the corners, with straight edges"
            )
        if kind not in solids and (solids or CORNERS.get(_base(kind), 3) < 3):
            sentences.append(f"{counted_cells(kind, count)}: left out")
    for word, names in (("Sets", held["sets"]), ("Regions", held["regions"])):
        if names:
            sentences.append(f"{word} are not taken, the body is one: {', '.join(names)}")
    if held["arrays"]:
        sentences.append(f"Arrays are not taken: {', '.join(held['arrays'])}")
    return sentences


def _base(kind: str) -> str:
    return kind.rstrip("0123456789")
