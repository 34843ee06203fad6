"""A gripper closes on a cube, lifts it, and holds it, with voxels and steps of several sizes.

``python evidence/gripper.py [--json] [--fine]``. `examples/gripper.toml`, two PneuNet fingers,
with 25 kPa in place of 20: a cube of 50 g is lifted by 50 mm and held by friction alone. One set of
parameters for every size of voxels and every step. By default voxels of 2.5 mm, steps of 20 ms, and
one second of holding; `--fine` takes three sizes with three steps each, ten seconds of holding, and
the same with μ = 0.05, where the cube has to stay on the floor.

The rows of a case say how high the cube is lifted, how far it moves while it is held, the largest
error of the balance of contact, weight and inertia in that time over its weight, the bound of
friction over what it carries, and what the run takes.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import voxsoft as vs
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

DESIGN = Path(__file__).parents[1] / "examples" / "gripper.toml"
#: Edges of voxels in mm and steps in ms, the default case first.
VOXELS, STEPS = (2.5, 2.0, 5 / 3), (20.0, 10.0, 5.0)
PRESSURE, SLIPPERY = 25 * kPa, 0.05
#: When the flange has come to its height, and when the cube has stopped to swing, in s.
LIFTED, STILL = 1.4, 2.0
#: Seconds of holding by default and with `--fine`, and between two records.
SOME, MANY, INTERVAL = 1.0, 10.0, 0.1
LIFT, WEIGHT = 50 * mm, 0.05 * 9.81
#: The cube is held where it is at least this part of the way up.
HELD = 0.9


def gripper(voxel: float, friction: float | None = None) -> vs.Design:
    """The gripper with voxels of a size in mm, with its own friction or another one."""
    values = {"pressure": PRESSURE} | ({} if friction is None else {"friction": friction})
    return vs.load(DESIGN, **values).model_copy(update={"voxel_size": voxel * mm})


def hold(report: Report, voxel: float, step: float, seconds: float) -> None:
    """Add the rows of a cube that is held."""
    name = f"voxels of {voxel:.3g} mm, steps of {step:g} ms"
    result = vs.simulate(
        gripper(voxel), end_time=STILL + seconds, time_step=1e-3 * step, record_interval=INTERVAL
    )
    report.add(f"{name}: time", result.seconds, "s")
    if result.status != "ok":
        report.add(f"{name}: {result.status} at", result.time, "s")
        return
    times, heights = result.recording.times, result.recording.objects["cube"][0][:, 2]
    later = times >= STILL - 1e-9
    rise = heights[-1] - heights[0]
    report.add(f"{name}: cube is lifted by", 1e3 * rise, "mm", rise / LIFT)
    if rise < HELD * LIFT:
        return
    report.add(f"{name}: it moves while it is held by", 1e6 * float(np.ptp(heights[later])), "µm")
    acceleration = np.gradient(np.gradient(heights[later], times[later]), times[later])
    carried = [
        sum(-c.force[2] if c.of[1] == "cube" else c.force[2] for c in now if "cube" in c.of)
        for now, count in zip(result.recording.contacts, later, strict=True)
        if count
    ]
    error = np.abs(np.array(carried) / WEIGHT - 1.0 - acceleration / 9.81).max()
    report.add(f"{name}: error of the balance", 100 * float(error), "%")
    bound = sum(c.bound for c in result.contacts if "cube" in c.of)
    report.add(f"{name}: bound of friction over the weight", bound, "N", bound / WEIGHT)


def drop(report: Report, voxel: float, step: float) -> None:
    """Add the row of a cube that is too slippery."""
    name = f"voxels of {voxel:.3g} mm, steps of {step:g} ms, μ = {SLIPPERY:g}"
    result = vs.simulate(
        gripper(voxel, SLIPPERY), end_time=LIFTED, time_step=1e-3 * step, record_interval=INTERVAL
    )
    report.add(f"{name}: time", result.seconds, "s")
    if result.status != "ok":
        report.add(f"{name}: {result.status} at", result.time, "s")
        return
    heights = result.recording.objects["cube"][0][:, 2]
    rise = float(heights[-1] - heights[0])
    report.add(f"{name}: cube is lifted by", 1e3 * rise, "mm", rise / LIFT)


def main() -> None:
    """Measure everything."""
    report = Report("A gripper holds a cube", fine="three sizes, three steps, ten seconds")
    if report.options["fine"]:
        for voxel in VOXELS:
            for step in STEPS:
                hold(report, voxel, step, MANY)
                drop(report, voxel, step)
    else:
        hold(report, VOXELS[0], STEPS[0], SOME)
        drop(report, VOXELS[0], STEPS[0])
    report.show()


if __name__ == "__main__":
    sys.exit(main())
