"""Growth: seconds and memory to rest for bodies of 10² to 10⁵ voxels, solver not named.

``python benchmarks/growth.py [--json] [--fine]``. A cube and a slender beam under their weight,
of both families of materials, in finer and finer voxels; `--fine` adds 10⁶ voxels, which take
minutes and gigabytes. Each size has a process of its own, so that its peak of memory is its own.
Wall clock, all cores, from the design to the state at rest, shapes and meshing included. An answer
counts once its forces balance. The slope is that of the logarithms from 10³ voxels on.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable

import numpy as np
from bodies import MATERIALS, block, require_rest
from measure import Report, peak_bytes

import voxsoft as vs
from voxsoft.materials import Material
from voxsoft.simulation import Setup
from voxsoft.units import mm

#: Voxels along an edge of the cube, and across the beam, which is ten times as long as thick.
CUBE, CUBE_FINE = (5, 10, 22, 46), (100,)
BEAM, BEAM_FINE = (2, 5, 10, 22), (46,)
#: Residual that is asked for where relaxation answers; statics goes further.
TOLERANCE = 1e-5
#: Sizes from which the slope is taken, in voxels: below, start-up counts.
SLOPE_FROM = 900


def slender_beam(material: Material, across: int) -> vs.Design:
    """A cantilever of 100 x 10 x 10 mm under a tenth of its weight, clamped at its end."""
    size = (100 * mm, 10 * mm, 10 * mm)
    return vs.Design(
        name="beam",
        voxel_size=10 * mm / across,
        parts=[vs.Part(shape=vs.Box(size=size), material=material)],
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0)))],
        loads=[vs.Gravity(value=0.981)],
    )


BODIES: dict[str, tuple[Callable[[Material, int], vs.Design], tuple[int, ...], tuple[int, ...]]] = {
    "cube": (block, CUBE, CUBE_FINE),
    "beam": (slender_beam, BEAM, BEAM_FINE),
}


def to_rest(body: str, material: str, across: int) -> tuple[int, float, int, str]:
    """Voxels, seconds, peak of memory in bytes, and the way to rest of one size."""
    design = BODIES[body][0](MATERIALS[material], across)
    start = time.perf_counter()
    setup = Setup.of(design)
    result = vs.simulate(setup)
    seconds = time.perf_counter() - start
    peak = peak_bytes()
    require_rest(setup, result, TOLERANCE)
    return len(setup.mesh.tets) // 5, seconds, peak, result.solver["way"]


def alone(*arguments: object) -> tuple[int, float, int, str]:
    """`to_rest` in a fresh process."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(to_rest, arguments)


def main() -> None:
    """Measure all sizes."""
    report = Report("Growth of time and memory to rest", fine="also 10⁶ voxels")
    for body, (_, sizes, fine) in BODIES.items():
        for material in MATERIALS:
            points = []
            for across in sizes + (fine if report.options["fine"] else ()):
                voxels, seconds, peak, way = alone(body, material, across)
                way = "statics" if way == "load" else way
                name = f"{material} {body}, {voxels} voxels"
                report.add(f"{name}: to rest by {way}", seconds, "s")
                report.add(f"{name}: peak memory", peak / 1e9, "GB")
                if voxels > SLOPE_FROM:
                    points.append((voxels, seconds))
            slope = np.polyfit(*np.log(points).T, 1)[0]
            report.add(f"{material} {body}: slope of time", float(slope), "")
    report.show()


if __name__ == "__main__":
    main()
