"""Crawl: a bar on two legs whose halves bend, to go forward as far as it can."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from voxsoft.environments.drive import Drive
from voxsoft.environments.environment import SoftRobotEnv
from voxsoft.environments.robots import robot
from voxsoft.environments.task import Task
from voxsoft.environments.vector import on_threads
from voxsoft.simulation import Observation

#: Probes along the body.
_PROBES = ("rear", "middle", "front")


class Crawl(Task):
    """Go forward along x: a reward of 1 for each mm by which the body as a whole moves on."""

    def shown(self, seen: Observation) -> Mapping[str, float]:
        """Return by how much the body is shorter and its middle higher than at rest, in mm."""
        rear, middle, front = (1e3 * seen.probes[name] for name in _PROBES)
        return {
            "shorter": float(rear[0] - front[0]),
            "higher": float(middle[2] - 0.5 * (rear[2] + front[2])),
        }

    def reward(self, before: Observation, after: Observation) -> float:
        """Return the way forward in mm."""
        return 1e3 * (_place(after) - _place(before))

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return the way since the reset, m."""
        return {"x": _place(seen)}


def _place(seen: Observation) -> float:
    """Return how far the body has moved along x, m."""
    return float(np.mean([seen.probes[name][0] for name in _PROBES]))


def crawl(**options: Any) -> SoftRobotEnv:  # noqa: ANN401 - those of the environment
    """Make the environment ``VoxSoft/Crawl-v0``, with options of :class:`SoftRobotEnv`."""
    sensors = [f"probes.{name}.velocity" for name in _PROBES]
    given: dict[str, Any] = {
        "drives": [Drive(command=name, low=0.0, rate=2.0) for name in ("rear", "front")],
        "sensors": sensors,
        "stage": ((-0.02, -0.02, 0.0), (0.16, 0.03, 0.03)),
    }
    return SoftRobotEnv(robot("crawl"), Crawl(), **(given | options))


crawl_on_threads = on_threads(crawl)
