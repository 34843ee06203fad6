"""Hashes of designs in all methods: whether a change moves a bit of them.

``python benchmarks/golden.py --save before.json`` on one state of the code, and
``--against before.json`` on another, on one machine: other processors sum in another order.
Each row has three hashes: of the cells and their place, of the mesh, and of the positions that
were solved for. ``--voxels`` leaves out the last, which takes a minute.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import voxsoft as vs
from voxsoft.design import Design, families
from voxsoft.design.discretization.discretize import filled, mesh_of
from voxsoft.design.solver import Solver
from voxsoft.simulation import simulate

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Examples that are solved within seconds; of the others cells and mesh are hashed.
SOLVED = (
    "beam", "bellows", "bender", "cylinder", "dielectric_bender", "finger", "pinch", "pneunet",
    "pulsed_finger", "shape_memory_finger", "sphere", "tendon_finger", "toolkit_pneunet",
)  # fmt: skip
#: The families in the methods that the examples leave out.
METHODS: dict[str, dict[str, Any]] = {
    "relaxation": {"method": "relaxation"},
    "dynamics": {"method": "dynamics", "end_time": 0.05},
    "arc-length": {"method": "statics", "control": "arc-length"},
}


def designs() -> Iterator[tuple[str, Design, bool]]:
    """Name, design, and whether it is solved."""
    for path in sorted(EXAMPLES.glob("*.toml")):
        yield path.stem, vs.load(path), path.stem in SOLVED
    for name in ("paper_beam", "paper_cylinder"):
        yield name, families.family(name.replace("_", "-")), True
    for fill in ("binary", "fraction"):
        ball = families.sphere().model_copy(update={"fill": fill})
        yield f"sphere, {fill}", ball, True
    for name, settings in METHODS.items():
        base = families.paper_beam() if name != "arc-length" else families.cylinder()
        solver = Solver.model_validate(settings)
        yield (
            f"{'beam' if name != 'arc-length' else 'cylinder'}, {name}",
            base.model_copy(update={"solver": solver}),
            True,
        )


def digest(*arrays: Any) -> str:
    """The first 16 digits of the SHA-256 of some arrays, with their shapes."""
    found = hashlib.sha256()
    for array in arrays:
        values = np.ascontiguousarray(array)
        found.update(str((values.dtype.str, values.shape)).encode())
        found.update(values.tobytes())
    return found.hexdigest()[:16]


def hashes(design: Design, solved: bool) -> dict[str, str]:
    """The hashes of one design."""
    grids = filled(design).each.values()
    cells = digest(*(part for each in grids for part in (each.voxels.array, each.voxels.origin)))
    mesh = mesh_of(design)
    row = {"cells": cells, "mesh": digest(mesh.vertices, mesh.tets, mesh.tet_part)}
    if solved:
        quiet = design.solver.model_copy(update={"error": "off"})
        result = simulate(design.model_copy(update={"solver": quiet}))
        row["solution"] = digest(result.positions)
    return row


def main() -> int:
    """Hash, then save or compare; 1 where a hash differs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--save", type=Path)
    parser.add_argument("--against", type=Path)
    parser.add_argument("--voxels", action="store_true")
    options = parser.parse_args()
    before = json.loads(options.against.read_text()) if options.against else {}
    found, moved = {}, 0
    for name, design, solved in designs():
        row = found[name] = hashes(design, solved and not options.voxels)
        old = before.get(name, row)
        differs = [key for key, value in row.items() if old.get(key, value) != value]
        moved += bool(differs)
        note = f"moved: {', '.join(differs)}" if differs else ""
        print(f"{name:24} {' '.join(row.values())} {note}", flush=True)
    print(f"{len(found)} designs, {moved} moved")
    if options.save:
        options.save.write_text(json.dumps(found, indent=1) + "\n")
    return int(moved > 0)


if __name__ == "__main__":
    sys.exit(main())
