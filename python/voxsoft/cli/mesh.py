"""``voxsoft mesh``: a design to tetrahedra on disk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from voxsoft.cli.exits import errors_in_words
from voxsoft.cli.options import DesignFile, Json, Sets
from voxsoft.cli.output import print_json, say


def mesh(
    design: DesignFile,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File to write: .vtu, .msh, .inp, .stl or .obj."),
    ] = None,
    sets: Sets = None,
    json: Json = False,
) -> None:
    """Voxelise and mesh a design; print quality figures and write the mesh."""
    from voxsoft import files
    from voxsoft.design import mesh_of
    from voxsoft.simulation import named_regions

    with errors_in_words(json=json):
        loaded = files.load_with(design, sets or [])
        made = mesh_of(loaded)
        if out is not None:
            files.write_mesh(out, made, regions=named_regions(loaded, made))
        quality = made.quality
        figures = {
            "voxels": len(made.tets) // 5,
            "vertices": len(made.vertices),
            "tets": len(made.tets),
            "edges": len(made.edges),
            "triangles": len(made.triangles),
            "cavities": len(made.cavities),
            "volume": quality.volume,
            "area": quality.area,
            "euler_number": quality.euler_number,
            "conforming": quality.conforming,
            "watertight": quality.watertight,
        }
    if json:
        print_json(figures | {"file": None if out is None else str(out)})
    else:
        for name, value in figures.items():
            say(
                f"{name.replace('_', ' ')}: {value:,}"
                if isinstance(value, int)
                else f"{name}: {value:.6g}"
            )
        if out is not None:
            say(f"wrote {out}")
