"""Peg: a soft finger that pushes a peg over a smooth floor into a socket."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from voxsoft.environments.drive import Drive
from voxsoft.environments.environment import SoftRobotEnv
from voxsoft.environments.randomization import Randomization
from voxsoft.environments.robots import robot
from voxsoft.environments.task import Task
from voxsoft.environments.vector import on_threads
from voxsoft.simulation import Observation

#: Middle of the peg where it is all the way in, m.
_INSIDE: Final = (0.032, 0.0)
#: Rest of the way at which the peg counts as inserted, m.
_NEAR: Final = 1e-3


class Peg(Task):
    """Insert the peg: a reward of 1 for each mm by which its middle comes nearer; done inside.

    The peg lies up to 2 mm aside, drawn for each episode as a parameter of the design.
    """

    def shown(self, seen: Observation) -> Mapping[str, float]:
        """Return the way of the peg to its place in mm, and its turn in rad."""
        x, y, _ = seen.objects["peg"].position
        (cosine, *_), (sine, *_), _ = seen.objects["peg"].rotation
        return {
            "way.x": 1e3 * (_INSIDE[0] - x),
            "way.y": 1e3 * (_INSIDE[1] - y),
            "turn": float(np.arctan2(sine, cosine)),
        }

    def reward(self, before: Observation, after: Observation) -> float:
        """Return by how much the peg came nearer, mm."""
        return 1e3 * (_distance(before) - _distance(after))

    def is_done(self, seen: Observation) -> bool:
        """Return True once the peg is inserted."""
        return _distance(seen) < _NEAR

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return the rest of the way, m, and whether the peg is inserted."""
        return {"distance": _distance(seen), "is_success": self.is_done(seen)}


def _distance(seen: Observation) -> float:
    x, y, _ = seen.objects["peg"].position
    return float(np.hypot(_INSIDE[0] - x, _INSIDE[1] - y))


def peg(**options: Any) -> SoftRobotEnv:  # noqa: ANN401 - those of the environment
    """Make the environment ``VoxSoft/Peg-v0``, with options of :class:`SoftRobotEnv`."""
    given: dict[str, Any] = {
        "drives": [
            Drive(command="wrist", axis="x", low=0.0, high="45 mm", rate="15 mm"),
            Drive(command="wrist", axis="y", low="-8 mm", high="8 mm", rate="15 mm"),
        ],
        "sensors": ["probes.tip"],
        "randomize": Randomization(parameters={"aside": None}),
        "stage": ((-0.03, -0.025, 0.0), (0.05, 0.025, 0.035)),
    }
    return SoftRobotEnv(robot("peg"), Peg(), **(given | options))


peg_on_threads = on_threads(peg)
