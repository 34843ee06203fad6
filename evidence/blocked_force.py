"""The blocked force of a bending actuator of EcoFlex 00-30, against the one that was measured.

``python evidence/blocked_force.py [--json] [--variants]``. The actuator is that of
`examples/validation/epfl_bender.toml`, five chambers in walls of 10 mm, with its tip held: nothing
is fitted to the forces. Measured: Reconfigurable Robotics Lab, EPFL
(`examples/data/epfl_bender/README.md`).

In the experiment the root sits in a cup on a slider, free along the actuator, and the end of the
film is pinned to a load cell. Seen from the slider the root is fixed and the tip free along the
actuator: its lower edge is held upright and across, and the force is what holds it there. Weight
was removed from the measurement as its baseline, and is left out.
"""

from __future__ import annotations

import statistics
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from voxsoft.units import MPa, kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "examples" / "validation"))
sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from epfl_blocked_force import Model, measured, predicted
from measure import Report


@dataclass(frozen=True, kw_only=True)
class Variant(Model):
    """What else the experiment may have been; `pressures` in Pa, empty for all measured."""

    name: str
    pressures: tuple[float, ...] = ()


#: The first was chosen before any force was computed: the model whose angles are compared, and the
#: tip as it is described.
VARIANTS = (
    Variant(name="as described"),
    Variant(name="tip free across", held="z"),
    Variant(name="tip held along the actuator too", held="xyz"),
    Variant(name="root of 6 mm in the cup", root=6 * mm),
    Variant(name="tunnel of 2 mm, beside the middle", tunnel=2 * mm, beside=1 * mm),
    Variant(name="film ten times as stiff", film=410 * MPa),
    Variant(name="film a tenth as stiff", film=4.1 * MPa),
    Variant(name="constants of Yeoh's model", rubber="ecoflex-00-30-epfl-yeoh"),
    Variant(
        name="voxels of 1 mm, tunnel of 2 mm",
        tunnel=2 * mm,
        voxel=1 * mm,
        pressures=(20 * kPa, 30 * kPa, 40 * kPa),
    ),
)


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
