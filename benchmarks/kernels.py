"""Kernels of iterative solutions beside the memory's speed: bytes per second and STREAM's triad.

``python benchmarks/kernels.py [--json] [--across N]``. It needs cargo, and compiles a test of
`crates/statics` (`linear/bandwidth.rs`) that measures the tangent of a rubber cube of N voxels
along each edge: the product of conjugate gradients, the sums of both halves of all rows that a
sweep takes, a whole V-cycle, an assembly, the coarser matrices, and the triad in the same
process. Each is the quickest of 15 runs, on all threads, or on as many as RAYON_NUM_THREADS says.
The ratio is that to the triad.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from measure import Report

#: Root of the repository.
ROOT = Path(__file__).parents[1]
#: The test that measures, and prints a name, seconds and bytes per second in columns.
TEST = "linear::bandwidth::speeds_of_kernels"
#: Kernels whose work is reading the matrix: the others compute too.
READING = ("product", "halves of all rows", "V-cycle")


def measured(across: int) -> dict[str, tuple[float, float]]:
    """Seconds and bytes per second of each kernel, and of the triad."""
    command = ["cargo", "test", "--release", "--quiet", "--package", "voxsoft-statics", "--lib"]
    command += [TEST, "--", "--exact", "--ignored", "--nocapture"]
    environment = {**os.environ, "VOXSOFT_ACROSS": str(across)}
    done = subprocess.run(
        command, cwd=ROOT, env=environment, check=True, stdout=subprocess.PIPE, text=True
    )
    rows = (line.split("\t") for line in done.stdout.splitlines())
    return {row[0]: (float(row[1]), float(row[2])) for row in rows if len(row) == 3}


def main() -> None:
    """Measure all kernels."""
    report = Report(
        "Kernels of iterative solutions beside STREAM's triad",
        values={"across": (46, "voxels along an edge of the cube")},
    )
    across = report.options["across"]
    figures = measured(across)
    triad = figures.pop("triad")[1]
    report.add("STREAM triad", triad / 1e9, "GB/s")
    for name, (seconds, speed) in figures.items():
        report.add(f"{name}, {across}³ voxels", 1e3 * seconds, "ms")
        if name in READING:
            report.add(f"{name}, {across}³ voxels", speed / 1e9, "GB/s", speed / triad)
    report.show()


if __name__ == "__main__":
    main()
