"""Molds of the open design: their numbers, their sheet, and all files as an archive."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from voxsoft.design import Design
from voxsoft.errors import ErrorDetail
from voxsoft.fabrication import ASKED_WAYS, Fabrication, Printer, make, one_body
from voxsoft.files.fabrication import write_fabrication
from voxsoft.studio.outputs.archive import archive
from voxsoft.studio.protocol import events
from voxsoft.units import parse


@dataclass(frozen=True)
class Molds:
    """Molds, and their archive and sheet where all proofs hold."""

    made: Fabrication
    archive: Path | None
    sheet: str


def make_molds(design: Design, asked: Mapping[str, Any], folder: Path) -> Molds:
    """Make the molds of a design, and write them as an archive.

    Parameters
    ----------
    design
        The design.
    asked
        ``way``, ``body`` and ``shrinkage`` as on the command line, empty for those of the design,
        and ``printer``: a table of limits, by name.
    folder
        Folder, which is made; the archive lies beside it.

    Raises
    ------
    VoxSoftError
        A wrong limit, or a body of which no samples can be taken.
    """
    if body := asked.get("body"):
        design = one_body(design, str(body))
    shrinkage = asked.get("shrinkage")
    printer = Printer() if design.molds is None else design.molds.printer
    limits = {key: value for key, value in (asked.get("printer") or {}).items() if value}
    made = make(
        design,
        way=next((way for way in ASKED_WAYS if way == asked.get("way")), None),
        printer=printer.replace(**limits),
        shrinkage=parse(str(shrinkage), "number") if shrinkage else None,
    )
    if made.problems:
        return Molds(made, None, "")
    write_fabrication(made, folder)
    sheet = (folder / "sheet.html").read_text("utf-8")
    return Molds(made, archive(folder, folder.with_suffix(".zip")), sheet)


def reported(molds: Molds, rev: int, url: str, name: str) -> events.Molds:
    """Return molds as the page shows them.

    Parameters
    ----------
    molds
        The molds.
    rev
        Revision of the document of which they were made.
    url, name
        Address and name of the archive; empty without one.
    """
    made = molds.made
    return events.Molds(
        rev=rev,
        way=made.way,
        why=made.why,
        castings=[
            events.Casting(
                name=cast.casting.name,
                material=cast.data.title if cast.data else cast.casting.component.material,
                volume=cast.volume,
                mass=cast.mass,
                a=cast.a,
                b=cast.b,
                deviation=cast.deviation,
                trapped_air=cast.mold.trapped,
                pot_life=cast.data.pot_life if cast.data else None,
                cure=cast.data.cure if cast.data else None,
            )
            for cast in made.casts
        ],
        files=list(made.surfaces()),
        notes=list(made.notes),
        problems=[_problem(each) for each in made.problems],
        sheet=molds.sheet,
        url=url,
        name=name,
    )


def _problem(each: ErrorDetail) -> events.MoldProblem:
    return events.MoldProblem(where=each.where, what=each.what, hint=each.hint)
