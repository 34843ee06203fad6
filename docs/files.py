"""Write the page of files for users from the registry of formats: ``python docs/files.py``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Final

from voxsoft.formats.registry import FORMATS, Format

PAGE: Final = Path(__file__).parent / "how-to" / "files.md"
HEAD: Final = """# Which file goes where

Bodies come as surfaces, meshes or scans; tests come as tables, recordings and photographs. For each
format: its unit, its parts, the usual trap, and a command that reads it. This page is written from
the registry (`voxsoft.formats.registry`) by `python docs/files.py`;
[File formats](../reference/formats.md) has all that readers take and writers keep.

| to do | file | way |
|---|---|---|
"""
WAYS: Final = (
    (
        "simulate a body",
        "surface, mesh or scan",
        '`shape = { kind = "mesh", path = "part.stl", unit = "mm" }` in a design, or drop it on '
        "the studio",
    ),
    (
        "take one part of it",
        "parts by name",
        '`part = "left"` beside the path; `voxsoft check` lists the names',
    ),
    (
        "keep its own cells",
        "mesh",
        "`voxsoft.files.read_mesh` and `Setup` ([your own geometry](../tutorials/own-geometry.md))",
    ),
    (
        "fit a rubber",
        "stress and strain of a coupon",
        "`voxsoft material fit` ([material card](material-card.md))",
    ),
    (
        "fit a material to a body",
        "stations on a body at rest",
        "`voxsoft calibrate` ([a beam](../tutorials/calibrate-a-beam.md), "
        "[instruments](measured-data.md))",
    ),
    (
        "compare with an experiment",
        "stations, tests",
        "`voxsoft compare --measured` ([compare](compare.md))",
    ),
    (
        "look at measured data",
        "columns over time",
        '`print(vs.measured("test.tdms").account)` ([instruments](measured-data.md))',
    ),
)
EXAMPLE: Final = """
A command says what it took of a file, and what it left out:

```python
import numpy as np

np.save("scan.npy", np.ones((4, 3, 2), np.uint8))
```

```console
$ voxsoft check scan.npy --unit '2 mm'
NumPy array, numbers times 0.002 m
...
24 voxels, ...
...
valid
```
"""
SECTIONS: Final[tuple[tuple[str, str, Callable[[Format], bool]], ...]] = (
    (
        "Surfaces",
        "Triangles around a body. Names in the file are parts that a shape can take alone.",
        lambda form: form.kind == "surface",
    ),
    (
        "Meshes and scans",
        "Cells with a volume. Of a scan each voxel whose label is not 0 is a brick, and its label "
        "a part; gray values have to be segmented first.",
        lambda form: form.kind in ("cells", "voxels"),
    ),
    (
        "Measured data",
        "Columns of instruments. A unit that is not in the file is asked for; times too, where "
        "they count. TDMS and C3D need `pip install 'voxsoft[measured]'`.",
        lambda form: form.kind == "measured",
    ),
)
ROW: Final = "| file | unit | parts | trap and limit | command |\n|---|---|---|---|---|\n"


def page() -> str:
    """Return the text of the page."""
    sections = []
    for title, sentence, belongs in SECTIONS:
        rows = "\n".join(_row(form) for form in FORMATS if form.reader and belongs(form))
        head = ROW.replace("| parts |", "| columns |") if title == "Measured data" else ROW
        sections.append(f"\n## {title}\n\n{sentence}\n\n{head}{rows}\n")
    ways = "".join(f"| {' | '.join(way)} |\n" for way in WAYS)
    return HEAD + ways + EXAMPLE + "".join(sections)


def _row(form: Format) -> str:
    suffixes = " ".join(f"`{suffix}`" for suffix in form.suffixes)
    return f"| {suffixes} | {form.states} | {form.parts} | {form.trap} | `{form.command}` |"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
