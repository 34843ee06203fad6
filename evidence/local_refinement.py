"""What local refinement gains: error, unknowns and time beside voxels of one size.

Each body is solved on large voxels, on small ones, and on both: where a person would have them
small, and where the estimated error is. Errors are against voxels smaller than all of these.

    python evidence/local_refinement.py [--json]
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import voxsoft as vs
from voxsoft.comparison import refined
from voxsoft.design import Refinement, families
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)
#: Of the block around a chamber.
SIDE = 80 * mm


@dataclass(frozen=True)
class Body:
    """A design, where it is refined, what is looked at, and into how many its truth is cut."""

    name: str
    design: vs.Design
    refine: Refinement
    number: Callable[[vs.Result], float]
    truth: int


def bodies() -> Iterator[Body]:
    """The root of a beam, the thin roof of a chamber in a block, a ball in a block, a finger."""
    beam = families.paper_beam().with_parameters(length=90 * mm, width=20 * mm, height=20 * mm)
    beam = beam.replace(
        parts=[vs.Part(shape="body", material=RUBBER)],
        probes={"tip": vs.Probe(x=(90 * mm, 90 * mm))},
        objectives={},
        constraints={},
    )
    root = Refinement(region=vs.Region(x=(0, 20 * mm)))
    yield Body("root of a beam", beam, root, lambda result: result.probes["tip"][2], 4)
    room = {
        "kind": "box",
        "size": ["32 mm", "32 mm", "8 mm"],
        "corner": ["24 mm", "24 mm", "28 mm"],
    }
    near = vs.Region(x=(20 * mm, 60 * mm), y=(20 * mm, 60 * mm), z=(28 * mm, 50 * mm))
    thin = around(
        room, "40 mm", 3 * kPa, probes={"roof": vs.Probe(point=(SIDE / 2, SIDE / 2, 0.04))}
    )
    yield Body("roof", thin, Refinement(region=near), lambda result: result.probes["roof"][2], 3)
    middle = (SIDE / 2, SIDE / 2, SIDE / 2)
    ball = around(
        {"kind": "sphere", "radius": "12 mm", "center": middle}, SIDE, 10 * kPa, fill="fraction"
    )
    shell = Refinement(region=vs.Region(center=middle, radius=16 * mm))
    yield Body("ball in a block", ball, shell, growth, 3)
    finger = families.pneunet()
    lower = Refinement(region=vs.Region(z=(0, 12.5 * mm)))
    yield Body("finger", finger, lower, lambda result: result.probes["tip"][2], 3)


def around(
    room: dict[str, object], height: float | str, pressure: float, **changes: object
) -> vs.Design:
    """A block on its foot, with a room under pressure."""
    return vs.Design(
        name="block",
        voxel_size=4 * mm,
        shapes={
            "block": {"kind": "box", "size": [SIDE, SIDE, height], "corner": [0, 0, 0]},
            "room": room,
            "body": {"kind": "difference", "of": ["block", "room"]},
        },
        parts=[vs.Part(shape="body", material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=pressure)],
        **changes,
    )


def growth(result: vs.Result) -> float:
    """Of the first cavity, in m³."""
    return float(result.cavity_volumes[0] - result.mesh.cavities[0].volume)


def main() -> None:
    """Solve all of them."""
    report = Report(__doc__ or "")
    for body in bodies():
        truth = solved(body, body.design, body.truth)[0]
        coarse = vs.simulate(body.design)
        for name, design, refine in (
            ("large", body.design, 1),
            ("both", body.design.replace(refine=[body.refine]), 1),
            ("found", refined(coarse), 1),
            ("small", body.design, 2),
        ):
            number, free, seconds = solved(body, design, refine)
            report.add(f"{body.name}, {name} voxels: error", 100 * (number / truth - 1), "%")
            report.add(f"{body.name}, {name} voxels: free vertices", free, "")
            report.add(f"{body.name}, {name} voxels: time", seconds, "s")
    report.show()


def solved(body: Body, design: vs.Design, refine: int) -> tuple[float, int, float]:
    """What is looked at, how many vertices are free, and the seconds of the solution."""
    setup = Setup.of(design, refine=refine)
    # What is tied has no mass of its own.
    free = int((setup.problem.masses > 0.0).sum())
    begin = time.perf_counter()
    result = vs.simulate(setup)
    seconds = time.perf_counter() - begin
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {result.message}")
    return body.number(result), free, seconds


if __name__ == "__main__":
    main()
