"""Step and frame of a live run: 2,000 and 20,000 voxels, the native core and that of the page.

``python benchmarks/live.py [--json] [--rubber] [--largest]``. A cube that stands on its foot sags
under its weight. Both cores take the same substeps in turn, five times; the page's must reach the
same bits as the native one's deterministic way before its time counts. Ratios are against the
native core on all its threads. The page's core runs in Node, where there is one.

Cubes of rubber of 216 to 10,648 voxels then take steps of 1/60 s, while a hand drags a corner of
the top to and fro. Ratios of their rows are those of the time per voxel to that of the cube of
1,000. With ``--rubber`` only these are timed; with ``--largest`` also one of 97,336 voxels.
"""

from __future__ import annotations

import json
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from bodies import MATERIALS, block
from measure import Report

from voxsoft import _core
from voxsoft.simulation import Setup

ROOT = Path(__file__).parents[1]
CORE = ROOT / "studio" / "public" / "voxsoft.wasm"
RUNNER = ROOT / "tests" / "crosscheck" / "wasm_run.mjs"
REPEATS = 5
STRESS = 5
#: Voxels along an edge of the cubes of rubber, the one that ratios refer to, and the largest.
RUBBER = (6, 10, 13, 17, 22)
REFERENCE = 10
LARGEST = 46
#: Steps of each, the first of which are those of a sudden load, before the hand comes.
RUBBER_STEPS = 40
SUDDEN = 5
#: Stiffness of the hand in N/m, and how far it goes as a part of an edge.
HAND = 30.0
REACH = 0.3


def main() -> None:
    """Time both cores on both bodies."""
    report = Report(
        "Step and frame of a live run",
        rubber="only the cubes of rubber",
        largest="also a cube of rubber of 97,336 voxels",
    )
    if not report.options["rubber"]:
        for across, substeps in ((13, 400), (27, 60)):
            measure(report, across, substeps)
    rubber(report, (*RUBBER, LARGEST) if report.options["largest"] else RUBBER)
    report.show()


def rubber(report: Report, sizes: Sequence[int]) -> None:
    """Implicit steps of cubes, by the wall clock and by the processor's time of all threads."""
    times = {across: rubber_steps(across) for across in sizes}
    for kind, clock in (("", 0), (", processor", 1)):
        reference = statistics.mean(step[clock] for step in times[REFERENCE]) / REFERENCE**3
        for across, steps in times.items():
            own = [step[clock] for step in steps]
            body = f"rubber, {across**3:,} voxels: step{kind}"
            mean = statistics.mean(own)
            report.add(f"{body}, mean", 1e3 * mean, "ms", mean / across**3 / reference)
            report.add(f"{body}, median", 1e3 * statistics.median(own), "ms")
            report.add(f"{body}, longest", 1e3 * max(own), "ms")


def rubber_steps(across: int) -> list[tuple[float, float]]:
    """Time of each step of a cube by both clocks in s, after it was found sound."""
    setup = Setup.of(block(MATERIALS["neo-Hookean"], across))
    rest = setup.mesh.vertices
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    live = _core.Live(setup.problem, triangles, tags, setup.design.voxel_size, tolerance=1e-30)
    corner = len(rest) - 1
    reach = REACH * rest[corner, 2] * np.array([1.0, 0.7, 0.7])
    times = []
    for number in range(RUBBER_STEPS):
        if number >= SUDDEN:
            swing = np.sin(number / np.array([6.0, 4.0, 9.0]))
            live.grab(1, corner, list(rest[corner] + reach * swing), HAND)
        began, busy = time.perf_counter(), time.process_time()
        look = live.advance(1)
        times.append((time.perf_counter() - began, time.process_time() - busy))
        if look.taken != 1 or look.back_offs:
            raise SystemExit(f"{across**3:,} voxels of rubber: a step failed")
    measured = _core.Fields(setup.problem).measure(live.positions())
    if not (measured["volume_ratio"] > 0).all():
        raise SystemExit(f"{across**3:,} voxels of rubber: some are inside out")
    return times


def measure(report: Report, across: int, substeps: int) -> None:
    """One cube of so many voxels along an edge."""
    setup = Setup.of(block(MATERIALS["lattice"], across))
    triangles = setup.mesh.triangles.astype(np.uint32)
    tags = np.zeros(len(triangles), np.uint8)
    shown = (setup.problem, triangles, tags, setup.design.voxel_size)
    body = f"{across**3:,} voxels"

    def native(*, deterministic: bool) -> tuple[_core.Live, float]:
        live = _core.Live(*shown, tolerance=1e-30, deterministic=deterministic)
        started = time.perf_counter()
        look = live.advance(substeps)
        taken = time.perf_counter() - started
        if look.taken != substeps or look.back_offs:
            raise SystemExit(f"{body}: the run broke off after {look.taken} substeps")
        return live, taken / substeps

    ways: dict[str, list[float]] = {"native": [], "native, deterministic": [], "page": []}
    page_frames = []
    for _ in range(REPEATS):
        quick, seconds = native(deterministic=False)
        ways["native"].append(seconds)
        plain, seconds = native(deterministic=True)
        ways["native, deterministic"].append(seconds)
        check_alike(body, setup, quick.positions(), plain.positions())
        if shutil.which("node") is not None:
            seconds, frame_seconds = page(body, shown, substeps, plain.positions())
            ways["page"].append(seconds)
            page_frames.append(frame_seconds)
    first = statistics.median(ways["native"])
    for way, times in ways.items():
        if times:
            median = statistics.median(times)
            report.add(f"{body}: substep, {way}", 1e3 * median, "ms", median / first)
    report.add(f"{body}: substep of the run", 1e3 * quick.substep, "ms")
    frame_times(report, body, quick)
    if page_frames:
        report.add(f"{body}: frame, page", 1e3 * statistics.median(page_frames), "ms")


def check_alike(body: str, setup: Setup, quick: np.ndarray, plain: np.ndarray) -> None:
    """Both native ways differ by rounding alone."""
    moved = np.abs(plain - setup.mesh.vertices).max()
    if not moved > 0 or np.abs(quick - plain).max() > 1e-9 * moved:
        raise SystemExit(f"{body}: the deterministic way comes to other positions")


def page(
    body: str,
    shown: tuple[_core.Problem, np.ndarray, np.ndarray, float],
    substeps: int,
    expected: np.ndarray,
) -> tuple[float, float]:
    """Seconds of a substep and of a frame in Node, after its positions were compared."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene = _core.Scene(*shown, tolerance=1e-30)
        (folder / "scene").write_bytes(scene.pack('[{"t": "pace", "factor": 1}, {"t": "play"}]'))
        seconds = substeps * _core.Live(*shown).substep
        command = ["node", RUNNER, CORE, folder / "scene", folder / "positions", str(seconds)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        if not (np.fromfile(folder / "positions").reshape(expected.shape) == expected).all():
            raise SystemExit(f"{body}: the page's core comes to other bits")
        answer = json.loads(done.stdout)
    return 1e-3 * answer["advance_ms"] / substeps, 1e-3 * answer["frame_ms"]


def frame_times(report: Report, body: str, live: _core.Live) -> None:
    """A frame of displacements, and one of stresses, which are found for it."""
    for name, field in (("displacement", 0), ("stress", STRESS)):
        times = []
        for number in range(20):
            started = time.perf_counter()
            frame = live.pack_frame(1, number, field)
            times.append(time.perf_counter() - started)
        report.add(f"{body}: frame of {name}", 1e3 * statistics.median(times), "ms")
    report.add(f"{body}: bytes of a frame", len(frame), "B")
    report.add(f"{body}: bytes of the topology", len(live.pack_topology(1)), "B")


if __name__ == "__main__":
    main()
