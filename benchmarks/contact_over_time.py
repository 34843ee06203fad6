"""Contact over time: what is pinched must not creep, and what slides must slide as Coulomb says.

``python benchmarks/contact_over_time.py [--json] [--fine]``. A capsule of 45 g is held by friction
alone between two soft pads (μ = 0.7), by steps of 1, 5 and 20 ms with the same settings: how far it
creeps once the weight has come, in some seconds or (`--fine`) a minute, and what a second of it
takes. A soft block lies on an incline (μ = 0.5) that holds it, and slides down steeper ones: its
acceleration over that of Coulomb's law.
"""

from __future__ import annotations

import math
import sys

import numpy as np
from measure import Report

import voxsoft as vs
from voxsoft.design import Contact, History, Object
from voxsoft.units import kPa, mm

#: Steps in ms, and how many seconds are shown, by default and with `--fine`.
PINCHES = [(20.0, (6.0, 60.0)), (5.0, (6.0, 60.0)), (1.0, (2.0, 60.0))]
#: When the weight is there, and when what it shook has faded, s.
LOADED, FADED = 0.1, 0.6
FRICTION = 0.5
INCLINES = (20.0, 30.0, 40.0)
GRAVITY = 9.81


def pinch(press: float = 0.8) -> vs.Design:
    """A capsule between pads that close by `press` mm each."""
    pads = vs.Box(size=(6 * mm, 12 * mm, 16 * mm), center=(-7 * mm, 0, 0)) | vs.Box(
        size=(6 * mm, 12 * mm, 16 * mm), center=(7 * mm, 0, 0)
    )
    close = History(time=[0.0, LOADED / 2], factor=[0.0, 1.0])
    come = History(time=[LOADED / 2, LOADED], factor=[0.0, 1.0])
    capsule = vs.Capsule(start=(0, -4 * mm, 0), end=(0, 4 * mm, 0), radius=3.95 * mm)
    return vs.Design(
        name="pinch",
        voxel_size=2 * mm,
        parts=[vs.Part(shape=pads, material=vs.NeoHookean(young=1000 * kPa, poisson=0.45))],
        clamps=[
            vs.Clamp(
                region=vs.Region(x=(10 * mm * side, 10 * mm * side)),
                motion=vs.Motion(displacement=(-press * mm * side, 0, 0), history=close),
            )
            for side in (-1, 1)
        ],
        loads=[vs.Gravity(history=come)],
        objects=[
            Object(name="capsule", shape=capsule, motion="free", mass="45 g", voxel_size=2 * mm)
        ],
        contact=Contact(friction=0.7),
    )


def incline(degrees: float) -> vs.Design:
    """A block of 20 mm on a plane, with gravity turned instead of it."""
    side, angle = 20 * mm, math.radians(degrees)
    plane = vs.Box(size=(0.2, 0.06, 0.01), center=(0.08, 0.01, -0.005))
    return vs.Design(
        name="incline",
        voxel_size=5 * mm,
        parts=[
            vs.Part(
                shape=vs.Box(size=(side, side, side)),
                material=vs.NeoHookean(young=100 * kPa, poisson=0.45),
            )
        ],
        loads=[vs.Gravity(direction=(math.sin(angle), 0, -math.cos(angle)))],
        objects=[Object(name="plane", shape=plane, voxel_size=5 * mm)],
        contact=Contact(friction=FRICTION),
        probes={"middle": vs.Probe(point=(side / 2, side / 2, side / 2))},
    )


def creep(report: Report, step: float, seconds: float) -> None:
    """How far the capsule creeps after what shook it has faded."""
    result = vs.simulate(
        pinch(), end_time=FADED + seconds, time_step=step * 1e-3, record_interval=0.1
    )
    name = f"capsule of 45 g, steps of {step:g} ms"
    if result.status != "ok":
        report.add(f"{name}: {result.status} at", result.time, "s")
        return
    times, heights = result.recording.times, result.recording.objects["capsule"][0][:, 2]
    later = heights[times >= FADED - 1e-9]
    (contact,) = result.contacts
    report.add(f"{name}: force of a pad", contact.pressed / 2.0, "N")
    carried = -contact.force[2]
    report.add(f"{name}: friction, over the weight", carried, "N", carried / (0.045 * GRAVITY))
    report.add(f"{name}: creep in {seconds:g} s", 1e6 * float(np.ptp(later)), "µm")
    report.add(f"{name}: a second of it takes", result.seconds / (FADED + seconds), "s")


def slide(report: Report, degrees: float) -> None:
    """How a block slides down an incline, or stays."""
    result = vs.simulate(incline(degrees), end_time=0.3, time_step=5e-3, record_interval=0.01)
    times, along = result.recording.times, result.recording.probes["middle"][:, 0]
    name = f"block on an incline of {degrees:g}°, μ = {FRICTION}"
    angle = math.radians(degrees)
    expected = GRAVITY * (math.sin(angle) - FRICTION * math.cos(angle))
    later = times >= 0.1 - 1e-9
    if expected > 0.0:
        fit = np.polyfit(times[later], along[later], 2)
        report.add(f"{name}: acceleration", 2.0 * fit[0], "m/s²", 2.0 * fit[0] / expected)
    else:
        report.add(f"{name}: it swings by", 1e6 * float(np.ptp(along[times >= 0.2])), "µm")
        report.add(f"{name}: it drifts by", 1e6 * float(along[-1] - along[later][0]), "µm")


def main() -> None:
    """Measure everything."""
    report = Report("Contact over time", fine="a whole minute of the capsule")
    for degrees in INCLINES:
        slide(report, degrees)
    for step, (some, minute) in PINCHES:
        creep(report, step, minute if report.options["fine"] else some)
    report.show()


if __name__ == "__main__":
    sys.exit(main())
