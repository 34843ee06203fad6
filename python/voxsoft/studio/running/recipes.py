"""Ways to repeat a job without the studio: as Python, and as a command line."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from voxsoft.errors import VoxSoftError
from voxsoft.jobs import RunSpec, load
from voxsoft.jobs.copies import design_file
from voxsoft.studio.protocol import events
from voxsoft.studio.running.runs import read_summary

#: The worker processes of a study import the script: they must not start it again.
_SCRIPT = """\
from voxsoft import jobs

if __name__ == "__main__":
    spec = jobs.load({folder!r}).spec
    outcome = jobs.run_job(spec, {again!r})  # spec.replace(...) is another job
    print(outcome.summary)
"""


def recipe_of(folder: Path) -> events.Recipe:
    """Tell how the job of a folder can be done again.

    Raises
    ------
    FileError
        The folder holds no job.
    """
    job = load(folder, check=False)
    kept = isinstance(job.spec, RunSpec) and job.spec.kept
    design = str(folder / design_file("run"))
    summary: Mapping[str, Any] = {}
    with suppress(OSError, VoxSoftError):  # not ended yet, or not well
        summary = read_summary(folder)
    return events.Recipe(
        job=folder.name,
        python=_SCRIPT.format(folder=str(folder), again=f"{folder.name}-again"),
        # No job repeats a state kept from the screen: its design can be solved.
        command=shlex.join(["voxsoft", *(["run", design] if kept else ["again", str(folder)])]),
        seed=getattr(job.spec, "seed", None),
        version=str(summary.get("versions", {}).get("voxsoft", job.version)),
    )
