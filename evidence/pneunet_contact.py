"""A PneuNet whose facing walls meet: whether it gets there, how long it takes, how right it is.

``python evidence/pneunet_contact.py [--json] [--fine]``. `examples/pneunet_contact.toml` under
80 kPa with the default settings, with and without contact in turn (three times each
with `--fine`). The surface that touches is looked at by the exact test and by ipctk
(`crossing_faces.py`) at every point of the load path. The tip is held against CalculiX with
contact (`tests/data/contact/pneunet.csv`, made by `evidence/make_pneunet_reference.py`) where
that file is there.

A path that ends early says which part of the load was reached; what it reached is looked at too.
"""

from __future__ import annotations

import csv
import statistics
import sys
from pathlib import Path

import numpy as np
from crossing_faces import Faces

import voxsoft as vs
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples" / "pneunet_contact.toml"
REFERENCE = ROOT / "tests" / "data" / "contact" / "pneunet.csv"
#: The pressure of the tutorial, kPa.
FULL = 80.0
#: Parts of the pressure at which the tip is reported.
PARTS = (0.25, 0.5, 0.75, 1.0)


def look_at_path(report: Report, setup: Setup, result: vs.Result) -> None:
    """Add what passes through what at any point of the load path."""
    faces = Faces(setup)
    states = [*zip(result.recording.frames, result.recording.times, strict=True)]
    states.append((result.positions, result.load_factor))
    pairs, folds, deepest, by_ipctk = 0, 0, 0.0, 0
    for positions, factor in states:
        points = faces.at(positions, factor)
        met, _, folded, deep = faces.crossings(points)
        pairs, folds, deepest = max(pairs, met), max(folds, folded), max(deepest, deep)
        by_ipctk += faces.crosses_by_ipctk(points)
    report.add("points of the path", len(states), "")
    report.add("intersecting faces at any of them, exact", pairs, "")
    report.add("folds", folds, "")
    report.add("depth", deepest / setup.design.voxel_size, "voxels")
    report.add("points with intersections, ipctk", by_ipctk, "")


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
            last[name] = simulate(setup, frames=True)
            seconds[name].append(last[name].seconds)
    failed = 0
    for name, result in last.items():
        failed += result.status != "ok"
        report.add(f"{name}: {result.status}, load reached", 100 * result.load_factor, "%")
        report.add(f"{name}: iterations", result.steps, "")
        ratio = statistics.median(seconds[name]) / statistics.median(seconds["without contact"])
        report.add(f"{name}: time", statistics.median(seconds[name]), "s", ratio)
    result = last["contact"]
    report.add("contact: force between walls", sum(c.pressed for c in result.contacts), "N")
    look_at_path(report, touching, result)
    times = result.recording.times
    for part in PARTS:
        if part > result.load_factor + 1e-9:
            continue
        expected = reference(part * FULL)
        for axis, name in ((0, "x"), (2, "z")):
            way = [probe[axis] for probe in result.recording.probes["tip"]]
            moved = 1e3 * float(np.interp(part, times, way))
            known = expected[f"tip_u{name}_mm"] if expected else None
            title = f"{part * FULL:g} kPa: tip along {name}"
            report.add(title, moved, "mm", None if known is None else moved / known)
    report.add("solutions that ended early", failed, "")
    report.show()


if __name__ == "__main__":
    main()
