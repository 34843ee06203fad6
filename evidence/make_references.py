"""References of `tests/data/voxel_references.csv`: outside codes on the same voxels, split finer.

``python evidence/make_references.py FOLDER [CASE ...]`` solves what FOLDER does not hold yet,
keeps the displacements of each run there, and writes the tables into it. CalculiX (C3D20R) and the
mixed bricks of `voxsoft.comparison.scikit_fem` (Q2-P1) share no line of code past the nodes.
Symmetry planes halve the work: bodies are cut at x = 0, or at the middle of their width.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import voxsoft as vs
from voxsoft import geometry
from voxsoft.comparison import discretization_error
from voxsoft.comparison.bricks import BrickModel
from voxsoft.comparison.outside import OutsideAnswer
from voxsoft.comparison.scikit_fem import run_scikit_fem
from voxsoft.design import families
from voxsoft.files.calculix import run_calculix
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

SOFT = vs.NeoHookean(young=60 * kPa, poisson=0.49)
FIRM = vs.NeoHookean(young=600 * kPa, poisson=0.49)
TIME_LIMIT = 1500.0
#: In the units of the table: far below what any run is worth.
ZERO = 1e-6


def cylinder(wall: float, voxel: float) -> vs.Design:
    """The cylinder of the smooth references, as full voxels."""
    edge = {"x": (0, 0), "y": (25 * mm, 25 * mm), "z": (35 * mm, 35 * mm)}
    return families.paper_cylinder(wall=wall).replace(
        voxel_size=voxel,
        fill="binary",
        parts=(vs.Part(shape="body", material=SOFT),),
        probes={
            "center": vs.Probe(point=(0, 0, 35 * mm)),
            "top": vs.Probe(z=(35 * mm, 35 * mm)),
            "rim": vs.Probe(**edge),
            "side": vs.Probe(point=(0, 25 * mm, 17.5 * mm)),
        },
    )


def pneunet() -> vs.Design:
    """Six chambers with walls of one voxel of 2.5 mm on a layer ten times as stiff."""
    design = families.pneunet(chambers=6, width=15 * mm, height=20 * mm)
    layer, chambers = design.parts
    return design.replace(
        parts=(
            layer.replace(material=FIRM),
            chambers.replace(material=SOFT),
        ),
        loads=(vs.Pressure(value=PNEUNET_PRESSURE),),
    )


PNEUNET_PRESSURE = 3 * kPa


class Case(NamedTuple):
    """A design, its planes of symmetry, and the splits for CalculiX and for scikit-fem."""

    make: Callable[[], vs.Design]
    planes: str
    calculix: tuple[int, ...]
    mixed: tuple[int, ...]


CASES = {
    "cylinder-15-5": Case(lambda: cylinder(15 * mm, 5 * mm), "xy", (2, 3), (1, 2)),
    "cylinder-10-5": Case(lambda: cylinder(10 * mm, 5 * mm), "xy", (2,), (1, 2)),
    "cylinder-5-5": Case(lambda: cylinder(5 * mm, 5 * mm), "xy", (2,), (1, 2)),
    "pneunet-2.5": Case(pneunet, "y", (1, 2), (1,)),
    "cylinder-15-2.5": Case(lambda: cylinder(15 * mm, 2.5 * mm), "xy", (), (1,)),
    "cylinder-10-2.5": Case(lambda: cylinder(10 * mm, 2.5 * mm), "xy", (), (1,)),
    "cylinder-5-2.5": Case(lambda: cylinder(5 * mm, 2.5 * mm), "xy", (), (1,)),
}


def cut(model: BrickModel, planes: str) -> tuple[BrickModel, np.ndarray]:
    """Keep one side of planes of symmetry; also which vertices of the voxels are kept."""
    middle = (model.nodes.min(axis=0) + model.nodes.max(axis=0)) / 2
    keep = np.ones(len(model.bricks), dtype=bool)
    for name in planes:
        axis = "xyz".index(name)
        keep &= model.nodes[model.bricks[:, :8], axis].mean(axis=1) > middle[axis]
    used = np.unique(model.bricks[keep])
    number = np.full(len(model.nodes), -1)
    number[used] = np.arange(len(used))
    fixed = model.fixed[used].copy()
    for name in planes:
        axis = "xyz".index(name)
        fixed[np.abs(model.nodes[used, axis] - middle[axis]) < 1e-3 * model.edge, axis] = True
    renumbered = np.cumsum(keep) - 1
    pressures = tuple(
        replace(load, faces=np.column_stack((renumbered[rows[:, 0]], rows[:, 1])))
        for load in model.pressures
        for rows in [load.faces[keep[load.faces[:, 0]]]]
    )
    vertices = number[model.vertex_nodes]
    part = replace(
        model,
        nodes=model.nodes[used],
        bricks=number[model.bricks[keep]],
        parts=model.parts[keep],
        fixed=fixed,
        values=model.values[used],
        forces=model.forces[used],
        pressures=pressures,
        vertex_nodes=vertices[vertices >= 0],
    )
    return part, vertices >= 0


def mirrored(setup: Setup, kept: np.ndarray, moved: np.ndarray, planes: str) -> np.ndarray:
    """Displacements of all vertices from those on one side."""
    points = setup.mesh.vertices
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    signs = np.ones_like(points)
    twins = points - middle
    for name in planes:
        axis = "xyz".index(name)
        signs[:, axis] = np.where(twins[:, axis] < 0, -1.0, 1.0)
        twins[:, axis] = np.abs(twins[:, axis])
    keys = np.rint(twins / setup.mesh.voxel_size * 2).astype(int).tolist()
    row = {
        tuple(key): index
        for index, key in enumerate(key for key, inside in zip(keys, kept, strict=True) if inside)
    }
    return signs * moved[[row[tuple(key)] for key in keys]]


def solve(case: Case, code: str, split: int, target: Path) -> None:
    """Solve one case and keep its displacements."""
    setup = Setup.of(case.make())
    model, kept = cut(
        BrickModel.of(setup, split=split, nodes=20 if code == "C3D20R" else 27), case.planes
    )
    answer: OutsideAnswer = (
        run_calculix(model, time_limit=TIME_LIMIT)
        if code == "C3D20R"
        else run_scikit_fem(model, time_limit=TIME_LIMIT)
    )
    print(target.stem, answer.status, answer.unknowns, f"{answer.seconds:.0f} s", flush=True)
    if answer.status == "ok":
        moved = mirrored(setup, kept, answer.displacements, case.planes)
        version = f"{answer.code} {answer.version}"
        np.savez(target, moved=moved, unknowns=answer.unknowns, version=version)


def quantities(setup: Setup, moved: np.ndarray) -> dict[str, float]:
    """Displacements of probes in mm, rotation in degrees, growth of the cavity in mm³."""
    rest = setup.mesh.vertices
    values = {}
    for name, place in setup.places.items():
        mean = geometry.mean_displacement(rest, rest + moved, place.vertices, place.weights)
        for axis, value in zip("xyz", mean, strict=True):
            values[f"{name}_u{axis}_mm"] = value * 1e3
        if len(place.vertices) > 4:
            turned = geometry.mean_rotation(rest, rest + moved, place.vertices)
            values[f"{name}_rotation_deg"] = float(np.degrees(turned))
    cavity = setup.mesh.cavities[0]
    grown = geometry.enclosed_volume(cavity.triangles, rest + moved) - cavity.volume
    return values | {"cavity_growth_mm3": grown * 1e9}


class Solved(NamedTuple):
    """One run as it was kept."""

    element: str
    split: int
    unknowns: int
    code: str
    values: dict[str, float]


def solved(name: str, folder: Path) -> list[Solved]:
    """What the folder holds of a case, the finest of each element last."""
    setup = Setup.of(CASES[name].make())
    runs = []
    for path in sorted(folder.glob(f"{name}_*.npz")):
        element, split = path.stem.removeprefix(f"{name}_").split("_")
        run = np.load(path)
        values = quantities(setup, run["moved"])
        runs.append(Solved(element, int(split), int(run["unknowns"]), str(run["version"]), values))
    return sorted(runs, key=lambda run: (run.element, run.split))


def tables(folder: Path) -> None:
    """Write every run, one quantity a row, and the references made of them."""
    raw, kept = [], []
    for name in CASES:
        runs = solved(name, folder)
        raw += [
            [name, quantity, run.element, run.split, run.unknowns, run.code, f"{value:.6g}"]
            for run in runs
            for quantity, value in run.values.items()
        ]
        mixed = [run for run in runs if run.element == "Q2-P1"]
        other = next((run for run in reversed(runs) if run.element == "C3D20R"), None)
        for quantity in mixed[-1].values if mixed else ():
            best = mixed[-1].values[quantity]
            if abs(best) < ZERO:
                continue  # by symmetry
            second = other.values[quantity] if other else None
            row = [name, quantity, f"{best:.6g}", mixed[-1].split, "", "", ""]
            if len(mixed) > 1:
                sizes = [1 / run.split for run in mixed]
                found = discretization_error(sizes, [run.values[quantity] for run in mixed])
                row[4] = f"{found.error:.3g}"
            if other is not None and second is not None:
                row[5], row[6] = str(other.split), f"{second:.6g}"
            kept.append(row)
    head = ["case", "quantity", "element", "split", "unknowns", "code", "value"]
    _write(folder / "voxel_references_runs.csv", [head, *raw])
    head = ["case", "quantity", "value", "split", "error_estimate", "calculix_split", "calculix"]
    _write(folder / "voxel_references.csv", [head, *kept])


def _write(path: Path, rows: list[list[object]]) -> None:
    with path.open("w", newline="\n") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def main() -> None:
    """Solve what is missing and write the tables."""
    folder, *wanted = sys.argv[1:]
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for name in wanted or CASES:
        case = CASES[name]
        runs = [("C3D20R", split) for split in case.calculix]
        runs += [("Q2-P1", split) for split in case.mixed]
        for code, split in sorted(runs, key=lambda run: run[1]):
            path = target / f"{name}_{code}_{split}.npz"
            if not path.exists():
                solve(case, code, split, path)
    tables(target)


if __name__ == "__main__":
    main()
