"""Annular membranes of EcoFlex 00-30 that lift weights, against the pressures that were measured.

``python evidence/membranes.py [--json] [--fine] [--variants]``. A membrane is that of
`examples/validation/membrane.toml`; nothing is fitted to the data
(`examples/data/membrane_lift/README.md`). For each height of the disc the pressure is found at
which the membrane lifts the weight. Pressure over height is what is compared first: some measured
curves fall in between, so that one pressure has several heights. Heights at a pressure are read
from the predicted curve where it rises. Beyond its ends their errors are lower bounds.

At rest the disc lies on a plate, which carries what the membrane does not. It leaves the plate at
the pressure at which the membrane lifts all of the weight at no height: the force that a disc at a
given height needs and that of a plate below it are the same reaction.
"""

from __future__ import annotations

import statistics
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import voxsoft as vs
from voxsoft.units import MPa, kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "examples" / "validation"))
sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report
from membrane_lift import HEIGHTS, MEMBRANES, Lifted, Membrane, Model, measured

#: The heights that are compared, up to what was measured; with ``--fine`` all of them.
ALL_HEIGHTS = tuple(step * mm for step in (10, 20, 30, 40, 50, 60))
WEIGHTS = (14.72, 24.52, 39.24)

_EPFL = vs.Ogden(
    mu=(24.3610418 * kPa, 66.7032, 0.45381 * kPa), alpha=(1.7137766, 7.0678724, -3.3658807)
)


@dataclass(frozen=True, kw_only=True)
class Variant(Model):
    """What else it may be, and what of it is compared."""

    name: str
    membranes: tuple[str, ...] = ("plain", "rings", "thick")
    heights: tuple[float, ...] = HEIGHTS
    weights: tuple[float, ...] = WEIGHTS


_FEW = {"heights": (10 * mm, 30 * mm, 50 * mm), "weights": (14.72,)}
#: The first was chosen before any pressure was computed: the card of the bending actuator, and the
#: rings of the authors' theory.
VARIANTS = (
    Variant(name="as described"),
    Variant(name="the card of the plain name", rubber="ecoflex-00-30", **_FEW),
    Variant(name="nearly incompressible", rubber=_EPFL, membranes=("plain",), **_FEW),
    Variant(name="tensile test of another laboratory", rubber="ecoflex-00-30-tensile", **_FEW),
    Variant(
        name="constants of the authors' theory", rubber=vs.Gent(shear=31.7 * kPa, jm=39.6), **_FEW
    ),
    Variant(name="rings ten times as stiff", fabric=30 * MPa, membranes=("rings", "thick"), **_FEW),
    Variant(name="two voxels across", refine=2, membranes=("plain", "rings"), **_FEW),
)


def curve(
    membrane: Membrane, variant: Variant, real: dict[tuple[str, float, float], float]
) -> dict[tuple[float, float], float]:
    """The pressure in Pa by weight in N and height in m, where something was measured."""
    found: dict[tuple[float, float], float] = {}
    for height in variant.heights:
        lifted = Lifted(membrane, variant, height)
        near = None
        for weight in variant.weights:
            if (membrane.name, weight, height) not in real:
                continue
            start = _below(found, weight, height) or near or weight / 6.0e-3
            near = lifted.pressure(weight, start)
            found[weight, height] = near
            near = 1.3 * near if np.isfinite(near) else None
    return found


def _below(found: dict[tuple[float, float], float], weight: float, height: float) -> float | None:
    """The pressure for a weight at the last height below one, if there is one."""
    at = [below for w, below in found if w == weight and below < height]
    return found[weight, max(at)] if at and np.isfinite(found[weight, max(at)]) else None


def heights_off(
    found: dict[tuple[float, float], float],
    real: dict[tuple[str, float, float], float],
    membrane: str,
) -> list[float]:
    """Relative errors of the height at each measured pressure but those of the last height.

    Where a pressure is above the predicted curve the disc is higher than the last height, and where
    it is below, lower than the first. That height then counts: the error is at least that.
    """
    errors = []
    for weight in {weight for weight, _ in found}:
        heights = sorted(height for at, height in found if at == weight)
        pressures = np.array([found[weight, height] for height in heights])
        rising = np.maximum.accumulate(pressures)
        for height in heights[:-1]:
            here = float(np.interp(real[membrane, weight, height], rising, heights))
            errors.append(abs(here / height - 1.0))
    return errors


def median(errors: list[float]) -> float:
    """The median in percent."""
    return 100.0 * statistics.median(errors)


def main() -> None:
    """Measure everything."""
    report = Report(
        "Membranes lifting weights",
        fine="all heights",
        variants="also what the experiment may have been else",
    )
    real = measured()
    variants = VARIANTS if report.options["variants"] else VARIANTS[:1]
    if report.options["fine"]:
        variants = (replace(VARIANTS[0], heights=ALL_HEIGHTS), *variants[1:])
    for variant in variants:
        start = time.perf_counter()
        every: list[float] = []
        every_height: list[float] = []
        for membrane in MEMBRANES:
            if membrane.name not in variant.membranes:
                continue
            found, off = curve(membrane, variant, real), []
            for (weight, height), pressure in sorted(found.items()):
                there = real[membrane.name, weight, height]
                name = f"{variant.name}, {membrane.name}, {weight:g} N, {height / mm:g} mm"
                report.add(name, pressure, "Pa", pressure / there)
                off.append(abs(pressure / there - 1.0))
            every += off
            name = f"{variant.name}, {membrane.name}"
            report.add(f"{name}, median error of pressure", median(off), "%")
            heights = heights_off(found, real, membrane.name)
            every_height += heights
            report.add(f"{name}, least median error of height", median(heights), "%")
        report.add(f"{variant.name}, median error of pressure", median(every), "%")
        report.add(f"{variant.name}, least median error of height", median(every_height), "%")
        report.add(f"{variant.name}, time", time.perf_counter() - start, "s")
    report.show()


if __name__ == "__main__":
    sys.exit(main())
