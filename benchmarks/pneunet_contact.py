"""A PneuNet whose facing walls meet: whether it gets there, how long it takes, how right it is.

``python benchmarks/pneunet_contact.py [--json] [--fine]``. `examples/pneunet_contact.toml` under
80 kPa with the default settings, with and without contact in turn (three times each
with `--fine`). Each quarter of the pressure is solved by itself too, and the surface looked at by
the exact test of `voxsoft.simulation.find_penetration`, and by ipctk where it is installed. The tip
is held against CalculiX with contact (`tests/data/contact/pneunet.csv`, made by
`benchmarks/make_pneunet_reference.py`) where that file is there.

A path that ends early says which part of the load was reached; what it reached is looked at too.
"""

from __future__ import annotations

import csv
import statistics
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from measure import Report

import voxsoft as vs
from voxsoft.simulation import Setup, find_penetration, simulate
from voxsoft.units import kPa

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples" / "pneunet_contact.toml"
REFERENCE = ROOT / "tests" / "data" / "contact" / "pneunet.csv"
#: The pressure of the tutorial, kPa.
FULL = 80.0
#: Parts of the pressure whose surfaces are looked at.
PARTS = (0.25, 0.5, 0.75, 1.0)


def crossing_faces(result: vs.Result) -> int | None:
    """Whether ipctk finds faces that intersect, 0 or 1; None where it is not installed."""
    if find_spec("ipctk") is None:
        return None
    import ipctk

    used, faces = np.unique(result.mesh.triangles, return_inverse=True)
    faces = faces.reshape(-1, 3)
    mesh = ipctk.CollisionMesh(result.mesh.vertices[used], ipctk.edges(faces), faces)
    return int(ipctk.has_intersections(mesh, result.positions[used]))


def look_at(report: Report, name: str, result: vs.Result) -> None:
    """Add how the surface of a result passes through itself."""
    found = find_penetration(result.mesh, result.positions)
    report.add(f"{name}: intersecting faces, exact", len(found.pairs), "")
    report.add(f"{name}: depth", found.depth / result.mesh.voxel_size, "voxels")
    crossing = crossing_faces(result)
    if crossing is not None:
        report.add(f"{name}: intersections, ipctk", crossing, "")


def reference(pressure: float) -> dict[str, float] | None:
    """The row of CalculiX with contact, its finest split, at a pressure in kPa."""
    if not REFERENCE.exists():
        return None
    with REFERENCE.open(newline="", encoding="utf-8") as lines:
        rows = [{key: float(text) for key, text in row.items()} for row in csv.DictReader(lines)]
    rows = [row for row in rows if row["contact"] == 1.0]
    rows = [row for row in rows if row["split"] == max(each["split"] for each in rows)]
    at = [row["pressure_kPa"] for row in rows]
    if pressure > max(at) + 1e-6:
        return None
    return {key: float(np.interp(pressure, at, [row[key] for row in rows])) for key in rows[0]}


def main() -> None:
    """Solve, look, compare."""
    report = Report("A PneuNet whose walls meet", fine="three solutions each way, and medians")
    touching = Setup.of(vs.load(EXAMPLE, pressure=FULL * kPa))
    apart = Setup.of(touching.design.replace(contact=None))
    seconds: dict[str, list[float]] = {"contact": [], "without contact": []}
    last: dict[str, vs.Result] = {}
    for _ in range(3 if report.options["fine"] else 1):
        for name, setup in (("contact", touching), ("without contact", apart)):
            last[name] = simulate(setup)
            seconds[name].append(last[name].seconds)
    failed = 0
    for name, result in last.items():
        failed += result.status != "ok"
        report.add(f"{name}: {result.status}, load reached", 100 * result.load_factor, "%")
        report.add(f"{name}: iterations", result.steps, "")
        ratio = statistics.median(seconds[name]) / statistics.median(seconds["without contact"])
        report.add(f"{name}: time", statistics.median(seconds[name]), "s", ratio)
    report.add(
        "contact: force between walls", sum(c.pressed for c in last["contact"].contacts), "N"
    )
    for part in PARTS:
        design = vs.load(EXAMPLE, pressure=part * FULL * kPa)
        result = last["contact"] if part == 1.0 else simulate(design)
        reached = part * FULL * result.load_factor
        failed += result.status != "ok"
        name = f"{part * FULL:g} kPa"
        report.add(f"{name}: {result.status}, load reached", 100 * result.load_factor, "%")
        look_at(report, name, result)
        expected = reference(reached)
        for axis in (0, 2):
            moved = 1e3 * float(result.probes["tip"][axis])
            title = f"{name}: tip along {'xyz'[axis]}"
            known = expected[f"tip_u{'xyz'[axis]}_mm"] if expected else None
            report.add(title, moved, "mm", None if known is None else moved / known)
    report.add("solutions that ended early", failed, "")
    report.show()


if __name__ == "__main__":
    main()
