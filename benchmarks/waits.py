"""Waits that are not physics: short commands beside an import of NumPy.

``python benchmarks/waits.py [--json] [--rounds N]``. Each command is a process of its own, as in a
shell, in turn with ``python -c "import numpy"``; times are medians by the wall clock, and the ratio
is the median of those of each round's pair. Nothing is kept from one round to the next but what the
system keeps of files.

The rod is a round body of about 300 cut voxels, with its error bar and without.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from measure import Report

import voxsoft as vs
from voxsoft.units import mm

ROOT = Path(__file__).parents[1]
BEAMS = ROOT / "examples/data/paper_beams"
NUMPY = ("-c", "import numpy")


def rod() -> vs.Design:
    """A round cantilever under its weight."""
    body = vs.Cylinder(radius=10 * mm, height=60 * mm)
    return vs.Design(
        name="rod",
        voxel_size=4 * mm,
        parts=[vs.Part(shape=body, material="ecoflex-00-30")],
        clamps=[vs.Clamp(region=vs.Region(z=(0, 0)))],
        loads=[vs.Gravity(direction=(1, 0, 0))],
    )


def commands(file: str, folder: str) -> dict[str, Sequence[str]]:
    """Arguments of Python for each command."""
    voxsoft = ("-m", "voxsoft")
    run, out = (*voxsoft, "run", file), ("--out", f"{folder}/out")
    beam, marks = str(ROOT / "examples/beam.toml"), str(BEAMS / "ecoflex-00-30.csv")
    return {
        "check": (*voxsoft, "check", file),
        "run, without an error bar": (*run, "--error", "off", *out),
        "run": (*run, *out),
        "sweep of the paper's 105": (*voxsoft, "sweep", str(ROOT / "examples/cylinder.toml"), *out),
        "calibrate": (*voxsoft, "calibrate", beam, marks, *out),
    }


def seconds(arguments: Sequence[str], path: str) -> float:
    """Wall time of a process of Python, with a folder of packages before all others."""
    environment = {**os.environ, "PYTHONPATH": path}
    # Bytecode is kept as in a shell of anyone's; the round that is left out writes it.
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    started = time.perf_counter()
    done = subprocess.run(
        [sys.executable, *arguments], env=environment, capture_output=True, text=True, check=False
    )
    passed = time.perf_counter() - started
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(arguments)}: {done.stdout}{done.stderr}")
    return passed


def main() -> None:
    """Time all commands and print them."""
    report = Report(
        "Waits that are not physics",
        {"rounds": (5, "pairs of each command")},
    )
    rounds = int(report.options["rounds"])
    path = str(ROOT / "python")
    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/rod.toml"
        rod().save(file)
        for name in commands(file, folder):
            pairs = []
            for number in range(rounds + 1):
                # Each round has a folder of its own, so that nothing is resumed.
                own = commands(file, f"{folder}/{number}-{len(report.rows)}")[name]
                pair = seconds(NUMPY, path), seconds(own, path)
                pairs += [pair] if number else []  # the first warms the system's files up
            numpy, command = (statistics.median(column) for column in zip(*pairs, strict=True))
            ratio = statistics.median(b / a for a, b in pairs)
            report.add(f"import of NumPy, beside {name}", numpy, "s")
            report.add(name, command, "s", ratio)
    report.show()


if __name__ == "__main__":
    main()
