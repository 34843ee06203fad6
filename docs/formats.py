"""Write the page of file formats from the registry: ``python docs/formats.py``."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from voxsoft.formats.registry import FORMATS, Holding

PAGE: Final = Path(__file__).parent / "reference" / "formats.md"
HEAD: Final = """# File formats

Formats of meshes and surfaces that VoxSoft reads, and of files that it writes. This page is written
from the registry (`voxsoft.formats.registry`) by `python docs/formats.py`; readers, `voxsoft
export` and its help, and the studio's lists follow it.

## Read

A surface becomes a shape, volume cells also a mesh with parts and regions
([your own geometry](../tutorials/own-geometry.md)). Most files do not say their unit: it is asked
for.

| suffix | format | taken |
|---|---|---|
"""
MEASURED: Final = """
## Measured data

Columns of instruments over time, by `voxsoft.measured`; `voxsoft material fit` takes them, and
`calibrate` and `compare` by a test ([which file goes where](../how-to/files.md)).

| suffix | format | taken |
|---|---|---|
"""
WRITTEN: Final = """
## Written

Writers: `voxsoft export`, `voxsoft.files.write_mesh`, the studio ([export](../how-to/export.md)).
A mesh keeps its geometry in every format; the columns list further data of a file.

| suffix | format | parts | regions | cavities | values | unit |
|---|---|---|---|---|---|---|
"""
COLUMNS: Final[tuple[Holding, ...]] = ("parts", "regions", "cavities", "values")


def page() -> str:
    """Return the text of the page."""
    read, measured = (
        [
            f"| {', '.join(f'`{s}`' for s in form.suffixes)} | {form.title} | {form.taken} |"
            for form in FORMATS
            if form.reader is not None and (form.kind == "measured") == is_measured
        ]
        for is_measured in (False, True)
    )
    written = []
    for form in FORMATS:
        if form.writer is None:
            continue
        kept = ["yes" if c in form.holds else "no" for c in COLUMNS]
        if form.kind in ("design", "table"):
            kept = [""] * len(COLUMNS)
        unit = "given by `--unit`; mm if left out" if form.unit is None else form.unit
        suffixes = ", ".join(f"`{suffix}`" for suffix in form.suffixes)
        written.append(f"| {suffixes} | {form.title} | {' | '.join(kept)} | {unit} |")
    tables = (HEAD, read), (MEASURED, measured), (WRITTEN, written)
    return "".join(f"{head}{chr(10).join(rows)}\n" for head, rows in tables)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
