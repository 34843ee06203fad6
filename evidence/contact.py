"""Errors of contact in equilibrium against converged references and closed forms.

``python evidence/contact.py [--json] [--fine]``. A uniform pressure through voxels that do not
match, a half sphere on a rigid plane, a rigid ball pressed into a block, a block on a block, and a
bellows whose walls meet. Nothing is fitted: every solution has the default settings, and ratios
are those to the reference. Where the load path ends early, the row says which part of the load was
reached, and there is no figure. All of it takes four minutes; `--fine` adds cases that take minutes
each, some twenty more.

The references have the same material law (``tests/data/README.md``), so the ratios are errors of
the discretization and of contact.
"""

from __future__ import annotations

import csv
import sys
from functools import cache
from pathlib import Path
from typing import Any

import contact_designs as designs
import numpy as np

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.units import mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

DATA = Path(__file__).parents[1] / "tests" / "data" / "contact"

#: Cases of the half sphere: voxel in mm, cut voxels, Poisson's ratio, depths in mm.
SPHERES = [
    (5.0, False, 0.45, (1, 2, 5)),
    (5.0, True, 0.45, (1, 2, 5)),
    (2.5, False, 0.45, (1, 2, 5)),
    (2.5, True, 0.45, (1, 2, 5)),
    (2.5, False, 0.49, (2.5, 5)),
    (1.25, False, 0.45, (2,)),
]
FINE_SPHERES = [(1.25, True, 0.45, (2,)), (1.25, False, 0.45, (5,))]
#: Cases of the ball: voxel in mm, Poisson's ratio, friction, depths in mm.
BALLS = [
    (5.0, 0.45, 0.0, (2, 4, 6)),
    (5.0, 0.49, 0.0, (2, 4, 6)),
    (5.0, 0.45, 0.5, (2, 4, 6)),
    (2.5, 0.45, 0.0, (2, 4)),
    (2.5, 0.49, 0.0, (4,)),
]
FINE_BALLS = [
    (2.5, 0.45, 0.0, (6,)),
    (2.5, 0.45, 0.5, (2,)),
    (5 / 3, 0.45, 0.0, (2,)),
]
#: Cases of the two blocks: voxel in mm, friction, ways in mm.
BLOCKS = [
    (2.0, 0.0, (1, 1.75)),
    (2.0, 0.5, (1, 1.75)),
    (1.0, 0.0, (1, 1.75)),
    (1.0, 0.5, (1, 1.75)),
]
FINE_BLOCKS = [(0.5, 0.0, (1, 1.75)), (0.5, 0.5, (1, 1.75))]
#: Cases of the bellows: voxel in mm, touching, pressures in kPa.
BELLOWS = [(1.0, False, (0.5, 1)), (0.5, False, (0.5, 1)), (1.0, True, (0.5, 1))]
FINE_BELLOWS = [(0.5, True, (0.5, 1))]


@cache
def reference(name: str) -> list[dict[str, float]]:
    """The rows of a reference."""
    with (DATA / f"{name}.csv").open(newline="", encoding="utf-8") as lines:
        return [
            {key: float(text or "nan") for key, text in row.items()}
            for row in csv.DictReader(lines)
        ]


def row_of(name: str, **where: float) -> dict[str, float]:
    """The row of a reference with given values."""
    return next(
        row
        for row in reference(name)
        if all(abs(row[key] - value) < 1e-9 for key, value in where.items())
    )


class Cases:
    """Solves designs and adds rows to a report."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.failed = 0

    def solved(self, name: str, design: vs.Design) -> vs.Result | None:
        """The equilibrium; None, with a row that says so, where the load path ended early."""
        result = vs.simulate(design)
        if result.status == "ok":
            return result
        self.failed += 1
        part = 100 * result.load_factor
        self.report.add(f"{name}: {result.status}, load reached", part, "%")
        self.report.add(f"{name}: time", result.seconds, "s")
        return None

    def compare(self, name: str, value: float, expected: float, unit: str) -> None:
        """Add a figure with its ratio to the reference."""
        ratio = None if np.isnan(expected) else value / expected
        self.report.add(name, value, unit, ratio)

    def patches(self) -> None:
        """Uniform pressures, through blocks that do not match and under a plate."""
        for below, above in ((3, 4), (4, 5)):
            design, force, stress = designs.mismatched_blocks(below, above)
            name = f"patch, {below} voxels across on {above}"
            if result := self.solved(name, design):
                self.compare(f"{name}: force", pressed(result), force, "N")
                error = designs.stress_error(result, stress)
                self.report.add(f"{name}: largest error of the stress", 100 * error, "%")
        for plate_voxel in (3.0, 1.7):
            design, stress = designs.block_under_plate(4.0, 1.2, plate_voxel)
            name = f"patch, 4 mm under a plate of facets of {plate_voxel / 3:.2g} mm"
            if result := self.solved(name, design):
                self.compare(f"{name}: force", pressed(result), -stress * (12 * mm) ** 2, "N")
                error = designs.stress_error(result, stress)
                self.report.add(f"{name}: largest error of the stress", 100 * error, "%")

    def spheres(self, cases: list[Any]) -> None:
        """Half a sphere on a rigid plane."""
        for voxel, cut, poisson, depths in cases:
            for depth in depths:
                kind = "cut voxels" if cut else "voxels"
                name = f"sphere on plane, {kind} of {voxel:g} mm, ν {poisson}, {depth:g} mm deep"
                expected = row_of("sphere_on_plane", poisson=poisson, depth_mm=depth)
                design = designs.sphere_on_plane(voxel, depth, poisson, cut=cut)
                if result := self.solved(name, design):
                    self.compare(f"{name}: force", 4 * pressed(result), expected["force_N"], "N")
                    radius = 1e3 * np.sqrt(4 * result.contacts[0].area / np.pi)
                    self.compare(f"{name}: contact radius", radius, expected["radius_mm"], "mm")
                    self.report.add(f"{name}: time", result.seconds, "s")

    def balls(self, cases: list[Any]) -> None:
        """A rigid ball in a block."""
        for voxel, poisson, friction, depths in cases:
            for depth in depths:
                name = f"ball into block, voxels of {voxel:.3g} mm, ν {poisson}, μ {friction:g}"
                name += f", {depth:g} mm deep"
                where = {"poisson": poisson, "friction": friction, "depth_mm": depth}
                expected = row_of("ball_into_block", **where)["force_N"]
                design = designs.ball_into_block(voxel, depth, poisson, friction)
                if result := self.solved(name, design):
                    force = -4 * result.contacts[0].force[2]
                    self.compare(f"{name}: force", force, expected, "N")
                    self.report.add(f"{name}: time", result.seconds, "s")

    def blocks(self, cases: list[Any]) -> None:
        """A block pressed on a wider one."""
        for voxel, friction, ways in cases:
            for press in ways:
                name = (
                    f"two blocks, voxels of {voxel:g} mm, μ {friction:g}, pressed by {press:g} mm"
                )
                expected = row_of("two_blocks", friction=friction, press_mm=press)
                if result := self.solved(name, designs.two_blocks(voxel, press, friction)):
                    force = force_on_top(result) / voxel
                    self.compare(f"{name}: force", force, expected["force_N_per_mm"], "N/mm")
                    for corner in ("upper", "lower"):
                        aside = 1e3 * result.probes[corner][0]
                        to = expected[f"{corner}_corner_ux_mm"]
                        self.compare(f"{name}: {corner} corner aside", aside, to, "mm")
                    self.report.add(f"{name}: time", result.seconds, "s")

    def bellows(self, cases: list[Any]) -> None:
        """A bellows whose walls meet, and one whose walls pass through each other."""
        for voxel, touching, pressures in cases:
            for pressure in pressures:
                through = "" if touching else " without contact"
                name = f"bellows{through}, {2 / voxel:g} voxels a wall, {pressure:g} kPa"
                expected = row_of("bellows", contact=touching, pressure_kPa=pressure)
                design = designs.bellows(voxel, pressure, touching=touching)
                if result := self.solved(name, design):
                    for probe, axis, column in (
                        ("tip", 0, "tip_ux_mm"),
                        ("tip", 2, "tip_uy_mm"),
                        ("top", 2, "top_uy_mm"),
                        ("outer", 0, "outer_ux_mm"),
                    ):
                        found = 1e3 * result.probes[probe][axis]
                        title = f"{name}: {probe} along {'xyz'[axis]}"
                        self.compare(title, found, expected[column], "mm")
                    if touching:
                        force, to = 1e3 * pressed(result) / voxel, 1e3 * expected["force_N_per_mm"]
                        self.compare(f"{name}: force between the walls", force, to, "mN/mm")
                    self.report.add(f"{name}: time", result.seconds, "s")


def pressed(result: vs.Result) -> float:
    """The force between the only two surfaces that touch, in N."""
    return sum(contact.pressed for contact in result.contacts)


def force_on_top(result: vs.Result) -> float:
    """The force that moves the top of two half blocks, of both halves in N."""
    height = result.mesh.vertices[:, 2]
    top = height > height.max() - 1e-6
    return -2 * float(result.reactions[top, 2].sum())


def main() -> None:
    """Compare everything."""
    report = Report("Contact in equilibrium", fine="also cases that take minutes")
    fine = report.options["fine"]
    Setup.of(designs.sphere_on_plane(5.0, 1.0))  # What is imported late costs no case its time.
    cases = Cases(report)
    cases.patches()
    cases.spheres(SPHERES + (FINE_SPHERES if fine else []))
    cases.balls(BALLS + (FINE_BALLS if fine else []))
    cases.blocks(BLOCKS + (FINE_BLOCKS if fine else []))
    cases.bellows(BELLOWS + (FINE_BELLOWS if fine else []))
    report.add("cases whose load path ended early", cases.failed, "")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
