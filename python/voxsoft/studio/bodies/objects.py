"""Rigid objects as the page draws them, and the moments of a solution's frames."""

from __future__ import annotations

import base64
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voxsoft.design import Design
from voxsoft.errors import VoxSoftError
from voxsoft.plot.objects import Surroundings
from voxsoft.simulation import Result, Setup
from voxsoft.simulation.compatibility import refused_features
from voxsoft.simulation.setup.contact import ContactState, Pose, has_contact
from voxsoft.simulation.setup.fluids import has_supplies
from voxsoft.studio.protocol import events
from voxsoft.studio.protocol.message import Triple


def objects_of(setup: Setup) -> list[events.BodyObject]:
    """The objects of a design where they are at first, as far as they have a surface."""
    touching = setup.touching
    if touching is None:
        return []
    try:
        traced = touching.traced
    except VoxSoftError:  # a finding of the check
        return []
    return [
        events.BodyObject(
            name=each.name,
            motion="free" if each.is_free else "fixed" if each.way is None else "moved",
            middle=_triple(surface.middle),
            vertices=packed(surface.vertices.astype("<f4")),
            triangles=packed(surface.triangles.astype("<u4")),
        )
        for each, surface in zip(setup.design.objects, traced, strict=True)
    ]


def not_live(setup: Setup) -> str:
    """Return the reason why time does not run for a body; empty where it does."""
    for feature in refused_features(setup.design, "live motion"):
        return f"Live motion does not know {feature} yet: press Solve."
    return ""


def touches_live(setup: Setup) -> bool:
    """Check if contact of the body is found while time runs."""
    return has_contact(setup.design) and not not_live(setup)


def is_filmed(design: Design) -> bool:
    """Check if a solution of a design has moments for the page."""
    return has_contact(design) or has_supplies(design)


def film_of(result: Result) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and positions recorded before the state that a result ends in."""
    times, frames = result.recording.times, result.recording.frames
    before = len(frames) - int(len(frames) > 0 and times[-1] >= result.time)
    return times[:before], frames[:before]


def moments_of(result: Result, last: int) -> list[events.Moment]:
    """Poses and contacts in each frame of a solution whose last frame has the number `last`."""
    if not is_filmed(result.design):
        return []
    names = [each.name for each in result.design.objects]
    recording, count = result.recording, len(film_of(result)[0])
    found = []
    for index in range(count):
        poses = {
            name: Pose(_triple(positions[index]), tuple(map(_triple, rotations[index])))
            for name, (positions, rotations) in recording.objects.items()
        }
        number = last - count + index
        when = float(recording.times[index])
        contacts = recording.contacts[index] if recording.contacts else ()
        found.append(_moment(number, when, names, poses, contacts))
    end = _moment(last, result.time, names, result.objects, result.contacts)
    end.fields = result.contact_field is not None
    return [*found, end]


def surroundings_of(design: Design, poses: Mapping[str, Pose]) -> Surroundings:
    """Objects and floor in pictures; without the objects where one has no surface to be drawn."""
    try:
        return Surroundings.of(design, poses)
    except VoxSoftError:  # a finding of the check
        return Surroundings(floor=None if design.floor is None else design.floor.z)


def poses_in(moment: events.Moment | None, design: Design) -> dict[str, Pose]:
    """Poses of the objects of a design at a moment, by name; empty where they are unknown."""
    if moment is None:
        return {}
    return {
        each.name: Pose(
            pose.position, tuple(_triple(row) for row in np.reshape(pose.rotation, (3, 3)))
        )
        for each, pose in zip(design.objects, moment.poses, strict=True)
    }


def _moment(
    frame: int,
    time: float,
    names: Sequence[str],
    poses: Mapping[str, Pose],
    contacts: Sequence[ContactState],
) -> events.Moment:
    return events.Moment(
        frame=frame,
        time=time,
        poses=[
            events.ObjectPose(
                position=poses[name].position,
                rotation=[part for row in poses[name].rotation for part in row],
            )
            for name in names
        ],
        contacts=[
            events.Touch(
                of=each.of,
                force=each.force,
                pressed=each.pressed,
                area=each.area,
                gap=each.gap,
                slipping=each.slipping,
                friction=math.hypot(*each.friction),
                bound=each.bound,
            )
            for each in contacts
        ],
    )


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def packed(values: NDArray[Any]) -> str:
    """Write the bytes of an array as base64, as messages hold them."""
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
