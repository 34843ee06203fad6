"""Errors of cut and of full voxels on round bodies, beside closed forms and converged elements.

``python evidence/cut_gains.py``: the tables of `docs/method/cut-voxels.md#gains`. Round cylinders
of 25 mm at 4 kPa, whose rise is that of `tests/data/cylinders_4kPa_smooth.csv`, and a hollow sphere
of 10 and 15 mm at small strain beside Lamé's solution.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Literal

import voxsoft as vs
from voxsoft.units import mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from accuracy import cylinder, rise, rows_of

Fill = Literal["fraction", "binary"]

FILLS: tuple[Fill, ...] = ("fraction", "binary")
INNER, OUTER = 10 * mm, 15 * mm
YOUNG, POISSON, PRESSURE = 1e6, 0.3, 100.0


def cylinders() -> None:
    """Print the error of the rise of the middle of the cap in %, by wall and size of voxels."""
    for row in sorted(rows_of("cylinders_4kPa_smooth.csv"), key=lambda row: float(row["wall_mm"])):
        wall, reference = float(row["wall_mm"]), float(row["top_centre_uz_mm"])
        for voxel in (5.0, 2.5):
            errors = [
                rise(cylinder(wall * mm, voxel * mm).replace(fill=fill), "center", 2) / reference
                for fill in FILLS
            ]
            shown = ", ".join(
                f"{fill} {100 * (each - 1):+.1f} %"
                for fill, each in zip(FILLS, errors, strict=True)
            )
            print(f"cylinder, wall {wall:g} mm, voxels of {voxel:g} mm: {shown}", flush=True)


def sphere(voxel: float, fill: Fill) -> vs.Design:
    """A hollow sphere that is free to grow from its center."""
    rubber = vs.NeoHookean(young=YOUNG, poisson=POISSON)
    shell = vs.Sphere(radius=OUTER) - vs.Sphere(radius=INNER)
    return vs.Design(
        name="sphere",
        voxel_size=voxel,
        fill=fill,
        parts=[vs.Part(shape=shell, material=rubber)],
        clamps=[{"region": {axis: (0, 0)}, "axes": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=PRESSURE)],
    )


def spheres() -> None:
    """Print the errors of growth, of the volume of the cavity and of the mass in %."""
    widening = PRESSURE * INNER / (YOUNG * (OUTER**3 - INNER**3))
    widening *= (1 - 2 * POISSON) * INNER**3 + (1 + POISSON) * OUTER**3 / 2
    growth = 4 * math.pi * INNER**2 * widening
    room = 4 / 3 * math.pi * INNER**3
    wall = 4 / 3 * math.pi * OUTER**3 - room
    for voxel in (5.0, 3.75, 2.5, 1.875, 1.25):
        for fill in FILLS:
            result = vs.simulate(sphere(voxel * mm, fill), error="off")
            pairs = (
                ("growth", result.metric("cavity_volume_change") / growth),
                ("cavity", result.mesh.cavities[0].volume / room),
                ("mass", result.mesh.volume / wall),
            )
            shown = ", ".join(f"{name} {100 * (each - 1):+.2f} %" for name, each in pairs)
            print(f"sphere, voxels of {voxel:g} mm, {fill}: {shown}", flush=True)


if __name__ == "__main__":
    cylinders()
    spheres()
