"""One frame of a run over time, as a result to draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from voxsoft.errors import MeshError
from voxsoft.simulation import Result
from voxsoft.simulation.setup.contact import Pose


def at_frame(result: Result, frame: int) -> Result:
    """Return the result with body and objects at their positions in a recorded frame.

    Numbers that are known for the end alone, such as forces and contacts, are left out.

    Parameters
    ----------
    result
        Result of a run with ``frames=True``.
    frame
        Number of the frame; negative ones count from the end.

    Raises
    ------
    MeshError
        No such frame.
    """
    recording = result.recording
    count = len(recording.frames)
    if not -count <= frame < count:
        what = f"is {frame}, and the run recorded {count}"
        hint = "simulate with frames=True" if count == 0 else f"give 0 to {count - 1}"
        raise MeshError("frame", what, hint)
    objects = {
        name: Pose(_triple(places[frame]), tuple(_triple(row) for row in turns[frame]))
        for name, (places, turns) in recording.objects.items()
    }
    return replace(
        result,
        positions=recording.frames[frame],
        velocities=np.zeros_like(result.velocities),
        objects=objects,
        contacts=(),
        contact_field=None,
        tendons={},
        supplies=(),
    )


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
