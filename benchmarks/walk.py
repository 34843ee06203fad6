"""Random commands of a simulator, for benchmarks, evidence and tests."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

import voxsoft as vs
from voxsoft.simulation import Command
from voxsoft.simulation.runs.drives import Value

#: Largest change of a command in a step, of the way to its farthest value in the design.
STRIDE: Final = 0.05


def farthest(command: Command) -> Value:
    """Return the value of a command in the design that is farthest from its first one."""
    values = [command.design] if command.history is None else list(command.history[1])
    far = [np.linalg.norm(np.subtract(each, command.first)) for each in values]
    return values[int(np.argmax(far))]


def walk(simulator: vs.Simulator, steps: int) -> list[dict[str, Any]]:
    """Return random commands for some steps, without gravity.

    Each drive walks at random between its first value and the one farthest from it in the design:
    in a step back by half a stride, or forward by one, at most.
    """
    generator, found = np.random.default_rng(0), list[dict[str, Any]]()
    shares = dict.fromkeys(simulator.commands, 0.0)
    ends = {name: (each.first, farthest(each)) for name, each in simulator.commands.items()}
    for _ in range(steps):
        commands: dict[str, Any] = {}
        for name, command in simulator.commands.items():
            if command.kind == "acceleration":
                continue
            walked = shares[name] + generator.uniform(-STRIDE / 2, STRIDE)
            shares[name] = float(np.clip(walked, 0.0, 1.0))
            first, last = (np.asarray(each) for each in ends[name])
            value = first + shares[name] * (last - first)
            commands[name] = tuple(value.tolist()) if command.shape else float(value)
        found.append(commands)
    return found
