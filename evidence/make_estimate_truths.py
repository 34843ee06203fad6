"""Bodies that the estimates of the discretization error never saw, and the truth of each.

``python evidence/make_estimate_truths.py TABLE [SET ...]``. Shapes, loads, materials and probes
of a set were fixed before any of it was solved, and so was the rule of
`voxsoft.comparison.richardson`: the first set was for the rule with a safety factor of 1.25 on two
sizes, the second for the one that replaced it. The truth is our own element on voxels split 2, 4
and 8 times (where 8 is too much, 2, 4 and 6), extrapolated with the order that they show; CalculiX
(C3D20R, voxels split 2 and 3 times) stands beside it as a code that shares no line past the nodes;
where their limits differ the truth is only known to lie between them.
Probes are points that every split has, since means over faces weigh vertices, of which finer
elements have others.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path
from typing import NamedTuple

import voxsoft as vs
from voxsoft.comparison.bricks import BrickModel
from voxsoft.errors import OutsideCodeError
from voxsoft.files.calculix import run_calculix
from voxsoft.shapes import Shape
from voxsoft.simulation import Setup, simulate
from voxsoft.units import kPa, mm

#: Cells that the finest of our own solutions may have, by set.
MOST_CELLS = {"first": 17_500, "second": 9_500}
OWN = (1, 2, 4, 6, 8)
OUTER = (2, 3)
HEAD = ("set", "body", "axis", "code", "split", "cells", "value_mm")


class Body(NamedTuple):
    """A design with one probe, and the axis of the displacement that is looked at."""

    design: vs.Design
    axis: str


NEARLY = vs.NeoHookean(young=30 * kPa, poisson=0.495)
LOOSE = vs.NeoHookean(young=150 * kPa, poisson=0.35)
MOONEY = vs.MooneyRivlin(c10=15 * kPa, c01=4 * kPa, poisson=0.48)
YEOH = vs.Yeoh(c=(18 * kPa, -0.5 * kPa, 0.3 * kPa), poisson=0.49)
OGDEN = vs.Ogden(mu=(35 * kPa, 5 * kPa), alpha=(2.5, -2.0), poisson=0.47)
STIFF = vs.NeoHookean(young=300 * kPa, poisson=0.45)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> vs.Box:
    """A box between two corners in mm."""
    size = tuple((b - a) * mm for a, b in zip(low, high, strict=True))
    return vs.Box(size=size, corner=tuple(a * mm for a in low))


def at(**planes: float | tuple[float, float]) -> vs.Region:
    """A region of planes, or of ranges, in mm."""
    ranges = {k: v if isinstance(v, tuple) else (v, v) for k, v in planes.items()}
    return vs.Region(**{axis: (a * mm, b * mm) for axis, (a, b) in ranges.items()})


def body(
    shape: Shape,
    material: object,
    point: tuple[float, float, float],
    axis: str,
    *,
    clamps: list[vs.Clamp],
    loads: list[object] = [],  # noqa: B006
    voxel: float = 5.0,
    over: tuple[Shape, object] | None = None,
) -> Body:
    """A body of one material, or of two of which the second, `over`, wins; lengths in mm."""
    parts = [vs.Part(shape=shape, material=material)]
    if over is not None:
        parts.insert(0, vs.Part(shape=over[0], material=over[1]))
    design = vs.Design(
        name="body",
        voxel_size=voxel * mm,
        parts=parts,
        clamps=clamps,
        loads=loads,
        probes={"probe": vs.Probe(point=tuple(each * mm for each in point))},
    )
    return Body(design, axis)


def first() -> dict[str, Body]:
    """Twelve bodies."""
    foot = [vs.Clamp(region=at(z=0))]
    wall = [vs.Clamp(region=at(x=0))]
    weight = [vs.Gravity()]
    twist = vs.Motion(
        rotation=vs.Rotation(axis=(1, 0, 0), angle="50 deg", center=(0, 5 * mm, 5 * mm))
    )
    return {
        "bent in plan": body(
            box((0, 0, 0), (25, 10, 10)) | box((15, 10, 0), (25, 25, 10)),
            YEOH,
            (25, 25, 5),
            "z",
            clamps=wall,
            loads=weight,
        ),
        "portal": body(
            box((0, 0, 0), (30, 10, 25)) - box((10, 0, 0), (20, 10, 15)),
            MOONEY,
            (30, 5, 25),
            "x",
            clamps=foot,
            loads=[vs.Traction(region=at(x=0), value=(1.5 * kPa, 0, 0))],
        ),
        "flat chamber": body(
            box((0, 0, 0), (30, 20, 15)) - box((5, 5, 5), (25, 15, 10)),
            NEARLY,
            (15, 10, 15),
            "z",
            clamps=wall,
            loads=[vs.Pressure(value=1.5 * kPa)],
        ),
        "stepped": body(
            box((0, 0, 0), (12, 12, 16))
            | box((12, 0, 4), (24, 12, 16))
            | box((24, 0, 8), (36, 12, 16)),
            LOOSE,
            (36, 4, 12),
            "z",
            clamps=wall,
            loads=[vs.Force(region=at(x=36), value=(0, 0, "-60 mN"))],
            voxel=4.0,
        ),
        "tee": body(
            box((10, 0, 0), (20, 10, 20)) | box((0, 0, 20), (30, 10, 30)),
            OGDEN,
            (30, 0, 30),
            "z",
            clamps=foot,
            loads=[vs.Force(region=at(x=30), value=(0, 0, "-80 mN"))],
        ),
        "twisted": body(
            box((0, 0, 0), (30, 10, 10)),
            NEARLY,
            (15, 10, 10),
            "y",
            clamps=[*wall, vs.Clamp(region=at(x=30), motion=twist)],
        ),
        "squeezed": body(
            box((0, 0, 0), (20, 20, 15)),
            MOONEY,
            (20, 10, 10),
            "x",
            clamps=[
                *foot,
                vs.Clamp(region=at(z=15), motion=vs.Motion(displacement=(0, 0, -3 * mm))),
            ],
        ),
        "plate": body(
            box((0, 0, 0), (30, 30, 5)),
            YEOH,
            (15, 15, 5),
            "z",
            clamps=[
                vs.Clamp(region=at(x=0)),
                vs.Clamp(region=at(x=30)),
                vs.Clamp(region=at(y=0)),
                vs.Clamp(region=at(y=30)),
            ],
            loads=[vs.Traction(region=at(z=0), value=0.6 * kPa)],
        ),
        "stiff skin": body(
            box((0, 0, 0), (32, 8, 12)),
            NEARLY,
            (32, 4, 4),
            "z",
            clamps=wall,
            loads=[vs.Gravity(direction=(0, 0, 1))],
            voxel=4.0,
            over=(box((0, 0, 8), (32, 8, 12)), STIFF),
        ),
        "pierced": body(
            box((0, 0, 0), (50, 20, 30)) - box((20, 0, 10), (40, 20, 20)),
            OGDEN,
            (50, 10, 20),
            "z",
            clamps=wall,
            loads=weight,
            voxel=10.0,
        ),
        "bridge": body(
            box((0, 0, 0), (40, 10, 10)),
            LOOSE,
            (20, 5, 0),
            "z",
            clamps=[*wall, vs.Clamp(region=at(x=40))],
            loads=[vs.Traction(region=at(z=10, x=(10, 30)), value=3 * kPa)],
        ),
        "lopsided chamber": body(
            box((0, 0, 0), (20, 15, 30)) - box((5, 5, 5), (10, 10, 25)),
            YEOH,
            (20, 5, 30),
            "x",
            clamps=foot,
            loads=[vs.Pressure(value=8 * kPa)],
        ),
    }


def second() -> dict[str, Body]:
    """Ten smaller bodies."""
    foot = [vs.Clamp(region=at(z=0))]
    wall = [vs.Clamp(region=at(x=0))]
    weight = [vs.Gravity()]
    aside = vs.Motion(displacement=(4 * mm, 0, 0))
    return {
        "hook": body(
            box((0, 0, 0), (10, 10, 30)) | box((10, 0, 20), (25, 10, 30)),
            YEOH,
            (25, 5, 20),
            "z",
            clamps=foot,
            loads=[vs.Force(region=at(x=25), value=(0, 0, "-50 mN"))],
        ),
        "fin": body(
            box((0, 0, 0), (30, 5, 20)),
            LOOSE,
            (30, 5, 20),
            "y",
            clamps=wall,
            loads=[vs.Traction(region=at(y=0), value=0.1 * kPa)],
        ),
        "ring": body(
            box((0, 0, 0), (20, 10, 20)) - box((5, 0, 5), (15, 10, 15)),
            NEARLY,
            (10, 5, 20),
            "z",
            clamps=foot,
            loads=[vs.Force(region=at(z=20), value=(0, 0, "-40 mN"))],
        ),
        "sheared": body(
            box((0, 0, 0), (15, 15, 10)),
            OGDEN,
            (15, 5, 5),
            "z",
            clamps=[*foot, vs.Clamp(region=at(z=10), motion=aside)],
        ),
        "cube chamber": body(
            box((0, 0, 0), (15, 15, 15)) - box((5, 5, 5), (10, 10, 10)),
            MOONEY,
            (5, 5, 15),
            "z",
            clamps=foot,
            loads=[vs.Pressure(value=6 * kPa)],
        ),
        "side by side": body(
            box((0, 0, 0), (25, 10, 10)),
            NEARLY,
            (25, 0, 10),
            "z",
            clamps=wall,
            loads=weight,
            over=(box((0, 0, 0), (25, 5, 10)), LOOSE),
        ),
        "propped": body(
            box((0, 0, 0), (30, 10, 10)),
            MOONEY,
            (15, 5, 5),
            "z",
            clamps=[*wall, vs.Clamp(region=at(x=30), axes="z")],
            loads=[vs.Traction(region=at(z=10), value=1 * kPa)],
        ),
        "post": body(
            box((0, 0, 0), (20, 20, 5)) | box((5, 5, 5), (15, 15, 25)),
            YEOH,
            (15, 10, 25),
            "x",
            clamps=foot,
            loads=[vs.Traction(region=at(x=5, z=(15, 25)), value=(2 * kPa, 0, 0))],
        ),
        "hung": body(
            box((0, 0, 0), (10, 10, 40)),
            OGDEN,
            (5, 5, 0),
            "z",
            clamps=[vs.Clamp(region=at(z=40))],
            loads=[vs.Gravity(value=50.0)],
        ),
        "long chamber": body(
            box((0, 0, 0), (25, 15, 15)) - box((5, 5, 5), (20, 10, 10)),
            NEARLY,
            (25, 5, 5),
            "x",
            clamps=wall,
            loads=[vs.Pressure(value=2 * kPa)],
        ),
    }


SETS = {"first": first, "second": second}


def solved(group: str, name: str, each: Body) -> list[tuple[object, ...]]:
    """Rows of the table of one body."""
    setup = Setup.of(each.design)
    rows: list[tuple[object, ...]] = []
    number = "xyz".index(each.axis)
    voxels = len(setup.mesh.tets) // 5
    splits = [split for split in OWN if voxels * split**3 <= MOST_CELLS[group]]
    # Of 4, 6 and 8 the two finest; the others would only repeat them.
    splits = [split for split in splits if split < 6 or split == splits[-1]]
    for split in splits:
        result = simulate(Setup.of(each.design, refine=split), method="statics")
        print(name, split, result.status, f"{result.seconds:.1f} s", flush=True)
        if result.status == "ok":
            value = result.probes["probe"][number] / mm
            rows.append(
                (group, name, each.axis, "voxsoft", split, voxels * split**3, f"{value:.8g}")
            )
    vertex = setup.places["probe"].vertices
    for split in OUTER:
        try:
            answer = run_calculix(BrickModel.of(setup, split=split, nodes=20), time_limit=300)
        except OutsideCodeError as error:
            print(name, split, error, flush=True)
            continue
        print(name, "CalculiX", split, answer.status, f"{answer.seconds:.1f} s", flush=True)
        if answer.status == "ok":
            value = float(setup.places["probe"].weights @ answer.displacements[vertex, number]) / mm
            rows.append(
                (group, name, each.axis, "CalculiX", split, voxels * split**3, f"{value:.8g}")
            )
    return rows


def main() -> None:
    """Solve all bodies and write the table."""
    table, *wanted = sys.argv[1:]
    rows = [
        row
        for group in wanted or SETS
        for name, each in SETS[group]().items()
        for row in solved(group, name, each)
    ]
    with Path(table).open("w", newline="\n") as file:
        csv.writer(file, lineterminator="\n").writerows([HEAD, *rows])


if __name__ == "__main__":
    main()
