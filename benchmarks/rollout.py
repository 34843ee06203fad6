"""Price of the derivatives of a motion: a hundred steps by twenty knots, with contact.

``python benchmarks/rollout.py [--json]``. The crawler of the environments walks by two drives of
ten knots each, with and without derivatives in turn, three times; medians of the processor's time.
The derivative of its way by each knot is held against central differences of whole motions by
three distances: the row is the median over knots of the least of the three errors, relative to the
largest slope, for the motion itself jumps within the tolerance of contact.
"""

from __future__ import annotations

import statistics
import time

import numpy as np
from measure import Report

import voxsoft as vs
from voxsoft.environments.robots import robot

STEPS, KNOTS, REPEATS = 100, 10, 3
DRIVES = ("rear", "front")
PROBE = "front"
#: Distances of the differences, as a part of the largest swelling.
DISTANCES = (1e-4, 1e-5, 1e-6)
LARGEST = 0.6


def gait() -> dict[str, np.ndarray]:
    """Waves of both drives, a quarter of a wave apart."""
    phase = 2.0 * np.pi / 5.0 * np.arange(KNOTS)
    return {
        drive: LARGEST * (0.3 + 0.2 * np.sin(phase - 1.5 * number))
        for number, drive in enumerate(DRIVES)
    }


def main() -> None:
    """Time both, and compare the derivative with differences."""
    report = Report("Derivatives of a motion")
    crawler = vs.Simulator(robot("crawl"), damping=10)
    times: dict[bool, list[float]] = {False: [], True: []}
    for _ in range(REPEATS):
        for slopes, taken in times.items():
            crawler.reset()
            start = time.process_time()
            found = vs.rollout(crawler, gait(), steps=STEPS, slopes=slopes)
            taken.append(time.process_time() - start)
    alone = statistics.median(times[False])
    report.add(f"{STEPS} steps", alone, "s", 1.0)
    both = statistics.median(times[True])
    report.add(f"with derivatives by {len(DRIVES) * KNOTS} knots", both, "s", both / alone)
    report.add("error of a derivative, median", 100.0 * error(crawler, found), "%")
    report.show()


def error(crawler: vs.Simulator, found: vs.Rollout) -> float:
    """Median over knots of the error of the last place along x, relative to the largest slope."""
    size = max(np.abs(found.slopes[drive][PROBE][-1, :, 0]).max() for drive in DRIVES)
    errors = []
    for drive in DRIVES:
        for knot in range(KNOTS):
            slope = found.slopes[drive][PROBE][-1, knot, 0]
            off = [abs(difference(crawler, drive, knot, h) - slope) for h in DISTANCES]
            errors.append(min(off) / size)
    return statistics.median(errors)


def difference(crawler: vs.Simulator, drive: str, knot: int, part: float) -> float:
    """Central difference of the last place along x by a knot."""
    ends = []
    for sign in (1.0, -1.0):
        moved = gait()
        moved[drive][knot] += sign * part * LARGEST
        crawler.reset()
        last = vs.rollout(crawler, moved, steps=STEPS, slopes=False).observations[-1]
        ends.append(float(last.probes[PROBE][0]))
    return (ends[0] - ends[1]) / (2.0 * part * LARGEST)


if __name__ == "__main__":
    main()
