"""Several environments at a time, on the threads of one process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from voxsoft.environments.environment import Floats32, SoftRobotEnv
from voxsoft.errors import SimulationError

Bools = NDArray[np.bool_]
#: A step of one environment: observation, reward, terminated, truncated, info.
_Step = tuple[Floats32, float, bool, bool, dict[str, Any]]


class ThreadVectorEnv(VectorEnv[Floats32, Floats32, NDArray[Any]]):
    """Environments that step on threads: the core leaves Python's lock while it computes.

    Each environment has the bits that it has alone. Beside processes, no observation is copied
    between them, and meshes and simulators stay where they are looked at.

    Parameters
    ----------
    make
        Makers of the environments, which have alike spaces.
    threads
        Number of threads; default: one for each environment. The core's own threads are those of
        ``RAYON_NUM_THREADS``, and that many steps are computed at a time.
    autoreset_mode
        ``"NextStep"`` (default): the step after the end of an episode resets and leaves the action
        aside; or ``"SameStep"``: the last step resets too, with the last observation in
        ``info["final_obs"]``.

    Raises
    ------
    SimulationError
        No environment, other spaces, or ``"Disabled"``.

    Examples
    --------
    >>> from voxsoft.environments.reach import reach
    >>> envs = ThreadVectorEnv([reach, reach])
    >>> observations, infos = envs.reset(seed=0)
    >>> observations.shape
    (2, 13)
    >>> envs.close()
    """

    def __init__(
        self,
        make: Sequence[Callable[[], SoftRobotEnv]],
        *,
        threads: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
    ) -> None:
        mode = AutoresetMode(autoreset_mode)
        if mode == AutoresetMode.DISABLED:
            what = "is to leave ended episodes to the caller"
            raise SimulationError("autoreset_mode", what, 'give "NextStep" or "SameStep"')
        self.envs = [each() for each in make]
        if not self.envs:
            raise SimulationError("make", "makes no environment", "give one maker or more")
        first = self.envs[0]
        for index, each in enumerate(self.envs):
            if (each.observation_space, each.action_space) != (
                first.observation_space,
                first.action_space,
            ):
                raise SimulationError(f"make[{index}]", "has other spaces", "make like ones")
        self.num_envs = len(self.envs)
        self.single_observation_space, self.single_action_space = (
            first.observation_space,
            first.action_space,
        )
        self.observation_space = batch_space(first.observation_space, self.num_envs)
        self.action_space = batch_space(first.action_space, self.num_envs)
        self.metadata = first.metadata | {"autoreset_mode": mode}
        self.render_mode = first.render_mode
        self._over = np.zeros(self.num_envs, dtype=np.bool_)
        self._pool = ThreadPoolExecutor(threads or self.num_envs, "voxsoft-environment")

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Floats32, dict[str, Any]]:
        """Begin an episode in all environments.

        Parameters
        ----------
        seed
            Seeds of the environments; one number for itself and those that follow it.
        options
            Options of the tasks.
        """
        if seed is None or isinstance(seed, int):
            seeds = [None if seed is None else seed + index for index in range(self.num_envs)]
        else:
            seeds = list(seed)
        if len(seeds) != self.num_envs:
            what = f"are {len(seeds)}, for {self.num_envs} environments"
            raise SimulationError("seed", what, "give one number, or one for each")

        def start(index: int) -> tuple[Floats32, dict[str, Any]]:
            return self.envs[index].reset(seed=seeds[index], options=options)

        found = list(self._pool.map(start, range(self.num_envs)))
        self._over[:] = False
        infos: dict[str, Any] = {}
        for index, (_, info) in enumerate(found):
            infos = self._add_info(infos, info, index)
        return np.stack([seen for seen, _ in found]), infos

    def step(
        self, actions: Floats32
    ) -> tuple[Floats32, NDArray[Any], Bools, Bools, dict[str, Any]]:
        """Drive all bodies for one period.

        Parameters
        ----------
        actions
            One row for each environment.
        """
        rows = np.asarray(actions)
        if len(rows) != self.num_envs:
            what = f"have {len(rows)} rows, for {self.num_envs} environments"
            raise SimulationError("actions", what, "give one row for each")
        same = self.metadata["autoreset_mode"] == AutoresetMode.SAME_STEP

        def move(index: int) -> _Step:
            env = self.envs[index]
            if self._over[index]:
                seen, info = env.reset()
                return seen, 0.0, False, False, info
            seen, reward, terminated, truncated, info = env.step(rows[index])
            if same and (terminated or truncated):
                last = {"final_obs": seen, "final_info": info}
                seen, info = env.reset()
                info |= last
            return seen, reward, terminated, truncated, info

        found = list(self._pool.map(move, range(self.num_envs)))
        infos: dict[str, Any] = {}
        for index, (*_, info) in enumerate(found):
            infos = self._add_info(infos, info, index)
        seen, rewards, terminated, truncated, _ = zip(*found, strict=True)
        ends = np.array(terminated), np.array(truncated)
        if not same:
            self._over = ends[0] | ends[1]
        return np.stack(seen), np.array(rewards), *ends, infos

    def render(self) -> tuple[NDArray[np.uint8] | None, ...]:  # type: ignore[override]
        """Return a picture of each body; None without a `render_mode`."""
        return tuple(each.render() for each in self.envs)

    def close_extras(self, **_: Any) -> None:  # noqa: ANN401 - of the base
        """End the threads."""
        self._pool.shutdown()


def on_threads(make: Callable[..., SoftRobotEnv]) -> Callable[..., ThreadVectorEnv]:
    """Return the maker of vector environments of a maker of environments, for `make_vec`."""

    def made(
        num_envs: int,
        *,
        threads: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        **options: Any,  # noqa: ANN401 - those of the environment
    ) -> ThreadVectorEnv:
        each = [partial(make, **options)] * num_envs
        return ThreadVectorEnv(each, threads=threads, autoreset_mode=autoreset_mode)

    return made
