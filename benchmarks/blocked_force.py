"""The blocked force of a bending actuator of EcoFlex 00-30, against the one that was measured.

``python benchmarks/blocked_force.py [--json] [--variants]``. The actuator is that of
`examples/validation/epfl_bender.toml`, five chambers in walls of 10 mm, with its tip held: nothing
is fitted to the forces. Measured: Reconfigurable Robotics Lab, EPFL
(`examples/data/epfl_bender/README.md`).

In the experiment the root sits in a cup on a slider, free along the actuator, and the end of the
film is pinned to a load cell. Seen from the slider the root is fixed and the tip free along the
actuator: its lower edge is held upright and across, and the force is what holds it there. Weight
was removed from the measurement as its baseline, and is left out.
"""

from __future__ import annotations

import csv
import statistics
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from measure import Report

import voxsoft as vs
from voxsoft.units import MPa, kPa, mm

ROOT = Path(__file__).parents[1]
DESIGN = ROOT / "examples" / "validation" / "epfl_bender.toml"
DATA = ROOT / "examples" / "data" / "epfl_bender" / "blocked_force.csv"
LENGTH, HEIGHT = 70 * mm, 18 * mm


@dataclass(frozen=True)
class Variant:
    """What else the experiment may have been.

    `held` are the axes of the tip's edge. `root` is the wall in the cup, which is held behind and
    above, and without which the root's face is held. `pressures` in Pa are some of those measured,
    empty for all.
    """

    name: str
    film: float = 41 * MPa
    tunnel: float = 4 * mm
    rubber: str = "ecoflex-00-30-epfl"
    held: str = "yz"
    voxel: float = 2 * mm
    beside: float = 0.0
    root: float = 0.0
    pressures: tuple[float, ...] = ()

    def values(self, pressure: float) -> dict[str, float]:
        """The values of the design's parameters."""
        names = ("film", "tunnel", "beside", "root")
        return {name: getattr(self, name) for name in names} | {"pressure": pressure}


#: The first was chosen before any force was computed: the model whose angles are compared, and the
#: tip as it is described.
VARIANTS = (
    Variant("as described"),
    Variant("tip free across", held="z"),
    Variant("tip held along the actuator too", held="xyz"),
    Variant("root of 6 mm in the cup", root=6 * mm),
    Variant("tunnel of 2 mm, beside the middle", tunnel=2 * mm, beside=1 * mm),
    Variant("film ten times as stiff", film=410 * MPa),
    Variant("film a tenth as stiff", film=4.1 * MPa),
    Variant("constants of Yeoh's model", rubber="ecoflex-00-30-epfl-yeoh"),
    Variant(
        "voxels of 1 mm, tunnel of 2 mm",
        tunnel=2 * mm,
        voxel=1 * mm,
        pressures=(20 * kPa, 30 * kPa, 40 * kPa),
    ),
)


def measured() -> dict[float, float]:
    """Force in N by pressure in Pa."""
    with DATA.open() as file:
        rows = list(csv.DictReader(file))
    return {float(row["pressure_kPa"]) * kPa: float(row["force_N"]) for row in rows}


def predicted(pressure: float, variant: Variant) -> float:
    """The force in N on the load cell under a pressure in Pa, NaN where there is no equilibrium."""
    design = vs.load(DESIGN, **variant.values(pressure))
    clamps = [vs.Clamp(region=vs.Region(x=(LENGTH, LENGTH), z=(0, 0)), axes=variant.held)]
    if variant.root:
        clamps.append(vs.Clamp(region=vs.Region(x=(-variant.root, 0), z=(HEIGHT, HEIGHT))))
    (part,) = design.parts
    design = design.model_copy(
        update={
            "parts": [part.model_copy(update={"material": variant.rubber})],
            "voxel_size": variant.voxel,
            "clamps": [*design.clamps, *clamps],
            "solver": vs.Solver(method="statics", tolerance=1e-6),
        }
    )
    result = vs.simulate(design)
    if result.status != "ok":
        print(f"{variant.name}, {pressure / kPa:g} kPa: {result.message}", file=sys.stderr)
        return float("nan")
    x, _, z = result.mesh.vertices.T
    on_edge = np.isclose(x, LENGTH) & np.isclose(z, 0.0)
    return float(result.reactions[on_edge, 2].sum())


def main() -> None:
    """Measure everything."""
    report = Report(
        "Blocked force of a bending actuator",
        variants="also what the experiment may have been else",
    )
    real = measured()
    for variant in VARIANTS if report.options["variants"] else VARIANTS[:1]:
        start, errors = time.perf_counter(), []
        for pressure in variant.pressures or real:
            force = real[pressure]
            here = predicted(pressure, variant)
            report.add(f"{variant.name}, {pressure / kPa:g} kPa", here, "N", here / force)
            if np.isfinite(here):
                errors.append(abs(here / force - 1))
        report.add(f"{variant.name}, median error", 100 * statistics.median(errors), "%")
        report.add(f"{variant.name}, time", time.perf_counter() - start, "s")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
