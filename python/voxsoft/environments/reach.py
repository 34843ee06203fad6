"""Reach: a hanging finger whose tip four tendons bring to a point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voxsoft.environments.drive import Drive
from voxsoft.environments.environment import SoftRobotEnv
from voxsoft.environments.robots import robot
from voxsoft.environments.task import Task
from voxsoft.environments.vector import on_threads
from voxsoft.errors import SimulationError
from voxsoft.simulation import Observation

#: Length of the finger, m.
_LENGTH: Final = 0.06
#: Least and largest bend of a drawn goal, rad.
_BENDS: Final = (0.15, 0.5)
#: Way by which the silicone gives in along its axis for a bend of a radian, m: as simulated.
_PRESSED: Final = 5.7e-3
#: Distance of a tip that counts as there, m.
_NEAR: Final = 2e-3


class Reach(Task):
    """Bring the tip to a goal and hold it there: a reward of -1 for each cm that it is off.

    The goal is drawn for each episode on any side of the finger, at the end of an arc of constant
    curvature, or given: ``reset(options={"goal": (x, y, z)})``, the displacement of the tip in m.
    """

    def __init__(self) -> None:
        self.goal: NDArray[np.float64] = np.zeros(3)

    def start(
        self, seen: Observation, generator: np.random.Generator, options: Mapping[str, Any]
    ) -> None:
        """Draw a goal, or take that of the options."""
        bend, side = generator.uniform(*_BENDS), generator.uniform(-np.pi, np.pi)
        aside = _LENGTH * (1.0 - np.cos(bend)) / bend
        up = _LENGTH * (1.0 - np.sin(bend) / bend) + _PRESSED * bend
        self.goal = np.array([aside * np.cos(side), aside * np.sin(side), up])
        if "goal" in options:
            self.goal = np.array(options["goal"], dtype=np.float64)
            if self.goal.shape != (3,) or not np.isfinite(self.goal).all():
                what = f"{options['goal']!r} is no displacement"
                raise SimulationError("options.goal", what, "give x, y and z in m")

    def shown(self, seen: Observation) -> Mapping[str, float]:
        """Return the way from the tip to the goal, mm."""
        x, y, z = (1e3 * (self.goal - seen.probes["tip"])).tolist()
        return {"goal.x": x, "goal.y": y, "goal.z": z}

    def reward(self, before: Observation, after: Observation) -> float:
        """Return minus the distance in cm."""
        return -1e2 * self._distance(after)

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return the distance, m, and whether it counts as reached."""
        distance = self._distance(seen)
        return {"distance": distance, "is_success": distance < _NEAR}

    def _distance(self, seen: Observation) -> float:
        return float(np.linalg.norm(self.goal - seen.probes["tip"]))


def reach(**options: Any) -> SoftRobotEnv:  # noqa: ANN401 - those of the environment
    """Make the environment ``VoxSoft/Reach-v0``, with options of :class:`SoftRobotEnv`."""
    tendons = ("right", "left", "back", "ahead")
    given: dict[str, Any] = {
        "drives": [Drive(command=each, low=0.0, high="8 mm", rate="20 mm") for each in tendons],
        "sensors": ["probes.tip", "probes.tip.velocity"],
        "episode": "5 s",
        "stage": ((-0.03, -0.03, -0.065), (0.03, 0.03, 0.0)),
    }
    return SoftRobotEnv(robot("reach"), Reach(), **(given | options))


reach_on_threads = on_threads(reach)
