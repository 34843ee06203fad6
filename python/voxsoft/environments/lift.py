"""Lift: two fingers that close around a box on the floor, and a flange that goes up."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from voxsoft.environments.drive import Drive
from voxsoft.environments.environment import SoftRobotEnv
from voxsoft.environments.robots import robot
from voxsoft.environments.task import Task
from voxsoft.environments.vector import on_threads
from voxsoft.simulation import Observation

#: Height above the floor at which the box counts as lifted, m.
_HIGH: Final = 0.02


class Lift(Task):
    """Lift the box: a reward of 1 for each mm by which it rises; done at 20 mm."""

    def __init__(self) -> None:
        self.floor = 0.0

    def start(self, seen: Observation, generator: object, options: object) -> None:
        """Note where the box stands."""
        self.floor = seen.objects["box"].position[2]

    def reward(self, before: Observation, after: Observation) -> float:
        """Return the way up in mm."""
        return 1e3 * (self._height(after) - self._height(before))

    def is_done(self, seen: Observation) -> bool:
        """Return True once the box is lifted."""
        return self._height(seen) >= _HIGH

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return the height of the box above where it stood, m, and whether that is enough."""
        return {"height": self._height(seen), "is_success": self.is_done(seen)}

    def _height(self, seen: Observation) -> float:
        return float(seen.objects["box"].position[2] - self.floor)


def lift(**options: Any) -> SoftRobotEnv:  # noqa: ANN401 - those of the environment
    """Make the environment ``VoxSoft/Lift-v0``, with options of :class:`SoftRobotEnv`."""
    given: dict[str, Any] = {
        "drives": [
            Drive(command="fingers", low=0.0, rate=1.0),
            Drive(command="flange", axis="z", low=0.0, high="30 mm", rate="15 mm"),
        ],
        "sensors": ["probes.right", "probes.left", "objects.box.position"],
        "stage": ((-0.03, -0.02, -0.035), (0.03, 0.02, 0.035)),
    }
    return SoftRobotEnv(robot("lift"), Lift(), **(given | options))


lift_on_threads = on_threads(lift)
