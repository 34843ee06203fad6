"""State of supplies over time, as the page draws it."""

from __future__ import annotations

from voxsoft.simulation import Result
from voxsoft.studio.protocol import events


def chambers_of(result: Result, topology: int) -> events.Chambers:
    """The curves of a motion that was solved for; none of an equilibrium."""
    recording = result.recording
    moved = result.solver["way"] == "dynamics"
    return events.Chambers(
        topology=topology,
        times=recording.times.tolist() if moved and recording.chambers else [],
        chambers=[
            events.ChamberCurve(
                name=name,
                pressure=each.pressure.tolist(),
                volume=each.volume.tolist(),
                flow=each.flow.tolist(),
            )
            for name, each in recording.chambers.items()
            if moved
        ],
    )
