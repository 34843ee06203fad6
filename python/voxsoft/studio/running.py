"""The job of one simulation."""

from __future__ import annotations

import io
import math
import time
from pathlib import Path
from typing import Final

from voxsoft import files
from voxsoft.files.whole import write_whole
from voxsoft.simulation import Result, simulate
from voxsoft.studio.commands import RunSpec
from voxsoft.studio.progress import Progress
from voxsoft.studio.rest import digits_lost
from voxsoft.studio.task import Task
from voxsoft.units import format_percent

#: The picture of a run in the list of runs.
THUMBNAIL: Final = "thumbnail.png"
#: Seconds between two words on how far a run is.
_SAID_EVERY: Final = 0.25


def run_once(task: Task, progress: Progress) -> str:
    """Simulate the design of a task, and write its run folder; returns what came out."""
    assert isinstance(task.spec, RunSpec)
    design = task.read_design()
    progress.at(0, 100, stage="meshing")
    last, largest = time.monotonic(), 0.0

    def tell(_: int, when: float, residual: float) -> None:
        nonlocal last, largest
        now = time.monotonic()
        if now - last < _SAID_EVERY:
            return
        last = now
        largest = max(largest, residual if math.isfinite(residual) else 0.0)
        end = design.solver.end_time
        share = when / end if end else digits_lost(residual, largest)
        left = f"residual {format_percent(residual)} of the load"
        progress.at(min(99, int(100 * share)), 100, stage=left)

    result = simulate(design, progress=tell, **task.spec.solver)
    files.write_run(result, progress.folder)
    draw(result, progress.folder)
    progress.at(100, 100)
    return f"{result.message[:1].upper()}{result.message[1:]}."


def draw(result: Result, folder: Path) -> None:
    """Draw the picture of a result for the list of runs."""
    from matplotlib.image import imsave  # slow to load

    from voxsoft.plot.body import body_image

    drawn = io.BytesIO()
    imsave(drawn, body_image(result), format="png")
    write_whole(folder / THUMBNAIL, drawn.getvalue())
