"""Nanoseconds for a voxel and substep: strips beside the textbook loop, one and two threads.

``python benchmarks/step_rate.py [--json]``. Compiles and runs the example `step_rate` of the
crate `voxsoft-xpbd`, which checks every answer before it counts and alternates the programs; a
ratio is how many times quicker than the textbook loop on one core. `docs/method/xpbd.md` has the
floor.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from measure import Report

COMMAND = "cargo run --quiet --release -p voxsoft-xpbd --example step_rate"


def main() -> None:
    """Run the example and show its figures."""
    report = Report("Nanoseconds for a voxel and substep")
    root = Path(__file__).parents[1]
    run = subprocess.run(COMMAND.split(), cwd=root, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise SystemExit(f"wrong answer or no compiler:\n{run.stderr}")
    for line in run.stdout.splitlines():
        body, what, threads, nanoseconds, ratio = line.split("; ")
        name = f"{body}: {what}, {threads} thread{'s' if threads != '1' else ''}"
        report.add(name, float(nanoseconds), "ns", float(ratio))
    report.show()


if __name__ == "__main__":
    main()
