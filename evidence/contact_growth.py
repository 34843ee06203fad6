"""Growth of contact: seconds to rest of a block on a block, and of one block as high as both.

``python evidence/contact_growth.py [--json] [--fine]``. Two blocks of 20 x 20 x 10 mm, a voxel
apart, are pressed on each other by 2 mm, in finer and finer voxels; `--fine` adds 10⁶ voxels, which
take minutes and gigabytes. The default settings, and no friction. Each size has a process of its
own, so that its peak of memory is its own. Wall clock, all cores, from the design to the state at
rest. The ratio is that to one block of the same voxels, which is pressed as far and meets nothing.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from pathlib import Path

import contact_designs as designs
import numpy as np

import voxsoft as vs
from voxsoft.design import Contact
from voxsoft.units import mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report, peak_bytes

#: Voxels along an edge of both blocks together.
ACROSS, ACROSS_FINE = (10, 22, 46), (100,)
#: The edge of both blocks together, and how far they are pressed, in mm.
EDGE, PRESS = 20.0, 2.0


def blocks(across: int, *, apart: bool) -> vs.Design:
    """Two blocks, a voxel apart, or one as high as both."""
    voxel, half = EDGE / across, EDGE / 2
    gap = voxel if apart else 0.0
    top = EDGE + gap
    shape = designs.box((0, 0, 0), (EDGE, EDGE, half)) | designs.box(
        (0, 0, half + gap), (EDGE, EDGE, top)
    )
    return vs.Design(
        name="blocks",
        voxel_size=voxel * mm,
        parts=[vs.Part(shape=shape, material=designs.rubber())],
        clamps=[
            vs.Clamp(region=vs.Region(z=(0, 0))),
            designs.moved("xyz", (0, 0, -PRESS - gap), z=(top, top)),
        ],
        contact=Contact() if apart else None,
        solver={"method": "statics"},
    )


def to_rest(across: int, apart: bool) -> tuple[int, float, int, int, float]:
    """Voxels, seconds, peak of memory in bytes, iterations, and the smallest gap in voxels."""
    start = time.perf_counter()
    result = vs.simulate(blocks(across, apart=apart))
    seconds = time.perf_counter() - start
    if result.status != "ok":
        raise SystemExit(f"{across} voxels across ended {result.status}")
    gap = min((contact.gap for contact in result.contacts), default=np.inf)
    voxels = len(result.mesh.tets) // 5
    return voxels, seconds, peak_bytes(), result.steps, gap * across / (EDGE * mm)


def main() -> None:
    """Solve all sizes."""
    report = Report("Growth of contact", fine="also 10⁶ voxels")
    sizes = ACROSS + (ACROSS_FINE if report.options["fine"] else ())
    context = multiprocessing.get_context("spawn")
    measured = []
    for across in sizes:
        found = {}
        for apart in (False, True):
            with context.Pool(1) as pool:
                found[apart] = pool.apply(to_rest, (across, apart))
        voxels, seconds, peak, steps, gap = found[True]
        name = f"block on block, {voxels:,} voxels"
        report.add(f"{name}: time", seconds, "s", seconds / found[False][1])
        report.add(f"{name}: iterations", steps, "", steps / found[False][3])
        report.add(f"{name}: peak of memory", peak / 1e9, "GB", peak / found[False][2])
        report.add(f"{name}: smallest gap", gap, "voxels")
        measured.append((voxels, seconds))
    count, seconds = np.log(np.array(measured).T)
    report.add("slope of the logarithms of time", float(np.polyfit(count, seconds, 1)[0]), "")
    report.show()


if __name__ == "__main__":
    main()
