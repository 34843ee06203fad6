"""Steps per second of simulators under random commands, on one core.

``python benchmarks/environments.py [--json]``. Processor time of `vs.Simulator.step` at a control
period of 20 ms, by the median of the steps, each drive walking at random between rest and its value
in the design. A figure counts once a restored state goes on to the same bits. The ratio is that to
the target: 60 steps per second of a finger, 20 of the crawler.
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when the core starts its threads.
os.environ["RAYON_NUM_THREADS"] = "1"

import statistics
import time
from pathlib import Path

import numpy as np
from measure import Report

import voxsoft as vs

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Steps before the first one that counts, and those that do.
WARM, STEPS = 5, 40
#: Largest change of a command in a step, of the way to its value in the design.
STRIDE = 0.05


def finger(*, touching: bool) -> vs.Design:
    """A finger of 600 voxels with one chamber behind a valve, and a post that it bends onto."""
    wall = vs.Box(size=("72 mm", "15 mm", "18 mm")) - vs.Box(
        size=("63 mm", "9 mm", "6 mm"), corner=("3 mm", "3 mm", "9 mm")
    )
    post = vs.Box(size=("12 mm", "24 mm", "6 mm"), corner=("60 mm", "-4.5 mm", "-7 mm"))
    rubber = vs.NeoHookean(young="100 kPa", poisson=0.45, density=1070.0)
    return vs.Design.model_validate(
        {
            "name": "finger",
            "voxel_size": "3 mm",
            "parts": [vs.Part(shape=wall, material=rubber)],
            "clamps": [vs.Clamp(region=vs.Region(x=(0, 0)))],
            "chambers": {"air": {"point": ("30 mm", "7.5 mm", "12 mm")}},
            "supplies": [
                {
                    "kind": "flow",
                    "chamber": "air",
                    "source": "15 kPa",
                    "valve": {"conductance": "0.002 L/s/bar"},
                    "leak": {"conductance": "0.001 L/s/bar"},
                }
            ],
            "objects": [{"name": "post", "shape": post}] if touching else [],
            "probes": {"tip": {"x": ("72 mm", "72 mm")}},
        }
    )


def rate(design: vs.Design) -> tuple[float, int]:
    """Steps per second, and voxels."""
    simulator = vs.Simulator(design)
    generator, shares = np.random.default_rng(0), dict.fromkeys(simulator.commands, 0.0)
    times = []
    for _ in range(WARM + STEPS):
        commands = {}
        for name, command in simulator.commands.items():
            if command.kind == "acceleration":
                continue
            walked = shares[name] + generator.uniform(-STRIDE / 2, STRIDE)
            shares[name] = float(np.clip(walked, 0.0, 1.0))
            first, last = np.asarray(command.first), np.asarray(command.design)
            value = first + shares[name] * (last - first)
            commands[name] = tuple(value.tolist()) if command.shape else float(value)
        saved = simulator.state
        begun = time.process_time()
        seen = simulator.step(commands)
        times.append(time.process_time() - begun)
        if seen.status == "diverged":
            raise SystemExit(f"wrong answer: {seen.message}")
    simulator.restore(saved)
    if simulator.step(commands).positions.tobytes() != seen.positions.tobytes():
        raise SystemExit("wrong answer: other bits from a restored state")
    return 1.0 / statistics.median(times[WARM:]), len(seen.result.mesh.tets) // 5


def main() -> None:
    """Measure all robots."""
    report = Report("Steps per second of a simulator at 20 ms, one core")
    robots = {
        "finger": (finger(touching=False), 60.0),
        "finger with a post": (finger(touching=True), 60.0),
        "crawler": (vs.load(EXAMPLES / "crawler.toml"), 20.0),
        "tendon finger": (vs.load(EXAMPLES / "tendon_finger.toml"), 60.0),
    }
    for name, (design, target) in robots.items():
        found, voxels = rate(design)
        report.add(f"{name}, {voxels:,} voxels", found, "1/s", found / target)
    report.show()


if __name__ == "__main__":
    main()
