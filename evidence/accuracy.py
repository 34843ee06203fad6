"""Errors against converged references, for the hyperelastic voxel and the lattice.

``python evidence/accuracy.py [--json] [--fine] [--answers] [--round]``. First what runs answer,
with error bars and times (`answers.py`): twisted bars, thick spheres and tubes, cylinders, a
PneuNet, and six clamped beams of three Poisson's ratios; `--answers` stops there. `--round` adds
round and thin bodies off the grid (`round_bodies.py`). Then the same beams,
round and stair-step cylinders at 4 kPa, the PneuNet at 3 kPa, and a block with a smooth exact
solution, of both materials and sizes extrapolated by hand. E = 60 kPa everywhere and nothing is
fitted, but for the lattice: its two moduli are those that fit beam (a) at 5 mm best, and then
stay. `--fine` adds voxels of 1.25 mm to the bodies that take minutes with them.

Errors of beams are lengths of the error vector at the stations of the reference; the ratio is over
the tip's displacement. Elsewhere the error is that of one displacement, and the ratio is over it.
References: `tests/data/README.md`.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from answers import (
    beam_answers,
    cylinder_answers,
    pneunet_answers,
    rubber,
    sphere_answers,
    tube_answers,
)
from bending import torsion
from make_references import SOFT, cylinder, pneunet
from numpy.typing import NDArray
from scipy.optimize import least_squares
from smooth_block import error as smooth_error

import voxsoft as vs
from voxsoft.comparison import discretization_error
from voxsoft.design import families
from voxsoft.materials import Material
from voxsoft.simulation import Setup, relax
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

Floats = NDArray[np.float64]

DATA = Path(__file__).parents[1] / "tests" / "data"
VOXEL = 5.0
CLAMPED = 10.0
#: Cells along an edge of the smooth block.
CELLS = (8, 12, 16)


@dataclass(frozen=True)
class Beam:
    """A beam of the reference: size in mm, stations (n,), their displacements (n, 2) in mm."""

    name: str
    size: tuple[float, float, float]
    stations: Floats
    moved: Floats

    @property
    def reach(self) -> float:
        """How far the tip moves in mm."""
        return float(np.linalg.norm(self.moved[-1]))

    def design(self, material: Material) -> vs.Design:
        """The beam of 5 mm voxels."""
        length, width, height = (f"{side:g} mm" for side in self.size)
        beam = families.paper_beam().with_parameters(length=length, width=width, height=height)
        probes = {
            f"s{station:g}": vs.Probe(
                point=(station * mm, self.size[1] / 2 * mm, self.size[2] / 2 * mm)
            )
            for station in self.stations
        }
        changes = {
            "parts": (vs.Part(shape="body", material=material),),
            "probes": probes,
            "objectives": {},
        }
        return beam.replace(**changes)

    def setup(self, material: Material, refine: int = 1) -> Setup:
        """The beam of 5 mm voxels, each cut into `refine` along each axis."""
        return Setup.of(self.design(material), refine=refine)


def rows_of(name: str) -> list[dict[str, str]]:
    """Rows of a table of references."""
    lines = (DATA / name).read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def beams() -> list[Beam]:
    """The six beams, without the station in the clamp."""
    found: dict[str, list[dict[str, str]]] = {}
    for row in rows_of("beams_gravity_E60.csv"):
        if float(row["station_mm_from_clamped_end"]) > CLAMPED:
            found.setdefault(row["beam"], []).append(row)
    return [
        Beam(
            name,
            tuple(float(rows[0][f"{side}_mm"]) for side in ("length", "width", "height")),
            np.array([float(row["station_mm_from_clamped_end"]) for row in rows]),
            np.array([[float(row["ux_mm"]), float(row["uz_mm"])] for row in rows]),
        )
        for name, rows in found.items()
    ]


def seen(result: vs.Result, beam: Beam) -> Floats:
    """Displacements of the stations along x and z in mm, (n, 2)."""
    if result.status != "ok":
        raise SystemExit(f"wrong answer: beam {beam.name} is {result.status}, {result.message}")
    return np.array([result.probes[f"s{station:g}"][[0, 2]] for station in beam.stations]) / mm


@cache
def lattice() -> vs.Lattice:
    """The lattice that fits beam (a) best with voxels of 5 mm; no other body is looked at."""
    beam = beams()[0]
    setup = beam.setup(vs.Lattice(edge=24 * kPa, bulk=50 * kPa))

    def material(logs: Floats) -> vs.Lattice:
        edge, bulk = np.exp(logs)
        return vs.Lattice(edge=edge, bulk=bulk)

    def misfit(logs: Floats) -> Floats:
        result = relax(setup, setup.problem_with([material(logs)]), 1e-6, 100_000)
        return (seen(result, beam) - beam.moved).ravel()

    low, high = np.log([10 * kPa, 5 * kPa]), np.log([40 * kPa, 400 * kPa])
    start = np.log([24 * kPa, 50 * kPa])
    return material(least_squares(misfit, start, bounds=(low, high), diff_step=1e-3).x)


def add_error(report: Report, name: str, errors: Floats, reach: float) -> None:
    """Add the largest and the mean error in mm."""
    report.add(f"{name}, largest error", float(errors.max()), "mm", float(errors.max()) / reach)
    report.add(f"{name}, mean error", float(errors.mean()), "mm", float(errors.mean()) / reach)


def beam_rows(report: Report, sizes: tuple[int, ...]) -> None:
    """The six beams, with both materials and extrapolated to voxels of size zero."""
    worst: dict[str, list[float]] = {}
    for beam in beams():
        found = {}
        for refine in sizes:
            found[refine] = seen(vs.simulate(beam.setup(SOFT, refine)), beam)
        shapes = {f"hyperelastic {VOXEL / r:g} mm": moved for r, moved in found.items()}
        for coarse, fine in pairwise(sizes):
            h = [VOXEL / coarse, VOXEL / fine]
            pairs = np.stack([found[coarse].ravel(), found[fine].ravel()], axis=1)
            limit = [discretization_error(h, pair).limit for pair in pairs.tolist()]
            shapes[f"hyperelastic {h[0]:g} and {h[1]:g} mm, extrapolated"] = np.reshape(
                limit, found[fine].shape
            )
        for refine in sizes[:2]:
            setup = beam.setup(lattice(), refine)
            shapes[f"lattice {VOXEL / refine:g} mm"] = seen(vs.simulate(setup), beam)
        for kind, moved in shapes.items():
            errors = np.linalg.norm(moved - beam.moved, axis=1)
            add_error(report, f"beam {beam.name}, {kind}", errors, beam.reach)
            worst.setdefault(kind, []).append(float(errors[-1]) / beam.reach)
        if len(sizes) > 2:
            reach = [float(np.linalg.norm(found[refine][-1])) for refine in sizes]
            order = discretization_error([VOXEL / refine for refine in sizes], reach).order
            report.add(f"beam {beam.name}, observed order at its singular clamp", order, "")
    for kind, ratios in worst.items():
        name = f"six beams, {kind}, largest error of a tip"
        report.add(name, 100 * max(ratios), "% of its displacement")


def answers(report: Report, refines: tuple[int, ...]) -> None:
    """What runs answer, with their error bars and times."""
    for across in (2, 4, 8):
        error = torsion(across)
        report.add(f"torsion, {across} across, error of the torque", 100 * error, "%", 1 + error)
    sphere_answers(report)
    tube_answers(report)
    walls = rows_of("cylinders_4kPa_smooth.csv")
    cylinder_answers(
        report,
        cylinder,
        [(float(row["wall_mm"]), float(row["top_centre_uz_mm"])) for row in walls],
    )
    pneunet_answers(report, pneunet(), voxel_references()["pneunet-2.5", "tip_uz_mm"])
    for beam in beams():

        def make(poisson: float, refine: int, beam: Beam = beam) -> vs.Design:
            design = beam.design(rubber(poisson))
            return design.replace(voxel_size=design.voxel_size / refine)

        station = f"s{beam.stations[-1]:g}"
        beam_answers(report, beam.name, make, station, float(beam.moved[-1][1]), refines)


def voxel_references() -> dict[tuple[str, str], float]:
    """The references on stairs, by case and quantity."""
    rows = rows_of("voxel_references.csv")
    return {(row["case"], row["quantity"]): float(row["value"]) for row in rows}


def one_number(report: Report, name: str, value: float, reference: float) -> None:
    """Add the error of one displacement in mm."""
    report.add(f"{name}, error", value - reference, "mm", value / reference - 1)


def rise(design: vs.Design, probe: str, axis: int, **settings: object) -> float:
    """One displacement of a body at rest in mm."""
    result = vs.simulate(design, **settings)
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {design.name} is {result.status}, {result.message}")
    return float(result.probes[probe][axis]) / mm


def cylinder_rows(report: Report, voxels: tuple[float, ...]) -> None:
    """Round cylinders as voxels of several sizes; their steps are part of the error."""
    for row in rows_of("cylinders_4kPa_smooth.csv"):
        wall, reference = float(row["wall_mm"]), float(row["top_centre_uz_mm"])
        for name, material in (("hyperelastic", SOFT), ("lattice", lattice())):
            for voxel in voxels if name == "hyperelastic" else voxels[:2]:
                design = with_material(cylinder(wall * mm, voxel * mm), material)
                for fill in fills(name):
                    moved = rise(filled(design, fill), "center", 2)
                    label = f"round cylinder, wall {wall:g} mm, {name} {voxel:g} mm, {fill}"
                    one_number(report, label, moved, reference)


def fills(family: str) -> tuple[str, ...]:
    """Ways to fill cells that the surface cuts: binary, and fractions where designs know them."""
    known = "fill" in vs.Design.model_fields and family == "hyperelastic"
    return ("binary", "fraction") if known else ("binary",)


def filled(design: vs.Design, fill: str) -> vs.Design:
    """The design with cut cells filled one way."""
    return design.replace(fill=fill) if "fill" in vs.Design.model_fields else design


def with_material(design: vs.Design, material: Material) -> vs.Design:
    """A design of one part with another material."""
    part = design.parts[0].replace(material=material)
    return design.replace(parts=(part,))


def stair_rows(report: Report, refines: tuple[int, ...]) -> None:
    """Cylinders of 5 mm voxels as they stand, steps and all, and the PneuNet of 2.5 mm voxels."""
    table = voxel_references()
    for wall in (5, 10, 15):
        body = cylinder(wall * mm, VOXEL * mm)
        # Points only: means over faces weigh their vertices, of which finer elements have others.
        for probe, axis, words in (("center", 2, "rise of the top"), ("side", 1, "bulge")):
            reference = table[f"cylinder-{wall}-5", f"{probe}_u{'xyz'[axis]}_mm"]
            found = {r: rise(body, probe, axis, refine=r) for r in refines}
            label = f"stair-step cylinder, wall {wall} mm, {words}"
            for kind, value in sized(found, VOXEL):
                one_number(report, f"{label}, hyperelastic {kind}", value, reference)
            value = rise(with_material(body, lattice()), probe, axis)
            one_number(report, f"{label}, lattice 5 mm", value, reference)
    reference = table["pneunet-2.5", "tip_uz_mm"]
    found = {r: rise(pneunet(), "tip", 2, refine=r) for r in refines[:2]}
    for kind, value in sized(found, 2.5):
        one_number(report, f"PneuNet, tip, hyperelastic {kind}", value, reference)
    stiff, soft = pneunet().parts
    spring = lattice()
    ten_times = vs.Lattice(edge=10 * spring.edge, bulk=10 * spring.bulk)
    parts = (
        stiff.replace(material=ten_times),
        soft.replace(material=spring),
    )
    value = rise(pneunet().replace(parts=parts), "tip", 2)
    one_number(report, "PneuNet, tip, lattice 2.5 mm", value, reference)


def sized(found: dict[int, float], voxel: float) -> Iterator[tuple[str, float]]:
    """Values by size of element, and two of them extrapolated."""
    for refine, value in found.items():
        yield f"{voxel / refine:g} mm", value
    pairs = list(found.items())
    for (coarse, first), (fine, second) in pairwise(pairs):
        h = [voxel / coarse, voxel / fine]
        limit = discretization_error(h, [first, second]).limit
        yield f"{h[0]:g} and {h[1]:g} mm, extrapolated", limit


def order_rows(report: Report) -> None:
    """The order of convergence where nothing is singular, by regression."""
    for poisson in (0.3, 0.49, 0.499):
        material = vs.NeoHookean(young=60 * kPa, poisson=poisson)
        errors = [smooth_error(cells, material) for cells in CELLS]
        order = -np.polyfit(np.log(CELLS), np.log(errors), 1)[0]
        report.add(f"smooth block, ν = {poisson:g}, observed order", float(order), "")


def main() -> None:
    """Measure everything."""
    report = Report(
        "Errors against converged references",
        fine="also 1.25 mm voxels, which take minutes",
        answers="only what runs answer, with their error bars",
        round="also round and thin bodies off the grid, which take minutes",
    )
    fine = bool(report.options["fine"])
    answers(report, (1, 2, 4))
    if report.options["round"]:
        from round_bodies import round_answers

        round_answers(report, voxel_references(), 60.0, None)
    if report.options["answers"]:
        report.show()
        return
    order_rows(report)
    fitted = lattice()
    report.add("lattice fitted to beam (a), edge modulus", fitted.edge / kPa, "kPa")
    report.add("lattice fitted to beam (a), bulk modulus", fitted.bulk / kPa, "kPa")
    beam_rows(report, (1, 2, 4) if fine else (1, 2))
    stair_rows(report, (1, 2, 4) if fine else (1, 2))
    cylinder_rows(report, (5.0, 2.5, 1.25) if fine else (5.0, 2.5))
    report.show()


if __name__ == "__main__":
    sys.exit(main())
