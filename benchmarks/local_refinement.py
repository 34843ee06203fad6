"""What local refinement gains: error, unknowns and time beside voxels of one size.

Each body is solved on large voxels, on small ones, and on both, against voxels smaller than all of them.

    python benchmarks/local_refinement.py [--json]
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

from measure import Report

import voxsoft as vs
from voxsoft.design import Refinement, families
from voxsoft.simulation import Setup
from voxsoft.units import kPa, mm

RUBBER = vs.NeoHookean(young=60 * kPa, poisson=0.49, density=1070.0)


@dataclass(frozen=True)
class Body:
    """A design, where it is refined, what is looked at, and how small voxels of its truth are."""

    name: str
    design: vs.Design
    refine: tuple[Refinement, ...]
    probe: str
    axis: int
    reference: int


def bodies() -> Iterator[Body]:
    """A root of a beam, a roof of a chamber in a block, and a wall around a ball."""
    beam = families.paper_beam().with_parameters(length=90 * mm, width=20 * mm, height=20 * mm)
    beam = beam.replace(
        parts=[vs.Part(shape="body", material=RUBBER)],
        probes={"tip": vs.Probe(x=(90 * mm, 90 * mm))},
        objectives={},
        constraints={},
    )
    root = (Refinement(region=vs.Region(x=(0, 20 * mm))),)
    yield Body("root of a beam", beam, root, "tip", 2, 4)
    block = vs.Design(
        name="roof",
        voxel_size=4 * mm,
        shapes={
            "block": {"kind": "box", "size": ["80 mm", "80 mm", "48 mm"], "corner": [0, 0, 0]},
            "room": {
                "kind": "box",
                "size": ["32 mm", "32 mm", "8 mm"],
                "corner": ["24 mm", "24 mm", "36 mm"],
            },
            "body": {"kind": "difference", "of": ["block", "room"]},
        },
        parts=[vs.Part(shape="body", material=RUBBER)],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Pressure(value=0.6 * kPa)],
        probes={"roof": vs.Probe(point=(40 * mm, 40 * mm, 48 * mm))},
    )
    roof = (
        Refinement(
            region=vs.Region(x=(18 * mm, 62 * mm), y=(18 * mm, 62 * mm), z=(40 * mm, 50 * mm))
        ),
    )
    yield Body("roof of a chamber", block, roof, "roof", 2, 3)


def main() -> None:
    """Solve all of them."""
    report = Report(__doc__ or "")
    for body in bodies():
        truth = solved(body, body.design, body.reference)[0]
        for name, design, refine in (
            ("large", body.design, 1),
            ("both", body.design.replace(refine=body.refine), 1),
            ("small", body.design, 2),
        ):
            moved, free, seconds = solved(body, design, refine)
            report.add(f"{body.name}, {name} voxels: error", 100 * (moved / truth - 1), "%")
            report.add(f"{body.name}, {name} voxels: free vertices", free, "")
            report.add(f"{body.name}, {name} voxels: time", seconds, "s")
    report.show()


def solved(body: Body, design: vs.Design, refine: int) -> tuple[float, int, float]:
    """How far the probe moves in m, how many vertices are free, and the seconds of the solution."""
    setup = Setup.of(design, refine=refine)
    tied = 0
    if design.refine:
        tied = int((setup.problem.masses == 0.0).sum())
    begin = time.perf_counter()
    result = vs.simulate(setup)
    seconds = time.perf_counter() - begin
    if result.status != "ok":
        raise SystemExit(f"wrong answer: {result.message}")
    moved = float(result.probes[body.probe][body.axis])
    return moved, len(setup.mesh.vertices) - tied, seconds


if __name__ == "__main__":
    main()
