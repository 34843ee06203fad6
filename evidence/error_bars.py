"""Whether error bars hold, on bodies that were fixed before any of them was solved.

``python evidence/error_bars.py TABLE SET [KIND ...]``. Three sets of nine kinds of bodies, drawn
from a generator of random numbers by kind and number. With the first set at hand the rule of
`voxsoft.comparison.bars` was made wider; after the second, the floor of 1 % was added; the third
had no part in it. Each body is run as ``voxsoft run`` does, and its estimate held against the
truth: the same number on voxels half as large and smaller, extrapolated from the finest sizes.
An error bar holds where the truth, give or take a fifth of the last change, is within it. Its width
is compared with the error of the run.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

import voxsoft as vs
from voxsoft.comparison import ErrorBars, discretization_error, error_bars
from voxsoft.design.contact import Contact
from voxsoft.simulation import Result
from voxsoft.units import kPa, mm

#: The numbers of the bodies of each kind in each set.
SETS = {"first": range(8), "second": range(8, 16), "third": range(16, 24)}
#: Voxels that the finest of a truth may have.
MOST = 12_000
HEAD = (
    "kind",
    "number",
    "voxels",
    "value",
    "estimate",
    "error",
    "truth",
    "unsure",
    "held",
    "regular",
)

Draw = np.random.Generator
H = 2.5 * mm


class Case(NamedTuple):
    """A design, and the number that is looked at: a component of its probe, or a volume."""

    design: vs.Design
    axis: int | None = 2


def rubber(draw: Draw) -> object:
    """One of four kinds of rubber."""
    poisson = float(draw.choice([0.3, 0.45, 0.49, 0.499]))
    young = float(draw.uniform(40, 200)) * kPa
    models = (
        vs.NeoHookean(young=young, poisson=poisson),
        vs.MooneyRivlin(c10=young / 8, c01=young / 24, poisson=poisson),
        vs.Yeoh(c=(young / 6, -young / 200, young / 2000), poisson=poisson),
        vs.Ogden(mu=(young / 3.2, young / 40), alpha=(2.4, -2.0), poisson=poisson),
    )
    return models[int(draw.integers(len(models)))]


def box(*corners: tuple[float, float, float]) -> vs.Box:
    """A box between two corners in voxels."""
    low, high = corners
    size = tuple((b - a) * H for a, b in zip(low, high, strict=True))
    return vs.Box(size=size, corner=tuple(a * H for a in low))


def at(**planes: float) -> vs.Region:
    """Planes, in voxels."""
    return vs.Region(**{axis: (a * H, a * H) for axis, a in planes.items()})


def design(shape: object, material: object, **more: object) -> vs.Design:
    """A design of one part, unless `parts` are given."""
    parts = more.pop("parts", None) or [vs.Part(shape=shape, material=material)]
    return vs.Design(name="body", voxel_size=H, parts=parts, **more)


def probe(*point: float) -> dict[str, vs.Probe]:
    """A probe at a point in voxels."""
    return {"probe": vs.Probe(point=tuple(a * H for a in point))}


def sides(draw: Draw, low: int, high: int, count: int) -> list[int]:
    """Numbers of voxels."""
    return [int(n) for n in draw.integers(low, high, size=count, endpoint=True)]


def beam(draw: Draw) -> Case:
    """Clamped at one end, bent by its weight or a force."""
    long, wide, high = *sides(draw, 8, 16, 1), *sides(draw, 2, 4, 2)
    load = (
        vs.Gravity(value=float(draw.uniform(5, 30)))
        if draw.random() < 0.5
        else vs.Force(
            region=at(x=long), value=(0, 0, -float(draw.uniform(0.2, 2)) * 1e-3 * wide * high**3)
        )
    )
    body = box((0, 0, 0), (long, wide, high))
    clamps = [vs.Clamp(region=at(x=0))]
    return Case(design(body, rubber(draw), clamps=clamps, loads=[load], probes=probe(long, 0, 0)))


def twisted(draw: Draw) -> Case:
    """A bar twisted by two forces at its end."""
    long, side = *sides(draw, 6, 14, 1), *sides(draw, 2, 4, 1)
    force = float(draw.uniform(1, 6)) * 1e-3 * side**2
    loads = [
        vs.Force(region=at(x=long, y=0), value=(0, 0, force)),
        vs.Force(region=at(x=long, y=side), value=(0, 0, -force)),
    ]
    body = box((0, 0, 0), (long, side, side))
    clamps = [vs.Clamp(region=at(x=0))]
    middle = long // 2
    return Case(
        design(body, rubber(draw), clamps=clamps, loads=loads, probes=probe(middle, 0, side // 2))
    )


def round_chamber(draw: Draw) -> Case:
    """A ball or a tube under pressure, of cut voxels; its growth."""
    inner, wall = float(draw.uniform(2.5, 3.5)), float(draw.uniform(2.0, 3.0))
    outer = inner + wall
    if draw.random() < 0.5:
        shape = vs.Sphere(radius=outer * H) - vs.Sphere(radius=inner * H)
        held = vs.Region(z=("-inf", -0.8 * outer * H))
    else:
        length = 2.0 * outer
        ends = {"start": (0, 0, -0.5 * length * H), "end": (0, 0, 0.5 * length * H)}
        shape = vs.Capsule(radius=outer * H, **ends) - vs.Capsule(radius=inner * H, **ends)
        held = vs.Region(z=("-inf", -(0.5 * length + 0.6 * outer) * H))
    material = rubber(draw)
    pressure = float(draw.uniform(0.02, 0.12)) * material.young() * wall / inner
    loads = [vs.Pressure(value=pressure)]
    return Case(
        design(shape, material, clamps=[vs.Clamp(region=held)], loads=loads, fill="fraction"), None
    )


def flat_chamber(draw: Draw, thin: int = 2) -> Case:
    """A box with a box in it under pressure; its growth."""
    a, b, c = sides(draw, 2, 5, 3)
    w = thin
    body = box((0, 0, 0), (a + 2 * w, b + 2 * w, c + 2 * w)) - box((w, w, w), (a + w, b + w, c + w))
    material = rubber(draw)
    pressure = float(draw.uniform(0.02, 0.1)) * material.young() * (w / max(a, b, c)) ** 1.5
    clamps = [vs.Clamp(region=at(x=0))]
    return Case(design(body, material, clamps=clamps, loads=[vs.Pressure(value=pressure)]), None)


def thin_wall(draw: Draw) -> Case:
    """A chamber with walls of one voxel, or a plate of one voxel."""
    if draw.random() < 0.5:
        return flat_chamber(draw, 1)
    a, b = sides(draw, 5, 10, 2)
    material = rubber(draw)
    load = vs.Traction(region=at(z=1), value=float(draw.uniform(0.5, 3)) * 1e-4 * material.young())
    clamps = [vs.Clamp(region=at(x=0)), vs.Clamp(region=at(x=a))]
    points = probe(a // 2, b, 0)
    return Case(
        design(box((0, 0, 0), (a, b, 1)), material, clamps=clamps, loads=[load], probes=points)
    )


def gyroid(draw: Draw) -> Case:
    """A block of a gyroid, of cut voxels, that carries a weight."""
    cells = sides(draw, 6, 8, 3)
    block = box((0, 0, 0), tuple(cells))
    period, thick = float(draw.uniform(6, 8)), float(draw.uniform(2.2, 3.0))
    sheet = vs.Gyroid(period=period * H, thickness=thick * H)
    material = rubber(draw)
    loads = [vs.Gravity(value=float(draw.uniform(20, 80)))]
    clamps = [vs.Clamp(region=at(z=0))]
    probes = {"probe": vs.Probe(z=(cells[2] * H, cells[2] * H))}
    return Case(
        design(block & sheet, material, clamps=clamps, loads=loads, probes=probes, fill="fraction")
    )


def two_materials(draw: Draw) -> Case:
    """A beam of two layers, the upper stiffer."""
    long, wide, low, top = *sides(draw, 8, 14, 1), *sides(draw, 2, 3, 3)
    soft = rubber(draw)
    stiff = vs.NeoHookean(young=float(draw.uniform(2, 8)) * soft.young(), poisson=0.45)
    parts = [
        vs.Part(shape=box((0, 0, low), (long, wide, low + top)), material=stiff),
        vs.Part(shape=box((0, 0, 0), (long, wide, low)), material=soft),
    ]
    return Case(
        design(
            None,
            None,
            parts=parts,
            clamps=[vs.Clamp(region=at(x=0))],
            loads=[vs.Gravity(value=float(draw.uniform(10, 40)))],
            probes=probe(long, 0, 0),
        )
    )


def pressed_on(draw: Draw) -> Case:
    """A block that is pressed on the floor, with friction, and bulges."""
    a, b, c = sides(draw, 3, 5, 3)
    down = vs.Motion(displacement=(0, 0, -float(draw.uniform(0.05, 0.2)) * c * H))
    body = box((0, 0, 0), (a, b, c))
    clamps = [vs.Clamp(region=at(z=c), motion=down)]
    contact = Contact(friction=float(draw.choice([0.0, 0.3, 0.8])))
    points = probe(a, b // 2, c // 2)
    return Case(
        design(
            body,
            rubber(draw),
            clamps=clamps,
            loads=[],
            probes=points,
            floor=vs.Floor(z=0.0),
            contact=contact,
        ),
        0,
    )


def strained(draw: Draw) -> Case:
    """A block drawn, squeezed or sheared far; how its side moves."""
    a, b, c = sides(draw, 3, 6, 3)
    way = float(draw.choice([0.8, 0.5, -0.3])) * c * H
    aside = float(draw.uniform(0, 0.5)) * c * H
    motion = vs.Motion(displacement=(aside, 0, way))
    clamps = [vs.Clamp(region=at(z=0)), vs.Clamp(region=at(z=c), motion=motion)]
    return Case(
        design(
            box((0, 0, 0), (a, b, c)),
            rubber(draw),
            clamps=clamps,
            loads=[],
            probes=probe(a // 2, b, c // 2),
        ),
        1,
    )


KINDS: dict[str, Callable[[Draw], Case]] = {
    "beam": beam,
    "twisted": twisted,
    "round chamber": round_chamber,
    "flat chamber": flat_chamber,
    "thin wall": thin_wall,
    "gyroid": gyroid,
    "two materials": two_materials,
    "contact": pressed_on,
    "large strain": strained,
}


def case(kind: str, number: int) -> Case:
    """A body, the same each time."""
    return KINDS[kind](np.random.default_rng([list(KINDS).index(kind), number]))


def number_of(result: Result, axis: int | None) -> float:
    """The number that is looked at."""
    if axis is None:
        return result.cavity_volumes[0] - float(result.mesh.cavities[0].volume)
    return float(result.probes["probe"][axis])


def bar_of(bars: ErrorBars, result: Result, axis: int | None) -> tuple[float, float]:
    """Its estimate and error."""
    if axis is None:
        bar = bars.metrics["cavity_volume_change"]
        return bar.estimate, bar.error
    found = bars.probes["probe"][axis]
    return found.estimate, found.error


def truth_of(each: Case, first: Result) -> tuple[float, float] | None:
    """The number on ever smaller voxels, and the last change; None where these do not solve."""
    values, sizes = [], []
    for part in (2, 4, 6, 8):
        if part**3 * len(first.mesh.tets) / 5 > MOST and len(values) > 1:
            break
        finer = each.design.with_values(f"voxel_size={H * 1e3 / part!r} mm")
        result = vs.simulate(finer)
        if result.status != "ok":
            break
        values.append(number_of(result, each.axis))
        sizes.append(1.0 / part)
    if len(values) < 2:
        return None
    found = discretization_error(sizes[-3:], values[-3:])
    return found.limit, abs(values[-1] - values[-2])


def main() -> None:
    """Run all bodies, and write the table."""
    table, group, *wanted = sys.argv[1:]
    with Path(table).open("w", newline="\n") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(HEAD)
        for kind in wanted or KINDS:
            ratios, held = [], 0
            for number in SETS[group]:
                each = case(kind, number)
                result = vs.simulate(each.design)
                bars = error_bars(result)
                if not bars.voxel_sizes:
                    print(kind, number, result.status, bars.sentence, flush=True)
                    continue
                value = number_of(result, each.axis)
                estimate, error = bar_of(bars, result, each.axis)
                found = truth_of(each, result)
                if found is None:
                    print(kind, number, "has no truth", flush=True)
                    continue
                truth, change = found
                inside = abs(truth - estimate) <= error + 0.2 * change
                held += inside
                row = (kind, number, bars.voxels[0], value, estimate, error, truth, change)
                rows.writerow((*row, int(inside), int(bars.regular)))
                file.flush()
                ratios.append(error / max(abs(value - truth), 1e-300))
                print(
                    kind,
                    number,
                    f"{value:.4g} {estimate:.4g} ± {error:.2g}, truth {truth:.4g}",
                    "held" if inside else "MISSED",
                    bars.regular,
                    flush=True,
                )
            if ratios:
                print(
                    f"{kind}: {held} of {len(ratios)} held; width over the run's error, median "
                    f"{np.median(ratios):.2g}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
