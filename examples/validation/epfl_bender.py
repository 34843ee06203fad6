"""Bending actuators of EcoFlex 00-30 with a film of silk: angle over pressure, nothing fitted.

The silicone's constants were published from tensile tests, and so was the film's modulus. Half of
the actuator is solved. With voxels of 2 mm the tunnel between the chambers is twice as wide as it
was; voxels of 1 mm take a quarter of an hour. The path is followed by the volume of the chambers.
Measured: Reconfigurable Robotics Lab, EPFL (`examples/data/epfl_bender/README.md`).

``python examples/validation/epfl_bender.py [--wall MM] [--voxel MM] [--film PA] [--ratio R]
[--picture FILE]``; walls of 10 or 7 mm, the latter with voxels of 1 mm.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import voxsoft as vs
from voxsoft.design import Symmetry
from voxsoft.plot.style import SERIES, empty_figure, plain_axes, plain_legend
from voxsoft.scoreboard import Prediction
from voxsoft.units import GPa, kPa, mm

Floats = NDArray[np.float64]

DESIGN = Path(__file__).parent / "epfl_bender.toml"
DATA = Path(__file__).parents[1] / "data" / "epfl_bender" / "angle.csv"
#: Width of the chambers and of the tunnel [m].
CHAMBER, TUNNEL = 8 * mm, 2 * mm
#: How far the chambers grow, and the largest step of that. Larger first steps are lost.
RATIO, STEP = 40.0, 0.75
#: Measured angles are zero here, where the recording begins.
START = 10 * kPa
#: On the scoreboard: walls with their voxels [m], angles, and how far the chambers grow for them.
#: Walls of 7 mm and chambers of 8 mm have no larger voxels.
WALLS, ANGLES, ENOUGH = {10 * mm: 2 * mm, 7 * mm: 1 * mm}, (2, 5, 10, 15, 20), 20.0
#: Initial shear moduli [Pa] that the laboratory publishes for the same tensile tests: Ogden's three
#: terms, which are the card, Yeoh's model, a neo-Hookean and Mooney's.
SHEAR = (24.88155 * kPa, 26.4458 * kPa, 27.3554 * kPa, 28.9445 * kPa)
#: Standard deviations of the middle 90 % of a normal distribution.
NINETY = 1.645
#: Relative half-widths that are assumed: geometry and voxels.
GEOMETRY, VOXELS = 0.05, 0.05


@dataclass(frozen=True)
class Curve:
    """Angle in rad over pressure in Pa; a path need not be monotonic."""

    pressure: Floats
    angle: Floats


def measured(wall: float = 10 * mm) -> Curve:
    """The recorded angles of the actuator with walls of so many m, from the angle at 10 kPa on."""
    name = f"chamber8x8-c5-w{wall / mm:g}"
    with DATA.open() as file:
        rows = [row for row in csv.DictReader(file) if row["actuator"] == name]
    pressure = np.array([float(row["pressure_kPa"]) for row in rows]) * kPa
    return Curve(pressure, np.radians([float(row["angle_deg"]) for row in rows]))


def predicted(
    ratio: float = RATIO, film: float = 4.1 * GPa, wall: float = 10 * mm, voxel: float = 2 * mm
) -> Curve:
    """The equilibria along the path, from no pressure on.

    The angle is that of the line from the root's lower edge to the tip's, as the authors measure
    it in pictures: about half of what the tip turns.

    Parameters
    ----------
    ratio
        Volume of the chambers at the end, over that without pressure.
    film
        Young's modulus of the film in Pa, of which there are 0.5 mm.
    wall
        Thickness of the walls in m.
    voxel
        Size of the voxels in m.
    """
    design = vs.load(DESIGN, film=film, wall=wall, tunnel=2 * max(voxel, TUNNEL / 2))
    middle = (CHAMBER + 2 * wall) / 2
    design = design.replace(voxel_size=voxel, symmetry=[Symmetry(plane="y", at=middle)])
    steps = round((ratio - 1.0) / STEP)
    result = vs.simulate(design, volume_ratio=ratio, steps=max(steps, 12))
    assert result.status == "ok", result.message
    load = design.loads[0]
    assert isinstance(load, vs.Pressure)
    moved = result.recording.probes["tip"]
    length = float(np.ptp(result.mesh.vertices[:, 0]))
    angle = np.arctan2(-moved[:, 2], length + moved[:, 0])
    return Curve(load.value * result.recording.times, angle)


def from_start(curve: Curve) -> Curve:
    """Angles less that at 10 kPa, as the recording counts them."""
    angle = np.interp(START, curve.pressure[: _turn(curve)], curve.angle[: _turn(curve)])
    return Curve(curve.pressure, curve.angle - angle)


def _turn(curve: Curve) -> int:
    """How many points the path has before its pressure falls for the first time."""
    falls = np.flatnonzero(np.diff(curve.pressure) < 0.0)
    return int(falls[0]) + 1 if len(falls) else len(curve.pressure)


def errors(simulated: Curve, real: Curve) -> tuple[Floats, Floats]:
    """Pressures in Pa that both curves reach, and predicted less measured angles there, in rad."""
    line, rising = from_start(simulated), slice(_turn(simulated))
    at = real.pressure[real.pressure <= line.pressure[rising][-1]]
    here = np.interp(at, line.pressure[rising], line.angle[rising])
    return at, here - real.angle[: len(at)]


def reached(curve: Curve, angle: float) -> float:
    """The pressure in Pa at which a curve first has an angle, NaN if it does not."""
    above = np.flatnonzero(curve.angle >= angle)
    if len(above) == 0 or above[0] == 0:
        return float("nan")
    pair = slice(above[0] - 1, above[0] + 1)
    return float(np.interp(angle, curve.angle[pair], curve.pressure[pair]))


def steepest(curve: Curve) -> tuple[float, float]:
    """Where an angle grows most over pressure, in Pa, and how much, in rad/Pa."""
    rising = slice(_turn(curve))
    pressure, angle = curve.pressure[rising], curve.angle[rising]
    slope = np.diff(angle) / np.diff(pressure)
    most = int(np.argmax(slope))
    return float(pressure[most : most + 2].mean()), float(slope[most])


def stiffness_open() -> float:
    """By how much, as a part of it, the rubber's stiffness is open: half-width of 90 %.

    The four sets of constants that are published for the same tests differ in their modulus at
    small strain.
    """
    return NINETY * float(np.std(np.log(SHEAR), ddof=1))


def predictions() -> list[Prediction]:
    """The pressures at which the actuators with walls of 10 and 7 mm reach some angles.

    Material: what the sets of constants that are published for the same tests differ by, a tenth of
    the modulus, and pressures go with it, as the film hardly stretches; batches are not in it.
    Geometry, assumed: 5 %, as chambers are cast within some 0.2 mm, and the tunnel in walls of
    10 mm is modeled twice as wide as it is. Numerics, assumed: 5 % for voxels of one size.
    Repeatability: samples scatter by 10 to 25 degrees around the transition; its steepest part
    makes 2 kPa of it.
    """
    found = []
    for wall, voxel in WALLS.items():
        simulated = from_start(predicted(ENOUGH, wall=wall, voxel=voxel))
        real = measured(wall)
        for degrees in ANGLES:
            here, there = (reached(curve, np.radians(degrees)) for curve in (simulated, real))
            if not np.isfinite(here):
                raise ArithmeticError(f"walls of {wall / mm:g} mm never reach {degrees} degrees")
            found.append(
                Prediction(
                    f"EPFL bender, walls of {wall / mm:g} mm",
                    f"pressure for {degrees} deg",
                    "pressure",
                    there,
                    here,
                    material=stiffness_open() * here,
                    geometry=GEOMETRY * here,
                    numerics=VOXELS * here,
                    repeatability=2 * kPa,
                )
            )
    return found


def main() -> None:
    """Print the comparison, and draw it if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--wall", type=float, default=10.0, help="thickness of the walls, mm")
    parser.add_argument("--voxel", type=float, default=2.0, help="size of the voxels, mm")
    parser.add_argument("--film", type=float, default=4.1 * GPa, help="modulus of the film, Pa")
    parser.add_argument("--ratio", type=float, default=RATIO, help="how far the chambers grow")
    parser.add_argument("--picture", type=Path, help="where to save a picture")
    options = parser.parse_args()
    wall, voxel = options.wall * mm, options.voxel * mm
    simulated, real = predicted(options.ratio, options.film, wall, voxel), measured(wall)
    at, apart = errors(simulated, real)
    print(
        f"up to {at[-1] / kPa:.1f} kPa the angle is {np.degrees(np.abs(apart).mean()):.1f} deg off"
    )
    for pressure, difference in zip(at, apart, strict=True):
        angle = np.interp(pressure, real.pressure, real.angle)
        here, there = np.degrees((angle + difference, angle))
        print(f"  {pressure / kPa:.1f} kPa: {here:.1f} deg, measured {there:.1f}")
    for degrees in (2, 5, 10, 15, 20, 30):
        angle = np.radians(degrees)
        here, there = (reached(curve, angle) / kPa for curve in (from_start(simulated), real))
        print(f"  {degrees} deg at {here:.1f} kPa, measured {there:.1f}")
    for name, curve in {"predicted": simulated, "measured": real}.items():
        pressure, slope = steepest(curve)
        slope = np.degrees(slope) * kPa
        print(f"  {name}: steepest at {pressure / kPa:.1f} kPa, {slope:.1f} deg/kPa")
    if options.picture:
        draw(simulated, real, options.picture)


def draw(simulated: Curve, real: Curve, path: Path) -> None:
    """Draw angle over pressure, predicted and measured."""
    figure = empty_figure(6.5, 4.2)
    axes = figure.subplots()
    line = from_start(simulated)
    axes.plot(line.pressure / kPa, np.degrees(line.angle), color=SERIES[0], label="predicted")
    seen = np.degrees(real.angle)
    axes.plot(real.pressure / kPa, seen, "o", color=SERIES[1], markersize=4, label="measured")
    axes.set_xlim(START / kPa, 70)
    plain_axes(axes, x="pressure (kPa)", y="bending angle from 10 kPa on (degrees)")
    plain_legend(axes, loc="upper left")
    figure.savefig(path)


if __name__ == "__main__":
    main()
