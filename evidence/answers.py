"""What a run answers against the truth: the number, its error bar, and what it cost.

Used by `accuracy.py`. Each row is a body on voxels of one size, run as ``voxsoft run`` does, with
its error bar. Rows give the number over its truth, the error, half the width of the bar, and the
processor time of the run without and with its bar.
"""

from __future__ import annotations

import runpy
import sys
import time
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

import voxsoft as vs
from voxsoft.comparison import ErrorBars, discretization_error, error_bars
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

#: E of everything here.
YOUNG: Final = 60 * kPa
TESTS: Final = Path(__file__).parents[1] / "tests"

#: The number that is looked at, of a result.
Number = Callable[[vs.Result], float]
#: Estimate and error of that number, of error bars.
Bar = Callable[[ErrorBars], tuple[float, float]]


def solved(design: vs.Design) -> vs.Result:
    """The equilibrium, or the end of the benchmark."""
    result = vs.simulate(design)
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {design.name} is {result.status}, {result.message}")
    return result


def answer(report: Report, name: str, design: vs.Design, number: Number, bar: Bar) -> Callable:
    """Run a body, and return what adds its rows once the truth is known; its value is `value`."""
    start = time.process_time()
    result = solved(design)
    alone = time.process_time() - start
    bars = error_bars(result)
    whole = time.process_time() - start
    value = number(result)

    def add(truth: float) -> None:
        report.add(name, value, "", value / truth)
        report.add(f"{name}: error of the run", 100 * (value / truth - 1), "%")
        if bars.voxel_sizes:
            estimate, error = bar(bars)
            report.add(f"{name}: estimate", estimate, "", estimate / truth)
            report.add(f"{name}: its error bar", 100 * abs(error / truth), "%")
            within = abs(estimate - truth) <= error
            report.add(f"{name}: the truth is within it", float(within), "")
        else:
            report.add(f"{name}: no error bar, {bars.sentence}", float("nan"), "")
        report.add(f"{name}: processor time, and with its error bar", whole, "s", whole / alone)

    add.value = value
    return add


def _probe(name: str, axis: int) -> tuple[Number, Bar]:
    """A component of a probe in mm."""

    def number(result: vs.Result) -> float:
        return float(result.probes[name][axis]) / mm

    def bar(bars: ErrorBars) -> tuple[float, float]:
        found = bars.probes[name][axis]
        return found.estimate / mm, found.error / mm

    return number, bar


def _growth() -> tuple[Number, Bar]:
    """How much the cavity grows, in ml."""

    def number(result: vs.Result) -> float:
        return float(result.metric("cavity_volume_change")) * 1e6

    def bar(bars: ErrorBars) -> tuple[float, float]:
        found = bars.metrics["cavity_volume_change"]
        return found.estimate * 1e6, found.error * 1e6

    return number, bar


def rubber(poisson: float) -> vs.NeoHookean:
    """Of the density of the beams' references."""
    return vs.NeoHookean(young=YOUNG, poisson=poisson, density=1070.0)


def beam_answers(
    report: Report,
    name: str,
    make: Callable[[float, int], vs.Design],
    station: str,
    reference: float,
    refines: Sequence[int],
) -> None:
    """A clamped beam by its weight with three Poisson's ratios; the vertical way of its tip.

    The reference is of ν = 0.49. Where there is none the truth is extrapolated from the sizes.
    """
    number, bar = _probe(station, 2)
    for poisson in (0.3, 0.49, 0.4999):
        rows = [
            answer(
                report,
                f"beam {name}, ν {poisson:g}, {5 / refine:g} mm, tip in mm",
                make(poisson, refine),
                number,
                bar,
            )
            for refine in refines
        ]
        limit = discretization_error(
            [5 / refine for refine in refines], [row.value for row in rows]
        ).limit
        for row in rows:
            row(reference if poisson == 0.49 else limit)
        if poisson == 0.49:
            report.add(
                f"beam {name}, ν 0.49, extrapolated from these sizes",
                limit,
                "mm",
                limit / reference,
            )


@cache
def _inner_pressure() -> Callable[..., float]:
    """The closed form of `tests/round_walls.py`."""
    return runpy.run_path(str(TESTS / "round_walls.py"))["inner_pressure"]


def sphere_answers(report: Report) -> None:
    """A thick sphere of 10 and 20 mm, an eighth of it solved, against the closed form."""
    inner, outer = 10 * mm, 20 * mm
    for poisson in (0.3, 0.49, 0.4999):
        for stretch in (1.1, 1.4):
            pressure = _inner_pressure()(YOUNG, poisson, stretch, inner, outer, sphere=True)
            for voxel in (2.5, 1.25):
                design = vs.Design(
                    name="sphere",
                    voxel_size=voxel * mm,
                    fill="fraction",
                    parts=[
                        vs.Part(
                            shape=vs.Sphere(radius=outer) - vs.Sphere(radius=inner),
                            material=rubber(poisson),
                        )
                    ],
                    symmetry=[{"plane": axis} for axis in "xyz"],
                    loads=[vs.Pressure(value=pressure)],
                )
                name = f"sphere, ν {poisson:g}, stretch {stretch:g}, {voxel:g} mm, growth in ml"
                truth = 4 / 3 * np.pi * inner**3 * (stretch**3 - 1) * 1e6
                answer(report, name, design, *_growth())(truth)


def tube_answers(report: Report) -> None:
    """A thick tube of 8 and 16 mm in plane strain, against the closed form."""
    inner, outer = 8 * mm, 16 * mm
    skin = vs.NeoHookean(young=1e-5 * YOUNG, poisson=0.0, density=1070.0)
    for poisson in (0.3, 0.49):
        for stretch in (1.1, 1.4):
            pressure = _inner_pressure()(YOUNG, poisson, stretch, inner, outer, sphere=False)
            for voxel in (2.0, 1.0):
                size = voxel * mm
                height = 4 * mm

                def disk(radius: float, low: float, high: float) -> vs.Cylinder:
                    return vs.Cylinder(radius=radius, base=(0, 0, low), height=high - low)

                wall = disk(outer, 0, height) - disk(inner, -height, 2 * height)
                caps = disk(outer, -size, height + size) - disk(2 * outer, 0, height)
                design = vs.Design(
                    name="tube",
                    voxel_size=size,
                    fill="fraction",
                    parts=[
                        vs.Part(shape=wall, material=rubber(poisson)),
                        # A hundred thousandth of the wall, they only keep the cavity closed.
                        vs.Part(shape=caps, material=skin),
                    ],
                    clamps=[
                        vs.Clamp(region=vs.Region(x=(0, 0)), axes="x"),
                        vs.Clamp(region=vs.Region(y=(0, 0)), axes="y"),
                        vs.Clamp(region=vs.Region(z=(-height, 2 * height)), axes="z"),
                    ],
                    loads=[vs.Pressure(value=pressure)],
                )
                name = f"tube, ν {poisson:g}, stretch {stretch:g}, {voxel:g} mm, growth in ml"
                truth = np.pi * inner**2 * height * (stretch**2 - 1) * 1e6
                answer(report, name, design, *_growth())(truth)


def cylinder_answers(
    report: Report, make: Callable[[float, float], vs.Design], rows: Sequence[tuple[float, float]]
) -> None:
    """Round cylinders of some walls in mm at 4 kPa, of cut voxels; the rise of the middle."""
    for wall, reference in rows:
        for voxel in (5.0, 2.5):
            design = make(wall * mm, voxel * mm).replace(fill="fraction")
            name = f"round cylinder, wall {wall:g} mm, {voxel:g} mm, rise in mm"
            answer(report, name, design, *_probe("center", 2))(reference)


def pneunet_answers(report: Report, design: vs.Design, reference: float) -> None:
    """The PneuNet whose reference is of the same stairs; how far its tip goes."""
    for part in (1, 2):
        cut = design.replace(voxel_size=design.voxel_size / part)
        name = f"PneuNet, {2.5 / part:g} mm, tip in mm"
        answer(report, name, cut, *_probe("tip", 2))(reference)
