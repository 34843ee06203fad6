"""Contact over time: what is pinched must not creep, and what slides must slide as Coulomb says.

``python evidence/contact_over_time.py [--json] [--fine]``. A capsule of 45 g is held by friction
alone between two soft pads (μ = 0.7), by steps of 1, 5 and 20 ms with the same settings: how far it
creeps once the weight has come, in some seconds or (`--fine`) a minute, and what a second of it
takes. A soft block lies on an incline (μ = 0.5) that holds it, and slides down steeper ones: its
acceleration over that of Coulomb's law. A rigid ball rolls down one, or slips while it turns where
μ < 2/7 tan θ. A rubber ball bounces, and two of them meet: what they lose of their energy, how much
it ever grows, and how well they keep their momentum.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft.design import Body, Contact, Floor, History, Object
from voxsoft.simulation import Recording
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

#: Steps in ms, and how many seconds are shown, by default and with `--fine`.
PINCHES = [(20.0, (6.0, 60.0)), (5.0, (6.0, 60.0)), (1.0, (2.0, 60.0))]
#: When the weight is there, and when what it shook has faded, s.
LOADED, FADED = 0.1, 0.6
FRICTION = 0.5
INCLINES = (20.0, 30.0, 40.0)
#: Coefficients with which a ball rolls, and slips; 2/7 tan θ is 0.104 between them.
ROLLS, ROLLING_INCLINE = (0.5, 0.08), 20.0
#: Steps in ms of what bounces and meets.
BOUNCES = (5.0, 1.0)
GRAVITY = 9.81
RADIUS = 10 * mm
#: How long one of two balls is pushed, s.
PUSHED = 0.01


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


def rolling(degrees: float, friction: float, voxel: float = 2.0) -> vs.Design:
    """A rigid ball on the floor, with gravity turned instead, and a body that it never meets."""
    angle = math.radians(degrees)
    aside = vs.Box(size=(8 * mm, 8 * mm, 8 * mm), center=(-60 * mm, 0, 40 * mm))
    ball = vs.Sphere(radius=RADIUS, center=(0, 0, RADIUS))
    return vs.Design(
        name="rolling",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=aside, material=soft())],
        clamps=[vs.Clamp(region=vs.Region(x=(-64 * mm, -64 * mm)))],
        loads=[vs.Gravity(direction=(math.sin(angle), 0, -math.cos(angle)))],
        objects=[
            Object(name="ball", shape=ball, motion="free", mass="10 g", voxel_size=voxel * mm)
        ],
        floor=Floor(z=-0.01 * mm),
        contact=Contact(friction=friction),
    )


def soft() -> vs.NeoHookean:
    """Rubber of 1 MPa."""
    return vs.NeoHookean(young=1000 * kPa, poisson=0.45, density=1000)


def bouncing() -> vs.Design:
    """A rubber ball that falls by its diameter, onto the floor."""
    ball = vs.Sphere(radius=RADIUS)
    return vs.Design(
        name="bouncing",
        voxel_size=2.5 * mm,
        parts=[vs.Part(shape=ball, material=soft())],
        loads=[vs.Gravity()],
        floor=Floor(z=-3 * RADIUS),
        contact=Contact(friction=0.5),
    )


def meeting() -> vs.Design:
    """Two rubber balls, of two voxel sizes: one is pushed and meets the other off-center."""
    thrown = History(time=[0.0, PUSHED / 2, PUSHED], factor=[0.0, 1.0, 0.0])
    centers = {"thrown": ((0, 0, 0), 2.5), "resting": ((22 * mm, 3 * mm, 0), 2.0)}
    return vs.Design(
        name="meeting",
        voxel_size=2.5 * mm,
        bodies=[
            Body(
                name=name,
                parts=[vs.Part(shape=vs.Sphere(radius=RADIUS, center=center), material=soft())],
                voxel_size=voxel * mm,
            )
            for name, (center, voxel) in centers.items()
        ],
        loads=[
            vs.Force(
                value=(0.8, 0, 0), region=vs.Region(body="thrown", x=(-math.inf, 0)), history=thrown
            )
        ],
        contact=Contact(friction=0.3),
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


def roll(report: Report, friction: float, voxel: float = 2.0) -> None:
    """How a ball comes down an incline, without slip or with it."""
    step = 5e-3
    design = rolling(ROLLING_INCLINE, friction, voxel)
    result = vs.simulate(design, end_time=0.2, time_step=step, record_interval=step)
    times, (places, turns) = result.recording.times, result.recording.objects["ball"]
    later = times >= 0.05 - 1e-9
    turned = RADIUS * np.unwrap(np.arctan2(turns[:, 0, 2], turns[:, 0, 0]))
    way = places[:, 0]
    along, around = (2.0 * np.polyfit(times[later], each[later], 2)[0] for each in (way, turned))
    angle = math.radians(ROLLING_INCLINE)
    pull, bound = GRAVITY * math.sin(angle), friction * GRAVITY * math.cos(angle)
    slips = friction < 2.0 / 7.0 * math.tan(angle)
    expected = (pull - bound, 2.5 * bound) if slips else (5.0 / 7.0 * pull,) * 2
    name = f"ball of voxels of {voxel:g} mm on {ROLLING_INCLINE:g}°, μ = {friction:g}"
    report.add(f"{name}: acceleration", along, "m/s²", along / expected[0])
    report.add(f"{name}: turns, at its radius", around, "m/s²", around / expected[1])
    slip = float(np.ptp((way - turned)[later]))
    report.add(f"{name}: slip, over its way", 1e3 * slip, "mm", slip / float(np.ptp(way[later])))


def energies(recording: Recording) -> tuple[NDArray[np.float64], float]:
    """The energy at each instant in J, and by how much it ever grows beyond what it was."""
    total = recording.kinetic_energy + recording.elastic_energy + recording.load_potential
    return total, float(np.max(total - np.minimum.accumulate(total)))


def bounce(report: Report, step: float) -> None:
    """What a ball loses as it bounces."""
    result = vs.simulate(
        bouncing(), end_time=0.3, time_step=step * 1e-3, record_interval=step * 1e-3
    )
    recording = result.recording
    total, grown = energies(recording)
    fall = result.mass * GRAVITY * 2.0 * RADIUS
    name = f"ball that bounces, steps of {step:g} ms"
    report.add(f"{name}: energy grows by, over that of the fall", 1e6 * grown, "µJ", grown / fall)
    # The ball is in the air where nothing touches; its energy there tells how high it goes.
    touching = np.array([bool(found) for found in recording.contacts])
    left = np.flatnonzero(touching[:-1] & ~touching[1:]) + 1
    for count, index in enumerate(left, 1):
        kept = (total[index] - total[0]) / fall + 1.0
        report.add(f"{name}: energy after bounce {count}", 1e6 * kept * fall, "µJ", kept)


def meet(report: Report, step: float) -> None:
    """How two balls keep their momentum and energy as they meet."""
    result = vs.simulate(
        meeting(), end_time=0.06, time_step=step * 1e-3, record_interval=step * 1e-3
    )
    recording = result.recording
    flying = recording.times >= PUSHED - 1e-9
    momentum = recording.momentum[flying]
    off = float(np.linalg.norm(momentum - momentum[0], axis=1).max())
    total = (recording.kinetic_energy + recording.elastic_energy)[flying]
    grown = float(np.max(total - np.minimum.accumulate(total)))
    name = f"two balls that meet, steps of {step:g} ms"
    size = float(np.linalg.norm(momentum[0]))
    report.add(f"{name}: momentum changes by, over itself", 1e3 * off, "g m/s", off / size)
    report.add(f"{name}: energy grows by, over itself", 1e6 * grown, "µJ", grown / total[0])
    report.add(f"{name}: energy in the end", 1e6 * total[-1], "µJ", total[-1] / total[0])


def main() -> None:
    """Measure everything."""
    report = Report("Contact over time", fine="a minute of the capsule, a finer ball")
    for degrees in INCLINES:
        slide(report, degrees)
    fine = report.options["fine"]
    for friction in ROLLS:
        for voxel in (2.0, 1.0) if fine else (2.0,):
            roll(report, friction, voxel)
    for step in BOUNCES:
        bounce(report, step)
        meet(report, step)
    for step, (some, minute) in PINCHES:
        creep(report, step, minute if fine else some)
    report.show()


if __name__ == "__main__":
    sys.exit(main())
