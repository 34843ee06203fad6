"""Step and frame of a live run: 2,000 and 20,000 voxels, the native core and that of the page.

``python benchmarks/live.py [--json]``. A cube that stands on its foot sags under its weight. Both
cores take the same substeps in turn, five times; the page's must reach the same bits as the native
one's deterministic way before its time counts. Ratios are against the native core on all its
threads. The page's core runs in Node, where there is one.
"""

from __future__ import annotations

import json
import shutil
import statistics
import subprocess
import tempfile
import time
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


def main() -> None:
    """Time both cores on both bodies."""
    report = Report("Step and frame of a live run")
    for across, substeps in ((13, 400), (27, 60)):
        measure(report, across, substeps)
    report.show()


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
