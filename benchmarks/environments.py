"""Steps per second of simulators and environments under random commands.

``python benchmarks/environments.py [--json]``. Processor time of `vs.Simulator.step` at a control
period of 20 ms, by the median of the steps, each drive walking at random between rest and its value
in the design. A figure counts once a restored state goes on to the same bits. The ratio is that to
the target: 60 steps per second of a finger, 20 of the crawler.

Then the registered environments, each step 0.1 s, by processor time: all actions drawn evenly, from
-1 to 1, over the whole of 40 steps, whose dearest are many times dearer than the median. At last
eight crawlers by the wall clock, in one process, on two threads of one, and four in each of two
processes, the least of three runs of 15 steps; the ratio is that to the first. Anything else on the
machine spoils these three.
"""

from __future__ import annotations

import os

# One core, so that processor time is what a user waits; read when the core starts its threads.
os.environ["RAYON_NUM_THREADS"] = "1"

import multiprocessing
import statistics
import time
from pathlib import Path

import gymnasium
import numpy as np
from gymnasium.vector import SyncVectorEnv
from measure import Report
from walk import walk

import voxsoft as vs
from voxsoft.environments import ThreadVectorEnv
from voxsoft.environments.crawl import crawl

EXAMPLES = Path(__file__).parents[1] / "examples"
#: Steps before the first one that counts, and those that do.
WARM, STEPS = 5, 40
#: Steps of several environments at a time, and runs of them.
TOGETHER, RUNS = 15, 3


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
    times = []
    for commands in walk(simulator, WARM + STEPS):
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


def environment_rate(name: str) -> float:
    """Steps per second of a registered environment, all steps together."""
    env = gymnasium.make(f"VoxSoft/{name}-v0")
    env.action_space.seed(0)
    env.reset(seed=0)
    seconds = 0.0
    for _ in range(STEPS):
        action = env.action_space.sample()
        begun = time.process_time()
        *_, terminated, truncated, info = env.step(action)
        seconds += time.process_time() - begun
        if info["status"] == "diverged":
            raise SystemExit(f"wrong answer: {name} has diverged")
        if terminated or truncated:
            env.reset()
    return STEPS / seconds


def crawled(seeds: list[int], threads: int | None) -> float:
    """Seconds of the steps of crawlers by the wall clock, in turn or on threads."""
    os.environ["RAYON_NUM_THREADS"] = str(threads or 1)  # the core has no threads here yet
    makers = [crawl] * len(seeds)
    envs = SyncVectorEnv(makers) if threads is None else ThreadVectorEnv(makers, threads=threads)
    envs.reset(seed=seeds)
    actions = [np.random.default_rng(seed).uniform(-1, 1, (TOGETHER, 2)) for seed in seeds]
    begun = time.perf_counter()
    for step in range(TOGETHER):
        envs.step(np.array([each[step] for each in actions], dtype=np.float32))
    seconds = time.perf_counter() - begun
    envs.close()
    return seconds


def vector_seconds(*ways: tuple[list[int], int | None]) -> float:
    """Seconds of processes side by side: of the slower one, in the best run."""
    with multiprocessing.get_context("spawn").Pool(len(ways)) as pool:
        return min(max(pool.starmap(crawled, ways, chunksize=1)) for _ in range(RUNS))


def main() -> None:
    """Measure all robots."""
    report = Report("Steps per second of simulators at 20 ms and environments at 100 ms")
    robots = {
        "finger": (finger(touching=False), 60.0),
        "finger with a post": (finger(touching=True), 60.0),
        "crawler": (vs.load(EXAMPLES / "crawler.toml"), 20.0),
        "tendon finger": (vs.load(EXAMPLES / "tendon_finger.toml"), 60.0),
    }
    for name, (design, target) in robots.items():
        found, voxels = rate(design)
        report.add(f"{name}, {voxels:,} voxels", found, "1/s", found / target)
    for name in ("Reach", "Lift", "Crawl", "Peg", "PinchAndTurn"):
        report.add(f"VoxSoft/{name}-v0", environment_rate(name), "1/s")
    seeds = list(range(8))
    alone = vector_seconds((seeds, None))
    vectors = {
        "in turn": alone,
        "on two threads": vector_seconds((seeds, 2)),
        "in two processes": vector_seconds((seeds[:4], None), (seeds[4:], None)),
    }
    for name, seconds in vectors.items():
        rate_of_all = len(seeds) * TOGETHER / seconds
        report.add(f"eight crawlers {name}", rate_of_all, "1/s", alone / seconds)
    report.show()


if __name__ == "__main__":
    main()
