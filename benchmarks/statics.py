"""What statics costs: processor time of one Newton iteration, and memory.

``python benchmarks/statics.py [--json] [--fine]``. A cube of 40 mm and a beam of 200 x 20 x
20 mm of one rubber under their weight, in finer and finer voxels. `--fine` adds sizes that take
minutes and gigabytes. Memory is the peak of the process so far: a small body after a large one
shows nothing.
"""

from __future__ import annotations

import sys
import time

from measure import Report, peak_bytes

import voxsoft as vs
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49)
#: Sizes in mm, and voxels across.
CUBE, BEAM = (40.0, 40.0, 40.0), (200.0, 20.0, 20.0)
CASES = [(CUBE, 8), (CUBE, 16), (CUBE, 24), (BEAM, 4), (BEAM, 8)]
FINE = [(BEAM, 16), (CUBE, 32)]


def main() -> None:
    """Measure everything."""
    report = Report("Cost of statics", fine="also sizes that take minutes and gigabytes")
    for size, across in CASES + (FINE if report.options["fine"] else []):
        design = vs.Design(
            name="body",
            voxel_size=size[2] * mm / across,
            parts=[vs.Part(shape=vs.Box(size=tuple(side * mm for side in size)), material=RUBBER)],
            clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
            loads=[vs.Gravity(value=1.0)],
        )
        setup = Setup.of(design)
        start = time.process_time()
        result = vs.simulate(setup, method="statics")
        seconds = time.process_time() - start
        if result.status != "ok":
            raise SystemExit(f"wrong answer: {result.message}")
        shape = " × ".join(f"{side:g}" for side in size)
        name = f"{shape} mm, {across} voxels across, {len(setup.mesh.vertices)} vertices"
        report.add(f"{name}: iterations", float(result.steps), "")
        report.add(f"{name}: one iteration", seconds / result.steps, "s")
        report.add(f"{name}: peak of the process", peak_bytes() / 1e9, "GB")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
