"""Pinch and turn: two pads that press a bar between them and turn it on the floor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from voxsoft.environments.drive import Drive
from voxsoft.environments.environment import SoftRobotEnv
from voxsoft.environments.robots import robot
from voxsoft.environments.task import Task
from voxsoft.environments.vector import on_threads
from voxsoft.errors import SimulationError
from voxsoft.simulation import Observation

#: Least and largest turn that is asked for, to either side, rad.
_TURNS: Final = (0.15, 0.5)
#: Error of a turn that counts as reached, rad.
_NEAR: Final = 0.02


class PinchAndTurn(Task):
    """Turn the bar by an angle: a reward of 1 for each degree nearer to it; done within 0.02 rad.

    The angle is drawn for each episode, to either side, or given in rad:
    ``reset(options={"angle": 0.3})``.
    """

    def __init__(self) -> None:
        self.angle = 0.0

    def start(
        self, seen: Observation, generator: np.random.Generator, options: Mapping[str, Any]
    ) -> None:
        """Draw an angle, or take that of the options."""
        size, side = generator.uniform(*_TURNS), generator.integers(2)
        self.angle = float(size if side else -size)
        if "angle" in options:
            self.angle = float(options["angle"])
            if not np.isfinite(self.angle):
                what = f"{self.angle} is no angle"
                raise SimulationError("options.angle", what, "give one in rad")

    def shown(self, seen: Observation) -> Mapping[str, float]:
        """Return the angle of the bar and the rest of its turn, rad."""
        return {"turn": _turn(seen), "rest": self.angle - _turn(seen)}

    def reward(self, before: Observation, after: Observation) -> float:
        """Return by how many degrees the bar came nearer."""
        return float(np.degrees(self._error(before) - self._error(after)))

    def is_done(self, seen: Observation) -> bool:
        """Return True once the bar is turned."""
        return self._error(seen) < _NEAR

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return the angle of the bar and that asked for, rad, and whether it is reached."""
        return {"turn": _turn(seen), "angle": self.angle, "is_success": self.is_done(seen)}

    def _error(self, seen: Observation) -> float:
        return abs(self.angle - _turn(seen))


def _turn(seen: Observation) -> float:
    """Return the angle of the bar about the vertical, rad."""
    (cosine, *_), (sine, *_), _ = seen.objects["bar"].rotation
    return float(np.arctan2(sine, cosine))


def pinch_and_turn(**options: Any) -> SoftRobotEnv:  # noqa: ANN401 - those of the environment
    """Make the environment ``VoxSoft/PinchAndTurn-v0``: options of :class:`SoftRobotEnv`."""
    pads = [("right", "-2 mm", "0 mm"), ("left", "0 mm", "2 mm")]
    given: dict[str, Any] = {
        "drives": [
            drive
            for pad, low, high in pads
            for drive in (
                Drive(command=pad, axis="x", low=low, high=high, rate="3 mm"),
                Drive(command=pad, axis="y", low="-8 mm", high="8 mm", rate="10 mm"),
            )
        ],
        "sensors": ["objects.bar.position"],
        "stage": ((-0.025, -0.02, -0.006), (0.025, 0.02, 0.01)),
    }
    return SoftRobotEnv(robot("pinch_and_turn"), PinchAndTurn(), **(given | options))


pinch_and_turn_on_threads = on_threads(pinch_and_turn)
