"""Round and thin bodies of cut voxels beside truths that share no method with them.

``python evidence/round_bodies.py [--json] [--only NUMBER] [--patience SECONDS]``; with
``accuracy.py --round`` it follows the other bodies. One, two and four voxels through the thinnest
wall; each run has its error bar, as ``voxsoft run`` makes it. Truths of tubes, spheres and capsules
are those of `axisymmetric.py`, that of the PneuNet is of mixed bricks (`tests/data/README.md`).
Segment and bender have none from outside: theirs are our own two finest sizes, extrapolated with
order 1, and are named so. A run, or its bar, that takes longer than its patience of processor time
is left out and says so.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import places
from answers import Bar, Number, _growth, _probe
from axisymmetric import arc, between, can, stadium
from make_references import pneunet

import voxsoft as vs
from voxsoft.comparison import error_bars
from voxsoft.errors import VoxSoftError
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

#: E in kPa and ν of the bodies.
YOUNG, POISSON = 100.0, 0.49
#: Chamber and body of the tube of the review, and the heights of its faces, in mm.
RADII, HEIGHTS = (10.0, 20.0), (0.0, 10.0, 50.0, 60.0)
TUBE_PRESSURE: Final = 11.5
#: Distance of the centers of the two spheres in mm.
OFF: Final = 5.0
RATIOS: Final = (1.3, 2.0)
#: Radii of the capsule, and half the distance of its centers, in mm.
CAPSULE: Final = (10.0, 15.0, 10.0)
CAPSULE_PRESSURE: Final = 8.0
#: Tip of the PneuNet of Q2-P1 bricks in mm.
PNEUNET: Final = "pneunet-2.5"


class TooSlowError(Exception):
    """A run that takes longer than it may."""


@dataclass(frozen=True)
class Body:
    """A body: its design by voxel size in mm, three sizes, and what is looked at.

    The truth is None where our own sizes have to give it.
    """

    name: str
    make: Callable[[float], vs.Design]
    sizes: tuple[float, float, float]
    numbers: Mapping[str, tuple[Number, Bar, float | None]] = field(default_factory=dict)


def _rubber() -> vs.NeoHookean:
    return vs.NeoHookean(young=YOUNG * kPa, poisson=POISSON, density=1000.0)


def _pressure() -> tuple[Number, Bar]:
    """Pressure of volume control in kPa, by a load of 1 kPa."""

    def number(result: vs.Result) -> float:
        return float(result.load_factor)

    def bar(bars: vs.comparison.ErrorBars) -> tuple[float, float]:
        assert bars.load_factor is not None
        return bars.load_factor.estimate, bars.load_factor.error

    return number, bar


def tube(size: float, turn: float) -> vs.Design:
    """The tube of the review, turned about an oblique axis with its clamp and probes."""
    low, bottom, top, high = (height * mm for height in HEIGHTS)
    inner, outer = (radius * mm for radius in RADII)
    wall = vs.Cylinder(radius=outer, base=(0, 0, low), height=high - low)
    room = vs.Cylinder(radius=inner, base=(0, 0, bottom), height=top - bottom)
    part = vs.Part(shape=wall - room, material=_rubber())
    where = {} if turn == 0 else {"body": "tube"}
    middle = (bottom + top) / 2
    common: dict[str, Any] = {
        "name": "tube",
        "voxel_size": size * mm,
        "fill": "fraction",
        "clamps": [vs.Clamp(region=vs.Region(z=(low, low), **where))],
        "loads": [vs.Pressure(value=TUBE_PRESSURE * kPa)],
        "probes": {
            "bore": vs.Probe(point=(inner, 0, middle), **where),
            "outside": vs.Probe(point=(outer, 0, middle), **where),
            "top": vs.Probe(point=(0, 0, high), **where),
        },
    }
    if turn == 0:
        return vs.Design(parts=[part], symmetry=[{"plane": axis} for axis in "xy"], **common)
    rotation = vs.design.Rotation(axis=(2, 1, 0), angle=f"{turn} deg")
    body = vs.design.Body(name="tube", parts=[part], rotation=rotation)
    return vs.Design(bodies=[body], **common)


def off_center(size: float, ratio: float) -> vs.Design:
    """A sphere of 20 mm with a room of 10 mm that lies higher, and grows to `ratio`."""
    inner, outer = (radius * mm for radius in RADII)
    shape = vs.Sphere(radius=outer) - vs.Sphere(radius=inner, center=(0, 0, OFF * mm))
    return vs.Design(
        name="off-center sphere",
        voxel_size=size * mm,
        fill="fraction",
        parts=[vs.Part(shape=shape, material=_rubber())],
        symmetry=[{"plane": axis} for axis in "xy"],
        # A single vertex: nothing acts on it.
        clamps=[vs.Clamp(region=vs.Region(x=(0, 0), y=(0, 0), z=(-outer, -outer)), axes="z")],
        loads=[vs.Pressure(value=1 * kPa)],
        solver={"control": "volume", "volume_ratio": ratio, "steps": 5},
    )


def capsule(size: float) -> vs.Design:
    """A capsule that nothing holds, an eighth of it solved."""
    inner, outer, half = (length * mm for length in CAPSULE)
    ends = {"start": (0, 0, -half), "end": (0, 0, half)}
    return vs.Design(
        name="capsule",
        voxel_size=size * mm,
        fill="fraction",
        parts=[
            vs.Part(
                shape=vs.Capsule(radius=outer, **ends) - vs.Capsule(radius=inner, **ends),
                material=_rubber(),
            )
        ],
        symmetry=[{"plane": axis} for axis in "xyz"],
        loads=[vs.Pressure(value=CAPSULE_PRESSURE * kPa)],
    )


def pneunet_of(size: float) -> vs.Design:
    """The PneuNet of `make_references.py` of voxels of another size, on the grid."""
    return pneunet().replace(voxel_size=size * mm, fill="fraction")


def _away(name: str, axes: tuple[int, ...]) -> tuple[Number, Bar]:
    """Length of some components of a probe in mm; their errors are added."""

    def number(result: vs.Result) -> float:
        return float(sum(result.probes[name][axis] ** 2 for axis in axes) ** 0.5) / mm

    def bar(bars: vs.comparison.ErrorBars) -> tuple[float, float]:
        found = [bars.probes[name][axis] for axis in axes]
        estimate = sum(each.estimate**2 for each in found) ** 0.5
        return estimate / mm, sum(each.error for each in found) / mm

    return number, bar


def _placed(name: str) -> Callable[[float], vs.Design]:
    return lambda size: places.design(name, "fraction", size, 0.0).replace(solver=vs.Solver())


def bodies(references: Mapping[tuple[str, str], float]) -> Iterator[Body]:
    """All bodies, with their truths."""
    exact = can(RADII, HEIGHTS, YOUNG, POISSON, 2.5).at_pressure(TUBE_PRESSURE)
    middle = sum(HEIGHTS[1:3]) / 2
    bore, outside = (float(exact.moved((radius, middle))[0]) for radius in RADII)
    top = float(exact.moved((0.0, HEIGHTS[3]))[1])
    yield Body(
        "tube",
        lambda size: tube(size, 0),
        (10, 5, 2.5),
        {
            "growth in ml": (*_growth(), exact.grown),
            "bore in mm": (*_probe("bore", 0), bore),
            "outside in mm": (*_probe("outside", 0), outside),
            "top in mm": (*_probe("top", 2), top),
        },
    )
    yield Body(
        "tube turned by 30 degrees",
        lambda size: tube(size, 30),
        (10, 5, 2.5),
        {
            "growth in ml": (*_growth(), exact.grown),
            "top in mm": (*_away("top", (0, 1, 2)), top),
        },
    )
    lump = between(arc(RADII[0], OFF), arc(RADII[1]), YOUNG, POISSON, (6, 24))
    for ratio in RATIOS:
        yield Body(
            f"off-center sphere, volume times {ratio:g}",
            lambda size, ratio=ratio: off_center(size, ratio),  # type: ignore[misc]
            (5, 2.5, 1.25),
            {"pressure in kPa": (*_pressure(), lump.at_volume(ratio).pressure)},
        )
    inner, outer, half = CAPSULE
    shell = between(
        stadium(inner, half), stadium(outer, half), YOUNG, POISSON, (4, 8), (0, 1 / 3, 2 / 3, 1)
    )
    yield Body(
        "capsule",
        capsule,
        (5, 2.5, 1.25),
        {"growth in ml": (*_growth(), shell.at_pressure(CAPSULE_PRESSURE).grown)},
    )
    for name in ("segment", "bender"):
        size = places.BODIES[name][-1]
        yield Body(
            name,
            _placed(name),
            (2 * size, size, size / 2),
            {"growth in ml": (*_growth(), None), "end in mm": (*_probe("tip", 0), None)},
        )
    yield Body(
        "PneuNet",
        pneunet_of,
        (2.5, 1.25, 0.625),
        {"tip in mm": (*_probe("tip", 2), references[PNEUNET, "tip_uz_mm"])},
    )


def impatient(patience: float) -> Callable[..., None]:
    """A listener to progress that ends a run after some seconds of processor time."""
    started = time.process_time()

    def report(*_: float) -> None:
        if time.process_time() - started > patience:
            raise TooSlowError(f"not done after {patience:g} s")

    return report


def round_answers(
    report: Report, references: Mapping[tuple[str, str], float], patience: float, only: int | None
) -> None:
    """Add the rows of all bodies, or of one of them, and how many bars hold."""
    held: list[bool] = []
    for index, body in enumerate(bodies(references)):
        if only is not None and index != only:
            continue
        seen: list[tuple[str, dict[str, float], dict[str, tuple[float, float]]]] = []
        for voxels, size in zip((1, 2, 4), body.sizes, strict=True):
            name = f"{body.name}, {voxels} voxels a wall, {size:g} mm"
            start = time.process_time()
            try:
                result = vs.simulate(body.make(size), progress=impatient(patience))
                if result.status != "ok":
                    raise VoxSoftError(body.name, result.message)
            except (TooSlowError, VoxSoftError) as error:
                report.add(f"{name}: not solved, {error}", float("nan"), "")
                continue
            report.add(f"{name}: processor time", time.process_time() - start, "s")
            values = {key: each[0](result) for key, each in body.numbers.items()}
            found: dict[str, tuple[float, float]] = {}
            try:
                bars = error_bars(result, progress=impatient(patience))
                report.add(f"{name}: with its bar", time.process_time() - start, "s")
                if bars.voxel_sizes:
                    found = {key: each[1](bars) for key, each in body.numbers.items()}
                else:
                    report.add(f"{name}: no bar, {bars.sentence}", float("nan"), "")
            except TooSlowError as error:
                report.add(f"{name}: no bar, {error}", float("nan"), "")
            seen.append((name, values, found))
        for key, (_, _, truth) in body.numbers.items():
            kind = "truth"
            if truth is None:
                if len(seen) < 2:
                    continue
                kind, truth = "our own two sizes, order 1", 2 * seen[-1][1][key] - seen[-2][1][key]
            report.add(f"{body.name}, {key}, {kind}", truth, "")
            for name, values, found in seen:
                label = f"{name}, {key}"
                report.add(label, values[key], "", values[key] / truth)
                report.add(f"{label}: error", 100 * (values[key] / truth - 1), "%")
                if key in found:
                    estimate, error = found[key]
                    within = abs(estimate - truth) <= error
                    held.append(within)
                    width, off = abs(error / truth), abs(values[key] / truth - 1)
                    words = "holds" if within else "MISSED"
                    ratio = width / max(off, 1e-9)
                    report.add(f"{label}: half the bar, {words}", 100 * width, "%", ratio)
    report.add(f"bars of {len(held)} that hold", float(sum(held)), "")


def main() -> None:
    """Measure round bodies alone."""
    from accuracy import voxel_references

    report = Report(
        "Round and thin bodies of cut voxels",
        {
            "only": (None, "the number of one body, from 0"),
            "patience": (60, "seconds of processor time for a run, and as many for its bar"),
        },
    )
    given = report.options
    round_answers(report, voxel_references(), float(given["patience"]), given["only"])
    report.show()


if __name__ == "__main__":
    main()
