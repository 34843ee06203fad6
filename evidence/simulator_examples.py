"""All examples in a simulator for a hundred steps of random commands.

``python evidence/simulator_examples.py [--json] [--steps 100] [--only NAME]``. Every drive walks at
random between rest and its value in the design. The state after half of the steps is saved, and the
second half is repeated from it, by a process with one thread and by one with two: rows are the mean
processor time of a step on one thread, and 1 where all positions and velocities have the same bits
in the end, 0 otherwise. The walk ends where a body diverges, which is told.
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from measure import Report
from walk import walk

import voxsoft as vs

EXAMPLES = Path(__file__).parents[1] / "examples"


def bits(seen: Any) -> str:
    """Return the digest of a state."""
    return hashlib.sha256(seen.positions.tobytes() + seen.velocities.tobytes()).hexdigest()


def run(name: str, steps: int) -> dict[str, Any]:
    """Walk, go back to the middle, and walk on again."""
    simulator = vs.Simulator(vs.load(EXAMPLES / f"{name}.toml"))
    given, begun, taken = walk(simulator, steps), time.process_time(), 0
    saved = simulator.state
    for index, commands in enumerate(given):
        if index == steps // 2:
            saved = simulator.state
        if simulator.state.status == "diverged":
            break
        simulator.step(commands)
        taken += 1
    seconds = (time.process_time() - begun) / taken
    last = simulator.state
    simulator.restore(saved)
    for commands in given[saved.steps : taken]:
        simulator.step(commands)
    return {
        "seconds": seconds,
        "steps": taken,
        "status": last.status,
        "bits": bits(last),
        "again": bits(simulator.state),
    }


def main() -> None:
    """Run every example in two processes, with one thread and with two."""
    if sys.argv[1:2] == ["--one"]:
        print(json.dumps(run(sys.argv[2], int(sys.argv[3]))))
        return
    values = {"steps": (100, "steps of each walk")}
    report = Report("Examples in a simulator", values=values, texts={"only": "one example"})
    steps, only = int(report.options["steps"]), report.options["only"]
    for name in [only] if only else sorted(path.stem for path in EXAMPLES.glob("*.toml")):
        outcomes = []
        for threads in ("1", "2"):
            command = [sys.executable, __file__, "--one", name, str(steps)]
            environment = {**os.environ, "RAYON_NUM_THREADS": threads}
            done = subprocess.run(command, env=environment, capture_output=True, text=True)
            if done.returncode:
                raise SystemExit(f"{name}: {done.stderr[-500:]}")
            outcomes.append(json.loads(done.stdout))
        same = {each[key] for each in outcomes for key in ("bits", "again")}
        note = (
            "" if outcomes[0]["status"] != "diverged" else f", diverged at {outcomes[0]['steps']}"
        )
        report.add(f"{name}{note}: a step", outcomes[0]["seconds"], "s")
        report.add(f"{name}: same bits", float(len(same) == 1), "")
    report.show()


if __name__ == "__main__":
    main()
