"""Energy that the drives of a body in motion give it over a step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np

from voxsoft import _core

if TYPE_CHECKING:
    from voxsoft.simulation.runs.commands import Course
    from voxsoft.simulation.runs.observation import Floats, Observation

#: Speed in m/s below which the energy of held vertices is not worth counting.
_STILL: Final = 1e-9


def work_after(before: Observation, seen: Observation) -> dict[str, float]:
    """Energy that each drive has given since the reset, J, by its name.

    Forces count by the mean of both ends of the step: one that jumps acts in steps of second order
    as if it had gone evenly to its new value.

    Parameters
    ----------
    before, seen
        The body at both ends of a step.
    """
    subject, commands = seen._subject, seen._subject.commands
    given = dict(before._driven.work)
    if (fluids := subject.setup.fluids) is not None:
        for supplied in fluids.states(seen._drives[0]):
            given[supplied.name] = supplied.energy

    def add(name: str, work: float) -> None:
        given[name] = given.get(name, 0.0) + work

    for tendon in subject.setup.tendons:
        now, then = seen.tendons[tendon.name], before.tendons[tendon.name]
        drawn = (now.shortening - now.slack) - (then.shortening - then.slack)
        add(tendon.name, 0.5 * (now.tension + then.tension) * drawn)
    for index, cavities in subject.pressed:
        ends = (before._driven.values[index], seen._driven.values[index])
        pressure = 0.5 * sum(each for each in ends if isinstance(each, float))
        volumes = [seen.chambers[each].volume - before.chambers[each].volume for each in cavities]
        add(commands.names[index], pressure * sum(volumes))
    _add_forces(before, seen, add)
    return given


def _add_forces(
    before: Observation,
    seen: Observation,
    add: Callable[[str, float], None],
) -> None:
    """Add the work of loads that are drives, and of clamps and objects that are moved."""
    subject = seen._subject
    ends, following = (before._driven.values, seen._driven.values), seen._driven.following
    pressed = {index for index, _ in subject.pressed}
    loads = [
        (name, cores)
        for index, name, cores in subject.commands.forces
        if index not in pressed
        and (index in following or any(np.any(values[index]) for values in ends))
    ]
    clamps = subject.commands.clamps if moves_clamps(seen) or moves_clamps(before) else {}
    if not loads and not clamps:
        return
    of_loads, of_clamps = subject.problem.step_work(
        _state(before), _state(seen), [core for _, cores in loads for core in cores]
    )
    left = iter(of_loads)
    for name, cores in loads:
        add(name, sum(next(left) for _ in cores))
    for core, name in clamps.items():
        add(name, of_clamps[core])


def _state(
    seen: Observation,
) -> tuple[Floats, Floats, float, _core.Memory, list[Course]]:
    """State of a body with its inputs."""
    moment = seen._moment
    inputs = seen._subject.inputs(seen._driven, moment.time)
    return moment.positions, moment.velocities, moment.time, moment.memory, inputs


def moves_clamps(seen: Observation) -> bool:
    """Tell whether a clamp or an object that is commanded moves, or has just stopped."""
    subject, velocities = seen._subject, seen._moment.velocities
    if not subject.commands.clamps:
        return False
    own = len(subject.setup.mesh.vertices)
    held = [velocities[vertices] for vertices in subject.setup.clamped]
    return any(np.abs(each).max(initial=0.0) > _STILL for each in (*held, velocities[own:]))
