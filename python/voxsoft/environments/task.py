"""Task of an environment: its goal, its reward and its end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np

from voxsoft.simulation import Observation


class Task(ABC):
    """Goal, reward and end of the episodes of one environment.

    A subclass gives :meth:`reward`; all else has a default. Observations are those of the
    simulator, in SI units: the whole state, also where an agent sees little of it through sensors
    with noise.

    Examples
    --------
    >>> class Rise(Task):
    ...     def reward(self, before, after):
    ...         return 1e3 * float(after.probes["top"][2] - before.probes["top"][2])
    """

    def start(  # noqa: B027 - a task may have nothing to begin with
        self, seen: Observation, generator: np.random.Generator, options: Mapping[str, Any]
    ) -> None:
        """Begin an episode: draw a goal, note where things are.

        Parameters
        ----------
        seen
            The first observation of the episode.
        generator
            Source of all random numbers of the task, seeded by ``reset(seed=...)``.
        options
            Options of ``reset(options=...)``.
        """

    def shown(self, seen: Observation) -> Mapping[str, float]:
        """Return numbers that an agent sees beside the sensors, by name: the goal, for example.

        The names and their number are those of the first episode, always.
        """
        return {}

    @abstractmethod
    def reward(self, before: Observation, after: Observation) -> float:
        """Return the reward of one action, from the observations around it."""

    def is_done(self, seen: Observation) -> bool:
        """Return True where the task ends by its own nature: reached, or lost for good."""
        return False

    def info(self, seen: Observation) -> Mapping[str, Any]:
        """Return numbers for people, which stand in the ``info`` of each step."""
        return {}
