"""``voxsoft mesh``: a design to tetrahedra on disk."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import print_json, quantity, say

if TYPE_CHECKING:
    from voxsoft.mesh import Mesh


def mesh(
    design: DesignFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File to write: .vtu .msh .inp (in m) .stl .obj (in mm)."),
    ] = None,
    sets: Sets = None,
    json: Json = False,
) -> None:
    """Voxelize and mesh a design; print quality figures and write the mesh."""
    from voxsoft import files
    from voxsoft.design.discretization.discretize import mesh_of

    with errors_in_words(json=json):
        if out is not None:
            files.export(design, out, sets or [], mesh_alone=True)
        figures = _figures(mesh_of(files.load(design, assignments=sets or [])))
        if json:
            print_json(figures | {"file": None if out is None else str(out)})
            return
        for name, value in figures.items():
            if value is None:
                continue
            say(f"{name.replace('_', ' ')}: {_shown(name, value)}")
        if out is not None:
            say(f"wrote {out}")


def _figures(made: Mesh) -> dict[str, Any]:
    quality = made.quality
    return {
        "voxels": None if made.voxel_size is None else len(made.tets) // 5,
        "vertices": len(made.vertices),
        "tets": len(made.tets),
        "edges": len(made.edges),
        "triangles": len(made.triangles),
        "cavities": len(made.cavities),
        "volume": quality.volume,
        "area": quality.area,
        "smallest_tet": quality.smallest_tet,
        "largest_tet": quality.largest_tet,
        "euler_number": quality.euler_number,
        "conforming": quality.conforming,
        "watertight": quality.watertight,
    }


_KINDS = {"volume": "volume", "area": "area", "smallest_tet": "volume", "largest_tet": "volume"}


def _shown(name: str, value: float) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:,}" if isinstance(value, int) else quantity(value, _KINDS[name])
